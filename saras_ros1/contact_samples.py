"""Samples of a SARAS arm whose force is seen: the tip where it was when the pictures behind a force were taken.

/contact_force/<side>/wrench holds each reading for a while: a reading is one sample. One without a force (unknown,
saturated, too old) is none, and counted.
"""

from __future__ import annotations

import time
from collections import deque
from typing import Any, Callable

import numpy as np
from geometry_msgs.msg import PoseStamped, WrenchStamped

from saras_ros1 import convert
from saras_ros1.channel import base_frame
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.msg import Contact

HISTORY = 400  # poses: some seconds
HALF_NS = 25_000_000  # velocity is the way from so long before to so long after
GAP_NS = 100_000_000  # poses further apart than this say nothing of the time between
ANSWER_S = 1.0  # a reading whose force has not come by then has none
PENDING = 20

Push = Callable[[int, np.ndarray, np.ndarray, np.ndarray], None]


class TipHistory:
    """Positions by stamp."""

    def __init__(self) -> None:
        self._stamps: deque[int] = deque(maxlen=HISTORY)
        self._positions: deque[np.ndarray] = deque(maxlen=HISTORY)

    def add(self, stamp_ns: int, position: np.ndarray) -> None:
        """In the order of time; a clock that was set back begins anew."""
        if self._stamps and stamp_ns <= self._stamps[-1]:
            if stamp_ns < self._stamps[-1]:
                self._stamps.clear()
                self._positions.clear()
            else:
                return
        self._stamps.append(stamp_ns)
        self._positions.append(position)

    def covers(self, stamp_ns: int) -> bool:
        """Whether it goes on for long enough after the stamp."""
        return bool(self._stamps) and self._stamps[-1] >= stamp_ns + HALF_NS

    def at(self, stamp_ns: int) -> tuple[np.ndarray, np.ndarray] | None:
        """Position (3,) [m] and velocity (3,) [m/s] at a stamp; None: not known."""
        stamps = np.fromiter(self._stamps, dtype=np.int64)
        first, last = np.searchsorted(stamps, (stamp_ns - HALF_NS, stamp_ns + HALF_NS))
        if first == 0 or last == len(stamps):
            return None
        part = slice(first - 1, last + 1)
        if np.diff(stamps[part]).max() > GAP_NS:
            return None
        times = (stamps[part] - stamp_ns).astype(float)
        positions = np.array([self._positions[i] for i in range(first - 1, last + 1)])
        before, now, after = (
            np.array([np.interp(t, times, positions[:, k]) for k in range(3)]) for t in (-HALF_NS, 0, HALF_NS)
        )
        return now, (after - before) * NANOSECONDS / (2.0 * HALF_NS)


class ContactSource:
    """Gives push(stamp_ns, position, velocity, force) for each reading with a force; all in `frame`."""

    def __init__(self, node: Any, side: str, frame: str, timeout_s: float, push: Push) -> None:
        self._frame, self._base, self._push = frame, base_frame(side), push
        self._frames = LiveFrames(timeout_s)
        self._history = TipHistory()
        self._readings: dict[int, float] = {}
        self._waiting: deque[tuple[int, np.ndarray]] = deque(maxlen=PENDING)
        self._last_ns = 0
        self.counts = {"without_force": 0, "without_pose": 0}
        self.tip = node.input(f"/mesa_{side}/ee_pose", PoseStamped, self._read_pose, timeout_s=timeout_s)
        self.force = node.input(f"/contact_force/{side}/wrench", WrenchStamped, self._read_force, timeout_s=timeout_s)
        self.reading = node.input(f"/contact/{side}", Contact, timeout_s=timeout_s)
        self.inputs = (self.tip, self.force)
        self.tip.listeners.append(self._on_pose)
        self.force.listeners.append(self._on_force)
        self.reading.listeners.append(self._on_reading)

    def _turned(self) -> np.ndarray:
        """(4, 4) frame_T_base. Raises ValueError while it is not known."""
        if self._frame == self._base:
            return np.eye(4)
        try:
            return self._frames.fresh(self._frame, self._base)
        except UnknownFrameError as error:
            raise ValueError(str(error)) from None

    def _read_pose(self, message: PoseStamped) -> np.ndarray:
        return np.asarray(self._turned() @ convert.in_frame(self._base, convert.pose)(message))

    def _read_force(self, message: WrenchStamped) -> np.ndarray:
        return np.asarray(self._turned()[:3, :3] @ convert.in_frame(self._base, convert.wrench)(message)[:3])

    def _on_reading(self, reading: Input) -> None:
        now = time.monotonic()
        self._readings[reading.stamp_ns] = now
        for stamp_ns, came_s in list(self._readings.items()):
            if now - came_s > ANSWER_S:
                del self._readings[stamp_ns]
                self.counts["without_force"] += 1

    def _on_force(self, force: Input) -> None:
        self._readings.pop(force.stamp_ns, None)
        if force.stamp_ns == self._last_ns:
            return  # held
        self._last_ns = force.stamp_ns
        if len(self._waiting) == PENDING:
            self.counts["without_pose"] += 1  # the oldest one goes
        self._waiting.append((force.stamp_ns, force.value))
        self._give()

    def _on_pose(self, tip: Input) -> None:
        self._history.add(tip.stamp_ns, tip.value[:3, 3])
        self._give()

    def _give(self) -> None:
        while self._waiting and self._history.covers(self._waiting[0][0]):
            stamp_ns, force = self._waiting.popleft()
            found = self._history.at(stamp_ns)
            if found is None:
                self.counts["without_pose"] += 1
            else:
                self._push(stamp_ns, *found, force)

    def missing(self) -> str:
        """What is silent; empty: nothing."""
        if not self.tip.fresh:
            return f"nothing from {self.tip.topic}"
        if not self.force.fresh:
            why = f"{self.reading.topic} speaks, without a force" if self.reading.fresh else "no reading either"
            return f"nothing from {self.force.topic}: {why} ({self.counts['without_force']} so far)"
        return ""
