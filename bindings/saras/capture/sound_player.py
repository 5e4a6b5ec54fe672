"""Sound to a loudspeaker, or wherever a GStreamer sink leads, as it comes."""

from __future__ import annotations

import numpy as np

from saras.capture.chunks import Samples
from saras.capture.pulled_pipeline import gstreamer, words
from saras.capture.sound_index import SoundError


class SoundPlayer:
    """Plays what it is given at once; what comes late is heard late."""

    def __init__(self, sink: str, rate_hz: int, channels: int) -> None:
        """sink: GStreamer's words, as autoaudiosink. Raises SoundError when it does not work."""
        self._gst = gst = gstreamer()
        text = f"appsrc name=in format=time is-live=true do-timestamp=true ! audioconvert ! audioresample ! {sink}"
        try:
            self._pipeline = gst.parse_launch(text)
        except Exception as error:  # GLib.Error, which only exists once gi is there
            raise SoundError(f"sink = {sink!r}: {words(error)}") from None
        self._source, self._bus = self._pipeline.get_by_name("in"), self._pipeline.get_bus()
        caps = f"audio/x-raw,format=S16LE,layout=interleaved,rate={rate_hz},channels={channels}"
        self._source.set_property("caps", gst.Caps.from_string(caps))
        if self._pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
            why = self._failure() or "it cannot be started"
            self._pipeline.set_state(gst.State.NULL)
            raise SoundError(f"sink = {sink!r}: {why}")

    def play(self, samples: Samples) -> None:
        """(n, channels). Raises SoundError."""
        buffer = self._gst.Buffer.new_wrapped(np.ascontiguousarray(samples, np.int16).tobytes())
        taken = self._source.emit("push-buffer", buffer) == self._gst.FlowReturn.OK
        why = self._failure()
        if why is not None or not taken:
            raise SoundError(f"the sound cannot be played: {why or 'the sink takes no more'}")

    def close(self) -> None:
        """Plays what it has, and ends."""
        self._source.emit("end-of-stream")
        wanted = self._gst.MessageType.ERROR | self._gst.MessageType.EOS
        self._bus.timed_pop_filtered(2 * self._gst.SECOND, wanted)
        self._pipeline.set_state(self._gst.State.NULL)

    def _failure(self) -> str | None:
        message = self._bus.pop_filtered(self._gst.MessageType.ERROR)
        return None if message is None else words(message.parse_error()[0])


__all__ = ["SoundPlayer"]
