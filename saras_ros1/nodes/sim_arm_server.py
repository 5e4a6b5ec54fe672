"""The simulated arm's server under roslaunch. It is no ROS node: it has the arm's wire and nothing else."""

from __future__ import annotations

import sys

import rospy

from saras.mesa_link.__main__ import main as serve


def main() -> int:
    """Runs the server with the command line that roslaunch gave, less ROS's own remappings."""
    return serve(rospy.myargv(sys.argv)[1:])
