#!/usr/bin/env python3
"""csa_slave moves a SARAS arm through arm_driver: contact, force, hold while the side is not engaged."""

from __future__ import annotations

import sys
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from saras_ros1.msg import ArmTruth, ChannelState, CsaAdmittance, CsaTeleopState
from support import ROOT, Newest, wait_until

from saras.csa.system import load
from saras_ros1 import convert
from saras_ros1.csa_surgeon import Surgeon

DOWN = np.array([0.0, 0.0, -0.015])


class Supervisor:
    """/system/left/state, as far as the arm's nodes see it."""

    def __init__(self) -> None:
        self.state, self.engagement = ChannelState.READY, 0
        self._out = rospy.Publisher("/system/left/state", ChannelState, queue_size=1, latch=True)
        threading.Thread(target=self._run, daemon=True).start()

    def engage(self) -> None:
        self.engagement += 1
        self.state = ChannelState.ENGAGED

    def _run(self) -> None:
        while not rospy.is_shutdown():
            message = ChannelState(side="left", state=self.state, engagement=self.engagement)
            message.header.stamp = rospy.Time.now()
            self._out.publish(message)
            time.sleep(0.05)


class CsaSarasArm(unittest.TestCase):
    def test_force_is_kept_and_nothing_moves_without_engagement(self) -> None:
        rospy.init_node("csa_saras_arm_test")
        setup = load(ROOT / "config" / "csa" / "saras_arm.json").setup()
        told, did = Newest("/csa/teleop/state", CsaTeleopState), Newest("/csa/slave/admittance", CsaAdmittance)
        tip, truth = Newest("/mesa_left/ee_pose", PoseStamped), Newest("/mesa_left/truth", ArmTruth)
        supervisor, surgeon = Supervisor(), Surgeon(setup)
        wait_until(lambda: told.message and did.message and tip.message, "the controllers", 60.0)
        surgeon.enable()
        wait_until(lambda: "left is not engaged" in told.message.reason, lambda: told.message.reason)
        before = convert.pose(tip.message)[:3, 3]
        surgeon.go(np.array([0.0, 0.0, -0.003]), 1.0)
        np.testing.assert_allclose(convert.pose(tip.next())[:3, 3], before, atol=2e-4)
        surgeon.go(np.zeros(3), 1.0)
        supervisor.engage()
        wait_until(lambda: not told.message.hold, lambda: told.message.reason)
        surgeon.go(DOWN, 4.0)
        wait_until(lambda: told.message.state == CsaTeleopState.FULL_CONTACT, lambda: f"contact {did.message.reason}")

        def kept() -> bool:
            recent = [m.normal_force_N for m in did.all[-200:]]
            return len(recent) == 200 and abs(np.mean(recent) - 1.5) < 0.15 and np.ptp(recent) < 0.6

        did.clear()
        wait_until(kept, lambda: f"1.5 N: {did.message.normal_force_N:.2f} N {did.message.reason}")
        surgeon.go(DOWN + np.array([0.008, 0.006, 0.0]), 3.0)
        wait_until(
            lambda: np.linalg.norm(convert.pose(tip.message)[:2, 3] - before[:2] - [0.008, 0.006]) < 0.001, "across"
        )
        did.clear()
        wait_until(kept, lambda: f"1.5 N: {did.message.normal_force_N:.2f} N {did.message.reason}")
        self.assertLess(max(m.rcm_deviation for m in truth.all[-20:]), 1e-3)
        supervisor.state = ChannelState.HOLD
        wait_until(lambda: told.message.hold and not told.message.enabled, lambda: told.message.reason)
        supervisor.engage()
        wait_until(lambda: told.message.state == CsaTeleopState.FULL_CONTACT and not told.message.hold, "engaged again")
        surgeon.go(DOWN + np.array([0.0, 0.0, 0.03]), 4.0)
        wait_until(lambda: told.message.state == CsaTeleopState.NO_CONTACT, "no contact")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "csa_saras_arm", CsaSarasArm, sys.argv)
