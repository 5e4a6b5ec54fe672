"""The live status table in a terminal of its own: rosrun saras_ros1 status_table."""

from __future__ import annotations

import sys
import time

import rospy
from rich.console import Console
from rich.live import Live

from saras_ros1.status import Status

TABLE_PERIOD_S = 0.5
LINE_PERIOD_S = 5.0


def main() -> int:
    """Draws until the node is shut down; plain lines when the output is no terminal."""
    rospy.init_node("status_table", anonymous=True)
    status = Status()
    console = Console()
    if not console.is_terminal:
        while not rospy.is_shutdown():
            print(status.line(), flush=True)
            time.sleep(LINE_PERIOD_S)
        return 0
    with Live(status.table(), console=console, auto_refresh=False, screen=True) as live:
        while not rospy.is_shutdown():
            live.update(status.table(), refresh=True)
            time.sleep(TABLE_PERIOD_S)
    return 0


if __name__ == "__main__":
    sys.exit(main())
