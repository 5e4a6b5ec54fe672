"""Samples for whoever learns: position, velocity and force of one moment. A subscriber never waits."""

from __future__ import annotations

import time
from typing import Any, Callable

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped

from saras import ConfigError
from saras_ros1 import convert
from saras_ros1.channel import SIDES
from saras_ros1.contact_samples import ContactSource, Push
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.stamped import lean_class

WAITING = 50
CALLBACK_QUEUE = 200
CONTACT = "contact/"


class Samples:
    """Of <source>/measured_cp, measured_cv and measured_cf with equal stamps, in `frame`; or, with contact/left or
    contact/right, of a SARAS arm and the force that is seen. Raises ConfigError.

    sink(stamps (n,) [s], positions (n, 3), forces, velocities): gets each sample; must not wait.
    """

    def __init__(self, node: Any, source: str, frame: str, timeout_s: float, sink: Callable[..., int]) -> None:
        self._sink = sink
        self.heard = 0
        self._joined_s, self._timeout_s = time.monotonic(), timeout_s
        self._source: StampedSource | ContactSource
        if source.startswith(CONTACT):
            side = source[len(CONTACT) :]
            if side not in SIDES:
                raise ConfigError(f"{node.name}/source = {source!r}: must be {' or '.join(CONTACT + s for s in SIDES)}")
            self._source = ContactSource(node, side, frame, timeout_s, self._push)
        else:
            self._source = StampedSource(node, source, frame, timeout_s, self._push)
        self.tip: Input = self._source.tip

    def _push(self, stamp_ns: int, position: np.ndarray, velocity: np.ndarray, force: np.ndarray) -> None:
        self.heard += 1
        self._joined_s = time.monotonic()
        self._sink(np.array([stamp_ns / NANOSECONDS]), position[None], force[None], velocity[None])

    @property
    def counts(self) -> dict[str, int]:
        """What did not become a sample, and why."""
        return self._source.counts

    def missing(self) -> str:
        """What is silent; empty: nothing."""
        silent = self._source.missing()
        if not silent and time.monotonic() - self._joined_s > self._timeout_s:
            return f"stamps of {', '.join(i.topic for i in self._source.inputs)} differ"
        return silent


class StampedSource:
    """<source>/measured_cp, measured_cv and measured_cf: those with equal stamps are a sample."""

    def __init__(self, node: Any, source: str, frame: str, timeout_s: float, push: Push) -> None:
        self.tip = self._input(node, f"{source}/measured_cp", PoseStamped, convert.pose, frame, timeout_s)
        self.speed = self._input(node, f"{source}/measured_cv", TwistStamped, convert.twist, frame, timeout_s)
        self.force = self._input(node, f"{source}/measured_cf", WrenchStamped, convert.wrench, frame, timeout_s)
        self.inputs = (self.tip, self.speed, self.force)
        self.counts = {"without_partner": 0}
        self._parts: dict[int, dict[str, np.ndarray]] = {}
        self._push = push
        for source_input in self.inputs:
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
            self._push(part.stamp_ns, *(parts[i.topic] for i in self.inputs))
        elif len(self._parts) > WAITING:
            del self._parts[min(self._parts)]
            self.counts["without_partner"] += 1

    def missing(self) -> str:
        """What is silent; empty: nothing."""
        silent = next((i for i in self.inputs if not i.fresh), None)
        return "" if silent is None else f"nothing from {silent.topic}"
