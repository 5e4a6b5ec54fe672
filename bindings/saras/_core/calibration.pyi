"""
Base frames from touched dots, hand-eye, the board
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "BoardConfig",
    "FrameFromPoints",
    "HandEye",
    "HandEyeNoise",
    "dot_centers",
    "frame_from_points",
    "frame_from_three_points",
    "hand_eye",
    "marker_corners",
    "rotation_spread",
]

class BoardConfig:
    """
    Dots on a circle for the arms to touch, ArUco markers on a concentric one for the endoscope.
    """

    _fields: typing.ClassVar[list] = [
        "dot_circle_radius_m",
        "dot_diameter_m",
        "dot_angles_deg",
        "marker_circle_radius_m",
        "marker_side_m",
        "marker_angles_deg",
    ]
    def __copy__(self) -> BoardConfig: ...
    def __deepcopy__(self, arg0: dict) -> BoardConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Dots on a circle for the arms to touch, ArUco markers on a concentric one for the endoscope.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def dot_angles_deg(self) -> list[float]:
        """
        increasing and uneven, so that a wrong order shows [deg]
        """
    @dot_angles_deg.setter
    def dot_angles_deg(self, arg1: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]) -> None: ...
    @property
    def dot_circle_radius_m(self) -> float:
        """
        circle of the dots' centres [m]
        """
    @dot_circle_radius_m.setter
    def dot_circle_radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dot_diameter_m(self) -> float:
        """
        [m]
        """
    @dot_diameter_m.setter
    def dot_diameter_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def marker_angles_deg(self) -> list[float]:
        """
        [deg]
        """
    @marker_angles_deg.setter
    def marker_angles_deg(
        self, arg1: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex]
    ) -> None: ...
    @property
    def marker_circle_radius_m(self) -> float:
        """
        circle of the markers' centres [m]
        """
    @marker_circle_radius_m.setter
    def marker_circle_radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def marker_side_m(self) -> float:
        """
        edge of the black square [m]
        """
    @marker_side_m.setter
    def marker_side_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FrameFromPoints:
    """
    Where a board lies in an arm's base frame.
    """
    @property
    def base_T_board(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @property
    def covariance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6, 6) of saras.displacement(estimate, truth): [m, rad], in the base's axes, at the board's origin
        """
    @property
    def residuals(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) touched - fitted, in the base's frame [m]
        """
    @property
    def rms_m(self) -> float:
        """
        root mean square length of the residuals [m]
        """
    @property
    def spread_m(self) -> float:
        """
        conditioning: RMS extent of the dots across their best line [m]
        """

class HandEyeNoise:
    """
    Expected errors per axis; their ratios weigh, common factors are estimated.
    """

    _fields: typing.ClassVar[list] = [
        "robot_rotation_rad",
        "robot_translation_m",
        "camera_rotation_rad",
        "camera_translation_m",
    ]
    def __copy__(self) -> HandEyeNoise: ...
    def __deepcopy__(self, arg0: dict) -> HandEyeNoise: ...
    def __init__(self, **kwargs) -> None:
        """
        Expected errors per axis; their ratios weigh, common factors are estimated.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def camera_rotation_rad(self) -> float:
        """
        [rad]
        """
    @camera_rotation_rad.setter
    def camera_rotation_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def camera_translation_m(self) -> float:
        """
        [m]
        """
    @camera_translation_m.setter
    def camera_translation_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def robot_rotation_rad(self) -> float:
        """
        [rad]
        """
    @robot_rotation_rad.setter
    def robot_rotation_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def robot_translation_m(self) -> float:
        """
        [m]
        """
    @robot_translation_m.setter
    def robot_translation_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class HandEye:
    """
    Where the camera sits, how well that is known, and what each pair says.
    """
    @property
    def base_T_target(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4); eye-to-hand: gripper_T_target
        """
    @property
    def covariance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6, 6) of saras.displacement(estimate, truth) of gripper_T_camera: [m, rad], in the gripper's axes
        """
    @property
    def gripper_T_camera(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4); eye-to-hand: base_T_camera
        """
    @property
    def residuals(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) saras.displacement(base_T_target, what each pair says): [m, rad]
        """
    @property
    def rms_m(self) -> float:
        """
        of the used residuals' lengths [m]
        """
    @property
    def rms_rad(self) -> float:
        """
        of the used residuals' angles [rad]
        """
    @property
    def rotation_noise(self) -> float:
        """
        estimated noise of rotations, times what was expected
        """
    @property
    def spread_rad(self) -> float:
        """
        conditioning: second RMS extent of the relative rotations [rad]
        """
    @property
    def target_covariance(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6, 6) the same of base_T_target, in the base's axes
        """
    @property
    def time_offset_s(self) -> float:
        """
        correction to the offset that base_T_gripper already has [s]
        """
    @property
    def time_offset_std_s(self) -> float:
        """
        its standard deviation [s]
        """
    @property
    def translation_noise(self) -> float:
        """
        the same of translations
        """
    @property
    def used(self) -> list[bool]:
        """
        n flags; False: a gross error that was left out
        """

def dot_centers(config: BoardConfig) -> numpy.typing.NDArray[numpy.float64]:
    """
    (n, 3) centres of the dots in the board's frame [m]. Raises ConfigError.
    """

def frame_from_points(
    touched: typing.Any,
    board_points: typing.Any,
    above: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] | None = None,
    touch_noise_m: typing.SupportsFloat | typing.SupportsIndex = 0.0005,
    max_rms_m: typing.SupportsFloat | typing.SupportsIndex = 0.002,
    min_spread_m: typing.SupportsFloat | typing.SupportsIndex = 0.02,
) -> FrameFromPoints:
    """
    Rigid least squares (Kabsch) of touched points (n, 3) in the base's frame [m] to the same dots (n, 3) on the
    board [m]; a dot may come more than once. above: (3,) a point on the printed side in the base's frame (the
    trocar). touch_noise_m: expected error per axis. Raises CalibrationError: fewer than 3 different dots, collinear
    (min_spread_m), another unit, another order, a touch that does not fit (max_rms_m), board seen from behind.
    """

def frame_from_three_points(touched: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
    """
    The source document's construction, for comparison: (4, 4) with its origin in the circumcentre of three touched
    dots (3, 3) [m], x to the first, z along (second - first) x (third - first). Raises CalibrationError.
    """

def hand_eye(
    base_T_gripper: typing.Any,
    camera_T_target: typing.Any,
    *,
    eye_to_hand: bool = False,
    noise: HandEyeNoise = ...,
    robust: bool = True,
    initial: numpy.typing.ArrayLike | None = None,
    allow_repeats: bool = False,
    min_spread_rad: typing.SupportsFloat | typing.SupportsIndex = 0.035,
    max_rms_m: typing.SupportsFloat | typing.SupportsIndex = 0.02,
    max_rms_rad: typing.SupportsFloat | typing.SupportsIndex = 0.1,
    gripper_twist: typing.Any = None,
    groups: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
) -> HandEye:
    """
    A X = X B by joint maximum likelihood over camera and target, robust against gross errors.

    base_T_gripper, camera_T_target: (n, 4, 4), n >= 3. eye_to_hand: the camera stands in the base and sees a target
    on the gripper. initial: (4, 4) to start from instead of the linear solution. gripper_twist: (n, 6) in the base's
    axes [m/s, rad/s]; with it a time offset is estimated too. groups: n numbers; neighbours in a stream share one,
    and the covariance then comes from the spread between groups.
    Raises CalibrationError: fewer than 3 pairs, repeats, parallel axes (min_spread_rad, names the spread), implausible
    units, pairs that fit no rigid mounting (max_rms_m, max_rms_rad).
    """

def marker_corners(config: BoardConfig) -> numpy.typing.NDArray[numpy.float64]:
    """
    (n, 4, 3) corners in the board's frame [m]: upper left, upper right, lower right, lower left, as detectors give
    them; a marker's upper edge is towards the board's +y. Raises ConfigError.
    """

def rotation_spread(poses: typing.Any) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
    """
    (3,) RMS extents [rad] of all relative rotations of (n, 4, 4), largest first.
    """
