"""Files of forbidden regions: the source's vertices.txt, and a YAML form that a person can write.

YAML::

    regions:
      - {name: sacrum, center_m: [0, 0, 0.01], size_m: [0.1, 0.06, 0.03], rpy_rad: [0, 0, 0.2]}
      - name: pubis
        vertices_m: [[…, …, …], …]      # eight, in the order of vertices.txt

Both are strict: what is not understood is refused with its line, its value and the bound. Nothing is skipped, since a
region that is silently missing is a place where a tool may go.
"""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ConfigError, ProtocolError
from saras._core import collision as _core
from saras.kinematics.scene import pose_from_xyz_rpy

Array = npt.NDArray[np.float64]

MAX_REGIONS = 100_000
#: Bytes of a vertices.txt and of a YAML file, asked of the file system before anything is read.
MAX_BYTES = 64 << 20
#: YAML is read a hundred times slower and needs a hundred times the memory.
MAX_YAML_BYTES = 4 << 20

_SHAPES = {"vertices_m": (8, 3), "center_m": (3,), "size_m": (3,), "rpy_rad": (3,)}
_CORNER_SIGNS = np.array(
    [[-1, -1, -1], [1, -1, -1], [1, -1, 1], [-1, -1, 1], [-1, 1, -1], [1, 1, -1], [1, 1, 1], [-1, 1, 1]], dtype=float
)


@dataclass(frozen=True)
class ForbiddenRegions:
    """Parallelepipeds that no tool may enter, in the marker's frame."""

    names: tuple[str, ...]
    vertices: Array
    """(n, 8, 3) [m]; v1, v4, v3 are the neighbours of v0 along x, y, z."""

    def __post_init__(self) -> None:
        if self.vertices.shape != (len(self.names), 8, 3):
            raise ConfigError(f"vertices: shape {self.vertices.shape}: must be ({len(self.names)}, 8, 3)")
        for name, vertices in zip(self.names, self.vertices):
            try:
                _core.Parallelepiped(vertices)
            except ConfigError as error:
                raise ConfigError(f"region {name!r}: {error}") from None

    def __len__(self) -> int:
        return len(self.names)

    @classmethod
    def load(
        cls,
        path: str | Path,
        scale: float = 1.0,
        rotation: npt.ArrayLike | None = None,
        offset_m: npt.ArrayLike = (0.0, 0.0, 0.0),
    ) -> ForbiddenRegions:
        """Reads a YAML file (.yaml, .yml) or, under any other name, a vertices.txt.

        marker_point = rotation (3, 3) · scale · file_point + offset_m (3,). Raises ProtocolError naming file, line,
        value and bound; OSError when the file is not there; a file above MAX_BYTES (MAX_YAML_BYTES) is refused unread.
        """
        marker_T_file = np.eye(4)
        marker_T_file[:3, :3] = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
        marker_T_file[:3, 3] = offset_m
        _check_transform(scale, marker_T_file)
        path = Path(path)
        if path.suffix.lower() in (".yaml", ".yml"):
            names, vertices = _read_yaml(path, scale, marker_T_file)
        else:
            path.stat()  # FileNotFoundError says it better
            vertices = _core.read_vertices(str(path), scale, marker_T_file, MAX_BYTES, MAX_REGIONS)
            names = [f"region_{i}" for i in range(1, len(vertices) + 1)]
        return cls(tuple(names), vertices)

    def save(self, path: str | Path) -> None:
        """Writes YAML (.yaml, .yml) or, under any other name, a vertices.txt; names are kept in YAML only."""
        path = Path(path)
        text = (
            format_yaml(self) if path.suffix.lower() in (".yaml", ".yml") else str(_core.format_vertices(self.vertices))
        )
        path.write_text(text, encoding="utf-8")


def box_vertices(center: npt.ArrayLike, size: npt.ArrayLike, rotation: npt.ArrayLike | None = None) -> Array:
    """(8, 3) of a rectangular box: centre (3,), full edge lengths (3,) [m], rotation (3, 3) of its axes."""
    axes = np.eye(3) if rotation is None else np.asarray(rotation, dtype=float)
    corners: Array = np.asarray(center, dtype=float) + (_CORNER_SIGNS * 0.5 * np.asarray(size, dtype=float)) @ axes.T
    return corners


def format_yaml(regions: ForbiddenRegions) -> str:
    """The YAML text, one region a line, all digits."""
    lines = ["# Forbidden regions: eight corners each [m], in bones_marker_frame.", "regions:"]
    for name, vertices in zip(regions.names, regions.vertices):
        lines.append(f"  - {{name: {json.dumps(name)}, vertices_m: {json.dumps(vertices.tolist())}}}")
    return "\n".join(lines) + "\n"


def _check_transform(scale: float, marker_T_file: Array) -> None:
    if not (math.isfinite(scale) and scale > 0.0):
        raise ConfigError(f"scale = {scale}: must be finite and > 0")
    rotation = marker_T_file[:3, :3]
    rigid = np.isfinite(rotation).all() and np.allclose(rotation.T @ rotation, np.eye(3), atol=1e-6)
    if not (rigid and np.linalg.det(rotation) > 0.0):
        raise ConfigError(f"rotation = {rotation.tolist()}: must be a rotation matrix (orthonormal, determinant 1)")
    if not np.isfinite(marker_T_file[:3, 3]).all():
        raise ConfigError(f"offset_m = {marker_T_file[:3, 3].tolist()}: must be finite")


def _read_yaml(path: Path, scale: float, marker_T_file: Array) -> tuple[list[str], Array]:
    try:
        import yaml
    except ImportError:
        raise ImportError("regions in YAML need PyYAML: pip install pyyaml") from None

    size = path.stat().st_size
    if not path.is_file():
        raise ProtocolError(f"{path}: must be a regular file")
    if size > MAX_YAML_BYTES:
        raise ProtocolError(f"{path}: size = {size} bytes: must be at most {MAX_YAML_BYTES} bytes (use vertices.txt)")
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)(path.read_text(encoding="utf-8"))
    try:
        regions = _regions_of(loader, yaml)
        names: list[str] = []
        vertices: list[Array] = []
        for line, region in regions:
            try:
                name, corners = _region(region, len(names) + 1)
                if name in names:
                    raise ProtocolError(f"name {name!r}: must not stand there twice")
                corners = (scale * corners) @ marker_T_file[:3, :3].T + marker_T_file[:3, 3]
                _core.Parallelepiped(corners)
            except (ConfigError, ProtocolError) as error:
                raise ProtocolError(f"line {line}: region {len(names) + 1}: {error}") from None
            names.append(name)
            vertices.append(corners)
    except yaml.YAMLError as error:
        raise ProtocolError(f"{path}: {error}") from None
    except (ProtocolError, RecursionError) as error:
        raise ProtocolError(f"{path}: {error}") from None
    finally:
        loader.dispose()
    return names, np.array(vertices)


def _regions_of(loader: Any, yaml: Any) -> list[tuple[int, Any]]:
    """(line, content) of each region."""
    root = loader.get_single_node()
    entries = dict((key.value, value) for key, value in root.value) if isinstance(root, yaml.MappingNode) else {}
    if set(entries) != {"regions"}:
        raise ProtocolError(f"line 1: entries = {sorted(map(str, entries))}: must be 'regions' and nothing else")
    node = entries["regions"]
    if not isinstance(node, yaml.SequenceNode) or not 1 <= len(node.value) <= MAX_REGIONS:
        count = len(node.value) if isinstance(node, yaml.SequenceNode) else "no list"
        raise ProtocolError(
            f"line {node.start_mark.line + 1}: number of regions = {count}: must be a list of 1 to {MAX_REGIONS}"
        )
    return [(child.start_mark.line + 1, loader.construct_document(child)) for child in node.value]


def _region(entry: Any, number: int) -> tuple[str, Array]:
    if not isinstance(entry, dict):
        raise ProtocolError(f"{entry!r}: must be a mapping")
    keys = set(entry) - {"name"}
    if keys not in ({"vertices_m"}, {"center_m", "size_m"}, {"center_m", "size_m", "rpy_rad"}):
        raise ProtocolError(
            f"entries = {sorted(map(str, keys))}: must be vertices_m, or center_m and size_m (and rpy_rad)"
        )
    name = entry.get("name", f"region_{number}")
    if not isinstance(name, str) or not name:
        raise ProtocolError(f"name = {name!r}: must be a text")
    values = {key: _numbers(entry[key], key) for key in keys}
    if "vertices_m" in values:
        return name, values["vertices_m"]
    if not (values["size_m"] > 0.0).all():
        raise ProtocolError(f"size_m = {values['size_m'].tolist()}: must be > 0")
    rotation = pose_from_xyz_rpy(np.zeros(3), values.get("rpy_rad", np.zeros(3)))[:3, :3]
    return name, box_vertices(values["center_m"], values["size_m"], rotation)


def _numbers(value: Any, key: str) -> Array:
    shape = _SHAPES[key]
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != shape:
        raise ProtocolError(f"{key} = {str(value)[:120]}: must be numbers of shape {shape}")
    if not np.isfinite(array).all():
        raise ProtocolError(f"{key} = {str(value)[:120]}: must be finite")
    return array


__all__ = ["MAX_BYTES", "MAX_REGIONS", "MAX_YAML_BYTES", "ForbiddenRegions", "box_vertices", "format_yaml"]
