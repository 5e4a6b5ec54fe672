"""Forbidden regions: make them from a bone's mesh, or check a file of them.

saras regions from-mesh bone.stl --out regions.yaml --tolerance-m 0.003
saras regions check regions.yaml
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras._core.collision import Parallelepiped
from saras.collision.forbidden_regions import ForbiddenRegions

#: Bytes of a mesh: a million triangles and more.
MAX_MESH_BYTES = 256 << 20


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds from-mesh and check."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    mesh = actions.add_parser("from-mesh", help="fit oriented boxes that cover the surface of a mesh (STL, OBJ)")
    mesh.add_argument("mesh", type=Path, help="STL (binary or text) or OBJ, in the marker's frame")
    mesh.add_argument("--out", type=Path, required=True, help="regions.yaml, or vertices.txt under any other suffix")
    wanted = mesh.add_mutually_exclusive_group()
    wanted.add_argument("--count", type=int, help="how many boxes (20 when nothing is asked)")
    wanted.add_argument("--tolerance-m", type=float, help="as many as it takes until none stands out by more")
    mesh.add_argument("--margin-m", type=float, default=1e-4, help="added to each side of a box (default %(default)s)")
    mesh.add_argument("--scale", type=float, default=1.0, help="metres per unit of the mesh; 0.001 for mm")
    check = actions.add_parser("check", help="read a file as the platform does and show what is in it")
    check.add_argument("file", type=Path, help="regions.yaml or vertices.txt")
    check.add_argument("--scale", type=float, default=1.0, help="metres per unit of the file; 0.001 for mm")


def run(arguments: argparse.Namespace) -> int:
    """Exit code; refused input is a saras.Error."""
    return _from_mesh(arguments) if arguments.action == "from-mesh" else _check(arguments)


def _from_mesh(arguments: argparse.Namespace) -> int:
    from saras.collision.fit import fit_boxes

    points, faces = load_mesh(arguments.mesh, arguments.scale)
    size = np.ptp(points, axis=0)
    if not 0.001 <= size.max() <= 2.0:
        raise ConfigError(f"{arguments.mesh}: largest extent = {size.max():.4g} m: must be in [0.001, 2] (see --scale)")
    count = 20 if arguments.count is None and arguments.tolerance_m is None else arguments.count
    fit = fit_boxes(points, faces, count, arguments.tolerance_m, arguments.margin_m)
    names = tuple(f"{arguments.mesh.stem}_{i}" for i in range(1, len(fit.boxes) + 1))
    ForbiddenRegions(names, fit.vertices).save(arguments.out)
    ForbiddenRegions.load(arguments.out)  # what is written is what the platform reads
    excess = "unknown (the mesh is not closed)" if np.isnan(fit.excess) else f"{100.0 * fit.excess:.0f} % of the bone's"
    print(f"{arguments.out}: {len(fit.boxes)} boxes cover the surface of {len(faces)} triangles")
    print(f"  stand out of the bone by at most {1e3 * fit.overhang_m:.1f} mm; volume beyond the bone: {excess}")
    return 0


def load_mesh(path: Path, scale: float = 1.0) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int64]]:
    """Points (n, 3) [m] and faces (k, 3) of an STL or OBJ file. Raises ConfigError, OSError."""
    if not path.stat().st_size <= MAX_MESH_BYTES:
        raise ConfigError(f"{path}: size = {path.stat().st_size} bytes: must be at most {MAX_MESH_BYTES} bytes")
    if path.suffix.lower() not in (".stl", ".obj"):
        raise ConfigError(f"{path}: suffix = {path.suffix!r}: must be .stl or .obj")
    if not (np.isfinite(scale) and scale > 0.0):
        raise ConfigError(f"scale = {scale}: must be finite and > 0")
    import trimesh

    try:
        mesh = trimesh.load_mesh(path)
        points, faces = np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces)
    except Exception as error:  # a reader's errors are of any kind
        raise ConfigError(f"{path}: cannot be read as a mesh: {error}") from None
    if len(faces) == 0:
        raise ConfigError(f"{path}: number of triangles = 0: must be at least 1")
    return scale * points, faces


def _check(arguments: argparse.Namespace) -> int:
    regions = ForbiddenRegions.load(arguments.file, scale=arguments.scale)
    width = max(len(name) for name in regions.names)
    print(f"{'name':<{width}}  shape        centre [m]                    edges [mm]               volume [cm³]")
    for name, vertices in zip(regions.names, regions.vertices):
        shape = Parallelepiped(vertices)
        edges = [1e3 * float(np.linalg.norm(vertices[i] - vertices[0])) for i in (1, 4, 3)]
        center = " ".join(f"{value:9.4f}" for value in shape.center)
        print(
            f"{name:<{width}}  {'rectangular' if shape.rectangular else 'skewed     '}  {center} "
            f" {' '.join(f'{edge:7.1f}' for edge in edges)}  {1e6 * shape.volume:12.3f}"
        )
    low, high = regions.vertices.min(axis=(0, 1)), regions.vertices.max(axis=(0, 1))
    extent = ", ".join(f"{a:.4f} … {b:.4f}" for a, b in zip(low, high))
    print(f"{len(regions)} regions; x, y, z from … to [m]: {extent}")
    return 0
