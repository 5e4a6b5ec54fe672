"""What a calibration reads of one arm: the poses of a moment, and the joints under its base."""

from __future__ import annotations

import time
from collections import deque

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState

from saras import CalibrationError
from saras_ros1 import convert

LEAST_POSES = 3


class ArmReadings:
    """Subscribes to an arm's poses, and to the joints of its positioning arm or set-up joints where it has any."""

    def __init__(self, name: str, frame: str, pose_topic: str, joints_topic: str, joint_names: list[str]) -> None:
        self.name, self.frame, self.joint_names = name, frame, joint_names
        self.poses: deque[tuple[float, np.ndarray]] = deque(maxlen=2000)
        self.joints: dict[str, float] = {}
        self._read = convert.in_frame(frame, convert.pose)
        rospy.Subscriber(pose_topic, PoseStamped, self._on_pose, queue_size=20, tcp_nodelay=True)
        if joint_names:
            rospy.Subscriber(joints_topic, JointState, self._on_joints, queue_size=1, tcp_nodelay=True)

    def _on_pose(self, message: PoseStamped) -> None:
        try:
            self.poses.append((time.monotonic(), self._read(message)))
        except ValueError as error:
            rospy.logwarn_throttle(5.0, f"{self.name}: pose refused: {error}")

    def _on_joints(self, message: JointState) -> None:
        now = dict(zip(message.name, message.position))
        if all(name in now for name in self.joint_names):
            self.joints = {name: now[name] for name in self.joint_names}

    def over(self, seconds: float) -> np.ndarray:
        """(n, 4, 4) poses of the next so many seconds. Raises CalibrationError when the arm is silent."""
        start = time.monotonic()
        time.sleep(seconds)
        poses = [pose for at, pose in list(self.poses) if at >= start]
        if len(poses) < LEAST_POSES:
            raise CalibrationError(
                f"{self.name}: {len(poses)} poses in {seconds:g} s: must be >= {LEAST_POSES}; is the arm on?"
            )
        return np.array(poses)

    def under_base(self) -> dict[str, float] | None:
        """Joints under the base; None when this arm has none that are read."""
        if self.joint_names and not self.joints:
            raise CalibrationError(f"{self.name}: its positioning joints were not read yet")
        return dict(self.joints) or None
