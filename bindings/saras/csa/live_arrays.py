"""Names of a prompt that follow topics: each message binds a new array, so what was looked at never changes again."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ConfigError

Array = npt.NDArray[np.float64]

#: name: (array before anything came, what it is)
ARRAYS: dict[str, tuple[Any, str]] = {
    "tip": (np.full(3, np.nan), "tip of the slave [m]"),
    "velocity": (np.full(3, np.nan), "its velocity [m/s]"),
    "force": (np.full(3, np.nan), "what it exerts on the tissue [N]"),
    "samples": (np.empty((0, 10)), "newest touches: t [s], tip, force, velocity of one stamp"),
    "proxy": (np.full(3, np.nan), "tip of the proxy [m]"),
    "desired": (np.full(3, np.nan), "where the hand wants slave and proxy [m]"),
    "mismatch": (np.array(np.nan), "slave to proxy [m]"),
    "state": ("", "contact state; after a comma why nobody moves"),
    "next_location": (np.full(3, np.nan), "where to touch next [m]"),
    "vertices": (np.empty((0, 3)), "of the stiffness map [m]"),
    "stiffness": (np.empty(0), "at the vertices [N/m]; NaN: not known"),
    "std": (np.empty(0), "its standard deviation [N/m]; inf: not known"),
    "mesh": (np.empty((0, 3, 3)), "corners of the map's triangles [m]"),
}
PARTS = ("tip", "force", "velocity")


class LiveArrays:
    """names: a dictionary for a prompt. capacity: rows of samples that are kept. Raises ConfigError."""

    def __init__(self, capacity: int = 60_000) -> None:
        if not 1 <= capacity <= 10_000_000:
            raise ConfigError(f"samples = {capacity}: must be in [1, 10000000]")
        self.names: dict[str, Any] = {}
        for name, (value, _) in ARRAYS.items():
            self.put(name, value)
        self._came: dict[str, float] = {}
        self.names["ages"] = self.ages
        self.names["show"] = lambda: print(self.table())
        self._capacity, self._rows = capacity, 0
        self._kept = np.empty((2 * capacity, 10))
        self._pending: dict[int, dict[str, Array]] = {}
        self._one_writer = threading.Lock()

    def put(self, name: str, value: Any) -> None:
        """Binds one of ARRAYS; arrays cannot be written to."""
        if isinstance(value, np.ndarray):
            value = value.view()
            value.flags.writeable = False
        self.names[name] = value

    def came(self, name: str, value: Any) -> None:
        """Binds what a message brought."""
        self.put(name, value)
        self._came[name] = time.monotonic()

    def sample(self, stamp_ns: int, part: str, value: Array) -> None:
        """One of PARTS (3,); a row of samples is made of three of one stamp."""
        self.came(part, value)
        with self._one_writer:
            parts = self._pending.setdefault(stamp_ns, {})
            parts[part] = value
            if len(parts) == len(PARTS):
                del self._pending[stamp_ns]
                self._append(np.concatenate([[1e-9 * stamp_ns], *(parts[name] for name in PARTS)]))
            while len(self._pending) > 100:  # their fellows never came
                del self._pending[next(iter(self._pending))]

    def ages(self) -> dict[str, float]:
        """Seconds since each name's topic last spoke; inf: never."""
        now = time.monotonic()
        return {name: now - self._came[name] if name in self._came else np.inf for name in ARRAYS}

    def table(self) -> str:
        """Name, shape, age, newest value and what it is, a line each."""
        lines = []
        for name, age in self.ages().items():
            value, (empty, meaning) = self.names[name], ARRAYS[name]
            shape = "text" if isinstance(value, str) else "x".join(map(str, np.shape(value))) or "number"
            said = "never came" if np.isinf(age) else f"{age:.1f} s ago"
            lines.append(f"{name:<14}{shape:<10}{said:<12}{_newest(value, np.shape(empty) == (0,)):<34} {meaning}")
        return "\n".join(lines)

    @property
    def any_came(self) -> bool:
        """Some topic has spoken."""
        return bool(self._came)

    def _append(self, row: Array) -> None:
        if self._rows == len(self._kept):  # a new block: views of the old one may still be looked at
            newest = self._kept[-self._capacity :]
            self._kept = np.empty_like(self._kept)
            self._kept[: self._capacity], self._rows = newest, self._capacity
        self._kept[self._rows] = row
        self._rows += 1
        self.came("samples", self._kept[max(0, self._rows - self._capacity) : self._rows])


def _newest(value: Any, many: bool) -> str:
    """The text, the numbers, or of many rows how far they reach."""
    if isinstance(value, str):
        return value or "-"
    if many:
        finite = value[np.isfinite(value)]
        return f"{finite.min():.4g} to {finite.max():.4g}, {len(finite)} known" if len(finite) else "none known"
    if value.ndim < 2:
        return " ".join(f"{number:.4g}" for number in np.atleast_1d(value))
    return "last " + " ".join(f"{number:.4g}" for number in value[-1].ravel()[:4]) if len(value) else "-"


__all__ = ["ARRAYS", "LiveArrays"]
