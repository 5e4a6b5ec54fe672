"""A periodic loop on absolute deadlines in a thread of its own."""

from __future__ import annotations

import gc
import sys
import threading
import time
from collections.abc import Callable


class PeriodicLoop:
    """Calls ``step(now_ns)`` at a fixed rate until stopped or until it raises.

    Deadlines are absolute, so that jitter does not add up; a deadline missed by more than a period is skipped, not
    caught up with a burst.
    """

    def __init__(self, step: Callable[[int], None], rate_hz: float) -> None:
        self._step = step
        self._period_ns = round(1e9 / rate_hz)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, name="console-control", daemon=True)
        self.error: BaseException | None = None
        self.skipped = 0  #: deadlines
        self.worst_late_ns = 0

    def start(self) -> None:
        """Starts the thread. Garbage made so far is frozen: collections would stop the loop for milliseconds."""
        gc.collect()
        gc.freeze()
        gc.disable()
        sys.setswitchinterval(0.0005)  # the status display must not hold the loop for 5 ms
        self._thread.start()

    def stop(self) -> None:
        """Ends the loop after its current step."""
        self._stop.set()
        if self._thread.is_alive():
            self._thread.join(timeout=2.0)
        gc.enable()

    @property
    def running(self) -> bool:
        """Whether steps are being made."""
        return self._thread.is_alive()

    def _run(self) -> None:
        clock, sleep, period = time.monotonic_ns, time.sleep, self._period_ns
        deadline = clock()
        try:
            while not self._stop.is_set():
                now = clock()
                late = now - deadline
                if late < 0:
                    sleep(-late * 1e-9)
                    continue
                self.worst_late_ns = max(self.worst_late_ns, late)
                if late > period:
                    self.skipped += late // period
                    deadline = now
                deadline += period
                self._step(now)
        except BaseException as error:
            self.error = error
