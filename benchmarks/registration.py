"""Rows of script/bench model: rigid registration beside ICP, bending beside Coherent Point Drift (pycpd).

Rigid: the published protocol of registration_draws.py, seeded; both start from the same poses, 15 to 30 mm and degrees
off. Bending: a mesh of 642 vertices bent by up to a centimetre, 200 points on it with 0.5 mm of noise; the error is the
distance of the bent vertices from the true surface. pycpd runs in bench-venv, from a file of the same draws, with a
width and weight that did best of a few; its time is that of its own register().
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "property"))
import registration_draws as draws

from saras.model import DeformationGrid, Mesh, register_rigid

DRAWS = 100
BENT_DRAWS = 10
CONVERGED_M = 5e-3


def quantiles(values) -> dict[str, float]:
    values = np.asarray(values)
    return {
        "p50": float(np.quantile(values, 0.5)),
        "p99": float(np.quantile(values, 0.99)),
        "mean": float(values.mean()),
    }


def row(name, unit, ours, peers, **more) -> dict:
    """The ratio is that of the means: errors of registration have tails."""
    ratio = {peer: round(values["mean"] / ours["mean"], 2) for peer, values in peers.items()}
    return {"group": "model", "name": name, "unit": unit, "ours": ours, "peers": peers, "ratio": ratio, **more}


def rigid_rows(count: int = DRAWS) -> list[dict]:
    vertices, triangles = draws.organ(1, subdivisions=4)
    mesh = Mesh(vertices, triangles)
    rows = []
    for name, (along, across, outliers, gate) in draws.PROTOCOL.items():
        errors, times, converged = ([], []), ([], []), [0, 0]
        for seed in range(count):
            one = draws.draw(vertices, triangles, seed, along, across, outliers)
            for who, options in enumerate(({"gate": gate}, {"most_likely": False, "max_iterations": 1000})):
                begin = time.perf_counter()
                found = register_rigid(mesh, one.points, one.covariances, one.start, **options)
                times[who].append(1e3 * (time.perf_counter() - begin))
                errors[who].append(1e3 * draws.target_error_m(vertices, found.base_T_mesh))
                converged[who] += errors[who][-1] < 1e3 * CONVERGED_M
        ours, icp = quantiles(errors[0]), quantiles(errors[1])
        more = {"converged": converged, "draws": count}
        if outliers:
            more["ours_without_gross"] = without_gross(mesh, vertices, triangles, count, (along, across, outliers))
        rows.append(row(f"register_{name}", "mm", ours, {"icp": icp}, **more))
        rows.append(row(f"register_{name}_time", "ms", quantiles(times[0]), {"icp": quantiles(times[1])}))
        share = ours["mean"] / icp["mean"]
        print(
            f"model: register {name}: mean error {share:.2f} of ICP's, converged {converged} of {count}",
            file=sys.stderr,
        )
    return rows


def without_gross(mesh, vertices, triangles, count, noise) -> dict:
    """Ours on the same draws with the gross errors left out beforehand: what no gate can do better than."""
    errors = []
    for seed in range(count):
        one = draws.draw(vertices, triangles, seed, *noise)
        kept = slice(int(noise[2] * len(one.points)), None)
        found = register_rigid(mesh, one.points[kept], one.covariances[kept], one.start, gate=1e9)
        errors.append(1e3 * draws.target_error_m(vertices, found.base_T_mesh))
    print(f"model: without the gross errors ours would be at {np.mean(errors):.2f} mm", file=sys.stderr)
    return quantiles(errors)


def bent_rows(python: Path, count: int = BENT_DRAWS) -> list[dict]:
    vertices, triangles = draws.organ(1, subdivisions=3)
    mesh = Mesh(vertices, triangles)
    grid = DeformationGrid(mesh, 0.03)
    covariances = np.tile(0.25e-6 * np.eye(3), (200, 1, 1))
    truths, points, bent, times = [], [], [], []
    for seed in range(count):
        rng = np.random.default_rng(seed)
        truths.append(draws.bent(vertices, seed, 0.01))
        points.append(draws.on_surface(truths[-1], triangles, rng, 200) + rng.normal(0, 0.5e-3, (200, 3)))
        begin = time.perf_counter()
        bent.append(grid.deform(points[-1], covariances, gate=1e3).vertices)
        times.append(1e3 * (time.perf_counter() - begin))

    def errors(results):
        return [1e3 * np.sqrt(Mesh(t, triangles).closest(v)[3]).mean() for t, v in zip(truths, results)]

    peers, peer_times = {}, {}
    with tempfile.TemporaryDirectory() as folder:
        np.savez(Path(folder) / "draws.npz", vertices=vertices, points=np.array(points))
        command = [python, Path(__file__).with_name("registration_cpd.py"), folder]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            print(f"model: without pycpd: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        else:
            with np.load(Path(folder) / "results.npz") as results:
                peers["pycpd"] = quantiles(errors(results["vertices"]))
                peer_times["pycpd"] = quantiles(results["times_ms"])
    unbent = quantiles(errors([vertices] * count))
    return [
        row("deformable_error", "mm", quantiles(errors(bent)), peers, unbent=unbent, draws=count),
        row("deformable_time", "ms", quantiles(times), peer_times),
    ]


def update_row(count: int = 60) -> dict:
    """A mesh of 10,242 vertices laid and bent anew, from how it lay before, while 5 points come at a time [ms]."""
    vertices, triangles = draws.organ(1, subdivisions=5)
    mesh = Mesh(vertices, triangles)
    grid = DeformationGrid(mesh, 0.03)
    rng = np.random.default_rng(1)
    truth = draws.bent(vertices, 1, 0.01)
    points = draws.on_surface(truth, triangles, rng, 50 + 5 * count) + rng.normal(0, 0.5e-3, (50 + 5 * count, 3))
    covariances = np.tile(0.25e-6 * np.eye(3), (len(points), 1, 1))
    pose, start, times = np.eye(4), None, []
    for i in range(count):
        some = slice(0, 50 + 5 * i)
        begin = time.perf_counter()
        rigid = register_rigid(
            mesh, points[some], covariances[some], pose, gate=1e3, prior_shift_m=5e-3, prior_turn_rad=0.1
        )
        pose = np.asarray(rigid.base_T_mesh)
        bent = grid.deform(points[some], covariances[some], pose, gate=1e3, start=start)
        start = bent.displacements
        times.append(1e3 * (time.perf_counter() - begin))
    return {
        "group": "model",
        "name": "deformable_update_time",
        "unit": "ms",
        "ours": quantiles(times),
        "peers": {},
        "ratio": {},
    }


def run(python: Path) -> list[dict]:
    """All rows."""
    return [*rigid_rows(), *bent_rows(python), update_row()]
