"""Whose hand is on one side, when several operators have consoles: one console's data passes at a time. Pure."""

from __future__ import annotations

import time
from typing import Callable

#: Silence between two consoles' data: longer than any law's dt_max_s, so that all take new references.
PAUSE_S = 0.15


class ConsoleSwitch:
    """The source of one side: the console of who holds the arm; while nobody does, one that is heard.

    Both energy ledgers, the port guard's and tank_master's, begin a new session with each change, whose first message
    credits nothing: what tank_master sent to one operator's guard is never credited to the other's.
    """

    def __init__(self, operators: tuple[str, ...]) -> None:
        self.source = operators[0]
        self._operators = operators
        self._opens_at_s = 0.0
        self._epoch = self._newest_session = 0

    def update(self, holder: str, heard: Callable[[str], bool], now_s: float) -> bool:
        """holder: operator who holds the arm, "" for nobody. now_s: monotonic. True when the source changed."""
        wanted = self.source
        if holder in self._operators:
            wanted = holder
        elif not heard(self.source):
            wanted = next((name for name in self._operators if heard(name)), self.source)
        if wanted == self.source:
            return False
        self.source = wanted
        self._opens_at_s = now_s + PAUSE_S
        self._epoch = max(time.time_ns(), self._newest_session + 1)
        return True

    def passes(self, operator: str, now_s: float) -> bool:
        """Whether this operator's data goes on now."""
        return operator == self.source and now_s >= self._opens_at_s

    def session(self, session: int) -> int:
        """Number of a ledger's session beyond the switch: larger after each restart of its owner and each change."""
        mapped = max(session, self._epoch)
        self._newest_session = max(self._newest_session, mapped)
        return mapped
