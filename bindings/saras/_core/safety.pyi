"""
State table of the channels, supervisor, leases
"""

from __future__ import annotations
import collections.abc
import saras._core
import typing

__all__: list[str] = [
    "ChannelInput",
    "ChannelMemory",
    "ChannelOutput",
    "CrtkState",
    "EVENT_RULES",
    "EventRule",
    "Lease",
    "LeaseAct",
    "LeaseOutput",
    "LeaseState",
    "MAX_CHANNELS",
    "MAX_OPERATORS",
    "NOBODY",
    "OperatorSigns",
    "SafetyEvent",
    "SafetySign",
    "SafetyState",
    "Supervisor",
    "SupervisorConfig",
    "SupervisorOutput",
    "SupervisorState",
    "crtk_state",
    "event_of",
    "next_lease",
    "next_state",
]

class SafetyState:
    """
    State of one channel. The first four as saras_ros1/ChannelState.

    Members:

      WAITING

      READY

      ENGAGED

      HOLD

      ESTOP
    """

    ENGAGED: typing.ClassVar[SafetyState]
    ESTOP: typing.ClassVar[SafetyState]
    HOLD: typing.ClassVar[SafetyState]
    READY: typing.ClassVar[SafetyState]
    WAITING: typing.ClassVar[SafetyState]
    __members__: typing.ClassVar[dict[str, SafetyState]]
    @typing.overload
    def __eq__(self, other: SafetyState) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: SafetyState) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class CrtkState:
    """
    What others see, by CRTK's names.

    Members:

      DISABLED

      ENABLED

      PAUSED

      FAULT
    """

    DISABLED: typing.ClassVar[CrtkState]
    ENABLED: typing.ClassVar[CrtkState]
    FAULT: typing.ClassVar[CrtkState]
    PAUSED: typing.ClassVar[CrtkState]
    __members__: typing.ClassVar[dict[str, CrtkState]]
    @typing.overload
    def __eq__(self, other: CrtkState) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: CrtkState) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SafetyEvent:
    """
    What happened to a channel in one step.

    Members:

      NONE

      READY

      LOST

      FAULT

      ENGAGE

      ENGAGE_REFUSED

      HOLD

      DISENGAGE

      ESTOP

      ESTOP_RESET
    """

    DISENGAGE: typing.ClassVar[SafetyEvent]
    ENGAGE: typing.ClassVar[SafetyEvent]
    ENGAGE_REFUSED: typing.ClassVar[SafetyEvent]
    ESTOP: typing.ClassVar[SafetyEvent]
    ESTOP_RESET: typing.ClassVar[SafetyEvent]
    FAULT: typing.ClassVar[SafetyEvent]
    HOLD: typing.ClassVar[SafetyEvent]
    LOST: typing.ClassVar[SafetyEvent]
    NONE: typing.ClassVar[SafetyEvent]
    READY: typing.ClassVar[SafetyEvent]
    __members__: typing.ClassVar[dict[str, SafetyEvent]]
    @typing.overload
    def __eq__(self, other: SafetyEvent) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: SafetyEvent) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SafetySign:
    """
    Signs of one step, as bits for event_of.

    Members:

      ESTOP

      ESTOP_LATCHED

      RESET_ASKED

      HOLD_ASKED

      FAULT

      DISENGAGE_ASKED

      LOST

      ENGAGE_ASKED

      HOLDER_ASKS

      ALL_THERE

      ALIGNED
    """

    ALIGNED: typing.ClassVar[SafetySign]
    ALL_THERE: typing.ClassVar[SafetySign]
    DISENGAGE_ASKED: typing.ClassVar[SafetySign]
    ENGAGE_ASKED: typing.ClassVar[SafetySign]
    ESTOP: typing.ClassVar[SafetySign]
    ESTOP_LATCHED: typing.ClassVar[SafetySign]
    FAULT: typing.ClassVar[SafetySign]
    HOLDER_ASKS: typing.ClassVar[SafetySign]
    HOLD_ASKED: typing.ClassVar[SafetySign]
    LOST: typing.ClassVar[SafetySign]
    RESET_ASKED: typing.ClassVar[SafetySign]
    __members__: typing.ClassVar[dict[str, SafetySign]]
    @typing.overload
    def __and__(self, other: SafetySign) -> int: ...
    @typing.overload
    def __and__(self, other: typing.SupportsInt | typing.SupportsIndex) -> int: ...
    @typing.overload
    def __eq__(self, other: SafetySign) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.SupportsInt | typing.SupportsIndex) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    @typing.overload
    def __ge__(self, other: SafetySign) -> bool: ...
    @typing.overload
    def __ge__(self, other: typing.SupportsInt | typing.SupportsIndex) -> bool: ...
    def __getstate__(self) -> int: ...
    @typing.overload
    def __gt__(self, other: SafetySign) -> bool: ...
    @typing.overload
    def __gt__(self, other: typing.SupportsInt | typing.SupportsIndex) -> bool: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    def __invert__(self) -> typing.Any: ...
    @typing.overload
    def __le__(self, other: SafetySign) -> bool: ...
    @typing.overload
    def __le__(self, other: typing.SupportsInt | typing.SupportsIndex) -> bool: ...
    @typing.overload
    def __lt__(self, other: SafetySign) -> bool: ...
    @typing.overload
    def __lt__(self, other: typing.SupportsInt | typing.SupportsIndex) -> bool: ...
    @typing.overload
    def __ne__(self, other: SafetySign) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.SupportsInt | typing.SupportsIndex) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    @typing.overload
    def __or__(self, other: SafetySign) -> int: ...
    @typing.overload
    def __or__(self, other: typing.SupportsInt | typing.SupportsIndex) -> int: ...
    @typing.overload
    def __rand__(self, other: SafetySign) -> int: ...
    @typing.overload
    def __rand__(self, other: typing.SupportsInt | typing.SupportsIndex) -> int: ...
    def __repr__(self) -> str: ...
    @typing.overload
    def __ror__(self, other: SafetySign) -> int: ...
    @typing.overload
    def __ror__(self, other: typing.SupportsInt | typing.SupportsIndex) -> int: ...
    @typing.overload
    def __rxor__(self, other: SafetySign) -> int: ...
    @typing.overload
    def __rxor__(self, other: typing.SupportsInt | typing.SupportsIndex) -> int: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @typing.overload
    def __xor__(self, other: SafetySign) -> int: ...
    @typing.overload
    def __xor__(self, other: typing.SupportsInt | typing.SupportsIndex) -> int: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class EventRule:
    """
    The first rule that fits the signs gives the event.
    """

    _fields: typing.ClassVar[list] = ["event", "all_of", "none_of"]
    def __copy__(self) -> EventRule: ...
    def __deepcopy__(self, arg0: dict) -> EventRule: ...
    def __init__(self, **kwargs) -> None:
        """
        The first rule that fits the signs gives the event.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def all_of(self) -> int:
        """
        bits of SafetySign that must stand
        """
    @all_of.setter
    def all_of(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def event(self) -> SafetyEvent:
        """
        SafetyEvent
        """
    @event.setter
    def event(self, arg1: SafetyEvent) -> None: ...
    @property
    def none_of(self) -> int:
        """
        bits of SafetySign that must not
        """
    @none_of.setter
    def none_of(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class LeaseAct:
    """
    What an operator does to a lease.

    Members:

      SILENT

      RELEASE

      WITHDRAW

      OFFER

      ACCEPT

      CLAIM
    """

    ACCEPT: typing.ClassVar[LeaseAct]
    CLAIM: typing.ClassVar[LeaseAct]
    OFFER: typing.ClassVar[LeaseAct]
    RELEASE: typing.ClassVar[LeaseAct]
    SILENT: typing.ClassVar[LeaseAct]
    WITHDRAW: typing.ClassVar[LeaseAct]
    __members__: typing.ClassVar[dict[str, LeaseAct]]
    @typing.overload
    def __eq__(self, other: LeaseAct) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: LeaseAct) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class LeaseState:
    """
    All that a Lease remembers. Operators are 1..MAX_OPERATORS, 0 is nobody.
    """

    _fields: typing.ClassVar[list] = ["holder", "offered_to"]
    def __copy__(self) -> LeaseState: ...
    def __deepcopy__(self, arg0: dict) -> LeaseState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a Lease remembers. Operators are 1..MAX_OPERATORS, 0 is nobody.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def holder(self) -> int:
        """
        operator who may move the arm
        """
    @holder.setter
    def holder(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def offered_to(self) -> int:
        """
        operator who may take it over
        """
    @offered_to.setter
    def offered_to(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class OperatorSigns:
    """
    What one operator's console says in one step.
    """

    _fields: typing.ClassVar[list] = ["alive", "claim", "release", "withdraw", "accept", "offer_to"]
    def __copy__(self) -> OperatorSigns: ...
    def __deepcopy__(self, arg0: dict) -> OperatorSigns: ...
    def __init__(self, **kwargs) -> None:
        """
        What one operator's console says in one step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def accept(self) -> bool:
        """
        takes what was offered in an earlier step
        """
    @accept.setter
    def accept(self, arg1: bool) -> None: ...
    @property
    def alive(self) -> bool:
        """
        heard within its limit
        """
    @alive.setter
    def alive(self, arg1: bool) -> None: ...
    @property
    def claim(self) -> bool:
        """
        asks for a free arm
        """
    @claim.setter
    def claim(self, arg1: bool) -> None: ...
    @property
    def offer_to(self) -> int:
        """
        operator to whom the lease is offered; 0: nobody
        """
    @offer_to.setter
    def offer_to(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def release(self) -> bool:
        """
        gives the arm back
        """
    @release.setter
    def release(self, arg1: bool) -> None: ...
    @property
    def withdraw(self) -> bool:
        """
        takes an offer back
        """
    @withdraw.setter
    def withdraw(self, arg1: bool) -> None: ...

class LeaseOutput:
    """
    Result of Lease.step.
    """

    _fields: typing.ClassVar[list] = ["holder", "offered_to", "refused", "status"]
    def __copy__(self) -> LeaseOutput: ...
    def __deepcopy__(self, arg0: dict) -> LeaseOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of Lease.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def holder(self) -> int:
        """
        operator who may move the arm; 0: nobody
        """
    @holder.setter
    def holder(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def offered_to(self) -> int:
        """
        operator who may take it over; 0: nobody
        """
    @offered_to.setter
    def offered_to(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def refused(self) -> typing.Annotated[list[bool], "FixedSize(4)"]:
        """
        of each operator: asked for what he may not have now
        """
    @refused.setter
    def refused(self, arg1: typing.Annotated[collections.abc.Sequence[bool], "FixedSize(4)"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        WAITING: nobody holds the arm
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...

class Lease:
    """
    Who may move an arm: one operator at a time; silence releases to nobody.
    """
    def __init__(self) -> None: ...
    def reset(self, state: LeaseState = ...) -> None: ...
    def step(
        self, operators: collections.abc.Sequence[OperatorSigns], dt: typing.SupportsFloat | typing.SupportsIndex
    ) -> LeaseOutput:
        """
        One tick: OperatorSigns of operator 1, 2, …; who is left out is silent. dt [s] is only checked.
        """
    @property
    def state(self) -> LeaseState: ...

class SupervisorConfig:
    """
    Size and patience of a Supervisor.
    """

    _fields: typing.ClassVar[list] = ["channels", "steps_missing_hold"]
    def __copy__(self) -> SupervisorConfig: ...
    def __deepcopy__(self, arg0: dict) -> SupervisorConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Size and patience of a Supervisor.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def channels(self) -> int:
        """
        1..MAX_CHANNELS
        """
    @channels.setter
    def channels(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def steps_missing_hold(self) -> int:
        """
        so many steps in a row without all there end an engagement
        """
    @steps_missing_hold.setter
    def steps_missing_hold(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class ChannelInput:
    """
    What one channel reports in one step.
    """

    _fields: typing.ClassVar[list] = [
        "all_there",
        "fault",
        "aligned",
        "hold",
        "disengage",
        "clutch",
        "holder",
        "engage_by",
    ]
    def __copy__(self) -> ChannelInput: ...
    def __deepcopy__(self, arg0: dict) -> ChannelInput: ...
    def __init__(self, **kwargs) -> None:
        """
        What one channel reports in one step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def aligned(self) -> bool:
        """
        hand and tool are aligned
        """
    @aligned.setter
    def aligned(self, arg1: bool) -> None: ...
    @property
    def all_there(self) -> bool:
        """
        everything that the channel needs is fresh
        """
    @all_there.setter
    def all_there(self, arg1: bool) -> None: ...
    @property
    def clutch(self) -> bool:
        """
        pressed, a level
        """
    @clutch.setter
    def clutch(self, arg1: bool) -> None: ...
    @property
    def disengage(self) -> bool:
        """
        asked for in this step
        """
    @disengage.setter
    def disengage(self, arg1: bool) -> None: ...
    @property
    def engage_by(self) -> int:
        """
        operator who asks for engagement in this step; 0: nobody
        """
    @engage_by.setter
    def engage_by(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def fault(self) -> bool:
        """
        in this step, such as a pose that jumped
        """
    @fault.setter
    def fault(self, arg1: bool) -> None: ...
    @property
    def hold(self) -> bool:
        """
        asked for in this step
        """
    @hold.setter
    def hold(self, arg1: bool) -> None: ...
    @property
    def holder(self) -> int:
        """
        operator who holds the arm's lease; 0: nobody
        """
    @holder.setter
    def holder(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class ChannelOutput:
    """
    What one channel may do.
    """

    _fields: typing.ClassVar[list] = ["state", "crtk", "event", "may_move", "engage_refused", "engagement"]
    def __copy__(self) -> ChannelOutput: ...
    def __deepcopy__(self, arg0: dict) -> ChannelOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        What one channel may do.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def crtk(self) -> CrtkState:
        """
        CrtkState
        """
    @crtk.setter
    def crtk(self, arg1: CrtkState) -> None: ...
    @property
    def engage_refused(self) -> bool:
        """
        somebody asked for engagement and did not get it
        """
    @engage_refused.setter
    def engage_refused(self, arg1: bool) -> None: ...
    @property
    def engagement(self) -> int:
        """
        counts engagements
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def event(self) -> SafetyEvent:
        """
        SafetyEvent of this step
        """
    @event.setter
    def event(self, arg1: SafetyEvent) -> None: ...
    @property
    def may_move(self) -> bool:
        """
        engaged, clutch released, by who holds the lease
        """
    @may_move.setter
    def may_move(self, arg1: bool) -> None: ...
    @property
    def state(self) -> SafetyState:
        """
        SafetyState
        """
    @state.setter
    def state(self, arg1: SafetyState) -> None: ...

class SupervisorOutput:
    """
    Result of Supervisor.step.
    """

    _fields: typing.ClassVar[list] = ["channels", "whole", "estop_latched", "status"]
    def __copy__(self) -> SupervisorOutput: ...
    def __deepcopy__(self, arg0: dict) -> SupervisorOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of Supervisor.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def channels(self) -> typing.Annotated[list[ChannelOutput], "FixedSize(8)"]:
        """
        MAX_CHANNELS ChannelOutput; unused ones do not move
        """
    @channels.setter
    def channels(self, arg1: typing.Annotated[collections.abc.Sequence[ChannelOutput], "FixedSize(8)"]) -> None: ...
    @property
    def estop_latched(self) -> bool:
        """
        left by an explicit reset only
        """
    @estop_latched.setter
    def estop_latched(self, arg1: bool) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def whole(self) -> CrtkState:
        """
        CrtkState
        """
    @whole.setter
    def whole(self, arg1: CrtkState) -> None: ...

class ChannelMemory:
    """
    What a Supervisor remembers of one channel.
    """

    _fields: typing.ClassVar[list] = ["state", "cause", "engaged_by", "steps_missing", "engagement"]
    def __copy__(self) -> ChannelMemory: ...
    def __deepcopy__(self, arg0: dict) -> ChannelMemory: ...
    def __init__(self, **kwargs) -> None:
        """
        What a Supervisor remembers of one channel.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def cause(self) -> SafetyEvent:
        """
        SafetyEvent that led to this state
        """
    @cause.setter
    def cause(self, arg1: SafetyEvent) -> None: ...
    @property
    def engaged_by(self) -> int:
        """
        operator whose engagement it is; 0: none
        """
    @engaged_by.setter
    def engaged_by(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def engagement(self) -> int:
        """
        counts engagements
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def state(self) -> SafetyState:
        """
        SafetyState
        """
    @state.setter
    def state(self, arg1: SafetyState) -> None: ...
    @property
    def steps_missing(self) -> int:
        """
        steps in a row without all there
        """
    @steps_missing.setter
    def steps_missing(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class SupervisorState:
    """
    All that a Supervisor remembers.
    """

    _fields: typing.ClassVar[list] = ["channels"]
    def __copy__(self) -> SupervisorState: ...
    def __deepcopy__(self, arg0: dict) -> SupervisorState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a Supervisor remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def channels(self) -> typing.Annotated[list[ChannelMemory], "FixedSize(8)"]:
        """
        MAX_CHANNELS ChannelMemory
        """
    @channels.setter
    def channels(self, arg1: typing.Annotated[collections.abc.Sequence[ChannelMemory], "FixedSize(8)"]) -> None: ...

class Supervisor:
    """
    Which channels may move. E-stop wins; a reset never moves.
    """
    def __init__(self, config: SupervisorConfig = ...) -> None: ...
    def reset(self, state: SupervisorState = ...) -> None: ...
    def step(
        self,
        channels: collections.abc.Sequence[ChannelInput],
        *,
        estop: bool,
        estop_reset: bool = False,
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> SupervisorOutput:
        """
        One tick: a ChannelInput each. estop: pressed, or not known. estop_reset: asked for now. dt [s] is only
        checked.
        """
    @property
    def config(self) -> SupervisorConfig: ...
    @property
    def state(self) -> SupervisorState: ...

def crtk_state(state: SafetyState) -> CrtkState:
    """
    How a channel's state is shown to CRTK clients.
    """

def event_of(signs: typing.SupportsInt | typing.SupportsIndex) -> SafetyEvent:
    """
    The one event that a set of SafetySign bits gives.
    """

def next_lease(
    state: LeaseState,
    act: LeaseAct,
    by: typing.SupportsInt | typing.SupportsIndex,
    to: typing.SupportsInt | typing.SupportsIndex = 0,
) -> LeaseState:
    """
    What one act of operator `by` does to a lease; an act that he may not do changes nothing.
    """

def next_state(state: SafetyState, event: SafetyEvent) -> SafetyState:
    """
    The state table.
    """

EVENT_RULES: tuple
MAX_CHANNELS: int = 8
MAX_OPERATORS: int = 4
NOBODY: int = 0
