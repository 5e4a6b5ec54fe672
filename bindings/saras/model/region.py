"""A region of interest on a mesh: a flat chart of it, so that paths can be drawn over the surface."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras._core.model import Mesh

Array = npt.NDArray[np.float64]

ACROSS_M, ALONG_M = 1e-4, 0.03
LEAST_M = 2e-3


class Region:
    """The convex hull of (n, 3) corners [m], seen along the mesh's normal there. mesh may be replaced when it is bent.

    low, high: (2,) bounds of the chart [m]. Raises ConfigError: less than three corners, not finite, all on a line.
    """

    def __init__(self, corners: npt.ArrayLike, mesh: Mesh) -> None:
        points = np.asarray(corners, dtype=float)
        if points.ndim != 2 or points.shape[1] != 3 or len(points) < 3:
            raise ConfigError(f"corners: shape {points.shape}: must be (n, 3), n at least 3")
        if not np.isfinite(points).all():
            raise ConfigError("corners: must be finite")
        self.mesh, self._origin = mesh, points.mean(0)
        _, extent, axes = np.linalg.svd(points - self._origin, full_matrices=False)
        if extent[1] < LEAST_M:
            raise ConfigError(f"corners: lie within {1e3 * extent[1]:.2g} mm of a line: must span an area")
        nearest = int(((mesh.vertices - self._origin) ** 2).sum(1).argmin())
        self.normal = axes[2] * (1.0 if axes[2] @ mesh.vertex_normals[nearest] > 0.0 else -1.0)
        x = axes[0]
        self._axes = np.stack([x, np.cross(self.normal, x)])
        self.corners = _hull(self.chart(points))
        self.low, self.high = self.corners.min(0), self.corners.max(0)
        n = self.normal[:, None] * self.normal[None, :]
        self._covariance = ACROSS_M**2 * (np.eye(3) - n) + ALONG_M**2 * n

    @classmethod
    def whole(cls, mesh: Mesh, border_m: float) -> Region | None:
        """All of an open mesh but border_m [m] inwards of its edge; None for a closed one, which has no flat chart."""
        if mesh.closed:
            return None
        middle = mesh.vertices.mean(0)
        away = mesh.vertices - middle
        length_m = np.maximum(np.linalg.norm(away, axis=1, keepdims=True), 1e-9)
        return cls(middle + away * np.maximum(0.0, 1.0 - border_m / length_m), mesh)

    def chart(self, points: npt.ArrayLike) -> Array:
        """(n, 2) coordinates of (n, 3) points [m]."""
        flat: Array = (np.asarray(points, dtype=float).reshape(-1, 3) - self._origin) @ self._axes.T
        return flat

    def surface(self, across: npt.ArrayLike) -> Array:
        """(n, 3) points of the mesh over (n, 2) of the chart; those outside are moved to the region's border."""
        flat = self.inside(across)
        base = self._origin + flat @ self._axes
        points: Array = self.mesh.likely(base, np.broadcast_to(self._covariance, (len(base), 3, 3)))[0]
        return points

    def contains(self, points: npt.ArrayLike, margin_m: float = 0.0) -> npt.NDArray[np.bool_]:
        """(n,) whether (n, 3) points are over the region, as seen along its normal."""
        found: npt.NDArray[np.bool_] = (self._beyond(self.chart(points)) <= margin_m).all(1)
        return found

    def inside(self, across: npt.ArrayLike) -> Array:
        """(n, 2) nearest points of the region to (n, 2) of the chart."""
        flat = np.asarray(across, dtype=float).reshape(-1, 2)
        out = (self._beyond(flat) > 0.0).any(1)
        if not out.any():
            return flat
        a, along = self.corners, np.roll(self.corners, -1, axis=0) - self.corners
        share = ((flat[out, None] - a) * along).sum(2) / (along**2).sum(1)
        nearest = a + np.clip(share, 0.0, 1.0)[..., None] * along
        best = ((nearest - flat[out, None]) ** 2).sum(2).argmin(1)
        moved = flat.copy()
        moved[out] = nearest[np.arange(len(best)), best]
        return moved

    def _beyond(self, flat: Array) -> Array:
        """(n, edges) distances outward of each border's line."""
        along = np.roll(self.corners, -1, axis=0) - self.corners
        outward = np.column_stack([along[:, 1], -along[:, 0]]) / np.linalg.norm(along, axis=1, keepdims=True)
        beyond: Array = ((flat[:, None] - self.corners) * outward).sum(2)
        return beyond


def _hull(points: Array) -> Array:
    """(k, 2) corners of the convex hull, counter-clockwise (Andrew's monotone chain)."""
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]

    def chain(rows: Array) -> list[Array]:
        kept: list[Array] = []
        for row in rows:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], row) <= 0.0:
                kept.pop()
            kept.append(row)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1]))


def _turn(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


__all__ = ["Region"]
