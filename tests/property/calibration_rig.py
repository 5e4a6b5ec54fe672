"""Seeded hand-eye and board measurements with known truth."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

DEGREE = np.pi / 180.0


def pose(rotation_vector, translation) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_rotvec(rotation_vector).as_matrix()
    matrix[:3, 3] = translation
    return matrix


def spoilt(matrix: np.ndarray, rng: np.random.Generator, rotation_rad: float, translation_m: float) -> np.ndarray:
    """Errors about the body's own origin."""
    out = matrix @ pose(rng.normal(0.0, rotation_rad, 3), np.zeros(3))
    out[:3, 3] += rng.normal(0.0, translation_m, 3)
    return out


class HandEyeDraw:
    """Eye-in-hand, the target about 0.3 m before the camera, which turns about random axes by `turns_deg`."""

    def __init__(
        self, seed: int, n: int, turns_deg: tuple[float, float], outliers: int = 0, noise: float = 1.0
    ) -> None:
        rng = np.random.default_rng(seed)
        self.gripper_T_camera = pose(rng.normal(size=3), rng.uniform(-0.1, 0.1, 3))
        self.base_T_target = pose(rng.normal(size=3), rng.uniform(-0.3, 0.3, 3))
        first = pose(rng.normal(size=3), np.zeros(3))
        self.base_T_gripper, self.camera_T_target = np.empty((n, 4, 4)), np.empty((n, 4, 4))
        wrong = set(rng.choice(n, outliers, replace=False).tolist()) if outliers else set()
        for i in range(n):
            axis = rng.normal(size=3)
            turn = pose(axis / np.linalg.norm(axis) * rng.uniform(*turns_deg) * DEGREE, np.zeros(3))
            seen = pose(np.zeros(3), np.array([0.0, 0.0, 0.3]) + rng.normal(0, 0.02, 3)) @ turn @ first
            gripper = self.base_T_target @ np.linalg.inv(seen) @ np.linalg.inv(self.gripper_T_camera)
            if i in wrong:
                seen = spoilt(seen, rng, 5.0 * DEGREE, 0.01)
            self.base_T_gripper[i] = spoilt(gripper, rng, noise * 0.05 * DEGREE, noise * 0.1e-3)
            self.camera_T_target[i] = spoilt(seen, rng, noise * 0.1 * DEGREE, noise * 0.3e-3)
