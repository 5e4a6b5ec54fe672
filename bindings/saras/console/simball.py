"""The Simball hand piece as the console uses it: one kinematic model, the home pose, how the Touch stands to it."""

from __future__ import annotations

import numpy as np

from saras.console.arrays import Array
from saras.kinematics import SimballHandle
from saras.kinematics.simball import SIMBALL_T_TOUCH_BASE

HANDLE = SimballHandle()

#: The handle upright in the middle of its range: motions start here, calibration zeroes here. [rad], insertion [m]
HOME_JOINTS = np.array([0.0, 0.0, 0.0, 0.06])
SIMBALL_T_HOME = HANDLE.forward(HOME_JOINTS)

#: (3, 3) turns vectors of simball_base into the frame of the wrench. The laws have the same default.
TOUCH_R_SIMBALL: Array = SIMBALL_T_TOUCH_BASE[:3, :3].T.copy()
