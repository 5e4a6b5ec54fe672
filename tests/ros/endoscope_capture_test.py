#!/usr/bin/env python3
"""endoscope_capture over the wire, each test with a process of its own."""

from __future__ import annotations

import shutil
import signal
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
import rospy
import rostest
import tf2_ros
import yaml
from crtk_msgs.msg import OperatingState
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import CameraInfo, CompressedImage, Image
from std_msgs.msg import String
from support import ROOT, Newest, pair_of_pictures, spawn, wait_until

from saras.sim.endoscope import stereo_camera
from saras_ros1 import convert
from saras_ros1.camera_images import colours, eye_of

SIDES = ("left", "right")


class Capture(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("endoscope_capture_test")
        cls.folder = Path(tempfile.mkdtemp())
        config = yaml.safe_load((ROOT / "config" / "endoscope.yaml").read_text())
        cls.config, cls.frames_config = config["endoscope_capture"], config["endoscope_frames"]

    @classmethod
    def tearDownClass(cls) -> None:
        shutil.rmtree(cls.folder, ignore_errors=True)

    def setUp(self) -> None:
        self.process = self.frames = None

    def tearDown(self) -> None:
        self.end()
        if self.frames is not None:
            self.frames.send_signal(signal.SIGINT)
            self.frames.communicate(timeout=30)

    def end(self) -> str:
        """Ends the node; what it printed."""
        if self.process is None:
            return ""
        self.process.send_signal(signal.SIGINT)
        try:
            output, _ = self.process.communicate(timeout=30)
        except Exception:
            self.process.kill()
            raise
        self.process = None
        return output

    def capture(self, name: str, **changes: object) -> None:
        """Starts the node as /name, with topics under /name."""
        rospy.set_param(f"/{name}", {**self.config, "topics": f"/{name}", **changes})
        self.images = {side: Newest(f"/{name}/{side}/image_raw", Image) for side in SIDES}
        self.infos = {side: Newest(f"/{name}/{side}/camera_info", CameraInfo) for side in SIDES}
        self.status = {side: Newest(f"/{name}/{side}/status", String) for side in SIDES}
        self.process = spawn("endoscope_capture", f"__name:={name}")

    def place(self, name: str) -> None:
        """Starts endoscope_frames beside /name."""
        rospy.set_param(f"/{name}_frames", {**self.frames_config, "topics": f"/{name}"})
        self.frames = spawn("endoscope_frames", f"__name:={name}_frames")

    def await_status(self, side: str, *words: str) -> None:
        seen = self.status[side]
        wait_until(
            lambda: seen.all and all(word in seen.message.data for word in words),
            lambda: f"{side} status with {words}; last: {seen.message}",
        )

    def pair(self) -> tuple[Image, Image]:
        left, right = (self.images[side] for side in SIDES)
        return pair_of_pictures(left, right, what=lambda: self.status["left"].message)

    def video(self, name: str, levels: list[tuple[int, int]]) -> str:
        """A side by side video whose halves have grey levels of their own."""
        path = self.folder / name
        writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 20.0, (320, 120))
        for left, right in levels:
            writer.write(np.hstack([np.full((120, 160, 3), grey, np.uint8) for grey in (left, right)]))
        writer.release()
        return str(path)

    def test_a_side_by_side_from_the_test_source(self) -> None:
        source = {"source": "test", "device": "ball", "options": ""}
        self.capture("cap_test", left=source, width=640, height=240, rate_hz=20.0)
        left, right = self.pair()
        for message, frame in ((left, "endoscope_left_optical"), (right, "endoscope_right_optical")):
            self.assertEqual((message.width, message.height, message.encoding), (320, 240, "bgr8"))
            self.assertEqual(message.header.frame_id, frame)
        self.assertEqual(self.infos["left"].next().K[0], 0.0)  # not calibrated, and says so
        self.await_status("left", "OK")
        jpeg = Newest("/cap_test/left/image_raw/compressed", CompressedImage)
        message = wait_until(lambda: jpeg.message, "a compressed picture")
        self.assertEqual(cv2.imdecode(np.frombuffer(message.data, np.uint8), 1).shape, (240, 320, 3))

    def test_b_a_video_file_top_to_bottom_and_left_to_right(self) -> None:
        levels = [(30, 200), (60, 170), (90, 140), (120, 230)]
        source = {"source": "file", "device": self.video("pair.avi", levels), "options": ""}
        self.capture("cap_file", left=source, loop=True, swap=True)
        for _ in range(5):
            left, right = (float(colours(message).mean()) for message in self.pair())
            nearest = min(levels, key=lambda pair: abs(pair[1] - left))
            self.assertLess(abs(nearest[1] - left), 6.0)  # swapped: the right half is the left eye
            self.assertLess(abs(nearest[0] - right), 6.0)

    def test_c_two_devices_and_their_calibration_and_place(self) -> None:
        camera = stereo_camera(320, 240)
        for side, eye in zip(SIDES, (camera.left, camera.right)):
            eye.save(self.folder / f"{side}.yaml")
        source = {"source": "test", "device": "ball", "options": ""}
        self.capture(
            "cap_two",
            layout="two_devices",
            left=source,
            right=source,
            width=320,
            height=240,
            rate_hz=15.0,
            skew_s=0.06,
            camera_info={side: str(self.folder / f"{side}.yaml") for side in SIDES},
        )
        self.place("cap_two")
        pose = rospy.Publisher("/ECM/measured_cp", PoseStamped, queue_size=1)
        state = rospy.Publisher("/ECM/operating_state", OperatingState, queue_size=1, latch=True)
        state.publish(OperatingState(state="ENABLED", is_homed=True))
        place = np.eye(4)
        place[:3, 3] = (0.1, 0.2, 0.3)
        timer = rospy.Timer(
            rospy.Duration(0.02), lambda _: pose.publish(convert.pose_msg(place, "ECM", rospy.Time.now()))
        )
        tf = tf2_ros.Buffer()
        tf2_ros.TransformListener(tf)
        self.pair()
        for side, eye in zip(SIDES, (camera.left, camera.right)):
            found = eye_of(self.infos[side].next())
            self.assertTrue(np.allclose(found.P, eye.P) and np.allclose(found.R, eye.R))
        world = wait_until(
            lambda: (
                tf.can_transform("ECM", "endoscope_right_optical", rospy.Time(0))
                and tf.lookup_transform("ECM", "endoscope_right_optical", rospy.Time(0))
            ),
            "the right eye under the arm",
        )
        timer.shutdown()
        mount = np.diag([-1.0, -1.0, 1.0, 1.0])
        mount[0, 3] = 0.0026
        expected = place @ mount @ np.linalg.inv(camera.right_T_left)
        self.assertTrue(np.allclose(convert.transform(world), expected, atol=1e-6))

    def test_d_another_size_than_the_calibrated_one_is_not_calibrated(self) -> None:
        stereo_camera(640, 480).left.save(self.folder / "large.yaml")
        source = {"source": "test", "device": "ball", "options": ""}
        files = {"left": str(self.folder / "large.yaml"), "right": ""}
        self.capture("cap_size", left=source, width=320, height=120, rate_hz=20.0, camera_info=files)
        info = self.infos["left"].next()
        self.assertEqual((info.K[0], info.width, info.height), (0.0, 160, 120))
        diagnostics = Newest("/diagnostics", DiagnosticArray)
        wait_until(
            lambda: any(
                "calibrated 640x480" in status.message
                for array in diagnostics.all
                for status in array.status
                if status.name == "/cap_size"
            ),
            "diagnostics that say so",
        )

    def test_e_a_frozen_camera_is_said_and_not_repeated(self) -> None:
        levels = [(40 * (i % 5), 200 - 30 * (i % 6)) for i in range(30)] + [(70, 70)] * 400
        source = {"source": "file", "device": self.video("freeze.avi", levels), "options": ""}
        self.capture("cap_frozen", left=source)
        self.await_status("left", "OK")
        self.await_status("right", "FROZEN")
        self.await_status("left", "FROZEN")
        for image in self.images.values():
            image.clear()
        rospy.sleep(1.0)
        self.assertFalse(any(image.all for image in self.images.values()))  # old data gets no new stamp

    def test_f_a_lost_camera_is_named_and_comes_back(self) -> None:
        path = self.folder / "later.avi"
        self.capture("cap_lost", left={"source": "file", "device": str(path), "options": ""}, loop=True, retry_s=0.2)
        self.await_status("left", "LOST", "endoscope")
        self.await_status("right", "LOST")
        made = self.video("made.avi", [(20 * i, 240 - 20 * i) for i in range(12)])
        Path(made).rename(path)
        self.pair()
        self.await_status("left", "OK")

    def test_g_wrong_parameters_refuse_the_start_by_name(self) -> None:
        for changes, words in (
            ({"left": {"source": "webcam", "device": "0", "options": ""}}, "/cap_bad/left/source"),
            ({"camera_info": {"left": "left.yaml", "right": ""}}, "camera_info/left"),
            ({"camera_info": {"left": str(self.folder / "none.yaml"), "right": ""}}, "none.yaml"),
            ({"frozen_s": -1.0}, "frozen_s"),
            ({"frozne_s": 0.2}, "frozne_s: unknown"),
            ({"left": {"source": "test", "device": "", "options": "", "optoins": ""}}, "left/optoins: unknown"),
            ({"left": {"source": "decklink", "device": "front", "options": ""}}, "/cap_bad/left: device = 'front'"),
            ({"camera_info": {"left": str(ROOT / "config" / "endoscope.yaml"), "right": ""}}, "no camera_info in it"),
            ({"width": 640}, "height"),
        ):
            self.capture("cap_bad", **changes)
            output, _ = self.process.communicate(timeout=60)
            self.assertEqual(self.process.returncode, 2, output)
            self.assertIn(words, output)
            self.process = None

    def test_h_devices_out_of_step_keep_their_own_stamps(self) -> None:
        source = {"source": "test", "device": "ball", "options": ""}
        two = {"layout": "two_devices", "left": source, "right": source, "width": 64, "height": 48, "rate_hz": 20.0}
        self.capture("cap_apart", **two, skew_s=0.0)
        wait_until(lambda: all(len(self.images[side].all) >= 10 for side in SIDES), "pictures of both")
        stamps = [{message.header.stamp.to_nsec() for message in self.images[side].all} for side in SIDES]
        self.assertFalse(stamps[0] & stamps[1])
        for side in SIDES:
            self.await_status(side, "OK")
            in_order = [message.header.stamp for message in self.images[side].all]
            self.assertEqual(in_order, sorted(in_order))

    def test_i_a_late_picture_has_the_place_of_its_own_time(self) -> None:
        """The arm moves at 0.2 m/s: in the second by which the device delays its pictures, 0.2 m."""
        source = {"source": "test", "device": "ball", "options": ""}
        self.capture("cap_late", left=source, width=64, height=24, rate_hz=10.0, latency_s=1.0)
        self.place("cap_late")
        pose = rospy.Publisher("/ECM/measured_cp", PoseStamped, queue_size=1)
        state = rospy.Publisher("/ECM/operating_state", OperatingState, queue_size=1, latch=True)
        state.publish(OperatingState(state="ENABLED", is_homed=True))
        begin = rospy.Time.now()

        def at(time: rospy.Time) -> float:
            return 0.2 * (time - begin).to_sec()

        def send(_: object) -> None:
            now, place = rospy.Time.now(), np.eye(4)
            place[1, 3] = at(now)
            pose.publish(convert.pose_msg(place, "ECM", now))

        timer = rospy.Timer(rospy.Duration(0.02), send)
        tf = tf2_ros.Buffer()
        tf2_ros.TransformListener(tf)
        off: list[float] = []

        def near() -> bool:
            stamp = self.images["left"].next().header.stamp
            if at(stamp) > 0.2 and tf.can_transform("ECM", "endoscope_left_optical", stamp):
                found = tf.lookup_transform("ECM", "endoscope_left_optical", stamp)
                off.append(abs(found.transform.translation.y - at(stamp)))
            return len(off) >= 10

        wait_until(near, lambda: f"transforms for the pictures; {off}")
        timer.shutdown()
        self.assertLess(np.median(off), 0.04, off)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "endoscope_capture", Capture)
