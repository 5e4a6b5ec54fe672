"""One GStreamer pipeline in a thread: frames out, errors by name, and another try."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import Error

Image = npt.NDArray[np.uint8]

POLL_NS = 50_000_000
OLDEST_S = 5.0


class NoGStreamerError(Error):
    """GStreamer or its Python bindings are missing; the text says what to install."""


@dataclass(frozen=True)
class Frame:
    """One picture."""

    pixels: Image
    """(height, width, 3) BGR"""
    taken_ns: int
    """When it was taken, nanoseconds since the epoch, as far as the pipeline knows"""


def gstreamer() -> Any:
    """The module gi.repository.Gst, initialised. Raises NoGStreamerError."""
    try:
        import gi

        gi.require_version("Gst", "1.0")
        from gi.repository import Gst
    except (ImportError, ValueError) as error:
        raise NoGStreamerError(
            f"capture needs GStreamer's Python bindings: apt-get install python3-gst-1.0 ({error})"
        ) from None
    if not Gst.is_initialized():
        Gst.init(None)
    return Gst


class Grabber:
    """Runs `source` (of source_text) and calls on_frame from its own thread, until stopped.

    A pipeline that fails, ends or is silent for silence_s is started anew after retry_s; loop: one that came to its
    end begins again at once. latency_s: what the device itself takes, taken
    off the time of each frame.
    """

    def __init__(
        self,
        name: str,
        source: str,
        on_frame: Callable[[Frame], None],
        *,
        silence_s: float = 1.0,
        retry_s: float = 2.0,
        loop: bool = False,
        latency_s: float = 0.0,
        on_state: Callable[[str], None] = lambda state: None,
    ) -> None:
        self.name, self.source = name, source
        self.silence_s, self.retry_s, self.loop, self.latency_s = silence_s, retry_s, loop, latency_s
        self.frames = self.failures = 0
        self.state = "STARTING"
        self._on_frame, self._on_state = on_frame, on_state
        self._end = threading.Event()
        self._gst = gstreamer()
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)

    def start(self) -> None:
        """Begins."""
        self._thread.start()

    def stop(self) -> None:
        """Ends the pipeline and its thread."""
        self._end.set()
        if self._thread.is_alive():
            self._thread.join(5.0)

    def _run(self) -> None:
        while not self._end.is_set():
            why = self._play()
            if self._end.is_set():
                return
            if why == "end" and self.loop:
                continue
            self.failures += 1
            self._say(f"LOST: {self.name}: {'the end of it was reached' if why == 'end' else why}")
            self._end.wait(self.retry_s)

    def _say(self, state: str) -> None:
        if state != self.state:
            self.state = state
            self._on_state(state)

    def _play(self) -> str:
        """Until something ends it: what that was."""
        gst = self._gst
        sink = "appsink name=out max-buffers=2 drop=true sync=true"  # sync: files at their own speed
        text = f"{self.source} ! videoconvert ! video/x-raw,format=BGR ! {sink}"
        try:
            pipeline = gst.parse_launch(text)
        except Exception as error:  # GLib.Error, which only exists once gi is there
            return _words(error)
        out, bus = pipeline.get_by_name("out"), pipeline.get_bus()
        try:
            if pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
                return self._failure(bus) or "it cannot be started"
            heard_s = time.monotonic()
            while not self._end.is_set():
                sample = out.emit("try-pull-sample", POLL_NS)
                if sample is not None:
                    heard_s = time.monotonic()
                    self.frames += 1
                    frame = self._frame(sample, pipeline)
                    self._say("OK")
                    self._on_frame(frame)
                    continue
                if (why := self._failure(bus)) is not None:
                    return why
                if time.monotonic() - heard_s > self.silence_s:
                    return f"no picture for {self.silence_s:g} s"
            return "stopped"
        finally:
            pipeline.set_state(gst.State.NULL)

    def _failure(self, bus: Any) -> str | None:
        gst = self._gst
        message = bus.pop_filtered(gst.MessageType.ERROR | gst.MessageType.EOS)
        if message is None:
            return None
        if message.type == gst.MessageType.EOS:
            return "end"
        error, _ = message.parse_error()
        return f"{message.src.get_name()}: {_words(error)}"

    def _frame(self, sample: Any, pipeline: Any) -> Frame:
        gst = self._gst
        buffer, form = sample.get_buffer(), sample.get_caps().get_structure(0)
        width, height = form.get_value("width"), form.get_value("height")
        now_ns = time.time_ns()
        data = buffer.extract_dup(0, buffer.get_size())
        step = len(data) // height  # GStreamer begins rows at multiples of four bytes
        rows = np.frombuffer(data, np.uint8).reshape(height, step)
        pixels = np.ascontiguousarray(rows[:, : 3 * width]).reshape(height, width, 3)
        age_ns = 0
        clock = pipeline.get_clock()
        if clock is not None and buffer.pts != gst.CLOCK_TIME_NONE:
            running = sample.get_segment().to_running_time(gst.Format.TIME, buffer.pts)
            age_ns = clock.get_time() - pipeline.get_base_time() - running
        if not 0 <= age_ns <= OLDEST_S * 1e9:  # a source without sensible times
            age_ns = 0
        return Frame(pixels, now_ns - age_ns - round(1e9 * self.latency_s))


def _words(error: Any) -> str:
    return str(getattr(error, "message", error)).strip().rstrip(".")


__all__ = ["Frame", "Grabber", "NoGStreamerError", "gstreamer"]
