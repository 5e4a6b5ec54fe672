"""How late a packet is, without comparing clocks: receive minus send time above the link's running minimum."""

from __future__ import annotations

import math

DRIFT = 200e-6  # the minimum rises this fast [s/s], so that clocks drifting apart do not read as lag


class LagMeter:
    """One link. Constant delay is not lag; a backlog is."""

    def __init__(self) -> None:
        self._least_s = math.inf
        self._last_s = 0.0

    def step(self, received_s: float, sent_s: float) -> float:
        """Lag [s] of a packet sent at ``sent_s`` (sender's clock), received at ``received_s`` (ours)."""
        offset_s = received_s - sent_s
        if math.isfinite(self._least_s):
            self._least_s += DRIFT * max(0.0, received_s - self._last_s)
        self._least_s = min(self._least_s, offset_s)
        self._last_s = received_s
        return offset_s - self._least_s
