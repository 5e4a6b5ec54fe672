#!/usr/bin/env python3
"""Two operators with a console program each: one holder an arm, and a console's death is its own arms' only."""

import signal
import sys
import unittest

import rospy
import rostest
from saras_ros1.srv import OperatorAct
from support.case import FaultCase
from support.console import Console
from support.options import HOSTING
from support.platform import SIDES
from support.waiting import wait_until

from saras_ros1.processes import free_ports

FIRST, SECOND = "assistant", "colleague"


class OperatorFaults(FaultCase):
    @classmethod
    def setUpClass(cls):
        if HOSTING == "realtime":
            raise unittest.SkipTest("the real-time host serves one console")
        super().setUpClass()

    @classmethod
    def prepare(cls, platform):
        _, (cls.second_bind, cls.second_listen) = free_ports(udp=2)
        cls.arguments = {**cls.arguments, "second_operator": SECOND}
        platform.params["/touchball_receiver/second_console/bind_port"] = cls.second_bind
        platform.params["/touchball_receiver/second_console/console_port"] = cls.second_listen

    @classmethod
    def start_console(cls):
        super().start_console()
        cls.other = Console(
            cls.platform,
            "--motion",
            "circle",
            "--seed",
            "2",
            name="colleague",
            to=cls.second_bind,
            listen=cls.second_listen,
        )
        cls.other.start()

    def act(self, operator, side, act, to=""):
        answer = rospy.ServiceProxy(f"/system/{side}/operator", OperatorAct)(operator, act, to)
        return answer.success, answer.message

    def must(self, operator, side, *acts):
        for act in acts:
            said = []
            wait_until(
                lambda act=act, said=said: (
                    (answer := self.act(operator, side, act)) and (said.append(answer[1]) or answer[0])
                ),
                lambda act=act, said=said: f"{operator}: {act} {side}: {said[-1:]}",
                90.0,
            )

    def test_44_and_11_two_operators(self):
        self.must(FIRST, "left", "claim", "engage")
        self.must(SECOND, "right", "claim", "engage")
        for side in SIDES:
            self.logs[side].await_motion(2e-3, "engaged by its holder")
        with self.row(
            44, "the second operator claims, engages and disengages the first one's moving arm; a hand-over"
        ) as row:
            refused = {act: self.act(SECOND, "left", act) for act in ("claim", "accept", "engage", "disengage")}
            self.assertFalse(any(done for done, _ in refused.values()), refused)
            self.goes_on("left", "after the refusals")
            self.other.await_shown("left", "WAITING")
            self.console.await_shown("left", "ENGAGED")
            row.saw(f"all refused (“{refused['claim'][1]}”), the arm goes on with its holder")
            self.assertTrue(self.act(FIRST, "left", "offer", SECOND)[0])
            self.must(SECOND, "left", "accept")
            self.watch.await_state("left", "HOLD")
            self.logs["left"].await_still()
            self.assertFalse(self.act(FIRST, "left", "engage")[0])
            self.must(SECOND, "left", "engage")
            self.logs["left"].await_motion(2e-3, "with its new holder")
            row.saw("offered and accepted it holds, then moves with the other hand; the first one is refused")
            self.assertTrue(self.act(SECOND, "left", "offer", FIRST)[0])
            self.must(FIRST, "left", "accept", "engage")
            self.logs["left"].await_motion(2e-3, "back")
        with self.row(11, "kill -9 of the second operator's console; he holds the right arm", "second console") as row:
            number = self.watch.engagement("left")
            self.other.kill(signal.SIGKILL)
            self.await_hold(row, "right", shown=False)
            self.goes_on("left", "the other console")
            self.assertEqual(self.watch.engagement("left"), number)
            self.console.await_shown("left", "ENGAGED")
            row.saw("the first operator's arm goes on")
            self.other.start()
            self.must(SECOND, "right", "claim", "engage")
            self.logs["right"].await_motion(2e-3, "again")
            row.saw("started again, claimed and engaged by hand it moves")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "faults_operators", OperatorFaults, sys.argv)
