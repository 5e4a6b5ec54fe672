#!/usr/bin/env python3
"""csa with a CRTK arm that has a state machine of its own; the tissue's stiffness is not known to anybody."""

from __future__ import annotations

import math
import sys
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from saras_ros1.msg import CsaAdmittance, CsaTeleopState
from support import ROOT, Newest, wait_until

from saras.csa.system import load
from saras_ros1 import convert
from saras_ros1.csa_surgeon import Surgeon

sys.path.insert(0, str(ROOT / "tests"))
from fakes.crtk_client import Arm

DOWN = np.array([0.0, 0.0, -0.014])
FULL = CsaTeleopState.FULL_CONTACT


class CsaDvrk(unittest.TestCase):
    def test_force_is_kept_and_the_arms_state_is_obeyed(self) -> None:
        rospy.init_node("csa_dvrk_test")
        setup = load(ROOT / "tests" / "ros" / "csa_dvrk.json").setup()
        told, did = Newest("/csa/teleop/state", CsaTeleopState), Newest("/csa/slave/admittance", CsaAdmittance)
        tip = Newest("/PSM1/measured_cp", PoseStamped)
        arm, surgeon = Arm("PSM1", 2.0), Surgeon(setup)
        arm.ral.check_connections(30.0)
        wait_until(lambda: told.message and did.message and tip.message, "the controllers", 60.0)
        self.assertTrue(arm.move_jp(setup.slave_model.home).wait())  # over the phantom
        surgeon.enable()
        wait_until(lambda: not told.message.hold, lambda: told.message.reason)
        surgeon.go(DOWN, 3.0)

        def kept() -> bool:
            recent = [m.normal_force_N for m in did.all[-200:]]
            return len(recent) == 200 and abs(np.mean(recent) - 2.0) < 0.2

        wait_until(lambda: told.message.state == FULL, "full contact")
        wait_until(kept, lambda: f"2 N: {did.message.normal_force_N:.2f} N {did.message.reason}")
        # As long as the stiffness is not known the gain is that of the largest.
        lag = 0.01 + 2.0 / 200.0 + 0.03
        self.assertLessEqual(did.message.admittance_m_Ns, 0.5 / (2000.0 * lag) + 1e-9)
        surgeon.follow(lambda t: DOWN + 0.006 * np.array([math.sin(t), 0.0, 0.0]), 6.3)
        self.assertTrue(arm.disable(10.0))
        wait_until(lambda: "says DISABLED" in told.message.reason, lambda: told.message.reason)
        before = convert.pose(tip.next())[:3, 3]
        surgeon.go(DOWN + np.array([0.005, 0.0, 0.0]), 1.0)
        np.testing.assert_allclose(convert.pose(tip.next())[:3, 3], before, atol=1e-9)
        self.assertTrue(arm.enable(10.0))
        wait_until(lambda: told.message.state == FULL and not told.message.hold, lambda: told.message.reason)
        did.clear()
        wait_until(kept, lambda: f"2 N again: {did.message.normal_force_N:.2f} N {did.message.reason}")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "csa_dvrk", CsaDvrk, sys.argv)
