"""What the map says of the tissue under a tip, on the safe side: not known rather than a guess."""

from __future__ import annotations

import numpy as np

#: Fewer vertices near the tip do not tell what is under it.
LEAST = 3
UNKNOWN = (float("nan"), float("inf"))


class StiffnessUnderTip:
    """Vertices with stiffness and deviation, as the modeler publishes them.

    reach_m: so far around the tip, along the surface, all must be known, and the largest counts; depth_m: a tip further
    than this from all vertices is not over the map.
    """

    def __init__(self, reach_m: float = 0.003, depth_m: float = 0.01) -> None:
        self.reach_m, self.depth_m = reach_m, depth_m
        self._vertices = np.zeros((0, 3))
        self._known = np.zeros((0, 2))

    def take_map(self, vertices: np.ndarray, stiffness: np.ndarray, std: np.ndarray) -> None:
        """All vertices (n, 3) [m], and (n,) [N/m] each; NaN and infinite: unknown."""
        self._vertices = np.array(vertices, dtype=float).reshape(-1, 3)
        self._known = np.column_stack([stiffness, std]).astype(float)

    def take_touched(self, indices: np.ndarray, stiffness: np.ndarray, std: np.ndarray) -> None:
        """Newer values of some vertices (m,); of a map that is not here yet they are left out."""
        if len(indices) and int(indices.max()) < len(self._known):
            self._known[indices] = np.column_stack([stiffness, std])

    def forget(self) -> None:
        """Nothing is known."""
        self.take_map(np.zeros((0, 3)), np.zeros(0), np.zeros(0))

    def at(self, tip: np.ndarray) -> tuple[float, float]:
        """Stiffness and deviation [N/m] of the vertex near the tip (3,) whose upper bound is greatest; or UNKNOWN."""
        if not len(self._vertices) or not np.isfinite(tip).all():
            return UNKNOWN
        squared = ((self._vertices - tip) ** 2).sum(axis=1)
        least = squared.min()  # the tip presses in: what is near is counted from the surface's nearest vertex
        at = squared <= least + self.reach_m**2
        near = self._known[at]
        if least > self.depth_m**2 or len(near) < LEAST or self._beside(self._vertices[at], tip):
            return UNKNOWN
        if not (np.isfinite(near).all() and (near[:, 0] > 0.0).all() and (near[:, 1] >= 0.0).all()):
            return UNKNOWN
        stiffness, std = near[upper_bound(near[:, 0], near[:, 1]).argmax()]
        return float(stiffness), float(std)

    def _beside(self, vertices: np.ndarray, tip: np.ndarray) -> bool:
        """Whether the tip is past the border of the mesh rather than over these vertices (n, 3)."""
        _, extents, axes = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)
        if extents[1] < 0.1 * extents[0]:
            return True  # on one line: an edge
        normal = axes[2]
        above = tip - normal * (normal @ (tip - vertices[0]))
        return bool(((vertices - above) ** 2).sum(axis=1).min() > self.reach_m**2)


def upper_bound(stiffness: np.ndarray, std: np.ndarray) -> np.ndarray:
    """What the tissue is hardly stiffer than [N/m]: the slave's gain must be stable there."""
    return np.asarray(stiffness) + 2.0 * np.asarray(std)
