"""Rows of script/bench model: the live map, its threads fed at 1 kHz in real time over 11,025 vertices.

live_learn: time to learn a sample. live_refresh: time to ask near the tip and the whole map's share. live_oldest: of
each refresh, the longest time that a vertex it asked had been out of date. Counted beside: how often a second the
touched vertices were asked, samples lost, growth of the process's memory after the first tenth. --heavy: ten minutes.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from saras.model import Mesh
from saras.model.live import LiveMap, refine
from saras.runtime import ModelHostConfig
from saras.sim import TissueConfig
from saras.sim.palpation import Phantom, palpate, raster_path

RATE_HZ = 1000.0
HALF_M, VERTICES = 0.03, 12_000
SECONDS, HEAVY_SECONDS = 20.0, 600.0
PUSH_S = 0.01


def resident_MiB() -> float:
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * 4096 / 2**20


def prior(phantom: Phantom, count: int = 14) -> Mesh:
    side = np.linspace(-HALF_M, HALF_M, count)
    x, y = (axis.reshape(-1) for axis in np.meshgrid(side, side, indexing="ij"))
    corner = [i * count + j for i in range(count - 1) for j in range(count - 1)]
    parts = [((a, a + count, a + count + 1), (a, a + count + 1, a + 1)) for a in corner]
    vertices = phantom.surface(np.column_stack([x, y]))
    vertices[:, 2] += 1e-3 * np.sin(80.0 * x)
    return refine(Mesh(vertices, np.array(parts, dtype=np.int32).reshape(-1, 3)), VERTICES)


def samples(phantom: Phantom, seconds: float):
    """A raster over the whole patch at 25 mm/s, again and again, a little elsewhere each time."""
    dt = 1.0 / RATE_HZ
    path = raster_path(1.8 * HALF_M, 3e-3, 0.025, dt)
    rng = np.random.default_rng(1)
    times = -(-int(seconds * RATE_HZ) // len(path))
    parts = [path + rng.uniform(-1.2e-3, 1.2e-3, 2) * (i > 0) for i in range(times)]
    return palpate(phantom, np.concatenate(parts), dt, amplitude_N=0.7, frequency_Hz=1.3, seed=1)


def run(heavy: bool = False) -> list[dict]:
    """Rows, and what was counted."""
    seconds = HEAVY_SECONDS if heavy else SECONDS
    phantom = Phantom(TissueConfig(curvature_1_m=8.0, inclusion_x_m=0.006, inclusion_y_m=-0.004))
    mesh, recorded = prior(phantom), samples(phantom, seconds)
    live = LiveMap(mesh, ModelHostConfig(touched_hz=40.0, map_hz=1.5))  # asked for: 30 and 1
    count = int(seconds * RATE_HZ)
    live.start()
    began, pushed, bent_at, settled_MiB, laid = time.perf_counter(), 0, 0.0, 0.0, 0
    while pushed < count:
        now = time.perf_counter() - began
        due = min(count, int(now * RATE_HZ))
        part = slice(pushed, due)
        live.push(recorded.t[part], recorded.positions[part], recorded.forces[part], recorded.velocities[part])
        pushed = due
        if now - bent_at > 0.5:  # as the node does
            laid, bent_at = laid + (live.bend(live.snapshot()) is not None), now
        if not settled_MiB and now > 0.1 * seconds:
            settled_MiB = resident_MiB()
        time.sleep(PUSH_S)
    took = time.perf_counter() - began
    live.stop()
    said = live.statistics()
    learned = sum(said.verdicts.values()) + said.waiting
    counted = {
        "seconds": round(took, 1),
        "samples": learned,
        "lost": said.dropped + count - learned,
        "vertices": len(mesh.vertices),
        "known": int(np.isfinite(live.laid.stiffness_N_m).sum()),
        "touched_hz": round(said.refreshes / took, 1),
        "bent_hz": round(laid / took, 1),
        "places": said.places,
        "grown_MiB": round(resident_MiB() - settled_MiB, 1),
    }
    print(f"model: live map: {counted}", file=sys.stderr)
    rows = []
    for name, unit, scale, histogram in (
        ("live_learn", "us", 1e-3, said.learning),
        ("live_refresh", "ms", 1e-6, said.refreshing),
        ("live_oldest", "ms", 1e-6, said.waits),
    ):
        ours = {"p50": scale * histogram.quantile_ns(0.5), "p99": scale * histogram.quantile_ns(0.99)}
        rows.append({"group": "model", "name": name, "unit": unit, "ours": ours, "peers": {}, "ratio": {}, **counted})
    return rows
