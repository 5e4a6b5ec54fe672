"""The simulated arm's server under roslaunch. It is no ROS node: it has the arm's wire and nothing else."""

from __future__ import annotations

import sys

import rospy

from saras.mesa_link.__main__ import main as serve
from saras.priority import CONTROL, prefer


def main() -> int:
    """Runs the server with the command line that roslaunch gave, less ROS's own remappings."""
    prefer(CONTROL)
    return serve(rospy.myargv(sys.argv)[1:])
