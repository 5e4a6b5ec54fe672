"""Who goes first when the processor is short: control before recording and pictures."""

from __future__ import annotations

import os
import sys

CONTROL, DISPLAY = 0, 5


def prefer(niceness: int) -> bool:
    """Sets this process's niceness. False where that is not permitted (raising it needs root or CAP_SYS_NICE)."""
    if sys.platform == "win32":
        return False
    try:
        os.setpriority(os.PRIO_PROCESS, 0, niceness)
    except PermissionError:
        return False
    return True
