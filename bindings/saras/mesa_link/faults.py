"""Faults that a simulated arm shows on request, so that the platform's reactions can be tested over the real wire."""

from __future__ import annotations

from dataclasses import replace

from saras.mesa_link.fields import MessageError, Reader
from saras.mesa_link.protocol import Reason, State

KINDS = ("none", "frozen", "frozen_tick", "jump", "silent")


class FaultInjector:
    """Alters outgoing states. ``frozen``: content stands still, tick goes on; ``frozen_tick``: both stand still;
    ``jump``: the reported tip is off by ``offset`` [m]; ``silent``: no state leaves, the socket stays open.
    """

    def __init__(self) -> None:
        self._kind = "none"
        self._offset: tuple[float, ...] = (0.0, 0.0, 0.0)
        self._kept: State | None = None

    def inject(self, data: object) -> None:
        """Take an ``inject`` event: {kind, offset}."""
        read = Reader("inject", data)
        kind = read.text("kind", KINDS)
        if kind == "jump" and not read.has("offset"):
            raise MessageError(Reason.MALFORMED, "inject.offset: expected 3 numbers, got nothing")
        self._offset = read.vector("offset", 3) if read.has("offset") else (0.0, 0.0, 0.0)
        self._kind, self._kept = kind, None

    def alter(self, state: State) -> State | None:
        """The state to send instead, None for silence."""
        if self._kind == "silent":
            return None
        if self._kind == "jump":
            moved = tuple(x + d for x, d in zip(state.position, self._offset))
            return replace(state, position=moved)
        if self._kind in ("frozen", "frozen_tick"):
            self._kept = self._kept or state
            if self._kind == "frozen_tick":
                return self._kept
            return replace(self._kept, tick=state.tick, time_s=state.time_s)
        return state
