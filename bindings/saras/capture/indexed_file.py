"""A file that a GStreamer pipeline encodes, and an index of times beside it, written line by line."""

from __future__ import annotations

from pathlib import Path

from saras import Error
from saras.capture.pulled_pipeline import gstreamer, words

CLOSE_S = 10


class IndexedFile:
    """Buffers in, one file and its index out. Existing files are refused. `error` is what it raises."""

    def __init__(
        self, path: Path, index: Path, head: str, *, caps: str, stages: str, error: type[Error], most_bytes: int = 0
    ) -> None:
        """caps: of the buffers; stages: encoder and container; head: first line of the index; most_bytes: of buffers
        that wait for the encoder, 0: GStreamer's own.
        """
        for file in (path, index):
            if file.exists():
                raise error(f"{file}: exists")
        self.path, self._error = path, error
        self._gst = gst = gstreamer()
        waiting = f" max-bytes={most_bytes}" if most_bytes else ""
        text = (
            f"appsrc name=in format=time block=true{waiting} ! {stages} ! "
            "filesink name=out sync=false buffer-mode=unbuffered"
        )
        try:
            self._pipeline = gst.parse_launch(text)
        except Exception as why:  # GLib.Error, which only exists once gi is there
            raise error(f"GStreamer: {words(why)}") from None
        self._pipeline.get_by_name("out").set_property("location", str(path))
        self._source, self._bus = self._pipeline.get_by_name("in"), self._pipeline.get_bus()
        self._source.set_property("caps", gst.Caps.from_string(caps))
        if self._pipeline.set_state(gst.State.PLAYING) == gst.StateChangeReturn.FAILURE:
            said = self._failure() or "it cannot be started"
            self._pipeline.set_state(gst.State.NULL)
            raise error(f"{path}: {said}")
        try:
            self._index = index.open("w", encoding="utf-8", buffering=1)
            self._index.write(head)
        except OSError as why:
            self._pipeline.set_state(gst.State.NULL)
            raise error(f"{index}: {why.strerror}") from None

    def push(self, data: bytes, at_ns: int, line: str) -> None:
        """One buffer, at_ns from the file's begin, and its line in the index. Raises self.error."""
        if (why := self._failure()) is not None:
            raise self._error(f"{self.path}: {why}")
        buffer = self._gst.Buffer.new_wrapped(data)
        buffer.pts = at_ns
        if self._source.emit("push-buffer", buffer) != self._gst.FlowReturn.OK:
            raise self._error(f"{self.path}: {self._failure() or 'the encoder takes no more'}")
        try:
            self._index.write(line)
        except OSError as full:
            raise self._error(f"{self.path}: its index: {full.strerror}") from None

    def close(self) -> None:
        """Finishes the file; again: nothing. Raises self.error when it could not be."""
        if self._index.closed:
            return
        self._index.close()
        self._source.emit("end-of-stream")
        wanted = self._gst.MessageType.ERROR | self._gst.MessageType.EOS
        message = self._bus.timed_pop_filtered(CLOSE_S * self._gst.SECOND, wanted)
        self._pipeline.set_state(self._gst.State.NULL)
        if message is None or message.type == self._gst.MessageType.ERROR:
            why = "it does not end" if message is None else words(message.parse_error()[0])
            raise self._error(f"{self.path}: {why}")

    def _failure(self) -> str | None:
        message = self._bus.pop_filtered(self._gst.MessageType.ERROR)
        return None if message is None else words(message.parse_error()[0])


__all__ = ["IndexedFile"]
