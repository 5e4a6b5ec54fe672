"""ViSP's hand-eye solver (GPL-2.0-or-later), where the build found ViSP."""

from collections.abc import Sequence

import numpy
import numpy.typing

def hand_eye(
    base_T_gripper: Sequence[numpy.typing.ArrayLike], camera_T_target: Sequence[numpy.typing.ArrayLike]
) -> numpy.typing.NDArray[numpy.float64]: ...
