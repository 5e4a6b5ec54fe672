"""One world: where the arms' bases, the board and the endoscope are, and how well that is known.

Poses ``a_T_b`` are (4, 4), lengths in m. Uncertainties are (6, 6) covariances of
``saras.displacement(estimate, truth)``: translation [m], then rotation vector [rad]. Measurements that nothing may be
made from raise CalibrationError.
"""

from saras._core.calibration import FrameFromPoints, frame_from_points, frame_from_three_points
from saras.calibration.board import Board, board
from saras.calibration.calibration_file import BaseFrame, Calibration
from saras.calibration.hand_eye import HandEye, HandEyeNoise, hand_eye, rotation_spread
from saras.calibration.registration import Arm, Registration, View
from saras.calibration.stereo import Charuco, Checkerboard, Stereo, stereo

__all__ = [
    "Arm",
    "BaseFrame",
    "Board",
    "Calibration",
    "Charuco",
    "Checkerboard",
    "FrameFromPoints",
    "HandEye",
    "HandEyeNoise",
    "Registration",
    "Stereo",
    "View",
    "board",
    "frame_from_points",
    "frame_from_three_points",
    "hand_eye",
    "rotation_spread",
    "stereo",
]
