"""What was learned, as a PLY file: a mesh that any viewer opens, with stiffness and its deviation at each vertex."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ModelError
from saras._core.model import Mesh

Array = npt.NDArray[np.float64]

MAX_BYTES = 256 << 20
#: Colours of the softest, the middle and the stiffest vertex, and of what is not known.
SOFT, MIDDLE, STIFF, UNKNOWN = (68, 1, 84), (33, 145, 140), (253, 231, 37), (160, 160, 160)


@dataclass(frozen=True)
class StiffMesh:
    """A mesh with what is known of its stiffness."""

    vertices: Array
    """(n, 3) [m]"""
    triangles: npt.NDArray[np.int32]
    """(m, 3) counter-clockwise from outside"""
    stiffness_N_m: Array
    """(n,) NaN: not known"""
    stiffness_std_N_m: Array
    """(n,) infinite: not known"""

    def __post_init__(self) -> None:
        Mesh(self.vertices, self.triangles)  # raises ModelError
        for name in ("stiffness_N_m", "stiffness_std_N_m"):
            shape = np.shape(getattr(self, name))
            if shape != (len(self.vertices),):
                raise ModelError(f"{name}: shape {shape}: must be ({len(self.vertices)},), one a vertex")
        if (self.stiffness_std_N_m < 0.0).any():
            raise ModelError(f"stiffness_std_N_m = {self.stiffness_std_N_m.min()}: must be >= 0")

    def colours(self, low_N_m: float | None = None, high_N_m: float | None = None) -> npt.NDArray[np.uint8]:
        """(n, 4) from dark (soft) over green to yellow (stiff) between two stiffnesses; grey where nothing is known."""
        known = np.isfinite(self.stiffness_N_m) & np.isfinite(self.stiffness_std_N_m)
        values = self.stiffness_N_m[known]
        low = low_N_m if low_N_m is not None else (float(values.min()) if known.any() else 0.0)
        high = high_N_m if high_N_m is not None else (float(values.max()) if known.any() else 1.0)
        share = np.clip((values - low) / max(high - low, 1e-12), 0.0, 1.0)
        colours = np.tile(np.array([*UNKNOWN, 255], dtype=np.uint8), (len(self.vertices), 1))
        ramp = np.array([SOFT, MIDDLE, STIFF], dtype=float)
        colours[known, :3] = np.column_stack([np.interp(share, [0.0, 0.5, 1.0], ramp[:, k]) for k in range(3)]).round()
        return colours

    def save(self, path: str | Path) -> None:
        """Writes a binary PLY; coordinates as 32-bit numbers, stiffness and deviation in full."""
        trimesh = _trimesh()
        attributes = {"stiffness_N_m": self.stiffness_N_m, "stiffness_std_N_m": self.stiffness_std_N_m}
        mesh = trimesh.Trimesh(
            self.vertices, self.triangles, process=False, vertex_attributes=attributes, vertex_colors=self.colours()
        )
        Path(path).write_bytes(mesh.export(file_type="ply"))

    @classmethod
    def load(cls, path: str | Path) -> StiffMesh:
        """Reads what save() wrote. Raises ModelError naming what is missing or wrong; OSError when it is not there."""
        path = Path(path)
        size = path.stat().st_size
        if size > MAX_BYTES:
            raise ModelError(f"{path}: size = {size} bytes: must be at most {MAX_BYTES}")
        trimesh = _trimesh()
        try:
            mesh = trimesh.load(path, file_type="ply", process=False)
            columns = mesh.metadata["_ply_raw"]["vertex"]["data"]
            vertices, triangles = np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces, dtype=np.int32)
        except Exception as error:  # trimesh raises what its parser happens to meet
            raise ModelError(f"{path}: must be a PLY file of triangles: {error}") from None
        missing = [n for n in ("stiffness_N_m", "stiffness_std_N_m") if n not in (columns.dtype.names or ())]
        if missing:
            raise ModelError(f"{path}: vertices without {', '.join(missing)}")
        try:
            values = [np.asarray(columns[name], dtype=float) for name in ("stiffness_N_m", "stiffness_std_N_m")]
            return cls(vertices, triangles, *values)
        except ModelError as error:
            raise ModelError(f"{path}: {error}") from None


def _trimesh() -> Any:
    try:
        import trimesh
    except ImportError:
        raise ImportError("StiffMesh.save and load need trimesh: pip install trimesh") from None
    return trimesh


__all__ = ["MAX_BYTES", "StiffMesh"]
