"""What the tissue looked like where nothing pressed on it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

CELL_M = 2e-3
MOST_CELLS = 40000
#: A mean of more points than this follows new ones no more slowly.
MOST_COUNTED = 200.0


def cells_of(points: Array, counts: Array | None = None) -> tuple[Array, Array, npt.NDArray[np.int64]]:
    """Means of the points (n, 3) in each cell of 2 mm, how many there were, and the cell of each point.

    A picture has many points in a cell, all with much the same error of the matching: a fit through the means is as
    good, weighs near and far tissue alike, and is faster.
    """
    weight = np.ones(len(points)) if counts is None else counts
    cells = np.floor(points / CELL_M).astype(np.int64) + (1 << 20)
    _, of_point = np.unique((cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2], return_inverse=True)
    total = np.bincount(of_point, weights=weight)
    means = np.column_stack([np.bincount(of_point, weights=weight * points[:, k]) for k in range(3)]) / total[:, None]
    return means, np.asarray(total, dtype=float), np.asarray(of_point)


class SurfaceMemory:
    """Mean points in world with the time at which they were last seen."""

    def __init__(self, keep_s: float) -> None:
        self.keep_s = keep_s
        self.clear()

    def __len__(self) -> int:
        return len(self._points)

    def clear(self) -> None:
        """Forgets all."""
        self._points, self._counts, self._times = np.zeros((0, 3)), np.zeros(0), np.zeros(0)

    def add(self, points: Array, now_s: float) -> None:
        """Points (n, 3) of an undisturbed surface, seen now."""
        if self.keep_s <= 0.0 or not len(points):
            return
        young = self._times >= now_s - self.keep_s
        every = np.concatenate([self._points[young], points])
        counts = np.concatenate([np.minimum(self._counts[young], MOST_COUNTED), np.ones(len(points))])
        times = np.concatenate([self._times[young], np.full(len(points), now_s)])
        self._points, self._counts, of_point = cells_of(every, counts)
        self._times = np.full(len(self._points), -np.inf)
        np.maximum.at(self._times, of_point, times)
        if len(self._points) > MOST_CELLS:
            newest = np.argsort(-self._times, kind="stable")[:MOST_CELLS]
            self._points, self._counts, self._times = self._points[newest], self._counts[newest], self._times[newest]

    def near(self, place: Array, radius_m: float, now_s: float) -> Array:
        """(n, 3) remembered around a place (3,)."""
        if not len(self._points):
            return self._points
        close = (np.abs(self._points - place) < radius_m).all(axis=1) & (self._times >= now_s - self.keep_s)
        return np.asarray(self._points[close])


__all__ = ["SurfaceMemory", "cells_of"]
