#!/usr/bin/env python3
"""The whole platform in one go. Test methods run in alphabetical order and build on each other."""

import os
import re
import signal
import unittest
import xmlrpc.client

import numpy as np
import rosgraph
import rosnode
import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import PoseStamped
from saras_ros1.msg import ArmTruth, ChannelState, CollisionState, TankState
from std_srvs.srv import Trigger
from support import Newest, wait_until

from saras.runtime import read_flight
from saras_ros1 import convert

SIDES = ("left", "right")
NODES = {
    "/frames", "/supervisor", "/tool_command", "/arm_state_left", "/arm_state_right", "/arm_driver_left",
    "/arm_driver_right", "/visualization", "/colliding_regions", "/dvrk_sim",
}  # fmt: skip
HOSTING_NODES = {
    "separate": {
        "/touchball_receiver", "/tf_transformer_left", "/tf_transformer_right", "/transparency", "/tank_master",
        "/tank_slave", "/velocity_integrator_left", "/velocity_integrator_right",
    },
    "realtime": {"/realtime_host"},
}  # fmt: skip
FRAMES = ["sbs_world", "rcm", "tool_tip", "set_point"]


def kill(node):
    """SIGKILL to a ROS node of this machine."""
    uri = rosgraph.Master("/platform_test").lookupNode(node)
    os.kill(xmlrpc.client.ServerProxy(uri).getPid("/platform_test")[2], signal.SIGKILL)


class PlatformTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("platform_test")
        cls.hosting = rospy.get_param("~hosting", "separate")
        cls.nodes = NODES | HOSTING_NODES[cls.hosting]
        cls.state = {s: Newest(f"/system/{s}/state", ChannelState) for s in SIDES}
        cls.set_point = {s: Newest(f"/mesa_{s}/set_point", PoseStamped) for s in SIDES}
        cls.tip = {s: Newest(f"/mesa_{s}/ee_pose", PoseStamped) for s in SIDES}
        cls.truth = {s: Newest(f"/mesa_{s}/truth", ArmTruth) for s in SIDES}
        cls.guard = {s: Newest(f"/port_guard_{s}/state", TankState) for s in SIDES}
        cls.distances = Newest("/collision/state", CollisionState)
        cls.buffer = tf2_ros.Buffer()
        cls.listener = tf2_ros.TransformListener(cls.buffer)

    def await_state(self, side, state, patience_s=60.0):
        wait_until(
            lambda: self.state[side].message is not None and self.state[side].message.state == state,
            lambda: f"{side} in state {state}; last {self.state[side].message}",
            patience_s,
        )

    def test_1_all_nodes_come_up_and_both_sides_engage(self):
        wait_until(
            lambda: set(rosnode.get_node_names()) >= self.nodes, lambda: self.nodes - set(rosnode.get_node_names())
        )
        for side in SIDES:
            self.await_state(side, ChannelState.READY)
            engage = rospy.ServiceProxy(f"/system/{side}/engage", Trigger)
            wait_until(lambda engage=engage: engage().success, f"{side} lets itself be engaged")
            self.await_state(side, ChannelState.ENGAGED)

    def test_2_tips_follow_and_the_trocars_stay(self):
        for side in SIDES:
            self.set_point[side].next("after engagement")
        rospy.sleep(8.0)
        for side in SIDES:
            moved = np.ptp([convert.pose(m)[:3, 3] for m in self.tip[side].all[-400:]], axis=0)
            self.assertGreater(moved.max(), 0.005, f"{side} tip moved {moved}")
            self.assertLess(max(m.rcm_deviation for m in self.truth[side].all), 1e-4)
            guard = self.guard[side].next()
            # Topped up to its charge at engagement, whatever its damping had taken in before.
            self.assertGreater(guard.granted_J, 2.0 * guard.minimum_J)

    def test_3_frames_make_one_tree(self):
        for side in SIDES:
            for frame in FRAMES:
                name = f"mesa_{side}/{frame}"
                wait_until(lambda name=name: self.buffer.can_transform("world", name, rospy.Time(0)), f"world ← {name}")
            handle = f"touchball_{side}/handle"
            wait_until(lambda name=handle: self.buffer.can_transform("world", name, rospy.Time(0)), handle)

    def test_3b_all_distances_are_known(self):
        def known():
            message = self.distances.message
            return message and len(message.tools) == 5 and all(tool.state != tool.UNKNOWN for tool in message.tools)

        wait_until(known, lambda: self.distances.message)
        for name in ("PSM1_tool_tip", "PSM2_tool_tip", "ECM_tool_tip"):
            wait_until(lambda name=name: self.buffer.can_transform("world", name, rospy.Time(0)), f"world ← {name}")

    def test_3c_the_loop_knows_the_same_distances(self):
        if self.hosting != "realtime":
            return
        write = rospy.ServiceProxy("/realtime_host/write_record", Trigger)
        seen = len(self.distances.all)
        answer = write()
        self.assertTrue(answer.success, answer.message)
        record = read_flight(re.search(r"\S+\.flight", answer.message)[0])
        last = record.ticks(record.chunks - 1)[-1].output
        nearby = self.distances.all[max(0, seen - 20) : len(self.distances.all) + 20]
        for side in SIDES:
            loop_m = getattr(last, side).nearness.distance_m
            theirs = [tool.known_distance for m in nearby for tool in m.tools if tool.name == f"mesa_{side}"]
            # The tools move at some cm/s, and the record's last step is between two messages.
            self.assertLess(min(abs(loop_m - each) for each in theirs), 3e-3, (side, loop_m, theirs))

    def test_4_a_killed_arm_holds_its_side_alone(self):
        kill("/arm_state_right")
        self.await_state("right", ChannelState.HOLD)
        self.assertIn("arm state", self.state["right"].message.reason)
        self.assertEqual(self.state["left"].message.state, ChannelState.ENGAGED)
        self.set_point["left"].next("the left side goes on")
        # Nobody knows where the right tool is: no other one is clear any more.
        wait_until(lambda: all(t.state != t.CLEAR for t in self.distances.message.tools), self.distances.message)

    def test_5_a_silent_link_holds(self):
        kill("/touchball_receiver" if self.hosting == "separate" else "/realtime_host")
        self.await_state("left", ChannelState.HOLD)
        self.assertIn("console data", self.state["left"].message.reason)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "platform", PlatformTest)
