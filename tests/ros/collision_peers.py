"""Arms, da Vinci and bones for the collision tests: publishes them all at 50 Hz until told otherwise."""

from __future__ import annotations

import contextlib
import threading
import time

import numpy as np
import rospy
import tf2_ros
from crtk_msgs.msg import OperatingState
from geometry_msgs.msg import PointStamped, PoseStamped, TwistStamped
from saras_ros1.msg import ChannelState
from tf2_msgs.msg import TFMessage

from saras_ros1 import convert

STATIC = ("mesa_left/sbs_world", "mesa_right/sbs_world", "PSM1", "PSM2", "ECM")
TROCARS = {
    "mesa_left": (-0.1, 0.05, 0.2),
    "mesa_right": (-0.1, -0.05, 0.2),
    "PSM1": (0.3, 0.05, 0.2),
    "PSM2": (0.3, -0.05, 0.2),
    "ECM": (0.4, 0.0, 0.2),
}


def at(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = (x, y, z)
    return matrix


class Peers:
    """tips: (3,) in the world by tool; what is not in it is silent. bones: world_T_bones, None: silent."""

    def __init__(self) -> None:
        self.tips = {name: np.array(trocar) - (0.0, 0.0, 0.1) for name, trocar in TROCARS.items()}
        self.bones: np.ndarray | None = None
        self.states = dict.fromkeys(("PSM1", "PSM2", "ECM"), "ENABLED")
        self.twist: np.ndarray | None = None
        self._static = tf2_ros.StaticTransformBroadcaster()
        now = rospy.Time.now()
        self._static.sendTransform(
            [convert.transform_msg(at(*TROCARS.get(frame, (0, 0, 0))), "world", frame, now) for frame in STATIC]
        )
        mesa = ("mesa_left", "mesa_right")
        self._poses = {name: rospy.Publisher(f"/{name}/ee_pose", PoseStamped, queue_size=5) for name in mesa}
        self._poses |= {
            name: rospy.Publisher(f"/{name}/measured_cp", PoseStamped, queue_size=5) for name in ("PSM1", "PSM2", "ECM")
        }
        self._modes = {
            name: rospy.Publisher(f"/{name}/operating_state", OperatingState, queue_size=5) for name in self.states
        }
        self._rcm = {name: rospy.Publisher(f"/{name}/rcm", PointStamped, queue_size=1, latch=True) for name in mesa}
        for name in mesa:
            message = PointStamped()
            message.header.frame_id = f"{name}/sbs_world"
            message.point.x, message.point.y, message.point.z = TROCARS[name]
            self._rcm[name].publish(message)
        self.tf = rospy.Publisher("/tf", TFMessage, queue_size=5)
        self._twist = rospy.Publisher("/tank_slave/left/twist", TwistStamped, queue_size=5)
        self._channel = rospy.Publisher("/system/left/state", ChannelState, queue_size=5)
        rospy.Subscriber("/mesa_left/set_point", PoseStamped, self._follow, queue_size=1)
        self.follows = False
        self._listeners = self._ready_for = self._engagement = 0
        threading.Thread(target=self._run, daemon=True).start()

    def _follow(self, message: PoseStamped) -> None:
        """The left arm is where it is told to be."""
        if self.follows:
            self.tips["mesa_left"] = convert.pose(message)[:3, 3]

    def _run(self) -> None:
        while not rospy.is_shutdown():
            with contextlib.suppress(rospy.ROSException):  # topics close before this thread ends
                self._publish(rospy.Time.now())
            time.sleep(0.02)

    def _publish(self, now: rospy.Time) -> None:
        for name, tip in dict(self.tips).items():
            if name.startswith("mesa"):
                pose, frame = at(*tip), f"{name}/sbs_world"
            else:
                pose, frame = at(*(np.array(tip) - TROCARS[name])), name
            self._poses[name].publish(convert.pose_msg(pose, frame, now))
        for name, state in self.states.items():
            message = OperatingState(state=state, is_homed=True)
            message.header.stamp = now
            self._modes[name].publish(message)
        if self.bones is not None:
            self.tf.publish(TFMessage([convert.transform_msg(self.bones, "world", "bones_marker_frame", now)]))
        # A node has no part in an engagement that is older than itself: who comes new sees one begin.
        listeners = self._channel.get_num_connections()
        if listeners != self._listeners:
            self._listeners, self._ready_for = listeners, 20
            self._engagement += 1
        self._ready_for -= 1
        state = ChannelState.READY if self._ready_for > 0 else ChannelState.ENGAGED
        channel = ChannelState(side="left", state=state, engagement=self._engagement)
        channel.header.stamp = now
        self._channel.publish(channel)
        if self.twist is not None:
            self._twist.publish(convert.twist_msg(self.twist, "mesa_left/sbs_world", now))
