"""Where the endoscope's eyes are: from the arm that carries it and how it sits on the arm, in tf."""

from __future__ import annotations

import numpy as np
import rospy
import tf2_ros

from saras import ConfigError
from saras.calibration.calibration_file import Calibration
from saras.kinematics.scene import pose_from_xyz_rpy
from saras_ros1 import convert
from saras_ros1.dvrk_inputs import DvrkArmInput
from saras_ros1.node import Node
from saras_ros1.params import Params

LEFT, RIGHT = "endoscope_left_optical", "endoscope_right_optical"
OPTICAL = {"left": LEFT, "right": RIGHT}


class EndoscopeFrames:
    """Publishes `LEFT` under the frame of the arm's pose with each picture, and `RIGHT` under it once.

    Both are those of the raw pictures. An arm whose pose is not fresh gives no transform: readers see its age.
    """

    def __init__(self, node: Node, params: Params) -> None:
        """params: the section `mount`. Raises ConfigError."""
        name = params.text("arm")
        xyz, rpy = params.vector("xyz_m", 3, -1.0, 1.0), params.vector("rpy_rad", 3, -2.0 * np.pi, 2.0 * np.pi)
        self.tip_T_left = pose_from_xyz_rpy(xyz, rpy)
        file = params.text("hand_eye_file", empty=True)
        timeout_s = params.number("timeout_s", 0.005, 2.0)
        params.finish()
        if file:
            try:
                self.tip_T_left = Calibration.load(file).gripper_T_camera[name]
            except OSError as error:
                raise ConfigError(f"{node.name}/mount/hand_eye_file: {error}") from None
            except KeyError:
                raise ConfigError(f"{file}: gripper_T_camera/{name}: missing: no hand-eye calibration in it") from None
        self.arm = DvrkArmInput(node, name, timeout_s=timeout_s)
        self._tf = tf2_ros.TransformBroadcaster()
        self._static = tf2_ros.StaticTransformBroadcaster()

    def place_right(self, right_T_left: np.ndarray) -> None:
        """right_T_left: (4, 4) of the raw optical frames."""
        left_T_right = np.linalg.inv(right_T_left)
        self._static.sendTransform(convert.transform_msg(left_T_right, LEFT, RIGHT, rospy.Time.now()))

    def last(self) -> tuple[str, np.ndarray] | None:
        """Frame and frame_T_left (4, 4) by the newest pose, however old; None: there was none."""
        try:
            frame, pose = self.arm.frame_id, self.arm.pose
        except ValueError:
            return None
        return (frame, pose @ self.tip_T_left) if frame else None

    def publish(self, stamp: rospy.Time) -> None:
        """The transform of a picture taken at stamp; nothing when the arm's pose is not fresh."""
        found = self.last() if self.arm.fresh else None
        if found is not None:
            self._tf.sendTransform(convert.transform_msg(found[1], found[0], LEFT, stamp))
