#!/usr/bin/env python3
"""The ROS master is frozen, then killed, under a moving platform."""

import os
import signal
import sys
import time

import rospy
import rostest
from std_srvs.srv import Trigger
from support.case import FaultCase
from support.platform import SIDES
from support.waiting import wait_until


class MasterFaults(FaultCase):
    def standing_service(self, name):
        """A service whose connection stands already: rospy asks the master at each call of any other."""
        rospy.wait_for_service(name, 30.0)
        service = rospy.ServiceProxy(name, Trigger, persistent=True)
        return service

    def go_on_without_master(self, row, numbers):
        counts = {}
        marks = {side: self.logs[side].mark() for side in SIDES}
        begin = {side: len(self.logs[side].ticks) for side in SIDES}
        for side in SIDES:
            self.logs[side].await_commands(300, "without a master")
            self.goes_on(side, "without a master")
            self.assertEqual(self.watch.engagement(side), numbers[side])
            ticks = len(self.logs[side].ticks) - begin[side]
            counts[side] = (len(self.logs[side].commands) - marks[side][0], ticks)
        row.saw("; ".join(f"{side}: {n} commands in {t} ticks of the arm" for side, (n, t) in counts.items()))

    def test_46_47_the_master(self):
        self.engage_and_move()
        hold, engage = (self.standing_service(f"/system/right/{word}") for word in ("hold", "engage"))
        self.assertTrue(hold().success)
        wait_until(lambda: engage().success, "the connections stand")
        self.engage_and_move()
        numbers = {side: self.watch.engagement(side) for side in SIDES}
        pid = self.platform.core_pid()
        with self.row(47, "SIGSTOP of the ROS master while both sides move") as row:
            self.platform.freeze(pid)
            self.go_on_without_master(row, numbers)
            event = self.watch.await_event("roscore does not answer", self.events_before)
            self.assertTrue(hold().success)
            done, said = (answer := engage()).success, answer.message
            self.assertFalse(done)
            self.assertIn("roscore", said)
            self.platform.thaw(pid)
            self.watch.await_event("roscore answers again", self.events_before)
            wait_until(lambda: engage().success, "engaged again")
            row.saw(f"event “{event}”; new engagement refused (“{said}”), possible when it answers again")
        self.engage_and_move()
        numbers = {side: self.watch.engagement(side) for side in SIDES}
        with self.row(46, "kill -9 of the ROS master while both sides move") as row:
            os.kill(pid, signal.SIGKILL)
            self.go_on_without_master(row, numbers)
            event = self.watch.await_event("roscore does not answer", self.events_before)
            self.assertTrue(hold().success)
            self.logs["right"].await_still()
            time.sleep(1.0)
            done, said = (answer := engage()).success, answer.message
            self.assertFalse(done)
            self.logs["right"].await_still()
            self.goes_on("left", "the other side")
            row.saw(f"event “{event}”; links go on; new engagement refused (“{said}”)")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "faults_roscore", MasterFaults, sys.argv)
