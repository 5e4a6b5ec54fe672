#!/usr/bin/env python3
"""The arm's ROS side with real processes and sockets. Tests run in the order of their names: the last ones kill."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
import threading
import time
import unittest
import xmlrpc.client
from pathlib import Path

import numpy as np
import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from saras_ros1.msg import ArmTruth, ChannelState
from saras_ros1.srv import SetMode, SetRcm
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool

from saras.mesa_link import ArmLinkError, SocketIoArmDriver
from saras_ros1 import convert

PATIENCE_S = 20.0  # an upper bound for waiting, never a measure
URL = {"left": "http://127.0.0.1:28320", "right": "http://127.0.0.1:28321"}


def eventually(condition, what: str) -> None:
    end = time.monotonic() + PATIENCE_S
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"never came true: {what}")
        time.sleep(0.01)


class Side:
    """Supervisor and velocity integrator of one side, as far as the arm's nodes see them."""

    def __init__(self, side: str) -> None:
        self.side, self.frame = side, f"mesa_{side}/sbs_world"
        self.state = ChannelState.READY
        self.engagement = 0
        self.goal: np.ndarray | None = None
        self.tip: np.ndarray | None = None
        self.tip_count = 0
        self.path: list[np.ndarray] = []
        self.latest: dict[str, object] = {}
        self._state = rospy.Publisher(f"/system/{side}/state", ChannelState, queue_size=1, latch=True)
        self._set_point = rospy.Publisher(f"/mesa_{side}/set_point", PoseStamped, queue_size=1)
        self.tool_command = rospy.Publisher(f"/mesa_{side}/tool_command", JointState, queue_size=1)
        rospy.Subscriber(f"/mesa_{side}/ee_pose", PoseStamped, self._on_tip, tcp_nodelay=True)
        for name, kind in {
            "operating_state": String,
            "rcm": PointStamped,
            "joint_states": JointState,
            "tool": JointState,
            "measured_cf": WrenchStamped,
            "truth": ArmTruth,
        }.items():
            rospy.Subscriber(f"/mesa_{side}/{name}", kind, lambda m, n=name: self.latest.__setitem__(n, m))
        threading.Thread(target=self._run, daemon=True).start()

    def _on_tip(self, message: PoseStamped) -> None:
        assert message.header.frame_id == self.frame
        self.tip = convert.pose(message)
        self.tip_count += 1
        self.path.append(self.tip[:3, 3].copy())

    def _run(self) -> None:
        set_point = None
        while not rospy.is_shutdown():
            time.sleep(0.01)
            with contextlib.suppress(rospy.ROSException):  # the topics close while the test ends
                set_point = self._publish(set_point)

    def _publish(self, set_point: np.ndarray | None) -> np.ndarray | None:
        now = rospy.Time.now()
        message = ChannelState(side=self.side, state=self.state, engagement=self.engagement)
        message.header.stamp = now
        self._state.publish(message)
        goal = self.goal
        if goal is None or self.tip is None:
            return None
        set_point = self.tip.copy() if set_point is None else set_point
        way = goal[:3, 3] - set_point[:3, 3]
        set_point[:3, 3] += way * min(1.0, 0.0008 / max(1e-12, np.linalg.norm(way)))
        self._set_point.publish(convert.pose_msg(set_point, self.frame, now))
        return set_point

    def engage(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
        """Engaged, towards the measured tip moved by x, y, z [m]."""
        eventually(lambda: self.tip is not None, f"{self.side} tip")
        goal = self.tip.copy()
        goal[:3, 3] += (x, y, z)
        self.engagement += 1
        self.state, self.goal = ChannelState.ENGAGED, goal
        return goal

    def hold(self) -> None:
        self.state, self.goal = ChannelState.HOLD, None

    def at(self, goal: np.ndarray, within: float = 5e-4) -> bool:
        return self.tip is not None and np.linalg.norm(self.tip[:3, 3] - goal[:3, 3]) < within

    def shows(self, word: str) -> bool:
        return "operating_state" in self.latest and self.latest["operating_state"].data == word

    def largest_step(self) -> float:
        return float(np.linalg.norm(np.diff(self.path, axis=0), axis=1).max()) if len(self.path) > 1 else 0.0


def pid_of(node: str) -> int:
    uri = rosgraph.Master("/arms_test").lookupNode(node)
    return int(xmlrpc.client.ServerProxy(uri).getPid("/arms_test")[2])


def sibling(words: str) -> int:
    """The process that this test's roslaunch started with these words in its command line."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            command = (process / "cmdline").read_text().replace("\0", " ")
            parent = int((process / "stat").read_text().rsplit(")", 1)[1].split()[1])
            if words in command and parent == os.getppid():
                return int(process.name)
    raise AssertionError(f"no process with '{words}'")


class Arms(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        cls.sides = {name: Side(name) for name in ("left", "right")}
        for side in cls.sides.values():
            eventually(lambda side=side: side.tip_count > 10 and side.shows("PAUSED"), f"{side.side} arm")

    def setUp(self) -> None:
        for side in self.sides.values():
            side.hold()
        self.left, self.right = self.sides["left"], self.sides["right"]

    def test_a1_what_arm_state_says(self) -> None:
        left = self.left
        eventually(lambda: {"rcm", "joint_states", "tool", "measured_cf", "truth"} <= set(left.latest), "all topics")
        joints = left.latest["joint_states"]
        self.assertEqual(
            joints.name[:2] + joints.name[7:9],
            [
                "mesa_left/passive_1",
                "mesa_left/passive_2",
                "mesa_left/scara_1",
                "mesa_left/scara_2",
            ],
        )
        self.assertEqual(len(joints.position), 13)
        self.assertEqual(left.latest["tool"].name, ["mesa_left/roll", "mesa_left/jaw"])
        self.assertEqual(left.latest["rcm"].header.frame_id, "mesa_left/sbs_world")
        self.assertLess(abs(left.latest["measured_cf"].wrench.force.z), 0.1)
        self.assertLess(left.latest["truth"].depth, 0.0)

    def test_a2_nothing_moves_unless_engaged(self) -> None:
        left = self.left
        start = left.tip.copy()
        left.goal = left.tip.copy()
        left.goal[:3, 3] += (0.01, 0.0, 0.0)
        for state in (ChannelState.WAITING, ChannelState.READY, ChannelState.HOLD):
            left.state = state
            count = left.tip_count
            eventually(lambda count=count: left.tip_count > count + 30, "poses go on")
            self.assertTrue(left.at(start, 1e-4))

    def test_a3_engaged_the_tip_follows_and_the_tool_obeys(self) -> None:
        left, right_start = self.left, self.right.tip.copy()
        left.path.clear()
        goal = left.engage(0.004, 0.006, -0.005)
        command = JointState(name=["mesa_left/roll", "mesa_left/jaw"], position=[0.3, 0.8], velocity=[2.0, 2.0])

        def arrived() -> bool:
            left.tool_command.publish(command)
            return left.at(goal) and np.allclose(left.latest["tool"].position, [0.3, 0.8], atol=0.01)

        eventually(arrived, "tip, roll and jaw at their targets")
        self.assertTrue(left.shows("ENABLED"))
        self.assertLess(left.latest["truth"].rcm_deviation, 1e-4)
        self.assertTrue(self.right.at(right_start, 1e-4))
        left.hold()
        eventually(lambda: left.shows("PAUSED"), "the arm holds")

    def test_a4_pressing_on_the_phantom_is_felt(self) -> None:
        left = self.left
        depth = -left.latest["truth"].depth + 0.006
        left.engage(0.0, 0.0, -depth)
        eventually(lambda: left.latest["truth"].depth > 0.003, "contact")
        time.sleep(1.0)  # the observer's low-pass settles
        truth, felt = left.latest["truth"].tip_force, left.latest["measured_cf"].wrench.force
        self.assertLess(truth.z, -0.5)
        self.assertAlmostEqual(felt.z, truth.z, delta=0.15 + 0.1 * abs(truth.z))
        self.assertGreater(felt.z * truth.z, 0.0)

    def test_a5_jump_of_the_set_point_is_refused(self) -> None:
        left = self.left
        goal = left.engage()
        eventually(lambda: left.shows("ENABLED"), "following")
        left.hold()
        eventually(lambda: left.shows("PAUSED"), "holding")
        start = left.tip.copy()
        far = left.tip.copy()
        far[:3, 3] += (0.05, 0.0, 0.0)
        publisher = rospy.Publisher("/mesa_left/set_point", PoseStamped, queue_size=1)
        left.state, left.engagement = ChannelState.ENGAGED, left.engagement + 1
        for _ in range(50):
            publisher.publish(convert.pose_msg(far, left.frame, rospy.Time.now()))
            wrong = convert.pose_msg(goal, "world", rospy.Time.now())
            publisher.publish(wrong)
            old = convert.pose_msg(goal, left.frame, rospy.Time.now() - rospy.Duration(2.0))
            publisher.publish(old)
            time.sleep(0.01)
        self.assertTrue(left.at(start, 1e-4))

    def test_b1_services_only_at_rest(self) -> None:
        left = self.left
        set_rcm = rospy.ServiceProxy("/mesa_left/set_rcm", SetRcm)
        set_mode = rospy.ServiceProxy("/mesa_left/set_mode", SetMode)
        brake = rospy.ServiceProxy("/mesa_left/brake", SetBool)
        left.engage()
        eventually(lambda: left.shows("ENABLED"), "following")
        answer = set_rcm(left.latest["rcm"])
        self.assertFalse(answer.success)
        self.assertIn("left is engaged: hold it first", answer.message)
        left.hold()
        eventually(lambda: left.shows("PAUSED"), "holding")
        rcm = PointStamped()
        rcm.header.frame_id = "mesa_left/sbs_world"
        rcm.point.x, rcm.point.y, rcm.point.z = 0.18, 0.0, -0.099
        eventually(lambda: set_rcm(rcm).success, "trocar set")
        eventually(lambda: abs(left.latest["rcm"].point.z + 0.099) < 1e-6, "trocar published")
        rcm.header.frame_id = "world"
        self.assertIn("must be 'mesa_left/sbs_world'", set_rcm(rcm).message)
        self.assertIn("expected pivot or parallel", set_mode("free").message)
        self.assertTrue(brake(False).success)
        eventually(lambda: left.shows("DISABLED"), "brakes open")
        self.assertTrue(brake(True).success)
        eventually(lambda: left.shows("PAUSED"), "brakes locked")

    def test_b2_second_controller_is_refused(self) -> None:
        second = SocketIoArmDriver(URL["left"], "intruder")
        try:
            second.connect(PATIENCE_S)
            eventually(lambda: "busy" in second.stats().last_error, "refusal")
            self.assertIn("'/arm_driver_left' is in control", second.stats().last_error)
            self.assertRaises(ArmLinkError, second.command_pose, self.left.tip)
        finally:
            second.close()

    def test_b3_missing_parameters_refuse_the_start(self) -> None:
        for node in ("arm_driver", "arm_state"):
            run = subprocess.run(
                ["rosrun", "saras_ros1", node, "__name:=nobody"],
                capture_output=True,
                text=True,
                timeout=60,
                check=False,
            )
            self.assertEqual(run.returncode, 2, run.stderr)
            self.assertIn("/nobody: no parameters there", run.stderr)

    def inject(self, kind: str, **fields: object) -> None:
        hand = SocketIoArmDriver(URL["left"], "tester", control=False)
        try:
            hand.connect(PATIENCE_S)
            hand.inject(kind, **fields)
        finally:
            hand.close()

    def test_c1_frozen_content_is_a_fault_and_ends(self) -> None:
        for kind in ("frozen", "frozen_tick"):
            self.left.engage(0.001)
            eventually(lambda: self.left.shows("ENABLED"), "following")
            self.inject(kind)
            eventually(lambda: self.left.shows("FAULT"), f"{kind}: fault")
            count, other = self.left.tip_count, self.right.tip_count
            eventually(lambda other=other: self.right.tip_count > other + 20, "the other arm goes on")
            self.assertLessEqual(self.left.tip_count, count + 1)
            self.left.hold()
            self.inject("none")
            eventually(lambda: not self.left.shows("FAULT"), "believed again")

    def test_c2_pose_jump_is_a_fault(self) -> None:
        start = self.left.tip.copy()
        self.left.path.clear()
        self.inject("jump", offset=[0.06, 0.0, 0.0])
        eventually(lambda: self.left.shows("FAULT"), "fault")
        self.assertTrue(self.left.at(start, 1e-3))
        self.assertLess(self.left.largest_step(), 0.05)
        self.inject("none")
        eventually(lambda: self.left.shows("PAUSED"), "believed again")

    def test_d1_frozen_driver_leaves_no_backlog(self) -> None:
        left = self.left
        goal = left.engage(0.0, 0.003, 0.0)
        eventually(lambda: left.at(goal), "following")
        pid = pid_of("/arm_driver_left")
        os.kill(pid, signal.SIGSTOP)
        try:
            eventually(lambda: left.shows("PAUSED"), "the arm holds by its own watchdog")
            left.goal = goal.copy()
            left.goal[:3, 3] += (0.0, 0.006, 0.0)  # set-points that the frozen driver cannot see
            left.path.clear()
            time.sleep(3.0)
            self.assertTrue(left.at(goal, 1e-3))
        finally:
            left.hold()
            time.sleep(0.05)
            os.kill(pid, signal.SIGCONT)
        count = left.tip_count
        eventually(lambda: left.tip_count > count + 100, "a second later")
        self.assertTrue(left.at(goal, 1e-3))

    def test_d2_killed_driver_stops_the_arm(self) -> None:
        left = self.left
        left.engage(0.0, -0.02, 0.0)
        eventually(lambda: left.shows("ENABLED"), "following")
        os.kill(pid_of("/arm_driver_left"), signal.SIGKILL)
        eventually(lambda: left.shows("PAUSED"), "the arm holds")
        count, stopped = left.tip_count, left.tip.copy()
        eventually(lambda: left.tip_count > count + 50, "arm_state goes on")
        self.assertTrue(left.at(stopped, 2e-3))
        # A new driver takes control. It has no part in the engagement that ran before it; the next one starts from the
        # measured pose.
        left.path.clear()
        again = subprocess.Popen(["rosrun", "saras_ros1", "arm_driver", "__name:=arm_driver_left"])
        try:
            count = left.tip_count
            eventually(lambda: self.answers("/mesa_left/brake", "is engaged"), "the new driver answers")
            self.assertGreater(left.tip_count, count)
            self.assertTrue(left.at(stopped, 2e-3))
            left.hold()
            eventually(lambda: self.answers("/mesa_left/brake", "done"), "the new driver sees the HOLD")
            goal = left.engage(0.0, 0.004, 0.0)
            eventually(lambda: left.at(goal), "the new driver's motion")
            self.assertLess(left.largest_step(), 5e-3)
        finally:
            again.terminate()
            again.wait()

    def answers(self, service: str, word: str) -> bool:
        try:
            return word in rospy.ServiceProxy(service, SetBool)(True).message
        except rospy.ServiceException:
            return False

    def test_d3_dead_arm_is_a_fault_and_the_other_goes_on(self) -> None:
        os.kill(sibling("--port 28320"), signal.SIGKILL)
        eventually(lambda: self.left.shows("FAULT"), "fault")
        goal = self.right.engage(0.0, 0.004, 0.0)
        eventually(lambda: self.right.at(goal), "the other arm follows")


if __name__ == "__main__":
    rospy.init_node("arms_test")
    rostest.rosrun("saras_ros1", "arms", Arms, sys.argv)
