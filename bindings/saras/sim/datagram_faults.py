"""Faults counted in datagrams, so that a test can say what it did: the next three lost, the next ten swapped."""

from __future__ import annotations

import random
from collections import Counter, deque

from saras import ConfigError

#: what can be done to the next datagrams
KINDS = ("drop", "swap", "duplicate", "flip")
REMEMBERED = 4096  #: datagrams kept for a replay


class DatagramFaults:
    """One direction. ``request`` names a fault for the next datagrams; ``pass_on`` says what becomes of each one.

    drop: lost. swap: comes after its successor. duplicate: comes twice. flip: one bit, drawn from the seed, is turned.
    Faults asked for together act on the same datagrams, in this order; a dropped one needs no other fault.
    """

    def __init__(self, seed: int) -> None:
        self.done: Counter[str] = Counter()
        self._random = random.Random(seed)
        self._left: Counter[str] = Counter()
        self._held: bytes | None = None
        self._passed: deque[bytes] = deque(maxlen=REMEMBERED)

    def request(self, kind: str, count: int) -> None:
        """Do this to the next ``count`` datagrams, beside what was asked for before."""
        if kind not in KINDS:
            raise ConfigError(f"fault = {kind!r}: must be one of {', '.join(KINDS)}")
        if count < 0:
            raise ConfigError(f"{kind} = {count}: must be >= 0")
        self._left[kind] += count

    @property
    def waiting(self) -> int:
        """Faults that were asked for and wait for datagrams."""
        return sum(self._left.values())

    def recorded(self, count: int) -> list[bytes]:
        """The newest ``count`` datagrams as their sender sent them, oldest first; at most REMEMBERED."""
        return list(self._passed)[-count:] if count > 0 else []

    def pass_on(self, datagram: bytes) -> list[bytes]:
        """What goes on instead of this datagram: nothing, itself, or several."""
        self._passed.append(datagram)
        if self._take("drop"):
            return []
        swapped = self._held is None and self._take("swap")
        out = [datagram, datagram] if self._take("duplicate") else [datagram]
        if self._take("flip"):
            bit = self._random.randrange(max(1, 8 * len(datagram)))
            out = [_flipped(each, bit) for each in out]
        if swapped:
            self._held = out[0]
            return out[1:]
        held, self._held = self._held, None
        return out if held is None else [*out, held]

    def _take(self, kind: str) -> bool:
        if self._left[kind] == 0:
            return False
        self._left[kind] -= 1
        self.done[kind] += 1
        return True


def _flipped(datagram: bytes, bit: int) -> bytes:
    if not datagram:
        return datagram
    damaged = bytearray(datagram)
    damaged[bit // 8] ^= 1 << bit % 8
    return bytes(damaged)
