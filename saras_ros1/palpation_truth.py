"""A prior model that is shifted and bent, and how far a map is from the phantom's truth."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from saras.csa.setup import Setup
from saras.csa.system import load
from saras.sim.palpation import Phantom
from saras_ros1.modeler_prior import square

COARSE = 14
HALF_WIDTH_M, LOOKED_AT_M = 0.028, 0.02
SHIFT_M, BEND_M, TILT = 0.0015, 0.0015, 0.03
INCLUSION_M = 0.012


class Errors(NamedTuple):
    """Of a map beside the truth."""

    t_s: float
    samples: int
    known: float
    """share of the square looked at"""
    stiffness_N_m: float
    """RMS where it is known"""
    surface_m: float
    """RMS over the square"""
    inclusion_m: float
    """from the inclusion to the place that is surely stiffest, across the surface"""
    within_1: float
    """share of the stiffnesses within one standard deviation of the truth"""
    within_2: float


def draw(base: Path, out: Path, seed: int) -> Path:
    """Writes a system file whose inclusion, and a coarse mesh whose shift and bend, are drawn from the seed."""
    rng = np.random.default_rng(seed)
    document = json.loads(base.read_text(encoding="utf-8"))
    angle, away = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(0.5, 1.0) * INCLUSION_M
    phantom = document["teleops"][0]["phantom"]
    phantom["inclusion_m"] = [round(float(away * f(angle)), 5) for f in (np.cos, np.sin)]
    document["teleops"][0]["model"] = {"type": "mesh", "file": "prior.obj"}
    path = out / "system.json"
    setup = load(base).setup()
    side = np.linspace(-HALF_WIDTH_M, HALF_WIDTH_M, COARSE)
    x, y = (axis.reshape(-1) for axis in np.meshgrid(side, side, indexing="ij"))
    tilt, phase = rng.uniform(-TILT, TILT, 2), rng.uniform(0.0, 2.0 * np.pi, 2)
    z = SHIFT_M * rng.uniform(0.5, 1.0) + tilt[0] * x + tilt[1] * y
    z = z + BEND_M * np.sin(x / 0.015 + phase[0]) * np.sin(y / 0.02 + phase[1])
    top = setup.start() - [0.0, 0.0, setup.phantom()["height_m"]]
    points = np.column_stack([x, y, z]) + top
    lines = [f"v {p[0]:.7f} {p[1]:.7f} {p[2]:.7f}" for p in points]
    lines += [f"f {a} {b} {c}" for a, b, c in square(COARSE) + 1]
    (out / "prior.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    path.write_text(json.dumps(document, indent=2), encoding="utf-8")
    return path


class Truth:
    """The phantom of a system file."""

    def __init__(self, setup: Setup) -> None:
        self.phantom = Phantom(setup.tissue_config())
        self.middle = self.phantom.surface([[0.0, 0.0]])[0]

    def looked_at(self, points: np.ndarray) -> np.ndarray:
        """(n,) whether (n, 3) points are over the square that is judged."""
        return (np.abs(points[:, :2] - self.middle[:2]) <= LOOKED_AT_M).all(1)

    def errors(self, t_s: float, samples: int, rows: Any, stiffest: np.ndarray) -> Errors:
        """rows: of read_cloud; stiffest (3,) [m]."""
        points = np.column_stack([rows["x"], rows["y"], rows["z"]]).astype(float)
        seen = self.looked_at(points)
        points, stiffness, std = points[seen], rows["stiffness"][seen].astype(float), rows["std"][seen].astype(float)
        known = np.isfinite(stiffness)
        error = (stiffness - self.phantom.stiffness(points))[known]
        share = np.abs(error) / std[known]
        surface = float(np.sqrt((self.phantom.depth(points) ** 2).mean()))
        off = float(np.linalg.norm((stiffest - self.phantom.inclusion)[:2]))
        rms = float(np.sqrt((error**2).mean())) if known.any() else np.nan
        within = [float((share < n).mean()) if known.any() else np.nan for n in (1.0, 2.0)]
        return Errors(t_s, samples, float(known.mean()), rms, surface, off, *within)
