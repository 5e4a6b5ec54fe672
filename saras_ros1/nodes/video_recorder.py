"""video_recorder: both eyes of the endoscope as videos beside the bag, each picture's number and stamp in the bag.

It follows /recorder/state: a bag at PATH.bag has PATH_left.mkv and PATH_right.mkv, with their indices beside them.
"""

from __future__ import annotations

import threading
from pathlib import Path

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import Image
from std_msgs.msg import String

from saras import Error
from saras.capture.video_file import CODECS, VideoFile
from saras_ros1.camera_images import colours
from saras_ros1.channel import SIDES
from saras_ros1.msg import RecorderState, VideoFrame
from saras_ros1.node import Node, run

STATE_TIMEOUT_S = 2.0  #: a silent recorder records nothing: its video is closed
MAX_WAIT_S = 0.2


class EyeVideo:
    """One eye. Its picture is encoded in a thread of its own: ROS goes on meanwhile."""

    def __init__(self, node: VideoRecorder, side: str) -> None:
        self.side, self.node = side, node
        self.video: VideoFile | None = None
        self.frames = self.lost = 0
        self.fault = ""
        self._seq: int | None = None
        self._lock = threading.Lock()
        self._out = rospy.Publisher(f"/recorder/video/{side}", VideoFrame, queue_size=100)
        rospy.Subscriber(f"{node.topics}/{side}/image_raw", Image, self._on_image, queue_size=8, buff_size=1 << 25)

    def _on_image(self, message: Image) -> None:
        if self._seq is not None and message.header.seq > self._seq + 1 and self.video is not None:
            self.lost += message.header.seq - self._seq - 1
        self._seq = message.header.seq
        with self._lock:
            try:
                self._write(message)
                self.fault = ""
            except Error as error:
                self.fault = str(error)
                rospy.logerr_throttle(5.0, f"video of the {self.side} eye: {error}")
                self._close()

    def _write(self, message: Image) -> None:
        path = self.node.video_path(self.side)
        if self.video is not None and (path is None or self.video.path != path):
            self._close()
        if path is None:
            return
        if self.video is None:
            size = (message.width - message.width % 2, message.height - message.height % 2)
            self.video = VideoFile(
                path, size, self.node.rate_hz, codec=self.node.codec, bitrate_kbit_s=self.node.bitrate_kbit_s
            )
            self.frames = self.lost = 0
        width, height = self.video.size
        pixels = colours(message)[:height, :width]
        if pixels.ndim == 2:
            pixels = np.repeat(pixels[:, :, np.newaxis], 3, axis=2)
        frame = VideoFrame(file=path.name)
        frame.frame = self.video.write(pixels, message.header.stamp.to_nsec(), message.header.seq)
        frame.header.stamp, frame.header.frame_id = message.header.stamp, message.header.frame_id
        self.frames = self.video.frames
        self._out.publish(frame)

    def check(self) -> None:
        """Closes the video when the recording is over, also when no picture comes any more."""
        with self._lock:
            if self.video is not None and self.video.path != self.node.video_path(self.side):
                self._close()

    def _close(self) -> None:
        video, self.video = self.video, None
        if video is not None:
            try:
                video.close()
            except Error as error:
                rospy.logerr(str(error))

    def end(self) -> None:
        """At shutdown."""
        with self._lock:
            self._close()


class VideoRecorder(Node):
    """Nothing waits for it."""

    def __init__(self) -> None:
        super().__init__("video_recorder")
        self.topics = self.params.text("topics")
        self.rate_hz = self.params.number("rate_hz", 1.0, 120.0)
        self.codec = self.params.text("codec", tuple(CODECS))
        self.bitrate_kbit_s = self.params.integer("bitrate_kbit_s", 100, 100_000)
        self.params.finish()
        self.recorder = self.input("/recorder/state", RecorderState, timeout_s=STATE_TIMEOUT_S)
        self._events = self.output("/system/events", String)
        self.eyes = [EyeVideo(self, side) for side in SIDES]
        rospy.on_shutdown(lambda: [eye.end() for eye in self.eyes])
        self.every(MAX_WAIT_S, lambda: [eye.check() for eye in self.eyes])

    def video_path(self, side: str) -> Path | None:
        """Where this eye's pictures go now; None: nowhere."""
        state = self.recorder.message
        if not self.recorder.fresh or not state.wanted or not state.path or not state.duration > 0.0:
            return None
        bag = Path(state.path)
        return bag.with_name(f"{bag.name.removesuffix('.bag')}_{side}.mkv")

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's; an eye that is not written while the bag is, is an error."""
        status = super()._diagnose()
        if faults := [f"{eye.side}: {eye.fault}" for eye in self.eyes if eye.fault]:
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
