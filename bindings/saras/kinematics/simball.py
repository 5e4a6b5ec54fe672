"""The console's hand piece (Simball) and the Touch that carries it.

Frames ``touchball_*/simball_base`` (pivot, z up, x away from the operator), ``touchball_*/touch_base``
(z up, x towards the operator) and ``touchball_*/handle``. The Touch is drawn with dimensions of our own.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from saras._core.kinematics import SimballHandle

Array = npt.NDArray[np.float64]

JOINT_NAMES = ("yaw", "pitch", "roll", "insertion")
"""Order of q everywhere. ROS puts the console's name before it: ``touchball_left/yaw``."""

TOUCH_JOINT_NAMES = (
    "touch_waist",
    "touch_shoulder",
    "touch_elbow",
    "touch_gimbal_1",
    "touch_gimbal_2",
    "touch_gimbal_3",
)

TOUCH_SHOULDER_HEIGHT_M = 0.12
TOUCH_UPPER_ARM_M = 0.18
TOUCH_FOREARM_M = 0.20
SIMBALL_T_TOUCH_BASE: Array = np.array(
    [[-1.0, 0.0, 0.0, 0.20], [0.0, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, -0.06], [0.0, 0.0, 0.0, 1.0]]
)
"""(4, 4) as in config/scene.yaml: the Touch stands behind the pivot and faces the operator."""


def handle() -> SimballHandle:
    """The hand piece with the dimensions of config/mesa_geometry.yaml."""
    return SimballHandle()


def touch_joints_from_handle(simball_T_handle: npt.ArrayLike, simball_T_touch: Array = SIMBALL_T_TOUCH_BASE) -> Array:
    """(6,) joints [rad] of the Touch whose gimbal holds the handle (4, 4). For drawing only.

    Beyond its reach the Touch points at the handle. Raises ValueError when the pose is not finite.
    """
    touch_T_handle = np.linalg.inv(simball_T_touch) @ np.asarray(simball_T_handle, dtype=float)
    if not np.isfinite(touch_T_handle).all():
        raise ValueError("simball_T_handle: must be finite")
    x, y, z = touch_T_handle[:3, 3]
    waist = math.atan2(y, x)
    radius, height = math.hypot(x, y), z - TOUCH_SHOULDER_HEIGHT_M
    upper, fore = TOUCH_UPPER_ARM_M, TOUCH_FOREARM_M
    cosine = (radius**2 + height**2 - upper**2 - fore**2) / (2.0 * upper * fore)
    elbow = -math.acos(min(1.0, max(-1.0, cosine)))  # elbow up
    shoulder = math.atan2(height, radius) - math.atan2(fore * math.sin(elbow), upper + fore * math.cos(elbow))
    fore_R_handle = (_rot_z(waist) @ _rot_y(-(shoulder + elbow))).T @ touch_T_handle[:3, :3]
    # Rx(g1) Ry(g2) Rz(g3)
    gimbal_1 = math.atan2(-fore_R_handle[1, 2], fore_R_handle[2, 2])
    gimbal_2 = math.asin(min(1.0, max(-1.0, fore_R_handle[0, 2])))
    gimbal_3 = math.atan2(-fore_R_handle[0, 1], fore_R_handle[0, 0])
    return np.array([waist, shoulder, elbow, gimbal_1, gimbal_2, gimbal_3])


def _rot_z(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def _rot_y(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


__all__ = [
    "JOINT_NAMES",
    "SIMBALL_T_TOUCH_BASE",
    "TOUCH_FOREARM_M",
    "TOUCH_JOINT_NAMES",
    "TOUCH_SHOULDER_HEIGHT_M",
    "TOUCH_UPPER_ARM_M",
    "handle",
    "touch_joints_from_handle",
]
