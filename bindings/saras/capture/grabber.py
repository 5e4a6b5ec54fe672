"""Pictures out of a GStreamer pipeline, each with the time when it was taken."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from saras.capture.pulled_pipeline import PulledPipeline

Image = npt.NDArray[np.uint8]

# sync: files at their own speed
ENDING = "videoconvert ! video/x-raw,format=BGR ! appsink max-buffers=2 drop=true sync=true"


@dataclass(frozen=True)
class Frame:
    """One picture."""

    pixels: Image
    """(height, width, 3) BGR"""
    taken_ns: int
    """When it was taken, nanoseconds since the epoch, as far as the pipeline knows"""


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
        self.name, self.frames = name, 0
        self._latency_ns, self._on_frame = round(1e9 * latency_s), on_frame
        self._pipeline = PulledPipeline(
            name,
            source,
            ENDING,
            self._on_sample,
            awaited="picture",
            silence_s=silence_s,
            retry_s=retry_s,
            loop=loop,
            on_state=on_state,
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

    def _on_sample(self, sample: Any, taken_ns: int | None) -> None:
        taken_ns = time.time_ns() if taken_ns is None else taken_ns
        buffer, form = sample.get_buffer(), sample.get_caps().get_structure(0)
        width, height = form.get_value("width"), form.get_value("height")
        data = buffer.extract_dup(0, buffer.get_size())
        step = len(data) // height  # GStreamer begins rows at multiples of four bytes
        rows = np.frombuffer(data, np.uint8).reshape(height, step)
        pixels = np.ascontiguousarray(rows[:, : 3 * width]).reshape(height, width, 3)
        self.frames += 1
        self._on_frame(Frame(pixels, taken_ns - self._latency_ns))


__all__ = ["Frame", "Grabber"]
