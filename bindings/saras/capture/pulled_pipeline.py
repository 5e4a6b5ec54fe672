"""One GStreamer pipeline in a thread: buffers out, errors by name, and another try."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

from saras import Error

POLL_NS = 50_000_000
OLDEST_NS = 5_000_000_000


class NoGStreamerError(Error):
    """GStreamer or its Python bindings are missing; the text says what to install."""


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


class PulledPipeline:
    """Runs `source ! ending ! appsink` and calls on_sample(sample, taken_ns) from its own thread, until stopped.

    sample: a Gst.Sample; taken_ns: when its first part was taken, nanoseconds since the epoch, None: the pipeline does
    not know. A pipeline that fails, ends or is silent for silence_s is started anew after retry_s. awaited: what is
    missing when it is silent; on_start(Gst.Pipeline): one begins, the first or another.
    """

    def __init__(
        self,
        name: str,
        source: str,
        ending: str,
        on_sample: Callable[[Any, int | None], None],
        *,
        awaited: str,
        silence_s: float,
        retry_s: float,
        on_start: Callable[[Any], None] = lambda pipeline: None,
        on_state: Callable[[str], None] = lambda state: None,
    ) -> None:
        """ending: from the source's raw data to what is wanted, and the appsink with its properties."""
        self.name, self.failures, self.state = name, 0, "STARTING"
        self._text = f"{source} ! {ending} name=out"
        self._awaited, self._silence_s, self._retry_s = awaited, silence_s, retry_s
        self._on_sample, self._on_start, self._on_state = on_sample, on_start, on_state
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
            try:
                why = self._play()
            except Exception as error:  # of on_sample: a thread that ends quietly would leave its last word standing
                why = f"{type(error).__name__}: {error}"
            if self._end.is_set():
                return
            self.failures += 1
            self._say(f"LOST: {self.name}: {'the end of it was reached' if why == 'end' else why}")
            self._end.wait(self._retry_s)

    def _say(self, state: str) -> None:
        if state != self.state:
            self.state = state
            self._on_state(state)

    def _play(self) -> str:
        """Until something ends it: what that was."""
        gst = self._gst
        try:
            pipeline = gst.parse_launch(self._text)
        except Exception as error:  # GLib.Error, which only exists once gi is there
            return words(error)
        out, bus = pipeline.get_by_name("out"), pipeline.get_bus()
        try:
            if pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
                return self._failure(bus) or "it cannot be started"
            self._on_start(pipeline)
            heard_s = time.monotonic()
            while not self._end.is_set():
                sample = out.emit("try-pull-sample", POLL_NS)
                if sample is not None:
                    heard_s = time.monotonic()
                    taken_ns = self._taken_ns(pipeline, sample)
                    self._say("OK")
                    self._on_sample(sample, taken_ns)
                    continue
                if (why := self._failure(bus)) is not None:
                    return why
                if time.monotonic() - heard_s > self._silence_s:
                    return f"no {self._awaited} for {self._silence_s:g} s"
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
        return f"{message.src.get_name()}: {words(error)}"

    def _taken_ns(self, pipeline: Any, sample: Any) -> int | None:
        gst, buffer, clock = self._gst, sample.get_buffer(), pipeline.get_clock()
        if clock is None or buffer.pts == gst.CLOCK_TIME_NONE:
            return None
        running = sample.get_segment().to_running_time(gst.Format.TIME, buffer.pts)
        age_ns = int(clock.get_time() - pipeline.get_base_time() - running)
        return time.time_ns() - age_ns if 0 <= age_ns <= OLDEST_NS else None


def words(error: Any) -> str:
    """What a GLib.Error says."""
    return str(getattr(error, "message", error)).strip().rstrip(".")


__all__ = ["NoGStreamerError", "PulledPipeline", "gstreamer", "words"]
