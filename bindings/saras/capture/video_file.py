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
from saras.capture.indexed_file import IndexedFile

Image = npt.NDArray[np.uint8]

#: name: encoder. h264 has no frames out of order and a whole picture every second; ffv1 is without loss, and large.
CODECS = {
    "h264": "openh264enc bitrate={bitrate} rate-control=bitrate gop-size={gop} complexity=low ! h264parse",
    "ffv1": "avenc_ffv1",
}
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
        self.path, self.size, self.frames = path, size, 0
        encoder = CODECS[codec].format(bitrate=1000 * bitrate_kbit_s, gop=max(1, round(rate_hz)))
        self._file = IndexedFile(
            path,
            index_path(path),
            INDEX_HEAD,
            caps=f"video/x-raw,format=BGR,width={size[0]},height={size[1]},framerate={round(1000 * rate_hz)}/1000",
            stages=f"videoconvert ! {encoder} ! matroskamux max-cluster-duration=200000000",
            error=VideoError,
            most_bytes=8 * size[0] * size[1] * 3,
        )
        self._begin_ns: int | None = None
        self._last_ns = -1

    def write(self, pixels: Image | bytes, stamp_ns: int, seq: int = 0) -> int:
        """Adds a picture, (height, width, 3) BGR; returns its number. Raises VideoError; ConfigError for a wrong size.

        A stamp that is not later than the one before is kept in the index; in the video the frame follows by 1 ms.
        """
        data = pixels if isinstance(pixels, bytes) else np.ascontiguousarray(pixels, np.uint8).tobytes()
        if len(data) != 3 * self.size[0] * self.size[1]:
            raise ConfigError(f"picture of {len(data)} bytes: must be {self.size[0]}x{self.size[1]}x3")
        begin_ns = stamp_ns if self._begin_ns is None else self._begin_ns
        at_ns, number = max(stamp_ns - begin_ns, self._last_ns + 1_000_000), self.frames
        self._file.push(self._padded(data), at_ns, f"{number},{stamp_ns},{seq}\n")
        self._begin_ns, self._last_ns, self.frames = begin_ns, at_ns, number + 1
        return number

    def _padded(self, data: bytes) -> bytes:
        row = 3 * self.size[0]
        step = (row + 3) // 4 * 4  # GStreamer begins rows at multiples of four bytes
        if step == row:
            return data
        rows = np.zeros((self.size[1], step), np.uint8)
        rows[:, :row] = np.frombuffer(data, np.uint8).reshape(self.size[1], row)
        return rows.tobytes()

    def close(self) -> None:
        """Finishes the file. Raises VideoError when it could not be."""
        self._file.close()

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
