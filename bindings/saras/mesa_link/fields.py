"""Reading JSON that a peer sent: each refusal names event, field, value and what was expected."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Any

from saras import ProtocolError

QUATERNION_TOLERANCE = 1e-3  # of the norm; JSON rounding stays far below it
LARGEST_INTEGER = 2**53  # JSON numbers are doubles in most languages


class MessageError(ProtocolError):
    """A message is refused. ``reason`` is one of :class:`Reason`'s values, the text names the field."""

    def __init__(self, reason: str, detail: str) -> None:
        super().__init__(f"{reason}: {detail}")
        self.reason = reason
        self.detail = detail


class Reader:
    """The fields of one event's JSON object. Every read checks type, size, finiteness and range."""

    def __init__(self, event: str, data: object) -> None:
        if not isinstance(data, dict):
            raise MessageError("malformed", f"{event}: expected one JSON object, got {_shown(data)}")
        self._event = event
        self._data: dict[str, Any] = data

    def _refuse(self, name: str, expected: str, reason: str = "malformed") -> MessageError:
        value = _shown(self._data[name]) if name in self._data else "nothing"
        return MessageError(reason, f"{self._event}.{name}: expected {expected}, got {value}")

    def has(self, name: str) -> bool:
        """Whether the field is there and not null."""
        return self._data.get(name) is not None

    def integer(self, name: str, lowest: int = 0, highest: int = LARGEST_INTEGER) -> int:
        """An integer in [lowest, highest]."""
        value = self._data.get(name)
        if type(value) is not int or not lowest <= value <= highest:
            raise self._refuse(name, f"an integer from {lowest} to {highest}")
        return value

    def boolean(self, name: str) -> bool:
        """True or false, nothing that merely looks like it."""
        value = self._data.get(name)
        if type(value) is not bool:
            raise self._refuse(name, "true or false")
        return value

    def text(self, name: str, choices: Sequence[str] = (), longest: int = 200) -> str:
        """A string, one of ``choices`` when given."""
        value = self._data.get(name)
        if not isinstance(value, str) or len(value) > longest:
            raise self._refuse(name, f"a string of at most {longest} characters")
        if choices and value not in choices:
            raise self._refuse(name, " or ".join(choices))
        return value

    def number(self, name: str, lowest: float = -math.inf, highest: float = math.inf) -> float:
        """A finite number in [lowest, highest]."""
        value: Any = self._data.get(name)
        if type(value) not in (int, float):
            raise self._refuse(name, "a number")
        if not math.isfinite(value):
            raise self._refuse(name, "a finite number", "non_finite")
        if not lowest <= value <= highest:
            raise self._refuse(name, f"a number in [{lowest:g}, {highest:g}]")
        return float(value)

    def vector(self, name: str, size: int) -> tuple[float, ...]:
        """``size`` finite numbers."""
        value = self._data.get(name)
        if not isinstance(value, (list, tuple)) or len(value) != size:
            raise self._refuse(name, f"{size} numbers")
        for number in value:
            if type(number) not in (int, float):
                raise self._refuse(name, f"{size} numbers")
            if not math.isfinite(number):
                raise self._refuse(name, f"{size} finite numbers", "non_finite")
        return tuple(float(number) for number in value)

    def quaternion(self, name: str) -> tuple[float, ...]:
        """A unit quaternion x, y, z, w; normalised when within 1e-3 of unit length."""
        value = self.vector(name, 4)
        norm = math.sqrt(sum(number * number for number in value))
        if abs(norm - 1.0) > QUATERNION_TOLERANCE:
            raise self._refuse(name, f"a unit quaternion (norm is {norm:.6g})")
        return tuple(number / norm for number in value)

    def part(self, name: str) -> Reader:
        """The object in field ``name``."""
        return Reader(f"{self._event}.{name}", self._data.get(name))

    def counters(self, name: str) -> dict[str, int]:
        """An object of non-negative integers."""
        reader = self.part(name)
        return {key: reader.integer(key) for key in reader._data}


def _shown(value: object) -> str:
    """A value for an error message, cut short: a peer must not fill our log."""
    try:
        text = json.dumps(value)
    except (TypeError, ValueError):
        text = type(value).__name__
    return text if len(text) <= 80 else text[:77] + "..."
