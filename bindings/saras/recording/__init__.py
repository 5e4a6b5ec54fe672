"""Recorded sessions as numpy arrays, read from a ROS 1 bag without ROS.

>>> session = Session.open("session.bag")                   # doctest: +SKIP
>>> pose = session.arm("mesa_left").ee_pose                 # doctest: +SKIP
>>> pose.t.shape, pose.pose.shape                           # doctest: +SKIP
((6000,), (6000, 4, 4))

Times are seconds since the first recorded message. What was not recorded is None, never zeros.
"""

from saras.recording.bag import Topic
from saras.recording.series import JointSeries, PoseSeries, VectorSeries
from saras.recording.session import Arm, Console, Event, Session

__all__ = ["Arm", "Console", "Event", "JointSeries", "PoseSeries", "Session", "Topic", "VectorSeries"]
