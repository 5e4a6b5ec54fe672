"""
Complementary situational awareness: controllers, fixtures, teleoperation states
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import saras._core
import saras._core.kinematics
import saras._core.teleop
import typing

__all__: list[str] = [
    "BorderWrench",
    "BorderWrenchConfig",
    "BorderWrenchOutput",
    "BorderWrenchState",
    "ComplianceConfig",
    "ComplianceConvention",
    "ComplianceGains",
    "ComplianceOutput",
    "ComplianceState",
    "ComplianceWrench",
    "ConstrainedMotion",
    "ConstrainedMotionConfig",
    "ConstrainedMotionOutput",
    "ContactDetector",
    "ContactState",
    "ContactTransition",
    "CsaTeleop",
    "CsaTeleopConfig",
    "CsaTeleopOutput",
    "CsaTeleopState",
    "Fixture",
    "FixtureForce",
    "FixtureForceConfig",
    "FixtureForceOutput",
    "FixtureForceState",
    "FixtureIntegrator",
    "FixtureIntegratorState",
    "FixtureOutput",
    "FixtureSet",
    "FixtureState",
    "FixtureWord",
    "GravityModel",
    "MAX_JOINTS",
    "MasterMlc",
    "MasterMlcConfig",
    "MasterMlcOutput",
    "MasterMlcState",
    "MeshPoint",
    "MotionReason",
    "Palpation",
    "PalpationKind",
    "ProxySlave",
    "QpResult",
    "QpSolver",
    "QpStatus",
    "SlaveMlc",
    "SlaveMlcConfig",
    "SlaveMlcOutput",
    "SlaveMlcState",
    "SlaveMode",
    "Synchronisation",
    "TeleopFixture",
    "TriangleMesh",
    "contact_transition",
    "is_hold",
]

class QpStatus:
    """
    How a quadratic programme ended.

    Members:

      SOLVED

      SOFTENED

      INFEASIBLE

      INVALID_INPUT

      FAILED
    """

    FAILED: typing.ClassVar[QpStatus]
    INFEASIBLE: typing.ClassVar[QpStatus]
    INVALID_INPUT: typing.ClassVar[QpStatus]
    SOFTENED: typing.ClassVar[QpStatus]
    SOLVED: typing.ClassVar[QpStatus]
    __members__: typing.ClassVar[dict[str, QpStatus]]
    @typing.overload
    def __eq__(self, other: QpStatus) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: QpStatus) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class QpResult:
    """
    How a solve ended.
    """
    @property
    def iterations(self) -> int: ...
    @property
    def kkt_residual(self) -> float: ...
    @property
    def slack(self) -> float:
        """
        largest violation of a soft row
        """
    @property
    def status(self) -> QpStatus:
        """
        QpStatus
        """

class QpSolver:
    """
    minimise 1/2 x'Hx + g'x, lower <= x <= upper, row_lower <= A x <= row_upper.
    DAQP, with memory taken once; a solution is only called solved with a KKT residual <= 1e-8.
    """
    def __init__(
        self,
        variables: typing.SupportsInt | typing.SupportsIndex,
        rows_max: typing.SupportsInt | typing.SupportsIndex,
        soft_weight: typing.SupportsFloat | typing.SupportsIndex = 1000000.0,
    ) -> None:
        """
        soft_weight: cost of a soft row's violation s is soft_weight s^2 / 2. Raises ConfigError.
        """
    def solve(
        self,
        hessian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        gradient: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        rows: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        row_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        row_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        soft: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 1]"] | None = None,
    ) -> QpResult:
        """
        hessian: (n, n); gradient, lower, upper: (n,); rows: (m, n); row_lower, row_upper: (m,), infinite for no
        bound; soft: (m,) 0 or 1. Gives a QpResult; solution and multipliers stay here. ValueError for shapes.
        """
    @property
    def multipliers(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n + rows_max,) bounds first; positive at an upper bound: Hx + g + l[:n] + A' l[n:] = 0
        """
    @property
    def solution(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) of the last solved problem
        """

class ComplianceConvention:
    """
    How compliance gains act.

    Members:

      AS_PRINTED

      POSITIVE
    """

    AS_PRINTED: typing.ClassVar[ComplianceConvention]
    POSITIVE: typing.ClassVar[ComplianceConvention]
    __members__: typing.ClassVar[dict[str, ComplianceConvention]]
    @typing.overload
    def __eq__(self, other: ComplianceConvention) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ComplianceConvention) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ComplianceGains:
    """
    Of one side of each axis, in the compliance frame.
    """

    _fields: typing.ClassVar[list] = [
        "stiffness_N_m",
        "damping_N_s_m",
        "force_bias_N",
        "rotation_stiffness_Nm_rad",
        "torque_bias_Nm",
    ]
    def __copy__(self) -> ComplianceGains: ...
    def __deepcopy__(self, arg0: dict) -> ComplianceGains: ...
    def __init__(self, **kwargs) -> None:
        """
        Of one side of each axis, in the compliance frame.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def damping_N_s_m(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N s/m]
        """
    @damping_N_s_m.setter
    def damping_N_s_m(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def force_bias_N(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N]
        """
    @force_bias_N.setter
    def force_bias_N(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def rotation_stiffness_Nm_rad(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N m/rad]
        """
    @rotation_stiffness_Nm_rad.setter
    def rotation_stiffness_Nm_rad(
        self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> None: ...
    @property
    def stiffness_N_m(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def torque_bias_Nm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N m]
        """
    @torque_bias_Nm.setter
    def torque_bias_Nm(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class ComplianceConfig:
    """
    Gains of ComplianceWrench. Raises ConfigError.
    """

    _fields: typing.ClassVar[list] = [
        "convention",
        "negative",
        "positive",
        "rotation_damping_Nm_s_rad",
        "deadband_m",
        "rotation_deadband_rad",
        "force_limit_N",
        "torque_limit_Nm",
        "walls_never_pull",
        "dt_max_s",
    ]
    def __copy__(self) -> ComplianceConfig: ...
    def __deepcopy__(self, arg0: dict) -> ComplianceConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Gains of ComplianceWrench. Raises ConfigError.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def convention(self) -> ComplianceConvention:
        """
        AS_PRINTED: restoring gains are negative; POSITIVE: stiffness and damping in the usual sense, >= 0
        """
    @convention.setter
    def convention(self, arg1: ComplianceConvention) -> None: ...
    @property
    def deadband_m(self) -> float:
        """
        [m]
        """
    @deadband_m.setter
    def deadband_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def negative(self) -> ComplianceGains:
        """
        ComplianceGains where the deviation is <= 0
        """
    @negative.setter
    def negative(self, arg1: ComplianceGains) -> None: ...
    @property
    def positive(self) -> ComplianceGains:
        """
        ComplianceGains where it is > 0
        """
    @positive.setter
    def positive(self, arg1: ComplianceGains) -> None: ...
    @property
    def rotation_damping_Nm_s_rad(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N m s/rad]
        """
    @rotation_damping_Nm_s_rad.setter
    def rotation_damping_Nm_s_rad(
        self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> None: ...
    @property
    def rotation_deadband_rad(self) -> float:
        """
        [rad]
        """
    @rotation_deadband_rad.setter
    def rotation_deadband_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_limit_Nm(self) -> float:
        """
        [N m]
        """
    @torque_limit_Nm.setter
    def torque_limit_Nm(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def walls_never_pull(self) -> bool:
        """
        a damper may weaken a wall's spring, but not turn it round
        """
    @walls_never_pull.setter
    def walls_never_pull(self, arg1: bool) -> None: ...

class ComplianceOutput:
    """
    Result of ComplianceWrench.step.
    """

    _fields: typing.ClassVar[list] = ["wrench", "deviation", "rotation", "status"]
    def __copy__(self) -> ComplianceOutput: ...
    def __deepcopy__(self, arg0: dict) -> ComplianceOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of ComplianceWrench.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def deviation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) in the compliance frame [m]
        """
    @deviation.setter
    def deviation(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def rotation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) rotation vector from the compliance frame [rad]
        """
    @rotation.setter
    def rotation(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the hand, base axes
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class ComplianceState:
    """
    Nothing is remembered.
    """

    _fields: typing.ClassVar[list] = list()
    def __copy__(self) -> ComplianceState: ...
    def __deepcopy__(self, arg0: dict) -> ComplianceState: ...
    def __init__(self, **kwargs) -> None:
        """
        Nothing is remembered.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """

class ComplianceWrench:
    """
    Springs, dampers and biases about a frame (Chalasani et al. 2018, algorithm 1).
    """
    def __init__(self, config: ComplianceConfig = ...) -> None: ...
    def reset(self, state: ComplianceState = ...) -> None: ...
    def step(
        self,
        handle_pose: numpy.typing.ArrayLike,
        handle_twist: numpy.typing.ArrayLike,
        frame: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        torque_frame: numpy.typing.ArrayLike | None = None,
    ) -> ComplianceOutput:
        """
        One tick, base axes. handle_pose: (4, 4); handle_twist: (6,); frame: (4, 4) compliance frame;
        torque_frame: (4, 4) whose rotation the torque refers to, the frame's own by default.
        """
    @property
    def config(self) -> ComplianceConfig: ...
    @property
    def state(self) -> ComplianceState: ...

class GravityModel:
    """
    Joint torques that hold a chain against gravity.
    """
    def __init__(
        self,
        joints: collections.abc.Sequence[saras._core.kinematics.Joint],
        masses_kg: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        centres_m: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]],
        gravity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
    ) -> None:
        """
        joints: of kinematics.Chain. masses_kg, centres_m (3,): one a joint, in its link's frame. gravity: (3,)
        in the base frame [m/s^2]. Raises ConfigError, KinematicsError.
        """
    def torque(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) what the motors must give [N m, N].
        """

class MasterMlcConfig:
    """
    Limits of MasterMlc. Raises ConfigError.
    """

    _fields: typing.ClassVar[list] = ["torque_limit", "gravity", "dt_max_s"]
    def __copy__(self) -> MasterMlcConfig: ...
    def __deepcopy__(self, arg0: dict) -> MasterMlcConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Limits of MasterMlc. Raises ConfigError.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def gravity(self) -> bool:
        """
        add the gravity model's torques
        """
    @gravity.setter
    def gravity(self, arg1: bool) -> None: ...
    @property
    def torque_limit(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) [N m, N]
        """
    @torque_limit.setter
    def torque_limit(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class MasterMlcOutput:
    """
    Result of MasterMlc.step.
    """

    _fields: typing.ClassVar[list] = ["torque", "compliance_torque", "gravity_torque", "status"]
    def __copy__(self) -> MasterMlcOutput: ...
    def __deepcopy__(self, arg0: dict) -> MasterMlcOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of MasterMlc.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def compliance_torque(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) J' wrench
        """
    @compliance_torque.setter
    def compliance_torque(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def gravity_torque(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @gravity_torque.setter
    def gravity_torque(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        LIMITED: a joint at its limit; STALE: without the wrench
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def torque(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) for the low-level controller [N m, N]
        """
    @torque.setter
    def torque(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class MasterMlcState:
    """
    Nothing is remembered.
    """

    _fields: typing.ClassVar[list] = list()
    def __copy__(self) -> MasterMlcState: ...
    def __deepcopy__(self, arg0: dict) -> MasterMlcState: ...
    def __init__(self, **kwargs) -> None:
        """
        Nothing is remembered.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """

class MasterMlc:
    """
    torque = J' wrench + gravity + external, each joint limited.
    """
    def __init__(self, config: MasterMlcConfig, gravity: GravityModel | None = None) -> None:
        """
        gravity: GravityModel or None. Raises ConfigError.
        """
    def reset(self, state: MasterMlcState = ...) -> None: ...
    def step(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        wrench: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        external_torque: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
        wrench_stale: bool = False,
    ) -> MasterMlcOutput:
        """
        One tick. q: (n,) measured; jacobian: (6, n) base axes; wrench: (6,) on the hand, either computed by
        ComplianceWrench or given from outside; external_torque: (n,) sum of what others add.
        """
    @property
    def config(self) -> MasterMlcConfig: ...
    @property
    def state(self) -> MasterMlcState: ...

class MeshPoint:
    """
    The closest point on a mesh.
    """
    @property
    def distance_m(self) -> float:
        """
        signed: negative behind the surface; NaN: none within reach
        """
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit, outward
        """
    @property
    def point(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the surface [m]
        """
    @property
    def triangle(self) -> int:
        """
        index as given; -1: none
        """

class TriangleMesh:
    """
    Triangles in a tree, for closest points in microseconds.
    """
    def __init__(
        self,
        vertices: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
        triangles: typing.Annotated[numpy.typing.ArrayLike, numpy.int32, "[m, 3]"],
    ) -> None:
        """
        vertices: (v, 3) [m]; triangles: (t, 3) indices, counter-clockwise from outside. Raises ConfigError.
        """
    def closest(
        self,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        within_m: typing.SupportsFloat | typing.SupportsIndex = ...,
        hint: typing.SupportsInt | typing.SupportsIndex = -1,
    ) -> MeshPoint:
        """
        MeshPoint nearest to (3,) [m], no further than within_m. hint: a triangle that may be near.
        """
    def nearby(
        self,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        within_m: typing.SupportsFloat | typing.SupportsIndex,
        capacity: typing.SupportsInt | typing.SupportsIndex = 6,
    ) -> list[MeshPoint]:
        """
        Up to capacity MeshPoints within within_m, nearest first, with normals that differ.
        """
    @property
    def triangles(self) -> int: ...
    @property
    def vertices(self) -> int: ...

class Fixture:
    """
    One virtual fixture; make it with plane, line, path, remote_centre, hull, mesh.
    """

    _fields: typing.ClassVar[list] = ["name", "soft", "kind", "numbers"]
    @staticmethod
    def hull(
        name: str,
        faces: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 4]"],
        keep_in: bool = True,
        margin_m: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        soft: bool = False,
    ) -> Fixture:
        """
        faces: (n, 4) outward unit normal and offset, inside is n.x <= offset; see saras.csa.convex_hull.
        """
    @staticmethod
    def line(
        name: str,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        radius_m: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        soft: bool = False,
    ) -> Fixture:
        """
        The tip stays within radius_m of a line.
        """
    @staticmethod
    def mesh(
        name: str,
        mesh: TriangleMesh,
        keep_in: bool = False,
        margin_m: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        reach_m: typing.SupportsFloat | typing.SupportsIndex = 0.005,
        soft: bool = False,
    ) -> Fixture:
        """
        The tip stays margin_m outside (keep_in: inside) a TriangleMesh. All raise ConfigError.
        """
    @staticmethod
    def path(
        name: str,
        points: collections.abc.Sequence[typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]],
        radius_m: typing.SupportsFloat | typing.SupportsIndex = 0.001,
        soft: bool = False,
    ) -> Fixture:
        """
        The tip stays within radius_m of a polyline (n, 3) and may move along it.
        """
    @staticmethod
    def plane(
        name: str,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        margin_m: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        soft: bool = False,
    ) -> Fixture:
        """
        The tip stays margin_m on the side of the unit normal (3,).
        """
    @staticmethod
    def remote_centre(
        name: str,
        centre: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        tolerance_m: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        soft: bool = False,
    ) -> Fixture:
        """
        The shaft passes the point (3,) within tolerance_m.
        """
    def __init__(
        self,
        *,
        name: str,
        soft: bool,
        kind: typing.SupportsInt | typing.SupportsIndex,
        numbers: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    ) -> None:
        """
        From a record: kind and numbers of another fixture. Raises ConfigError.
        """
    @property
    def kind(self) -> int:
        """
        0 plane, 1 line, 2 path, 3 remote centre, 4 hull, 5 mesh
        """
    @property
    def name(self) -> str: ...
    @property
    def numbers(self) -> list[float]:
        """
        of its geometry, in a row
        """
    @property
    def soft(self) -> bool: ...

class FixtureOutput:
    """
    Result of FixtureSet.step; goes into the controllers as `fixtures`.
    """
    @property
    def closest(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) its closest point, base frame
        """
    @property
    def distance_m(self) -> typing.Annotated[list[float], "FixedSize(16)"]:
        """
        of each fixture to its border, 16 numbers; negative: violated; NaN: no such fixture
        """
    @property
    def nearest(self) -> int:
        """
        fixture with the least distance; -1: none
        """
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) towards what is allowed
        """
    @property
    def row_fixtures(self) -> list[int]:
        """
        the fixture of each row
        """
    @property
    def rows(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (m, 8) axis on the tip's displacement and rotation vector, lower, upper [m]
        """
    @property
    def status(self) -> saras._core.Status:
        """
        LIMITED: something is violated
        """

class FixtureState:
    """
    Face, triangle or segment of each fixture, plus 1.
    """

    _fields: typing.ClassVar[list] = ["feature"]
    def __copy__(self) -> FixtureState: ...
    def __deepcopy__(self, arg0: dict) -> FixtureState: ...
    def __init__(self, **kwargs) -> None:
        """
        Face, triangle or segment of each fixture, plus 1.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def feature(self) -> typing.Annotated[list[int], "FixedSize(16)"]: ...
    @feature.setter
    def feature(
        self,
        arg1: typing.Annotated[collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex], "FixedSize(16)"],
    ) -> None: ...

class FixtureSet:
    """
    All virtual fixtures of one tool, as rows on its motion.
    """
    def __init__(self, fixtures: collections.abc.Sequence[Fixture]) -> None:
        """
        At most 16. Raises ConfigError.
        """
    def reset(self, state: FixtureState = ...) -> None: ...
    def step(
        self,
        base_T_tip: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        shaft: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
        base_T_fixtures: numpy.typing.ArrayLike = ...,
    ) -> FixtureOutput:
        """
        base_T_tip: (4, 4); shaft: (3,) unit from trocar to tip, base axes; base_T_fixtures: (4, 4).
        """
    @property
    def names(self) -> list[str]: ...
    @property
    def state(self) -> FixtureState: ...

class TeleopFixture:
    """
    A fixture of ordinary teleoperation, in the arm's base frame.

    A hard one is a wall for the set-point and the hand; a soft one only tells the hand.
    """

    _fields: typing.ClassVar[list] = ["fixture", "stiffness_N_m", "start_m"]
    def __copy__(self) -> TeleopFixture: ...
    def __deepcopy__(self, arg0: dict) -> TeleopFixture: ...
    def __init__(self, **kwargs) -> None:
        """
        A fixture of ordinary teleoperation, in the arm's base frame.

        A hard one is a wall for the set-point and the hand; a soft one only tells the hand.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def fixture(self) -> Fixture:
        """
        saras.csa.Fixture, any but a remote centre
        """
    @fixture.setter
    def fixture(self, arg1: Fixture) -> None: ...
    @property
    def start_m(self) -> float:
        """
        the force begins this far on the allowed side [m]
        """
    @start_m.setter
    def start_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        force on the hand per metre nearer than start_m [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FixtureWord:
    """
    What holds at the moment of all fixtures of a side.
    """

    _fields: typing.ClassVar[list] = ["on", "known"]
    def __copy__(self) -> FixtureWord: ...
    def __deepcopy__(self, arg0: dict) -> FixtureWord: ...
    def __init__(self, **kwargs) -> None:
        """
        What holds at the moment of all fixtures of a side.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def known(self) -> bool:
        """
        whether it is known where they are; if not, the set-point stands
        """
    @known.setter
    def known(self, arg1: bool) -> None: ...
    @property
    def on(self) -> bool:
        """
        switched off: neither wall nor force
        """
    @on.setter
    def on(self, arg1: bool) -> None: ...

class FixtureForceConfig:
    """
    Limits of a FixtureForce.
    """

    _fields: typing.ClassVar[list] = ["force_limit_N", "ramp_s", "dt_max_s"]
    def __copy__(self) -> FixtureForceConfig: ...
    def __deepcopy__(self, arg0: dict) -> FixtureForceConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Limits of a FixtureForce.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        of one fixture, and of all together [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def ramp_s(self) -> float:
        """
        the force moves by at most its limit in this time [s]
        """
    @ramp_s.setter
    def ramp_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FixtureForceOutput:
    """
    Result of FixtureForce.step.
    """

    _fields: typing.ClassVar[list] = ["wrench", "distance_m", "nearest", "closest", "normal", "violation_m", "status"]
    def __copy__(self) -> FixtureForceOutput: ...
    def __deepcopy__(self, arg0: dict) -> FixtureForceOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of FixtureForce.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def closest(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) its closest point, base frame [m]
        """
    @closest.setter
    def closest(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def distance_m(self) -> typing.Annotated[list[float], "FixedSize(16)"]:
        """
        of the tip to each border, 16 numbers; negative: passed; NaN: unknown, none
        """
    @distance_m.setter
    def distance_m(
        self,
        arg1: typing.Annotated[collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(16)"],
    ) -> None: ...
    @property
    def nearest(self) -> int:
        """
        fixture with the least distance; -1: none
        """
    @nearest.setter
    def nearest(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) its direction towards what is allowed
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status; LIMITED: a force is due; WAITING: none is there, or they are off
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def violation_m(self) -> float:
        """
        how far the tip is beyond the nearest border [m]
        """
    @violation_m.setter
    def violation_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the operator's hand, base axes
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class FixtureForceState:
    """
    All that a FixtureForce remembers.
    """

    _fields: typing.ClassVar[list] = ["force", "fixtures"]
    def __copy__(self) -> FixtureForceState: ...
    def __deepcopy__(self, arg0: dict) -> FixtureForceState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a FixtureForce remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def fixtures(self) -> FixtureState:
        """
        FixtureState
        """
    @fixtures.setter
    def fixtures(self, arg1: FixtureState) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N]
        """
    @force.setter
    def force(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class FixtureForce:
    """
    What the hand feels of virtual fixtures.
    """
    def __init__(self, config: FixtureForceConfig, fixtures: collections.abc.Sequence[TeleopFixture]) -> None:
        """
        At most 16 TeleopFixture. Raises ConfigError.
        """
    def reset(self, state: FixtureForceState = ...) -> None: ...
    def step(
        self,
        base_T_tip: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        hand_ahead: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] | None = None,
        fixtures_on: bool = True,
        fixtures_known: bool = True,
    ) -> FixtureForceOutput:
        """
        base_T_tip: (4, 4) measured; dt: since the last step [s]; hand_ahead: (3,) from the tip to where the hand
        wants it [m]; fixtures_on, fixtures_known: as FixtureWord.
        """
    @property
    def config(self) -> FixtureForceConfig: ...
    @property
    def state(self) -> FixtureForceState: ...

class FixtureIntegratorState:
    """
    All that a FixtureIntegrator remembers.
    """

    _fields: typing.ClassVar[list] = ["integrator", "fixtures"]
    def __copy__(self) -> FixtureIntegratorState: ...
    def __deepcopy__(self, arg0: dict) -> FixtureIntegratorState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a FixtureIntegrator remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def fixtures(self) -> FixtureState:
        """
        FixtureState
        """
    @fixtures.setter
    def fixtures(self, arg1: FixtureState) -> None: ...
    @property
    def integrator(self) -> saras._core.teleop.VelocityIntegratorState:
        """
        saras.teleop.VelocityIntegratorState
        """
    @integrator.setter
    def integrator(self, arg1: saras._core.teleop.VelocityIntegratorState) -> None: ...

class FixtureIntegrator:
    """
    saras.teleop.VelocityIntegrator whose set-point does not pass hard fixtures; without one it is that law.
    """
    def __init__(
        self, config: saras._core.teleop.VelocityIntegratorConfig, fixtures: collections.abc.Sequence[TeleopFixture]
    ) -> None:
        """
        config: saras.teleop.VelocityIntegratorConfig. Raises ConfigError.
        """
    def reset(self, state: FixtureIntegratorState = ...) -> None:
        """
        Without argument: starts from measured again.
        """
    def step(
        self,
        twist: numpy.typing.ArrayLike,
        measured_pose: numpy.typing.ArrayLike,
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        stale: bool = False,
        max_speed_scale: typing.SupportsFloat | typing.SupportsIndex = 1.0,
        approach_direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] | None = None,
        approach_speed_limit_m_s: typing.SupportsFloat | typing.SupportsIndex = ...,
        fixtures_on: bool = True,
        fixtures_known: bool = True,
    ) -> saras._core.teleop.VelocityIntegratorOutput:
        """
        As VelocityIntegrator.step; fixtures_on, fixtures_known: as FixtureWord. Gives a
        saras.teleop.VelocityIntegratorOutput, fixture_limited where a fixture held it back.
        """
    @property
    def config(self) -> saras._core.teleop.VelocityIntegratorConfig: ...
    @property
    def state(self) -> FixtureIntegratorState: ...

class BorderWrenchConfig:
    """
    Gains of BorderWrench. Raises ConfigError.
    """

    _fields: typing.ClassVar[list] = ["stiffness_N_m", "damping_N_s_m", "force_limit_N", "dt_max_s"]
    def __copy__(self) -> BorderWrenchConfig: ...
    def __deepcopy__(self, arg0: dict) -> BorderWrenchConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Gains of BorderWrench. Raises ConfigError.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def damping_N_s_m(self) -> float:
        """
        [N s/m]
        """
    @damping_N_s_m.setter
    def damping_N_s_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class BorderWrenchOutput:
    """
    Result of BorderWrench.step.
    """

    _fields: typing.ClassVar[list] = ["wrench", "way", "status"]
    def __copy__(self) -> BorderWrenchOutput: ...
    def __deepcopy__(self, arg0: dict) -> BorderWrenchOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of BorderWrench.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def status(self) -> saras._core.Status:
        """
        LIMITED: cut at the limit, or fixtures that contradict each other
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def way(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) shortest back to where all fixtures are obeyed; zero inside [m]
        """
    @way.setter
    def way(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the hand, base axes
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class BorderWrenchState:
    """
    Nothing is remembered.
    """

    _fields: typing.ClassVar[list] = list()
    def __copy__(self) -> BorderWrenchState: ...
    def __deepcopy__(self, arg0: dict) -> BorderWrenchState: ...
    def __init__(self, **kwargs) -> None:
        """
        Nothing is remembered.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """

class BorderWrench:
    """
    What the hand feels of virtual fixtures: a one-sided spring back to where the tip may be.
    """
    def __init__(self, config: BorderWrenchConfig = ...) -> None: ...
    def reset(self, state: BorderWrenchState = ...) -> None: ...
    def step(
        self,
        fixtures: FixtureOutput | None,
        velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> BorderWrenchOutput:
        """
        fixtures: FixtureOutput at the point that the hand leads, None: none; velocity: (3,) of that point, base
        axes. Rows of remote centres are left out.
        """
    @property
    def config(self) -> BorderWrenchConfig: ...
    @property
    def state(self) -> BorderWrenchState: ...

class MotionReason:
    """
    Why less than asked was done; from INVALID_INPUT on a hold.

    Members:

      NONE

      SPEED_LIMIT

      JOINT_LIMIT

      LEAD_LIMIT

      NEAR_SINGULAR

      FORCE_CAP

      FIXTURE_ACTIVE

      INVALID_INPUT

      INVALID_TIME_STEP

      STALE

      FORCE_UNKNOWN

      FORCE_SATURATED

      NORMAL_UNKNOWN

      INFEASIBLE

      SOLVER_FAILED
    """

    FIXTURE_ACTIVE: typing.ClassVar[MotionReason]
    FORCE_CAP: typing.ClassVar[MotionReason]
    FORCE_SATURATED: typing.ClassVar[MotionReason]
    FORCE_UNKNOWN: typing.ClassVar[MotionReason]
    INFEASIBLE: typing.ClassVar[MotionReason]
    INVALID_INPUT: typing.ClassVar[MotionReason]
    INVALID_TIME_STEP: typing.ClassVar[MotionReason]
    JOINT_LIMIT: typing.ClassVar[MotionReason]
    LEAD_LIMIT: typing.ClassVar[MotionReason]
    NEAR_SINGULAR: typing.ClassVar[MotionReason]
    NONE: typing.ClassVar[MotionReason]
    NORMAL_UNKNOWN: typing.ClassVar[MotionReason]
    SOLVER_FAILED: typing.ClassVar[MotionReason]
    SPEED_LIMIT: typing.ClassVar[MotionReason]
    STALE: typing.ClassVar[MotionReason]
    __members__: typing.ClassVar[dict[str, MotionReason]]
    @typing.overload
    def __eq__(self, other: MotionReason) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: MotionReason) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SlaveMode:
    """
    Which projections the slave uses.

    Members:

      POSITION

      HYBRID

      ADMITTANCE
    """

    ADMITTANCE: typing.ClassVar[SlaveMode]
    HYBRID: typing.ClassVar[SlaveMode]
    POSITION: typing.ClassVar[SlaveMode]
    __members__: typing.ClassVar[dict[str, SlaveMode]]
    @typing.overload
    def __eq__(self, other: SlaveMode) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: SlaveMode) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class PalpationKind:
    """
    What is superimposed along the normal.

    Members:

      NONE

      FORCE

      MOTION
    """

    FORCE: typing.ClassVar[PalpationKind]
    MOTION: typing.ClassVar[PalpationKind]
    NONE: typing.ClassVar[PalpationKind]
    __members__: typing.ClassVar[dict[str, PalpationKind]]
    @typing.overload
    def __eq__(self, other: PalpationKind) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: PalpationKind) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class Palpation:
    """
    Motion primitive of continuous palpation.
    """

    _fields: typing.ClassVar[list] = ["kind", "amplitude", "frequency_hz"]
    def __copy__(self) -> Palpation: ...
    def __deepcopy__(self, arg0: dict) -> Palpation: ...
    def __init__(self, **kwargs) -> None:
        """
        Motion primitive of continuous palpation.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def amplitude(self) -> float:
        """
        [N] or [m]; of the force primitive at most 0.95 F_d
        """
    @amplitude.setter
    def amplitude(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def frequency_hz(self) -> float:
        """
        [Hz]
        """
    @frequency_hz.setter
    def frequency_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def kind(self) -> PalpationKind:
        """
        PalpationKind
        """
    @kind.setter
    def kind(self, arg1: PalpationKind) -> None: ...

class ConstrainedMotionConfig:
    """
    Limits of the joints and weights. Raises ConfigError.
    """

    _fields: typing.ClassVar[list] = [
        "lower",
        "upper",
        "speed",
        "lead",
        "rotation_weight_m",
        "first_weight",
        "damping",
        "singular_value_min_m",
        "damping_singular",
        "recovery_speed_m_s",
        "soft_weight",
        "dt_max_s",
    ]
    def __copy__(self) -> ConstrainedMotionConfig: ...
    def __deepcopy__(self, arg0: dict) -> ConstrainedMotionConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Limits of the joints and weights. Raises ConfigError.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def damping(self) -> float:
        """
        weight of joint speeds [m^2/rad^2]
        """
    @damping.setter
    def damping(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping_singular(self) -> float:
        """
        at singular value zero
        """
    @damping_singular.setter
    def damping_singular(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def first_weight(self) -> float:
        """
        error along the direction that comes first counts so many times
        """
    @first_weight.setter
    def first_weight(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lead(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) largest |set-point - measured| [rad, m]
        """
    @lead.setter
    def lead(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) joint limits [rad, m]
        """
    @lower.setter
    def lower(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def recovery_speed_m_s(self) -> float:
        """
        out of a violated fixture [m/s]
        """
    @recovery_speed_m_s.setter
    def recovery_speed_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_weight_m(self) -> float:
        """
        one radian of error counts as so many metres
        """
    @rotation_weight_m.setter
    def rotation_weight_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def singular_value_min_m(self) -> float:
        """
        below it damping rises [m]
        """
    @singular_value_min_m.setter
    def singular_value_min_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def soft_weight(self) -> float:
        """
        cost of violating a soft row, per (m/s)^2
        """
    @soft_weight.setter
    def soft_weight(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) largest speeds [rad/s, m/s]
        """
    @speed.setter
    def speed(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) [rad, m]
        """
    @upper.setter
    def upper(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...

class ConstrainedMotionOutput:
    """
    One tick of joint motion.
    """

    _fields: typing.ClassVar[list] = [
        "q",
        "rates",
        "twist",
        "fixture",
        "smallest_singular_value_m",
        "kkt_residual",
        "reason",
        "status",
    ]
    def __copy__(self) -> ConstrainedMotionOutput: ...
    def __deepcopy__(self, arg0: dict) -> ConstrainedMotionOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        One tick of joint motion.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def fixture(self) -> int:
        """
        index of the fixture that acts most; -1: none
        """
    @fixture.setter
    def fixture(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def kkt_residual(self) -> float: ...
    @kkt_residual.setter
    def kkt_residual(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def q(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) next set-point; the old one under a hold
        """
    @q.setter
    def q(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def rates(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) [rad/s, m/s]
        """
    @rates.setter
    def rates(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> None: ...
    @property
    def reason(self) -> MotionReason:
        """
        MotionReason
        """
    @reason.setter
    def reason(self, arg1: MotionReason) -> None: ...
    @property
    def smallest_singular_value_m(self) -> float:
        """
        of the weighted Jacobian [m]
        """
    @smallest_singular_value_m.setter
    def smallest_singular_value_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) J rates
        """
    @twist.setter
    def twist(self, arg1: numpy.typing.ArrayLike) -> None: ...

class ConstrainedMotion:
    """
    Joint motion towards a twist inside limits and fixtures.
    """
    def __init__(self, config: ConstrainedMotionConfig) -> None:
        """
        Raises ConfigError.
        """
    def step(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        twist: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        q_measured: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
        fixtures: FixtureOutput | None = None,
        first: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
    ) -> ConstrainedMotionOutput:
        """
        q: (n,) set-point; jacobian: (6, n) at q, base axes; twist: (6,) wanted; q_measured: (n,) bounds the lead;
        fixtures: FixtureOutput; first: (3,) unit, speed along it comes before all other directions.
        """
    @property
    def config(self) -> ConstrainedMotionConfig: ...

class ProxySlave:
    """
    The slave of the virtual environment: motion only.
    """
    def __init__(
        self,
        config: ConstrainedMotionConfig,
        speed_limit_m_s: typing.SupportsFloat | typing.SupportsIndex = 0.1,
        rotation_speed_limit_rad_s: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    ) -> None:
        """
        Raises ConfigError.
        """
    def step(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        pose: numpy.typing.ArrayLike,
        desired: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        fixtures: FixtureOutput | None = None,
    ) -> ConstrainedMotionOutput:
        """
        pose: (4, 4) at q; desired: (4, 4).
        """

class SlaveMlcConfig:
    """
    Limits and gains of SlaveMlc. Raises ConfigError, at once.
    """

    _fields: typing.ClassVar[list] = [
        "motion",
        "admittance_m_Ns",
        "scheduled",
        "stiffness_min_N_m",
        "stiffness_max_N_m",
        "period_s",
        "arm_lag_s",
        "sensor_lag_s",
        "stability_margin",
        "approach_speed_m_s",
        "speed_limit_m_s",
        "rotation_speed_limit_rad_s",
        "force_cutoff_hz",
        "normal_cutoff_hz",
        "normal_force_min_N",
        "normal_rate_rad_s",
        "force_cap_N",
        "force_range_N",
    ]
    def __copy__(self) -> SlaveMlcConfig: ...
    def __deepcopy__(self, arg0: dict) -> SlaveMlcConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Limits and gains of SlaveMlc. Raises ConfigError, at once.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def admittance_m_Ns(self) -> float:
        """
        K_g, largest [m/(N s)]
        """
    @admittance_m_Ns.setter
    def admittance_m_Ns(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def approach_speed_m_s(self) -> float:
        """
        largest speed from force [m/s]
        """
    @approach_speed_m_s.setter
    def approach_speed_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def arm_lag_s(self) -> float:
        """
        2 zeta / omega_n [s]
        """
    @arm_lag_s.setter
    def arm_lag_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_cap_N(self) -> float:
        """
        [N]
        """
    @force_cap_N.setter
    def force_cap_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_cutoff_hz(self) -> float:
        """
        [Hz]
        """
    @force_cutoff_hz.setter
    def force_cutoff_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_range_N(self) -> float:
        """
        a component at or beyond it: saturated [N]
        """
    @force_range_N.setter
    def force_range_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def motion(self) -> ConstrainedMotionConfig:
        """
        ConstrainedMotionConfig
        """
    @motion.setter
    def motion(self, arg1: ConstrainedMotionConfig) -> None: ...
    @property
    def normal_cutoff_hz(self) -> float:
        """
        [Hz]
        """
    @normal_cutoff_hz.setter
    def normal_cutoff_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def normal_force_min_N(self) -> float:
        """
        below it the normal is kept [N]
        """
    @normal_force_min_N.setter
    def normal_force_min_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def normal_rate_rad_s(self) -> float:
        """
        the normal turns at most so fast [rad/s]
        """
    @normal_rate_rad_s.setter
    def normal_rate_rad_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def period_s(self) -> float:
        """
        of this controller [s]
        """
    @period_s.setter
    def period_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_speed_limit_rad_s(self) -> float:
        """
        [rad/s]
        """
    @rotation_speed_limit_rad_s.setter
    def rotation_speed_limit_rad_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def scheduled(self) -> bool:
        """
        lower K_g by the estimated stiffness
        """
    @scheduled.setter
    def scheduled(self, arg1: bool) -> None: ...
    @property
    def sensor_lag_s(self) -> float:
        """
        [s]
        """
    @sensor_lag_s.setter
    def sensor_lag_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed_limit_m_s(self) -> float:
        """
        largest speed from position [m/s]
        """
    @speed_limit_m_s.setter
    def speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stability_margin(self) -> float:
        """
        largest K_g k (period + arm + sensor), at most 0.5
        """
    @stability_margin.setter
    def stability_margin(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_max_N_m(self) -> float:
        """
        taken while nothing is known [N/m]
        """
    @stiffness_max_N_m.setter
    def stiffness_max_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_min_N_m(self) -> float:
        """
        [N/m]
        """
    @stiffness_min_N_m.setter
    def stiffness_min_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class SlaveMlcOutput:
    """
    Result of SlaveMlc.step.
    """

    _fields: typing.ClassVar[list] = [
        "motion",
        "normal",
        "normal_force_N",
        "desired_force_N",
        "admittance_m_Ns",
        "status",
    ]
    def __copy__(self) -> SlaveMlcOutput: ...
    def __deepcopy__(self, arg0: dict) -> SlaveMlcOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of SlaveMlc.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def admittance_m_Ns(self) -> float:
        """
        K_g that was used
        """
    @admittance_m_Ns.setter
    def admittance_m_Ns(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def desired_force_N(self) -> float:
        """
        with palpation [N]
        """
    @desired_force_N.setter
    def desired_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def motion(self) -> ConstrainedMotionOutput:
        """
        ConstrainedMotionOutput
        """
    @motion.setter
    def motion(self, arg1: ConstrainedMotionOutput) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) that was used; zero: none
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def normal_force_N(self) -> float:
        """
        [N]
        """
    @normal_force_N.setter
    def normal_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...

class SlaveMlcState:
    """
    Filters, normal and phase of palpation.
    """

    _fields: typing.ClassVar[list] = [
        "has_force",
        "force",
        "normal_force",
        "has_normal",
        "normal",
        "phase_rad",
        "palpating_motion",
        "anchor_m",
    ]
    has_force: bool
    has_normal: bool
    palpating_motion: bool
    def __copy__(self) -> SlaveMlcState: ...
    def __deepcopy__(self, arg0: dict) -> SlaveMlcState: ...
    def __init__(self, **kwargs) -> None:
        """
        Filters, normal and phase of palpation.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def anchor_m(self) -> float:
        """
        still to go along the normal [m]
        """
    @anchor_m.setter
    def anchor_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) low-passed F_c [N]
        """
    @force.setter
    def force(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,)
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def normal_force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) low-passed further [N]
        """
    @normal_force.setter
    def normal_force(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def phase_rad(self) -> float:
        """
        [rad]
        """
    @phase_rad.setter
    def phase_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class SlaveMlc:
    """
    Hybrid force and motion as one constrained optimisation.
    """
    def __init__(self, config: SlaveMlcConfig) -> None:
        """
        Raises ConfigError.
        """
    def admittance(self, stiffness_N_m: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        K_g for an estimated stiffness.
        """
    def reset(self, state: SlaveMlcState = ...) -> None: ...
    def step(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        jacobian: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        pose: numpy.typing.ArrayLike,
        desired: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        tissue_wrench: numpy.typing.ArrayLike | None = None,
        mode: SlaveMode = ...,
        desired_force_N: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
        stiffness_N_m: typing.SupportsFloat | typing.SupportsIndex = ...,
        palpation: Palpation = ...,
        q_measured: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"] | None = None,
        fixtures: FixtureOutput | None = None,
        stale: bool = False,
    ) -> SlaveMlcOutput:
        """
        One tick, base axes. q: (n,) set-point, jacobian (6, n) and pose (4, 4) there; desired: (4, 4);
        tissue_wrench: (6,) measured, exerted on the tissue, or None; normal: (3,) outward, zero: along the force;
        stiffness_N_m: estimated, NaN: unknown; fixtures: FixtureOutput.
        """
    @property
    def config(self) -> SlaveMlcConfig: ...
    @property
    def state(self) -> SlaveMlcState: ...

class ContactState:
    """
    Who is in contact.

    Members:

      NO_CONTACT

      PROXY_CONTACT

      SLAVE_CONTACT

      FULL_CONTACT
    """

    FULL_CONTACT: typing.ClassVar[ContactState]
    NO_CONTACT: typing.ClassVar[ContactState]
    PROXY_CONTACT: typing.ClassVar[ContactState]
    SLAVE_CONTACT: typing.ClassVar[ContactState]
    __members__: typing.ClassVar[dict[str, ContactState]]
    @typing.overload
    def __eq__(self, other: ContactState) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ContactState) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class Synchronisation:
    """
    Whether the proxy goes to the slave.

    Members:

      NEVER

      ALWAYS

      WHEN_MISMATCHED
    """

    ALWAYS: typing.ClassVar[Synchronisation]
    NEVER: typing.ClassVar[Synchronisation]
    WHEN_MISMATCHED: typing.ClassVar[Synchronisation]
    __members__: typing.ClassVar[dict[str, Synchronisation]]
    @typing.overload
    def __eq__(self, other: Synchronisation) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Synchronisation) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ContactTransition:
    """
    One row of the table of contact states.
    """

    _fields: typing.ClassVar[list] = ["state", "master_feels", "mode", "synchronise"]
    def __copy__(self) -> ContactTransition: ...
    def __deepcopy__(self, arg0: dict) -> ContactTransition: ...
    def __init__(self, **kwargs) -> None:
        """
        One row of the table of contact states.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def master_feels(self) -> bool:
        """
        compliance wrench; else zero
        """
    @master_feels.setter
    def master_feels(self, arg1: bool) -> None: ...
    @property
    def mode(self) -> SlaveMode:
        """
        SlaveMode
        """
    @mode.setter
    def mode(self, arg1: SlaveMode) -> None: ...
    @property
    def state(self) -> ContactState:
        """
        ContactState
        """
    @state.setter
    def state(self, arg1: ContactState) -> None: ...
    @property
    def synchronise(self) -> Synchronisation:
        """
        Synchronisation
        """
    @synchronise.setter
    def synchronise(self, arg1: Synchronisation) -> None: ...

class ContactDetector:
    """
    A contact with hysteresis and debounce.
    """

    _fields: typing.ClassVar[list] = ["contact", "pending_s"]
    contact: bool
    def __copy__(self) -> ContactDetector: ...
    def __deepcopy__(self, arg0: dict) -> ContactDetector: ...
    def __init__(self, **kwargs) -> None:
        """
        A contact with hysteresis and debounce.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def pending_s(self) -> float:
        """
        for how long the signal has said otherwise [s]
        """
    @pending_s.setter
    def pending_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class CsaTeleopConfig:
    """
    Thresholds, forces and ramp of CsaTeleop. Raises ConfigError.
    """

    _fields: typing.ClassVar[list] = [
        "scale",
        "contact_on_N",
        "contact_off_N",
        "proxy_on_m",
        "proxy_off_m",
        "debounce_s",
        "stiffness_N_m",
        "desired_force_N",
        "force_cap_N",
        "mismatch_tolerance_m",
        "force_limit_N",
        "torque_limit_Nm",
        "ramp_s",
        "dt_max_s",
    ]
    def __copy__(self) -> CsaTeleopConfig: ...
    def __deepcopy__(self, arg0: dict) -> CsaTeleopConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Thresholds, forces and ramp of CsaTeleop. Raises ConfigError.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def contact_off_N(self) -> float:
        """
        [N]
        """
    @contact_off_N.setter
    def contact_off_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def contact_on_N(self) -> float:
        """
        [N]
        """
    @contact_on_N.setter
    def contact_on_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def debounce_s(self) -> float:
        """
        [s]
        """
    @debounce_s.setter
    def debounce_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def desired_force_N(self) -> float:
        """
        F_d in FULL_CONTACT [N]
        """
    @desired_force_N.setter
    def desired_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_cap_N(self) -> float:
        """
        largest F_d [N]
        """
    @force_cap_N.setter
    def force_cap_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        largest force on the hand [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mismatch_tolerance_m(self) -> float:
        """
        [m]
        """
    @mismatch_tolerance_m.setter
    def mismatch_tolerance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def proxy_off_m(self) -> float:
        """
        [m]
        """
    @proxy_off_m.setter
    def proxy_off_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def proxy_on_m(self) -> float:
        """
        depth in the model [m]
        """
    @proxy_on_m.setter
    def proxy_on_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def ramp_s(self) -> float:
        """
        from nothing to the limit at the fastest [s]
        """
    @ramp_s.setter
    def ramp_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def scale(self) -> float:
        """
        slave metres per master metre
        """
    @scale.setter
    def scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        k_d [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_limit_Nm(self) -> float:
        """
        [N m]
        """
    @torque_limit_Nm.setter
    def torque_limit_Nm(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class CsaTeleopOutput:
    """
    Result of CsaTeleop.step.
    """

    _fields: typing.ClassVar[list] = [
        "state",
        "desired",
        "hold",
        "synchronise",
        "mode",
        "normal",
        "desired_force_N",
        "wrench",
        "mismatch_m",
        "status",
    ]
    def __copy__(self) -> CsaTeleopOutput: ...
    def __deepcopy__(self, arg0: dict) -> CsaTeleopOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of CsaTeleop.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def desired(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) x_d, for slave and proxy
        """
    @desired.setter
    def desired(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def desired_force_N(self) -> float:
        """
        [N]
        """
    @desired_force_N.setter
    def desired_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def hold(self) -> bool:
        """
        nobody moves
        """
    @hold.setter
    def hold(self, arg1: bool) -> None: ...
    @property
    def mismatch_m(self) -> float:
        """
        slave to proxy, after synchronisation [m]
        """
    @mismatch_m.setter
    def mismatch_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mode(self) -> SlaveMode:
        """
        SlaveMode
        """
    @mode.setter
    def mode(self, arg1: SlaveMode) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) for the slave; zero: along its force
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def state(self) -> ContactState:
        """
        ContactState
        """
    @state.setter
    def state(self, arg1: ContactState) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def synchronise(self) -> bool:
        """
        set the proxy to the slave before it steps
        """
    @synchronise.setter
    def synchronise(self, arg1: bool) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the hand, ramped
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class CsaTeleopState:
    """
    What CsaTeleop remembers.
    """

    _fields: typing.ClassVar[list] = [
        "state",
        "slave",
        "proxy",
        "has_reference",
        "master_reference",
        "slave_reference",
        "wrench",
    ]
    has_reference: bool
    def __copy__(self) -> CsaTeleopState: ...
    def __deepcopy__(self, arg0: dict) -> CsaTeleopState: ...
    def __init__(self, **kwargs) -> None:
        """
        What CsaTeleop remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def master_reference(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @master_reference.setter
    def master_reference(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def proxy(self) -> ContactDetector:
        """
        ContactDetector
        """
    @proxy.setter
    def proxy(self, arg1: ContactDetector) -> None: ...
    @property
    def slave(self) -> ContactDetector:
        """
        ContactDetector
        """
    @slave.setter
    def slave(self, arg1: ContactDetector) -> None: ...
    @property
    def slave_reference(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @slave_reference.setter
    def slave_reference(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def state(self) -> ContactState:
        """
        ContactState
        """
    @state.setter
    def state(self, arg1: ContactState) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,)
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class CsaTeleop:
    """
    Contact states of slave and proxy, what each means for both ends, mismatch correction.
    """
    def __init__(self, config: CsaTeleopConfig = ...) -> None: ...
    def reset(self, state: CsaTeleopState = ...) -> None: ...
    def step(
        self,
        master_pose: numpy.typing.ArrayLike,
        slave_pose: numpy.typing.ArrayLike,
        proxy_pose: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        slave_force_N: typing.SupportsFloat | typing.SupportsIndex | None,
        proxy_depth_m: typing.SupportsFloat | typing.SupportsIndex | None,
        proxy_normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        compliance_wrench: numpy.typing.ArrayLike,
        clutch: bool = False,
        enabled: bool = True,
        stale: bool = False,
        fixture_wrench: numpy.typing.ArrayLike = ...,
    ) -> CsaTeleopOutput:
        """
        One tick, the slave's base axes. Poses: (4, 4) of handle, slave's set-point, proxy. slave_force_N: norm of
        the filtered contact force, None: unknown. proxy_depth_m: in the model, negative outside, None: no model.
        proxy_normal: (3,) outward. compliance_wrench: (6,) from the proxy's interaction.
        fixture_wrench: (6,) of BorderWrench, felt in every state.
        """
    @property
    def config(self) -> CsaTeleopConfig: ...
    @property
    def state(self) -> CsaTeleopState: ...

def contact_transition(from_state: ContactState, slave_contact: bool, proxy_contact: bool) -> ContactTransition:
    """
    The table of contact states: pure.
    """

def is_hold(reason: MotionReason) -> bool:
    """
    Whether a MotionReason means standing still.
    """

MAX_JOINTS: int = 12
