#!/usr/bin/env python3
"""A bag that is played has its pictures and its sound in step: the frame that it names, with its own stamp."""

from __future__ import annotations

import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosbag
import rospy
import rostest
from saras_ros1.msg import AudioChunk, VideoFrame
from sensor_msgs.msg import Image
from support import Newest, spawn, wait_until

from saras.capture.video_file import VideoFile

SIDES, SIZE, BITS, FRAMES, RATE_HZ = ("left", "right"), (320, 240), 8, 60, 16000
BEGIN_NS = 1_700_000_000_000_000_000


def picture(number: int) -> np.ndarray:
    """Its number in blocks of black and white, which no codec spoils."""
    pixels, width = np.full((SIZE[1], SIZE[0], 3), 90, np.uint8), SIZE[0] // BITS
    for bit in range(BITS):
        pixels[20:120, bit * width : (bit + 1) * width] = 230 if number >> bit & 1 else 10
    return pixels


def number_in(message: Image) -> int:
    pixels = np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, 3)
    width = SIZE[0] // BITS
    return sum(1 << bit for bit in range(BITS) if pixels[70, bit * width + width // 2].mean() > 120)


def shown(images: Newest) -> list[int]:
    return [number_in(message) for message in list(images.all)]


class ReplayMedia(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("replay_media_test")
        cls.folder = Path(tempfile.mkdtemp())
        cls.bag = cls.folder / "s.bag"
        videos = {side: VideoFile(cls.folder / f"s_{side}.mkv", SIZE, 15.0) for side in SIDES}
        with rosbag.Bag(str(cls.bag), "w") as bag:
            for k in range(FRAMES):
                stamp = rospy.Time.from_seconds(1_700_000_000) + rospy.Duration(nsecs=k * 66_000_000)
                for side in SIDES:
                    frame = VideoFrame(frame=k, file=f"s_{side}.mkv")
                    frame.header.stamp, frame.header.frame_id = stamp, f"endoscope_{side}_optical"
                    videos[side].write(picture(k), stamp.to_nsec())
                    if k % 7 != 3:  # the bag need not name every one
                        bag.write(f"/recorder/video/{side}", frame, stamp)
                chunk = AudioChunk(first=1056 * k, rate=RATE_HZ, channels=1, samples=[k + 1] * 1056)
                chunk.header.stamp = stamp
                bag.write("/audio", chunk, stamp)
        for video in videos.values():
            video.close()

    def replay(self, sink: str, **changes) -> subprocess.Popen:
        rospy.set_param(
            "/replay_media", {"directory": str(self.folder), "topics": "/endoscope", "sink": sink, **changes}
        )
        return spawn("replay_media")

    def play(self) -> None:
        quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        command = ["rosbag", "play", "--quiet", "--delay=2", "--wait-for-subscribers", str(self.bag)]
        self.assertEqual(subprocess.run(command, check=False, timeout=120.0, **quiet).returncode, 0)

    def test_1_pictures_and_sound_are_the_ones_that_were_recorded(self):
        heard = self.folder / "heard.raw"
        node = self.replay(f"audio/x-raw,format=S16LE,rate={RATE_HZ},channels=1 ! filesink location={heard}")
        self.addCleanup(node.wait, 60.0)
        self.addCleanup(node.terminate)
        images = {side: Newest(f"/endoscope/{side}/image_raw", Image) for side in SIDES}
        wait_until(lambda: all(i.subscriber.get_num_connections() for i in images.values()), "replay_media publishes")
        self.play()
        expected = [k for k in range(FRAMES) if k % 7 != 3]
        for side, image in images.items():
            wait_until(lambda image=image: len(image.all) >= len(expected), lambda image=image: str(shown(image)))
            self.assertEqual(shown(image), expected)
            stamps = [message.header.stamp.to_nsec() - BEGIN_NS for message in image.all]
            self.assertEqual(stamps, [k * 66_000_000 for k in expected])
            self.assertEqual(image.all[0].header.frame_id, f"endoscope_{side}_optical")
        node.terminate()
        node.wait(60.0)
        samples = np.fromfile(heard, np.int16).reshape(-1, 1056)
        self.assertGreaterEqual(len(samples), FRAMES - 2)  # who subscribes late misses a piece
        np.testing.assert_array_equal(
            samples, np.repeat(samples[:1, :1] + np.arange(len(samples))[:, None], 1056, axis=1)
        )

    def test_2_what_is_missing_is_named(self):
        node = self.replay("", directory=str(self.folder / "nowhere"))
        output, _ = node.communicate(timeout=60)
        self.assertEqual(node.returncode, 2, output)
        self.assertIn("must be the bag's directory", output)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "replay_media", ReplayMedia)
