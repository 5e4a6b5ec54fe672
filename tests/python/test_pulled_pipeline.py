"""A GStreamer pipeline in a thread: samples with their times, and what goes wrong, by name."""

from __future__ import annotations

import threading
import time

import pytest

from saras.capture.pulled_pipeline import PulledPipeline

pytest.importorskip("gi")

PATIENCE_S = 30.0
ENDING = "videoconvert ! video/x-raw,format=BGR ! appsink max-buffers=2 drop=true sync=true"


class Taken:
    """Runs a pipeline for a while."""

    def __init__(self, source: str, silence_s: float = 20.0, retry_s: float = 600.0, fails: int = 0) -> None:
        self.times_ns: list[int | None] = []
        self.states: list[str] = []
        self._fails = fails
        self._news = threading.Condition()
        self.pipeline = PulledPipeline(
            "camera",
            source,
            ENDING,
            self._on_sample,
            awaited="picture",
            silence_s=silence_s,
            retry_s=retry_s,
            on_state=self._on_state,
        )

    def __enter__(self) -> Taken:
        self.pipeline.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.pipeline.stop()

    def _on_sample(self, _: object, taken_ns: int | None) -> None:
        if self._fails > 0:
            self._fails -= 1
            raise ValueError("no room")
        with self._news:
            self.times_ns.append(taken_ns)
            self._news.notify_all()

    def _on_state(self, state: str) -> None:
        with self._news:
            self.states.append(state)
            self._news.notify_all()

    def wait(self, condition) -> None:
        with self._news:
            assert self._news.wait_for(condition, PATIENCE_S), self.states


def test_samples_come_in_the_order_of_their_times() -> None:
    begin_ns = time.time_ns()
    with Taken("videotestsrc is-live=true") as taken:
        taken.wait(lambda: len(taken.times_ns) >= 10)
    assert taken.states == ["OK"]
    assert taken.times_ns == sorted(taken.times_ns)
    assert begin_ns - 1e9 < taken.times_ns[0] <= taken.times_ns[-1] <= time.time_ns()


def test_one_that_ends_is_lost_by_name_and_tried_again() -> None:
    with Taken("videotestsrc num-buffers=3", retry_s=0.05) as taken:
        taken.wait(lambda: len(taken.times_ns) >= 7)
    assert taken.states[:3] == ["OK", "LOST: camera: the end of it was reached", "OK"]
    assert taken.pipeline.failures >= 2


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("v4l2src device=/dev/video77 ! decodebin", "/dev/video77"),
        ("filesrc location=/nowhere/none.avi ! decodebin", "filesrc0"),
        ("nosuchelement", "nosuchelement"),
    ],
)
def test_what_is_not_there_is_lost_with_its_name(source: str, words: str) -> None:
    with Taken(source) as taken:
        taken.wait(lambda: taken.states)
    assert taken.states[0].startswith("LOST: camera: ")
    assert words in taken.states[0]
    assert not taken.times_ns


def test_silence_is_lost_too() -> None:
    source = "appsrc is-live=true caps=video/x-raw,format=BGR,width=32,height=32,framerate=5/1"
    with Taken(source, silence_s=0.3) as taken:
        taken.wait(lambda: taken.states)
    assert taken.states == ["LOST: camera: no picture for 0.3 s"]


def test_a_reader_that_raises_is_said_and_asked_again() -> None:
    with Taken("videotestsrc is-live=true", retry_s=0.05, fails=1) as taken:
        taken.wait(lambda: taken.times_ns)
    assert taken.states == ["OK", "LOST: camera: ValueError: no room", "OK"]
