"""script/bench stereo_contact: force seen by the endoscope against the simulator's truth, over calibration errors.

On sequences with textures, views and motions that the estimator was not tuned on. The curve, after a build:
PYTHONPATH=devel/lib/python3/dist-packages .venv/bin/python benchmarks/stereo_contact.py PICTURE.png
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "property"))
from contact_sequences import RANGE_M, STIFFNESS_N_M, curved, moments, watch

from saras.sim.endoscope import Room, StereoRenderer, stereo_camera

SCENE = Path(__file__).parents[1] / "config" / "scene.yaml"
#: Seed of the textures and curvature of the tissue [1/m].
ROOMS = ((11, 0.0), (12, 0.0), (13, 3.0), (14, -3.0))
SEQUENCES = 5
ERRORS_M = (0.0, 0.25e-3, 0.5e-3, 1e-3, 1.5e-3, 2e-3, 3e-3)
TOUCH_M = 1.5e-3


def sequences() -> list:
    made = []
    for seed, curvature in ROOMS:
        renderer = StereoRenderer(curved(Room.load(SCENE), curvature), stereo_camera(), seed=seed)
        made += [(renderer, list(moments(renderer, 1000 * seed + i))) for i in range(SEQUENCES)]
    return made


def measure() -> list[dict]:
    """For each calibration error: share of contacts found, of false ones, and the force's errors [% of the range]."""
    made = sequences()
    results = []
    for error_m in ERRORS_M:
        rng = np.random.default_rng(7)
        seen, begin = [], time.process_time()
        for renderer, sequence in made:
            direction = rng.normal(size=3)
            seen += watch(renderer, sequence, error_m * direction / np.linalg.norm(direction))
        took_s = time.process_time() - begin
        depth = np.array([s.depth_m for s in seen])
        found = np.array([s.estimate.known and s.estimate.depth_m > 0.0 for s in seen])
        touching = depth >= TOUCH_M
        errors = 100.0 * np.abs([s.force_error for s in seen])[touching]
        results.append(
            {
                "error_mm": 1e3 * error_m,
                "frames": int(touching.sum()),
                "found": 100.0 * found[touching].mean(),
                "false": 100.0 * found[depth < -TOUCH_M].mean(),
                "unknown": 100.0 * np.mean([not s.estimate.known for s in seen]),
                "p50": float(np.nanpercentile(errors, 50)),
                "p95": float(np.nanpercentile(errors, 95)),
                "p99": float(np.nanpercentile(errors, 99)),
                "frame_ms": 1e3 * took_s / len(seen),
            }
        )
        print("stereo_contact:", {key: round(value, 2) for key, value in results[-1].items()}, file=sys.stderr)
    return results


def run() -> list[dict]:
    """Rows of the group: p50 and p99 of the force's error, and the share of contacts with >= 1.5 mm that was missed."""
    rows = []
    for result in measure():
        at = f"calibration off by {result['error_mm']:g} mm"
        for name, values in (
            (f"force error, {at}", {"p50": result["p50"], "p95": result["p95"], "p99": result["p99"]}),
            (f"contacts missed, {at}", {"p50": 100.0 - result["found"], "p99": 100.0 - result["found"]}),
        ):
            unit = f"% of {1e3 * RANGE_M * STIFFNESS_N_M / 1e3:g} N" if "force" in name else "% of frames"
            rows.append(
                {"group": "stereo_contact", "name": name, "unit": unit, "ours": values, "peers": {}, "ratio": {}}
            )
    return rows


def draw(results: list[dict], path: Path) -> None:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    x = [result["error_mm"] for result in results]
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.0, 3.4), constrained_layout=True)
    for key, label in (("p50", "median"), ("p95", "95 % below"), ("p99", "99 % below")):
        left.plot(x, [result[key] for result in results], marker="o", label=label)
    left.axhline(10.0, color="grey", linestyle=":", label="10 %")
    left.set(xlabel="error of the calibration [mm]", ylabel=f"error of the force [% of {RANGE_M * STIFFNESS_N_M:g} N]")
    left.legend()
    right.plot(x, [result["found"] for result in results], marker="o", label="contacts with >= 1.5 mm found")
    right.plot(x, [result["false"] for result in results], marker="o", label="seen where there is none (1.5 mm above)")
    right.axhline(90.0, color="grey", linestyle=":", label="90 %")
    right.set(xlabel="error of the calibration [mm]", ylabel="frames [%]", ylim=(-3.0, 103.0))
    right.legend()
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    draw(measure(), Path(sys.argv[1]))
