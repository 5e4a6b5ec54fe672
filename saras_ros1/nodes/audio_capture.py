"""audio_capture: what is said in the room, on a topic and as FLAC beside the bag; each chunk with its time.

It follows /recorder/state: a bag at PATH.bag has PATH_audio.flac and its index beside it.
"""

from __future__ import annotations

import threading
from pathlib import Path

import rospy
from diagnostic_msgs.msg import DiagnosticStatus

from saras import Error
from saras.capture.sound import Chunk, Microphone, SoundFile, source_text
from saras_ros1.msg import AudioChunk, RecorderState
from saras_ros1.node import Node, run
from saras_ros1.stamped import time_of

STATE_TIMEOUT_S = 2.0


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
        self.recorder = self.input("/recorder/state", RecorderState, timeout_s=STATE_TIMEOUT_S)
        self._out = rospy.Publisher("/audio", AudioChunk, queue_size=50)
        self._file: SoundFile | None = None
        self._file_lock = threading.Lock()
        self._fault = ""
        self.microphone = Microphone(
            source, self._on_chunk, rate_hz=self.rate_hz, channels=self.channels, chunk_s=chunk_s
        )
        rospy.on_shutdown(self._end)
        self.microphone.start()
        self.every(0.2, self._check)

    def _on_chunk(self, chunk: Chunk) -> None:
        message = AudioChunk(first=chunk.first, rate=self.rate_hz, channels=self.channels)
        message.header.stamp = time_of(chunk.taken_ns)
        message.samples = chunk.samples.ravel().tolist()
        self._out.publish(message)
        with self._file_lock:
            try:
                self._write(chunk)
                self._fault = ""
            except Error as error:
                self._fault = str(error)
                rospy.logerr_throttle(5.0, self._fault)
                self._close()

    def _write(self, chunk: Chunk) -> None:
        path = self._path()
        if self._file is not None and self._file.path != path:
            self._close()
        if path is None:
            return
        if self._file is None:
            self._file = SoundFile(path, self.rate_hz, self.channels)
        self._file.write(chunk.samples, chunk.taken_ns)

    def _path(self) -> Path | None:
        state = self.recorder.message
        if not self.recorder.fresh or not state.wanted or not state.path or not state.duration > 0.0:
            return None
        bag = Path(state.path)
        return bag.with_name(f"{bag.name.removesuffix('.bag')}_audio.flac")

    def _check(self) -> None:
        with self._file_lock:
            if self._file is not None and self._file.path != self._path():
                self._close()

    def _close(self) -> None:
        file, self._file = self._file, None
        if file is not None:
            try:
                file.close()
            except Error as error:
                rospy.logerr(str(error))

    def _end(self) -> None:
        self.microphone.stop()
        with self._file_lock:
            self._close()

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's; a lost microphone and a file that cannot be written are errors."""
        status = super()._diagnose()
        if fault := self._fault or (self.microphone.state if self.microphone.state != "OK" else ""):
            status.level, status.message = DiagnosticStatus.ERROR, fault
        return status

    def report(self) -> dict:
        """Chunks so far."""
        return {"microphone": self.microphone.state, "chunks": self.microphone.chunks}


def main() -> int:
    """Runs the node."""
    return run(AudioCapture)
