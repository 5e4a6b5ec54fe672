"""script/bench calibration: hand-eye by ours, OpenCV's five methods and ViSP, on the same seeded draws.

The accuracy lines of touched dots come with it. OpenCV's methods run in bench-venv (opencv-contrib-python-headless 4.x
from PyPI: Debian's 4.6 has known sign errors), in a process that reads the draws from a file.
"""

from __future__ import annotations

import argparse
import io
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "property"))
from calibration_rig import DEGREE, HandEyeDraw, pose
from rich.console import Console

import saras
from saras.calibration import board, frame_from_points, hand_eye
from saras.calibration.calibrate_command import add_guide_arguments
from saras.calibration.guided import Guide, errors
from saras.calibration.simulated import ENDOSCOPE, SimulatedRoom
from saras.kinematics import scene

DRAWS, SESSIONS = 1000, 30
PEERS = ("tsai", "park", "horaud", "andreff", "daniilidis")
#: Spread of the rotations [deg], poses, gross errors: one pose in ten with 5 deg and 10 mm an axis more.
SWEEP = [(spread, n, outliers) for spread in (15, 40) for n in (10, 30) for outliers in (False, True)]


class NoResult(RuntimeError):
    """A peer that could not be run: nothing is claimed beside it."""


def error_of(estimate: np.ndarray, truth: np.ndarray) -> tuple[float, float]:
    """Rotation [deg], translation [mm]; NaN where a method gave no transform."""
    if not np.isfinite(estimate).all():
        return np.nan, np.nan
    off = saras.displacement(estimate, truth)
    return float(np.linalg.norm(off[3:]) / DEGREE), float(1e3 * np.linalg.norm(off[:3]))


def opencv_results(folder: Path, python: Path) -> dict[str, np.ndarray]:
    done = subprocess.run(
        [python, Path(__file__).with_name("calibration_opencv.py"), folder], capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise NoResult(f"OpenCV's methods: {done.stderr.strip().splitlines()[-1:]}")
    print(f"calibration: OpenCV {done.stdout.strip()}", file=sys.stderr)
    with np.load(folder / "results.npz") as results:
        return {name: results[name] for name in PEERS}


def compare(ours: np.ndarray, theirs: np.ndarray) -> dict[str, float]:
    """Means over the same draws, and the upper 95 % bound of ours - theirs (paired), without draws that they failed."""
    both = np.isfinite(theirs)
    difference = ours[both] - theirs[both]
    bound = difference.mean() + 1.645 * difference.std(ddof=1) / np.sqrt(len(difference))
    return {"mean": float(theirs[both].mean()), "failed": int((~both).sum()), "bound95": float(bound)}


def hand_eye_rows(draws: int, python: Path) -> list[dict]:
    try:
        from saras import _visp
    except ImportError:
        _visp = None
        print("calibration: ViSP left out, saras._visp is not built (apt-get install libvisp-dev)", file=sys.stderr)
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for spread, n, outliers in SWEEP:
            made = [HandEyeDraw(seed, n, (0.0, float(spread)), n // 10 if outliers else 0) for seed in range(draws)]
            gripper = np.array([draw.base_T_gripper for draw in made])
            target = np.array([draw.camera_T_target for draw in made])
            np.savez(Path(folder) / "draws.npz", gripper=gripper, target=target)
            found = opencv_results(Path(folder), python)
            if _visp is not None:
                found["visp"] = np.array([_visp.hand_eye(list(g), list(t)) for g, t in zip(gripper, target)])
            ours = [hand_eye(g, t) for g, t in zip(gripper, target)]
            truth = [draw.gripper_T_camera for draw in made]
            errors = np.array([error_of(o.gripper_T_camera, t) for o, t in zip(ours, truth)])
            peers = {
                name: np.array([error_of(matrix, t) for matrix, t in zip(results, truth)])
                for name, results in found.items()
            }
            off = [saras.displacement(o.gripper_T_camera, t) for o, t in zip(ours, truth)]
            squares = np.array([d @ np.linalg.solve(o.covariance, d) for d, o in zip(off, ours)])
            name = f"hand_eye {spread} deg, {n} poses, {'outliers' if outliers else 'clean'}"
            for column, unit in enumerate(("deg", "mm")):
                own = errors[:, column]
                row = {"group": "calibration", "name": f"{name}, {'rotation' if unit == 'deg' else 'translation'}"}
                row |= {"unit": unit, "ours": {**_quantiles(own), "mean": float(own.mean())}, "peers": {}, "ratio": {}}
                row["coverage95"] = float((squares < 12.5916).mean())
                row["draws"] = draws
                for peer, theirs in peers.items():
                    good = theirs[np.isfinite(theirs[:, column]), column]
                    row["peers"][peer] = {**_quantiles(good), **compare(own, theirs[:, column])}
                    row["ratio"][peer] = round(row["peers"][peer]["mean"] / row["ours"]["mean"], 2)
                rows.append(row)
            worse = [(r["name"], p) for r in rows[-2:] for p, v in r["peers"].items() if v["bound95"] > 0.0]
            says = f"not shown better than {worse}" if worse else "better than every peer (95 %, paired means)"
            print(f"calibration: {name}: {says}; covariance holds {row['coverage95']:.1%}", file=sys.stderr)
    return rows


def dot_rows(draws: int) -> list[dict]:
    """Touched dots: error 150 mm above the board with 0.5 mm an axis."""
    dots, above = board().dots, np.array([0.0, 0.0, 0.15, 1.0])
    rows = []
    for name, chosen in (("dots 1, 3, 5 once", dots[[0, 2, 4]]), ("six dots twice", np.tile(dots, (2, 1)))):
        errors = []
        for seed in range(draws):
            rng = np.random.default_rng(seed)
            truth = pose(rng.normal(size=3), rng.normal(size=3))
            touched = chosen @ truth[:3, :3].T + truth[:3, 3] + rng.normal(0, 5e-4, chosen.shape)
            found = frame_from_points(touched, chosen).base_T_board
            turn, _ = error_of(found, truth)
            errors.append((turn, 1e3 * float(np.linalg.norm((found @ above - truth @ above)[:3]))))
        for column, unit in enumerate(("deg", "mm")):
            own = np.array(errors)[:, column]
            ours = {**_quantiles(own), "mean": float(own.mean())}
            row = {"group": "calibration", "name": f"base frame, {name}", "unit": unit, "ours": ours}
            rows.append({**row, "peers": {}, "ratio": {}, "draws": draws})
    return rows


class TouchingRoom(SimulatedRoom):
    """The simulated room without the endoscope, which touches nothing."""

    @property
    def arms(self) -> dict:
        return {name: arm for name, arm in super().arms.items() if name != ENDOSCOPE}


def guided_rows(sessions: int) -> list[dict]:
    """The guided procedure as `saras calibrate simulation --yes` runs it: the worst base of each session."""
    root = Path(__file__).parents[1]
    arguments = argparse.ArgumentParser()
    add_guide_arguments(arguments)
    usual = arguments.parse_args([])
    place, touches = scene.load(root / "config" / "scene.yaml"), []
    worst: dict[str, list[float]] = {"its base": [], "tools, 50 mm above the board": []}
    for seed in range(sessions):
        room = TouchingRoom(place, board(), seed)
        quiet = Console(file=io.StringIO())
        guide = Guide(room, ENDOSCOPE, quiet, automatic=True, rounds=usual.rounds, known_to_m=1e-3 * usual.known_to_mm)
        calibration = guide.run()
        truth = {room.frame(arm): room.truth(arm) for arm in room.arms}
        worst["its base"].append(1e3 * max(distance for distance, _ in errors(calibration, truth).values()))
        point = room.world_T_board @ [0.0, 0.0, 0.05, 1.0]
        found = [
            calibration.frames[name].parent_T_frame @ np.linalg.inv(world_T_base) @ point
            for name, world_T_base in truth.items()
        ]
        worst["tools, 50 mm above the board"].append(1e3 * max(np.linalg.norm(each - point) for each in found))
        touches += [len(taken) for taken in guide.registration.touches.values()]
    within = int((np.array(worst["its base"]) <= 1.0).sum())
    print(
        f"calibration: {within} of {sessions} guided sessions have all touched bases within 1 mm; "
        f"{np.mean(touches):.0f} touches an arm",
        file=sys.stderr,
    )
    rows = []
    for where, values in worst.items():
        ours = {**_quantiles(np.array(values)), "mean": float(np.mean(values))}
        row = {"group": "calibration", "name": f"guided session, worst arm: {where}", "unit": "mm", "ours": ours}
        row |= {"within_1mm": int((np.array(values) <= 1.0).sum()), "sessions": sessions}
        rows.append({**row, "touches_an_arm": float(np.mean(touches)), "peers": {}, "ratio": {}})
    return rows


def _quantiles(values: np.ndarray) -> dict[str, float]:
    return {"p50": float(np.quantile(values, 0.5)), "p99": float(np.quantile(values, 0.99))}


def run(python: Path, draws: int = DRAWS) -> list[dict]:
    """All rows of the group."""
    return dot_rows(draws) + guided_rows(SESSIONS) + hand_eye_rows(draws, python)
