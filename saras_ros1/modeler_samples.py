"""Samples of a slave: position, velocity and force of one stamp, kept for whoever learns. A subscriber never waits."""

from __future__ import annotations

import time
from typing import Any, Callable

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped

from saras_ros1 import convert
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.stamped import lean_class

WAITING = 50
CALLBACK_QUEUE = 200


class Samples:
    """Of <source>/measured_cp, measured_cv and measured_cf with equal stamps.

    sink(stamps (n,) [s], positions (n, 3), forces, velocities): gets each sample; must not wait.
    """

    def __init__(self, node: Any, source: str, frame: str, timeout_s: float, sink: Callable[..., int]) -> None:
        self.tip = self._input(node, f"{source}/measured_cp", PoseStamped, convert.pose, frame, timeout_s)
        self.speed = self._input(node, f"{source}/measured_cv", TwistStamped, convert.twist, frame, timeout_s)
        self.force = self._input(node, f"{source}/measured_cf", WrenchStamped, convert.wrench, frame, timeout_s)
        self._parts: dict[int, dict[str, np.ndarray]] = {}
        self._sink = sink
        self.heard = 0
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
            self.heard += 1
            self._joined_s = time.monotonic()
            x, f, v = (parts[i.topic][None] for i in (self.tip, self.force, self.speed))
            self._sink(np.array([part.stamp_ns / NANOSECONDS]), x, f, v)
        elif len(self._parts) > WAITING:
            del self._parts[min(self._parts)]

    def missing(self) -> str:
        """What is silent; empty: nothing."""
        silent = next((i for i in (self.tip, self.speed, self.force) if not i.fresh), None)
        if silent is not None:
            return f"nothing from {silent.topic}"
        if time.monotonic() - self._joined_s > self._timeout_s:
            return f"stamps of {self.tip.topic}, {self.speed.topic} and {self.force.topic} differ"
        return ""
