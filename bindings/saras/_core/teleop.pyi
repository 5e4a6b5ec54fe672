"""
Frame mapping, transparency, energy tanks, velocity integrator
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core
import typing

__all__: list[str] = [
    "DisturbanceObserver",
    "DisturbanceObserverConfig",
    "DisturbanceObserverOutput",
    "DisturbanceObserverState",
    "EnergyTank",
    "EnergyTankConfig",
    "EnergyTankOutput",
    "EnergyTankState",
    "FrameMapping",
    "FrameMappingConfig",
    "FrameMappingOutput",
    "FrameMappingState",
    "LedgerReceiver",
    "LedgerReceiverState",
    "LedgerSender",
    "Mapping",
    "Transparency",
    "TransparencyConfig",
    "TransparencyMode",
    "TransparencyOutput",
    "TransparencyState",
    "TwistEstimator",
    "TwistEstimatorConfig",
    "TwistEstimatorOutput",
    "TwistEstimatorState",
    "VelocityIntegrator",
    "VelocityIntegratorConfig",
    "VelocityIntegratorOutput",
    "VelocityIntegratorState",
    "project_on_pivot",
]

class TwistEstimatorConfig:
    """
    Limits and filter of a TwistEstimator.
    """

    _fields: typing.ClassVar[list] = ["cutoff_hz", "dt_max_s"]
    def __copy__(self) -> TwistEstimatorConfig: ...
    def __deepcopy__(self, arg0: dict) -> TwistEstimatorConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Limits and filter of a TwistEstimator.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def cutoff_hz(self) -> float:
        """
        cut-off of the low-pass behind twist_filtered [Hz]
        """
    @cutoff_hz.setter
    def cutoff_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest interval that still gives a twist [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class TwistEstimatorOutput:
    """
    Result of TwistEstimator.step.
    """

    _fields: typing.ClassVar[list] = ["twist", "twist_filtered", "status"]
    def __copy__(self) -> TwistEstimatorOutput: ...
    def __deepcopy__(self, arg0: dict) -> TwistEstimatorOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of TwistEstimator.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) displacement / dt in the base frame [m/s, rad/s]
        """
    @twist.setter
    def twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def twist_filtered(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) low-passed, for damping and display
        """
    @twist_filtered.setter
    def twist_filtered(self, arg1: numpy.typing.ArrayLike) -> None: ...

class TwistEstimatorState:
    """
    All that a TwistEstimator remembers.
    """

    _fields: typing.ClassVar[list] = ["has_previous", "base_T_previous", "twist_filtered"]
    def __copy__(self) -> TwistEstimatorState: ...
    def __deepcopy__(self, arg0: dict) -> TwistEstimatorState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a TwistEstimator remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def base_T_previous(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) last pose
        """
    @base_T_previous.setter
    def base_T_previous(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def has_previous(self) -> bool:
        """
        whether a pose was seen
        """
    @has_previous.setter
    def has_previous(self, arg1: bool) -> None: ...
    @property
    def twist_filtered(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) filter state
        """
    @twist_filtered.setter
    def twist_filtered(self, arg1: numpy.typing.ArrayLike) -> None: ...

class TwistEstimator:
    """
    Mean twist of a moving frame over each interval, raw and low-passed.
    """
    def __init__(self, config: TwistEstimatorConfig = ...) -> None: ...
    def reset(self, state: TwistEstimatorState = ...) -> None: ...
    def step(
        self, base_T_body: numpy.typing.ArrayLike, dt: typing.SupportsFloat | typing.SupportsIndex
    ) -> TwistEstimatorOutput:
        """
        One tick: the (4, 4) pose now, dt [s] since the last one.
        """
    @property
    def state(self) -> TwistEstimatorState: ...

class Mapping:
    """
    Where base_T_console comes from.

    Members:

      STATIC : the configuration

      ENDOSCOPE : each input, so that the hand moves as the picture shows
    """

    ENDOSCOPE: typing.ClassVar[Mapping]
    STATIC: typing.ClassVar[Mapping]
    __members__: typing.ClassVar[dict[str, Mapping]]
    @typing.overload
    def __eq__(self, other: Mapping) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Mapping) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class FrameMappingConfig:
    """
    Frames, filter and limits of a FrameMapping.
    """

    _fields: typing.ClassVar[list] = ["mapping", "base_T_console", "touch_T_console", "cutoff_hz", "dt_max_s"]
    def __copy__(self) -> FrameMappingConfig: ...
    def __deepcopy__(self, arg0: dict) -> FrameMappingConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Frames, filter and limits of a FrameMapping.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def base_T_console(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) console (simball_base) in the arm's base, for Mapping.STATIC
        """
    @base_T_console.setter
    def base_T_console(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def cutoff_hz(self) -> float:
        """
        cut-off of the low-pass behind tracked_twist_filtered [Hz]
        """
    @cutoff_hz.setter
    def cutoff_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        a longer interval re-references like a clutch [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mapping(self) -> Mapping:
        """
        Mapping.STATIC or Mapping.ENDOSCOPE
        """
    @mapping.setter
    def mapping(self, arg1: Mapping) -> None: ...
    @property
    def touch_T_console(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) console in the frame in which the device takes forces; its rotation is used
        """
    @touch_T_console.setter
    def touch_T_console(self, arg1: numpy.typing.ArrayLike) -> None: ...

class FrameMappingOutput:
    """
    Result of FrameMapping.step. Twists are means over interval_s, in base axes.
    """

    _fields: typing.ClassVar[list] = [
        "has_pose",
        "has_wrench",
        "tracked_pose",
        "tracked_twist",
        "tracked_twist_filtered",
        "handle_twist",
        "touch_wrench",
        "interval_s",
        "gap",
        "status",
    ]
    def __copy__(self) -> FrameMappingOutput: ...
    def __deepcopy__(self, arg0: dict) -> FrameMappingOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of FrameMapping.step. Twists are means over interval_s, in base axes.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def gap(self) -> bool:
        """
        interval_s was above dt_max_s: re-referenced
        """
    @gap.setter
    def gap(self, arg1: bool) -> None: ...
    @property
    def handle_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) of the handle, also under clutch and over gaps: bill energy with it
        """
    @handle_twist.setter
    def handle_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def has_pose(self) -> bool:
        """
        pose and twists are new: publish them
        """
    @has_pose.setter
    def has_pose(self, arg1: bool) -> None: ...
    @property
    def has_wrench(self) -> bool:
        """
        touch_wrench is new: publish it
        """
    @has_wrench.setter
    def has_wrench(self, arg1: bool) -> None: ...
    @property
    def interval_s(self) -> float:
        """
        time that the twists span [s]
        """
    @interval_s.setter
    def interval_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def touch_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) for the hand in touch axes [N, N m]
        """
    @touch_wrench.setter
    def touch_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tracked_pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tracked, never jumps
        """
    @tracked_pose.setter
    def tracked_pose(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tracked_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) of tracked_pose [m/s, rad/s]; 0 under clutch
        """
    @tracked_twist.setter
    def tracked_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tracked_twist_filtered(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) low-passed
        """
    @tracked_twist_filtered.setter
    def tracked_twist_filtered(self, arg1: numpy.typing.ArrayLike) -> None: ...

class FrameMappingState:
    """
    All that a FrameMapping remembers.
    """

    _fields: typing.ClassVar[list] = [
        "has_reference",
        "base_T_reference",
        "console_T_reference",
        "base_T_console",
        "console_T_previous",
        "base_T_tracked",
        "tracked_twist_filtered",
        "elapsed_s",
    ]
    def __copy__(self) -> FrameMappingState: ...
    def __deepcopy__(self, arg0: dict) -> FrameMappingState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a FrameMapping remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def base_T_console(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) mapping in use
        """
    @base_T_console.setter
    def base_T_console(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def base_T_reference(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) tracked pose at the reference
        """
    @base_T_reference.setter
    def base_T_reference(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def base_T_tracked(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) last tracked pose
        """
    @base_T_tracked.setter
    def base_T_tracked(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def console_T_previous(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) handle at the last good input
        """
    @console_T_previous.setter
    def console_T_previous(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def console_T_reference(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) handle at the reference
        """
    @console_T_reference.setter
    def console_T_reference(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def elapsed_s(self) -> float:
        """
        time since the last good input [s]
        """
    @elapsed_s.setter
    def elapsed_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def has_reference(self) -> bool:
        """
        whether a pose was seen
        """
    @has_reference.setter
    def has_reference(self, arg1: bool) -> None: ...
    @property
    def tracked_twist_filtered(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) filter state
        """
    @tracked_twist_filtered.setter
    def tracked_twist_filtered(self, arg1: numpy.typing.ArrayLike) -> None: ...

class FrameMapping:
    """
    Handle pose and twist from the console's frame to the arm's base frame, wrench back.
    """
    def __init__(self, config: FrameMappingConfig = ...) -> None: ...
    def reset(self, state: FrameMappingState = ...) -> None:
        """
        Without argument: new reference.
        """
    def step(
        self,
        console_T_handle: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        clutch: bool = False,
        base_wrench: numpy.typing.ArrayLike = ...,
        base_T_console: numpy.typing.ArrayLike | None = None,
        stale: bool = False,
    ) -> FrameMappingOutput:
        """
        One tick.

        console_T_handle: (4, 4) measured handle in simball_base. dt: since the previous step [s].
        base_wrench: (6,) for the hand in base axes. base_T_console: (4, 4), needed by Mapping.ENDOSCOPE.
        stale: the pose is older than its limit. Publish only what has_pose and has_wrench allow.
        """
    @property
    def config(self) -> FrameMappingConfig: ...
    @property
    def state(self) -> FrameMappingState: ...

class TransparencyMode:
    """
    What the hand feels.

    Members:

      POSITION_POSITION : the position error

      POSITION_FORCE : the force on the tissue

      FOUR_CHANNEL : the sum of both
    """

    FOUR_CHANNEL: typing.ClassVar[TransparencyMode]
    POSITION_FORCE: typing.ClassVar[TransparencyMode]
    POSITION_POSITION: typing.ClassVar[TransparencyMode]
    __members__: typing.ClassVar[dict[str, TransparencyMode]]
    @typing.overload
    def __eq__(self, other: TransparencyMode) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: TransparencyMode) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class TransparencyConfig:
    """
    Gains and limits of a Transparency.
    """

    _fields: typing.ClassVar[list] = [
        "mode",
        "scale",
        "stiffness_N_m",
        "damping_N_s_m",
        "rotation_stiffness_Nm_rad",
        "rotation_damping_Nm_s_rad",
        "force_scale",
        "torque_scale",
        "force_limit_N",
        "torque_limit_Nm",
        "ramp_s",
        "drift_gain_1_s",
        "drift_limit_m_s",
        "slave_lag_s",
        "rotation_drift_gain_1_s",
        "rotation_drift_limit_rad_s",
        "pivoted",
        "pivot_radius_min_m",
        "dt_max_s",
    ]
    def __copy__(self) -> TransparencyConfig: ...
    def __deepcopy__(self, arg0: dict) -> TransparencyConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Gains and limits of a Transparency.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def damping_N_s_m(self) -> float:
        """
        force on the hand per slave error velocity [N s/m]
        """
    @damping_N_s_m.setter
    def damping_N_s_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def drift_gain_1_s(self) -> float:
        """
        removes the drift that a reduced command leaves [1/s]
        """
    @drift_gain_1_s.setter
    def drift_gain_1_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def drift_limit_m_s(self) -> float:
        """
        largest speed of that correction [m/s]
        """
    @drift_limit_m_s.setter
    def drift_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
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
        largest force on the hand [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_scale(self) -> float:
        """
        force on the hand per force on the tissue
        """
    @force_scale.setter
    def force_scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mode(self) -> TransparencyMode:
        """
        TransparencyMode
        """
    @mode.setter
    def mode(self, arg1: TransparencyMode) -> None: ...
    @property
    def pivot_radius_min_m(self) -> float:
        """
        distance trocar - tip below which pivot rates are no longer raised [m]
        """
    @pivot_radius_min_m.setter
    def pivot_radius_min_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pivoted(self) -> bool:
        """
        project the slave's twist on an arm that pivots about its trocar
        """
    @pivoted.setter
    def pivoted(self, arg1: bool) -> None: ...
    @property
    def ramp_s(self) -> float:
        """
        force fades in and out over this time [s]
        """
    @ramp_s.setter
    def ramp_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_damping_Nm_s_rad(self) -> float:
        """
        torque per its rate [N m s/rad]
        """
    @rotation_damping_Nm_s_rad.setter
    def rotation_damping_Nm_s_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_drift_gain_1_s(self) -> float:
        """
        the same for rotation [1/s]
        """
    @rotation_drift_gain_1_s.setter
    def rotation_drift_gain_1_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_drift_limit_rad_s(self) -> float:
        """
        its largest rate [rad/s]
        """
    @rotation_drift_limit_rad_s.setter
    def rotation_drift_limit_rad_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rotation_stiffness_Nm_rad(self) -> float:
        """
        torque per rotation error [N m/rad]
        """
    @rotation_stiffness_Nm_rad.setter
    def rotation_stiffness_Nm_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def scale(self) -> float:
        """
        slave metres per master metre, (0, 10]
        """
    @scale.setter
    def scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def slave_lag_s(self) -> float:
        """
        of the arm in free motion: no drift, not corrected [s]
        """
    @slave_lag_s.setter
    def slave_lag_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        force on the hand per metre of slave error [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_limit_Nm(self) -> float:
        """
        largest torque on the hand [N m]
        """
    @torque_limit_Nm.setter
    def torque_limit_Nm(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def torque_scale(self) -> float:
        """
        torque on the hand per torque on the tissue
        """
    @torque_scale.setter
    def torque_scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class TransparencyOutput:
    """
    Result of Transparency.step, in the slave's base frame.
    """

    _fields: typing.ClassVar[list] = ["desired_wrench", "desired_twist", "error", "status"]
    def __copy__(self) -> TransparencyOutput: ...
    def __deepcopy__(self, arg0: dict) -> TransparencyOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of Transparency.step, in the slave's base frame.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def desired_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) of the slave's tip [m/s, rad/s]
        """
    @desired_twist.setter
    def desired_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def desired_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the operator's hand [N, N m]
        """
    @desired_wrench.setter
    def desired_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def error(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) slave - mapped master [slave m, rad]
        """
    @error.setter
    def error(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...

class TransparencyState:
    """
    All that a Transparency remembers.
    """

    _fields: typing.ClassVar[list] = [
        "has_reference",
        "master_reference",
        "slave_reference",
        "lagged_master",
        "ramp",
        "wrench",
    ]
    def __copy__(self) -> TransparencyState: ...
    def __deepcopy__(self, arg0: dict) -> TransparencyState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a Transparency remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def has_reference(self) -> bool:
        """
        whether references were taken
        """
    @has_reference.setter
    def has_reference(self, arg1: bool) -> None: ...
    @property
    def lagged_master(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) scaled master displacement behind slave_lag_s [m]
        """
    @lagged_master.setter
    def lagged_master(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def master_reference(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) master pose there
        """
    @master_reference.setter
    def master_reference(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def ramp(self) -> float:
        """
        0 = no force, 1 = all of it
        """
    @ramp.setter
    def ramp(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def slave_reference(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) slave pose there
        """
    @slave_reference.setter
    def slave_reference(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) last wrench before the ramp
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class Transparency:
    """
    Desired wrench on the hand and desired twist of the slave, one side.
    """
    def __init__(self, config: TransparencyConfig = ...) -> None: ...
    def reset(self, state: TransparencyState = ...) -> None:
        """
        Without argument: new references at the next good input (engagement).
        """
    def step(
        self,
        master_pose: numpy.typing.ArrayLike,
        master_twist: numpy.typing.ArrayLike,
        slave_pose: numpy.typing.ArrayLike,
        slave_twist: numpy.typing.ArrayLike,
        tissue_wrench: numpy.typing.ArrayLike,
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        clutch: bool = False,
        stale: bool = False,
        master_twist_filtered: numpy.typing.ArrayLike | None = None,
        guidance_wrench: numpy.typing.ArrayLike = ...,
    ) -> TransparencyOutput:
        """
        One tick; everything in the slave's base frame.

        master_pose: (4, 4) tracked pose, master_twist: (6,). slave_pose: (4, 4) measured tip, slave_twist: (6,).
        tissue_wrench: (6,) exerted on the tissue. rcm: (3,) trocar [m]. dt: since the previous step [s].
        stale: any of these is older than its limit. master_twist_filtered: (6,) for the damping term.
        guidance_wrench: (6,) further wrench on the hand, from fixtures or nearness.
        """
    @property
    def config(self) -> TransparencyConfig: ...
    @property
    def state(self) -> TransparencyState: ...

class EnergyTankConfig:
    """
    Levels, damping and limits of an EnergyTank; 0 < minimum < request < available < maximum.
    """

    _fields: typing.ClassVar[list] = [
        "initial_J",
        "minimum_J",
        "request_J",
        "available_J",
        "maximum_J",
        "exchange_W",
        "damping_min",
        "damping_max",
        "conjugate_rate",
        "applied_limit",
        "hold_s",
        "dt_max_s",
    ]
    def __copy__(self) -> EnergyTankConfig: ...
    def __deepcopy__(self, arg0: dict) -> EnergyTankConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Levels, damping and limits of an EnergyTank; 0 < minimum < request < available < maximum.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def applied_limit(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) saturation of the output, per axis
        """
    @applied_limit.setter
    def applied_limit(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def available_J(self) -> float:
        """
        above it the tank may give; asking stops here [J]
        """
    @available_J.setter
    def available_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def conjugate_rate(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) largest rate of change of the conjugate [unit/s]
        """
    @conjugate_rate.setter
    def conjugate_rate(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def damping_max(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) B with an empty tank
        """
    @damping_max.setter
    def damping_max(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def damping_min(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) B with a full tank; 0 on axes without a motor
        """
    @damping_min.setter
    def damping_min(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        a longer interval is billed, and answered by zero [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def exchange_W(self) -> float:
        """
        largest power to one requesting peer [W]
        """
    @exchange_W.setter
    def exchange_W(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def hold_s(self) -> float:
        """
        longest time the device keeps a command before it zeroes it [s]
        """
    @hold_s.setter
    def hold_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def initial_J(self) -> float:
        """
        level at construction, counted as granted; minimum_J for a restart [J]
        """
    @initial_J.setter
    def initial_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def maximum_J(self) -> float:
        """
        capacity [J]
        """
    @maximum_J.setter
    def maximum_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def minimum_J(self) -> float:
        """
        below it only damping acts [J]
        """
    @minimum_J.setter
    def minimum_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def request_J(self) -> float:
        """
        below it the tank asks its peers and reduces the command [J]
        """
    @request_J.setter
    def request_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class EnergyTankOutput:
    """
    Result of EnergyTank.step.
    """

    _fields: typing.ClassVar[list] = [
        "applied",
        "energy_J",
        "sent_J",
        "sent_overflow_J",
        "requesting",
        "has_room",
        "reduction",
        "scale",
        "damping",
        "status",
    ]
    def __copy__(self) -> EnergyTankOutput: ...
    def __deepcopy__(self, arg0: dict) -> EnergyTankOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of EnergyTank.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def applied(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) goes to the device
        """
    @applied.setter
    def applied(self, arg1: typing.Any) -> None: ...
    @property
    def damping(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) B of this tick
        """
    @damping.setter
    def damping(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def energy_J(self) -> float:
        """
        level after this tick [J]
        """
    @energy_J.setter
    def energy_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def has_room(self) -> bool:
        """
        the tank can take more
        """
    @has_room.setter
    def has_room(self, arg1: bool) -> None: ...
    @property
    def reduction(self) -> float:
        """
        K_E in [0, 1]
        """
    @reduction.setter
    def reduction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def requesting(self) -> bool:
        """
        ask the peers for energy
        """
    @requesting.setter
    def requesting(self, arg1: bool) -> None: ...
    @property
    def scale(self) -> float:
        """
        alpha in [0, 1], what the budget over hold_s lets through
        """
    @scale.setter
    def scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def sent_J(self) -> float:
        """
        left for the peers in this tick: put it on the ledger [J]
        """
    @sent_J.setter
    def sent_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def sent_overflow_J(self) -> float:
        """
        the part of sent_J that is overflow [J]
        """
    @sent_overflow_J.setter
    def sent_overflow_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...

class EnergyTankState:
    """
    All that an EnergyTank remembers; cumulative joules since construction or restart.
    """

    _fields: typing.ClassVar[list] = [
        "energy_J",
        "granted_J",
        "work_out_J",
        "received_J",
        "sent_J",
        "vented_J",
        "requesting",
        "rate_locked",
        "has_conjugate",
        "applied",
        "conjugate",
    ]
    def __copy__(self) -> EnergyTankState: ...
    def __deepcopy__(self, arg0: dict) -> EnergyTankState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that an EnergyTank remembers; cumulative joules since construction or restart.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def applied(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the last tick
        """
    @applied.setter
    def applied(self, arg1: typing.Any) -> None: ...
    @property
    def conjugate(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 6) of the last tick
        """
    @conjugate.setter
    def conjugate(self, arg1: typing.Any) -> None: ...
    @property
    def energy_J(self) -> float:
        """
        level [J]
        """
    @energy_J.setter
    def energy_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def granted_J(self) -> float:
        """
        starting charge and grants [J]
        """
    @granted_J.setter
    def granted_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def has_conjugate(self) -> bool:
        """
        whether the last tick had a usable conjugate
        """
    @has_conjugate.setter
    def has_conjugate(self, arg1: bool) -> None: ...
    @property
    def rate_locked(self) -> bool:
        """
        damping only until energy_J > minimum_J
        """
    @rate_locked.setter
    def rate_locked(self, arg1: bool) -> None: ...
    @property
    def received_J(self) -> float:
        """
        from peers [J]
        """
    @received_J.setter
    def received_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def requesting(self) -> bool:
        """
        asks its peers for energy
        """
    @requesting.setter
    def requesting(self, arg1: bool) -> None: ...
    @property
    def sent_J(self) -> float:
        """
        to peers [J]
        """
    @sent_J.setter
    def sent_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def vented_J(self) -> float:
        """
        discarded because the tank was full [J]
        """
    @vented_J.setter
    def vented_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def work_out_J(self) -> float:
        """
        through the ports; negative: the surroundings put energy in [J]
        """
    @work_out_J.setter
    def work_out_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class EnergyTank:
    """
    The passivity layer: bounds what motors may do by a store of energy.

    At a handle (port guard) desired/applied are wrenches on the hand and conjugate its twist; at an arm
    desired/applied are twists and conjugate the wrench exerted on the tissue. Always, to rounding:
    energy_J + work_out_J + sent_J + vented_J == granted_J + received_J.
    """
    def __init__(
        self, config: EnergyTankConfig = ..., channels: typing.SupportsInt | typing.SupportsIndex = 1
    ) -> None: ...
    def grant(self, energy_J: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Puts energy in from outside (engagement). Above maximum_J it is vented. ConfigError when negative or not finite.
        """
    def reset(self, state: EnergyTankState | None = None) -> None:
        """
        A restart (level minimum_J, all counters zero), or continuation from a recorded state.
        """
    def step(
        self,
        desired: typing.Any,
        conjugate: typing.Any,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        received_J: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        peer_requests: typing.SupportsInt | typing.SupportsIndex = 0,
        peer_has_room: bool = True,
        work_J: typing.SupportsFloat | typing.SupportsIndex | None = None,
        stale: bool = False,
        measured: typing.Any | None = None,
    ) -> EnergyTankOutput:
        """
        One tick.

        desired, conjugate: (n, 6), n channels; conjugate is the mean over the last interval.
        dt: seconds since the last tick. received_J: credited by the ledgers since then.
        peer_requests: how many peers ask for energy (bool or count). peer_has_room: some peer takes overflow.
        work_J: what really left through the ports; None bills applied_prev . conjugate . dt.
        stale: conjugate is too old: zero output. measured: (n, 6) the applied side as measured, for a lagging arm.
        """
    @property
    def channels(self) -> int: ...
    @property
    def config(self) -> EnergyTankConfig: ...
    @property
    def damping_reserve_J(self) -> float:
        """
        deepest that damping alone can take the level below minimum_J [J]
        """
    @property
    def state(self) -> EnergyTankState: ...

class LedgerSender:
    """
    Sums what a tank sends to one peer in this session.
    """
    def __init__(self, session: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        session: larger for every restart (such as a clock at start).
        """
    def next(self) -> tuple[int, int, float]:
        """
        (session, seq, sent_J) for the next message on the wire.
        """
    def send(self, energy_J: typing.SupportsFloat | typing.SupportsIndex) -> float:
        """
        Adds joules that left the tank; returns the cumulative sum.
        """
    @property
    def sent_J(self) -> float: ...
    @property
    def seq(self) -> int: ...
    @property
    def session(self) -> int: ...

class LedgerReceiverState:
    """
    All that a LedgerReceiver remembers.
    """

    _fields: typing.ClassVar[list] = ["has_baseline", "session", "seq", "seen_J", "credited_J", "ignored"]
    def __copy__(self) -> LedgerReceiverState: ...
    def __deepcopy__(self, arg0: dict) -> LedgerReceiverState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a LedgerReceiver remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def credited_J(self) -> float:
        """
        credited over all sessions [J]
        """
    @credited_J.setter
    def credited_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def has_baseline(self) -> bool:
        """
        a message of this session was seen
        """
    @has_baseline.setter
    def has_baseline(self, arg1: bool) -> None: ...
    @property
    def ignored(self) -> int:
        """
        messages not used
        """
    @ignored.setter
    def ignored(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def seen_J(self) -> float:
        """
        newest cumulative total [J]
        """
    @seen_J.setter
    def seen_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def seq(self) -> int:
        """
        newest message
        """
    @seq.setter
    def seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        the sender's session
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class LedgerReceiver:
    """
    Turns a peer's cumulative sums into credits, each joule once.
    """
    def __init__(self) -> None: ...
    def credit(
        self,
        session: typing.SupportsInt | typing.SupportsIndex,
        seq: typing.SupportsInt | typing.SupportsIndex,
        sent_J: typing.SupportsFloat | typing.SupportsIndex,
    ) -> float:
        """
        Joules to credit. 0 for the first message of a session (the baseline), older sessions, repeats, bad numbers.
        """
    def reset(self) -> None: ...
    @property
    def state(self) -> LedgerReceiverState: ...

class VelocityIntegratorConfig:
    """
    Bounds of a VelocityIntegrator.
    """

    _fields: typing.ClassVar[list] = [
        "speed_limit_m_s",
        "speed_limit_rad_s",
        "lead_limit_m",
        "lead_limit_rad",
        "cone_axis",
        "cone_half_angle_rad",
        "insertion_min_m",
        "insertion_max_m",
        "measured_jump_m",
        "shaft_through_rcm",
        "nominal_dt_s",
        "dt_max_s",
    ]
    def __copy__(self) -> VelocityIntegratorConfig: ...
    def __deepcopy__(self, arg0: dict) -> VelocityIntegratorConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Bounds of a VelocityIntegrator.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def cone_axis(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit, base frame: from the trocar into the patient
        """
    @cone_axis.setter
    def cone_axis(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def cone_half_angle_rad(self) -> float:
        """
        (0, pi/2) [rad]
        """
    @cone_half_angle_rad.setter
    def cone_half_angle_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        a longer time step is a stall [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def insertion_max_m(self) -> float:
        """
        greatest distance trocar - tip [m]
        """
    @insertion_max_m.setter
    def insertion_max_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def insertion_min_m(self) -> float:
        """
        least distance trocar - tip [m]
        """
    @insertion_min_m.setter
    def insertion_min_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lead_limit_m(self) -> float:
        """
        set-point ahead of measured [m]
        """
    @lead_limit_m.setter
    def lead_limit_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def lead_limit_rad(self) -> float:
        """
        set-point ahead of measured [rad]
        """
    @lead_limit_rad.setter
    def lead_limit_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def measured_jump_m(self) -> float:
        """
        measured further than this from the last is refused [m]
        """
    @measured_jump_m.setter
    def measured_jump_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def nominal_dt_s(self) -> float:
        """
        one period: the first step, and the most after a stall [s]
        """
    @nominal_dt_s.setter
    def nominal_dt_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def shaft_through_rcm(self) -> bool:
        """
        orientation follows from the trocar; only roll is taken from the twist
        """
    @shaft_through_rcm.setter
    def shaft_through_rcm(self, arg1: bool) -> None: ...
    @property
    def speed_limit_m_s(self) -> float:
        """
        no set-point step is longer than this times dt [m/s]
        """
    @speed_limit_m_s.setter
    def speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed_limit_rad_s(self) -> float:
        """
        the same for rotation [rad/s]
        """
    @speed_limit_rad_s.setter
    def speed_limit_rad_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class VelocityIntegratorOutput:
    """
    Result of VelocityIntegrator.step.
    """

    _fields: typing.ClassVar[list] = [
        "has_set_point",
        "set_point",
        "lead_m",
        "speed_limited",
        "approach_limited",
        "lead_limited",
        "cone_limited",
        "insertion_limited",
        "fixture_limited",
        "measured_jumped",
        "status",
    ]
    def __copy__(self) -> VelocityIntegratorOutput: ...
    def __deepcopy__(self, arg0: dict) -> VelocityIntegratorOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of VelocityIntegrator.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def approach_limited(self) -> bool:
        """
        command above the approach limit
        """
    @approach_limited.setter
    def approach_limited(self, arg1: bool) -> None: ...
    @property
    def cone_limited(self) -> bool:
        """
        at the edge of the cone
        """
    @cone_limited.setter
    def cone_limited(self, arg1: bool) -> None: ...
    @property
    def fixture_limited(self) -> bool:
        """
        at a virtual fixture
        """
    @fixture_limited.setter
    def fixture_limited(self, arg1: bool) -> None: ...
    @property
    def has_set_point(self) -> bool:
        """
        false until a measured pose was seen: send nothing
        """
    @has_set_point.setter
    def has_set_point(self, arg1: bool) -> None: ...
    @property
    def insertion_limited(self) -> bool:
        """
        at the least or greatest insertion
        """
    @insertion_limited.setter
    def insertion_limited(self, arg1: bool) -> None: ...
    @property
    def lead_limited(self) -> bool:
        """
        set-point too far ahead of measured
        """
    @lead_limited.setter
    def lead_limited(self, arg1: bool) -> None: ...
    @property
    def lead_m(self) -> float:
        """
        distance set-point - measured [m]
        """
    @lead_m.setter
    def lead_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def measured_jumped(self) -> bool:
        """
        measured pose refused
        """
    @measured_jumped.setter
    def measured_jumped(self, arg1: bool) -> None: ...
    @property
    def set_point(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tip, always finite
        """
    @set_point.setter
    def set_point(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def speed_limited(self) -> bool:
        """
        command above the speed limit
        """
    @speed_limited.setter
    def speed_limited(self, arg1: bool) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...

class VelocityIntegratorState:
    """
    All that a VelocityIntegrator remembers.
    """

    _fields: typing.ClassVar[list] = ["started", "set_point", "measured_position"]
    def __copy__(self) -> VelocityIntegratorState: ...
    def __deepcopy__(self, arg0: dict) -> VelocityIntegratorState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a VelocityIntegrator remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def measured_position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) last accepted [m]
        """
    @measured_position.setter
    def measured_position(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def set_point(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) last set-point
        """
    @set_point.setter
    def set_point(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def started(self) -> bool:
        """
        whether a measured pose was seen
        """
    @started.setter
    def started(self, arg1: bool) -> None: ...

class VelocityIntegrator:
    """
    From a twist to the arm's set-point, within hard bounds.
    """
    def __init__(self, config: VelocityIntegratorConfig = ...) -> None: ...
    def reset(self, state: VelocityIntegratorState = ...) -> None:
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
    ) -> VelocityIntegratorOutput:
        """
        One tick; everything in the arm's base frame.

        twist: (6,) of the tip. measured_pose: (4, 4). rcm: (3,) trocar [m]. dt: since the previous step [s].
        stale: the twist is older than its limit (taken as zero). max_speed_scale: 0..1 of both speed limits.
        approach_direction: (3,) towards what is near; approach_speed_limit_m_s: along it, retreat is free.
        """
    @property
    def config(self) -> VelocityIntegratorConfig: ...
    @property
    def state(self) -> VelocityIntegratorState: ...

class DisturbanceObserverConfig:
    """
    Servo model and filter of a DisturbanceObserver.
    """

    _fields: typing.ClassVar[list] = [
        "natural_frequency_rad_s",
        "damping_ratio",
        "mass_kg",
        "cutoff_hz",
        "deadband_N",
        "settle_s",
        "dt_max_s",
    ]
    def __copy__(self) -> DisturbanceObserverConfig: ...
    def __deepcopy__(self, arg0: dict) -> DisturbanceObserverConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Servo model and filter of a DisturbanceObserver.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def cutoff_hz(self) -> float:
        """
        of the second-order low-pass on the force [Hz]
        """
    @cutoff_hz.setter
    def cutoff_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping_ratio(self) -> float:
        """
        of the arm's servo, [0.1, 10]
        """
    @damping_ratio.setter
    def damping_ratio(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def deadband_N(self) -> float:
        """
        below it none, exact above twice it [N]
        """
    @deadband_N.setter
    def deadband_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        a longer gap restarts the observer [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mass_kg(self) -> float:
        """
        effective mass at the tip [kg]
        """
    @mass_kg.setter
    def mass_kg(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def natural_frequency_rad_s(self) -> float:
        """
        of the arm's servo [rad/s]
        """
    @natural_frequency_rad_s.setter
    def natural_frequency_rad_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def settle_s(self) -> float:
        """
        no estimate for this long after a (re)start [s]
        """
    @settle_s.setter
    def settle_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class DisturbanceObserverOutput:
    """
    Result of DisturbanceObserver.step.
    """

    _fields: typing.ClassVar[list] = ["has_wrench", "wrench", "status"]
    def __copy__(self) -> DisturbanceObserverOutput: ...
    def __deepcopy__(self, arg0: dict) -> DisturbanceObserverOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of DisturbanceObserver.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def has_wrench(self) -> bool:
        """
        otherwise the wrench is unknown, not zero
        """
    @has_wrench.setter
    def has_wrench(self, arg1: bool) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) exerted on the tissue [N, 0]
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class DisturbanceObserverState:
    """
    All that a DisturbanceObserver remembers.
    """

    _fields: typing.ClassVar[list] = [
        "started",
        "free_position",
        "free_velocity",
        "error",
        "error_filtered",
        "error_rate_filtered",
        "elapsed_s",
        "settled_s",
    ]
    def __copy__(self) -> DisturbanceObserverState: ...
    def __deepcopy__(self, arg0: dict) -> DisturbanceObserverState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a DisturbanceObserver remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def elapsed_s(self) -> float:
        """
        time since the last good input [s]
        """
    @elapsed_s.setter
    def elapsed_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def error(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) measured - free_position [m]
        """
    @error.setter
    def error(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def error_filtered(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) low-passed [m]
        """
    @error_filtered.setter
    def error_filtered(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def error_rate_filtered(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) its rate [m/s]
        """
    @error_rate_filtered.setter
    def error_rate_filtered(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def free_position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) tip of the model in free motion [m]
        """
    @free_position.setter
    def free_position(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def free_velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) its velocity [m/s]
        """
    @free_velocity.setter
    def free_velocity(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def settled_s(self) -> float:
        """
        time since the (re)start, up to settle_s [s]
        """
    @settled_s.setter
    def settled_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def started(self) -> bool:
        """
        whether an input was seen
        """
    @started.setter
    def started(self, arg1: bool) -> None: ...

class DisturbanceObserver:
    """
    Wrench on the tissue from the arm's servo model, without the lag of free motion.
    """
    def __init__(self, config: DisturbanceObserverConfig = ...) -> None: ...
    def reset(self, state: DisturbanceObserverState = ...) -> None: ...
    def step(
        self,
        set_point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        measured: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        stale: bool = False,
    ) -> DisturbanceObserverOutput:
        """
        One tick; base frame of the arm.

        set_point: (3,) tip position that the arm followed since the previous step [m]. measured: (3,) tip now [m].
        dt: since the previous step [s]. stale: either of them is older than its limit.
        """
    @property
    def config(self) -> DisturbanceObserverConfig: ...
    @property
    def state(self) -> DisturbanceObserverState: ...

def project_on_pivot(
    tip_twist: numpy.typing.ArrayLike,
    base_T_tip: numpy.typing.ArrayLike,
    rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    radius_min: typing.SupportsFloat | typing.SupportsIndex = 0.01,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    The part (6,) of a tip twist (6,) that an arm pivoting about rcm (3,) can do: translation kept,
    rotation = pivoting + roll. Closer than radius_min [m] the pivot rate is that at radius_min.
    """
