"""Names of the two sides, and their operating state as a node sees it."""

from __future__ import annotations

from saras_ros1.msg import ChannelState
from saras_ros1.node import Node

SIDES = ("left", "right")
# The supervisor publishes at 10 Hz and at each change; three missed ones mean that nobody watches this side any more.
STATE_TIMEOUT_S = 0.35


def base_frame(side: str) -> str:
    """Arm base, the frame of all teleoperation topics of a side."""
    return f"mesa_{side}/sbs_world"


class Channel:
    """/system/{side}/state. A stale one counts as HOLD: the supervisor itself may be dead."""

    def __init__(self, node: Node, side: str) -> None:
        self.side = side
        self.input = node.input(f"/system/{side}/state", ChannelState, timeout_s=STATE_TIMEOUT_S)
        self._seen_engagement = 0

    @property
    def state(self) -> int:
        """One of ChannelState's constants."""
        if self.input.message is None:
            return ChannelState.WAITING
        return self.input.message.state if self.input.fresh else ChannelState.HOLD

    @property
    def engaged(self) -> bool:
        """Whether motion and force may flow now."""
        return self.state == ChannelState.ENGAGED

    @property
    def clutch(self) -> bool:
        """Whether the operator's clutch is pressed. The tracked pose freezes by itself; this only re-references."""
        return self.input.fresh and self.input.message.clutch

    @property
    def engagement(self) -> int:
        """Number of the last engagement, 0 when there was none."""
        return 0 if self.input.message is None else self.input.message.engagement

    def newly_engaged(self) -> bool:
        """True once for each engagement: take new references, grant the starting charge."""
        if not self.engaged or self.engagement == self._seen_engagement:
            return False
        self._seen_engagement = self.engagement
        return True
