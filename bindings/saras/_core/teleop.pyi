"""
Frame mapping, transparency, energy tanks, velocity integrator
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core
import typing

__all__: list[str] = [
    "EnergyTank",
    "EnergyTankConfig",
    "EnergyTankOutput",
    "EnergyTankState",
    "LedgerReceiver",
    "LedgerReceiverState",
    "LedgerSender",
    "TwistEstimator",
    "TwistEstimatorConfig",
    "TwistEstimatorOutput",
    "TwistEstimatorState",
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
