"""
What the console program steps at device rate
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import saras._core
import saras._core.kinematics
import saras._core.sim
import saras._core.teleop
import typing

__all__: list[str] = [
    "PortGuard",
    "PortGuardConfig",
    "PortGuardOutput",
    "PortGuardState",
    "SimulatedHandle",
    "SimulatedHandleConfig",
    "SimulatedHandleState",
]

class PortGuardConfig:
    """
    An energy tank of one channel at a handle.
    """

    _fields: typing.ClassVar[list] = ["tank", "force_ramp_s", "touch_R_simball"]
    def __copy__(self) -> PortGuardConfig: ...
    def __deepcopy__(self, arg0: dict) -> PortGuardConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        An energy tank of one channel at a handle.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def force_ramp_s(self) -> float:
        """
        from full force to none, and back [s]
        """
    @force_ramp_s.setter
    def force_ramp_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def tank(self) -> saras._core.teleop.EnergyTankConfig:
        """
        EnergyTankConfig
        """
    @tank.setter
    def tank(self, arg1: saras._core.teleop.EnergyTankConfig) -> None: ...
    @property
    def touch_R_simball(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) turns simball_base vectors into the touch frame
        """
    @touch_R_simball.setter
    def touch_R_simball(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"]) -> None: ...

class PortGuardOutput:
    """
    Result of PortGuard.step.
    """

    _fields: typing.ClassVar[list] = ["applied", "tank", "status"]
    def __copy__(self) -> PortGuardOutput: ...
    def __deepcopy__(self, arg0: dict) -> PortGuardOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of PortGuard.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def applied(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) to the motors, touch frame [N, N m]
        """
    @applied.setter
    def applied(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status, the tank's
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def tank(self) -> saras._core.teleop.EnergyTankOutput:
        """
        EnergyTankOutput
        """
    @tank.setter
    def tank(self, arg1: saras._core.teleop.EnergyTankOutput) -> None: ...

class PortGuardState:
    """
    All that a PortGuard remembers.
    """

    _fields: typing.ClassVar[list] = ["tank", "ramp", "has_previous", "simball_T_previous", "billed_J"]
    def __copy__(self) -> PortGuardState: ...
    def __deepcopy__(self, arg0: dict) -> PortGuardState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a PortGuard remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def billed_J(self) -> float:
        """
        of the device's cumulative work [J]
        """
    @billed_J.setter
    def billed_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def has_previous(self) -> bool:
        """
        whether the last tick had a pose
        """
    @has_previous.setter
    def has_previous(self, arg1: bool) -> None: ...
    @property
    def ramp(self) -> float:
        """
        share of the wanted wrench that passes, 0 to 1
        """
    @ramp.setter
    def ramp(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def simball_T_previous(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) pose of the last tick
        """
    @simball_T_previous.setter
    def simball_T_previous(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tank(self) -> saras._core.teleop.EnergyTankState:
        """
        EnergyTankState
        """
    @tank.setter
    def tank(self, arg1: saras._core.teleop.EnergyTankState) -> None: ...

class PortGuard:
    """
    The passivity layer at one handle. Begins at minimum_J; grant() once an engagement.
    """
    def __init__(self, config: PortGuardConfig = ...) -> None: ...
    def grant(self) -> None:
        """
        Fills the tank up to initial_J and counts it as granted.
        """
    def reset(self, state: PortGuardState | None = None) -> None:
        """
        A restart (level minimum_J), or continuation from a recorded state.
        """
    def step(
        self,
        simball_T_handle: numpy.typing.ArrayLike | None,
        work_J: typing.SupportsFloat | typing.SupportsIndex,
        wrench: numpy.typing.ArrayLike,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        active: bool,
        received_J: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        peer_requests: bool = False,
        peer_has_room: bool = False,
    ) -> PortGuardOutput:
        """
        One device tick.

        simball_T_handle: (4, 4), None without a valid reading. work_J: the device's cumulative work on the hand.
        wrench: (6,) newest from the platform, touch frame. active: engaged on a fresh link; else the force ramps to
        zero. received_J: credited by the ledger since the last tick.
        """
    @property
    def config(self) -> PortGuardConfig: ...
    @property
    def state(self) -> PortGuardState: ...

class SimulatedHandleConfig:
    """
    A hand, the Simball it holds, the motors that push it.
    """

    _fields: typing.ClassVar[list] = [
        "hand",
        "simball",
        "home_joints",
        "workspace_radius_m",
        "watchdog_s",
        "stall_max_s",
        "touch_R_simball",
    ]
    def __copy__(self) -> SimulatedHandleConfig: ...
    def __deepcopy__(self, arg0: dict) -> SimulatedHandleConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        A hand, the Simball it holds, the motors that push it.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def hand(self) -> saras._core.sim.OperatorConfig:
        """
        saras.sim.OperatorConfig; its workspace is set from here
        """
    @hand.setter
    def hand(self, arg1: saras._core.sim.OperatorConfig) -> None: ...
    @property
    def home_joints(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) start, and origin of intentions [rad], insertion [m]
        """
    @home_joints.setter
    def home_joints(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...
    @property
    def simball(self) -> saras._core.kinematics.SimballHandleConfig:
        """
        saras.kinematics.SimballHandleConfig
        """
    @simball.setter
    def simball(self, arg1: saras._core.kinematics.SimballHandleConfig) -> None: ...
    @property
    def stall_max_s(self) -> float:
        """
        of a longer step only this much is simulated [s]
        """
    @stall_max_s.setter
    def stall_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def touch_R_simball(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) turns simball_base vectors into the touch frame
        """
    @touch_R_simball.setter
    def touch_R_simball(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"]) -> None: ...
    @property
    def watchdog_s(self) -> float:
        """
        the motors fall back to zero when a wrench is this old [s]
        """
    @watchdog_s.setter
    def watchdog_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def workspace_radius_m(self) -> float:
        """
        mechanical stop around home [m]
        """
    @workspace_radius_m.setter
    def workspace_radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class SimulatedHandleState:
    """
    All that a SimulatedHandle remembers.
    """

    _fields: typing.ClassVar[list] = ["hand", "work_J"]
    def __copy__(self) -> SimulatedHandleState: ...
    def __deepcopy__(self, arg0: dict) -> SimulatedHandleState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a SimulatedHandle remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def hand(self) -> saras._core.sim.OperatorState:
        """
        saras.sim.OperatorState
        """
    @hand.setter
    def hand(self, arg1: saras._core.sim.OperatorState) -> None: ...
    @property
    def work_J(self) -> float:
        """
        cumulative work of the motors on the hand [J]
        """
    @work_J.setter
    def work_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class SimulatedHandle:
    """
    A haptic handle without the hardware.
    """
    def __init__(self, config: SimulatedHandleConfig = ...) -> None: ...
    def reset(self) -> None:
        """
        At rest at home.
        """
    def step(
        self,
        intended_offset: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
        intended_velocity: typing.Annotated[
            collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex], "FixedSize(3)"
        ],
        intended_roll: typing.SupportsFloat | typing.SupportsIndex,
        wrench: numpy.typing.ArrayLike | None,
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"] | None, float]:
        """
        One step of dt [s]: what the hand intends, from home in the handle's frame there (3,) [m], (3,) [m/s], [rad];
        wrench (6,) applied since the last step in the touch frame, None for none. Returns (joints (4,) or None,
        cumulative work on the hand [J]).
        """
    @property
    def config(self) -> SimulatedHandleConfig: ...
    @property
    def state(self) -> SimulatedHandleState: ...
