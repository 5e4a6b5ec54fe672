"""Capture through GStreamer: its own test source, a video file that is encoded here, pictures, and what goes wrong."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np
import pytest

from saras import ConfigError
from saras.capture import Frame, Grabber, Pairing, halves, source_text

pytest.importorskip("gi")
cv2 = pytest.importorskip("cv2")

PATIENCE_S = 30.0


class Taken:
    """Runs a grabber for a while."""

    def __init__(self, source: str, **options: object) -> None:
        self.frames: list[Frame] = []
        self.states: list[str] = []
        self._news = threading.Condition()
        self.grabber = Grabber("camera", source, self._on_frame, on_state=self._on_state, **options)

    def __enter__(self) -> Taken:
        self.grabber.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.grabber.stop()

    def _on_frame(self, frame: Frame) -> None:
        with self._news:
            self.frames.append(frame)
            self._news.notify_all()

    def _on_state(self, state: str) -> None:
        with self._news:
            self.states.append(state)
            self._news.notify_all()

    def wait(self, condition) -> None:
        with self._news:
            assert self._news.wait_for(condition, PATIENCE_S), self.states


def write_video(path: Path, levels: list[int], size: tuple[int, int] = (160, 120)) -> None:
    """A video whose n-th picture has a grey level of its own."""
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 20.0, size)
    for level in levels:
        writer.write(np.full((size[1], size[0], 3), level, np.uint8))
    writer.release()


def test_the_test_source_runs_at_the_size_that_is_asked_for() -> None:
    with Taken(source_text("test", "ball", width=321, height=242, rate_hz=25.0)) as taken:
        taken.wait(lambda: len(taken.frames) >= 10)
    assert taken.states == ["OK"]
    frames = taken.frames
    assert all(frame.pixels.shape == (242, 321, 3) for frame in frames)  # rows that are no multiple of four bytes
    assert any(not np.array_equal(frames[0].pixels, frame.pixels) for frame in frames[1:])
    stamps = [frame.taken_ns for frame in frames]
    assert stamps == sorted(stamps)
    assert abs(stamps[-1] - time.time_ns()) < 20e9


def test_colours_are_bgr() -> None:
    with Taken(source_text("test", "red")) as taken:
        taken.wait(lambda: taken.frames)
    blue, green, red = taken.frames[0].pixels.reshape(-1, 3).mean(axis=0)
    assert red > 200 and blue < 40 and green < 40


def test_a_video_file_is_played_in_order_and_again(tmp_path: Path) -> None:
    levels = [20, 60, 100, 140, 180, 220]
    write_video(tmp_path / "six.avi", levels)
    with Taken(source_text("file", str(tmp_path / "six.avi")), loop=True) as taken:
        taken.wait(lambda: len(taken.frames) >= 14)
    seen = [round(float(frame.pixels.mean())) for frame in taken.frames]
    nearest = [min(levels, key=lambda level: abs(level - value)) for value in seen]
    assert all(abs(a - b) < 6 for a, b in zip(seen, nearest))
    assert set(nearest) == set(levels)
    ups = sum(b > a for a, b in zip(nearest, nearest[1:]))
    assert ups >= 0.6 * len(nearest)  # on a busy machine pictures are left out, not exchanged


def test_a_file_that_ends_is_lost_by_name_unless_it_is_to_loop(tmp_path: Path) -> None:
    write_video(tmp_path / "short.avi", [10, 200])
    with Taken(source_text("file", str(tmp_path / "short.avi")), retry_s=60.0) as taken:
        taken.wait(lambda: any(state.startswith("LOST") for state in taken.states))
    assert "camera: the end of it was reached" in taken.states[-1]


def test_numbered_pictures(tmp_path: Path) -> None:
    for i in range(5):
        cv2.imwrite(str(tmp_path / f"eye_{i:03d}.png"), np.full((48, 64, 3), 40 * (i + 1), np.uint8))
    with Taken(source_text("images", str(tmp_path / "eye_%03d.png"), rate_hz=25.0), retry_s=60.0) as taken:
        taken.wait(lambda: len(taken.frames) >= 3)
    assert taken.frames[0].pixels.shape == (48, 64, 3)
    assert {round(float(frame.pixels.mean())) for frame in taken.frames} <= {40, 80, 120, 160, 200}


def test_a_missing_device_is_named_and_found_when_it_comes(tmp_path: Path) -> None:
    path = tmp_path / "later.avi"
    with Taken(source_text("file", str(path)), retry_s=0.1, loop=True) as taken:
        taken.wait(lambda: taken.states)
        assert taken.states[0].startswith("LOST: camera: ")
        assert not taken.frames
        write_video(tmp_path / "made.avi", [10, 60, 110, 160])
        (tmp_path / "made.avi").rename(path)
        taken.wait(lambda: taken.frames)
    assert "OK" in taken.states


@pytest.mark.parametrize(
    ("source", "words"),
    [
        (source_text("v4l2", "/dev/video77"), "/dev/video77"),
        (source_text("pipeline", "nosuchelement"), "nosuchelement"),
        (source_text("decklink", "0"), "LOST: camera"),
    ],
)
def test_what_is_not_there_is_lost_with_its_name(source: str, words: str) -> None:
    with Taken(source, retry_s=60.0, silence_s=2.0) as taken:
        taken.wait(lambda: taken.states)
    assert taken.states[0].startswith("LOST: camera: ")
    assert words in taken.states[0]
    assert not taken.frames


def test_silence_is_lost_too() -> None:
    source = "appsrc is-live=true caps=video/x-raw,format=BGR,width=32,height=32,framerate=5/1"
    with Taken(source_text("pipeline", source), silence_s=0.3, retry_s=60.0) as taken:
        taken.wait(lambda: taken.states)
    assert taken.states == ["LOST: camera: no picture for 0.3 s"]


def test_an_error_of_the_reader_is_said_and_does_not_end_it() -> None:
    taken = Taken(source_text("test", "ball"), retry_s=0.1)
    broken = threading.Event()
    taken.grabber = Grabber("camera", source_text("test", "ball"), lambda frame: 1 // 0 if not broken.is_set()
                            else taken._on_frame(frame), on_state=taken._on_state, retry_s=0.1)  # fmt: skip
    with taken:
        taken.wait(lambda: any("ZeroDivisionError" in state for state in taken.states))
        broken.set()
        taken.wait(lambda: taken.frames)


def test_sources_as_gstreamer_writes_them() -> None:
    assert source_text("decklink", "1", "mode=1080p25 connection=sdi") == (
        "decklinkvideosrc device-number=1 mode=1080p25 connection=sdi"
    )
    assert source_text("v4l2", "/dev/video2", width=1280, height=720, rate_hz=25.0) == (
        'v4l2src device="/dev/video2" ! decodebin ! videoscale ! videorate'
        " ! video/x-raw,width=1280,height=720,framerate=25000/1000"
    )


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("webcam", "0"), "source"),
        (("decklink", "front"), "device"),
        (("file", ""), "device"),
        (("file", 'a" ! fakesink name="b'), "device"),
        (("images", "a.png"), "rate_hz"),
        (("test", "ball ! fakesink"), "device"),
        (("pipeline", " "), "device"),
        (("v4l2", "/dev/video0", "io-mode=2 ! fakesink"), "options"),
    ],
)
def test_wrong_sources_are_refused_by_name(arguments: tuple[str, ...], word: str) -> None:
    with pytest.raises(ConfigError, match=word):
        source_text(*arguments)
    with pytest.raises(ConfigError, match="height"):
        source_text("test", width=640)


def test_halves_of_a_picture() -> None:
    picture = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)
    left, right = halves(picture, "side_by_side")
    assert np.array_equal(np.hstack([left, right]), picture) and left.shape == (4, 3, 3)
    top, bottom = halves(picture, "top_bottom")
    assert np.array_equal(np.vstack([top, bottom]), picture) and top.flags.c_contiguous
    with pytest.raises(ConfigError, match="5x4"):
        halves(picture[:, :5], "side_by_side")


def test_pairs_are_of_one_moment() -> None:
    for seed in range(20):
        rng = np.random.default_rng(seed)
        pairing: Pairing[float] = Pairing(0.01)
        late = rng.uniform(0.0, 0.03)
        events = [(0.04 * i + rng.uniform(0, 1e-3), 0) for i in range(50)]
        events += [(0.04 * i + late + rng.uniform(0, 1e-3), 1) for i in range(50) if rng.random() > 0.1]
        out = [pair for at, side in sorted(events) for pair in pairing.add(side, at, at)]
        for left, right in out:
            assert left is None or right is None or abs(left - right) <= 0.01
        singles = [one for pair in out for one in pair if one is not None]
        assert len(singles) == len(set(singles)) >= len(events) - 2  # nothing twice, nothing lost but the last
        if late < 0.008:
            assert sum(left is not None and right is not None for left, right in out) > 35
        if late > 0.012:
            assert all(left is None or right is None for left, right in out)
