#!/usr/bin/env python3
"""Force from seen contact: rate, age, signs, frames; unknown and saturated mean motion without force."""

from __future__ import annotations

import contextlib
import math
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PointStamped, PoseStamped, Twist, TwistStamped, Vector3, WrenchStamped
from saras_ros1.msg import ChannelState, Contact
from support import Newest, wait_until

from saras_ros1 import convert

BASE = "mesa_left/sbs_world"
CAMERA = "endoscope_left_optical"
TROCAR = (0.18, 0.0, -0.1)
TIP = np.array([0.18, 0.0, -0.2])
STIFFNESS = 300.0
FORCE_SCALE = 0.2


class Peers:
    """stereo_contact at 10 Hz; the hand, the arm and the supervisor at 100 Hz."""

    def __init__(self) -> None:
        self.depth, self.direction, self.frame = 0.004, (0.0, 0.0, 1.0), BASE
        self.sends, self.age_s = True, 0.0
        self.hand_speed = np.array([0.01, 0.0, 0.0])
        self._hand, self._tip, self._engaged_at = np.zeros(3), TIP.copy(), 0
        self._count = self._seq = 0
        turn = np.eye(4)
        turn[:3, :3] = [[1, 0, 0], [0, -1, 0], [0, 0, -1]]  # base_R_camera: looks down
        self._static = tf2_ros.StaticTransformBroadcaster()
        self._static.sendTransform([convert.transform_msg(turn, BASE, CAMERA, rospy.Time.now())])
        self._contact = rospy.Publisher("/contact/left", Contact, queue_size=5)
        stamped = {
            "/tf_transformer_left/tracked_pose": PoseStamped,
            "/tf_transformer_left/tracked_twist": TwistStamped,
            "/tf_transformer_left/tracked_twist_filtered": TwistStamped,
            "/mesa_left/ee_pose": PoseStamped,
        }
        self._out = {topic: rospy.Publisher(topic, kind, queue_size=5) for topic, kind in stamped.items()}
        self._rcm = rospy.Publisher("/mesa_left/rcm", PointStamped, queue_size=1, latch=True)
        self._channel = rospy.Publisher("/system/left/state", ChannelState, queue_size=5)
        message = PointStamped()
        message.header.frame_id = BASE
        message.point.x, message.point.y, message.point.z = TROCAR
        self._rcm.publish(message)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            with contextlib.suppress(rospy.ROSException):  # topics close before this thread ends
                self._publish(rospy.Time.now())
            time.sleep(0.01)

    def _publish(self, now: rospy.Time) -> None:
        self._count += 1
        if self.sends and self._count % 10 == 0:
            message = Contact(depth=self.depth, direction=Vector3(*self.direction))
            message.header.stamp, message.header.frame_id = now - rospy.Duration(self.age_s), self.frame
            self._contact.publish(message)
        self._hand += 0.01 * self.hand_speed
        pose, tip, twist = np.eye(4), np.eye(4), np.concatenate([self.hand_speed, np.zeros(3)])
        pose[:3, 3], tip[:3, 3] = self._hand, self._tip
        self._out["/tf_transformer_left/tracked_pose"].publish(convert.pose_msg(pose, BASE, now))
        for name in ("tracked_twist", "tracked_twist_filtered"):
            self._out[f"/tf_transformer_left/{name}"].publish(convert.twist_msg(twist, BASE, now))
        self._out["/mesa_left/ee_pose"].publish(convert.pose_msg(tip, BASE, now))
        # A node has no part in an engagement that is older than itself: who comes new sees one begin.
        listeners = self._channel.get_num_connections()
        if listeners and not self._engaged_at:
            self._engaged_at = self._count + 50
        engaged = bool(self._engaged_at) and self._count >= self._engaged_at
        self._seq += 1
        state = ChannelState(side="left", state=ChannelState.ENGAGED if engaged else ChannelState.READY)
        state.engagement, state.seq = int(engaged), self._seq
        state.header.stamp = now
        self._channel.publish(state)


def force(message: WrenchStamped) -> np.ndarray:
    return convert.wrench(message)[:3]


class ContactForce(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("contact_test")
        cls.peers = Peers()
        cls.wrench = Newest("/contact_force/left/wrench", WrenchStamped)
        cls.reaction = Newest("/contact_force/left", Twist)
        cls.hand = Newest("/transparency/left/desired_wrench", WrenchStamped)
        cls.twist = Newest("/transparency/left/desired_twist", TwistStamped)

    def setUp(self) -> None:
        peers = self.peers
        peers.depth, peers.direction, peers.frame, peers.sends, peers.age_s = 0.004, (0.0, 0.0, 1.0), BASE, True, 0.0

    def await_force(self, expected: np.ndarray) -> None:
        def there() -> bool:
            message = self.wrench.message
            return message is not None and np.abs(force(message) - expected).max() < 1e-9

        wait_until(there, lambda: f"{expected} on the tissue; last {self.wrench.message}")

    def await_silence(self) -> None:
        """No wrench for longer than a consumer waits, though the node runs."""

        def silent() -> bool:
            self.wrench.clear()
            self.reaction.clear()
            rospy.sleep(0.3)
            return not self.wrench.all and not self.reaction.all

        wait_until(silent, "silence")

    def await_hand(self, felt: bool) -> None:
        def there() -> bool:
            message = self.hand.message
            return message is not None and (np.linalg.norm(force(message)) > 0.05) == felt

        wait_until(there, lambda: f"force on the hand: {felt}; last {self.hand.message}")

    def test_01_the_tool_pushes_in_and_the_tissue_out(self) -> None:
        self.await_force(np.array([0.0, 0.0, -STIFFNESS * 0.004]))
        message = self.reaction.next()
        self.assertAlmostEqual(message.linear.z, STIFFNESS * 0.004, places=9)
        self.assertEqual(self.wrench.message.header.frame_id, BASE)

    def test_02_the_normal_is_turned_into_the_arms_base(self) -> None:
        self.peers.frame, self.peers.direction = CAMERA, (0.0, 1.0, -1.0)
        self.await_force(STIFFNESS * 0.004 * np.array([0.0, 1.0, -1.0]) / math.sqrt(2.0))

    def test_03_many_forces_a_reading_with_the_readings_age(self) -> None:
        self.await_force(np.array([0.0, 0.0, -STIFFNESS * 0.004]))
        self.wrench.clear()
        wait_until(lambda: len(self.wrench.all) > 200, "forces")
        stamps = [message.header.stamp.to_nsec() for message in self.wrench.all]
        per_reading = len(stamps) / len(set(stamps))
        self.assertGreater(per_reading, 2.5, "each reading is held: ten readings a second, sixty forces")
        self.peers.age_s = 0.2
        self.await_force(np.array([0.0, 0.0, -STIFFNESS * 0.004]))
        rospy.sleep(0.5)
        message = self.wrench.next()
        self.assertGreater((rospy.Time.now() - message.header.stamp).to_sec(), 0.19)

    def test_04_a_reading_that_is_too_old_gives_no_force(self) -> None:
        self.peers.age_s = 0.3
        self.await_silence()

    def test_05_out_of_contact_is_a_known_zero(self) -> None:
        self.peers.depth = -0.01
        self.await_force(np.zeros(3))

    def test_06_unknown_is_silent_and_not_zero(self) -> None:
        for depth, direction, frame in (
            (math.nan, (0.0, 0.0, 1.0), BASE),
            (0.004, (0.0, 0.0, 0.0), BASE),
            (0.004, (0.0, math.nan, 1.0), BASE),
            (math.inf, (0.0, 0.0, 1.0), BASE),
            (0.004, (0.0, 0.0, 1.0), "nowhere"),
        ):
            self.setUp()
            self.await_force(np.array([0.0, 0.0, -STIFFNESS * 0.004]))
            self.peers.depth, self.peers.direction, self.peers.frame = depth, direction, frame
            self.await_silence()

    def test_07_the_hand_feels_it_in_position_force(self) -> None:
        self.await_hand(True)
        wait_until(
            lambda: abs(force(self.hand.message)[2] - FORCE_SCALE * STIFFNESS * 0.004) < 1e-6,
            lambda: f"lambda times the reaction; last {self.hand.message}",
        )

    def motion_only(self) -> None:
        """The force fades out and the slave goes on. Row 52 of the fault catalogue."""
        self.await_hand(False)
        self.twist.clear()
        wait_until(lambda: len(self.twist.all) > 30, "twists")
        speeds = [np.linalg.norm(convert.twist(message)[:3]) for message in self.twist.all]
        self.assertGreater(min(speeds), 0.002)
        self.assertLess(np.linalg.norm(force(self.hand.next())), 1e-6)

    def test_08_absent_force_is_motion_only(self) -> None:
        self.await_hand(True)
        self.peers.sends = False
        self.motion_only()
        self.peers.sends = True
        self.await_hand(True)

    def test_09_a_saturated_force_is_motion_only(self) -> None:
        self.await_hand(True)
        self.peers.depth = 0.045  # 13.5 N, beyond force_limit_N
        self.motion_only()
        self.peers.depth = 0.004
        self.await_hand(True)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "contact_force", ContactForce)
