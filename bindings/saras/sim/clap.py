"""The clap: what picture, motion and sound of a simulated session show at one true time, to measure their alignment.

It begins at each full second of the computer's clock. Each simulator looks at the clock itself, nobody tells another.
"""

from __future__ import annotations

SECOND_NS = 1_000_000_000
#: The picture is bright, PSM1's tip is lifted; so long that a slow camera sees it too.
CLAP_NS = 300_000_000
#: The beep.
BEEP_NS = 100_000_000
#: By which PSM1's tip is lifted.
LIFT_M = 0.005


def is_on(time_ns: int, long_ns: int = CLAP_NS) -> bool:
    """Whether the clap is seen at this time (nanoseconds since the epoch)."""
    return time_ns % SECOND_NS < long_ns


__all__ = ["BEEP_NS", "CLAP_NS", "LIFT_M", "SECOND_NS", "is_on"]
