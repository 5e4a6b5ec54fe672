"""script/bench model: what a palpation teaches, beside scikit-learn's GaussianProcessRegressor.

Both learn the same seeded palpation of the simulated phantom (without damping: scikit-learn's kernels know positions
only), are told the surface's normals, as a registered mesh has them, and are judged by the phantom's truth.
update_N: the time until the N-th sample is in the estimate under the tip.
scikit-learn's kernel and length scales are its own optimum over a part of the samples (a search over all 10^4 takes
hours); the timed fit keeps them.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

from saras import sim
from saras.model import StiffnessGp, StiffnessGpConfig, StiffnessMap
from saras.sim.palpation import Palpation, Phantom, palpate, raster_path

DT = 1e-3
SIZE_M = 0.04
TIMED = 2000
PEER_SAMPLES = (1_000, 10_000)
OURS_SAMPLES = (1_000, 10_000, 100_000, 1_000_000)
SEARCHED = 600


class NotTheSame(RuntimeError):
    """A peer that does not reach our error: its time says nothing. Or ours does not reach its."""


def phantom() -> Phantom:
    return Phantom(sim.TissueConfig(curvature_1_m=8.0, inclusion_x_m=0.006, inclusion_y_m=-0.004, damping_N_s_m2=0.0))


def palpation(samples: int, seed: int = 1):
    """Samples and the time between them [s]: a minute over the whole phantom at a lower rate, or many at 1 kHz."""
    path = raster_path(SIZE_M, 2.5e-3, 0.012, DT)
    times = -(-samples // len(path))
    rng = np.random.default_rng(seed)
    parts = [path + rng.uniform(-1.2e-3, 1.2e-3, 2) * (i > 0) for i in range(times)]
    every = len(path) * times // samples
    recorded = palpate(phantom(), np.concatenate(parts), DT, amplitude_N=0.7, frequency_Hz=1.3, seed=seed)
    chosen = slice(0, samples * every, every)
    return Palpation(
        *(getattr(recorded, name)[chosen] for name in ("t", "positions", "forces", "velocities"))
    ), DT * every


def held_out(count: int = 400, seed: int = 7):
    """Points under the palpated surface, at depths that were pressed to, with the truth of force and stiffness."""
    rng = np.random.default_rng(seed)
    here = phantom()
    surface = here.surface(rng.uniform(-0.45 * SIZE_M, 0.45 * SIZE_M, (count, 2)))
    depth = rng.uniform(0.5, 1.5, count) / here.stiffness(surface)
    points = surface - depth[:, None] * here.normal(surface)
    normals = here.normal(points)
    return points, normals, -(here.forces(points) * normals).sum(1), here.stiffness(points)


class ScikitLearn:
    """Normal force over position by an exact process; what a user would write."""

    def __init__(self, recorded) -> None:
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

        self._regressor = GaussianProcessRegressor
        kernel = ConstantKernel(25.0, (1e-1, 1e6)) * RBF([5.0, 5.0, 10.0], (0.5, 500.0)) + WhiteKernel(1e-2, (1e-6, 1))
        x, f = self.arrays(recorded)
        some = np.random.default_rng(3).choice(len(x), min(SEARCHED, len(x)), replace=False)
        self.kernel = self._regressor(kernel, n_restarts_optimizer=2, random_state=1).fit(x[some], f[some]).kernel_

    @staticmethod
    def arrays(recorded):
        normals = phantom().normal(recorded.positions)
        return 1e3 * recorded.positions, -(recorded.forces * normals).sum(1)

    def fit(self, recorded):
        return self._regressor(self.kernel, optimizer=None).fit(*self.arrays(recorded))


def quantiles(values):
    return {"p50": float(np.quantile(values, 0.5)), "p99": float(np.quantile(values, 0.99))}


def row(name, unit, ours, peers=None):
    peers = peers or {}
    ratio = {peer: round(times["p50"] / ours["p50"], 2) for peer, times in peers.items()}
    return {"group": "model", "name": name, "unit": unit, "ours": ours, "peers": peers, "ratio": ratio}


def our_updates(samples: int, hyperparameters):
    """Single steps after `samples` were learned [us], and the law."""
    law = StiffnessGp(StiffnessGpConfig())
    law.adopt(hyperparameters)
    recorded, dt = palpation(samples + TIMED)
    law.steps(recorded.positions[:samples], recorded.forces[:samples], dt)
    times = np.empty(TIMED)
    for i in range(TIMED):
        x, f = recorded.positions[samples + i], recorded.forces[samples + i]
        begin = time.perf_counter()
        law.step(x, f, dt)
        times[i] = time.perf_counter() - begin
    return 1e6 * times, law


def error_rows(samples: int, ours: StiffnessMap, theirs) -> list[dict]:
    points, normals, force, stiffness = held_out()
    found = ours.estimate(points, normals=normals)
    if not found.known.mean() > 0.99:
        raise NotTheSame(f"model: ours knows only {found.known.mean():.1%} of the held-out points")
    points, normals, force, stiffness = (part[found.known] for part in (points, normals, force, stiffness))
    step = 1e-3 * 0.2
    slope = (theirs.predict(1e3 * (points - step * normals)) - theirs.predict(1e3 * (points + step * normals))) / (
        2 * step
    )
    rows = []
    for name, unit, scale, truth, mine, peer in (
        ("held_out_force", "mN", 1e3, force, found.force_N[found.known], theirs.predict(1e3 * points)),
        ("held_out_stiffness", "N/m", 1.0, stiffness, found.stiffness_N_m[found.known], slope),
    ):
        errors = {"ours": scale * np.abs(mine - truth), "scikit-learn": scale * np.abs(peer - truth)}
        rms = {who: float(np.sqrt(np.mean(error**2))) for who, error in errors.items()}
        values = {who: {**quantiles(error), "rms": rms[who]} for who, error in errors.items()}
        one = row(f"{name}_{samples}", unit, values["ours"], {"scikit-learn": values["scikit-learn"]})
        one["ratio"] = {"scikit-learn": round(rms["scikit-learn"] / rms["ours"], 2)}
        rows.append(one)
        print(
            f"model: {name}, {samples} samples: RMS {rms['ours']:.1f} {unit}, theirs {rms['scikit-learn']:.1f}",
            file=sys.stderr,
        )
    # The map is there for stiffness; between dense samples a process over all of them interpolates force better.
    # That is the price of 64 neighbours: docs/model.md, "How it works".
    if samples >= 10_000 and not rows[1]["ratio"]["scikit-learn"] >= 1.0:
        raise NotTheSame(f"model: scikit-learn predicts held-out stiffness better: {rows[1]}")
    return rows


def run(heavy_python: Path | None = None, peer_samples=PEER_SAMPLES, our_samples=OURS_SAMPLES) -> list[dict]:
    """All rows of what is learned. heavy_python: of the environment that has GPyTorch; None: without it."""
    try:
        import sklearn  # noqa: F401
    except ImportError:
        peer_samples = ()
        print("model: without scikit-learn (pip install scikit-learn)", file=sys.stderr)
    rows, theirs = [], {}
    for samples in peer_samples:
        recorded, _ = palpation(samples)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # its optimiser stops at bounds
            peer = ScikitLearn(recorded)
        times = []
        for _ in range(3 if samples < 5000 else 1):
            begin = time.perf_counter()
            fitted = peer.fit(recorded)
            fitted.predict(1e3 * recorded.positions[-1:], return_std=True)
            times.append(1e6 * (time.perf_counter() - begin))
        theirs[samples] = {"scikit-learn": quantiles(times)}
        if heavy_python:
            theirs[samples].update(gpytorch_times(heavy_python, samples))
        ours = StiffnessMap().fit(recorded.positions, recorded.forces)
        rows += error_rows(samples, ours, fitted)
        del fitted
    learned, _ = palpation(20_000)
    hyperparameters = StiffnessMap().fit(learned.positions, learned.forces).hyperparameters
    for samples in our_samples:
        times, law = our_updates(samples, hyperparameters)
        rows.append(row(f"update_{samples}", "us", quantiles(times), theirs.get(samples)))
        print(f"model: {samples} samples are {law.grid.places} places", file=sys.stderr)
    rows.append(map_row(hyperparameters))
    return rows


def gpytorch_times(python: Path, samples: int) -> dict:
    """Updates of GPyTorch's exact and variational processes, with their held-out errors."""
    recorded, _ = palpation(samples + 10)
    x, y = ScikitLearn.arrays(recorded)
    points, _, force, _ = held_out()
    with tempfile.TemporaryDirectory() as folder:
        given = {"x": x[:samples], "y": y[:samples], "new_x": x[samples:], "new_y": y[samples:], "points": 1e3 * points}
        np.savez(Path(folder) / "palpation.npz", **given)
        command = [python, Path(__file__).with_name("gpytorch_peers.py"), folder]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            print(f"model: without GPyTorch: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
            return {}
        with np.load(Path(folder) / "results.npz") as results:
            times = {}
            for name in ("exact", "svgp"):
                rms = 1e3 * float(np.sqrt(np.mean((results[f"{name}_force"] - force) ** 2)))
                times[f"gpytorch-{name}"] = {**quantiles(results[f"{name}_us"]), "held_out_force_rms_mN": rms}
                print(f"model: held_out_force, {samples} samples: gpytorch-{name} {rms:.1f} mN", file=sys.stderr)
    return times


def map_row(hyperparameters) -> dict:
    """10^4 vertices with variances, all anew."""
    recorded, _ = palpation(100_000)
    model = StiffnessMap().fit(recorded.positions, recorded.forces)
    across = np.linspace(-0.5 * SIZE_M, 0.5 * SIZE_M, 100)
    vertices = phantom().surface(np.array([(x, y) for x in across for y in across]))
    times = []
    for _ in range(5):
        begin = time.perf_counter()
        model.estimate(vertices)
        times.append(1e3 * (time.perf_counter() - begin))
    return row("map_10000_vertices", "ms", quantiles(times))
