"""The simulated arm's server under roslaunch. It is no ROS node: it has the arm's wire and nothing else."""

from __future__ import annotations

import sys

import rospy

from saras.mesa_link.__main__ import main as serve
from saras_ros1.scheduling import wake_without_preempting


def main() -> int:
    """Runs the server with the command line that roslaunch gave, less ROS's own remappings."""
    wake_without_preempting()
    return serve(rospy.myargv(sys.argv)[1:])
