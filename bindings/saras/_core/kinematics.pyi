"""
Chains, the SARAS arm, the da Vinci
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import typing

__all__: list[str] = [
    "Chain",
    "DvrkTool",
    "Ecm",
    "EcmConfig",
    "Joint",
    "JointType",
    "MESA_NOMINAL_RCM",
    "MESA_SHAFT_RADIUS_M",
    "Psm",
    "PsmConfig",
    "RcmArm",
    "RcmArmConfig",
    "SimballHandle",
    "SimballHandleConfig",
    "dvrk_ecm_config",
    "dvrk_find_tool",
    "dvrk_psm_config",
    "dvrk_tools",
]

class JointType:
    """
    How a joint moves.

    Members:

      FIXED

      REVOLUTE

      PRISMATIC
    """

    FIXED: typing.ClassVar[JointType]
    PRISMATIC: typing.ClassVar[JointType]
    REVOLUTE: typing.ClassVar[JointType]
    __members__: typing.ClassVar[dict[str, JointType]]
    @typing.overload
    def __eq__(self, other: JointType) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: JointType) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class Joint:
    """
    One joint of a Chain and the link behind it, as in URDF.
    """

    _fields: typing.ClassVar[list] = ["name", "link", "type", "parent_T_joint", "axis", "lower", "upper"]
    def __copy__(self) -> Joint: ...
    def __deepcopy__(self, arg0: dict) -> Joint: ...
    def __init__(self, **kwargs) -> None:
        """
        One joint of a Chain and the link behind it, as in URDF.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def axis(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit vector in the joint's frame
        """
    @axis.setter
    def axis(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def link(self) -> str:
        """
        name of the link that the joint moves
        """
    @link.setter
    def link(self, arg1: str) -> None: ...
    @property
    def lower(self) -> float:
        """
        lower limit [rad or m]
        """
    @lower.setter
    def lower(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def name(self) -> str:
        """
        name of the joint
        """
    @name.setter
    def name(self, arg1: str) -> None: ...
    @property
    def parent_T_joint(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) in the frame of the link before it
        """
    @parent_T_joint.setter
    def parent_T_joint(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def type(self) -> JointType:
        """
        JointType
        """
    @type.setter
    def type(self, arg1: JointType) -> None: ...
    @property
    def upper(self) -> float:
        """
        upper limit [rad or m]
        """
    @upper.setter
    def upper(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Chain:
    """
    A serial chain of fixed, revolute and prismatic joints (Orocos KDL).
    """
    def __init__(self, joints: collections.abc.Sequence[Joint]) -> None: ...
    def check_limits(self, q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]) -> None:
        """
        Raises KinematicsError naming the first joint beyond its limits.
        """
    def forward(
        self, q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"], link: str = ""
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_link of the last link, or of a named one. q: (n,) moving joints [rad or m].
        Raises KinematicsError for a wrong length, a joint that is not finite, an unknown link.
        """
    def jacobian(
        self, q: typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (6, n) twist of the last link's origin in the base frame, linear first, from joint rates.
        """
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (n, 2) lower, upper [rad or m]
        """

class RcmArmConfig:
    """
    Dimensions and limits of a SARAS arm; defaults: mesa_geometry.hpp.
    """

    _fields: typing.ClassVar[list] = [
        "scara_link_1_m",
        "scara_link_2_m",
        "tip_offset_m",
        "instrument_m",
        "minimum_depth_m",
        "lower",
        "upper",
        "speed",
    ]
    def __copy__(self) -> RcmArmConfig: ...
    def __deepcopy__(self, arg0: dict) -> RcmArmConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Dimensions and limits of a SARAS arm; defaults: mesa_geometry.hpp.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def instrument_m(self) -> float:
        """
        adapter flange to tip [m]
        """
    @instrument_m.setter
    def instrument_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) lower joint limits [rad], insertion [m]
        """
    @lower.setter
    def lower(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def minimum_depth_m(self) -> float:
        """
        least distance from trocar to tip [m]
        """
    @minimum_depth_m.setter
    def minimum_depth_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def scara_link_1_m(self) -> float:
        """
        shoulder to elbow [m]
        """
    @scara_link_1_m.setter
    def scara_link_1_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def scara_link_2_m(self) -> float:
        """
        elbow to universal joint [m]
        """
    @scara_link_2_m.setter
    def scara_link_2_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) speed limits [rad/s], insertion [m/s]
        """
    @speed.setter
    def speed(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def tip_offset_m(self) -> float:
        """
        universal joint to tip at insertion = 0 [m]
        """
    @tip_offset_m.setter
    def tip_offset_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) upper joint limits [rad], insertion [m]
        """
    @upper.setter
    def upper(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...

class RcmArm:
    """
    The SARAS endoscope robot. q = [scara_1, scara_2, universal_1, universal_2, insertion, roll] [rad], insertion [m];
    poses and points are in sbs_world (z up, universal joint in z = 0, trocar below).
    """
    def __init__(self, config: RcmArmConfig = ...) -> None: ...
    def chain(self) -> Chain:
        """
        The same mechanism as a Chain, with the links of the URDF.
        """
    def forward(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tip; +z along the shaft from trocar to tip.
        """
    def inverse(
        self, base_T_tip: numpy.typing.ArrayLike, q0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) joints for a (4, 4) pose, elbow on the side of q0. Raises KinematicsError naming joint, value, bound.
        """
    def inverse_parallel(
        self,
        tip_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        roll: typing.SupportsFloat | typing.SupportsIndex,
        q0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) joints with the tip at a point (3,) [m] and the universal joint as in q0.
        """
    def inverse_pivot(
        self,
        tip_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        roll: typing.SupportsFloat | typing.SupportsIndex,
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        q0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) joints with the tip at a point (3,) [m], the shaft through rcm (3,) [m], the roll joint at roll [rad].
        Elbow on the side of q0. Raises KinematicsError naming quantity, value, bound.
        """
    def jacobian(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 6]"]:
        """
        (6, 6) twist of the tip in the base frame, linear first, from joint rates.
        """
    def limit_violation(self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> str:
        """
        First joint beyond its limits with value and bounds; '' when none.
        """
    def pivot_jacobian(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 4]"] | None:
        """
        (6, 4) joint rates from (tip velocity [m/s], angular velocity about the shaft [rad/s]) that keep the
        shaft through rcm; None near a singularity.
        """
    def pivot_pose(
        self, base_T_tip: numpy.typing.ArrayLike, rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        The (4, 4) pose turned the least so that its shaft passes rcm; None nearer than minimum_depth_m.
        """
    def rcm_deviation(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"],
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> float:
        """
        Distance of the shaft's line from the trocar [m].
        """
    def reachable(
        self,
        tip_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> bool:
        """
        Whether the tip can be at a point (3,) with the shaft through rcm.
        """
    def universal_position(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) centre of the universal joint [m].
        """
    def unreachable(
        self,
        tip_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> str:
        """
        What keeps the tip from a point with the shaft through rcm: quantity, value, bounds; '' when reachable.
        """
    @property
    def config(self) -> RcmArmConfig: ...
    @property
    def joint_names(self) -> typing.Any: ...
    @property
    def limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 2]"]:
        """
        (6, 2) lower, upper [rad], insertion [m]
        """

class SimballHandleConfig:
    """
    Dimensions and limits of a hand piece.
    """

    _fields: typing.ClassVar[list] = ["handle_distance_m", "lower", "upper"]
    def __copy__(self) -> SimballHandleConfig: ...
    def __deepcopy__(self, arg0: dict) -> SimballHandleConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Dimensions and limits of a hand piece.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def handle_distance_m(self) -> float:
        """
        pivot to handle at insertion = 0 [m]
        """
    @handle_distance_m.setter
    def handle_distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) lower limits [rad], insertion [m]
        """
    @lower.setter
    def lower(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) upper limits [rad], insertion [m]
        """
    @upper.setter
    def upper(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...

class SimballHandle:
    """
    The console's hand piece. q = [yaw, pitch, roll, insertion] [rad], insertion [m];
    simball_base: origin in the pivot, z up; handle: +z along the shaft to the pivot.
    """
    def __init__(self, config: SimballHandleConfig = ...) -> None: ...
    def check_limits(self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None:
        """
        Raises KinematicsError naming the first joint beyond its limits, its value, the bounds.
        """
    def clamp(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) nearest joints inside the limits.
        """
    def forward(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) simball_T_handle.
        """
    def inverse(
        self, simball_T_handle: numpy.typing.ArrayLike
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"] | None:
        """
        (4,) joints of a (4, 4) pose, limits not applied; None when not above the pivot.
        """
    def inverse_position(
        self,
        handle_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        roll: typing.SupportsFloat | typing.SupportsIndex,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"] | None:
        """
        (4,) joints of a point (3,) [m] and roll [rad], limits not applied; None when not above the pivot.
        """
    def jacobian(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 4]"]:
        """
        (6, 4) twist of the handle in simball_base, linear first, from joint rates.
        """
    @property
    def config(self) -> SimballHandleConfig: ...
    @property
    def joint_names(self) -> typing.Any: ...
    @property
    def limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 2]"]:
        """
        (4, 2) lower, upper [rad], insertion [m]
        """

class PsmConfig:
    """
    Dimensions and limits of a PSM; defaults: Classic body, 400006.
    """

    _fields: typing.ClassVar[list] = ["insertion_offset_m", "tool_length_m", "wrist_offset_m", "lower", "upper"]
    def __copy__(self) -> PsmConfig: ...
    def __deepcopy__(self, arg0: dict) -> PsmConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Dimensions and limits of a PSM; defaults: Classic body, 400006.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def insertion_offset_m(self) -> float:
        """
        carriage at insertion 0 behind the centre [m]
        """
    @insertion_offset_m.setter
    def insertion_offset_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) lower limits [rad], insertion [m]
        """
    @lower.setter
    def lower(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def tool_length_m(self) -> float:
        """
        DH d of the roll row [m]
        """
    @tool_length_m.setter
    def tool_length_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) upper limits [rad], insertion [m]
        """
    @upper.setter
    def upper(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def wrist_offset_m(self) -> float:
        """
        wrist pitch axis to wrist yaw axis [m]
        """
    @wrist_offset_m.setter
    def wrist_offset_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Psm:
    """
    The da Vinci's patient side manipulator. q = [yaw, pitch, insertion, roll, wrist_pitch, wrist_yaw]
    [rad], insertion [m]; the base frame's origin is the remote centre, its -z the shaft at zero.
    """
    def __init__(self, config: PsmConfig = ...) -> None: ...
    def forward(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tip. Raises KinematicsError naming the joint that is not finite.
        """
    def inverse(
        self, base_T_tip: numpy.typing.ArrayLike, q0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) joints of a (4, 4) pose inside the limits, nearest to q0 (6,), closed form.
        Raises KinematicsError naming joint, value, bounds.
        """
    def jacobian(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 6]"]:
        """
        (6, 6) twist of the tip in the base frame, linear first, from joint rates.
        """
    def limit_violation(self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> str:
        """
        First joint beyond its limits with value and bounds; '' when none.
        """
    def shaft(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit vector from the remote centre along the shaft.
        """
    def wrist_position(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) end of the straight shaft, in the base [m].
        """
    @property
    def config(self) -> PsmConfig: ...
    @property
    def joint_names(self) -> typing.Any: ...
    @property
    def limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 2]"]:
        """
        (6, 2) lower, upper [rad], insertion [m]
        """

class EcmConfig:
    """
    Dimensions and limits of an ECM; defaults: Classic body, straight endoscope.
    """

    _fields: typing.ClassVar[list] = ["insertion_offset_m", "endoscope_length_m", "view_angle_rad", "lower", "upper"]
    def __copy__(self) -> EcmConfig: ...
    def __deepcopy__(self, arg0: dict) -> EcmConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Dimensions and limits of an ECM; defaults: Classic body, straight endoscope.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def endoscope_length_m(self) -> float:
        """
        DH d of the roll row [m]
        """
    @endoscope_length_m.setter
    def endoscope_length_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def insertion_offset_m(self) -> float:
        """
        carriage at insertion 0 behind the centre [m]
        """
    @insertion_offset_m.setter
    def insertion_offset_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) lower limits [rad], insertion [m]
        """
    @lower.setter
    def lower(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) upper limits [rad], insertion [m]
        """
    @upper.setter
    def upper(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...
    @property
    def view_angle_rad(self) -> float:
        """
        lens about x, down positive [rad]
        """
    @view_angle_rad.setter
    def view_angle_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class Ecm:
    """
    The da Vinci's endoscope manipulator. q = [yaw, pitch, insertion, roll] [rad], insertion [m];
    the base frame's origin is the remote centre, its -z the shaft at zero.
    """
    def __init__(self, config: EcmConfig = ...) -> None: ...
    def forward(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tip. Raises KinematicsError naming the joint that is not finite.
        """
    def inverse(
        self,
        base_T_tip: numpy.typing.ArrayLike,
        q0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"],
        rotation_tolerance_rad: typing.SupportsFloat | typing.SupportsIndex = 1e-06,
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) joints that reach the point of a (4, 4) pose with the roll that comes nearest to its rotation.
        Four joints cannot reach every rotation: what remains must be within rotation_tolerance_rad (pi takes
        any). Raises KinematicsError naming joint or rotation, value, bounds.
        """
    def jacobian(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 4]"]:
        """
        (6, 4) twist of the tip in the base frame, linear first, from joint rates.
        """
    def limit_violation(self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> str:
        """
        First joint beyond its limits with value and bounds; '' when none.
        """
    def rotation_error(
        self, base_T_tip: numpy.typing.ArrayLike, q0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> float:
        """
        Rotation that inverse would leave [rad].
        """
    def shaft(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit vector from the remote centre along the endoscope.
        """
    @property
    def config(self) -> EcmConfig: ...
    @property
    def joint_names(self) -> typing.Any: ...
    @property
    def limits(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 2]"]:
        """
        (4, 2) lower, upper [rad], insertion [m]
        """

class DvrkTool:
    """
    One da Vinci instrument. Angles are limits of both signs.
    """
    @property
    def jaw_lower_rad(self) -> float: ...
    @property
    def jaw_upper_rad(self) -> float: ...
    @property
    def length_m(self) -> float:
        """
        DH d of the roll row [m]
        """
    @property
    def model(self) -> str:
        """
        six digits
        """
    @property
    def name(self) -> str:
        """
        as dVRK writes it
        """
    @property
    def roll_limit_rad(self) -> float: ...
    @property
    def wrist_offset_m(self) -> float:
        """
        wrist pitch axis to wrist yaw axis [m]
        """
    @property
    def wrist_pitch_limit_rad(self) -> float: ...
    @property
    def wrist_yaw_limit_rad(self) -> float: ...

def dvrk_ecm_config(endoscope: str, body: str) -> EcmConfig:
    """
    EcmConfig of a body with an endoscope. Raises ConfigError.
    """

def dvrk_find_tool(text: str) -> DvrkTool:
    """
    By model ('400006') or dVRK name ('LARGE_NEEDLE_DRIVER:400006'). Raises ConfigError naming what is known.
    """

def dvrk_psm_config(tool: str, body: str) -> PsmConfig:
    """
    PsmConfig of a body with an instrument. Raises ConfigError.
    """

def dvrk_tools() -> list[DvrkTool]:
    """
    All known instruments, by model.
    """

MESA_NOMINAL_RCM: numpy.ndarray
MESA_SHAFT_RADIUS_M: float = 0.0025
