"""OpenCV's five hand-eye methods on draws.npz of a folder, into results.npz. Runs in bench-venv."""

from __future__ import annotations

import sys
from pathlib import Path

import cv2
import numpy as np

METHODS = {
    "tsai": cv2.CALIB_HAND_EYE_TSAI,
    "park": cv2.CALIB_HAND_EYE_PARK,
    "horaud": cv2.CALIB_HAND_EYE_HORAUD,
    "andreff": cv2.CALIB_HAND_EYE_ANDREFF,
    "daniilidis": cv2.CALIB_HAND_EYE_DANIILIDIS,
}


def solve(method, gripper, target):
    out = np.eye(4)
    try:
        rotation, translation = cv2.calibrateHandEye(
            gripper[:, :3, :3], gripper[:, :3, 3], target[:, :3, :3], target[:, :3, 3], method=method
        )
    except cv2.error:
        return np.full((4, 4), np.nan)
    out[:3, :3], out[:3, 3] = rotation, translation.ravel()
    rigid = np.isfinite(out).all() and np.allclose(out[:3, :3] @ out[:3, :3].T, np.eye(3), atol=1e-6)
    return out if rigid and np.linalg.det(out[:3, :3]) > 0 else np.full((4, 4), np.nan)


folder = Path(sys.argv[1])
with np.load(folder / "draws.npz") as draws:
    grippers, targets = draws["gripper"], draws["target"]
results = {name: [solve(method, g, t) for g, t in zip(grippers, targets)] for name, method in METHODS.items()}
np.savez(folder / "results.npz", **{name: np.array(found) for name, found in results.items()})
print(cv2.__version__)
