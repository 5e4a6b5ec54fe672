#!/usr/bin/env python3
"""Two operators at two consoles: one holder an arm, hand-over, and an E-stop that no restart resets.

Test methods run in alphabetical order and build on each other.
"""

import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosnode
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from saras_ros1.msg import ChannelState, SideFault, TankExchange
from saras_ros1.srv import OperatorAct
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from support import FakeConsole, Newest, spawn, wait_until

from saras.net import ChannelState as WireState
from saras_ros1 import convert

SIDES = ("left", "right")


class OperatorsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("operators_test")
        cls.directory = tempfile.TemporaryDirectory()
        cls.estop_file = Path(cls.directory.name, "estop")
        cls.assistant, cls.colleague = FakeConsole(28130, 28131), FakeConsole(28132, 28133)
        # Far apart, so that whose hand it is shows.
        for side in SIDES:
            cls.assistant.position[side] = np.array([0.02, 0.0, -0.22])
            cls.colleague.position[side] = np.array([-0.02, 0.0, -0.22])
        cls.assistant.start()
        cls.colleague.start()
        cls.state = {s: Newest(f"/system/{s}/state", ChannelState) for s in SIDES}
        cls.hand = {s: Newest(f"/touchball_{s}/pose", PoseStamped) for s in SIDES}
        cls.set_point = {s: Newest(f"/mesa_{s}/set_point", PoseStamped) for s in SIDES}
        cls.ledger = Newest("/port_guard_left/exchange", TankExchange)
        cls.children = []

    @classmethod
    def tearDownClass(cls):
        cls.assistant.stop()
        cls.colleague.stop()
        for child in cls.children:
            child.terminate()
            child.wait(timeout=20)

    def act(self, operator, act, to="", side="left"):
        answer = rospy.ServiceProxy(f"/system/{side}/operator", OperatorAct)(operator, act, to)
        return answer.success, answer.message

    def must(self, operator, act, to="", side="left"):
        wait_until(
            lambda: self.act(operator, act, to, side)[0], lambda: f"{act} by {operator}: {self.state[side].message}"
        )

    def await_state(self, side, **fields):
        wait_until(
            lambda: (
                self.state[side].message is not None
                and all(getattr(self.state[side].message, name) == value for name, value in fields.items())
            ),
            lambda: f"{side} {fields}; last {self.state[side].message}",
        )

    def await_hand_of(self, console, side="left"):
        wait_until(
            lambda: np.allclose(convert.pose(self.hand[side].next())[:3, 3], console.position[side]), "the hand's pose"
        )

    def test_01_nobody_holds_a_free_arm(self):
        for side in SIDES:
            self.await_state(side, state=ChannelState.WAITING, reason="nobody holds the arm", holder="")
        refused = rospy.ServiceProxy("/system/left/engage", Trigger)()
        self.assertFalse(refused.success)
        self.assertIn("nobody holds", refused.message)

    def test_02_one_claims_and_the_second_is_refused(self):
        self.must("assistant", "claim")
        self.await_state("left", state=ChannelState.READY, holder="assistant")
        self.assertEqual(self.act("colleague", "claim"), (False, "left: claim refused: held by assistant"))
        done, said = self.act("colleague", "engage")
        self.assertFalse(done)
        self.assertIn("assistant does", said)
        self.must("assistant", "engage")
        self.await_state("left", state=ChannelState.ENGAGED, holder="assistant")
        self.await_hand_of(self.assistant)

    def test_03_each_console_is_told_of_its_own_arms_only(self):
        wait_until(lambda: self.assistant.down.left.state == WireState.ENGAGED, "the holder is told")
        self.must("colleague", "claim", side="right")
        self.must("colleague", "engage", side="right")
        wait_until(lambda: self.colleague.down.right.state == WireState.ENGAGED, "the other one too, of the other arm")
        self.assertEqual(self.colleague.down.left.state, WireState.WAITING)
        np.testing.assert_array_equal(self.colleague.down.left.touch_wrench, 0.0)
        self.await_hand_of(self.assistant, "left")
        self.await_hand_of(self.colleague, "right")
        self.assertEqual(self.state["left"].message.state, ChannelState.ENGAGED)

    def test_04_the_one_without_the_arm_moves_nothing(self):
        self.set_point["left"].clear()
        self.colleague.position["left"] = np.array([-0.05, 0.01, -0.2])
        rospy.sleep(1.0)
        points = np.array([convert.pose(m)[:3, 3] for m in self.set_point["left"].all])
        self.assertGreater(len(points), 5)
        self.assertLess(np.ptp(points, axis=0).max(), 1e-4)

    def test_05_handing_over_holds_and_begins_a_new_ledger(self):
        before = self.ledger.next().session
        self.set_point["left"].clear()
        self.must("assistant", "offer", "colleague")
        self.await_state("left", state=ChannelState.ENGAGED, offered_to="colleague")
        self.must("colleague", "accept")
        self.await_state("left", state=ChannelState.HOLD, holder="colleague", offered_to="")
        self.assertIn("handed the arm over", self.state["left"].message.reason)
        self.await_hand_of(self.colleague)
        wait_until(lambda: self.ledger.next().session > before, "a new session of the ledger")
        self.assertFalse(self.act("assistant", "engage")[0])
        self.must("colleague", "engage")
        rospy.sleep(1.0)
        points = np.array([convert.pose(m)[:3, 3] for m in self.set_point["left"].all])
        self.assertLess(np.linalg.norm(np.diff(points, axis=0), axis=1).max(), 1e-3, "a step at the hand-over")

    def test_06_a_silent_holder_leaves_the_arm_to_nobody_and_the_next_claims_it(self):
        self.colleague.sending = False
        self.await_state("left", state=ChannelState.HOLD, holder="")
        self.await_hand_of(self.assistant)
        self.must("assistant", "claim")
        self.must("assistant", "engage")
        self.colleague.sending = True
        rospy.sleep(1.0)
        self.await_state("left", state=ChannelState.ENGAGED, holder="assistant")

    def test_07_a_reported_fault_holds_that_side(self):
        self.must("colleague", "claim", side="right")
        self.must("colleague", "engage", side="right")
        faults = rospy.Publisher("/system/faults", SideFault, queue_size=1)
        wait_until(lambda: faults.get_num_connections() > 0, "the supervisor listens")
        faults.publish(SideFault(side="right", source="test", reason="it smokes", advice="open a window"))
        self.await_state("right", state=ChannelState.HOLD, reason="test: it smokes", advice="open a window")
        self.await_state("left", state=ChannelState.ENGAGED)

    def test_08_a_moving_hand_does_not_engage(self):
        self.must("assistant", "hold")
        fast = [0.0]

        def move(t):
            fast[0] = 0.05 * np.sin(8.0 * t)

        self.assistant.motion = move
        self.assistant.joints = lambda side: (fast[0] * 5.0, 0.0, 0.0, 0.1)
        wait_until(lambda: "hold the hand still" in self.state["left"].message.misaligned, "the advice")
        refusals = [self.act("assistant", "engage")[1] for _ in range(3)]
        self.assistant.motion, self.assistant.joints = None, None
        self.assertTrue(any("hold the hand still" in said for said in refusals), refusals)
        self.must("assistant", "engage")

    def restart_supervisor(self, **changes):
        rosnode.kill_nodes(["/supervisor"])
        for name, value in changes.items():
            rospy.set_param(f"/supervisor/{name}", value)
        count = len(self.state["left"].all)
        self.children.append(spawn("supervisor", "__name:=supervisor"))
        wait_until(lambda: any(m.seq < 40 for m in self.state["left"].all[count:]), "a new supervisor")

    def test_09_an_estop_outlives_its_supervisor(self):
        self.restart_supervisor(estop_file=str(self.estop_file))
        self.assertTrue(rospy.ServiceProxy("/system/estop", Trigger)().success)
        self.await_state("left", state=ChannelState.HOLD, estop=True)
        wait_until(self.estop_file.exists, "the latch")
        self.restart_supervisor(auto_engage=True)
        rospy.sleep(1.0)
        for side in SIDES:
            self.await_state(side, state=ChannelState.HOLD, estop=True, reason="E-stop")
        self.assertFalse(self.act("assistant", "engage")[0])
        self.assertTrue(rospy.ServiceProxy("/system/estop_reset", Trigger)().success)
        self.await_state("left", state=ChannelState.HOLD, estop=False)
        self.assertFalse(self.estop_file.exists())

    def test_10_a_button_that_is_pressed_or_silent_is_an_estop(self):
        self.restart_supervisor(auto_engage=False, estop_button=True, estop_button_limit_s=1.0)
        self.await_state("left", state=ChannelState.HOLD, estop=True, reason="E-stop: nothing from the E-stop button")
        button = rospy.Publisher("/system/estop_button", Bool, queue_size=1)
        level = [False]
        timer = rospy.Timer(rospy.Duration(0.05), lambda _: button.publish(level[0]))
        wait_until(lambda: rospy.ServiceProxy("/system/estop_reset", Trigger)().success, "the reset")
        self.must("assistant", "claim")
        self.must("assistant", "engage")
        level[0] = True
        self.await_state("left", state=ChannelState.HOLD, estop=True, reason="E-stop: the button is pressed")
        refused = rospy.ServiceProxy("/system/estop_reset", Trigger)()
        self.assertFalse(refused.success)
        self.assertIn("pressed", refused.message)
        level[0] = False
        wait_until(lambda: rospy.ServiceProxy("/system/estop_reset", Trigger)().success, "the reset")
        self.await_state("left", state=ChannelState.HOLD, estop=False)
        timer.shutdown()


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "operators", OperatorsTest)
