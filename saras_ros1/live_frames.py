"""Transforms through tf2 that know their age."""

from __future__ import annotations

import numpy as np
import rospy
import tf2_ros
from tf2_msgs.msg import TFMessage

from saras_ros1 import convert
from saras_ros1.static_frames import StaticFrames


class UnknownFrameError(Exception):
    """A transform that is missing, too old, or not rigid; the text says which and why."""


class LiveFrames(StaticFrames):
    """/tf_static and /tf. tf2 gives old transforms under Time(0) without complaint: here they are refused."""

    def __init__(self, timeout_s: float) -> None:
        super().__init__()
        self.timeout_s = timeout_s
        self._static: dict[tuple[str, str], tuple[int, np.ndarray]] = {}  # changes, target_T_source
        rospy.Subscriber("/tf", TFMessage, self._on_moving, queue_size=100, tcp_nodelay=True)

    def _on_moving(self, message: TFMessage) -> None:
        for transform in message.transforms:
            try:
                convert.transform(transform)
                self._buffer.set_transform(transform, "tf")
            except (ValueError, tf2_ros.TransformException) as error:
                names = f"{transform.header.frame_id} → {transform.child_frame_id}"
                rospy.logwarn_throttle(1.0, f"/tf: {names} refused: {error}")

    def at(self, target: str, source: str, stamp: rospy.Time) -> np.ndarray:
        """(4, 4) target_T_source at a time, as tf2 interpolates it; else UnknownFrameError."""
        try:
            return convert.transform(self._buffer.lookup_transform(target, source, stamp))
        except (tf2_ros.TransformException, ValueError) as error:
            raise UnknownFrameError(f"no transform {source} to {target} at that time: {error}") from None

    def fresh(self, target: str, source: str) -> np.ndarray:
        """(4, 4) target_T_source, static or younger than timeout_s; else UnknownFrameError."""
        changes, matrix = self._static.get((target, source), (-1, None))
        if changes == self.changes and matrix is not None:
            return matrix
        changes = self.changes
        try:
            found = self._buffer.lookup_transform(target, source, rospy.Time(0))
        except tf2_ros.TransformException as error:
            raise UnknownFrameError(f"no transform {source} to {target}") from error
        static = found.header.stamp.is_zero()  # every step of the chain is static
        if not static:
            age_s = (rospy.Time.now() - found.header.stamp).to_sec()
            if abs(age_s) > self.timeout_s:  # a stamp from the future is no better
                raise UnknownFrameError(f"transform {source} to {target} is {1e3 * age_s:.0f} ms old")
        try:
            matrix = convert.transform(found)
        except ValueError as error:
            raise UnknownFrameError(f"transform {source} to {target}: {error}") from None
        if static:
            self._static[target, source] = (changes, matrix)
        return matrix
