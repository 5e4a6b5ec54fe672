"""Which moments of the overlay are worth a still in the record: one of each state, and again after a while. Pure."""

from __future__ import annotations

from collections.abc import Iterable

UNKNOWN, CLEAR, WARNING, COLLISION = range(4)  # as saras_ros1/ToolProximity has them
NAMES = ("unknown", "clear", "warning", "collision")
AGAIN_S = 20.0
SETTLED_S = 0.3


def worst(states: Iterable[int]) -> int:
    """Of all tools: a known danger before what is unknown, that before clear."""
    found = set(states)
    for state in (COLLISION, WARNING, UNKNOWN):
        if state in found:
            return state
    return CLEAR if found else UNKNOWN


class Moments:
    """Says when a still is due. A state must have lasted a moment: the picture of it comes later than its word."""

    def __init__(self) -> None:
        self.state = UNKNOWN
        self._since_s: float | None = None
        self._taken_s: dict[int, float] = {}

    @property
    def state_name(self) -> str:
        """In words."""
        return NAMES[self.state]

    def update(self, states: Iterable[int], now_s: float) -> None:
        """states: of all tools, now."""
        state = worst(states)
        if state != self.state or self._since_s is None:
            self.state, self._since_s = state, now_s

    def due(self, now_s: float) -> bool:
        """Whether the next picture shows something that has not been shown lately."""
        if self._since_s is None or now_s - self._since_s < SETTLED_S:
            return False
        return now_s - self._taken_s.get(self.state, float("-inf")) >= AGAIN_S

    def taken(self, now_s: float) -> str:
        """A still was taken; the name of what it shows."""
        self._taken_s[self.state] = now_s
        return NAMES[self.state]
