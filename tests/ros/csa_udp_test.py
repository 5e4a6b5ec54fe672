#!/usr/bin/env python3
"""csa with its slave elsewhere: both example slaves, killed and frozen. Tests run in the order of their names."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
import unittest
import xmlrpc.client
from pathlib import Path

import numpy as np
import rosgraph
import rospy
import rostest
from crtk_msgs.msg import OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, TwistStamped
from rosgraph_msgs.msg import Log
from saras_ros1.msg import CsaAdmittance, CsaTeleopState
from sensor_msgs.msg import JointState
from std_msgs.msg import String
from std_srvs.srv import SetBool
from support import ROOT, Newest, wait_until

from saras.csa.system import load
from saras_ros1 import convert
from saras_ros1.csa_surgeon import Surgeon

DOWN = np.array([0.0, 0.0, -0.014])
FULL = CsaTeleopState.FULL_CONTACT
SLAVES = ROOT / "examples" / "udp_slave"
SYSTEM = ROOT / "tests" / "ros" / "csa_udp.json"
ADDRESSES = ["--listen", "127.0.0.1:48131", "--platform", "127.0.0.1:48130", "--timeout-s", "1"]


class CsaUdp(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("csa_udp_test")
        cls.scratch = tempfile.TemporaryDirectory()
        program = Path(cls.scratch.name) / "udp_slave"
        subprocess.run(["make", "-s", "-C", str(SLAVES), f"OUT={program}"], check=True)
        cls.commands = {"c": [str(program)], "python": [sys.executable, str(SLAVES / "udp_slave.py")]}
        cls.process = None
        cls.told = Newest("/csa/teleop/state", CsaTeleopState)
        cls.did = Newest("/csa/slave/admittance", CsaAdmittance)
        cls.state = Newest("/REMOTE/operating_state", OperatingState)
        cls.reason = Newest("/REMOTE/hold_reason", String)
        cls.joints = Newest("/REMOTE/measured_js", JointState)
        cls.tip = Newest("/REMOTE/measured_cp", PoseStamped)
        cls.twist = Newest("/REMOTE/measured_cv", TwistStamped)
        cls.state_command = rospy.Publisher("/REMOTE/state_command", StringStamped, queue_size=5)
        cls.teleoperate = rospy.ServiceProxy("/csa/teleop/enable", SetBool)
        cls.log = Newest("/rosout", Log)
        cls.surgeon = Surgeon(load(SYSTEM).setup())
        wait_until(lambda: cls.state.message and cls.state_command.get_num_connections(), "csa_udp_slave")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.surgeon.stop()
        cls.end()
        cls.scratch.cleanup()

    @classmethod
    def begin(cls, kind: str, *more: str) -> None:
        cls.process = subprocess.Popen([*cls.commands[kind], *ADDRESSES, *more])

    @classmethod
    def end(cls, how: int = signal.SIGKILL) -> None:
        if cls.process is not None:
            cls.process.send_signal(signal.SIGCONT)
            cls.process.send_signal(how)
            cls.process.wait(30)
            cls.process = None

    def says(self, state: str, reason: str) -> None:
        wait_until(
            lambda: self.state.message.state == state and self.reason.message.data == reason,
            lambda: f"{state} {reason}: {self.state.message.state} {self.reason.message.data}",
        )

    def rouse(self, command: str) -> None:
        """Repeated: on a busy machine the slave may just then be thought lost."""

        def done() -> bool:
            self.state_command.publish(StringStamped(string=command))
            rospy.sleep(0.2)
            return self.state.message.state == "ENABLED"

        wait_until(done, lambda: f"{command}: {self.state.message.state} {self.reason.message.data}")

    def follows(self, joint: int, by: float) -> None:
        """By hand, without csa: the measured joint goes where servo_jp says."""
        publisher = rospy.Publisher("/REMOTE/servo_jp", JointState, queue_size=1)
        goal = np.array(self.joints.next().position)
        goal[joint] += by

        def there() -> bool:
            if self.reason.message.data == "SLAVE_LOST":  # for a moment, on a busy machine
                self.state_command.publish(StringStamped(string="resume"))
            publisher.publish(JointState(position=goal.tolist()))
            return np.abs(np.array(self.joints.message.position) - goal).max() < 1e-3

        wait_until(there, lambda: f"{self.joints.message.position} {self.reason.message.data}")

    def presses(self) -> None:
        """From above the phantom into full contact, with its force."""

        def kept() -> bool:
            recent = [m.normal_force_N for m in self.did.all[-200:]]
            return len(recent) == 200 and abs(np.mean(recent) - 2.0) < 0.25

        self.surgeon.enable()
        wait_until(lambda: not self.told.message.hold, lambda: self.told.message.reason, 60.0)
        self.surgeon.go(DOWN, 3.0)
        wait_until(lambda: self.told.message.state == FULL, lambda: f"full contact: {self.told.message.reason}")
        self.did.clear()
        wait_until(kept, lambda: f"2 N: {self.did.message.normal_force_N:.2f} N {self.did.message.reason}", 60.0)

    def rests(self) -> None:
        """Teleoperation off: the controller falls silent, which is a hold as well."""
        self.teleoperate(False)
        self.surgeon.go(np.zeros(3), 0.5)

    def test_a_nothing_before_the_slave_is_there(self) -> None:
        self.assertEqual((self.state.message.state, self.reason.message.data), ("DISABLED", "WAITING"))
        self.state_command.publish(StringStamped(string="enable"))
        rospy.sleep(0.3)
        self.assertEqual(self.state.message.state, "DISABLED")
        self.assertIsNone(self.joints.message)

    def test_b_a_slave_with_other_joints_is_refused(self) -> None:
        self.begin("c", "--joints", "7")
        self.says("DISABLED", "JOINTS_DIFFER")
        self.state_command.publish(StringStamped(string="enable"))
        wait_until(lambda: any("it has 7, must be 6" in m.msg for m in list(self.log.all)), "how many")
        wait_until(
            lambda: any("REMOTE says JOINTS_DIFFER" in m.msg for m in list(self.log.all)),
            "csa_slave says why it does not start",
            60.0,
        )
        self.assertEqual(self.state.message.state, "DISABLED")
        self.assertIsNone(self.joints.message)
        self.end()

    def test_c_it_is_a_crtk_arm(self) -> None:
        self.begin("c")
        wait_until(lambda: self.joints.message and self.tip.message and self.twist.message, "the slave's state")
        self.says("DISABLED", "DISABLED")
        stamps = [{m.header.stamp for m in source.all} for source in (self.joints, self.tip, self.twist)]
        self.assertTrue(stamps[0] & stamps[1] & stamps[2])
        start = np.array(self.joints.next().position)
        self.rouse("enable")
        self.says("ENABLED", "OK")
        self.follows(0, 0.05)
        self.says("PAUSED", "SET_POINT_LOST")  # nobody goes on
        self.rouse("resume")
        self.follows(0, -0.05)
        np.testing.assert_allclose(self.joints.next().position, start, atol=1e-3)
        # A set-point that is none is not taken; one far away is a hold.
        self.says("PAUSED", "SET_POINT_LOST")
        self.rouse("resume")
        publisher = rospy.Publisher("/REMOTE/servo_jp", JointState, queue_size=1)
        wait_until(publisher.get_num_connections, "servo_jp")
        publisher.publish(JointState(position=[float("nan")] * 6))
        rospy.sleep(0.2)
        self.says("ENABLED", "OK")
        publisher.publish(JointState(position=(start + 0.5).tolist()))
        self.says("PAUSED", "SET_POINT_REFUSED")
        np.testing.assert_allclose(self.joints.next().position, start, atol=1e-3)

    def test_d_the_whole_loop_and_a_slave_that_freezes(self) -> None:
        self.rouse("resume")
        self.presses()
        self.process.send_signal(signal.SIGSTOP)
        self.says("PAUSED", "SLAVE_LOST")
        wait_until(lambda: "PAUSED (SLAVE_LOST)" in self.told.message.reason, lambda: self.told.message.reason)
        self.assertTrue(self.told.message.hold)
        self.process.send_signal(signal.SIGCONT)
        wait_until(lambda: "says PAUSED" in self.told.message.reason, lambda: self.told.message.reason)
        before = convert.pose(self.tip.next())[:3, 3]
        self.surgeon.go(DOWN + np.array([0.004, 0.0, 0.0]), 0.5)
        np.testing.assert_allclose(convert.pose(self.tip.next())[:3, 3], before, atol=1e-4)  # nothing by itself
        self.surgeon.go(DOWN, 0.5)
        self.rouse("resume")
        wait_until(lambda: not self.told.message.hold, lambda: self.told.message.reason)

    def test_e_a_slave_that_dies_and_another_one(self) -> None:
        self.end()
        self.says("PAUSED", "SLAVE_LOST")
        self.rests()
        self.begin("python")
        self.rouse("resume")
        self.presses()

    def test_f_the_platforms_end_dies(self) -> None:
        """It is started again, DISABLED: the slave stands until it is enabled."""
        before = convert.pose(self.tip.next())[:3, 3]
        node = rosgraph.Master("/csa_udp_test").lookupNode("/csa_udp_slave")
        os.kill(xmlrpc.client.ServerProxy(node).getPid("/csa_udp_test")[2], signal.SIGKILL)
        wait_until(lambda: self.told.message.hold, lambda: self.told.message.reason)
        wait_until(lambda: "DISABLED (DISABLED)" in self.told.message.reason, lambda: self.told.message.reason, 60.0)
        np.testing.assert_allclose(convert.pose(self.tip.next())[:3, 3], before, atol=2e-3)
        self.rouse("enable")
        self.did.clear()
        self.presses()


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "csa_udp", CsaUdp, sys.argv)
