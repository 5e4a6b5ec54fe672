"""What an operator does: looks that all is ready, engages both sides, and engages again after a HOLD."""

from __future__ import annotations

import time

import rospy
from std_srvs.srv import Trigger

from saras_ros1.msg import ChannelState

SETTLE_S = 3.0  #: a side must ask for engagement for so long: nodes are still being loaded
SETTLE_AGAIN_S = 1.0  #: the same after a HOLD: all is loaded then
STEADY_S = 1.0  #: both sides must stay engaged for so long before it counts
PATIENCE = 20  #: HOLDs a side that are answered after the start; more is more than a busy machine's hiccup


class Engagement:
    """The operator's part: engages each side once it has settled, and knows since when both are engaged.

    A HOLD is said with its reason and answered by engaging again, after the start at most PATIENCE times a side.
    """

    def __init__(self) -> None:
        self.since: float | None = None  #: both sides engaged, monotonic [s]
        self.wall_since: float | None = None  #: the same as time of day [s]
        self._both_since: float | None = None
        self._asking_since: dict[str, float] = {}
        self._answered: dict[str, int] = {}

    def update(self, states: dict[str, ChannelState | None], now: float) -> None:
        """states: of each side, None where unknown. now: monotonic [s]."""
        for side, state in states.items():
            if state is None or state.state not in (ChannelState.READY, ChannelState.HOLD):
                self._asking_since.pop(side, None)
            elif "E-stop" in state.reason:
                self._asking_since.pop(side, None)  # what a person stopped, a person starts
            elif now - self._asking_since.setdefault(side, now) > (SETTLE_S if self.since is None else SETTLE_AGAIN_S):
                self._asking_since[side] = now
                self._answer(side, state)
        if self.since is not None:
            return
        if not all(state is not None and state.state == ChannelState.ENGAGED for state in states.values()):
            self._both_since = None
        elif self._both_since is None:
            self._both_since = now
        elif now - self._both_since > STEADY_S:
            self.since, self.wall_since = now, time.time()

    def _answer(self, side: str, state: ChannelState) -> None:
        if self.since is not None:
            if self._answered.setdefault(side, 0) >= PATIENCE:
                return
            self._answered[side] += 1
            print(f"[demo] {side} held: {state.reason}: engages again", flush=True)
        engage(side)


def engage(side: str) -> None:
    """Asks the supervisor; says so when it refuses."""
    try:
        answer = rospy.ServiceProxy(f"/system/{side}/engage", Trigger)()
        refusal = None if answer.success else answer.message
    except rospy.ServiceException as error:
        refusal = str(error)
    if refusal is not None:
        print(f"[demo] {side}: not engaged: {refusal}", flush=True)
