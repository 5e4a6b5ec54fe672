"""How far another host's clock is ahead of ours, from questions and answers over a network. No socket, no clock.

An exchange has four times: sent and received on our clock, heard and answered on the other one. The offset then lies
within half the round trip of its middle, however unequal both ways are (RFC 5905 §8). The exchange with the
shortest round trip says most; it loses worth as it ages, because clocks drift apart.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

from saras import ConfigError

#: Two undisciplined clocks [s/s]: what crystals of ordinary computers stay within. chrony's own bound is smaller.
DRIFT = 200e-6
_S = 1e-9


class Exchange(NamedTuple):
    """Times of one question and its answer [ns]: sent and received on our clock, heard and answered on theirs."""

    sent_ns: int
    heard_ns: int
    answered_ns: int
    received_ns: int

    @property
    def round_trip_s(self) -> float:
        """Time on the way, both ways together; negative when a clock was set meanwhile."""
        return _S * ((self.received_ns - self.sent_ns) - (self.answered_ns - self.heard_ns))

    @property
    def offset_s(self) -> float:
        """Their clock less ours, as if both ways took equally long."""
        return _S * ((self.heard_ns - self.sent_ns) + (self.answered_ns - self.received_ns)) / 2.0


class Offset(NamedTuple):
    """Their clock less ours [s], true within ± error_s; round_trip_s of the exchange that says so."""

    offset_s: float
    error_s: float
    round_trip_s: float


class ClockOffset:
    """The estimate for one host. Times `at_s` are on a clock of ours that nobody sets."""

    def __init__(self, keep: int = 8, stale_s: float = 120.0) -> None:
        if keep < 1:
            raise ConfigError(f"keep = {keep}: must be at least 1 exchange")
        if not 0.0 < stale_s < float("inf"):
            raise ConfigError(f"stale_s = {stale_s}: must be a finite number above 0")
        self.stale_s = stale_s
        self.steps = 0  #: how often a clock was set, theirs or ours
        self.refused = 0  #: exchanges during which one was
        self._kept: deque[tuple[float, Exchange]] = deque(maxlen=keep)

    def add(self, exchange: Exchange, at_s: float) -> bool:
        """Takes an exchange that ended at at_s; False when it is refused: a clock was set on its way.

        One that contradicts what is kept means that a clock was set in between: the older ones are forgotten.
        """
        if exchange.round_trip_s < 0.0 or exchange.answered_ns < exchange.heard_ns:
            self.refused += 1
            return False
        known = self.estimate(at_s)
        if known is not None and abs(exchange.offset_s - known.offset_s) > known.error_s + exchange.round_trip_s / 2:
            self._kept.clear()
            self.steps += 1
        self._kept.append((at_s, exchange))
        return True

    def estimate(self, now_s: float) -> Offset | None:
        """The offset at now_s; None, unknown, without an exchange of the last stale_s."""
        best: Offset | None = None
        for at_s, exchange in self._kept:
            age_s = max(0.0, now_s - at_s)
            error_s = exchange.round_trip_s / 2 + DRIFT * age_s
            if age_s <= self.stale_s and (best is None or error_s < best.error_s):
                best = Offset(exchange.offset_s, error_s, exchange.round_trip_s)
        return best
