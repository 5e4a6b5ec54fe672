"""Something that a side needs: its name for the operator, its age now, how old it may be, what to do about it."""

from __future__ import annotations

import math
from typing import NamedTuple


class Watch(NamedTuple):
    """Ages in seconds; infinite: never seen."""

    name: str
    age_s: float
    limit_s: float
    advice: str

    @property
    def seen(self) -> bool:
        """Whether it was ever there."""
        return not math.isinf(self.age_s)

    @property
    def fresh(self) -> bool:
        """Whether it is there now."""
        return self.age_s <= self.limit_s


def describe(missing: list[Watch]) -> str:
    """What is missing, and for how long."""
    return "; ".join(
        f"no {w.name} for {w.age_s * 1e3:.0f} ms (limit {w.limit_s * 1e3:.0f})" if w.seen else f"no {w.name} yet"
        for w in missing
    )
