"""audio_capture: what is said in the room, on a topic and as FLAC beside the bag; each chunk with its time.

It follows /recorder/state: a bag at PATH.bag has PATH_audio.flac and its index beside it.
"""

from __future__ import annotations

from pathlib import Path

import rospy
from diagnostic_msgs.msg import DiagnosticStatus

from saras.capture.sound import Chunk, Microphone, SoundFile, source_text
from saras_ros1.beside_bag import BesideBag, recorder_state
from saras_ros1.msg import AudioChunk
from saras_ros1.node import Node, run
from saras_ros1.stamped import time_of


class AudioCapture(Node):
    """One microphone. Nothing waits for it."""

    def __init__(self) -> None:
        super().__init__("audio_capture")
        source = source_text(
            self.params.text("source"), self.params.text("device"), self.params.text("pipeline", empty=True)
        )
        self.rate_hz = self.params.integer("rate_hz", 8000, 192_000)
        self.channels = self.params.integer("channels", 1, 8)
        chunk_s = self.params.number("chunk_s", 0.01, 1.0)
        self.params.finish()
        self._out = rospy.Publisher("/audio", AudioChunk, queue_size=50)
        self.microphone = Microphone(
            source, self._on_chunk, rate_hz=self.rate_hz, channels=self.channels, chunk_s=chunk_s
        )
        rospy.on_shutdown(self.microphone.stop)  # before the file is closed
        self.file: BesideBag[SoundFile] = BesideBag(self, recorder_state(self), "sound", "audio.flac")
        self.microphone.start()

    def _on_chunk(self, chunk: Chunk) -> None:
        message = AudioChunk(first=chunk.first, rate=self.rate_hz, channels=self.channels)
        message.header.stamp = time_of(chunk.taken_ns)
        message.samples = chunk.samples.ravel().tolist()
        self._out.publish(message)
        self.file.put(self._new, lambda file: file.write(chunk.samples, chunk.taken_ns))

    def _new(self, path: Path) -> SoundFile:
        return SoundFile(path, self.rate_hz, self.channels)

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's; a lost microphone and a file that cannot be written are errors."""
        status = super()._diagnose()
        if fault := self.file.fault or (self.microphone.state if self.microphone.state != "OK" else ""):
            status.level, status.message = DiagnosticStatus.ERROR, fault
        return status

    def report(self) -> dict:
        """Chunks so far."""
        return {"microphone": self.microphone.state, "chunks": self.microphone.chunks}


def main() -> int:
    """Runs the node."""
    return run(AudioCapture)
