#!/usr/bin/env python3
"""Hand-eye calibration over the wire: rendered pictures of the board, an arm that stands still or does not."""

from __future__ import annotations

import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from saras_ros1.srv import SaveCalibration
from sensor_msgs.msg import CameraInfo, Image
from std_srvs.srv import Trigger
from support import ROOT, wait_until

import saras
from saras.calibration.calibration_file import Calibration
from saras.calibration.simulated import SimulatedRoom
from saras.kinematics import scene
from saras_ros1 import convert

NODE = "/hand_eye_calibration"


class HandEye(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("hand_eye_test")
        cls.room = SimulatedRoom(scene.load(ROOT / "config" / "scene.yaml"))
        cls.picture = np.full((480, 640), 128, np.uint8)
        cls.gripper, cls.drift_m = np.eye(4), 0.0
        cls.pose = rospy.Publisher("/ECM/local/measured_cp", PoseStamped, queue_size=1)
        cls.image = rospy.Publisher("/endoscope/left/image_raw", Image, queue_size=1)
        cls.info = rospy.Publisher("/endoscope/left/camera_info", CameraInfo, queue_size=1)
        cls.marked: list[Image] = []
        threading.Thread(target=cls.speak, daemon=True).start()
        for name in ("take", "undo", "compute", "save", "status"):
            rospy.wait_for_service(f"{NODE}/{name}", 60.0)

    @classmethod
    def speak(cls) -> None:
        camera, ticks = cls.room.intrinsics, 0
        info = CameraInfo(height=camera.height, width=camera.width, distortion_model="plumb_bob")
        info.K, info.D = camera.matrix.ravel().tolist(), camera.distortion.ravel().tolist()
        while not rospy.core.is_shutdown_requested():
            ticks += 1
            pose = cls.gripper.copy()
            pose[0, 3] += cls.drift_m * (ticks % 20)
            cls.pose.publish(convert.pose_msg(pose, "ECM", rospy.Time.now().to_nsec()))
            if ticks % 5 == 0:
                height, width = cls.picture.shape
                image = Image(height=height, width=width, step=width, encoding="mono8", data=cls.picture.tobytes())
                image.header.stamp = info.header.stamp = rospy.Time.now()
                cls.image.publish(image)
                cls.info.publish(info)
            rospy.rostime.wallsleep(0.02)

    def call(self, name: str):
        return rospy.ServiceProxy(f"{NODE}/{name}", Trigger)()

    def go_to(self, view: int) -> None:
        kind = type(self)
        kind.picture = self.room.image(view)
        kind.gripper = self.room.see(view)[0]
        rospy.sleep(0.6)  # the old picture is gone

    def test_1_what_is_refused(self) -> None:
        self.assertIn("views = 0", self.call("compute").message)
        self.assertIn(
            "nothing computed", rospy.ServiceProxy(f"{NODE}/save", SaveCalibration)("/tmp/x.yaml", False).message
        )
        self.assertIn("nothing to undo", self.call("undo").message)
        wait_until(lambda: "blurred view" in self.call("take").message, "a refusal of an empty picture")
        self.go_to(0)
        type(self).drift_m = 0.001
        rospy.sleep(0.2)
        self.assertIn("hold still", self.call("take").message)
        type(self).drift_m = 0.0
        rospy.sleep(0.6)

    def test_2_take_undo_compute_save(self) -> None:
        for view in range(min(14, self.room.views)):
            self.go_to(view)
            answer = self.call("take")
            self.assertTrue(answer.success, answer.message)
        self.assertFalse(self.call("take").success, "the same pose twice")
        self.assertTrue(self.call("undo").success)
        self.assertTrue(self.call("take").success)
        answer = self.call("compute")
        self.assertTrue(answer.success, answer.message)
        self.assertIn("camera known to", answer.message)
        path = str(Path(tempfile.mkdtemp()) / "hand_eye.yaml")
        save = rospy.ServiceProxy(f"{NODE}/save", SaveCalibration)
        self.assertTrue(save(path, False).success)
        self.assertIn("exists", save(path, False).message)
        found = Calibration.load(path, board_hash=self.room.board.hash).gripper_T_camera["ECM"]
        off = saras.displacement(found, self.room.gripper_T_camera)
        self.assertLess(np.linalg.norm(off[:3]), 2e-3)
        self.assertLess(np.rad2deg(np.linalg.norm(off[3:])), 0.5)

    def test_3_the_live_picture_shows_the_markers(self) -> None:
        self.go_to(2)
        rospy.Subscriber(f"{NODE}/image_markers", Image, self.marked.append, queue_size=1)
        wait_until(lambda: len(self.marked) > 2, "marked images")
        shown = self.marked[-1]
        self.assertEqual((shown.height, shown.width, shown.encoding), (480, 640, "bgr8"))
        pixels = np.frombuffer(shown.data, np.uint8).reshape(480, 640, 3).astype(int)
        green = (pixels[:, :, 1] - pixels[:, :, 2] > 60) & (pixels[:, :, 1] - pixels[:, :, 0] > 60)
        self.assertGreater(green.sum(), 500, "outlines of four markers")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "hand_eye", HandEye)
