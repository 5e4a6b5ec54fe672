"""The state table of one side: WAITING, READY, ENGAGED, HOLD. No ROS in here, so that tests can walk through it."""

from __future__ import annotations

import enum
import math
from typing import NamedTuple


class State(enum.IntEnum):
    """Same numbers as saras_ros1/ChannelState."""

    WAITING = 0
    READY = 1
    ENGAGED = 2
    HOLD = 3


class Watch(NamedTuple):
    """Something that a side needs: its name for the operator, its age now, how old it may be, what to do about it."""

    name: str
    age_s: float
    limit_s: float
    advice: str

    @property
    def seen(self) -> bool:
        """Whether it was ever there."""
        return not math.isinf(self.age_s)

    @property
    def fresh(self) -> bool:
        """Whether it is there now."""
        return self.age_s <= self.limit_s


class SideSupervisor:
    """One side's state. update() each period; engage() and hold() are the operator's words.

    READY falls back to WAITING by itself; ENGAGED falls to HOLD, which is latched until an explicit engage. Silence
    must be seen in two updates in a row, so that one hiccup of this process latches nothing; motion and force do not
    wait for that, each receiver's own watchdog has stopped them at the limit.
    auto_engage engages by itself once, when all was there for settle_updates in a row; never out of HOLD.
    """

    def __init__(self, side: str, auto_engage: bool = False, settle_updates: int = 1) -> None:
        self.side = side
        self.state = State.WAITING
        self.engagement = 0
        self.reason = "nothing was seen yet"
        self.advice = ""
        self._auto = auto_engage
        self._settle_updates = settle_updates
        self._ready_updates = 0
        self._watches: list[Watch] = []
        self._was_missing = False

    def update(self, watches: list[Watch], fault: str = "") -> bool:
        """New ages, and a fault that needs no age (a pose that jumped). True when the state changed."""
        self._watches = watches
        before = self.state
        missing = [w for w in watches if not w.fresh]
        if self.state == State.ENGAGED:
            if fault:
                self._hold(fault, "look at the arm, then engage again")
            elif missing and self._was_missing:
                self._hold(_describe(missing), missing[0].advice)
        elif self.state != State.HOLD:
            self.state = State.WAITING if missing else State.READY
            self.reason = _describe(missing) if missing else "all there"
            self.advice = missing[0].advice if missing else "engage to begin"
            self._ready_updates = self._ready_updates + 1 if self.state == State.READY else 0
            if self._auto and self._ready_updates >= self._settle_updates:
                self.engage()
        self._was_missing = bool(missing)
        return self.state != before

    def engage(self, refusal: str = "") -> tuple[bool, str]:
        """(whether engaged now, what was said). refusal: a reason outside this side, such as a dead master."""
        if self.state == State.ENGAGED:
            return True, f"{self.side} is engaged already"
        missing = [w for w in self._watches if not w.fresh]
        if refusal or missing or not self._watches:
            return False, f"{self.side} not engaged: {refusal or _describe(missing) or self.reason}"
        self.engagement += 1
        self.state = State.ENGAGED
        self.reason, self.advice = "engaged", ""
        self._auto = False
        return True, f"{self.side} engaged (number {self.engagement})"

    def hold(self, reason: str = "the operator asked") -> None:
        """Stops this side."""
        self._auto = False
        self._hold(reason, "engage again when ready")

    def _hold(self, reason: str, advice: str) -> None:
        self.state, self.reason, self.advice = State.HOLD, reason, advice


def _describe(missing: list[Watch]) -> str:
    return "; ".join(
        f"no {w.name} for {w.age_s * 1e3:.0f} ms (limit {w.limit_s * 1e3:.0f})" if w.seen else f"no {w.name} yet"
        for w in missing
    )
