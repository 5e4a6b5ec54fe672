"""Run inside a graph: waits for what the tests ask, and prints what it saw as JSON.

probe.py diagnostics NAME=WORD…      until each status says its word
probe.py teleoperate                 engages both sides and watches the arms move
probe.py hung_master                 stops roscore's process, and lets it go on when that is shown
"""

import json
import os
import signal
import sys
import time

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from saras_ros1.msg import ChannelState
from std_srvs.srv import Trigger

from saras_ros1.listening_sockets import listening

PATIENCE_S = 180.0
MOVED_M = 0.003


def wait_until(condition):
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end and not rospy.is_shutdown():
        if condition():
            return True
        time.sleep(0.05)
    return False


def watch_diagnostics():
    seen = {}

    def take(message):
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            seen[status.name] = {"level": status.level, "message": status.message, "values": values}

    rospy.Subscriber("/diagnostics", DiagnosticArray, take, queue_size=100)
    return seen


def hung_master():
    seen = watch_diagnostics()
    known = wait_until(lambda: "links:" in seen.get("graph links", {}).get("message", ""))
    master = rosgraph.Master("/probe").getPid()
    os.kill(master, signal.SIGSTOP)
    try:
        shown = known and wait_until(lambda: "roscore does not answer" in seen["graph links"]["message"])
        level = seen["graph links"]["level"]
    finally:
        os.kill(master, signal.SIGCONT)
    recovered = wait_until(lambda: "links:" in seen["graph links"]["message"])
    return {"shown": shown, "level": level, "recovered": recovered}


def diagnostics(wanted):
    seen = watch_diagnostics()
    complete = wait_until(lambda: all(word in json.dumps(seen.get(name, {})) for name, word in wanted.items()))
    return {"complete": complete, "status": seen}


class Side:
    def __init__(self, side):
        self.state, self.low, self.high = None, [1e9] * 3, [-1e9] * 3
        rospy.Subscriber(f"/system/{side}/state", ChannelState, self.on_state, queue_size=1)
        rospy.Subscriber(f"/mesa_{side}/ee_pose", PoseStamped, self.on_pose, queue_size=1)
        self.engage = rospy.ServiceProxy(f"/system/{side}/engage", Trigger)

    def on_state(self, message):
        self.state = message

    def on_pose(self, message):
        place = message.pose.position.x, message.pose.position.y, message.pose.position.z
        self.low, self.high = list(map(min, self.low, place)), list(map(max, self.high, place))

    @property
    def moved(self):
        return max(high - low for low, high in zip(self.low, self.high))

    def try_to_engage(self):
        try:
            return self.state is not None and (self.state.state == ChannelState.ENGAGED or self.engage().success)
        except rospy.ServiceException:
            return False


def teleoperate():
    sides = {name: Side(name) for name in ("left", "right")}
    ready = wait_until(lambda: all(side.state is not None for side in sides.values()))
    engaged = ready and wait_until(lambda: all(side.try_to_engage() for side in sides.values()))
    # A machine under load may make a HOLD of it: engaged again by hand, as an operator would.
    engaged and wait_until(
        lambda: all(side.try_to_engage() for side in sides.values()) and min(s.moved for s in sides.values()) > MOVED_M
    )
    said = {name: None if side.state is None else side.state.reason for name, side in sides.items()}
    return {"engaged": engaged, "moved_m": {name: side.moved for name, side in sides.items()}, "reason": said}


rospy.init_node("probe", anonymous=True)
arguments = sys.argv[2:]
if sys.argv[1] == "teleoperate":
    result = teleoperate()
elif sys.argv[1] == "hung_master":
    result = hung_master()
else:
    result = diagnostics(dict(argument.split("=", 1) for argument in arguments))
result["listening"] = sorted({(each.protocol, each.port) for each in listening()})
print("\n" + json.dumps(result))
