"""An impaired link that carries Python objects."""

from __future__ import annotations

import math
from typing import Generic, TypeVar

from saras._core.sim import Channel, ChannelConfig, ChannelCounters

T = TypeVar("T")

KEEP_S = 5.0
"""How long a payload is kept beyond its sending: longer than any delay in use."""


class Link(Generic[T]):
    """A :class:`Channel` with payloads: what is sent comes out late, twice, out of order or not at all.

    Payloads are shared, not copied: send values that nobody changes (bytes, tuples, frozen dataclasses).
    """

    def __init__(self, config: ChannelConfig | None = None) -> None:
        """Take the impairments; none by default."""
        self._channel = Channel(config if config is not None else ChannelConfig())
        self._keep_s = (
            KEEP_S + self._channel.config.delay_s + self._channel.config.jitter_s + 2 * self._channel.config.reorder_s
        )
        self._payloads: dict[int, tuple[float, T]] = {}
        self._next_id = 0
        self._held_until = -math.inf

    def send(self, payload: T, now: float) -> None:
        """Put a payload on the link at the time ``now`` [s]."""
        self._payloads[self._next_id] = (now, payload)
        self._channel.send(self._next_id, now)
        self._next_id += 1

    def receive(self, now: float) -> list[T]:
        """All payloads that are due at the time ``now`` [s], in order of arrival."""
        due = [self._payloads[i][1] for i in self._channel.receive(now)]
        if now - self._keep_s > self._held_until:
            self._forget_before(now - self._keep_s)
        return due

    def blackout_until(self, time: float) -> None:
        """Lose all that is sent before ``time`` [s]: a link that is cut."""
        self._channel.blackout_until(time)

    def hold_until(self, time: float) -> None:
        """Deliver nothing before ``time`` [s], then all at once: a stalled queue."""
        self._held_until = time
        self._channel.hold_until(time)

    @property
    def next_arrival(self) -> float:
        """When the next payload comes out [s]; infinity: none is under way."""
        return self._channel.next_arrival

    @property
    def counters(self) -> ChannelCounters:
        """What the channel did so far."""
        return self._channel.counters

    def _forget_before(self, time: float) -> None:
        # Lost payloads never come out; ids grow with time, so the oldest are first.
        while self._payloads:
            oldest = next(iter(self._payloads))
            if self._payloads[oldest][0] >= time:
                break
            del self._payloads[oldest]
