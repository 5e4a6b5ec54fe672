"""How the kernel shares the processors among the graph's many short-lived wake-ups."""

from __future__ import annotations

import contextlib
import os


def wake_without_preempting() -> None:
    """Makes this process, when a message wakes it, let the running one finish its tick (SCHED_BATCH; no privilege).

    A node that sends three messages is otherwise interrupted after each. On two cores that costs more time than the
    laws take; the wait is the rest of one tick, well under a millisecond. For threads that are started afterwards.
    """
    with contextlib.suppress(OSError, AttributeError):  # not Linux, or forbidden: only slower
        os.sched_setscheduler(0, os.SCHED_BATCH, os.sched_param(0))
