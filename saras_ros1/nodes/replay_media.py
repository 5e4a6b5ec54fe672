"""replay_media: the videos and the sound beside a bag, in step with the bag that is played.

The bag says which frame is due (/recorder/video/{s}): it is decoded and published as the picture that it was, with its
own stamp. /audio is played as it comes.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from sensor_msgs.msg import Image

from saras import ConfigError, Error
from saras.capture.sound_player import SoundPlayer
from saras.capture.video_reader import VideoReader
from saras_ros1.camera_images import image_msg
from saras_ros1.channel import SIDES
from saras_ros1.msg import AudioChunk, VideoFrame
from saras_ros1.node import Node, run


class ReplayedEye:
    """One eye; the video that the bag names."""

    def __init__(self, node: ReplayMedia, side: str) -> None:
        self.node, self.side = node, side
        self.shown, self.fault = 0, ""
        self._reader: VideoReader | None = None
        self._out = rospy.Publisher(f"{node.topics}/{side}/image_raw", Image, queue_size=50)
        rospy.Subscriber(f"/recorder/video/{side}", VideoFrame, self._on_frame, queue_size=100, tcp_nodelay=True)

    def _on_frame(self, message: VideoFrame) -> None:
        path = self.node.directory / Path(message.file).name  # a name, whatever the bag says
        try:
            if self._reader is None or self._reader.path != path:
                self._reader = VideoReader(path)
            pixels = self._reader.frame(message.frame)
        except Error as error:
            self.fault = str(error)
            rospy.logerr_throttle(5.0, f"{self.side} eye: {error}")
            return
        self.fault = ""
        self._out.publish(image_msg(pixels, "bgr8", message.header.frame_id, message.header.stamp))
        self.shown += 1


class ReplayMedia(Node):
    """Publishes as the bag's messages come."""

    def __init__(self) -> None:
        super().__init__("replay_media")
        self.directory = Path(self.params.text("directory"))
        self.topics, self.sink = self.params.text("topics"), self.params.text("sink", empty=True)
        self.params.finish()
        if not self.directory.is_dir():
            raise ConfigError(f"{self.name}/directory = {str(self.directory)!r}: must be the bag's directory")
        self.player: SoundPlayer | None = None
        self.heard, self.fault = 0, ""
        self.eyes = [ReplayedEye(self, side) for side in SIDES]
        if self.sink:
            rospy.Subscriber("/audio", AudioChunk, self._on_sound, queue_size=100, tcp_nodelay=True)
        rospy.on_shutdown(self._end)

    def _on_sound(self, message: AudioChunk) -> None:
        if self.fault:
            return
        try:
            if self.player is None:
                self.player = SoundPlayer(self.sink, message.rate, message.channels)
            self.player.play(np.array(message.samples, np.int16).reshape(-1, message.channels))
            self.heard += 1
        except Error as error:  # a computer without a loudspeaker
            self.fault = str(error)
            rospy.logerr(f"no sound: {error}")

    def _end(self) -> None:
        if self.player is not None:
            self.player.close()

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's; a video that is not there or cannot be read is an error."""
        status = super()._diagnose()
        if faults := [eye.fault for eye in self.eyes if eye.fault] + [self.fault] * bool(self.fault):
            status.level, status.message = DiagnosticStatus.ERROR, "; ".join(faults)
        return status

    def report(self) -> dict:
        """Pictures and pieces of sound so far."""
        return {**{f"{eye.side} pictures": eye.shown for eye in self.eyes}, "chunks": self.heard}


def main() -> int:
    """Runs the node."""
    return run(ReplayMedia)
