#!/usr/bin/env python3
"""Complementary situational awareness with real processes. Tests run in the order of their names."""

from __future__ import annotations

import json
import math
import os
import signal
import sys
import tempfile
import unittest
import xmlrpc.client
from pathlib import Path

import numpy as np
import rosgraph
import rospy
import rostest
from geometry_msgs.msg import Point32, PointStamped, PolygonStamped, PoseStamped, WrenchStamped
from saras_ros1.msg import CsaAdmittance, CsaPrimitive, CsaTeleopState
from saras_ros1.srv import SetGains, SetPrimitive
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty
from std_srvs.srv import SetBool
from support import ROOT, Newest, spawn, wait_until

from saras.csa.system import load
from saras_ros1 import convert
from saras_ros1.csa_surgeon import Surgeon

SYSTEM = ROOT / "config" / "csa" / "demo.json"
FULL = CsaTeleopState.FULL_CONTACT
DOWN = np.array([0.0, 0.0, -0.014])  # 7 mm into the model
SIDE = np.array([1.0, 0.0, 0.0])


def pid_of(node: str) -> int:
    return xmlrpc.client.ServerProxy(rosgraph.Master("/csa_test").lookupNode(node)).getPid("/csa_test")[2]


class Csa(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("csa_test")
        cls.setup = load(SYSTEM).setup()
        cls.told = Newest("/csa/teleop/state", CsaTeleopState)
        cls.did = Newest("/csa/slave/admittance", CsaAdmittance)
        cls.command = Newest("/PSM1/servo_jp", JointState)
        cls.torques, cls.held = Newest("/MTML/servo_jf", JointState), Newest("/MTML/hold", Empty)
        cls.tip = Newest("/csa/slave/measured_cp", PoseStamped)
        cls.set_point = Newest("/csa/slave/setpoint_cp", PoseStamped)
        cls.proxy = Newest("/csa/proxy/measured_cp", PoseStamped)
        cls.hand = Newest("/csa/master/servo_cf", WrenchStamped)
        cls.surgeon = Surgeon(cls.setup)
        wait_until(lambda: cls.told.message and cls.did.message, "the controllers", 60.0)

    def state(self) -> str:
        told, did = self.told.message, self.did.message
        slave = f"slave {did.hold} {did.reason!r} {did.normal_force_N:.2f} N"
        return f"state {told.state} hold {told.hold} {told.reason!r}; {slave}"

    def reach(self, state: int, what: str = "") -> None:
        wait_until(
            lambda: self.told.message.state == state and not self.told.message.hold, lambda: f"{what}: {self.state()}"
        )

    def holds_because(self, word: str) -> None:
        wait_until(
            lambda: self.told.message.hold and word in self.told.message.reason, lambda: f"{word}: {self.state()}"
        )

    def force_settles(self, newton: float) -> None:
        """The mean over a palpation comes to the force that is asked for."""

        def kept() -> bool:
            recent = [m.normal_force_N for m in self.did.all[-400:]]
            return len(recent) == 400 and abs(np.mean(recent) - newton) < 0.1 * newton

        self.did.clear()
        wait_until(kept, lambda: f"{newton} N: {self.state()}")

    def position(self, source: Newest) -> np.ndarray:
        return convert.pose(source.message)[:3, 3] - self.setup.start()

    # ---- the experiment

    def test_a1_nobody_moves_before_it_is_enabled(self) -> None:
        self.holds_because("not enabled")
        self.assertFalse(self.told.message.enabled)
        self.assertEqual(self.command.all, [])
        self.assertEqual(self.torques.all, [])  # an arm without torque would fall
        rospy.wait_for_service("/csa/teleop/enable")
        rospy.ServiceProxy("/csa/teleop/enable", SetBool)(True)
        self.holds_because("operator not present")
        self.surgeon.press("present", 1)
        self.reach(CsaTeleopState.NO_CONTACT)

    def test_a2_contact_states_pass_and_the_force_is_kept(self) -> None:
        self.told.clear()
        self.surgeon.go(DOWN, 3.0)
        self.reach(FULL, "down")
        states = [m.state for m in self.told.all]
        self.assertEqual(states[0], CsaTeleopState.NO_CONTACT)
        passed = [s for i, s in enumerate(states) if i == 0 or s != states[i - 1]]
        self.assertIn(CsaTeleopState.PROXY_CONTACT, passed)  # the model is above the phantom
        self.force_settles(2.0)
        wait_until(lambda: convert.wrench(self.hand.message)[2] > 0.5, "a force on the hand, upwards")
        self.assertEqual(self.did.message.fixture, "")

    def test_a3_sideways_the_force_is_kept_and_palpation_goes_on(self) -> None:
        self.did.clear()
        self.surgeon.follow(lambda t: DOWN + 0.008 * math.sin(2.0 * math.pi * t / 6.0) * SIDE, 9.0)
        forces = np.array([m.normal_force_N for m in self.did.all])
        desired = np.array([m.desired_force_N for m in self.did.all])
        self.assertGreater(forces.min(), 0.2)  # never let go
        self.assertLess(forces.max(), 4.5)
        self.assertLess(np.nanmin(desired), 1.6)
        self.assertGreater(np.nanmax(desired), 2.4)
        self.assertLessEqual(max(m.joint_speed_share for m in self.did.all), 1.0 + 1e-9)
        self.surgeon.go(DOWN, 1.5)
        self.reach(FULL)

    def test_a4_primitive_and_gains_by_service(self) -> None:
        set_primitive = rospy.ServiceProxy("/csa/teleop/set_primitive", SetPrimitive)
        teleop = rospy.ServiceProxy("/csa/teleop/set_gains", SetGains)
        slave = rospy.ServiceProxy("/csa/slave/set_gains", SetGains)
        primitive = Newest("/csa/teleop/primitive", CsaPrimitive)
        for refused, words in (
            (set_primitive("rub", 1.0, 1.0), ("kind = 'rub'", "none, force, motion")),
            (set_primitive("force", -1.0, 1.0), ("amplitude = -1",)),
            (set_primitive("force", math.nan, 1.0), ("amplitude = nan",)),
            (set_primitive("motion", 0.001, 0.0), ("frequency_hz = 0",)),
            (teleop(["desired_force_N"], [9.0]), ("desired_force_N = 9",)),
            (teleop(["colour"], [1.0]), ("colour: must be one of",)),
            (teleop(["scale", "scale"], [1.0]), ("as many",)),
            (slave(["admittance_m_Ns"], [math.inf]), ("must be finite",)),
            (slave(["admittance_m_Ns"], [-1.0]), ("admittance_m_Ns = -1",)),
            (slave(["admittance_m_Ns"], [0.05]), ("admittance_m_Ns = 0.05", "damping_max_N_s_m = 42")),
        ):
            self.assertFalse(refused.success)
            for word in words:
                self.assertIn(word, refused.message)
        self.assertTrue(set_primitive("none", 0.0, 1.0).success)
        wait_until(lambda: primitive.message and primitive.message.kind == "none", "the primitive")
        said = teleop(["desired_force_N"], [1.5])
        self.assertTrue(said.success, said.message)
        self.assertTrue(slave(["approach_speed_m_s"], [0.02]).success)
        self.force_settles(1.5)
        self.assertTrue(teleop(["desired_force_N"], [2.0]).success)
        self.assertTrue(set_primitive("motion", 0.001, 1.0).success)
        wait_until(lambda: math.isnan(self.did.message.desired_force_N), "position instead of force along the normal")
        self.assertTrue(set_primitive("force", 0.5, 0.3).success)
        self.force_settles(2.0)

    def test_a5_a_picked_region_holds_the_tip_inside(self) -> None:
        region, border = Newest("/csa/modeler/roi", PolygonStamped), Newest("/csa/master/border", WrenchStamped)
        size = 0.006
        for x, y in ((-size, -size), (size, -size), (size, size), (-size, size), (-size, -size)):
            self.surgeon.go(DOWN + np.array([x, y, 0.0]), 1.5)
            there = [x, y]
            wait_until(lambda there=there: np.abs(self.position(self.tip)[:2] - there).max() < 0.001, "the corner")
            self.surgeon.click("pick")
        wait_until(lambda: region.message and len(region.message.polygon.points) == 4, "the region")
        wait_until(lambda: self.did.message.fixture == "region_of_interest", "the fixture")
        self.tip.clear()
        self.surgeon.follow(lambda t: DOWN + 0.014 * np.array([math.sin(1.5 * t), math.sin(1.0 * t), 0.0]), 12.0)
        tips = np.array([convert.pose(m)[:2, 3] for m in self.tip.all]) - self.setup.start()[:2]
        self.assertLess(np.abs(tips).max(), size + 0.0015)  # corners were picked to a millimetre
        self.assertGreater(np.abs(tips).max(), size - 0.0015)
        self.surgeon.go(DOWN + 0.02 * SIDE, 2.0)
        wait_until(
            lambda: self.position(self.proxy)[0] > size + 0.003,
            lambda: f"the proxy goes on: {self.position(self.proxy)}, {convert.wrench(self.hand.message)}",
        )
        wait_until(
            lambda: convert.wrench(self.hand.message)[0] < -0.5, lambda: f"felt: {convert.wrench(self.hand.message)}"
        )
        self.hand.clear()
        self.surgeon.go(DOWN, 2.0)
        wait_until(lambda: not convert.wrench(border.next()).any(), "nothing of it inside")
        wrenches = np.array([convert.wrench(m)[:3] for m in self.hand.all])
        self.assertLess(wrenches[:, 0].max(), 0.3)  # it never pulls outwards: what is left is the model's
        self.surgeon.press("pick", 2)
        wait_until(lambda: not region.message.polygon.points, "no region")
        wait_until(lambda: self.did.message.fixture == "", "no fixture")
        self.surgeon.press("pick", 0)

    def test_a6_the_tip_goes_where_the_modeler_wants_to_touch(self) -> None:
        publisher = rospy.Publisher("/csa/modeler/next_location", PointStamped, queue_size=1, latch=True)
        spot = PointStamped()
        spot.header.frame_id = "PSM1"
        at = self.setup.start() + np.array([-0.006, 0.004, -0.008])
        spot.point.x, spot.point.y, spot.point.z = at.tolist()
        publisher.publish(spot)
        set_exploring = rospy.ServiceProxy("/csa/teleop/set_exploring", SetBool)
        before = self.position(self.tip)[:2]
        set_exploring(True)
        wait_until(lambda: np.linalg.norm(self.position(self.tip)[:2] - [-0.006, 0.004]) < 0.0008, "the spot")
        self.assertEqual(self.told.message.state, FULL)
        set_exploring(False)
        wait_until(lambda: np.linalg.norm(self.position(self.tip)[:2] - before) < 0.0008, "where the hand is")

    def test_a7_under_the_clutch_the_hand_moves_alone(self) -> None:
        self.reach(FULL)
        self.surgeon.press("clutch", 1)
        wait_until(lambda: not convert.wrench(self.hand.next())[:3].any(), "no force on the hand")
        self.tip.clear()
        self.surgeon.go(DOWN + np.array([0.005, 0.005, 0.003]), 1.5)
        tips = np.array([convert.pose(m)[:2, 3] for m in self.tip.all])
        self.assertLess(np.ptp(tips, axis=0).max(), 0.0008)
        self.set_point.clear()
        self.surgeon.press("clutch", 0)
        wait_until(lambda: len(self.set_point.all) > 100, "set-points")
        path = np.array([convert.pose(m)[:3, 3] for m in self.set_point.all])
        self.assertLess(np.linalg.norm(np.diff(path, axis=0), axis=1).max(), 0.003)
        self.assertEqual(self.told.message.state, FULL)

    # ---- what goes wrong

    def test_b1_a_killed_force_source_is_a_hold_and_recovers(self) -> None:
        self.reach(FULL)
        os.kill(pid_of("/csa_phantom"), signal.SIGKILL)
        self.holds_because("FORCE_UNKNOWN")
        self.set_point.clear()
        wait_until(lambda: len(self.set_point.all) > 20, "set-points")
        held = np.array([convert.pose(m)[:3, 3] for m in self.set_point.all[5:20]])
        self.assertEqual(np.ptp(held, axis=0).max(), 0.0)
        wait_until(lambda: np.linalg.norm(convert.wrench(self.hand.message)[:3]) == 0.0, "no force on the hand")
        self.set_point.clear()
        self.reach(FULL, "after the force came back")
        self.force_settles(2.0)
        path = np.array([convert.pose(m)[:3, 3] for m in self.set_point.all])
        self.assertLess(np.linalg.norm(np.diff(path, axis=0), axis=1).max(), 0.003)

    def test_b2_a_killed_master_is_a_hold_and_recovers(self) -> None:
        os.kill(pid_of("/csa_master"), signal.SIGKILL)
        self.holds_because("STALE: nothing from /csa/master/measured_cp")
        self.reach(FULL, "after csa_master came back")

    def test_b3_a_killed_proxy_is_a_hold_and_recovers(self) -> None:
        os.kill(pid_of("/csa_proxy"), signal.SIGKILL)
        self.holds_because("MODEL_UNKNOWN")
        self.reach(FULL, "after csa_proxy came back")

    def test_b4_the_operator_leaves(self) -> None:
        self.held.clear()
        self.surgeon.press("present", 0)
        self.holds_because("operator not present")
        self.assertFalse(self.told.message.enabled)
        wait_until(lambda: self.held.all, "the master is told to hold")
        self.torques.clear()
        self.tip.clear()
        wait_until(lambda: len(self.tip.all) > 30, "the slave")
        self.assertEqual(self.torques.all, [])
        self.surgeon.press("present", 1)
        self.reach(FULL, "after the operator came back")

    def test_b5_a_killed_teleop_is_a_hold_until_it_is_enabled_again(self) -> None:
        self.reach(FULL)
        region = rospy.Publisher("/csa/modeler/roi", PolygonStamped, queue_size=1, latch=True)
        message = PolygonStamped()
        message.header.frame_id = "PSM1"
        centre = convert.pose(self.tip.message)[:3, 3]
        corners = [centre + np.array([x, y, 0.0]) for x, y in ((-0.02, -0.02), (0.02, -0.02), (0.0, 0.02))]
        message.polygon.points = [Point32(*corner.tolist()) for corner in corners]
        region.publish(message)
        wait_until(lambda: self.did.message.fixture == "region_of_interest", "a region older than csa_teleop")
        for heard in (self.held, self.did, self.set_point, self.told):
            heard.clear()
        os.kill(pid_of("/csa_teleop"), signal.SIGKILL)
        wait_until(lambda: any(m.hold and m.reason == "STALE" for m in list(self.did.all)), "the slave's hold")
        wait_until(lambda: self.held.all, "the master is told to hold")
        self.holds_because("not enabled")
        self.assertFalse(self.told.message.enabled)
        wait_until(lambda: "not enabled" in self.did.message.reason, self.state)
        self.assertEqual(self.did.message.fixture, "")
        path = np.array([convert.pose(m)[:3, 3] for m in self.set_point.all])
        self.assertLess(np.linalg.norm(np.diff(path, axis=0), axis=1).max(), 0.003)
        for heard in (self.command, self.torques):
            heard.clear()
        rospy.sleep(0.5)
        self.assertEqual((self.command.all, self.torques.all), ([], []))
        self.set_point.clear()
        rospy.ServiceProxy("/csa/teleop/enable", SetBool)(True)
        self.reach(FULL, "after csa_teleop came back and was enabled")
        self.force_settles(2.0)
        path = np.array([convert.pose(m)[:3, 3] for m in self.set_point.all])
        self.assertLess(np.linalg.norm(np.diff(path, axis=0), axis=1).max(), 0.003)
        wait_until(lambda: self.did.message.fixture == "region_of_interest", "the region is still there")
        self.surgeon.press("pick", 2)
        wait_until(lambda: self.did.message.fixture == "", "it can be cleared")
        self.surgeon.press("pick", 0)

    def test_b6_up_again_slave_and_proxy_meet(self) -> None:
        self.surgeon.go(DOWN + np.array([0.0, 0.0, 0.03]), 3.0)
        self.reach(CsaTeleopState.NO_CONTACT)
        wait_until(lambda: self.told.message.mismatch_m < 0.0005, lambda: f"mismatch {self.told.message.mismatch_m}")
        wait_until(lambda: np.linalg.norm(convert.wrench(self.hand.message)[:3]) == 0.0, "no force on the hand")

    def test_c1_starts_that_are_refused_say_what_is_missing(self) -> None:
        document = json.loads(SYSTEM.read_text())
        document["io"]["start_timeout_s"] = 1.0

        def refused(node: str, change, *words: str) -> None:
            changed = json.loads(json.dumps(document))
            change(changed)
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder) / "system.json"
                path.write_text(json.dumps(changed))
                rospy.set_param("/lonely", {"system": str(path), "teleop": ""})
                process = spawn(node, "__name:=lonely")
                said, _ = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 2, said)
            for word in words:
                self.assertIn(word, said)

        def other_force(d: dict) -> None:
            d["arms"][1]["force"]["topic"] = "/nowhere/wrench"

        def other_master(d: dict) -> None:
            d["arms"][0]["name"] = d["teleops"][0]["master"] = "MTMR"

        def fixed_gain(d: dict) -> None:
            d["teleops"][0]["scheduled"] = False

        refused("csa_slave", other_force, "nobody publishes /nowhere/wrench", "a source of force")
        refused("csa_master", other_master, "/MTMR/measured_js", "nobody listens to /MTMR/servo_jf", "its torque")
        refused("csa_slave", fixed_gain, "$.teleops[0]", "admittance_m_Ns = 0.02")

    def test_c2_a_wrench_from_outside_instead_of_the_computed_one(self) -> None:
        document = json.loads(SYSTEM.read_text())
        document["arms"][0] = {"name": "HAND", "type": "simulated_hand"}
        document["teleops"][0].update(master="HAND", wrench="external", master_rpy_rad=[0.0, 0.0, math.pi / 2.0])
        hand = rospy.Publisher("/HAND/measured_cp", PoseStamped, queue_size=1)
        felt = Newest("/HAND/servo_cf", WrenchStamped)
        outside = rospy.Publisher("/csa/master/external_wrench", WrenchStamped, queue_size=1)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "system.json"
            path.write_text(json.dumps(document))
            rospy.set_param("/lonely", {"system": str(path), "teleop": ""})
            process = spawn("csa_master", "__name:=lonely")
            try:

                def turned() -> bool:
                    now = rospy.Time.now()
                    hand.publish(convert.pose_msg(np.eye(4), "HAND", now))
                    outside.publish(convert.wrench_msg(np.array([0.0, 1.0, 0.5, 0, 0, 0]), "PSM1", now))
                    return felt.message and np.allclose(convert.wrench(felt.message)[:3], [1.0, 0.0, 0.5], atol=1e-9)

                wait_until(turned, "the outside wrench in the hand's axes")

                def gone() -> bool:
                    hand.publish(convert.pose_msg(np.eye(4), "HAND", rospy.Time.now()))
                    return not convert.wrench(felt.message).any()

                wait_until(gone, "a wrench that is too old is none")
            finally:
                process.kill()
                process.wait()


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "csa", Csa, sys.argv)
