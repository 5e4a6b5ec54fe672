"""The da Vinci's master arm as the dVRK knows it: seven joints, the gripper apart. Base: where its first axes meet."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras._core.kinematics import Chain, Joint, JointType

JOINT_NAMES = (
    "outer_yaw",
    "shoulder_pitch",
    "elbow_pitch",
    "wrist_platform",
    "wrist_pitch",
    "wrist_yaw",
    "wrist_roll",
)
"""Order of q everywhere."""

# Standard Denavit-Hartenberg, after the dVRK's user guide: alpha, a, d, offset; limits in degrees, of the left one.
_HALF = np.pi / 2.0
_ROWS = (
    (_HALF, 0.0, 0.0, -_HALF, (-40.0, 65.0)),
    (0.0, 0.2794, 0.0, -_HALF, (-15.0, 50.0)),
    (-_HALF, 0.3645, 0.0, _HALF, (-50.0, 35.0)),
    (_HALF, 0.0, 0.1506, 0.0, (-200.0, 90.0)),
    (-_HALF, 0.0, 0.0, 0.0, (-90.0, 180.0)),
    (_HALF, 0.0, 0.0, -_HALF, (-45.0, 45.0)),
    (0.0, 0.0, 0.0, _HALF, (-480.0, 450.0)),
)

HOME: npt.NDArray[np.float64] = np.array([0.0, 0.3, 0.0, 0.0, 1.2, 0.0, 0.0])
"""(7,) joints in the middle of the workspace, away from singularities."""


def joints() -> list[Joint]:
    """Joints and links up to the gripper's centre."""
    made = []
    before = np.eye(4)
    for name, (alpha, a, d, offset, (lower, upper)) in zip(JOINT_NAMES, _ROWS):
        made.append(
            Joint(
                name=name,
                link=f"{name}_link",
                type=JointType.REVOLUTE,
                parent_T_joint=before @ _turned("z", offset),
                axis=np.array([0.0, 0.0, 1.0]),
                lower=float(np.deg2rad(lower)),
                upper=float(np.deg2rad(upper)),
            )
        )
        before = _moved([a, 0.0, d]) @ _turned("x", alpha)
    return made


def chain() -> Chain:
    """The arm as a Chain."""
    return Chain(joints())


def _turned(axis: str, angle: float) -> npt.NDArray[np.float64]:
    pose = np.eye(4)
    c, s = np.cos(angle), np.sin(angle)
    i, j = (1, 2) if axis == "x" else (0, 1)
    pose[i, i], pose[i, j], pose[j, i], pose[j, j] = c, -s, s, c
    return pose


def _moved(by: list[float]) -> npt.NDArray[np.float64]:
    pose = np.eye(4)
    pose[:3, 3] = by
    return pose


__all__ = ["HOME", "JOINT_NAMES", "chain", "joints"]
