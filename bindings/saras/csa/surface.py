"""The model of the anatomy that the proxy meets: a plane, or a mesh of triangles."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from saras import ConfigError, csa

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Touch:
    """What the surface is at a point."""

    depth_m: float
    """behind the surface; negative: in front of it"""
    closest: Array
    """(3,) on the surface [m]"""
    normal: Array
    """(3,) unit, outward; zero: too far away to say"""


class PlaneSurface:
    """All that is behind a plane. point (3,) [m]; normal (3,) outward."""

    def __init__(self, point: ArrayLike, normal: ArrayLike) -> None:
        self._point, n = np.array(point, dtype=float), np.array(normal, dtype=float)
        if n.shape != (3,) or not np.isfinite(n).all() or not np.linalg.norm(n) > 0.0:
            raise ConfigError(f"normal = {n.tolist()}: must be three numbers, not all zero")
        self._normal = n / np.linalg.norm(n)

    def touch(self, point: ArrayLike) -> Touch:
        """At (3,) [m]."""
        depth = float(self._normal @ (self._point - np.asarray(point, dtype=float)))
        return Touch(depth, np.asarray(point, dtype=float) + depth * self._normal, self._normal)


class MeshSurface:
    """A triangle mesh. reach_m: further away than this from it nothing is said but that it is not touched."""

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike, reach_m: float = 0.03) -> None:
        self._mesh = csa.TriangleMesh(np.asarray(vertices, dtype=float), np.asarray(triangles, dtype=np.int32))
        self._reach_m, self._hint = reach_m, -1

    def touch(self, point: ArrayLike) -> Touch:
        """At (3,) [m]."""
        at = np.asarray(point, dtype=float)
        found = self._mesh.closest(at, self._reach_m, self._hint)
        if not np.isfinite(found.distance_m):
            return Touch(-self._reach_m, at.copy(), np.zeros(3))
        self._hint = found.triangle
        return Touch(-found.distance_m, np.array(found.point), np.array(found.normal))


Surface = Union[PlaneSurface, MeshSurface]


def load_mesh(
    path: str | Path, xyz_m: ArrayLike | None = None, rpy_rad: ArrayLike | None = None
) -> tuple[Array, NDArray[np.int32]]:
    """Vertices (n, 3) [m] and triangles (m, 3) of an STL, OBJ or PLY file in metres, moved to a place. ConfigError."""
    try:
        import trimesh
    except ImportError:
        raise ConfigError(f"{path}: reading meshes needs trimesh: pip install 'saras[regions]'") from None
    try:
        mesh: Any = trimesh.load(str(path), force="mesh")
        vertices, triangles = np.asarray(mesh.vertices, dtype=float), np.asarray(mesh.faces, dtype=np.int32)
    except Exception as error:  # trimesh raises whatever its readers do
        raise ConfigError(f"{path}: no mesh: {error}") from error
    if not len(triangles):
        raise ConfigError(f"{path}: no mesh: no triangles")
    turn = rotation(np.zeros(3) if rpy_rad is None else rpy_rad)
    return vertices @ turn.T + (np.zeros(3) if xyz_m is None else np.asarray(xyz_m, dtype=float)), triangles


def rotation(rpy: ArrayLike) -> Array:
    """(3, 3) Rz(yaw) Ry(pitch) Rx(roll)."""
    roll, pitch, yaw = np.asarray(rpy, dtype=float)
    cr, sr, cp, sp, cy, sy = np.cos(roll), np.sin(roll), np.cos(pitch), np.sin(pitch), np.cos(yaw), np.sin(yaw)
    z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
    y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
    x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
    return np.asarray(z @ y @ x)
