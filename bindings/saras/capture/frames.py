"""From frames to pairs: splitting, and pairing by time. Whether a camera repeats itself: saras.overlay.FrozenWatch."""

from __future__ import annotations

from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from saras import ConfigError

Image = npt.NDArray[np.uint8]
LAYOUTS = ("two_devices", "side_by_side", "top_bottom")
T = TypeVar("T")


def halves(pixels: Image, layout: str) -> tuple[Image, Image]:
    """Left and right, or upper and lower half of (height, width, 3). Raises ConfigError for a side that is odd."""
    axis = {"side_by_side": 1, "top_bottom": 0}[layout]
    side = pixels.shape[axis]
    if side % 2:
        raise ConfigError(f"{layout} picture is {pixels.shape[1]}x{pixels.shape[0]}: that side must be even")
    first, second = np.split(pixels, 2, axis=axis)
    return np.ascontiguousarray(first), np.ascontiguousarray(second)


class Pairing(Generic[T]):
    """Joins frames of two devices that were taken within skew_s of each other."""

    def __init__(self, skew_s: float) -> None:
        self.skew_s = skew_s
        self.apart_s = 0.0  #: how far apart the last two frames were
        self._waiting: dict[int, tuple[float, T]] = {}

    def add(self, side: int, taken_s: float, frame: T) -> list[tuple[T | None, T | None]]:
        """side: 0 left, 1 right. What is ready: pairs, or one of an eye whose partner did not come in time."""
        other = self._waiting.get(1 - side)
        ready: list[tuple[T | None, T | None]] = []
        if other is not None:
            self.apart_s = taken_s - other[0]
        before = self._waiting.pop(side, None)
        if before is not None:
            ready.append((before[1], None) if side == 0 else (None, before[1]))
        if other is not None and abs(self.apart_s) <= self.skew_s:
            del self._waiting[1 - side]
            ready.append((frame, other[1]) if side == 0 else (other[1], frame))
        else:
            self._waiting[side] = (taken_s, frame)
        return ready


__all__ = ["LAYOUTS", "Pairing", "halves"]
