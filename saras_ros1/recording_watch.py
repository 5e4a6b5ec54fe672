"""Whether a recording really goes on: the child lives, its file grows, the disk has room."""

from __future__ import annotations

import math
import os
import tempfile
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

RATE_OVER_S = 5.0


@dataclass(frozen=True)
class RecordingLimits:
    """stall_s: a file that has not grown for so long is not written; min_free_B: below it the recording is ended while
    it can still be closed; warn_free_B: below it the operator is told; behind_s: a bag whose newest message is older
    does not keep up, and what is published now may be lost.
    """

    stall_s: float
    min_free_B: float
    warn_free_B: float
    behind_s: float = math.inf


class Look(NamedTuple):
    """What is seen of the recording at one time. exit_code: None while the child lives; free_B: NaN when unknown;
    behind_s: age of the newest message in the file, NaN when unknown.
    """

    now_s: float
    bytes: int
    exit_code: int | None
    free_B: float
    behind_s: float = math.nan


class Verdict(NamedTuple):
    """recording: whether what is published now will be in the bag. stop: it must be ended now. left_s: until the disk
    is full at the present rate, NaN when unknown.
    """

    recording: bool
    stop: bool
    reason: str
    left_s: float


class RecordingWatch:
    """Of one recording, from its start on."""

    def __init__(self, limits: RecordingLimits, started_s: float) -> None:
        self._limits = limits
        self._grown_s, self._bytes = started_s, 0
        self._opened_B = 0  # of the file's head, before any message
        self._history: deque[tuple[float, int]] = deque()

    def look(self, look: Look) -> Verdict:
        """The first thing that is wrong decides."""
        limits = self._limits
        self._opened_B = self._opened_B or look.bytes
        if look.bytes > self._bytes:
            self._grown_s, self._bytes = look.now_s, look.bytes
        self._history.append((look.now_s, look.bytes))
        while look.now_s - self._history[0][0] > RATE_OVER_S:
            self._history.popleft()
        left_s = self._left_s(look)
        if look.exit_code is not None:
            killed = look.exit_code < 0
            how = f"was killed by signal {-look.exit_code}" if killed else f"ended with code {look.exit_code}"
            return Verdict(False, True, f"the recorder {how}", left_s)
        if not look.free_B >= limits.min_free_B:  # NaN too
            free = f"{look.free_B / 1e6:.0f} MB free, needs {limits.min_free_B / 1e6:.0f}"
            return Verdict(False, True, f"the disk is full: {free}", left_s)
        silent_s = look.now_s - self._grown_s
        if silent_s > limits.stall_s:
            return Verdict(False, False, f"nothing was written for {silent_s:.1f} s: look at the disk", left_s)
        if look.bytes == self._opened_B:
            return Verdict(False, False, "starting", left_s)
        if look.behind_s > limits.behind_s:
            reason = f"the bag is {look.behind_s:.0f} s behind: disk or processor too slow"
            return Verdict(False, False, reason, left_s)
        if look.behind_s > limits.stall_s:
            return Verdict(True, False, f"the bag is {look.behind_s:.0f} s behind: disk or processor slow", left_s)
        if look.free_B < limits.warn_free_B:
            until = f", full in {left_s / 60.0:.0f} min" if math.isfinite(left_s) else ""
            return Verdict(True, False, f"{look.free_B / 1e6:.0f} MB free on the disk{until}", left_s)
        return Verdict(True, False, "", left_s)

    def _left_s(self, look: Look) -> float:
        begin_s, begin_B = self._history[0]
        span_s = look.now_s - begin_s
        rate = (look.bytes - begin_B) / span_s if span_s > 0.0 else 0.0
        return max(0.0, look.free_B - self._limits.min_free_B) / rate if rate > 0.0 else math.nan


def free_bytes(directory: str) -> float:
    """Room for this user's files there [B]; NaN when it cannot be told."""
    try:
        stat = os.statvfs(directory)
    except OSError:
        return math.nan
    return float(stat.f_bavail * stat.f_frsize)


def writable(directory: str) -> str:
    """Why nothing can be written there; "": it can."""
    try:
        Path(directory).mkdir(parents=True, exist_ok=True)
        with tempfile.NamedTemporaryFile(dir=directory, prefix=".saras_"):
            return ""
    except OSError as error:
        return f"{directory}: {error.strerror or error}"
