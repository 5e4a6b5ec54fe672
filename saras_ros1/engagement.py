"""What an operator does at the start: looks that all is ready, and engages both sides."""

from __future__ import annotations

import time

import rospy
from std_srvs.srv import Trigger

from saras_ros1.msg import ChannelState

SETTLE_S = 3.0  #: a side must ask for engagement for so long: nodes are still being loaded
STEADY_S = 1.0  #: both sides must stay engaged for so long before it counts


class Engagement:
    """The operator's part: engages each side once it has settled, and knows since when both are engaged.

    A HOLD before that is answered by engaging again; later ones are left as they are: they are what a demo may show.
    """

    def __init__(self) -> None:
        self.since: float | None = None  #: both sides engaged, monotonic [s]
        self.wall_since: float | None = None  #: the same as time of day [s]
        self._both_since: float | None = None
        self._asking_since: dict[str, float] = {}

    def update(self, states: dict[str, ChannelState | None], now: float) -> None:
        """states: of each side, None where unknown. now: monotonic [s]."""
        if self.since is not None:
            return
        for side, state in states.items():
            if state is not None and state.state in (ChannelState.READY, ChannelState.HOLD):
                if now - self._asking_since.setdefault(side, now) > SETTLE_S:
                    self._asking_since[side] = now
                    engage(side)
            else:
                self._asking_since.pop(side, None)
        if not all(state is not None and state.state == ChannelState.ENGAGED for state in states.values()):
            self._both_since = None
        elif self._both_since is None:
            self._both_since = now
        elif now - self._both_since > STEADY_S:
            self.since, self.wall_since = now, time.time()


def engage(side: str) -> None:
    """Asks the supervisor; says so when it refuses."""
    try:
        answer = rospy.ServiceProxy(f"/system/{side}/engage", Trigger)()
        refusal = None if answer.success else answer.message
    except rospy.ServiceException as error:
        refusal = str(error)
    if refusal is not None:
        print(f"[demo] {side}: not engaged: {refusal}", flush=True)
