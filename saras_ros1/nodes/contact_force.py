"""contact_force: from how deep stereo_contact sees a tip in the tissue to a force at a steady rate, held with its age.

Nothing is published that is not known: a consumer sees the age of what it has. A wrench's stamp is that of the images
behind it, so its age is on the wire too.
"""

from __future__ import annotations

import math
import time

import numpy as np
import rospy
from geometry_msgs.msg import Twist, Vector3, WrenchStamped

from saras.contact import ContactForce, ContactForceConfig
from saras_ros1 import convert
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.msg import Contact
from saras_ros1.node import Node, run

CLOCK_TOLERANCE_S = 0.02  # a stamp may be so far in the future: clocks of two hosts
UNKNOWN = (math.nan, np.zeros(3))


class Side:
    """One side: its readings, its law, its two outputs."""

    def __init__(self, node: ContactForceNode, side: str, config: ContactForceConfig) -> None:
        self.frame, self._frames = base_frame(side), node.frames
        self.law = ContactForce(config)
        self.contact = node.input(f"/contact/{side}", Contact, self._read, timeout_s=config.age_limit_s)
        self.contact.listeners.append(self._on_reading)
        self.reaction = node.output(f"/contact_force/{side}", Twist)
        self.wrench = node.output(f"/contact_force/{side}/wrench", WrenchStamped)
        self._new: tuple[float, np.ndarray] | None = None
        self._stamp_ns = 0
        self.last = None

    def _read(self, message: Contact) -> tuple[float, np.ndarray]:
        """Depth and direction in the arm's base; UNKNOWN: also when the direction cannot be turned there."""
        direction = np.array([message.direction.x, message.direction.y, message.direction.z])
        if not math.isfinite(message.depth) or not np.isfinite(direction).all():
            return UNKNOWN
        try:
            return message.depth, self._frames.fresh(self.frame, message.header.frame_id)[:3, :3] @ direction
        except UnknownFrameError as error:
            rospy.logwarn_throttle(1.0, f"{self.contact.topic}: {error}")
            return UNKNOWN

    def _on_reading(self, source: Input) -> None:
        self._new = source.value

    def step(self, dt: float) -> None:
        """One tick: a reading that came since the last one, or the one that is held."""
        if self._new is None:
            out = self.law.step(dt)
        else:
            (depth, direction), self._new = self._new, None
            self._stamp_ns = self.contact.stamp_ns
            out = self.law.step(dt, depth, direction, self._age_s())
        self.last = out
        if not out.has_estimate:
            return
        self.reaction.publish(Twist(linear=Vector3(*out.reaction)))
        self.wrench.publish(convert.wrench_msg(out.exerted, self.frame, self._stamp_ns))

    def _age_s(self) -> float:
        """Of the newest reading, from its stamp; negative (unknown) for a stamp from the future."""
        age_s = (rospy.Time.now().to_nsec() - self._stamp_ns) / NANOSECONDS
        return age_s if age_s < -CLOCK_TOLERANCE_S else max(age_s, 0.0)


class ContactForceNode(Node):
    """Both sides at one rate, whatever the rate of the readings."""

    def __init__(self) -> None:
        super().__init__("contact_force")
        rate_hz = self.params.number("rate_hz", 1.0, 200.0)
        self.frames = LiveFrames(self.params.number("transform_timeout_s", 0.005, 1.0))
        config = self.params.build(ContactForceConfig, "law")
        self.params.finish()
        self.sides = {side: Side(self, side, config) for side in SIDES}
        self._last_s = time.monotonic()
        self.ticks = self._ticks_at_report = 0
        self.every(1.0 / rate_hz, self.tick)

    def tick(self) -> None:
        """Steps by the time that really went by: a reading must not look younger than it is."""
        now = time.monotonic()
        with self.lock:
            dt, self._last_s = now - self._last_s, now
            self.ticks += 1
            for side in self.sides.values():
                side.step(dt)

    def report(self) -> dict:
        """Rate, and per side what is said and why not more."""
        ticks, self._ticks_at_report = self.ticks - self._ticks_at_report, self.ticks
        values = {"rate_hz": ticks}
        for name, side in self.sides.items():
            out = side.last
            if out is None or not out.has_estimate:
                values[name] = "unknown: " + ("WAITING" if out is None else out.status.name)
            else:
                force_N = float(np.linalg.norm(out.reaction))
                values[name] = f"{force_N:.2f} N, {1e3 * out.depth_m:.1f} mm, {1e3 * out.age_s:.0f} ms old"
        return values


def main() -> int:
    """Runs the node."""
    return run(ContactForceNode)
