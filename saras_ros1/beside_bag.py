"""A file that is written beside the bag for as long as one is recorded: named, opened and closed by /recorder/state."""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, Generic, Protocol, TypeVar

import rospy

from saras import Error
from saras_ros1.inputs import Input
from saras_ros1.msg import RecorderState
from saras_ros1.node import Node

STATE_TIMEOUT_S = 2.0  #: a silent recorder records nothing: what is beside its bag is closed
CHECK_S = 0.2


class Writable(Protocol):
    """A file of saras.capture."""

    path: Path

    def close(self) -> None:
        """Raises saras.Error."""


F = TypeVar("F", bound=Writable)


def recorder_state(node: Node) -> Input:
    """The recorder's word, which gets old."""
    return node.input("/recorder/state", RecorderState, timeout_s=STATE_TIMEOUT_S)


class BesideBag(Generic[F]):
    """One file at a time. put() opens it when there is something for it; it is closed once the recording is over, also
    when nothing comes any more. What goes wrong is kept in `fault` until it is over; the next put() tries again.
    """

    def __init__(self, node: Node, recorder: Input, what: str, suffix: str) -> None:
        """what: for messages; suffix: of a bag NAME.bag it is NAME_suffix."""
        self.what, self.fault = what, ""
        self._recorder, self._suffix = recorder, suffix
        self._file: F | None = None
        self._lock = threading.Lock()
        rospy.on_shutdown(self.close)
        node.every(CHECK_S, self._check)

    @property
    def path(self) -> Path | None:
        """Where it goes now; None: nowhere."""
        state = self._recorder.message
        if not self._recorder.fresh or not state.wanted or not state.path or not state.duration > 0.0:
            return None
        bag = Path(state.path)
        return bag.with_name(f"{bag.name.removesuffix('.bag')}_{self._suffix}")

    @property
    def open(self) -> bool:
        """Whether there is a file now."""
        return self._file is not None

    def put(self, new: Callable[[Path], F], write: Callable[[F], Any]) -> None:
        """Writes into the file, if there is to be one. Both may raise saras.Error."""
        with self._lock:
            try:
                path = self.path
                if self._file is not None and self._file.path != path:
                    self._close()
                if path is not None:
                    if self._file is None:
                        self._file = new(path)
                    write(self._file)
                self.fault = ""
            except Error as error:
                self.fault = str(error)
                rospy.logerr_throttle(5.0, f"{self.what}: {error}")
                self._close()

    def close(self) -> None:
        """Finishes the file, if there is one."""
        with self._lock:
            self._close()

    def _check(self) -> None:
        with self._lock:
            if self._file is not None and self._file.path != self.path:
                self._close()

    def _close(self) -> None:
        file, self._file = self._file, None
        if file is not None:
            try:
                file.close()
            except Error as error:
                rospy.logerr(f"{self.what}: {error}")
