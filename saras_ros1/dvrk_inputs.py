"""Where a da Vinci arm's tip is, as a dVRK says it: real or simulated, CRTK's names or the older ones.

    arm = DvrkArmInput(node, "PSM1", timeout_s=0.15)
    if arm.fresh: use(arm.frame_id, arm.pose)
    else: show(arm.unknown_reason)

Pose topics have had three types; messages are kept raw and decoded when they are looked at.
"""

from __future__ import annotations

import struct
import threading
import time
from io import BytesIO
from typing import Any

import numpy as np
import rospy
from crtk_msgs.msg import OperatingState
from geometry_msgs.msg import PoseStamped, TransformStamped
from std_msgs.msg import String

from saras_ros1 import convert
from saras_ros1.stamped import StampedPose

POSE_TOPICS = ("/{}/measured_cp", "/dvrk/{}/position_cartesian_current")
READERS = {
    PoseStamped._type: (StampedPose, convert.pose),
    TransformStamped._type: (TransformStamped, convert.transform),
}
# What current_state said before CRTK while the arm was powered and homed; positions and efforts are its control modes.
OLD_ENABLED = ("ENABLED", "READY", "HOMED", "DVRK_READY", "DVRK_POSITION", "DVRK_EFFORT", "DVRK_CARTESIAN")
STAMP = struct.Struct("<III")  # Header: seq, secs, nsecs


class DvrkArmInput:
    """The newest good pose of one arm, and whether it may be believed.

    node: the Node in whose process it reads; None in tests. timeout_s: an older pose, or one whose stamp does not move
    on, is unknown. frame_override: used instead of the header's frame_id. An arm that says its state must be
    ENABLED; require_state: it must say it (recordings of before CRTK have no state in them).
    """

    def __init__(
        self, node: Any, name: str, *, timeout_s: float, frame_override: str = "", require_state: bool = False
    ) -> None:
        self.name, self.timeout_s, self.frame_override = name, timeout_s, frame_override
        self.require_state = require_state
        self.received = self.rejected = 0
        self._raw: tuple[str, bytes] | None = None
        self._received_s = float("-inf")
        self._stamp: tuple[int, int] | None = None
        self._fault = ""
        self._decoded: tuple[bytes, np.ndarray, str] | None = None
        self.state = ""
        self._subscribers = {
            pattern: rospy.Subscriber(
                pattern.format(name), rospy.AnyMsg, self._on_pose, pattern, queue_size=1, tcp_nodelay=True
            )
            for pattern in POSE_TOPICS
        }
        rospy.Subscriber(f"/{name}/operating_state", OperatingState, self._on_state, queue_size=5, tcp_nodelay=True)
        rospy.Subscriber(f"/dvrk/{name}/current_state", String, self._on_old_state, queue_size=5, tcp_nodelay=True)

    # ---- messages

    def _on_pose(self, message: Any, pattern: str) -> None:
        kind, raw = _raw(message)
        if kind not in READERS or len(raw) < STAMP.size:
            self._reject(f"{pattern.format(self.name)} has type {kind}: must be one of {', '.join(READERS)}")
            return
        _, secs, nsecs = STAMP.unpack_from(raw)
        if secs == 0 and nsecs == 0:
            self._reject("zero stamp: the arm says that the pose is not valid")
            return
        if (secs, nsecs) == self._stamp:
            return  # said again: it grows old
        self._stamp, self._raw, self._fault = (secs, nsecs), (kind, raw), ""
        self._received_s = time.monotonic()
        self.received += 1
        if pattern == POSE_TOPICS[0] and POSE_TOPICS[1] in self._subscribers:
            # One naming is enough. It takes calls of the master, which must not hold up reception.
            threading.Thread(target=self._subscribers.pop(POSE_TOPICS[1]).unregister, daemon=True).start()

    def _on_state(self, message: OperatingState) -> None:
        self.state = message.state

    def _on_old_state(self, message: String) -> None:
        self.state = "ENABLED" if message.data.startswith(OLD_ENABLED) else message.data

    def _reject(self, why: str) -> None:
        self.rejected += 1
        self._raw, self._fault = None, why

    # ---- what is known now

    @property
    def age_s(self) -> float:
        """Seconds since a pose with a new stamp came; infinite when none did."""
        return time.monotonic() - self._received_s

    @property
    def unknown_reason(self) -> str:
        """Why the pose must not be used; empty when it may be."""
        if self._fault:
            return f"{self.name}: {self._fault}"
        if self._raw is None:
            return f"{self.name}: nothing on {' or '.join(topic.format(self.name) for topic in POSE_TOPICS)}"
        if self.age_s > self.timeout_s:
            return f"{self.name}: pose is {self.age_s:.2f} s old: must be at most {self.timeout_s:g}"
        if self.state != "ENABLED" and (self.state or self.require_state):
            return f"{self.name}: state is {self.state or 'not known'}: must be ENABLED"
        try:
            _, _, frame = self._decode()
        except ValueError as error:
            return f"{self.name}: {error}"
        return "" if frame else f"{self.name}: the pose names no frame: set its override"

    @property
    def fresh(self) -> bool:
        """Whether `pose` may be used."""
        return not self.unknown_reason

    @property
    def pose(self) -> np.ndarray:
        """(4, 4) tool tip in `frame_id`. Raises ValueError when there is none or it is not finite."""
        return self._decode()[1]

    @property
    def frame_id(self) -> str:
        """The override, else the header's, without a leading slash; empty when no pose came."""
        return self.frame_override or ("" if self._raw is None else self._decode()[2])

    def _decode(self) -> tuple[bytes, np.ndarray, str]:
        newest = self._raw
        if newest is None:
            raise ValueError("no pose")
        kind, raw = newest
        if self._decoded is None or self._decoded[0] is not raw:
            message_class, read = READERS[kind]
            message = message_class().deserialize(raw)
            frame = self.frame_override or message.header.frame_id.lstrip("/")
            self._decoded = (raw, read(message), frame)
        return self._decoded

    def report(self) -> dict[str, Any]:
        """For /diagnostics."""
        age = f"{1e3 * self.age_s:.0f}" if self.received else "never"
        return {self.name: f"age_ms={age} received={self.received} rejected={self.rejected} {self.unknown_reason}"}


def _raw(message: Any) -> tuple[str, bytes]:
    """Type and bytes. rospy gives another subscriber's class where this process reads the topic a second time."""
    if isinstance(message, rospy.AnyMsg):
        return message._connection_header.get("type", ""), message._buff
    buffer = BytesIO()
    message.serialize(buffer)
    return message._type, buffer.getvalue()
