"""Which place of the region is touched next: a path at a time, a place at a time."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from saras.model import Plan, TrajectoryOptimizer
from saras.model.live import LiveMap, Snapshot
from saras.model.region import Region
from saras.model.stiffness_map import SurfaceEstimates


class Explorer:
    """options: of TrajectoryOptimizer. reach_m: a place is touched this near; timeout_s: or given up after that."""

    def __init__(self, live: LiveMap, reach_m: float, timeout_s: float, options: dict[str, Any]) -> None:
        self._live, self._reach_m, self._timeout_s, self._options = live, reach_m, timeout_s, options
        self._known: Snapshot | None = None
        self._region: Region | None = None
        self._optimizer: TrajectoryOptimizer | None = None
        self._corners, self._since_s = np.zeros((0, 2)), 0.0
        self.error, self.plans = "", 0

    def estimate(self, points: Any, *, normals: Any = None) -> SurfaceEstimates:
        """What the optimiser asks."""
        assert self._known is not None
        return self._known.estimate(points, normals=normals)

    def next(self, region: Region | None, known: Snapshot | None, tip: np.ndarray) -> np.ndarray | None:
        """(3,) on the surface [m]; None: there is no region, or nothing to plan with."""
        if region is None or known is None:
            return None
        self._known = known
        if region is not self._region or self._optimizer is None:
            self._region, self._corners = region, np.zeros((0, 2))
            self._optimizer = TrajectoryOptimizer(
                self, region.surface, region.low, region.high, inside=region.inside, **self._options
            )
        region.mesh = self._live.laid.mesh
        at = region.chart(tip)[0]
        now = time.monotonic()
        if len(self._corners):
            near = np.linalg.norm(self._corners[0] - at) < self._reach_m
            if near or now - self._since_s > self._timeout_s:
                self._corners, self._since_s = self._corners[1:], now
        if not len(self._corners):
            plan: Plan = self._optimizer.next(region.inside(at)[0])
            self.error, self.plans = "" if plan.error is None else str(plan.error), self.plans + 1
            # To the first corner only: what is felt on the way there is in the next plan.
            self._corners, self._since_s = plan.corners[1:2], time.monotonic()
        return np.asarray(region.surface(self._corners[:1])[0])
