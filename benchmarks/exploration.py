"""Rows of script/bench model: samples until the inclusion is located within 2 mm, beside a raster scan.

A phantom of 80 x 80 mm with its inclusion at a seeded place; both press with the same strokes at 10 mm/s and ask the
same map for its stiffest well-known vertex. The raster's lines are 2 mm apart. Counted until the answer is within 2 mm
for good: for the raster until its end, for the explorer over four more paths.
"""

from __future__ import annotations

import sys

import numpy as np

from saras import sim
from saras.model import GpHyperparameters, StiffnessGpConfig, StiffnessMap
from saras.model.exploring import TrajectoryOptimizer
from saras.sim.palpation import Phantom, along_path, palpate, raster_path

HALF_M, SPEED_M_S, DT = 0.04, 0.01, 5e-3
LOCATED_M, KNOWN_N_M = 2e-3, 120.0
DRAWS, PATHS = 8, 80
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


def located(model: StiffnessMap, here: Phantom, vertices: np.ndarray) -> bool:
    found = model.estimate(vertices)
    sure = found.known & (found.stiffness_std_N_m < KNOWN_N_M)
    stiffest = vertices[np.argmax(np.where(sure, found.stiffness_N_m, -np.inf))]
    return bool(sure.any() and np.linalg.norm(stiffest - here.inclusion) < LOCATED_M)


def raster(seed: int) -> float:
    here, model = phantom(seed), new_map()
    path = raster_path(2 * HALF_M, 2e-3, SPEED_M_S, DT)
    recorded, vertices = palpate(here, path, DT, seed=seed), here.surface(LATTICE)
    line, since = round(2 * HALF_M / SPEED_M_S / DT), np.inf
    for begin in range(0, len(path), line):
        some = slice(begin, begin + line)
        model.partial_fit(recorded.positions[some], recorded.forces[some], recorded.velocities[some])
        since = min(since, begin + line) if located(model, here, vertices) else np.inf
    return since


def explore(seed: int, cost: str) -> float:
    here, model = phantom(seed), new_map()
    optimizer = TrajectoryOptimizer(
        model, here.surface, [-HALF_M] * 2, [HALF_M] * 2, cost=cost, corners=2, step_m=0.025, seed=100 * seed
    )
    vertices, at, samples, since, held = here.surface(LATTICE), np.full(2, -HALF_M), 0, np.inf, 0
    for i in range(PATHS):
        plan = optimizer.next(at)
        recorded = palpate(here, along_path(plan.corners, SPEED_M_S, DT), DT, seed=1000 * seed + i)
        model.partial_fit(recorded.positions, recorded.forces, recorded.velocities)
        samples, at = samples + len(recorded), plan.corners[-1]
        found = located(model, here, vertices)
        since, held = (min(since, samples), held + 1) if found else (np.inf, 0)
        if held > 4:
            break
    return since


def run(draws: int = DRAWS) -> list[dict]:
    """One row a cost. The ratio is that of the means; an explorer that never found it counts as the whole raster."""
    scans = np.array([raster(seed) for seed in range(draws)])
    whole = len(raster_path(2 * HALF_M, 2e-3, SPEED_M_S, DT))
    rows = []
    for cost in ("upper_confidence", "variance"):
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
