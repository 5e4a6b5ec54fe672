"""Rows of script/bench model: samples until the inclusion is located within 2 mm, beside a raster scan.

A phantom of 80 x 80 mm with its inclusion at a seeded place; both press with the same strokes at 10 mm/s, never lift,
and ask the same map for its stiffest well-known vertex. The raster's lines are 2 mm apart. All samples count, those on
the way too, until the answer is within 2 mm for good: for the raster until its end, for the explorer over PATHS_AFTER
more paths. Both are asked every ASKED samples.
"""

from __future__ import annotations

import sys

import numpy as np

from saras import sim
from saras.model import GpHyperparameters, StiffnessGpConfig, StiffnessMap
from saras.model.exploring import TrajectoryOptimizer
from saras.sim.palpation import Palpation, Phantom, along_path, palpate, raster_path

HALF_M, SPEED_M_S, DT = 0.04, 0.01, 5e-3
LOCATED_M, KNOWN_N_M = 2e-3, 120.0
DRAWS, ASKED, PATHS_AFTER = 24, 100, 5
COSTS = ("lump", "upper_confidence", "variance")
SIDE = np.linspace(-HALF_M, HALF_M, 41)
LATTICE = np.array([(x, y) for x in SIDE for y in SIDE])


def phantom(seed: int) -> Phantom:
    x, y = np.random.default_rng(seed).uniform(-0.7 * HALF_M, 0.7 * HALF_M, 2)
    return Phantom(sim.TissueConfig(curvature_1_m=4.0, inclusion_x_m=x, inclusion_y_m=y))


def new_map() -> StiffnessMap:
    """Hyper-parameters as learned on another phantom; coarser cells and a wider view than for a map alone."""
    config = StiffnessGpConfig()
    grid, local = config.grid, config.local
    grid.cell_m, local.radius_m, local.neighbours = 2e-3, 0.014, 48
    local.hyperparameters = GpHyperparameters(
        force_scale_N=0.8,
        stiffness_scale_N_m=400.0,
        bend_scale_N_m2=1e4,
        tangential_length_m=0.01,
        damping_s_m=16.7,
        damping_scale_s_m=2.0,
        noise_N=0.03,
    )
    config.grid, config.local = grid, local
    return StiffnessMap(config)


class Scan:
    """One map being learned, and since how many samples its answer is right for good."""

    def __init__(self, here: Phantom) -> None:
        self.model, self.here, self.vertices = new_map(), here, here.surface(LATTICE)
        self.surely = np.full(len(self.vertices), -np.inf)
        self.samples, self.since = 0, np.inf

    def learn(self, recorded: Palpation) -> None:
        for begin in range(0, len(recorded), ASKED):
            some = slice(begin, begin + ASKED)
            positions = recorded.positions[some]
            self.model.partial_fit(positions, recorded.forces[some], recorded.velocities[some])
            self.samples += len(positions)
            self.since = min(self.since, self.samples) if self._located(positions) else np.inf

    def _located(self, touched: np.ndarray) -> bool:
        """Only vertices within reach of what was touched are asked again: nothing changes further away."""
        reach_m = self.model.config.local.radius_m + 2e-3
        squared = ((self.vertices[:, None] - touched[:: ASKED // 10]) ** 2).sum(2).min(1)
        near = np.flatnonzero(squared < reach_m**2)
        found = self.model.estimate(self.vertices[near])
        sure = found.known & (found.stiffness_std_N_m < KNOWN_N_M)
        self.surely[near] = np.where(sure, found.stiffness_N_m, -np.inf)
        best = int(self.surely.argmax())
        return bool(self.surely[best] > 0.0 and np.linalg.norm(self.vertices[best] - self.here.inclusion) < LOCATED_M)


def raster(seed: int) -> float:
    scan = Scan(phantom(seed))
    scan.learn(palpate(scan.here, raster_path(2 * HALF_M, 2e-3, SPEED_M_S, DT), DT, seed=seed))
    return scan.since


def explore(seed: int, cost: str) -> float:
    """As the modeler's node: a path is planned, gone to its first corner, and planned again."""
    scan = Scan(phantom(seed))
    plans = TrajectoryOptimizer(
        scan.model, scan.here.surface, [-HALF_M] * 2, [HALF_M] * 2, cost=cost, corners=2, step_m=0.025, seed=100 * seed
    )
    at, held, whole, i = np.full(2, -HALF_M), 0, len(raster_path(2 * HALF_M, 2e-3, SPEED_M_S, DT)), 0
    while held < PATHS_AFTER and scan.samples < whole:
        way = along_path(plans.next(at).corners[:2], SPEED_M_S, DT)
        i += 1
        if len(way):
            scan.learn(palpate(scan.here, way, DT, seed=1000 * seed + i))
            at = way[-1]
        held = held + 1 if np.isfinite(scan.since) else 0
    return scan.since


def run(draws: int = DRAWS, costs: tuple[str, ...] = COSTS) -> list[dict]:
    """One row a cost. The ratio is that of the means; an explorer that never found it counts as the whole raster."""
    scans = np.array([raster(seed) for seed in range(draws)])
    whole = len(raster_path(2 * HALF_M, 2e-3, SPEED_M_S, DT))
    rows = []
    for cost in costs:
        ours = np.array([explore(seed, cost) for seed in range(draws)])
        lost = int(np.isinf(ours).sum())
        values = [np.where(np.isinf(v), whole, v) for v in (ours, scans)]
        mine, theirs = ({"p50": float(np.median(v)), "p99": float(v.max()), "mean": float(v.mean())} for v in values)
        ratio = round(theirs["mean"] / mine["mean"], 2)
        print(
            f"model: explore by {cost}: {ratio} times fewer samples than a raster, lost {lost} of {draws}",
            file=sys.stderr,
        )
        row = {
            "group": "model",
            "name": f"explore_{cost}",
            "unit": "samples",
            "ours": mine,
            "peers": {"raster": theirs},
        }
        rows.append({**row, "ratio": {"raster": ratio}, "lost": lost, "draws": draws})
    return rows
