"""Whether a channel may move: the state table, the supervisor's law over all channels, and the leases of the arms.

Pure: no clocks, no sockets; ages are judged by the caller. ``promela()`` writes the tables as the SPIN model takes them
(safety/supervisor.pml, script/verify-model).
"""

from saras._core.safety import (
    EVENT_RULES,
    MAX_CHANNELS,
    MAX_OPERATORS,
    NOBODY,
    ChannelInput,
    ChannelMemory,
    ChannelOutput,
    CrtkState,
    EventRule,
    Lease,
    LeaseAct,
    LeaseOutput,
    LeaseState,
    OperatorSigns,
    SafetyEvent,
    SafetySign,
    SafetyState,
    Supervisor,
    SupervisorConfig,
    SupervisorOutput,
    SupervisorState,
    crtk_state,
    event_of,
    next_lease,
    next_state,
)
from saras.safety.promela import promela

__all__ = [
    "EVENT_RULES",
    "MAX_CHANNELS",
    "MAX_OPERATORS",
    "NOBODY",
    "ChannelInput",
    "ChannelMemory",
    "ChannelOutput",
    "CrtkState",
    "EventRule",
    "Lease",
    "LeaseAct",
    "LeaseOutput",
    "LeaseState",
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
    "promela",
]
