"""A region of interest, picked point by point with a pedal."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from saras import ConfigError
from saras.csa.hulls import region_of_interest

Array = NDArray[np.float64]


class RegionPicker:
    """Points are added until one comes near the first: then the region is closed. The next point begins a new one.

    close_m: how near. A point nearer than this to the one before is not taken.
    """

    def __init__(self, close_m: float = 0.003) -> None:
        self.close_m = close_m
        self.points: list[Array] = []
        """of the region that is being picked, or of the closed one"""
        self.closed = False

    def pick(self, point: ArrayLike) -> str:
        """A point (3,) [m]; what became of it. Raises ConfigError when it cannot be: not finite, on one line."""
        at = np.array(point, dtype=float)
        if at.shape != (3,) or not np.isfinite(at).all():
            raise ConfigError(f"point = {at.tolist()}: must be three finite numbers")
        if self.closed:
            self.clear()
        if self.points and len(self.points) >= 3 and np.linalg.norm(at - self.points[0]) < self.close_m:
            return self.close()
        if self.points and np.linalg.norm(at - self.points[-1]) < self.close_m:
            return f"not taken: nearer than {1e3 * self.close_m:g} mm to the point before"
        self.points.append(at)
        return f"point {len(self.points)}"

    def close(self) -> str:
        """Closes the region. Raises ConfigError for fewer than three points or points on one line."""
        region_of_interest(np.array(self.points).reshape(-1, 3))
        self.closed = True
        return f"region of {len(self.points)} points"

    def clear(self) -> str:
        """Forgets all points."""
        self.points, self.closed = [], False
        return "no region"
