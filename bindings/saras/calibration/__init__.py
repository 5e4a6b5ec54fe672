"""One world: where the arms' bases, the board and the endoscope are, and how well that is known.

Poses ``a_T_b`` are (4, 4), lengths in m. Uncertainties are (6, 6) covariances of
``saras.displacement(estimate, truth)``: translation [m], then rotation vector [rad]. Measurements that nothing may be
made from raise CalibrationError.
"""

from saras._core.calibration import FrameFromPoints, frame_from_points, frame_from_three_points
from saras.calibration.board import Board, board
from saras.calibration.hand_eye import HandEye, HandEyeNoise, hand_eye, rotation_spread

__all__ = [
    "Board",
    "FrameFromPoints",
    "HandEye",
    "HandEyeNoise",
    "board",
    "frame_from_points",
    "frame_from_three_points",
    "hand_eye",
    "rotation_spread",
]
