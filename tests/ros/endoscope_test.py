#!/usr/bin/env python3
"""The simulated endoscope over the wire: pictures, camera_info, tf and truth fit each other."""

from __future__ import annotations

import contextlib
import threading
import time
import unittest

import cv2
import numpy as np
import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped, PoseStamped
from saras_ros1.msg import Contact, ContactQuality
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from support import ROOT, Newest, pair_of_pictures, wait_until

from saras.calibration.camera_info import right_T_left
from saras.kinematics import scene
from saras.sim.endoscope import Label, stereo_camera
from saras_ros1 import convert
from saras_ros1.camera_images import colours, eye_of

PATIENT_S = 90.0  # pictures are drawn without a graphics card
LEFT = "endoscope_left_optical"


class LeftArm:
    """A SARAS arm that publishes its pose at 50 Hz while `tip` (3,) in world is set."""

    def __init__(self, place: scene.Scene) -> None:
        self.tip: np.ndarray | None = None
        self._base_T_world = np.linalg.inv(place.world_T("mesa_left/sbs_world"))
        self._pose = rospy.Publisher("/mesa_left/ee_pose", PoseStamped, queue_size=5)
        self._rcm = rospy.Publisher("/mesa_left/rcm", PointStamped, queue_size=1, latch=True)
        trocar = PointStamped()
        trocar.header.frame_id = "mesa_left/sbs_world"
        trocar.point.x, trocar.point.y, trocar.point.z = place.arms["mesa_left"].rcm
        self._rcm.publish(trocar)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            if self.tip is not None:
                pose = self._base_T_world.copy()
                pose[:3, :3] = pose[:3, :3] @ np.diag([1.0, -1.0, -1.0])
                pose[:3, 3] = (self._base_T_world @ [*self.tip, 1.0])[:3]
                with contextlib.suppress(rospy.ROSException):
                    self._pose.publish(convert.pose_msg(pose, "mesa_left/sbs_world", rospy.Time.now()))
            time.sleep(0.02)


class Endoscope(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("endoscope_test")
        cls.tf = tf2_ros.Buffer(rospy.Duration(60.0))
        cls.listener = tf2_ros.TransformListener(cls.tf)
        cls.scene = scene.load(ROOT / "config" / "scene.yaml")
        cls.images = {side: Newest(f"/endoscope/{side}/image_raw", Image) for side in ("left", "right")}
        cls.infos = {side: Newest(f"/endoscope/{side}/camera_info", CameraInfo) for side in ("left", "right")}
        cls.arm = LeftArm(cls.scene)
        cls.contact = {side: Newest(f"/contact/{side}", Contact) for side in ("left", "right")}
        cls.quality = {side: Newest(f"/contact/{side}/quality", ContactQuality) for side in ("left", "right")}
        for image in cls.images.values():
            wait_until(lambda image=image: image.all, image.topic, PATIENT_S)

    def pair(self) -> tuple[Image, Image]:
        """Both pictures of one moment, from now on."""
        return pair_of_pictures(self.images["left"], self.images["right"], PATIENT_S)

    def test_a_pictures_are_whole_and_of_one_moment(self) -> None:
        left, right = self.pair()
        for message, name in ((left, LEFT), (right, "endoscope_right_optical")):
            self.assertEqual((message.width, message.height, message.encoding), (640, 480, "bgr8"))
            self.assertEqual(message.header.frame_id, name)
            self.assertGreater(colours(message).std(), 20.0)  # not one colour
        self.assertGreater(np.abs(colours(left).astype(int) - colours(right)).mean(), 3.0)

    def test_b_camera_info_is_the_cameras(self) -> None:
        camera = stereo_camera()
        eyes = {side: eye_of(info.next()) for side, info in self.infos.items()}
        for side, eye in (("left", camera.left), ("right", camera.right)):
            self.assertTrue(np.allclose(eyes[side].intrinsics.matrix, eye.intrinsics.matrix))
            self.assertTrue(np.allclose(eyes[side].P, eye.P))
        self.assertTrue(np.allclose(right_T_left(eyes["left"], eyes["right"]), camera.right_T_left, atol=1e-9))
        found = self.tf.lookup_transform(LEFT, "endoscope_right_optical", rospy.Time(0), rospy.Duration(10.0))
        self.assertTrue(np.allclose(convert.transform(found), np.linalg.inv(camera.right_T_left), atol=1e-9))

    def test_c_tf_and_truth_agree_with_the_scene(self) -> None:
        depth, labels = Newest("/endoscope/left/truth/depth", Image), Newest("/endoscope/left/truth/labels", Image)
        wait_until(lambda: depth.all and labels.all, "truth", PATIENT_S)

        def both() -> tuple[Image, Image] | None:
            by_stamp = {m.header.stamp: m for m in labels.all}
            same = [(m, by_stamp[m.header.stamp]) for m in depth.all if m.header.stamp in by_stamp]
            return same[-1] if same else None

        depth_message, label_message = wait_until(both, "depth and labels of one moment", PATIENT_S)
        depth.subscriber.unregister(), labels.subscriber.unregister()
        distance = np.frombuffer(depth_message.data, np.float32).reshape(480, 640)
        label = np.frombuffer(label_message.data, np.uint8).reshape(480, 640)
        self.assertTrue({Label.TISSUE, Label.TOOL} <= set(np.unique(label)))
        found = self.tf.lookup_transform("world", LEFT, depth_message.header.stamp, rospy.Duration(10.0))
        world_T_left = convert.transform(found)
        eye = stereo_camera().left.intrinsics
        v, u = np.nonzero(label == Label.TISSUE)
        pixels = np.column_stack([u, v]).astype(float)[::97, None]
        rays = cv2.undistortPointsIter(pixels, eye.matrix, eye.distortion, None, None, (3, 40, 1e-10)).reshape(-1, 2)
        at = pixels.reshape(-1, 2).astype(int)
        points = np.column_stack([rays, np.ones(len(rays))]) * distance[at[:, 1], at[:, 0]][:, None]
        world = points @ world_T_left[:3, :3].T + world_T_left[:3, 3]
        phantom = self.scene.phantom
        over = (np.abs(world[:, :2] - phantom.center[:2]) < 0.5 * phantom.size[:2]).all(axis=1)
        self.assertGreater(over.sum(), 100)
        top = phantom.center[2] + 0.5 * phantom.size[2]
        # Beside a tool's edge a pixel's depth is its neighbour's.
        self.assertLess(np.percentile(np.abs(world[over, 2] - top), 98), 1e-4)

    def test_d_an_arm_that_comes_in_is_seen_and_dents(self) -> None:
        before = self.dented()
        self.assertLess(np.abs(before), 5e-4)
        self.arm.tip = np.array([-0.02, 0.0, 0.124])  # 6 mm under the phantom's face
        wait_until(lambda: self.dented() > 1e-3, "a dent where the tip presses", PATIENT_S)

    def dented(self) -> float:
        """How far the tissue lies under the phantom's face, beside the tip, as the truth's depth says [m]."""
        depth = Newest("/endoscope/left/truth/depth", Image)
        message = wait_until(lambda: depth.all and depth.all[-1], "depth", PATIENT_S)
        depth.subscriber.unregister()
        found = self.tf.lookup_transform("world", LEFT, message.header.stamp, rospy.Duration(10.0))
        world_T_left = convert.transform(found)
        point = np.array([-0.02 + 0.005, 0.0, 0.13])  # on the camera's side of the tool
        eye = stereo_camera().left.intrinsics
        local = np.linalg.inv(world_T_left) @ [*point, 1.0]
        pixel, _ = cv2.projectPoints(local[None, :3], np.zeros(3), np.zeros(3), eye.matrix, eye.distortion)
        u, v = np.round(pixel.ravel()).astype(int)
        distance = np.frombuffer(message.data, np.float32).reshape(480, 640)[v, u]
        seen = world_T_left[:3, :3] @ (local[:3] * (distance / local[2])) + world_T_left[:3, 3]
        return float(0.13 - seen[2])

    def test_e_compressed_pictures_and_diagnostics(self) -> None:
        jpeg = Newest("/endoscope/right/image_raw/compressed", CompressedImage)
        message = wait_until(lambda: jpeg.message, "a compressed picture", PATIENT_S)
        picture = cv2.imdecode(np.frombuffer(message.data, np.uint8), cv2.IMREAD_COLOR)
        self.assertEqual(picture.shape, (480, 640, 3))
        diagnostics = Newest("/diagnostics", DiagnosticArray)

        def values() -> dict[str, str] | None:
            for array in diagnostics.all:
                for status in array.status:
                    if status.name == "/endoscope_sim":
                        found = {value.key: value.value for value in status.values}
                        if float(found["rate_hz"]) > 0.0:
                            return found
            return None

        found = wait_until(values, "diagnostics of endoscope_sim with a rate", PATIENT_S)
        self.assertEqual(found["size"], "640x480")
        self.assertAlmostEqual(
            float(found["shortfall_hz"]), max(0.0, float(found["wanted_hz"]) - float(found["rate_hz"])), delta=0.11
        )

    def await_contact(self, low_m: float, high_m: float) -> Contact:
        """A contact of the left arm within these depths."""
        seen = self.contact["left"]
        seen.clear()
        return wait_until(
            lambda: next((m for m in seen.all if low_m < m.depth < high_m), None),
            lambda: f"a depth in ({low_m}, {high_m}); last: {seen.message}, {self.quality['left'].message}",
            PATIENT_S,
        )

    def test_f_a_contact_is_seen_with_its_depth_and_direction(self) -> None:
        up = np.linalg.inv(self.scene.world_T("mesa_left/sbs_world"))[:3, 2]
        for height in (0.136, 0.126, 0.1225, 0.14):
            self.arm.tip = np.array([-0.02, 0.0, height])
            message = self.await_contact(0.13 - height - 1e-3, 0.13 - height + 1e-3)
            self.assertEqual(message.header.frame_id, "mesa_left/sbs_world")
            normal = np.array([message.direction.x, message.direction.y, message.direction.z])
            self.assertGreater(normal @ up, np.cos(np.radians(12.0)))
            self.assertAlmostEqual(np.linalg.norm(normal), 1.0, places=6)
        wait_until(lambda: any(q.reason == "" and q.confidence > 0.5 for q in self.quality["left"].all), "confidence")

    def unknown(self, side: str, *words: str) -> None:
        """Contact and quality say unknown, with a reason that has the words."""
        quality, contact = self.quality[side], self.contact[side]
        quality.clear(), contact.clear()
        found = wait_until(
            lambda: next((q for q in quality.all if all(word in q.reason for word in words)), None),
            lambda: f"a reason with {words}; last: {quality.message}",
            PATIENT_S,
        )
        self.assertEqual(found.confidence, 0.0)
        message = wait_until(
            lambda: next((m for m in contact.all if m.header.stamp == found.header.stamp), None), "its contact"
        )
        self.assertTrue(np.isnan(message.depth))
        self.assertEqual((message.direction.x, message.direction.y, message.direction.z), (0.0, 0.0, 0.0))

    def test_g_what_is_not_known_is_said(self) -> None:
        self.unknown("right", "no pose on /mesa_right/ee_pose")
        self.arm.tip = np.array([0.116, 0.0, 0.26])
        self.unknown("left", "behind")
        self.arm.tip = None
        self.unknown("left", "no pose on /mesa_left/ee_pose within")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "endoscope", Endoscope)
