"""A microphone that hears a beep at each full second of the computer's clock: the sound of saras.sim.clap."""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import numpy.typing as npt

from saras.capture.pulled_pipeline import gstreamer
from saras.sim.clap import BEEP_NS, SECOND_NS

BLOCK_NS = 20_000_000
PITCH_HZ, LOUDNESS = 880.0, 20000.0
#: A clock that was set by so much: the next block begins at what it says now.
STEP_NS = 500_000_000

#: Name of the appsrc that is fed.
NAME = "beep"


def beep(begin_ns: int, rate_hz: int, count: int) -> npt.NDArray[np.int16]:
    """(count,) samples from begin_ns on, nanoseconds since the epoch."""
    after_s = 1e-9 * (begin_ns % SECOND_NS) + np.arange(count) / rate_hz
    on = after_s % 1.0 < 1e-9 * BEEP_NS
    return np.where(on, LOUDNESS * np.sin(2.0 * np.pi * PITCH_HZ * after_s), 0.0).astype(np.int16)


class Beeper:
    """Feeds the appsrc NAME of a started pipeline, block by block as time goes on, until that takes no more."""

    def __init__(self, pipeline: Any, rate_hz: int) -> None:
        self._gst, self._pipeline, self._rate_hz = gstreamer(), pipeline, rate_hz
        self._source = pipeline.get_by_name(NAME)
        caps = f"audio/x-raw,format=S16LE,layout=interleaved,rate={rate_hz},channels=1"
        self._source.set_property("caps", self._gst.Caps.from_string(caps))
        threading.Thread(target=self._run, name="beeper", daemon=True).start()

    def _run(self) -> None:
        gst = self._gst
        while not self._pipeline.get_base_time():  # it has not begun to count
            if self._pipeline.get_state(0)[1] == gst.State.NULL:
                return
            time.sleep(0.01)
        begin_ns = time.time_ns()
        count = self._rate_hz * BLOCK_NS // SECOND_NS
        while True:
            time.sleep(max(0.0, 1e-9 * (begin_ns + BLOCK_NS - time.time_ns())))  # a block is heard when it is over
            running_ns = self._pipeline.get_clock().get_time() - self._pipeline.get_base_time()
            late_ns = time.time_ns() - begin_ns
            if not 0 <= late_ns < STEP_NS:
                begin_ns = time.time_ns()
                continue
            buffer = gst.Buffer.new_wrapped(beep(begin_ns, self._rate_hz, count).tobytes())
            buffer.pts, buffer.duration = max(0, running_ns - late_ns), BLOCK_NS
            if self._source.emit("push-buffer", buffer) != gst.FlowReturn.OK:
                return
            begin_ns += BLOCK_NS


__all__ = ["NAME", "Beeper", "beep"]
