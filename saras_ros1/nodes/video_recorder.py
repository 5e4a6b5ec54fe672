"""video_recorder: both eyes of the endoscope as videos beside the bag, each picture's number and stamp in the bag.

It follows /recorder/state: a bag at PATH.bag has PATH_left.mkv and PATH_right.mkv, with their indices beside them.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import Image

from saras.capture.video_file import CODECS, VideoFile
from saras_ros1.beside_bag import BesideBag, recorder_state
from saras_ros1.camera_images import colours
from saras_ros1.channel import SIDES
from saras_ros1.inputs import Input
from saras_ros1.msg import VideoFrame
from saras_ros1.node import Node, run


class EyeVideo:
    """One eye. Its picture is encoded in a thread of its own: ROS goes on meanwhile."""

    def __init__(self, node: VideoRecorder, recorder: Input, side: str) -> None:
        self.side, self.node = side, node
        self.frames = self.lost = 0
        self.file: BesideBag[VideoFile] = BesideBag(node, recorder, f"video of the {side} eye", f"{side}.mkv")
        self._seq: int | None = None
        self._out = rospy.Publisher(f"/recorder/video/{side}", VideoFrame, queue_size=100)
        rospy.Subscriber(f"{node.topics}/{side}/image_raw", Image, self._on_image, queue_size=8, buff_size=1 << 25)

    def _on_image(self, message: Image) -> None:
        if self._seq is not None and message.header.seq > self._seq + 1 and self.file.open:
            self.lost += message.header.seq - self._seq - 1
        self._seq = message.header.seq
        self.file.put(partial(self._new, message), partial(self._write, message))

    def _new(self, message: Image, path: Path) -> VideoFile:
        size = (message.width - message.width % 2, message.height - message.height % 2)
        node = self.node
        video = VideoFile(path, size, node.rate_hz, codec=node.codec, bitrate_kbit_s=node.bitrate_kbit_s)
        self.frames = self.lost = 0
        return video

    def _write(self, message: Image, video: VideoFile) -> None:
        width, height = video.size
        pixels = colours(message)[:height, :width]
        if pixels.ndim == 2:
            pixels = np.repeat(pixels[:, :, np.newaxis], 3, axis=2)
        frame = VideoFrame(file=video.path.name)
        frame.frame = video.write(pixels, message.header.stamp.to_nsec(), message.header.seq)
        frame.header.stamp, frame.header.frame_id = message.header.stamp, message.header.frame_id
        self.frames = video.frames
        self._out.publish(frame)


class VideoRecorder(Node):
    """Nothing waits for it."""

    def __init__(self) -> None:
        super().__init__("video_recorder")
        self.topics = self.params.text("topics")
        self.rate_hz = self.params.number("rate_hz", 1.0, 120.0)
        self.codec = self.params.text("codec", tuple(CODECS))
        self.bitrate_kbit_s = self.params.integer("bitrate_kbit_s", 100, 100_000)
        self.params.finish()
        recorder = recorder_state(self)
        self.eyes = [EyeVideo(self, recorder, side) for side in SIDES]

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's; an eye that is not written while the bag is, is an error."""
        status = super()._diagnose()
        if faults := [f"{eye.side}: {eye.file.fault}" for eye in self.eyes if eye.file.fault]:
            status.level, status.message = DiagnosticStatus.ERROR, "; ".join(faults)
        return status

    def report(self) -> dict:
        """Frames in the videos, and pictures that did not come."""
        return {f"{eye.side} frames": eye.frames for eye in self.eyes} | {
            f"{eye.side} lost": eye.lost for eye in self.eyes
        }


def main() -> int:
    """Runs the node."""
    return run(VideoRecorder)
