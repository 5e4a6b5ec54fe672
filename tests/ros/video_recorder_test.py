#!/usr/bin/env python3
"""Videos beside the bag: exactly the pictures that were published, each with its stamp in bag and index."""

from __future__ import annotations

import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag
import rospy
import rostest
from saras_ros1.msg import RecorderState
from saras_ros1.srv import StartRecording
from sensor_msgs.msg import Image
from std_srvs.srv import Trigger
from support import Newest, frames_in, wait_until

from saras.capture.video_file import read_index
from saras_ros1.camera_images import image_msg

SIDES, SIZE, BITS = ("left", "right"), (320, 240), 12


class VideoRecorder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("video_recorder_test")
        cls.state = Newest("/recorder/state", RecorderState)
        cls.images = {s: rospy.Publisher(f"/endoscope/{s}/image_raw", Image, queue_size=50) for s in SIDES}
        cls.number = 0
        cls.stamps = {}
        cls.speaking = True
        threading.Thread(target=cls.speak, daemon=True).start()
        rospy.wait_for_service("/recorder/start", 60.0)
        wait_until(lambda: all(image.get_num_connections() for image in cls.images.values()), "video_recorder listens")

    @classmethod
    def speak(cls):
        while not rospy.core.is_shutdown_requested():
            time.sleep(0.05)
            if not cls.speaking:
                continue
            cls.number += 1
            pixels = np.full((SIZE[1], SIZE[0], 3), 90, np.uint8)
            width = SIZE[0] // BITS
            for bit in range(BITS):
                pixels[20:120, bit * width : (bit + 1) * width] = 230 if cls.number >> bit & 1 else 10
            stamp = cls.stamps[cls.number] = rospy.Time.now()
            for side, image in cls.images.items():
                image.publish(image_msg(pixels, "bgr8", f"endoscope_{side}_optical", stamp))

    @staticmethod
    def shown(path):
        video, found = cv2.VideoCapture(str(path)), []
        while True:
            good, pixels = video.read()
            if not good:
                return found
            width = SIZE[0] // BITS
            grey = [pixels[70, bit * width + width // 2].mean() for bit in range(BITS)]
            found.append(sum(1 << bit for bit, value in enumerate(grey) if value > 120))

    def record(self, path, seconds):
        answer = rospy.ServiceProxy("/recorder/start", StartRecording)(str(path))
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: path.with_name(path.stem + "_left.mkv").exists(), "the left video")
        rospy.sleep(seconds)
        self.assertTrue(rospy.ServiceProxy("/recorder/stop", Trigger)().success)
        rospy.sleep(1.0)  # the videos are closed

    def test_0_pairs_for_a_calibration_are_saved(self):
        out = Path(tempfile.mkdtemp()) / "views"
        command = ["rosrun", "saras_ros1", "save_views", "--out", str(out), "--count", "3", "--every-s", "0.1"]
        done = subprocess.run(command, text=True, capture_output=True, check=False, timeout=60.0)
        self.assertEqual(done.returncode, 0, done.stderr)
        for number in range(3):
            left, right = (cv2.imread(str(out / side / f"{number:03d}.png"), cv2.IMREAD_GRAYSCALE) for side in SIDES)
            np.testing.assert_array_equal(left, right)
        self.assertEqual(subprocess.run(command, capture_output=True, check=False, timeout=60.0).returncode, 2)

    def test_1_every_picture_is_there_with_its_stamp(self):
        path = Path(tempfile.mkdtemp()) / "session.bag"
        self.record(path, 4.0)
        for side in SIDES:
            video = path.with_name(f"session_{side}.mkv")
            numbers, index = self.shown(video), read_index(video)
            self.assertGreater(len(numbers), 30)
            self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))), "one after the other, all")
            self.assertEqual([self.stamps[n].to_nsec() for n in numbers], index[:, 1].tolist())
            with rosbag.Bag(str(path)) as bag:
                frames = [m for _, m, _ in bag.read_messages([f"/recorder/video/{side}"])]
            self.assertTrue(frames)
            for frame in frames:
                self.assertEqual(frame.file, video.name)
                self.assertEqual(frame.header.stamp.to_nsec(), index[frame.frame, 1])
            named = [frame.frame for frame in frames]  # the bag's recorder subscribes a little later
            self.assertEqual(named, list(range(named[0], named[0] + len(named))), "one after the other, all")

    def test_2_the_next_recording_has_its_own_videos(self):
        path = Path(tempfile.mkdtemp()) / "second.bag"
        self.record(path, 1.0)
        self.assertGreater(len(self.shown(path.with_name("second_right.mkv"))), 5)

    def test_3_a_video_is_closed_when_no_picture_comes_any_more(self):
        path = Path(tempfile.mkdtemp()) / "third.bag"
        answer = rospy.ServiceProxy("/recorder/start", StartRecording)(str(path))
        self.assertTrue(answer.success, answer.message)
        video = path.with_name("third_left.mkv")
        wait_until(lambda: frames_in(video) > 10, "pictures in the video")
        type(self).speaking = False
        rospy.sleep(0.5)
        self.assertTrue(rospy.ServiceProxy("/recorder/stop", Trigger)().success)
        wait_until(lambda: len(self.shown(video)) == len(read_index(video)), "the finished video")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "video_recorder", VideoRecorder)
