"""
Both sides of the teleoperation in one step
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import saras._core
import saras._core.collision
import saras._core.csa
import saras._core.net
import saras._core.teleop
import typing

__all__: list[str] = [
    "ArmInput",
    "DistancesConfig",
    "HandleInput",
    "NearnessInput",
    "Pipeline",
    "PipelineConfig",
    "PipelineInput",
    "PipelineOutput",
    "PipelineSideOutput",
    "PipelineState",
    "SceneInput",
    "SideInput",
    "SupervisorWord",
    "TankOutput",
]

class DistancesConfig:
    """
    The distances that the pipeline takes itself.
    """

    _fields: typing.ClassVar[list] = ["enabled", "monitor", "radius_m", "other_tools", "regions", "scene_timeout_s"]
    def __copy__(self) -> DistancesConfig: ...
    def __deepcopy__(self, arg0: dict) -> DistancesConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        The distances that the pipeline takes itself.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def enabled(self) -> bool:
        """
        else the nearness is an input
        """
    @enabled.setter
    def enabled(self, arg1: bool) -> None: ...
    @property
    def monitor(self) -> saras._core.collision.ProximityMonitorConfig:
        """
        saras.collision.ProximityMonitorConfig
        """
    @monitor.setter
    def monitor(self, arg1: saras._core.collision.ProximityMonitorConfig) -> None: ...
    @property
    def other_tools(self) -> int:
        """
        tools of other robots, 0..6
        """
    @other_tools.setter
    def other_tools(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def radius_m(self) -> float:
        """
        of a SARAS instrument's shaft [m]
        """
    @radius_m.setter
    def radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def regions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 8, 3) vertices in the regions' frame [m]
        """
    @regions.setter
    def regions(self, arg1: typing.Any) -> None: ...
    @property
    def scene_timeout_s(self) -> float:
        """
        an older scene is unknown [s]
        """
    @scene_timeout_s.setter
    def scene_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class PipelineConfig:
    """
    Parameters of all laws of both sides, and how old their inputs may be.
    """

    _fields: typing.ClassVar[list] = [
        "left_mapping",
        "right_mapping",
        "transparency",
        "slave_twist",
        "repulsion",
        "proximity_force",
        "tank_master",
        "tank_slave",
        "left_integrator",
        "right_integrator",
        "proximity_slowdown",
        "left_unknown_speed_m_s",
        "right_unknown_speed_m_s",
        "distances",
        "left_fixtures",
        "right_fixtures",
        "fixture_force",
        "observe",
        "observer",
        "handle_timeout_s",
        "arm_timeout_s",
        "channel_timeout_s",
        "peer_timeout_s",
        "nearness_timeout_s",
        "session",
    ]
    def __copy__(self) -> PipelineConfig: ...
    def __deepcopy__(self, arg0: dict) -> PipelineConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Parameters of all laws of both sides, and how old their inputs may be.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def arm_timeout_s(self) -> float:
        """
        an older pose or wrench of the arm is unknown [s]
        """
    @arm_timeout_s.setter
    def arm_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def channel_timeout_s(self) -> float:
        """
        a supervisor silent for longer means HOLD [s]
        """
    @channel_timeout_s.setter
    def channel_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def distances(self) -> DistancesConfig:
        """
        DistancesConfig
        """
    @distances.setter
    def distances(self, arg1: DistancesConfig) -> None: ...
    @property
    def fixture_force(self) -> saras._core.csa.FixtureForceConfig:
        """
        saras.csa.FixtureForceConfig
        """
    @fixture_force.setter
    def fixture_force(self, arg1: saras._core.csa.FixtureForceConfig) -> None: ...
    @property
    def handle_timeout_s(self) -> float:
        """
        an older handle is stale [s]
        """
    @handle_timeout_s.setter
    def handle_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def left_fixtures(self) -> list[saras._core.csa.TeleopFixture]:
        """
        list of saras.csa.TeleopFixture in the arm's base frame
        """
    @left_fixtures.setter
    def left_fixtures(self, arg1: collections.abc.Sequence[saras._core.csa.TeleopFixture]) -> None: ...
    @property
    def left_integrator(self) -> saras._core.teleop.VelocityIntegratorConfig:
        """
        saras.teleop.VelocityIntegratorConfig
        """
    @left_integrator.setter
    def left_integrator(self, arg1: saras._core.teleop.VelocityIntegratorConfig) -> None: ...
    @property
    def left_mapping(self) -> saras._core.teleop.FrameMappingConfig:
        """
        saras.teleop.FrameMappingConfig
        """
    @left_mapping.setter
    def left_mapping(self, arg1: saras._core.teleop.FrameMappingConfig) -> None: ...
    @property
    def left_unknown_speed_m_s(self) -> float:
        """
        speed limit while the nearness is unknown [m/s]
        """
    @left_unknown_speed_m_s.setter
    def left_unknown_speed_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def nearness_timeout_s(self) -> float:
        """
        an older nearness is unknown [s]
        """
    @nearness_timeout_s.setter
    def nearness_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def observe(self) -> bool:
        """
        wrench on the tissue from the observer, else from the arm's input
        """
    @observe.setter
    def observe(self, arg1: bool) -> None: ...
    @property
    def observer(self) -> saras._core.teleop.DisturbanceObserverConfig:
        """
        saras.teleop.DisturbanceObserverConfig
        """
    @observer.setter
    def observer(self, arg1: saras._core.teleop.DisturbanceObserverConfig) -> None: ...
    @property
    def peer_timeout_s(self) -> float:
        """
        a port guard silent for longer wants nothing [s]
        """
    @peer_timeout_s.setter
    def peer_timeout_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def proximity_force(self) -> bool:
        """
        push the hand away from what its tool comes near to
        """
    @proximity_force.setter
    def proximity_force(self, arg1: bool) -> None: ...
    @property
    def proximity_slowdown(self) -> bool:
        """
        bound the speed near things and while they are unknown
        """
    @proximity_slowdown.setter
    def proximity_slowdown(self, arg1: bool) -> None: ...
    @property
    def repulsion(self) -> saras._core.collision.RepulsiveForceConfig:
        """
        saras.collision.RepulsiveForceConfig
        """
    @repulsion.setter
    def repulsion(self, arg1: saras._core.collision.RepulsiveForceConfig) -> None: ...
    @property
    def right_fixtures(self) -> list[saras._core.csa.TeleopFixture]:
        """
        list of saras.csa.TeleopFixture in the arm's base frame
        """
    @right_fixtures.setter
    def right_fixtures(self, arg1: collections.abc.Sequence[saras._core.csa.TeleopFixture]) -> None: ...
    @property
    def right_integrator(self) -> saras._core.teleop.VelocityIntegratorConfig:
        """
        saras.teleop.VelocityIntegratorConfig
        """
    @right_integrator.setter
    def right_integrator(self, arg1: saras._core.teleop.VelocityIntegratorConfig) -> None: ...
    @property
    def right_mapping(self) -> saras._core.teleop.FrameMappingConfig:
        """
        saras.teleop.FrameMappingConfig
        """
    @right_mapping.setter
    def right_mapping(self, arg1: saras._core.teleop.FrameMappingConfig) -> None: ...
    @property
    def right_unknown_speed_m_s(self) -> float:
        """
        speed limit while the nearness is unknown [m/s]
        """
    @right_unknown_speed_m_s.setter
    def right_unknown_speed_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        of the tanks' ledgers: larger for every restart
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def slave_twist(self) -> saras._core.teleop.TwistEstimatorConfig:
        """
        saras.teleop.TwistEstimatorConfig of the tips
        """
    @slave_twist.setter
    def slave_twist(self, arg1: saras._core.teleop.TwistEstimatorConfig) -> None: ...
    @property
    def tank_master(self) -> saras._core.teleop.EnergyTankConfig:
        """
        saras.teleop.EnergyTankConfig
        """
    @tank_master.setter
    def tank_master(self, arg1: saras._core.teleop.EnergyTankConfig) -> None: ...
    @property
    def tank_slave(self) -> saras._core.teleop.EnergyTankConfig:
        """
        saras.teleop.EnergyTankConfig
        """
    @tank_slave.setter
    def tank_slave(self, arg1: saras._core.teleop.EnergyTankConfig) -> None: ...
    @property
    def transparency(self) -> saras._core.teleop.TransparencyConfig:
        """
        saras.teleop.TransparencyConfig, both sides
        """
    @transparency.setter
    def transparency(self, arg1: saras._core.teleop.TransparencyConfig) -> None: ...

class HandleInput:
    """
    The newest datagram of a console about one handle.
    """

    _fields: typing.ClassVar[list] = ["is_new", "age_s", "simball_T_handle", "clutch", "ledger"]
    def __copy__(self) -> HandleInput: ...
    def __deepcopy__(self, arg0: dict) -> HandleInput: ...
    def __init__(self, **kwargs) -> None:
        """
        The newest datagram of a console about one handle.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        [s]; infinite: never came
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def clutch(self) -> bool:
        """
        pressed
        """
    @clutch.setter
    def clutch(self, arg1: bool) -> None: ...
    @property
    def is_new(self) -> bool:
        """
        came since the last step, with a valid reading
        """
    @is_new.setter
    def is_new(self, arg1: bool) -> None: ...
    @property
    def ledger(self) -> saras._core.net.PortLedger:
        """
        saras.net.PortLedger of the port guard
        """
    @ledger.setter
    def ledger(self, arg1: saras._core.net.PortLedger) -> None: ...
    @property
    def simball_T_handle(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @simball_T_handle.setter
    def simball_T_handle(self, arg1: numpy.typing.ArrayLike) -> None: ...

class ArmInput:
    """
    The newest sample of an arm, in its base frame.
    """

    _fields: typing.ClassVar[list] = [
        "is_new",
        "age_s",
        "interval_s",
        "base_T_tip",
        "target",
        "has_rcm",
        "rcm",
        "wrench_age_s",
        "exerted_wrench",
    ]
    def __copy__(self) -> ArmInput: ...
    def __deepcopy__(self, arg0: dict) -> ArmInput: ...
    def __init__(self, **kwargs) -> None:
        """
        The newest sample of an arm, in its base frame.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        [s]
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def base_T_tip(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) measured
        """
    @base_T_tip.setter
    def base_T_tip(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def exerted_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the tissue
        """
    @exerted_wrench.setter
    def exerted_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def has_rcm(self) -> bool:
        """
        whether the trocar is known
        """
    @has_rcm.setter
    def has_rcm(self, arg1: bool) -> None: ...
    @property
    def interval_s(self) -> float:
        """
        of a new one: since the one seen before; 0: not known [s]
        """
    @interval_s.setter
    def interval_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def is_new(self) -> bool:
        """
        came since the last step
        """
    @is_new.setter
    def is_new(self, arg1: bool) -> None: ...
    @property
    def rcm(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) trocar [m]
        """
    @rcm.setter
    def rcm(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def target(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) tip position that its servo follows [m]
        """
    @target.setter
    def target(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def wrench_age_s(self) -> float:
        """
        [s]
        """
    @wrench_age_s.setter
    def wrench_age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class SupervisorWord:
    """
    What the supervisor says of a side.
    """

    _fields: typing.ClassVar[list] = ["age_s", "state", "engagement", "clutch"]
    def __copy__(self) -> SupervisorWord: ...
    def __deepcopy__(self, arg0: dict) -> SupervisorWord: ...
    def __init__(self, **kwargs) -> None:
        """
        What the supervisor says of a side.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        [s]
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def clutch(self) -> bool:
        """
        pressed
        """
    @clutch.setter
    def clutch(self, arg1: bool) -> None: ...
    @property
    def engagement(self) -> int:
        """
        number of the last engagement
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def state(self) -> saras._core.net.ChannelState:
        """
        saras.net.ChannelState
        """
    @state.setter
    def state(self, arg1: saras._core.net.ChannelState) -> None: ...

class NearnessInput:
    """
    What a monitor says of a side's tool, in the arm's base frame.
    """

    _fields: typing.ClassVar[list] = [
        "age_s",
        "max_speed_scale",
        "approach_direction",
        "approach_speed_limit_m_s",
        "distance_m",
    ]
    def __copy__(self) -> NearnessInput: ...
    def __deepcopy__(self, arg0: dict) -> NearnessInput: ...
    def __init__(self, **kwargs) -> None:
        """
        What a monitor says of a side's tool, in the arm's base frame.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        [s]
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def approach_direction(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit, towards what is near; zero: nothing known
        """
    @approach_direction.setter
    def approach_direction(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def approach_speed_limit_m_s(self) -> float:
        """
        along it [m/s]; infinite: no bound
        """
    @approach_speed_limit_m_s.setter
    def approach_speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def distance_m(self) -> float:
        """
        [m]; NaN: unknown
        """
    @distance_m.setter
    def distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def max_speed_scale(self) -> float:
        """
        0..1, in any direction
        """
    @max_speed_scale.setter
    def max_speed_scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class SideInput:
    """
    Inputs of one side.
    """

    _fields: typing.ClassVar[list] = ["handle", "arm", "channel", "nearness", "fixtures"]
    def __copy__(self) -> SideInput: ...
    def __deepcopy__(self, arg0: dict) -> SideInput: ...
    def __init__(self, **kwargs) -> None:
        """
        Inputs of one side.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def arm(self) -> ArmInput:
        """
        ArmInput
        """
    @arm.setter
    def arm(self, arg1: ArmInput) -> None: ...
    @property
    def channel(self) -> SupervisorWord:
        """
        SupervisorWord
        """
    @channel.setter
    def channel(self, arg1: SupervisorWord) -> None: ...
    @property
    def fixtures(self) -> saras._core.csa.FixtureWord:
        """
        saras.csa.FixtureWord of the configured fixtures
        """
    @fixtures.setter
    def fixtures(self, arg1: saras._core.csa.FixtureWord) -> None: ...
    @property
    def handle(self) -> HandleInput:
        """
        HandleInput
        """
    @handle.setter
    def handle(self, arg1: HandleInput) -> None: ...
    @property
    def nearness(self) -> NearnessInput:
        """
        NearnessInput; not read when the pipeline takes the distances itself
        """
    @nearness.setter
    def nearness(self, arg1: NearnessInput) -> None: ...

class SceneInput:
    """
    Where everything is that the tools could meet, in the world.
    """

    _fields: typing.ClassVar[list] = [
        "age_s",
        "left_base_known",
        "right_base_known",
        "left_world_T_base",
        "right_world_T_base",
        "others",
        "regions_known",
        "world_T_regions",
    ]
    def __copy__(self) -> SceneInput: ...
    def __deepcopy__(self, arg0: dict) -> SceneInput: ...
    def __init__(self, **kwargs) -> None:
        """
        Where everything is that the tools could meet, in the world.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        [s]
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def left_base_known(self) -> bool:
        """
        whether world_T_base is known
        """
    @left_base_known.setter
    def left_base_known(self, arg1: bool) -> None: ...
    @property
    def left_world_T_base(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @left_world_T_base.setter
    def left_world_T_base(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def others(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        tools of other robots: (n, 7) tip, trocar, radius, not finite where unknown
        """
    @others.setter
    def others(self, arg1: collections.abc.Sequence) -> None: ...
    @property
    def regions_known(self) -> bool:
        """
        whether world_T_regions is known
        """
    @regions_known.setter
    def regions_known(self, arg1: bool) -> None: ...
    @property
    def right_base_known(self) -> bool:
        """
        whether world_T_base is known
        """
    @right_base_known.setter
    def right_base_known(self, arg1: bool) -> None: ...
    @property
    def right_world_T_base(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @right_world_T_base.setter
    def right_world_T_base(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def world_T_regions(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @world_T_regions.setter
    def world_T_regions(self, arg1: numpy.typing.ArrayLike) -> None: ...

class PipelineInput:
    """
    Inputs of one step of both sides.
    """

    _fields: typing.ClassVar[list] = ["left", "right", "scene", "overrun", "hold"]
    def __copy__(self) -> PipelineInput: ...
    def __deepcopy__(self, arg0: dict) -> PipelineInput: ...
    def __init__(self, **kwargs) -> None:
        """
        Inputs of one step of both sides.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def hold(self) -> bool:
        """
        the loop was too late: both sides stand until their next engagement
        """
    @hold.setter
    def hold(self, arg1: bool) -> None: ...
    @property
    def left(self) -> SideInput:
        """
        SideInput
        """
    @left.setter
    def left(self, arg1: SideInput) -> None: ...
    @property
    def overrun(self) -> bool:
        """
        the loop was late: integrators take one nominal period at most
        """
    @overrun.setter
    def overrun(self, arg1: bool) -> None: ...
    @property
    def right(self) -> SideInput:
        """
        SideInput
        """
    @right.setter
    def right(self, arg1: SideInput) -> None: ...
    @property
    def scene(self) -> SceneInput:
        """
        SceneInput
        """
    @scene.setter
    def scene(self, arg1: SceneInput) -> None: ...

class PipelineSideOutput:
    """
    Of one side.
    """

    _fields: typing.ClassVar[list] = [
        "state",
        "engagement",
        "has_tracked",
        "is_mapped",
        "tracked_pose",
        "tracked_twist",
        "tracked_twist_filtered",
        "handle_twist",
        "desired_wrench",
        "desired_twist",
        "error",
        "base_wrench",
        "touch_wrench",
        "twist",
        "has_set_point",
        "set_point",
        "lead_m",
        "wrench_known",
        "tissue_wrench",
        "to_guard",
        "nearness",
        "fixtures",
        "mapping",
        "transparency",
        "integrator",
        "speed_limited",
        "approach_limited",
        "lead_limited",
        "workspace_limited",
        "fixture_limited",
    ]
    def __copy__(self) -> PipelineSideOutput: ...
    def __deepcopy__(self, arg0: dict) -> PipelineSideOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Of one side.
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
    def base_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the hand, what passivity lets through
        """
    @base_wrench.setter
    def base_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def desired_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) of the tip, of transparency
        """
    @desired_twist.setter
    def desired_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def desired_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the hand, of transparency
        """
    @desired_wrench.setter
    def desired_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def engagement(self) -> int:
        """
        its number
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def error(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) slave - mapped master
        """
    @error.setter
    def error(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def fixture_limited(self) -> bool:
        """
        at a virtual fixture
        """
    @fixture_limited.setter
    def fixture_limited(self, arg1: bool) -> None: ...
    @property
    def fixtures(self) -> saras._core.csa.FixtureForceOutput:
        """
        saras.csa.FixtureForceOutput
        """
    @fixtures.setter
    def fixtures(self, arg1: saras._core.csa.FixtureForceOutput) -> None: ...
    @property
    def handle_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) the hand's own, also under clutch
        """
    @handle_twist.setter
    def handle_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def has_set_point(self) -> bool:
        """
        and the arm is there to hold it
        """
    @has_set_point.setter
    def has_set_point(self, arg1: bool) -> None: ...
    @property
    def has_tracked(self) -> bool:
        """
        a handle was mapped since the start
        """
    @has_tracked.setter
    def has_tracked(self, arg1: bool) -> None: ...
    @property
    def integrator(self) -> saras._core.Status:
        """
        saras.Status of the integrator
        """
    @integrator.setter
    def integrator(self, arg1: saras._core.Status) -> None: ...
    @property
    def is_mapped(self) -> bool:
        """
        in this step
        """
    @is_mapped.setter
    def is_mapped(self, arg1: bool) -> None: ...
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
        set-point ahead of measured [m]
        """
    @lead_m.setter
    def lead_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def mapping(self) -> saras._core.Status:
        """
        saras.Status of the frame mapping
        """
    @mapping.setter
    def mapping(self, arg1: saras._core.Status) -> None: ...
    @property
    def nearness(self) -> NearnessInput:
        """
        NearnessInput as used
        """
    @nearness.setter
    def nearness(self, arg1: NearnessInput) -> None: ...
    @property
    def set_point(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tip
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
    def state(self) -> saras._core.net.ChannelState:
        """
        saras.net.ChannelState in effect
        """
    @state.setter
    def state(self, arg1: saras._core.net.ChannelState) -> None: ...
    @property
    def tissue_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) exerted on the tissue
        """
    @tissue_wrench.setter
    def tissue_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def to_guard(self) -> saras._core.net.PortLedger:
        """
        saras.net.PortLedger to the port guard
        """
    @to_guard.setter
    def to_guard(self, arg1: saras._core.net.PortLedger) -> None: ...
    @property
    def touch_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) the same in the touch frame
        """
    @touch_wrench.setter
    def touch_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tracked_pose(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) base_T_tracked
        """
    @tracked_pose.setter
    def tracked_pose(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tracked_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) in the base frame
        """
    @tracked_twist.setter
    def tracked_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tracked_twist_filtered(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,)
        """
    @tracked_twist_filtered.setter
    def tracked_twist_filtered(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def transparency(self) -> saras._core.Status:
        """
        saras.Status of transparency
        """
    @transparency.setter
    def transparency(self, arg1: saras._core.Status) -> None: ...
    @property
    def twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) of the tip, what passivity lets through
        """
    @twist.setter
    def twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def workspace_limited(self) -> bool:
        """
        at the edge of cone or insertion
        """
    @workspace_limited.setter
    def workspace_limited(self, arg1: bool) -> None: ...
    @property
    def wrench_known(self) -> bool:
        """
        whether tissue_wrench is known
        """
    @wrench_known.setter
    def wrench_known(self, arg1: bool) -> None: ...

class TankOutput:
    """
    Of one tank; cumulative joules since the start.
    """

    _fields: typing.ClassVar[list] = [
        "energy_J",
        "work_out_J",
        "received_J",
        "sent_J",
        "vented_J",
        "granted_J",
        "reduction",
        "scale",
        "damping",
        "requesting",
        "has_room",
        "status",
        "to_peer",
    ]
    def __copy__(self) -> TankOutput: ...
    def __deepcopy__(self, arg0: dict) -> TankOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Of one tank; cumulative joules since the start.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def damping(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) B
        """
    @damping.setter
    def damping(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
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
        granted [J]
        """
    @granted_J.setter
    def granted_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def has_room(self) -> bool:
        """
        can take more
        """
    @has_room.setter
    def has_room(self, arg1: bool) -> None: ...
    @property
    def received_J(self) -> float:
        """
        from peers [J]
        """
    @received_J.setter
    def received_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
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
        asks its peers for energy
        """
    @requesting.setter
    def requesting(self, arg1: bool) -> None: ...
    @property
    def scale(self) -> float:
        """
        alpha in [0, 1]
        """
    @scale.setter
    def scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def sent_J(self) -> float:
        """
        to peers [J]
        """
    @sent_J.setter
    def sent_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def to_peer(self) -> tuple[int, int, float]:
        """
        (session, seq, sent_J) to the other tank
        """
    @to_peer.setter
    def to_peer(
        self,
        arg1: tuple[
            typing.SupportsInt | typing.SupportsIndex,
            typing.SupportsInt | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
        ],
    ) -> None: ...
    @property
    def vented_J(self) -> float:
        """
        discarded [J]
        """
    @vented_J.setter
    def vented_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def work_out_J(self) -> float:
        """
        through the ports [J]
        """
    @work_out_J.setter
    def work_out_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class PipelineOutput:
    """
    Of one step of both sides.
    """

    _fields: typing.ClassVar[list] = ["left", "right", "tank_master", "tank_slave", "proximity", "status"]
    def __copy__(self) -> PipelineOutput: ...
    def __deepcopy__(self, arg0: dict) -> PipelineOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Of one step of both sides.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def left(self) -> PipelineSideOutput:
        """
        PipelineSideOutput
        """
    @left.setter
    def left(self, arg1: PipelineSideOutput) -> None: ...
    @property
    def proximity(self) -> saras._core.Status:
        """
        saras.Status of the distances
        """
    @proximity.setter
    def proximity(self, arg1: saras._core.Status) -> None: ...
    @property
    def right(self) -> PipelineSideOutput:
        """
        PipelineSideOutput
        """
    @right.setter
    def right(self, arg1: PipelineSideOutput) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status: the worst of the engaged sides
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def tank_master(self) -> TankOutput:
        """
        TankOutput
        """
    @tank_master.setter
    def tank_master(self, arg1: TankOutput) -> None: ...
    @property
    def tank_slave(self) -> TankOutput:
        """
        TankOutput
        """
    @tank_slave.setter
    def tank_slave(self, arg1: TankOutput) -> None: ...

class PipelineState:
    """
    All that a Pipeline remembers; to be kept and given back whole.
    """

    _fields: typing.ClassVar[list] = ["tank_master", "tank_slave"]
    def __copy__(self) -> PipelineState: ...
    def __deepcopy__(self, arg0: dict) -> PipelineState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a Pipeline remembers; to be kept and given back whole.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def tank_master(self) -> saras._core.teleop.EnergyTankState:
        """
        saras.teleop.EnergyTankState
        """
    @tank_master.setter
    def tank_master(self, arg1: saras._core.teleop.EnergyTankState) -> None: ...
    @property
    def tank_slave(self) -> saras._core.teleop.EnergyTankState:
        """
        saras.teleop.EnergyTankState
        """
    @tank_slave.setter
    def tank_slave(self, arg1: saras._core.teleop.EnergyTankState) -> None: ...

class Pipeline:
    """
    Both sides in one step: hands' poses to set-points, and back to the wrenches on the hands.

    The laws of the separate nodes in their order, as one value.
    """
    def __init__(self, config: PipelineConfig) -> None:
        """
        Raises ConfigError.
        """
    def reset(self, state: PipelineState | None = None) -> None:
        """
        As constructed, or continuation from a recorded state.
        """
    def step(self, input: PipelineInput, dt: typing.SupportsFloat | typing.SupportsIndex) -> PipelineOutput:
        """
        One step: PipelineInput, seconds since the last one. Returns PipelineOutput.
        """
    @property
    def config(self) -> PipelineConfig: ...
    @property
    def distances(self) -> list[saras._core.collision.ToolProximity]:
        """
        a saras.collision.ToolProximity for each SARAS instrument and each other tool, of the last step
        """
    @property
    def state(self) -> PipelineState: ...
