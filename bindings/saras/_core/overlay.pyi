"""
What the surgeons see on the endoscope's images
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import saras._core
import saras._core.collision
import typing

__all__: list[str] = [
    "AwarenessInset",
    "AwarenessInsetStyle",
    "AwarenessView",
    "CameraConfig",
    "EyeSide",
    "FrozenWatch",
    "FrozenWatchConfig",
    "FrozenWatchOutput",
    "OverlayNotice",
    "OverlayPainter",
    "OverlayStyle",
    "OverlayTool",
    "PinholeEye",
    "StereoPairing",
    "StereoPairingConfig",
    "StereoPairingOutput",
    "StiffnessOverlay",
    "StiffnessOverlayStyle",
    "ToolMark",
    "ToolOverlay",
    "ToolOverlayConfig",
    "ToolOverlayOutput",
    "color_of",
    "draw_notice",
    "fingerprint",
    "stiffness_color",
]

class CameraConfig:
    """
    A calibrated camera, as sensor_msgs/CameraInfo and OpenCV have it.
    """

    _fields: typing.ClassVar[list] = ["width_px", "height_px", "K", "R", "P", "distortion", "rectified", "near_m"]
    def __copy__(self) -> CameraConfig: ...
    def __deepcopy__(self, arg0: dict) -> CameraConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        A calibrated camera, as sensor_msgs/CameraInfo and OpenCV have it.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def K(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) of the raw image [px]
        """
    @K.setter
    def K(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"]) -> None: ...
    @property
    def P(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 4]"]:
        """
        (3, 4) of the rectified image; the right eye's holds the baseline
        """
    @P.setter
    def P(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 4]"]) -> None: ...
    @property
    def R(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) rectified_R_raw
        """
    @R.setter
    def R(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"]) -> None: ...
    @property
    def distortion(self) -> typing.Annotated[list[float], "FixedSize(8)"]:
        """
        8 numbers: k1 k2 p1 p2 k3 (plumb_bob) k4 k5 k6 (rational_polynomial)
        """
    @distortion.setter
    def distortion(
        self,
        arg1: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(8)"],
    ) -> None: ...
    @property
    def height_px(self) -> int: ...
    @height_px.setter
    def height_px(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def near_m(self) -> float:
        """
        nothing nearer is drawn [m]
        """
    @near_m.setter
    def near_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rectified(self) -> bool:
        """
        drawn on are rectified images; else raw ones
        """
    @rectified.setter
    def rectified(self, arg1: bool) -> None: ...
    @property
    def width_px(self) -> int:
        """
        of the image that was calibrated
        """
    @width_px.setter
    def width_px(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class PinholeEye:
    """
    Points of the rectified left optical frame in the pixels of one eye.
    """
    def __init__(self, config: CameraConfig) -> None: ...
    def project(
        self, points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 2]"]:
        """
        (n, 2) pixels of (n, 3) points [m]; NaN: behind, too near, or beyond the lens model.
        """
    def project_line(
        self,
        a: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        b: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        margin_px: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 2, 3): both ends of each visible piece of the segment: column, row [px], depth [m].
        """
    @property
    def config(self) -> CameraConfig: ...

class FrozenWatchConfig:
    """
    When a picture counts as frozen.
    """

    _fields: typing.ClassVar[list] = ["frozen_after_s"]
    def __copy__(self) -> FrozenWatchConfig: ...
    def __deepcopy__(self, arg0: dict) -> FrozenWatchConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        When a picture counts as frozen.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def frozen_after_s(self) -> float:
        """
        the same picture for so long [s]
        """
    @frozen_after_s.setter
    def frozen_after_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FrozenWatchOutput:
    """
    Result of FrozenWatch.step.
    """

    _fields: typing.ClassVar[list] = ["frozen", "unchanged_s", "status"]
    frozen: bool
    def __copy__(self) -> FrozenWatchOutput: ...
    def __deepcopy__(self, arg0: dict) -> FrozenWatchOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of FrozenWatch.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def status(self) -> saras._core.Status:
        """
        STALE: frozen
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def unchanged_s(self) -> float:
        """
        since the picture changed [s]
        """
    @unchanged_s.setter
    def unchanged_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FrozenWatch:
    """
    Whether a camera gives the same picture again and again.
    """
    def __init__(self, config: FrozenWatchConfig = ...) -> None: ...
    def step(
        self, fingerprint: typing.SupportsInt | typing.SupportsIndex, dt: typing.SupportsFloat | typing.SupportsIndex
    ) -> FrozenWatchOutput:
        """
        One image; dt: since the one before [s].
        """

class EyeSide:
    """
    Whose image.

    Members:

      LEFT

      RIGHT

      NONE
    """

    LEFT: typing.ClassVar[EyeSide]
    NONE: typing.ClassVar[EyeSide]
    RIGHT: typing.ClassVar[EyeSide]
    __members__: typing.ClassVar[dict[str, EyeSide]]
    @typing.overload
    def __eq__(self, other: EyeSide) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: EyeSide) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class StereoPairingConfig:
    """
    Which two images are of one moment.
    """

    _fields: typing.ClassVar[list] = ["max_skew_s", "wait_s"]
    def __copy__(self) -> StereoPairingConfig: ...
    def __deepcopy__(self, arg0: dict) -> StereoPairingConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Which two images are of one moment.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def max_skew_s(self) -> float:
        """
        their stamps differ by no more [s]
        """
    @max_skew_s.setter
    def max_skew_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def wait_s(self) -> float:
        """
        so long an image waits for the other eye's [s]
        """
    @wait_s.setter
    def wait_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class StereoPairingOutput:
    """
    Which images leave now.
    """

    _fields: typing.ClassVar[list] = ["waiting_alone", "pair", "arrived_alone", "status"]
    def __copy__(self) -> StereoPairingOutput: ...
    def __deepcopy__(self, arg0: dict) -> StereoPairingOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Which images leave now.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def arrived_alone(self) -> bool:
        """
        the one that came is too old for the other eye's
        """
    @arrived_alone.setter
    def arrived_alone(self, arg1: bool) -> None: ...
    @property
    def pair(self) -> bool:
        """
        the one that came and the waiting one of the other eye
        """
    @pair.setter
    def pair(self, arg1: bool) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        STALE: one stays alone
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def waiting_alone(self) -> typing.Annotated[list[bool], "FixedSize(2)"]:
        """
        (left, right): the one that was waiting stays without a partner
        """
    @waiting_alone.setter
    def waiting_alone(self, arg1: typing.Annotated[collections.abc.Sequence[bool], "FixedSize(2)"]) -> None: ...

class StereoPairing:
    """
    Pairs the images of two eyes by their stamps.
    """
    def __init__(self, config: StereoPairingConfig = ...) -> None: ...
    def step(
        self,
        arrived: EyeSide,
        stamp_ns: typing.SupportsInt | typing.SupportsIndex,
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> StereoPairingOutput:
        """
        One image, or (NONE) only time; dt: since the last.
        """

class OverlayTool:
    """
    A tool as last heard of, in the world.
    """

    _fields: typing.ClassVar[list] = [
        "name",
        "tip",
        "trocar",
        "distance_m",
        "state",
        "known_distance_m",
        "on_tool",
        "on_partner",
    ]
    def __copy__(self) -> OverlayTool: ...
    def __deepcopy__(self, arg0: dict) -> OverlayTool: ...
    def __init__(self, **kwargs) -> None:
        """
        A tool as last heard of, in the world.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def distance_m(self) -> float:
        """
        to the nearest thing; NaN: unknown; inf: nothing there
        """
    @distance_m.setter
    def distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def known_distance_m(self) -> float:
        """
        between the two points; NaN: none
        """
    @known_distance_m.setter
    def known_distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def name(self) -> str:
        """
        as it is written on the image
        """
    @name.setter
    def name(self, arg1: str) -> None: ...
    @property
    def on_partner(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) and on what it is near to [m]
        """
    @on_partner.setter
    def on_partner(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def on_tool(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) nearest point on the tool [m]
        """
    @on_tool.setter
    def on_tool(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def state(self) -> saras._core.collision.ProximityState:
        """
        colliding_regions' own word
        """
    @state.setter
    def state(self, arg1: saras._core.collision.ProximityState) -> None: ...
    @property
    def tip(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]; NaN: unknown
        """
    @tip.setter
    def tip(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def trocar(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) remote centre [m]
        """
    @trocar.setter
    def trocar(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class ToolMark:
    """
    What is drawn of one tool, in the rectified left optical frame.
    """

    _fields: typing.ClassVar[list] = [
        "name",
        "level",
        "distance_m",
        "placed",
        "tip",
        "trocar",
        "witness",
        "on_tool",
        "on_partner",
    ]
    name: str
    def __copy__(self) -> ToolMark: ...
    def __deepcopy__(self, arg0: dict) -> ToolMark: ...
    def __init__(self, **kwargs) -> None:
        """
        What is drawn of one tool, in the rectified left optical frame.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def distance_m(self) -> float:
        """
        NaN: unknown
        """
    @distance_m.setter
    def distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def level(self) -> saras._core.collision.ProximityState:
        """
        its colour
        """
    @level.setter
    def level(self, arg1: saras._core.collision.ProximityState) -> None: ...
    @property
    def on_partner(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]
        """
    @on_partner.setter
    def on_partner(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def on_tool(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]
        """
    @on_tool.setter
    def on_tool(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def placed(self) -> bool:
        """
        tip and trocar are known
        """
    @placed.setter
    def placed(self, arg1: bool) -> None: ...
    @property
    def tip(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]
        """
    @tip.setter
    def tip(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def trocar(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]
        """
    @trocar.setter
    def trocar(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def witness(self) -> bool:
        """
        the two points are known and near
        """
    @witness.setter
    def witness(self, arg1: bool) -> None: ...

class ToolOverlayConfig:
    """
    Thresholds of the colours, and how old things may be.
    """

    _fields: typing.ClassVar[list] = [
        "collision_m",
        "warning_m",
        "hysteresis_m",
        "witness_below_m",
        "distances_timeout_s",
        "tools_timeout_s",
        "camera_timeout_s",
    ]
    def __copy__(self) -> ToolOverlayConfig: ...
    def __deepcopy__(self, arg0: dict) -> ToolOverlayConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Thresholds of the colours, and how old things may be.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def camera_timeout_s(self) -> float:
        """
        an older pose of the camera is unknown [s]
        """
    @camera_timeout_s.setter
    def camera_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def collision_m(self) -> float:
        """
        at most this far is red [m]
        """
    @collision_m.setter
    def collision_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def distances_timeout_s(self) -> float:
        """
        older distances are unknown [s]
        """
    @distances_timeout_s.setter
    def distances_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def hysteresis_m(self) -> float:
        """
        a colour is left this much further out [m]
        """
    @hysteresis_m.setter
    def hysteresis_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def tools_timeout_s(self) -> float:
        """
        older tools are unknown [s]
        """
    @tools_timeout_s.setter
    def tools_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def warning_m(self) -> float:
        """
        below it is yellow [m]
        """
    @warning_m.setter
    def warning_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def witness_below_m(self) -> float:
        """
        nearer than this the nearest points are shown [m]
        """
    @witness_below_m.setter
    def witness_below_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ToolOverlayOutput:
    """
    Result of ToolOverlay.step.
    """
    @property
    def camera_known(self) -> bool:
        """
        false: nothing is placed
        """
    @property
    def status(self) -> saras._core.Status:
        """
        STALE: some tool is unknown
        """
    @property
    def tools(self) -> list[ToolMark]:
        """
        a ToolMark each
        """

class ToolOverlay:
    """
    Green, yellow, red or grey for each tool. Unknown is never green.
    """
    def __init__(self, config: ToolOverlayConfig = ...) -> None: ...
    def reset(self) -> None: ...
    def step(
        self,
        tools: collections.abc.Sequence[OverlayTool],
        camera_T_world: numpy.typing.ArrayLike,
        distances_age_s: typing.SupportsFloat | typing.SupportsIndex,
        tools_age_s: typing.SupportsFloat | typing.SupportsIndex,
        camera_age_s: typing.SupportsFloat | typing.SupportsIndex,
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> ToolOverlayOutput:
        """
        One tick. tools: OverlayTool each; camera_T_world: (4, 4) into the rectified left optical frame; ages [s].
        """
    @property
    def config(self) -> ToolOverlayConfig: ...

class OverlayStyle:
    """
    How the overlay looks.
    """

    _fields: typing.ClassVar[list] = [
        "line_m",
        "least_line_px",
        "greatest_line_px",
        "ruler_step_m",
        "ruler_ticks",
        "text_height",
        "panel",
    ]
    def __copy__(self) -> OverlayStyle: ...
    def __deepcopy__(self, arg0: dict) -> OverlayStyle: ...
    def __init__(self, **kwargs) -> None:
        """
        How the overlay looks.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def greatest_line_px(self) -> float:
        """
        the other bound [px]
        """
    @greatest_line_px.setter
    def greatest_line_px(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def least_line_px(self) -> float:
        """
        bound of that, for an image 480 rows high [px]
        """
    @least_line_px.setter
    def least_line_px(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def line_m(self) -> float:
        """
        a shaft's line is as thick as this would look there [m]
        """
    @line_m.setter
    def line_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def panel(self) -> bool:
        """
        the list of all tools
        """
    @panel.setter
    def panel(self, arg1: bool) -> None: ...
    @property
    def ruler_step_m(self) -> float:
        """
        ticks along the shaft from the tip on [m]; 0: none
        """
    @ruler_step_m.setter
    def ruler_step_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def ruler_ticks(self) -> int:
        """
        how many
        """
    @ruler_ticks.setter
    def ruler_ticks(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def text_height(self) -> float:
        """
        of a capital, as a share of the image's height
        """
    @text_height.setter
    def text_height(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class OverlayNotice:
    """
    Why there is no overlay, or what is wrong with the picture.

    Members:

      NONE

      FROZEN

      OUT_OF_STEP

      NO_INTRINSICS

      SIZE_DIFFERS

      NO_CAMERA_POSE
    """

    FROZEN: typing.ClassVar[OverlayNotice]
    NONE: typing.ClassVar[OverlayNotice]
    NO_CAMERA_POSE: typing.ClassVar[OverlayNotice]
    NO_INTRINSICS: typing.ClassVar[OverlayNotice]
    OUT_OF_STEP: typing.ClassVar[OverlayNotice]
    SIZE_DIFFERS: typing.ClassVar[OverlayNotice]
    __members__: typing.ClassVar[dict[str, OverlayNotice]]
    @typing.overload
    def __eq__(self, other: OverlayNotice) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: OverlayNotice) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class OverlayPainter:
    """
    Draws what ToolOverlay says into the image of one eye.
    """
    def __init__(self, camera: CameraConfig, style: OverlayStyle = ...) -> None: ...
    def draw(self, tools: ToolOverlayOutput, image: numpy.typing.NDArray[numpy.uint8], encoding: str) -> bool:
        """
        Draws in place; False, and nothing drawn: the image is not of the camera's size.
        image: uint8 (height, width[, channels]); encoding: bgr8, rgb8, mono8, bgra8 or rgba8.
        """

class AwarenessInsetStyle:
    """
    How the inset of situational awareness looks.
    """

    _fields: typing.ClassVar[list] = [
        "width",
        "span_m",
        "azimuth_rad",
        "elevation_rad",
        "arrow_m_per_N",
        "least_force_N",
    ]
    def __copy__(self) -> AwarenessInsetStyle: ...
    def __deepcopy__(self, arg0: dict) -> AwarenessInsetStyle: ...
    def __init__(self, **kwargs) -> None:
        """
        How the inset of situational awareness looks.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def arrow_m_per_N(self) -> float:
        """
        length of the force's arrow [m/N]
        """
    @arrow_m_per_N.setter
    def arrow_m_per_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def azimuth_rad(self) -> float:
        """
        from where it is seen, about the base's z [rad]
        """
    @azimuth_rad.setter
    def azimuth_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def elevation_rad(self) -> float:
        """
        above the plane [rad]
        """
    @elevation_rad.setter
    def elevation_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def least_force_N(self) -> float:
        """
        no arrow below it [N]
        """
    @least_force_N.setter
    def least_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def span_m(self) -> float:
        """
        so wide is what it shows [m]
        """
    @span_m.setter
    def span_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def width(self) -> float:
        """
        as a share of the image's width
        """
    @width.setter
    def width(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class AwarenessView:
    """
    What the inset shows, in the slave's base; not finite: not known.
    """

    hold: bool
    region_closed: bool
    text: str
    def __init__(self) -> None: ...
    @property
    def center(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) middle of what is shown [m]
        """
    @center.setter
    def center(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def closest(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the model to the proxy, red [m]
        """
    @closest.setter
    def closest(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def force_N(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the hand [N]
        """
    @force_N.setter
    def force_N(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def known(self) -> bool:
        """
        else only a grey text
        """
    @known.setter
    def known(self, arg0: bool) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the model there
        """
    @normal.setter
    def normal(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def proxy(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) green [m]
        """
    @proxy.setter
    def proxy(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def region(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 3]"]:
        """
        (n, 3) corners [m], at most 64
        """
    @region.setter
    def region(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"]) -> None: ...
    @property
    def tip(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the slave, white [m]
        """
    @tip.setter
    def tip(self, arg0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class AwarenessInset:
    """
    Draws it bottom left, into images of one size.
    """
    def __init__(
        self,
        width_px: typing.SupportsInt | typing.SupportsIndex,
        height_px: typing.SupportsInt | typing.SupportsIndex,
        style: AwarenessInsetStyle = ...,
    ) -> None:
        """
        Raises ConfigError.
        """
    def draw(
        self,
        view: AwarenessView,
        image: numpy.typing.NDArray[numpy.uint8],
        encoding: str,
        dots: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 4]"] = ...,
    ) -> bool:
        """
        dots: (n, 4) of the stiffness map, x y z [m] and share 0 to 1, NaN: not known.
        False: the image is of another size.
        """
    def place(
        self, view: AwarenessView, point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[2, 1]"]:
        """
        (2,) pixel in the box of a point (3,).
        """
    @property
    def box(self) -> typing.Annotated[list[int], "FixedSize(4)"]:
        """
        (left, top, width, height) [px]
        """

class StiffnessOverlayStyle:
    """
    How the stiffness map looks on the organ.
    """

    _fields: typing.ClassVar[list] = ["low_N_m", "high_N_m", "opacity", "uncertain_std_N_m", "faint_opacity", "bar"]
    def __copy__(self) -> StiffnessOverlayStyle: ...
    def __deepcopy__(self, arg0: dict) -> StiffnessOverlayStyle: ...
    def __init__(self, **kwargs) -> None:
        """
        How the stiffness map looks on the organ.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def bar(self) -> bool:
        """
        the colour bar
        """
    @bar.setter
    def bar(self, arg1: bool) -> None: ...
    @property
    def faint_opacity(self) -> float:
        """
        of what is unsure, and of the grey of what is not known
        """
    @faint_opacity.setter
    def faint_opacity(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def high_N_m(self) -> float:
        """
        yellow end [N/m]
        """
    @high_N_m.setter
    def high_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def low_N_m(self) -> float:
        """
        dark end of the colours [N/m]
        """
    @low_N_m.setter
    def low_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def opacity(self) -> float:
        """
        where it is sure
        """
    @opacity.setter
    def opacity(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def uncertain_std_N_m(self) -> float:
        """
        such a deviation is as faint as what is not known [N/m]
        """
    @uncertain_std_N_m.setter
    def uncertain_std_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class StiffnessOverlay:
    """
    Draws the stiffness map over the organ in one eye's image: opacity says how sure.
    """
    def __init__(self, camera: CameraConfig, style: StiffnessOverlayStyle = ...) -> None:
        """
        Raises ConfigError.
        """
    def draw(
        self,
        vertices: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        stiffness: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        std: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        triangles: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 3]"],
        left_T_map: numpy.typing.ArrayLike,
        image: numpy.typing.NDArray[numpy.uint8],
        encoding: str,
    ) -> bool:
        """
        vertices (n, 3) [m], stiffness (n,) [N/m], std (n,) [N/m]; NaN or infinite: not known; triangles (m, 3);
        left_T_map (4, 4) to the rectified left optical frame. False: the image is of another size.
        """
    def draw_unknown(self, image: numpy.typing.NDArray[numpy.uint8], encoding: str) -> bool:
        """
        Says that there is no map. False: the image is of another size.
        """
    @property
    def bar(self) -> typing.Annotated[list[int], "FixedSize(4)"]:
        """
        (left, top, width, height) of the colour bar [px].
        """

def color_of(level: saras._core.collision.ProximityState) -> tuple[int, int, int, int]:
    """
    Red, green, blue, and what stands for them in mono8, each 0 to 255.
    """

def draw_notice(notice: OverlayNotice, image: numpy.typing.NDArray[numpy.uint8], encoding: str) -> None:
    """
    Writes a notice on an image, in place.
    """

def fingerprint(image: typing.Annotated[numpy.typing.ArrayLike, numpy.uint8], encoding: str) -> int:
    """
    A number that changes when any pixel does.
    """

def stiffness_color(share: typing.SupportsFloat | typing.SupportsIndex) -> tuple[int, int, int, int]:
    """
    Red, green, blue, and what stands for them in mono8; share: 0 softest, 1 stiffest, NaN grey.
    """
