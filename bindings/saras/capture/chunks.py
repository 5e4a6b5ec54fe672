"""Sound in pieces of one length, with numbers of samples that go on by time. Needs no GStreamer."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from saras import ConfigError

Samples = npt.NDArray[np.int16]

#: What comes so much later than the samples before it end was not heard in between.
GAP_NS = 100_000_000


class Chunk(NamedTuple):
    """samples: (n, channels). taken_ns: of the first one, nanoseconds since the epoch. first: its number."""

    samples: Samples
    taken_ns: int
    first: int


class Chunker:
    """Buffers of any length in, chunks of `count` samples out.

    The number of a sample counts from the first one that was ever heard; over a gap (a source that failed, sound that
    the card lost) it goes on by time. The piece before a gap is shorter.
    """

    def __init__(self, rate_hz: int, channels: int, count: int) -> None:
        self._rate_hz, self._count = rate_hz, max(1, count)
        self._kept: Samples = np.zeros((0, channels), np.int16)
        self._kept_ns: int | None = None  # of the first kept sample, or of the next one to come
        self._first = 0

    def add(self, samples: Samples, taken_ns: int | None) -> list[Chunk]:
        """samples: (n, channels); taken_ns: when the first was taken, None: right after the one before.

        Raises ConfigError: the very first ones have no time.
        """
        ready: list[Chunk] = []
        if self._kept_ns is None:
            if taken_ns is None:
                raise ConfigError("taken_ns = None: the first samples must have a time")
            self._kept_ns = taken_ns
        elif taken_ns is not None:
            gap_ns = taken_ns - (self._kept_ns + self._long_ns(len(self._kept)))
            if gap_ns > GAP_NS:
                ready += self.rest()
                self._first += round(1e-9 * gap_ns * self._rate_hz)
                self._kept_ns = taken_ns
            else:  # a card's clock is not the computer's: each buffer says anew when it was
                self._kept_ns = taken_ns - self._long_ns(len(self._kept))
        self._kept = np.concatenate([self._kept, samples])
        while len(self._kept) >= self._count:
            ready.append(self._take(self._count))
        return ready

    def rest(self) -> list[Chunk]:
        """What is kept, though it is no whole chunk."""
        return [self._take(len(self._kept))] if len(self._kept) else []

    def _take(self, count: int) -> Chunk:
        assert self._kept_ns is not None
        chunk = Chunk(self._kept[:count], self._kept_ns, self._first)
        self._kept, self._first = self._kept[count:], self._first + count
        self._kept_ns += self._long_ns(count)
        return chunk

    def _long_ns(self, count: int) -> int:
        return count * 1_000_000_000 // self._rate_hz


__all__ = ["GAP_NS", "Chunk", "Chunker"]
