"""Sound through GStreamer: chunks with their times from a microphone or a test source, and FLAC files of them."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from saras import ConfigError
from saras.capture.beeper import NAME as BEEPER
from saras.capture.beeper import Beeper
from saras.capture.chunks import Chunk, Chunker, Samples
from saras.capture.indexed_file import IndexedFile
from saras.capture.pulled_pipeline import PulledPipeline, gstreamer, words
from saras.capture.sound_index import INDEX_HEAD, SoundError, index_path, times_ns

#: name: pipeline. beep: 880 Hz for the first tenth of each second of the computer's clock (saras.sim.clap).
SOURCES = {
    "alsa": "alsasrc device={device}",
    "test": "audiotestsrc is-live=true wave=sine freq=440 volume=0.3",
    "beep": f"appsrc name={BEEPER} is-live=true format=time",
    "silence": "audiotestsrc is-live=true wave=silence",
}


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
    """Calls on_chunk from its own thread, chunk_s of sound at a time, until stopped. A failed source is tried again,
    and the numbers of its samples go on by time.
    """

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
        self.chunks = 0
        self._rate_hz, self._channels, self._on_chunk = rate_hz, channels, on_chunk
        self._chunker, self._begins = Chunker(rate_hz, channels, round(chunk_s * rate_hz)), True
        ending = f"audioconvert ! audioresample ! {_caps(rate_hz, channels)} ! appsink max-buffers=200 sync=false"
        self._pipeline = PulledPipeline(
            "microphone",
            source,
            ending,
            self._on_sample,
            awaited="sound",
            silence_s=silence_s,
            retry_s=retry_s,
            on_start=self._on_start,
        )

    @property
    def state(self) -> str:
        """OK, or what is wrong."""
        return self._pipeline.state

    @property
    def failures(self) -> int:
        """How often it had to begin anew."""
        return self._pipeline.failures

    def start(self) -> None:
        """Begins."""
        self._pipeline.start()

    def stop(self) -> None:
        """Ends the pipeline and its thread."""
        self._pipeline.stop()

    def _on_start(self, pipeline: Any) -> None:
        self._begins = True
        if pipeline.get_by_name(BEEPER) is not None:
            Beeper(pipeline, self._rate_hz)

    def _on_sample(self, sample: Any, taken_ns: int | None) -> None:
        buffer = sample.get_buffer()
        data = np.frombuffer(buffer.extract_dup(0, buffer.get_size()), np.int16).reshape(-1, self._channels)
        if taken_ns is None and self._begins:
            taken_ns = time.time_ns() - len(data) * 1_000_000_000 // self._rate_hz
        self._begins = False
        for chunk in self._chunker.add(data, taken_ns):
            self.chunks += 1
            self._on_chunk(chunk)


class SoundFile:
    """A FLAC file, and an index of sample numbers and times beside it. Existing files are refused."""

    def __init__(self, path: Path, rate_hz: int, channels: int) -> None:
        """Raises SoundError."""
        self.path, self.samples = path, 0
        self._rate_hz, self._channels = rate_hz, channels
        caps, stages = _caps(rate_hz, channels), "audioconvert ! flacenc"
        self._file = IndexedFile(path, index_path(path), INDEX_HEAD, caps=caps, stages=stages, error=SoundError)

    def write(self, samples: Samples, taken_ns: int) -> None:
        """(n, channels). Raises SoundError."""
        if samples.ndim != 2 or samples.shape[1] != self._channels:
            raise ConfigError(f"samples {samples.shape}: must be (n, {self._channels})")
        data = np.ascontiguousarray(samples, np.int16).tobytes()
        self._file.push(data, self.samples * 1_000_000_000 // self._rate_hz, f"{self.samples},{taken_ns}\n")
        self.samples += len(samples)

    def close(self) -> None:
        """Finishes the file. Raises SoundError when it could not be."""
        self._file.close()


def read_sound(path: Path) -> Samples:
    """(n, channels) of a file that GStreamer can decode. Raises SoundError."""
    gst = gstreamer()
    text = "filesrc name=in ! decodebin ! audioconvert ! audio/x-raw,format=S16LE ! appsink name=out sync=false"
    pipeline = gst.parse_launch(text)
    pipeline.get_by_name("in").set_property("location", str(path))
    out, bus = pipeline.get_by_name("out"), pipeline.get_bus()
    parts: list[Samples] = []
    channels, failed = 1, None
    try:
        pipeline.set_state(gst.State.PLAYING)
        while failed is None and not out.get_property("eos"):
            sample = out.emit("try-pull-sample", 100_000_000)
            if sample is not None:
                buffer = sample.get_buffer()
                channels = sample.get_caps().get_structure(0).get_value("channels")
                parts.append(np.frombuffer(buffer.extract_dup(0, buffer.get_size()), np.int16))
            else:
                failed = bus.pop_filtered(gst.MessageType.ERROR)
    finally:
        pipeline.set_state(gst.State.NULL)
    if failed is not None:
        raise SoundError(f"{path}: {words(failed.parse_error()[0])}")
    if not parts:
        raise SoundError(f"{path}: no sound in it")
    return np.concatenate(parts).reshape(-1, channels)


def _caps(rate_hz: int, channels: int) -> str:
    return f"audio/x-raw,format=S16LE,layout=interleaved,rate={rate_hz},channels={channels}"


__all__ = [
    "SOURCES",
    "Chunk",
    "Microphone",
    "SoundError",
    "SoundFile",
    "index_path",
    "read_sound",
    "source_text",
    "times_ns",
]
