#!/usr/bin/env python3
"""A hand drives its arm into virtual walls. Test methods run in alphabetical order and build on each other."""

import re
import unittest

import numpy as np
import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TransformStamped, WrenchStamped
from saras_ros1.msg import ChannelState, SideFixtures
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from support import FakeConsole, Newest, wait_until

from saras.runtime import read_flight, replay_flight
from saras_ros1 import convert

SIDES = ("left", "right")
START = np.array([0.18, 0.0, -0.18])
HALF_M = 0.002
BEYOND_M = 2e-6  # the law's border and what a message rounds
REST = np.array([0.0, 0.0, -0.22])
LIMITS = {
    "separate": ("/velocity_integrator_left", "limited_by"),
    "realtime": ("/realtime_host", "left_limited_by"),
}


class FixturesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("fixtures_test")
        cls.hosting = rospy.get_param("~hosting", "separate")
        cls.console = FakeConsole(rospy.get_param("~bind_port"), rospy.get_param("~console_port"))
        cls.goal = dict.fromkeys(SIDES, REST)
        cls.console.position = {side: REST.copy() for side in SIDES}
        cls.console.motion = cls.move
        cls.console.start()
        cls.state = {s: Newest(f"/system/{s}/state", ChannelState) for s in SIDES}
        cls.set_point = {s: Newest(f"/mesa_{s}/set_point", PoseStamped) for s in SIDES}
        cls.wrench = {s: Newest(f"/touchball_{s}/wrench", WrenchStamped) for s in SIDES}
        cls.fixtures = Newest("/fixtures/left", SideFixtures)
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)
        cls.switch = rospy.Publisher("/fixtures/enable", Bool, queue_size=1, latch=True)

    @classmethod
    def tearDownClass(cls):
        cls.console.stop()

    @classmethod
    def move(cls, _):
        """Each hand goes to its goal at 30 mm/s."""
        for side in SIDES:
            left = cls.goal[side] - cls.console.position[side]
            cls.console.position[side] = cls.console.position[side] + left * min(
                1.0, 3e-4 / (np.linalg.norm(left) + 1e-9)
            )

    def go(self, offset_m):
        """Both hands, from where they began; waits until they are there."""
        for side in SIDES:
            self.goal[side] = REST + offset_m
        wait_until(lambda: all(np.allclose(self.console.position[s], self.goal[s], atol=1e-5) for s in SIDES), "hands")

    def away(self, side):
        """(3,) set-point from the start."""
        return convert.pose(self.set_point[side].next())[:3, 3] - START

    def fixtures_say(self, condition, what):
        def holds():
            message = self.fixtures.message
            return message if message is not None and condition(message) else None

        return wait_until(holds, lambda: f"{what}; last {self.fixtures.message}")

    def limited_by(self):
        node, key = LIMITS[self.hosting]
        for message in reversed(self.diagnostics.all[-50:]):
            for status in message.status:
                values = {pair.key: pair.value for pair in status.values}
                if status.name == node and key in values:
                    return values[key]
        return ""

    def test_1_it_is_told_before_anybody_moves(self):
        message = self.fixtures_say(lambda m: np.isfinite(m.distance).all(), "distances are known")
        self.assertEqual(message.names, ["cage", "ground"])
        self.assertAlmostEqual(message.distance[0], HALF_M, delta=1e-4)
        self.assertGreater(message.distance[1], 1.0)
        self.assertEqual(message.header.frame_id, "mesa_left/sbs_world")

    def test_2_the_hand_feels_the_wall_and_the_arm_stays_inside(self):
        for side in SIDES:
            wait_until(
                lambda side=side: rospy.ServiceProxy(f"/system/{side}/engage", Trigger)().success, f"{side} engages"
            )
        for side in SIDES:
            self.set_point[side].next("after engagement")
        for offset_m in ([0.03, 0.0, 0.0], [-0.03, 0.02, 0.0], [0.0, -0.03, 0.02]):
            self.go(np.array(offset_m))
            wait_until(
                lambda: np.abs(self.away("left")).max() > HALF_M - 1e-4, lambda: f"at a wall: {self.away('left')}"
            )
            wait_until(lambda: np.linalg.norm(self.away("right")) > 2 * HALF_M, "the side without fixtures goes on")
            self.fixtures_say(
                lambda m: m.status == "LIMITED" and np.linalg.norm(vector(m.force)) > 0.3, "a force is due"
            )
            wait_until(
                lambda: np.linalg.norm(convert.wrench(self.wrench["left"].next())[:3]) > 0.3, "the hand feels a force"
            )
            wait_until(lambda: "fixture" in self.limited_by(), self.limited_by)
        places = np.array([convert.pose(m)[:3, 3] - START for m in self.set_point["left"].all])
        self.assertLessEqual(np.abs(places).max(), HALF_M + BEYOND_M)

    def test_3_switched_off_it_passes_and_switched_on_it_goes_no_further_out(self):
        self.switch.publish(True)
        self.go(np.array([0.02, 0.0, 0.0]))
        self.set_point["left"].clear()
        self.switch.publish(False)
        self.fixtures_say(lambda m: not m.on and m.status == "WAITING" and not vector(m.force).any(), "off")
        wait_until(lambda: np.abs(self.away("left")).max() > 2 * HALF_M, "the arm passes")
        places = np.array([convert.pose(m)[:3, 3] for m in self.set_point["left"].all])
        self.assertLess(np.linalg.norm(np.diff(places, axis=0), axis=1).max(), 5e-3, "no jump")
        self.switch.publish(True)
        self.fixtures_say(lambda m: m.on and m.violation > HALF_M / 2 and m.status == "LIMITED", "outside, and told")
        out = np.abs(self.away("left")).max()
        self.go(np.array([0.04, 0.0, 0.0]))
        self.assertLessEqual(np.abs(self.away("left")).max(), out + 1e-3)
        self.go(np.zeros(3))
        wait_until(lambda: np.abs(self.away("left")).max() < HALF_M, "back inside")

    def test_4_of_walls_nobody_knows_where_the_arm_stands(self):
        self.go(np.zeros(3))
        lost = TransformStamped(child_frame_id="mesa_left/sbs_world")
        lost.header.frame_id, lost.header.stamp = "unknown", rospy.Time.now()
        lost.transform.rotation.w = 1.0
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        broadcaster.sendTransform(lost)
        message = self.fixtures_say(lambda m: m.status == "STALE", "unknown")
        self.assertTrue(np.isnan(message.distance).all())
        self.assertIn("world", message.reason)
        wait_until(lambda: self.state["left"].message.state == ChannelState.HOLD, lambda: self.state["left"].message)
        self.assertIn("virtual walls are unknown", self.state["left"].message.reason)
        self.assertEqual(self.state["right"].message.state, ChannelState.ENGAGED)
        before = self.away("left")
        self.go(np.array([-0.02, 0.0, 0.0]))
        np.testing.assert_allclose(self.away("left"), before, atol=1e-9)
        self.fixtures_say(lambda m: not vector(m.force).any(), "no force from a wall that is nowhere")

    def test_5_the_loops_record_replays_to_the_bit(self):
        if self.hosting != "realtime":
            return
        answer = rospy.ServiceProxy("/realtime_host/write_record", Trigger)()
        self.assertTrue(answer.success, answer.message)
        replay = replay_flight(read_flight(re.search(r"\S+\.flight", answer.message)[0]))
        self.assertGreater(replay.ticks, 100)
        self.assertEqual(replay.exact, replay.ticks)


def vector(message):
    return np.array([message.x, message.y, message.z])


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "fixtures", FixturesTest)
