"""Convex hulls for fixtures: of points in space, and of a region of interest picked on a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

import saras

#: Faces that a fixture takes (kMaxHullFaces of the core).
MAX_FACES = 64
#: A hull thinner than this is no region [m].
MIN_EXTENT_M = 1e-4


def _points(points: ArrayLike, least: int) -> NDArray[np.float64]:
    array = np.asarray(points, dtype=float)
    if array.ndim != 2 or array.shape[1] != 3 or len(array) < least:
        raise saras.ConfigError(f"points: shape = {array.shape}: must be (n, 3) with n >= {least}")
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if len(bad):
        raise saras.ConfigError(f"points[{bad[0]}] = {array[bad[0]]}: must be finite")
    return array


def convex_hull(points: ArrayLike) -> NDArray[np.float64]:
    """Faces (n, 4) of the convex hull of points (m, 3) [m]: outward unit normal and offset, inside is n.x <= offset.

    Qhull, through scipy. Raises ConfigError for fewer than four points, for points in one plane and for more faces
    than a fixture takes.
    """
    from scipy.spatial import ConvexHull, QhullError

    array = _points(points, 4)
    extent = np.linalg.svd(array - array.mean(axis=0), compute_uv=False)[-1]
    if not extent > MIN_EXTENT_M:
        raise saras.ConfigError(f"points: thickness = {extent:.3g} m: must be above {MIN_EXTENT_M} m, not in one plane")
    try:
        equations = ConvexHull(array).equations
    except QhullError as error:
        raise saras.ConfigError(f"points: no hull: {str(error).splitlines()[0]}") from error
    faces: NDArray[np.float64] = np.unique(np.round(equations, 9), axis=0)  # triangles of one plane are one face
    faces[:, :3] /= np.linalg.norm(faces[:, :3], axis=1, keepdims=True)
    faces[:, 3] *= -1.0
    if len(faces) > MAX_FACES:
        raise saras.ConfigError(f"points: faces = {len(faces)}: must be at most {MAX_FACES}; give fewer points")
    return faces


def region_of_interest(points: ArrayLike, normal: ArrayLike | None = None) -> NDArray[np.float64]:
    """Walls (n, 4) around points (m, 3) picked on a surface: their convex hull seen along the normal, open above.

    normal: (3,) outward; by default that of the plane fitted to the points. Raises ConfigError for fewer than three
    points or points on one line.
    """
    from scipy.spatial import ConvexHull

    array = _points(points, 3)
    centre = array.mean(axis=0)
    _, _, axes = np.linalg.svd(array - centre)
    z = axes[2] if normal is None else np.asarray(normal, dtype=float)
    if z.shape != (3,) or not np.isfinite(z).all() or not np.linalg.norm(z) > 0.0:
        raise saras.ConfigError(f"normal = {z}: must be three numbers, not all zero")
    z = z / np.linalg.norm(z)
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    flat = np.c_[(array - centre) @ x, (array - centre) @ y]
    extent = np.linalg.svd(flat - flat.mean(axis=0), compute_uv=False)[-1]
    if not extent > MIN_EXTENT_M:
        raise saras.ConfigError(f"points: width = {extent:.3g} m: must be above {MIN_EXTENT_M} m, not on one line")
    equations = ConvexHull(flat).equations
    walls = equations[:, :1] * x + equations[:, 1:2] * y
    faces: NDArray[np.float64] = np.c_[walls, walls @ centre - equations[:, 2]]
    if len(faces) > MAX_FACES:
        raise saras.ConfigError(f"points: walls = {len(faces)}: must be at most {MAX_FACES}; give fewer points")
    return faces
