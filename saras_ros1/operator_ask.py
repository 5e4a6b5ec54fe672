"""What an operator asks of one side, and the answer that he waits for."""

from __future__ import annotations

import threading

#: Acts on the lease of the arm, and acts on the side itself.
LEASE_ACTS = ("claim", "release", "offer", "withdraw", "accept")
SIDE_ACTS = ("engage", "hold", "disengage")


class Ask:
    """One act. operator and to are numbers from 1; 0: whoever holds the arm, and nobody.

    ``reason``: text shown when the act stops something. ``refusal``: a reason outside the sides why not to engage.
    """

    def __init__(
        self, side: str, act: str, operator: int = 0, to: int = 0, *, reason: str = "", refusal: str = ""
    ) -> None:
        if act not in LEASE_ACTS + SIDE_ACTS:
            raise ValueError(f"act '{act}': must be one of {', '.join(LEASE_ACTS + SIDE_ACTS)}")
        self.side, self.act, self.operator, self.to = side, act, operator, to
        self.reason, self.refusal = reason, refusal
        self.success, self.message = False, ""
        self.withdrawn = False  #: nobody waits any more: it must not happen later
        self._done = threading.Event()

    def answer(self, success: bool, message: str) -> None:
        """Called once, by who did or refused it."""
        self.success, self.message = success, message
        self._done.set()

    def wait(self, timeout_s: float) -> tuple[bool, str]:
        """The answer; after timeout_s the ask is withdrawn."""
        if not self._done.wait(timeout_s):
            self.withdrawn = True
            return False, f"{self.side}: the supervisor did not come to it within {timeout_s:g} s: ask again"
        return self.success, self.message
