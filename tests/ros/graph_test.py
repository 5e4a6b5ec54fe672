#!/usr/bin/env python3
"""The graph with real processes and sockets. Test methods run in alphabetical order and build on each other."""

import math
import unittest

import numpy as np
import rosgraph
import rosnode
import rospy
import rostest
from crtk_msgs.msg import OperatingState, StringStamped
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from saras_ros1.msg import ChannelState, TankState
from std_msgs.msg import String
from std_srvs.srv import Trigger
from support import ROOT, FakeConsole, Newest, spawn, wait_until

from saras.net import ChannelState as WireState
from saras.runtime import read_flight, replay_flight
from saras_ros1 import convert

SIDES = ("left", "right")
# What carries a part of the graph, and a topic that it reads, in each hosting.
HOSTS = {"separate": ("touchball_receiver", "tank_slave"), "realtime": ("realtime_host", "realtime_host")}
READ_TOPICS = {
    "separate": ("/transparency/left/desired_twist", TwistStamped, convert.twist_msg, np.full(6, np.nan)),
    "realtime": ("/mesa_left/ee_pose", PoseStamped, convert.pose_msg, np.full((4, 4), np.nan)),
}
TOPICS = {
    "/touchball_{s}/pose": "geometry_msgs/PoseStamped",
    "/touchball_{s}/joint_states": "sensor_msgs/JointState",
    "/touchball_{s}/buttons": "sensor_msgs/Joy",
    "/touchball_{s}/grip": "sensor_msgs/JointState",
    "/touchball_{s}/wrench": "geometry_msgs/WrenchStamped",
    "/tf_transformer_{s}/tracked_pose": "geometry_msgs/PoseStamped",
    "/tf_transformer_{s}/tracked_twist": "geometry_msgs/TwistStamped",
    "/tf_transformer_{s}/tracked_twist_filtered": "geometry_msgs/TwistStamped",
    "/tf_transformer_{s}/handle_twist": "geometry_msgs/TwistStamped",
    "/transparency/{s}/desired_wrench": "geometry_msgs/WrenchStamped",
    "/transparency/{s}/desired_twist": "geometry_msgs/TwistStamped",
    "/tank_master/{s}/wrench": "geometry_msgs/WrenchStamped",
    "/tank_slave/{s}/twist": "geometry_msgs/TwistStamped",
    "/tank_master/exchange": "saras_ros1/TankExchange",
    "/tank_slave/exchange": "saras_ros1/TankExchange",
    "/tank_master/state": "saras_ros1/TankState",
    "/tank_slave/state": "saras_ros1/TankState",
    "/port_guard_{s}/state": "saras_ros1/TankState",
    "/port_guard_{s}/exchange": "saras_ros1/TankExchange",
    "/mesa_{s}/set_point": "geometry_msgs/PoseStamped",
    "/mesa_{s}/tool_command": "sensor_msgs/JointState",
    "/system/{s}/state": "saras_ros1/ChannelState",
    "/system/operating_state": "crtk_msgs/OperatingState",
    "/diagnostics": "diagnostic_msgs/DiagnosticArray",
}


def circle(console):
    """Both hands on a circle of 10 mm, one turn in 3 s: 21 mm/s."""

    def move(t):
        angle = 2.0 * math.pi * t / 3.0
        for side in SIDES:
            console.position[side] = np.array([0.01 * math.cos(angle), 0.01 * math.sin(angle), -0.22])

    return move


class GraphTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("graph_test")
        cls.hosting = rospy.get_param("~hosting", "separate")
        cls.link, cls.laws = HOSTS[cls.hosting]
        cls.console = FakeConsole(rospy.get_param("~bind_port", 28110), rospy.get_param("~console_port", 28111))
        cls.console.motion = circle(cls.console)
        cls.console.start()
        cls.state = {s: Newest(f"/system/{s}/state", ChannelState) for s in SIDES}
        cls.set_point = {s: Newest(f"/mesa_{s}/set_point", PoseStamped) for s in SIDES}
        cls.tip = {s: Newest(f"/mesa_{s}/ee_pose", PoseStamped) for s in SIDES}
        cls.tracked = {s: Newest(f"/tf_transformer_{s}/tracked_pose", PoseStamped) for s in SIDES}
        cls.twist = {s: Newest(f"/tank_slave/{s}/twist", TwistStamped) for s in SIDES}
        cls.wrench = {s: Newest(f"/touchball_{s}/wrench", WrenchStamped) for s in SIDES}
        cls.tank = Newest("/tank_master/state", TankState)
        cls.events = Newest("/system/events", String)
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)
        cls.children = []

    @classmethod
    def tearDownClass(cls):
        cls.console.stop()
        for child in cls.children:
            child.terminate()
            child.wait(timeout=20)

    def await_state(self, side, state):
        wait_until(
            lambda: self.state[side].message is not None and self.state[side].message.state == state,
            lambda: f"{side} in state {state}; last {self.state[side].message}",
        )

    def call(self, side, word):
        return rospy.ServiceProxy(f"/system/{side}/{word}", Trigger)()

    def engage(self, *sides):
        for side in sides:
            wait_until(lambda side=side: self.call(side, "engage").success, f"{side} lets itself be engaged")
            self.await_state(side, ChannelState.ENGAGED)

    def report_of(self, node):
        """The node's next /diagnostics as a dict."""
        count = len(self.diagnostics.all)

        def newer():
            for message in self.diagnostics.all[count:]:
                if message.status[0].name == f"/{node}":
                    return {pair.key: pair.value for pair in message.status[0].values}
            return None

        return wait_until(newer, f"diagnostics of {node}")

    def assert_smooth(self, side, limit_m):
        positions = np.array([convert.pose(m)[:3, 3] for m in self.set_point[side].all])
        self.assertGreater(len(positions), 10)
        steps = np.linalg.norm(np.diff(positions, axis=0), axis=1)
        self.assertLess(steps.max(), limit_m, f"{side}: a set-point step of {steps.max() * 1e3:.2f} mm")

    def test_01_comes_up_ready_and_still(self):
        for side in SIDES:
            self.await_state(side, ChannelState.READY)
            self.assertIsNone(self.set_point[side].message, "a set-point before any engagement")
            np.testing.assert_array_equal(convert.twist(self.twist[side].next()), 0.0)
            np.testing.assert_array_equal(convert.wrench(self.wrench[side].next()), 0.0)
        self.assertAlmostEqual(self.tank.message.energy_J, self.tank.message.minimum_J)

    def test_02_topics_have_their_names_and_types(self):
        types = dict(rosgraph.Master("/graph_test").getTopicTypes())
        wanted = {name.format(s=s): kind for name, kind in TOPICS.items() for s in SIDES}
        self.assertEqual({name: types.get(name) for name in wanted}, wanted)

    def test_03_engaged_arms_follow_the_hands(self):
        self.engage(*SIDES)
        for side in SIDES:
            self.assertEqual(self.state[side].message.engagement, 1)
            self.set_point[side].next("after engagement")
        self.assertGreater(self.tank.next().granted_J, 0.3)
        wait_until(lambda: self.console.down and self.console.down.left.state == WireState.ENGAGED, "console told")
        for side in SIDES:
            self.set_point[side].clear()
        rospy.sleep(4.0)
        for side in SIDES:
            moved = np.ptp([convert.pose(m)[:3, 3] for m in self.set_point[side].all], axis=0)
            self.assertGreater(np.sort(moved)[-2], 0.008, f"{side} moved {moved}: half of 20 mm was due in two axes")
            self.assert_smooth(side, 2e-3)

    def test_04_the_clutch_stops_the_arm_and_releases_without_a_step(self):
        side = "left"
        self.set_point[side].clear()
        self.console.clutch[side] = True
        wait_until(lambda: self.state[side].message.clutch, "clutch in the state")
        rospy.sleep(0.5)
        self.set_point[side].clear()
        rospy.sleep(0.7)
        still = np.ptp([convert.pose(m)[:3, 3] for m in self.set_point[side].all], axis=0)
        self.assertLess(still.max(), 1e-4, "the set-point moved under clutch")
        self.console.clutch[side] = False
        wait_until(lambda: not self.state[side].message.clutch, "clutch released")
        rospy.sleep(1.0)
        self.assert_smooth(side, 2e-3)
        self.assertEqual(self.state[side].message.state, ChannelState.ENGAGED)

    def test_05_bad_datagrams_are_counted_and_change_nothing(self):
        before = self.report_of(self.link)
        good = self.console.packet().encode()
        self.console.send_raw(good)
        for bad in (good, good[:-1], good + b"x", b"", good[:200] + bytes([good[200] ^ 255]) + good[201:]):
            self.console.send_raw(bad)
        # the x of the left handle, byte by byte, as NaN: whatever its offset, the checksum or the value refuses it
        old = self.console.packet()
        old.session -= 1
        self.console.send_raw(old.encode())
        after = wait_until(
            lambda: (lambda r: r if int(r["old_session"]) > int(before["old_session"]) else None)(
                self.report_of(self.link)
            ),
            "old session counted",
        )
        self.assertGreaterEqual(int(after["malformed"]), int(before["malformed"]) + 4)
        self.assertGreaterEqual(
            int(after["duplicate"]) + int(after["out_of_order"]),
            int(before["duplicate"]) + int(before["out_of_order"]) + 1,
        )
        for side in SIDES:
            self.assertEqual(self.state[side].message.state, ChannelState.ENGAGED)

    def test_06_a_message_with_nan_is_refused_and_does_not_feed_the_watchdog(self):
        topic, message_class, write, values = READ_TOPICS[self.hosting]
        publisher = rospy.Publisher(topic, message_class, queue_size=1)
        wait_until(lambda: publisher.get_num_connections() > 0, f"{self.laws} listens")
        before = self.report_of(self.laws)[topic]
        publisher.publish(write(values, "mesa_left/sbs_world", rospy.Time.now()))
        refused = wait_until(
            lambda: (lambda r: r if "rejected=0" not in r else None)(self.report_of(self.laws)[topic]),
            "refusal counted",
        )
        self.assertIn("rejected=0", before)
        self.assertIn("rejected=1", refused)
        self.assertTrue(np.isfinite(convert.twist(self.twist["left"].next())).all())
        publisher.unregister()

    def test_07_one_dead_arm_holds_its_side_alone(self):
        rosnode.kill_nodes(["/fake_arm_right"])
        self.await_state("right", ChannelState.HOLD)
        self.assertIn("arm state", self.state["right"].message.reason)
        self.assertTrue(self.state["right"].message.advice)
        wait_until(lambda: any("right: HOLD" in m.data for m in self.events.all), "an event")
        self.set_point["left"].clear()
        rospy.sleep(2.0)
        self.assertEqual(self.state["left"].message.state, ChannelState.ENGAGED)
        moved = np.ptp([convert.pose(m)[:3, 3] for m in self.set_point["left"].all], axis=0)
        self.assertGreater(moved.max(), 0.004, "the left arm stopped with the right one")
        np.testing.assert_array_equal(convert.twist(self.twist["right"].next()), 0.0)
        refused = self.call("right", "engage")
        self.assertFalse(refused.success)
        self.assertIn("arm state", refused.message)

    def test_08_hold_stays_until_engaged_again(self):
        self.children.append(spawn(ROOT / "tests" / "fakes" / "fake_arm", "right"))
        tip = self.tip["right"].next("of the new arm")
        rospy.sleep(0.5)
        self.assertEqual(self.state["right"].message.state, ChannelState.HOLD)
        self.set_point["right"].clear()
        self.engage("right")
        self.assertEqual(self.state["right"].message.engagement, 2)
        wait_until(lambda: self.set_point["right"].all, "set-points of the new engagement")
        first = convert.pose(self.set_point["right"].all[-1])[:3, 3]
        self.assertLess(np.linalg.norm(first - convert.pose(tip)[:3, 3]), 0.02, "it begins where the arm is")

    def test_09_a_dead_console_holds_both_sides_and_the_force_fades(self):
        self.console.sending = False
        for side in SIDES:
            self.await_state(side, ChannelState.HOLD)
            self.assertIn("console data", self.state[side].message.reason)
        rospy.sleep(1.0)
        for side in SIDES:
            np.testing.assert_array_equal(convert.twist(self.twist[side].next()), 0.0)
            self.set_point[side].clear()
        rospy.sleep(0.5)
        for side in SIDES:
            points = [convert.pose(m)[:3, 3] for m in self.set_point[side].all]
            self.assertLess(np.ptp(points, axis=0).max() if points else 0.0, 1e-9, "the set-point moved on HOLD")
        wait_until(lambda: self.console.down.left.state == WireState.HOLD, "HOLD in the datagrams down")
        np.testing.assert_array_equal(self.console.down.left.touch_wrench, 0.0)

    def test_10_a_restarted_console_needs_an_explicit_engage(self):
        self.console.session += 1
        self.console.seq = 0
        self.console.sending = True
        rospy.sleep(0.5)
        for side in SIDES:
            self.assertEqual(self.state[side].message.state, ChannelState.HOLD)
        self.engage(*SIDES)

    def test_11_the_operator_can_hold_one_side(self):
        self.assertTrue(self.call("left", "hold").success)
        self.await_state("left", ChannelState.HOLD)
        self.assertEqual(self.state["right"].message.state, ChannelState.ENGAGED)
        self.engage("left")

    def await_whole(self, state):
        whole = Newest("/system/operating_state", OperatingState)
        wait_until(lambda: whole.message is not None and whole.message.state == state, f"the whole {state}")

    def test_11a_estop_stops_all_and_reset_alone_never_moves(self):
        self.await_whole("ENABLED")
        self.assertFalse(rospy.ServiceProxy("/system/estop_reset", Trigger)().success)
        self.assertTrue(rospy.ServiceProxy("/system/estop", Trigger)().success)
        for side in SIDES:
            self.await_state(side, ChannelState.HOLD)
            self.assertIn("E-stop", self.state[side].message.reason)
            refused = self.call(side, "engage")
            self.assertFalse(refused.success)
            self.assertIn("E-stop", refused.message)
        self.await_whole("FAULT")
        self.assertTrue(rospy.ServiceProxy("/system/estop_reset", Trigger)().success)
        self.await_whole("PAUSED")
        rospy.sleep(0.5)
        for side in SIDES:
            self.assertEqual(self.state[side].message.state, ChannelState.HOLD)
            np.testing.assert_array_equal(convert.twist(self.twist[side].next()), 0.0)
        self.engage(*SIDES)

    def test_11b_crtk_commands(self):
        command = rospy.Publisher("/system/state_command", StringStamped, queue_size=20)
        wait_until(lambda: command.get_num_connections() > 0, "supervisor listens")
        for word, state in (("pause", "PAUSED"), ("resume", "ENABLED"), ("disable", "DISABLED")):
            command.publish(StringStamped(string=word))
            self.await_whole(state)
        command.publish(StringStamped(string="resume"))
        wait_until(lambda: any("'resume' is invalid" in m.data for m in self.events.all), "the refusal as an event")
        for side in SIDES:
            self.await_state(side, ChannelState.READY)
        command.unregister()  # publishers of one node and topic share their connections, and how these say "latching"
        latched = rospy.Publisher("/system/state_command", StringStamped, queue_size=20, latch=True)
        latched.publish(StringStamped(string="enable"))
        wait_until(lambda: any("latching" in m.data for m in self.events.all), "an old word is refused")
        latched.unregister()
        for side in SIDES:
            self.assertEqual(self.state[side].message.state, ChannelState.READY)
        command = rospy.Publisher("/system/state_command", StringStamped, queue_size=20)
        wait_until(lambda: command.get_num_connections() > 0, "supervisor listens again")
        command.publish(StringStamped(string="enable"))
        for side in SIDES:
            self.await_state(side, ChannelState.ENGAGED)

    def test_11c_a_fault_leaves_a_flight_record_that_replays(self):
        if self.hosting != "realtime":
            self.skipTest("the real-time host's")
        record = wait_until(lambda: [m.data for m in self.events.all if "flight record" in m.data], "a record")[-1]
        replay = replay_flight(read_flight(record.removeprefix("flight record ").split(": ")[0]))
        self.assertGreater(replay.ticks, 100)
        self.assertEqual(replay.exact, replay.ticks)

    def test_12_a_dead_node_in_between_holds(self):
        rosnode.kill_nodes([f"/{self.laws}"])
        for side in SIDES:
            self.await_state(side, ChannelState.HOLD)
            # With the host dies the console's link, which is missed earlier.
            wanted = "tank_slave" if self.hosting == "separate" else "console data"
            self.assertIn(wanted, self.state[side].message.reason)

    def test_13_without_the_supervisor_receivers_hold_by_themselves(self):
        if self.hosting == "realtime":  # comes back by itself, and moves nothing by itself
            self.console.down = None
            wait_until(lambda: self.console.down, "the restarted host")
            self.engage(*SIDES)
            wait_until(lambda: self.console.down.right.state == WireState.ENGAGED, "engaged again")
        rosnode.kill_nodes(["/supervisor"])
        wait_until(lambda: self.console.down.right.state == WireState.HOLD, "HOLD without a supervisor")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "graph", GraphTest)
