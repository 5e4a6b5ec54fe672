"""Sound through GStreamer: chunks with their times from a microphone or a test source, and FLAC files of them."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.capture.grabber import gstreamer
from saras.capture.sound_index import INDEX_HEAD, SoundError, index_path, times_ns

Samples = npt.NDArray[np.int16]

#: name: pipeline. beep: 880 Hz for a tenth of each second, to see that picture, motion and sound are of one time.
SOURCES = {
    "alsa": "alsasrc device={device}",
    "test": "audiotestsrc is-live=true wave=sine freq=440 volume=0.3",
    "beep": "audiotestsrc is-live=true wave=ticks freq=880 sine-periods-per-tick=88 volume=0.8",
    "silence": "audiotestsrc is-live=true wave=silence",
}
POLL_NS = 50_000_000
CLOSE_S = 10


class Chunk(NamedTuple):
    """samples: (n, channels). taken_ns: of the first one, nanoseconds since the epoch. first: its number."""

    samples: Samples
    taken_ns: int
    first: int


def source_text(name: str, device: str = "default", pipeline: str = "") -> str:
    """A GStreamer source: one of SOURCES, or "pipeline" with a text of one's own. Raises ConfigError."""
    if name == "pipeline":
        if not pipeline:
            raise ConfigError("pipeline = '': must not be empty")
        return pipeline
    if name not in SOURCES:
        raise ConfigError(f"source = {name!r}: must be one of {', '.join((*SOURCES, 'pipeline'))}")
    return SOURCES[name].format(device=device)


class Microphone:
    """Calls on_chunk from its own thread, chunk_s of sound at a time, until stopped. A failed source is tried again."""

    def __init__(
        self,
        source: str,
        on_chunk: Callable[[Chunk], None],
        *,
        rate_hz: int = 16000,
        channels: int = 1,
        chunk_s: float = 0.1,
        silence_s: float = 2.0,
        retry_s: float = 2.0,
    ) -> None:
        self.source, self.rate_hz, self.channels, self.chunk_s = source, rate_hz, channels, chunk_s
        self.silence_s, self.retry_s = silence_s, retry_s
        self.state = "STARTING"
        self.chunks = self.failures = 0
        self._on_chunk = on_chunk
        self._end = threading.Event()
        self._gst = gstreamer()
        self._thread = threading.Thread(target=self._run, name="microphone", daemon=True)

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
            if not self._end.is_set():
                self.failures += 1
                self.state = f"LOST: {why}"
                self._end.wait(self.retry_s)

    def _play(self) -> str:
        gst = self._gst
        caps = f"audio/x-raw,format=S16LE,layout=interleaved,rate={self.rate_hz},channels={self.channels}"
        text = f"{self.source} ! audioconvert ! audioresample ! {caps} ! appsink name=out max-buffers=200 sync=false"
        try:
            pipeline = gst.parse_launch(text)
        except Exception as error:  # GLib.Error, which only exists once gi is there
            return str(getattr(error, "message", error))
        out, bus = pipeline.get_by_name("out"), pipeline.get_bus()
        try:
            if pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
                return _failure(gst, bus) or "it cannot be started"
            return self._listen(pipeline, out, bus)
        finally:
            pipeline.set_state(gst.State.NULL)

    def _listen(self, pipeline: Any, out: Any, bus: Any) -> str:
        gst, heard_s = self._gst, time.monotonic()
        wanted = max(1, round(self.chunk_s * self.rate_hz))
        kept, kept_ns, first = np.zeros((0, self.channels), np.int16), 0, 0
        while not self._end.is_set():
            sample = out.emit("try-pull-sample", POLL_NS)
            if sample is None:
                if (why := _failure(gst, bus)) is not None:
                    return why
                if time.monotonic() - heard_s > self.silence_s:
                    return f"no sound for {self.silence_s:g} s"
                continue
            heard_s, self.state = time.monotonic(), "OK"
            buffer = sample.get_buffer()
            data = np.frombuffer(buffer.extract_dup(0, buffer.get_size()), np.int16).reshape(-1, self.channels)
            if not len(kept):
                kept_ns = self._taken_ns(pipeline, sample, buffer, len(data))
            kept = np.concatenate([kept, data])
            while len(kept) >= wanted:
                self.chunks += 1
                self._on_chunk(Chunk(kept[:wanted], kept_ns, first))
                kept, first = kept[wanted:], first + wanted
                kept_ns += wanted * 1_000_000_000 // self.rate_hz
        return "stopped"

    def _taken_ns(self, pipeline: Any, sample: Any, buffer: Any, count: int) -> int:
        """When the first sample of a buffer was taken: by the pipeline's clock, else by the buffer's own length."""
        gst, now_ns = self._gst, time.time_ns()
        clock = pipeline.get_clock()
        if clock is not None and buffer.pts != gst.CLOCK_TIME_NONE:
            running = sample.get_segment().to_running_time(gst.Format.TIME, buffer.pts)
            age_ns = int(clock.get_time() - pipeline.get_base_time() - running)
            if 0 <= age_ns < 5_000_000_000:
                return now_ns - age_ns
        return now_ns - count * 1_000_000_000 // self.rate_hz


class SoundFile:
    """A FLAC file, and an index of sample numbers and times beside it. Existing files are refused."""

    def __init__(self, path: Path, rate_hz: int, channels: int) -> None:
        """Raises SoundError."""
        for file in (path, index_path(path)):
            if file.exists():
                raise SoundError(f"{file}: exists")
        self.path, self.samples = path, 0
        self._rate_hz, self._channels = rate_hz, channels
        self._gst = gst = gstreamer()
        caps = f"audio/x-raw,format=S16LE,layout=interleaved,rate={rate_hz},channels={channels}"
        self._pipeline = gst.parse_launch(
            "appsrc name=in format=time block=true ! audioconvert ! flacenc ! filesink name=out buffer-mode=unbuffered"
        )
        self._pipeline.get_by_name("out").set_property("location", str(path))
        self._source = self._pipeline.get_by_name("in")
        self._source.set_property("caps", gst.Caps.from_string(caps))
        if self._pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
            why = _failure(gst, self._pipeline.get_bus()) or "it cannot be started"
            self._pipeline.set_state(gst.State.NULL)
            raise SoundError(f"{path}: {why}")
        self._index = index_path(path).open("w", encoding="utf-8", buffering=1)
        self._index.write(INDEX_HEAD)

    def write(self, samples: Samples, taken_ns: int) -> None:
        """(n, channels). Raises SoundError."""
        if samples.ndim != 2 or samples.shape[1] != self._channels:
            raise ConfigError(f"samples {samples.shape}: must be (n, {self._channels})")
        buffer = self._gst.Buffer.new_wrapped(np.ascontiguousarray(samples, np.int16).tobytes())
        buffer.pts = self.samples * 1_000_000_000 // self._rate_hz
        if self._source.emit("push-buffer", buffer) != self._gst.FlowReturn.OK:
            why = _failure(self._gst, self._pipeline.get_bus()) or "the encoder takes no more"
            raise SoundError(f"{self.path}: {why}")
        self._index.write(f"{self.samples},{taken_ns}\n")
        self.samples += len(samples)

    def close(self) -> None:
        """Finishes the file. Raises SoundError when it could not be."""
        if self._index.closed:
            return
        self._index.close()
        self._source.emit("end-of-stream")
        wanted = self._gst.MessageType.ERROR | self._gst.MessageType.EOS
        message = self._pipeline.get_bus().timed_pop_filtered(CLOSE_S * self._gst.SECOND, wanted)
        self._pipeline.set_state(self._gst.State.NULL)
        if message is None or message.type == self._gst.MessageType.ERROR:
            raise SoundError(
                f"{self.path}: " + ("it does not end" if message is None else message.parse_error()[0].message)
            )


def _failure(gst: Any, bus: Any) -> str | None:
    message = bus.pop_filtered(gst.MessageType.ERROR | gst.MessageType.EOS)
    if message is None:
        return None
    return "the end of it was reached" if message.type == gst.MessageType.EOS else str(message.parse_error()[0].message)


__all__ = ["SOURCES", "Chunk", "Microphone", "SoundError", "SoundFile", "index_path", "source_text", "times_ns"]
