"""The SARAS arm. Base frame ``mesa_*/sbs_world``, trocar ``mesa_*/rcm``, tip ``mesa_*/tool_tip``."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras._core.kinematics import MESA_NOMINAL_RCM, MESA_SHAFT_RADIUS_M, Chain, Joint, JointType, RcmArm

JOINT_NAMES = ("scara_1", "scara_2", "universal_1", "universal_2", "insertion", "roll")
"""Order of q everywhere. ROS puts the arm's name before it: ``mesa_left/scara_1``. The jaw is apart."""

PASSIVE_JOINT_NAMES = tuple(f"passive_{i}" for i in range(1, 8))
"""The positioning arm's joints, clamped by brakes."""

NOMINAL_RCM: npt.NDArray[np.float64] = np.array(MESA_NOMINAL_RCM)
"""(3,) trocar in sbs_world [m] around which the workspace is widest."""

HOME_DEPTH_M = 0.08
SHAFT_RADIUS_M: float = MESA_SHAFT_RADIUS_M

# The positioning arm, straight up at zero. config/mesa_geometry.yaml, `passive`.
PASSIVE_HEIGHT_M = (0.08, 0.10, 0.16, 0.16, 0.16, 0.14, 0.06)
PASSIVE_AXIS = "zyzyzyz"
PASSIVE_LIMIT_RAD = (2.9, 2.1, 2.9, 2.4, 2.9, 2.2, 3.1)
PASSIVE_FLANGE_HEIGHT_M = 0.05
PASSIVE_FLANGE_TO_BASE_M = 0.14


def arm() -> RcmArm:
    """The arm with the dimensions of config/mesa_geometry.yaml."""
    return RcmArm()


def home(
    rcm: npt.ArrayLike = NOMINAL_RCM, depth_m: float = HOME_DEPTH_M, elbow: float = 1.0
) -> npt.NDArray[np.float64]:
    """(6,) joints with a vertical shaft through rcm (3,) [m], the tip depth_m [m] below it, roll 0.

    elbow: sign of scara_2, either side of the line shoulder - universal joint.
    """
    trocar = np.asarray(rcm, dtype=float)
    near = np.array([0.0, elbow, 0.0, 0.0, 0.0, 0.0])
    q: npt.NDArray[np.float64] = arm().inverse_pivot(trocar - [0.0, 0.0, depth_m], 0.0, trocar, near)
    return q


def passive_chain() -> Chain:
    """The positioning arm, from ``mesa_*/passive_base`` to its last link ``base``, which is ``mesa_*/sbs_world``."""
    axes = {"y": np.array([0.0, 1.0, 0.0]), "z": np.array([0.0, 0.0, 1.0])}
    joints = [
        Joint(
            name=name,
            link=f"passive_link_{i}",
            type=JointType.REVOLUTE,
            parent_T_joint=_lifted(height),
            axis=axes[axis],
            lower=-limit,
            upper=limit,
        )
        for i, (name, height, axis, limit) in enumerate(
            zip(PASSIVE_JOINT_NAMES, PASSIVE_HEIGHT_M, PASSIVE_AXIS, PASSIVE_LIMIT_RAD), start=1
        )
    ]
    joints.append(Joint(name="passive_flange", link="flange", parent_T_joint=_lifted(PASSIVE_FLANGE_HEIGHT_M)))
    upside_down = _lifted(PASSIVE_FLANGE_TO_BASE_M) @ np.diag([1.0, -1.0, -1.0, 1.0])
    joints.append(Joint(name="flange_to_base", link="base", parent_T_joint=upside_down))
    return Chain(joints)


def _lifted(height_m: float) -> npt.NDArray[np.float64]:
    pose = np.eye(4)
    pose[2, 3] = height_m
    return pose


__all__ = [
    "HOME_DEPTH_M",
    "JOINT_NAMES",
    "NOMINAL_RCM",
    "PASSIVE_JOINT_NAMES",
    "SHAFT_RADIUS_M",
    "arm",
    "home",
    "passive_chain",
]
