"""The SARAS arm. Base frame ``mesa_*/sbs_world``, trocar ``mesa_*/rcm``, tip ``mesa_*/tool_tip``."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras._core.kinematics import MESA_NOMINAL_RCM, RcmArm

JOINT_NAMES = ("scara_1", "scara_2", "universal_1", "universal_2", "insertion", "roll")
"""Order of q everywhere. ROS puts the arm's name before it: ``mesa_left/scara_1``. The jaw is apart."""

PASSIVE_JOINT_NAMES = tuple(f"passive_{i}" for i in range(1, 8))
"""The positioning arm's joints, clamped by brakes."""

NOMINAL_RCM: npt.NDArray[np.float64] = np.array(MESA_NOMINAL_RCM)
"""(3,) trocar in sbs_world [m] around which the workspace is widest."""

HOME_DEPTH_M = 0.08


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


__all__ = ["HOME_DEPTH_M", "JOINT_NAMES", "NOMINAL_RCM", "PASSIVE_JOINT_NAMES", "arm", "home"]
