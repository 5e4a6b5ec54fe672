"""Frames into a video file, one by one, each with its time in an index beside it.

    with VideoFile(Path("left.mkv"), (640, 480), rate_hz=15.0) as video:
        number = video.write(pixels, stamp_ns)

Matroska in clusters of 200 ms and an index that is written line by line: a killed writer loses what it was encoding.
"""

from __future__ import annotations

from pathlib import Path
from types import TracebackType

import numpy as np
import numpy.typing as npt

from saras import ConfigError, Error
from saras.capture.grabber import gstreamer

Image = npt.NDArray[np.uint8]

#: name: encoder. h264 has no frames out of order and a whole picture every second; ffv1 is without loss, and large.
CODECS = {
    "h264": "openh264enc bitrate={bitrate} rate-control=bitrate gop-size={gop} complexity=low ! h264parse",
    "ffv1": "avenc_ffv1",
}
CLOSE_S = 10
INDEX_HEAD = "frame,stamp_ns,seq\n"


class VideoError(Error):
    """The file cannot be written, or GStreamer lacks what it needs; the text says which."""


def index_path(video: Path) -> Path:
    """Of the index beside a video: frame, stamp_ns, seq."""
    return video.with_suffix(".frames.csv")


class VideoFile:
    """One video. Existing files are refused. close() or leaving the context finishes it."""

    def __init__(
        self, path: Path, size: tuple[int, int], rate_hz: float, *, codec: str = "h264", bitrate_kbit_s: int = 8000
    ) -> None:
        """size: width, height [px]; rate_hz: nominal, only for what players show. Raises ConfigError, VideoError."""
        if codec not in CODECS:
            raise ConfigError(f"codec = {codec!r}: must be one of {', '.join(CODECS)}")
        if min(size) < 2 or size[0] % 2 or size[1] % 2:
            raise ConfigError(f"size = {size[0]}x{size[1]}: both must be even and >= 2")
        for file in (path, index_path(path)):
            if file.exists():
                raise VideoError(f"{file}: exists")
        self.path, self.size, self.frames = path, size, 0
        self._gst = gst = gstreamer()
        encoder = CODECS[codec].format(bitrate=1000 * bitrate_kbit_s, gop=max(1, round(rate_hz)))
        text = (
            f"appsrc name=in format=time block=true max-bytes={8 * size[0] * size[1] * 3} ! videoconvert ! {encoder} ! "
            "matroskamux max-cluster-duration=200000000 ! filesink name=out sync=false buffer-mode=unbuffered"
        )
        try:
            self._pipeline = gst.parse_launch(text)
        except Exception as error:  # GLib.Error, which only exists once gi is there
            raise VideoError(f"GStreamer: {getattr(error, 'message', error)}") from None
        self._pipeline.get_by_name("out").set_property("location", str(path))
        self._source = self._pipeline.get_by_name("in")
        caps = f"video/x-raw,format=BGR,width={size[0]},height={size[1]},framerate={round(1000 * rate_hz)}/1000"
        self._source.set_property("caps", gst.Caps.from_string(caps))
        self._bus = self._pipeline.get_bus()
        if self._pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
            why = self._failure() or "it cannot be started"
            self._pipeline.set_state(gst.State.NULL)
            raise VideoError(f"{path}: {why}")
        try:
            self._index = index_path(path).open("w", encoding="utf-8", buffering=1)
            self._index.write(INDEX_HEAD)
        except OSError as error:
            self._pipeline.set_state(gst.State.NULL)
            raise VideoError(f"{index_path(path)}: {error.strerror}") from None
        self._begin_ns: int | None = None
        self._last_ns = -1

    def write(self, pixels: Image | bytes, stamp_ns: int, seq: int = 0) -> int:
        """Adds a picture, (height, width, 3) BGR; returns its number. Raises VideoError; ConfigError for a wrong size.

        A stamp that is not later than the one before is kept in the index; in the video the frame follows by 1 ms.
        """
        data = pixels if isinstance(pixels, bytes) else np.ascontiguousarray(pixels, np.uint8).tobytes()
        if len(data) != 3 * self.size[0] * self.size[1]:
            raise ConfigError(f"picture of {len(data)} bytes: must be {self.size[0]}x{self.size[1]}x3")
        if (why := self._failure()) is not None:
            raise VideoError(f"{self.path}: {why}")
        self._begin_ns = stamp_ns if self._begin_ns is None else self._begin_ns
        self._last_ns = max(stamp_ns - self._begin_ns, self._last_ns + 1_000_000)
        buffer = self._gst.Buffer.new_wrapped(self._padded(data))
        buffer.pts = self._last_ns
        if self._source.emit("push-buffer", buffer) != self._gst.FlowReturn.OK:
            raise VideoError(f"{self.path}: {self._failure() or 'the encoder takes no more'}")
        number, self.frames = self.frames, self.frames + 1
        self._index.write(f"{number},{stamp_ns},{seq}\n")
        return number

    def _padded(self, data: bytes) -> bytes:
        row = 3 * self.size[0]
        step = (row + 3) // 4 * 4  # GStreamer begins rows at multiples of four bytes
        if step == row:
            return data
        rows = np.zeros((self.size[1], step), np.uint8)
        rows[:, :row] = np.frombuffer(data, np.uint8).reshape(self.size[1], row)
        return rows.tobytes()

    def _failure(self) -> str | None:
        message = self._bus.pop_filtered(self._gst.MessageType.ERROR)
        return None if message is None else str(message.parse_error()[0].message)

    def close(self) -> None:
        """Finishes the file. Raises VideoError when it could not be."""
        if self._index.closed:
            return
        self._index.close()
        self._source.emit("end-of-stream")
        wanted = self._gst.MessageType.ERROR | self._gst.MessageType.EOS
        message = self._bus.timed_pop_filtered(CLOSE_S * self._gst.SECOND, wanted)
        self._pipeline.set_state(self._gst.State.NULL)
        if message is None or message.type == self._gst.MessageType.ERROR:
            why = "it does not end" if message is None else message.parse_error()[0].message
            raise VideoError(f"{self.path}: {why}")

    def __enter__(self) -> VideoFile:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def read_index(video: Path) -> npt.NDArray[np.int64]:
    """(n, 3) frame, stamp_ns, seq of a video's index; a last line that was cut is left out."""
    lines = index_path(video).read_text(encoding="utf-8").split("\n")
    if lines[0] + "\n" != INDEX_HEAD:
        raise VideoError(f"{index_path(video)}: no index of frames")
    rows = [line.split(",") for line in lines[1:-1]]
    return np.array([[int(cell) for cell in row] for row in rows], dtype=np.int64).reshape(-1, 3)


__all__ = ["CODECS", "VideoError", "VideoFile", "index_path", "read_index"]
