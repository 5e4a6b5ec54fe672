"""Samples of a slave: position, velocity and force of one stamp, kept for whoever learns. A subscriber never waits."""

from __future__ import annotations

import time
from collections import deque
from typing import Any, NamedTuple

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped

from saras_ros1 import convert
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.stamped import lean_class

WAITING = 50
CALLBACK_QUEUE = 200


class Batch(NamedTuple):
    """Samples in their order, dt [s] apart."""

    positions: np.ndarray
    velocities: np.ndarray
    forces: np.ndarray
    dt: float


class Samples:
    """Of <source>/measured_cp, measured_cv and measured_cf with equal stamps. At most `room` wait to be learned."""

    def __init__(self, node: Any, source: str, frame: str, timeout_s: float, room: int) -> None:
        self.tip = self._input(node, f"{source}/measured_cp", PoseStamped, convert.pose, frame, timeout_s)
        self.speed = self._input(node, f"{source}/measured_cv", TwistStamped, convert.twist, frame, timeout_s)
        self.force = self._input(node, f"{source}/measured_cf", WrenchStamped, convert.wrench, frame, timeout_s)
        self._parts: dict[int, dict[str, np.ndarray]] = {}
        self._ready: deque[tuple[int, np.ndarray, np.ndarray, np.ndarray]] = deque(maxlen=room)
        self._last_ns: int | None = None
        self.heard = self.dropped = 0
        self._joined_s, self._timeout_s = time.monotonic(), timeout_s
        for source_input in (self.tip, self.speed, self.force):
            source_input.listeners.append(self._on_part)

    @staticmethod
    def _input(node: Any, topic: str, kind: type, read: Any, frame: str, timeout_s: float) -> Input:
        made = Input(topic, timeout_s, convert.in_frame(frame, read), node.lock)
        node.inputs.append(made)
        # Not Node.input: a sample of 1 kHz is worth as much as the newest one.
        rospy.Subscriber(topic, lean_class(kind), made.on_message, queue_size=CALLBACK_QUEUE, tcp_nodelay=True)
        return made

    def _on_part(self, part: Input) -> None:
        parts = self._parts.setdefault(part.stamp_ns, {})
        parts[part.topic] = part.value[:3, 3] if part is self.tip else part.value[:3]
        if len(parts) == 3:
            del self._parts[part.stamp_ns]
            if len(self._ready) == self._ready.maxlen:
                self.dropped += 1
            self.heard += 1
            self._joined_s = time.monotonic()
            self._ready.append((part.stamp_ns, *(parts[i.topic] for i in (self.tip, self.speed, self.force))))
        elif len(self._parts) > WAITING:
            del self._parts[min(self._parts)]

    def take(self) -> Batch | None:
        """All that wait; None: none."""
        rows = []
        while self._ready:
            rows.append(self._ready.popleft())
        if not rows:
            return None
        rows.sort(key=lambda row: row[0])
        before, self._last_ns = self._last_ns, rows[-1][0]
        gaps = len(rows) if before is not None else max(1, len(rows) - 1)
        dt = (rows[-1][0] - (before if before is not None else rows[0][0])) / NANOSECONDS / gaps
        x, v, f = (np.array([row[i] for row in rows]) for i in (1, 2, 3))
        return Batch(x, v, f, min(max(dt, 1e-4), 0.1))

    def missing(self) -> str:
        """What is silent; empty: nothing."""
        silent = next((i for i in (self.tip, self.speed, self.force) if not i.fresh), None)
        if silent is not None:
            return f"nothing from {silent.topic}"
        if time.monotonic() - self._joined_s > self._timeout_s:
            return f"stamps of {self.tip.topic}, {self.speed.topic} and {self.force.topic} differ"
        return ""
