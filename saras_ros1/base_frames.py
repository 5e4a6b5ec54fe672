"""Calibrated base frames, and whether they still hold: a positioning or set-up joint that moved makes one unknown."""

from __future__ import annotations

import math

import numpy as np
import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import JointState

from saras.calibration.calibration_file import BaseFrame, Calibration
from saras.calibration.registration import JOINT_TOLERANCE_RAD
from saras_ros1 import convert

#: Where the joints under a base frame are told.
JOINT_TOPICS = {
    "mesa_left/sbs_world": "/mesa_left/joint_states",
    "mesa_right/sbs_world": "/mesa_right/joint_states",
    "PSM1": "/SUJ/PSM1/measured_js",
    "PSM2": "/SUJ/PSM2/measured_js",
    "ECM": "/SUJ/ECM/measured_js",
}
#: Parent of a frame that is unknown. tf2 keeps a static transform for ever and refuses NaN, but it takes a new parent:
#: from then on nobody, in any language, finds a way from world to the frame.
UNKNOWN = "unknown"


class CalibratedFrame:
    """One frame of a calibration. Unknown until its joints are read, and from the moment on that they have moved."""

    def __init__(self, name: str, frame: BaseFrame) -> None:
        self.name, self.frame = name, frame
        self.reason = "" if not frame.joints_rad else f"joints not read yet on {JOINT_TOPICS.get(name, 'any topic')}"

    @property
    def known(self) -> bool:
        """Whether the frame may be used."""
        return not self.reason

    def on_joints(self, names: list[str], positions: list[float]) -> bool:
        """A reading; True when what is known has changed. Movement is latched: only a new calibration ends it."""
        if self.reason.startswith("moved"):
            return False
        now = dict(zip(names, positions))
        worst, by = "", 0.0
        for joint, then in self.frame.joints_rad.items():
            if joint not in now:
                return False  # a message of other joints
            off = abs(now[joint] - then)
            if not math.isfinite(off) or off > by:
                worst, by = joint, off
        before = self.reason
        moved = not by <= JOINT_TOLERANCE_RAD
        self.reason = f"moved: {worst} by {np.rad2deg(by):.2f} deg since the calibration" if moved else ""
        return self.reason != before

    def transform(self, stamp: rospy.Time) -> TransformStamped:
        """To publish: the calibrated place, or the unknown one."""
        if self.known:
            return convert.transform_msg(self.frame.parent_T_frame, self.frame.parent, self.name, stamp)
        return convert.transform_msg(np.eye(4), f"{UNKNOWN}/{self.name}", self.name, stamp)


class CalibratedFrames:
    """All frames of one calibration; calls back when one of them becomes known or unknown."""

    def __init__(self, calibration: Calibration, on_change) -> None:
        self.frames = {name: CalibratedFrame(name, frame) for name, frame in calibration.frames.items()}
        self._on_change = on_change
        self._subscribers = [
            rospy.Subscriber(JOINT_TOPICS[name], JointState, self._on_joints, callback_args=name, queue_size=1)
            for name, frame in self.frames.items()
            if frame.frame.joints_rad and name in JOINT_TOPICS
        ]

    def close(self) -> None:
        """Listens no longer."""
        for subscriber in self._subscribers:
            subscriber.unregister()

    def _on_joints(self, message: JointState, name: str) -> None:
        frame = self.frames[name]
        if frame.on_joints(list(message.name), list(message.position)):
            self._on_change(frame)
