"""Names of the two sides, and their operating state as a node sees it."""

from __future__ import annotations

from saras_ros1.inputs import Input
from saras_ros1.msg import ChannelState
from saras_ros1.node import Node

SIDES = ("left", "right")
# The supervisor publishes at 10 Hz and at each change; three missed ones mean that nobody watches this side any more.
STATE_TIMEOUT_S = 0.35


def base_frame(side: str) -> str:
    """Arm base, the frame of all teleoperation topics of a side."""
    return f"mesa_{side}/sbs_world"


class Channel:
    """/system/{side}/state. A stale one counts as HOLD: the supervisor itself may be dead.

    So does an engagement that ran before this node: it has no part in it, whatever became of its predecessor. Without
    its heartbeat the supervisor ends that engagement; the next one is believed. ``inherits`` is for a node whose
    heartbeat nobody waits for: it takes part at once.
    """

    def __init__(self, node: Node, side: str, *, inherits: bool = False) -> None:
        self.side = side
        self.input = node.input(f"/system/{side}/state", ChannelState, timeout_s=STATE_TIMEOUT_S)
        self.input.listeners.append(self._on_state)
        node.heard_channels.append(self)
        self.engagement = 0  # number of the last engagement that was told of, over restarts of the supervisor
        self._session = self._seq = 0
        self._seen_engagement = 0
        self._heard = inherits
        self._inherited: int | None = None

    def _on_state(self, source: Input) -> None:
        message = source.message
        if message.seq < self._seq:  # a restarted supervisor counts anew; here the numbers go on
            self._session = self.engagement
        self._seq = message.seq
        self.engagement = self._session + message.engagement
        if not self._heard and message.state == ChannelState.ENGAGED:
            self._inherited = self.engagement
        self._heard = True

    @property
    def inherited(self) -> bool:
        """Whether the engagement that runs is older than this node."""
        message = self.input.message
        return message is not None and message.state == ChannelState.ENGAGED and self.engagement == self._inherited

    @property
    def state(self) -> int:
        """One of ChannelState's constants."""
        if self.input.message is None:
            return ChannelState.WAITING
        return self.input.message.state if self.input.fresh and not self.inherited else ChannelState.HOLD

    @property
    def engaged(self) -> bool:
        """Whether motion and force may flow now."""
        return self.state == ChannelState.ENGAGED

    @property
    def clutch(self) -> bool:
        """Whether the operator's clutch is pressed. The tracked pose freezes by itself; this only re-references."""
        return self.input.fresh and self.input.message.clutch

    def newly_engaged(self) -> bool:
        """True once for each engagement: take new references, grant the starting charge."""
        if not self.engaged or self.engagement == self._seen_engagement:
            return False
        self._seen_engagement = self.engagement
        return True
