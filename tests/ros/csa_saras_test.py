#!/usr/bin/env python3
"""The same controllers with a SARAS arm as the slave and a master that takes forces."""

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
from saras.kinematics import mesa
from saras_ros1 import convert
from saras_ros1.csa_surgeon import Surgeon

DOWN = np.array([0.0, 0.0, -0.014])


class CsaSaras(unittest.TestCase):
    def test_force_is_kept_and_the_shaft_passes_the_trocar(self) -> None:
        rospy.init_node("csa_saras_test")
        setup = load(ROOT / "config" / "csa" / "saras.json").setup()
        told, did = Newest("/csa/teleop/state", CsaTeleopState), Newest("/csa/slave/admittance", CsaAdmittance)
        tip = Newest("/SARAS1/measured_cp", PoseStamped)
        surgeon = Surgeon(setup)
        wait_until(lambda: told.message and did.message and tip.message, "the controllers", 60.0)
        surgeon.enable()
        wait_until(lambda: not told.message.hold, lambda: told.message.reason)
        surgeon.go(DOWN, 3.0)
        wait_until(lambda: told.message.state == CsaTeleopState.FULL_CONTACT, "full contact")

        def kept() -> bool:
            recent = [m.normal_force_N for m in did.all[-400:]]
            return len(recent) == 400 and abs(np.mean(recent) - 2.0) < 0.2

        did.clear()
        wait_until(kept, lambda: f"2 N: {did.message.normal_force_N:.2f} N {did.message.reason}")
        self.assertEqual(did.message.fixture, "trocar")
        for message in (tip, did):
            message.clear()
        surgeon.follow(lambda t: DOWN + 0.008 * np.array([math.sin(t), 1.0 - math.cos(t), 0.0]), 6.3)
        poses = np.array([convert.pose(m) for m in tip.all])
        off = np.linalg.norm(np.cross(poses[:, :3, 2], poses[:, :3, 3] - mesa.NOMINAL_RCM), axis=1)
        self.assertLess(off.max(), 0.001)
        moved = np.ptp(poses[:, :2, 3], axis=0)
        self.assertGreater(moved.min(), 0.012)
        self.assertGreater(min(m.normal_force_N for m in did.all), 0.2)
        self.assertFalse(any(m.hold for m in did.all[-50:]), did.message.reason)
        surgeon.go(np.array([0.0, 0.0, 0.016]), 3.0)
        wait_until(lambda: told.message.state == CsaTeleopState.NO_CONTACT, "no contact")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "csa_saras", CsaSaras, sys.argv)
