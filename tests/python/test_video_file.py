"""Every frame that was written comes back, in order, with its time."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from saras import ConfigError

cv2 = pytest.importorskip("cv2")
pytest.importorskip("gi")
from saras.capture.video_file import VideoError, VideoFile, index_path, read_index

BITS = 12


def picture(number: int, size: tuple[int, int] = (320, 240)) -> np.ndarray:
    """Its number in blocks of black and white, which no codec spoils."""
    pixels = np.full((size[1], size[0], 3), 90, np.uint8)
    width = size[0] // BITS
    for bit in range(BITS):
        pixels[20:120, bit * width : (bit + 1) * width] = 230 if number >> bit & 1 else 10
    return pixels


def numbers(path: Path) -> list[int]:
    video, found = cv2.VideoCapture(str(path)), []
    while True:
        good, pixels = video.read()
        if not good:
            return found
        width = pixels.shape[1] // BITS
        grey = [pixels[70, bit * width + width // 2].mean() for bit in range(BITS)]
        found.append(sum(1 << bit for bit, value in enumerate(grey) if value > 120))


@pytest.mark.parametrize(("codec", "size"), [("h264", (320, 240)), ("ffv1", (320, 240)), ("h264", (322, 242))])
def test_each_frame_comes_back_in_order_with_its_time(tmp_path: Path, codec: str, size: tuple[int, int]) -> None:
    path, stamps = tmp_path / "left.mkv", []
    with VideoFile(path, size, 15.0, codec=codec) as video:
        for number in range(70):
            stamps.append(1_700_000_000_000_000_000 + number * 66_666_667 + (number % 7) * 1000)
            assert video.write(picture(number, size), stamps[-1], seq=number + 5) == number
    assert numbers(path) == list(range(70))
    index = read_index(path)
    assert index[:, 0].tolist() == list(range(70)) and index[:, 1].tolist() == stamps
    assert index[:, 2].tolist() == list(range(5, 75))


def test_equal_and_earlier_stamps_lose_no_frame(tmp_path: Path) -> None:
    path = tmp_path / "a.mkv"
    with VideoFile(path, (320, 240), 15.0) as video:
        for number, stamp in enumerate([10**9, 10**9, 9 * 10**8, 2 * 10**9, 0]):
            video.write(picture(number), stamp)
    assert numbers(path) == list(range(5))
    assert read_index(path)[:, 1].tolist() == [10**9, 10**9, 9 * 10**8, 2 * 10**9, 0]


def test_a_killed_writer_leaves_what_was_encoded(tmp_path: Path) -> None:
    path = tmp_path / "killed.mkv"
    code = (
        "import sys, time; sys.path[:0] = [sys.argv[2]]\n"
        "from pathlib import Path; from test_video_file import picture\n"
        "from saras.capture.video_file import VideoFile\n"
        "video = VideoFile(Path(sys.argv[1]), (320, 240), 15.0)\n"
        "for k in range(10**6): video.write(picture(k % 4096), k * 66_666_667); time.sleep(0.02)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code, str(path), str(Path(__file__).parent)])
    try:
        end = time.monotonic() + 60.0
        while not (index_path(path).exists() and len(read_index(path)) > 90) and time.monotonic() < end:
            time.sleep(0.05)
    finally:
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    written, found = read_index(path), numbers(path)
    assert len(written) > 90
    assert found == list(range(len(found))) and len(found) >= len(written) - 20


def test_what_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="codec = 'mpeg'"):
        VideoFile(tmp_path / "a.mkv", (320, 240), 15.0, codec="mpeg")
    with pytest.raises(ConfigError, match="size = 321x240"):
        VideoFile(tmp_path / "a.mkv", (321, 240), 15.0)
    with pytest.raises(VideoError):
        VideoFile(tmp_path / "nowhere" / "a.mkv", (320, 240), 15.0)
    with VideoFile(tmp_path / "b.mkv", (320, 240), 15.0) as video:
        with pytest.raises(ConfigError, match="picture of 12 bytes"):
            video.write(np.zeros((2, 2, 3), np.uint8), 0)
        video.write(picture(0), 0)
    with pytest.raises(VideoError, match="exists"):
        VideoFile(tmp_path / "b.mkv", (320, 240), 15.0)
