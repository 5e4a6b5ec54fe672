"""One side of the supervisor: ages and operators' words in, state and reason out, by the state table of saras.safety.

No ROS in here, so that tests can walk through it.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from saras.safety import CrtkState, SafetyEvent, SafetySign, crtk_state, event_of, next_state
from saras.safety import SafetyState as State

# One console, so no lease yet: who asks is the holder. The tracked pose is referenced at engagement: always aligned.
_ASKED = int(SafetySign.ENGAGE_ASKED) | int(SafetySign.HOLDER_ASKS) | int(SafetySign.ALIGNED)


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
    """One side's state. update() each period; engage(), hold(), disengage(), estop() are the operator's words.

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
                self._stop(SafetyEvent.FAULT, fault, "look at the arm, then engage again")
            elif missing and self._was_missing:
                self._stop(SafetyEvent.LOST, _describe(missing), missing[0].advice)
        elif self.state in (State.WAITING, State.READY):
            self._take(SafetyEvent.LOST if missing else SafetyEvent.READY)
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
        if self.state == State.ESTOP:
            return False, f"{self.side} not engaged: {self.reason}: {self.advice}"
        missing = [w for w in self._watches if not w.fresh]
        there = bool(self._watches) and not missing and not refusal
        event = event_of(_ASKED | int(SafetySign.ALL_THERE)) if there else event_of(_ASKED)
        self._take(event)
        if self.state != State.ENGAGED:
            return False, f"{self.side} not engaged: {refusal or _describe(missing) or self.reason}"
        self.engagement += 1
        self.reason, self.advice = "engaged", ""
        self._auto = False
        return True, f"{self.side} engaged (number {self.engagement})"

    def hold(self, reason: str = "the operator asked") -> None:
        """Stops this side."""
        if self.state != State.ESTOP:
            self._stop(SafetyEvent.HOLD, reason, "engage again when ready")

    def disengage(self) -> None:
        """Ends the engagement, or gives a HOLD up: WAITING or READY, as things are. No way out of an E-stop."""
        if self.state in (State.ENGAGED, State.HOLD):
            self._stop(SafetyEvent.DISENGAGE, "disengaged by the operator", "")

    def estop(self, reason: str = "E-stop") -> None:
        """Stops this side at once and stays so until estop_reset(), whatever its state."""
        self._stop(SafetyEvent.ESTOP, reason, "make it safe, reset the E-stop, then engage again")

    def estop_reset(self) -> None:
        """To HOLD: nothing moves before an explicit engage."""
        if self.state == State.ESTOP:
            self._stop(SafetyEvent.ESTOP_RESET, "the E-stop was reset", "engage again when ready")

    @property
    def crtk(self) -> str:
        """CRTK's name of this state."""
        return crtk_state(self.state).name

    def _stop(self, event: SafetyEvent, reason: str, advice: str) -> None:
        self._auto = self._auto and event in (SafetyEvent.LOST, SafetyEvent.FAULT)
        self._take(event)
        self.reason, self.advice = reason, advice

    def _take(self, event: SafetyEvent) -> None:
        self.state = next_state(self.state, event)


def crtk_of_all(names: list[str]) -> str:
    """CRTK's name of the whole: FAULT when a side is, else ENABLED when one may move, else PAUSED, else DISABLED."""
    ranks = (CrtkState.FAULT, CrtkState.ENABLED, CrtkState.PAUSED)
    return next((state.name for state in ranks if state.name in names), CrtkState.DISABLED.name)


def _describe(missing: list[Watch]) -> str:
    return "; ".join(
        f"no {w.name} for {w.age_s * 1e3:.0f} ms (limit {w.limit_s * 1e3:.0f})" if w.seen else f"no {w.name} yet"
        for w in missing
    )
