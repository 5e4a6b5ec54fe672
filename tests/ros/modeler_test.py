#!/usr/bin/env python3
"""The modeler with real processes, on the simulated phantom. Tests run in the order of their names."""

from __future__ import annotations

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
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point32, PointStamped, PolygonStamped, PoseStamped, TwistStamped, WrenchStamped
from saras_ros1.msg import CsaAdmittance, CsaModelerState, CsaStiffness, CsaTeleopState
from saras_ros1.srv import KeepModel, SetRegion
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool, Trigger
from support import ROOT, Newest, spawn, wait_until
from visualization_msgs.msg import Marker

from saras.csa import SlaveMlc
from saras.csa.system import load
from saras.model import StiffMesh
from saras.sim.palpation import Phantom
from saras_ros1 import convert
from saras_ros1.csa_surgeon import Surgeon
from saras_ros1.modeler_messages import read_cloud

SYSTEM = ROOT / "config" / "csa" / "palpation.json"
DOWN = np.array([0.0, 0.0, -0.014])
KEPT = Path(tempfile.mkdtemp()) / "organ.ply"


def pid_of(node: str) -> int:
    return xmlrpc.client.ServerProxy(rosgraph.Master("/modeler_test").lookupNode(node)).getPid("/modeler_test")[2]


def polygon(corners, frame: str) -> PolygonStamped:
    message = PolygonStamped()
    message.header.frame_id = frame
    message.polygon.points = [Point32(*map(float, corner)) for corner in corners]
    return message


def xyz(point) -> np.ndarray:
    return np.array([point.x, point.y, point.z])


class Modeler(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("modeler_test")
        cls.setup = load(SYSTEM).setup()
        cls.truth = Phantom(cls.setup.tissue_config())
        cls.told = Newest("/csa/teleop/state", CsaTeleopState)
        cls.did = Newest("/csa/slave/admittance", CsaAdmittance)
        cls.state = Newest("/csa/modeler/state", CsaModelerState)
        cls.cloud = Newest("/csa/modeler/stiffness", PointCloud2)
        cls.touched = Newest("/csa/modeler/touched", PointCloud2)
        cls.mesh = Newest("/csa/modeler/mesh", Marker)
        cls.next = Newest("/csa/modeler/next_location", PointStamped)
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)
        cls.surgeon = Surgeon(cls.setup)
        wait_until(lambda: cls.told.message and cls.state.message and cls.cloud.message, "the nodes", 60.0)
        cls.surgeon.enable()

    def service(self, name: str, kind: type):
        rospy.wait_for_service(f"/csa/modeler/{name}", 30.0)
        return rospy.ServiceProxy(f"/csa/modeler/{name}", kind)

    def says(self, word: str) -> None:
        wait_until(lambda: word in self.state.message.status, lambda: f"{word}: {self.state.message.status}")

    def said_by_diagnostics(self, word: str) -> None:
        def there() -> bool:
            for status in (s for m in list(self.diagnostics.all) for s in m.status if s.name == "/csa_modeler"):
                if any(word in value.value for value in status.values):
                    return True
            return False

        self.diagnostics.clear()
        wait_until(there, f"{word} in /diagnostics")

    def rows(self) -> np.ndarray:
        return read_cloud(self.cloud.next())

    def at_start(self, x: float, y: float) -> np.ndarray:
        return self.setup.start() + np.array([x, y, -0.008])

    def test_a1_nothing_is_known_before_anything_was_touched(self) -> None:
        self.says("NO_CONTACT")
        rows = self.rows()
        self.assertGreater(len(rows), 2000)
        self.assertTrue(np.isnan(rows["stiffness"]).all())
        self.assertTrue(np.isinf(rows["std"]).all())
        self.assertEqual(self.state.message.known_share, 0.0)
        marker = self.mesh.next()
        self.assertEqual(len(marker.points), len(marker.colors))
        self.assertEqual({(round(c.r, 2), round(c.g, 2), round(c.b, 2)) for c in marker.colors}, {(0.63, 0.63, 0.63)})

    def test_a2_the_map_grows_and_the_unknown_stays_unknown(self) -> None:
        self.surgeon.go(DOWN, 3.0)
        wait_until(lambda: self.told.message.state == CsaTeleopState.FULL_CONTACT, "contact")
        self.surgeon.follow(lambda t: DOWN + np.array([0.004 * np.sin(1.5 * t), 0.004 * np.sin(1.1 * t), 0.0]), 8.0)
        self.says("OK")
        wait_until(lambda: self.state.message.known_share > 0.05, "a map")
        rows = self.rows()
        xy = np.column_stack([rows["x"], rows["y"]]) - self.setup.start()[:2]
        away = np.linalg.norm(xy, axis=1)
        known = np.isfinite(rows["stiffness"])
        self.assertTrue(known[away < 0.002].all())
        near = rows[away < 0.002]
        truth = self.truth.stiffness(np.column_stack([near["x"], near["y"], near["z"]]).astype(float))
        self.assertLess(np.median(np.abs(near["stiffness"] / truth - 1.0)), 0.25, (near["stiffness"], truth))
        self.assertFalse(known[away > 0.02].any())
        self.assertTrue(np.isinf(rows["std"][~known]).all())
        height = rows["z"][away < 0.002] - self.at_start(0.0, 0.0)[2]  # the model began a millimetre off
        self.assertLess(np.abs(height).max(), 0.0006)

    def test_a3_touched_vertices_come_by_themselves_and_mesh_and_cloud_agree(self) -> None:
        rows = read_cloud(self.touched.next())
        self.assertIn("vertex", rows.dtype.names)
        self.assertLess(len(rows), 1000)
        marker, corners = self.mesh.next(), set()
        for point in marker.points:
            corners.add((np.float32(point.x), np.float32(point.y), np.float32(point.z)))
        self.assertEqual(len(corners), len(self.rows()))
        self.assertGreater(len({(c.r, c.g, c.b) for c in marker.colors}), 2)

    def test_a4_a_region_bounds_where_to_touch_next(self) -> None:
        set_region = self.service("set_region", SetRegion)
        frame = self.setup.frame
        line = [self.at_start(x, 0.0) for x in (0.0, 0.005, 0.01)]
        square = [self.at_start(x, y) for x in (-0.006, 0.006) for y in (-0.006, 0.006)]
        for region, word in (
            (polygon(line, frame), "must span an area"),
            (polygon(square, "world"), "frame_id 'world'"),
        ):
            refused = set_region(region)
            self.assertFalse(refused.success)
            self.assertIn(word, refused.message)
        self.assertTrue(set_region(polygon(square, frame)).success)
        self.next.next()
        self.next.clear()
        rospy.ServiceProxy("/csa/teleop/set_exploring", SetBool)(True)

        def spots() -> np.ndarray:
            return np.unique(np.array([xyz(m.point)[:2] for m in list(self.next.all)]).round(3), axis=0)

        wait_until(lambda: self.next.all and len(spots()) >= 3, lambda: f"other places: {spots()}", 60.0)
        rospy.ServiceProxy("/csa/teleop/set_exploring", SetBool)(False)
        self.assertLess(np.abs(spots() - self.setup.start()[:2]).max(), 0.007)
        self.assertEqual(self.state.message.cost_error, "")
        self.assertTrue(set_region(polygon([], frame)).success)

    def gains(self) -> np.ndarray:
        """The last twenty of K_g."""
        return np.array([m.admittance_m_Ns for m in self.did.all[-20:]])

    def falls_back(self) -> None:
        """To the gain of the largest stiffness, and stays there."""
        self.did.clear()
        wait_until(
            lambda: len(self.gains()) == 20 and np.ptp(self.gains()) == 0.0 and self.gains()[0] <= self.largest,
            lambda: f"the gain of what is not known: {self.gains()}",
        )

    def rises(self) -> None:
        self.did.clear()
        wait_until(
            lambda: len(self.gains()) == 20 and self.gains().min() > 1.3 * self.least,
            lambda: f"a gain above {self.least}: {self.gains()}",
            60.0,
        )

    def test_a5_the_slaves_gain_follows_the_map_and_falls_back_without_it(self) -> None:
        self.largest = SlaveMlc(self.setup.slave_config()).admittance(np.nan) + 1e-12
        self.surgeon.go(DOWN, 1.0)
        under = Newest("/csa/slave/stiffness", CsaStiffness)
        wait_until(lambda: under.message and 100.0 < under.message.stiffness_N_m < 1300.0, lambda: str(under.message))
        teller = pid_of("/csa_stiffness")  # who is stopped does not say it
        os.kill(teller, signal.SIGSTOP)
        try:
            self.falls_back()
        finally:
            os.kill(teller, signal.SIGCONT)
        self.least = self.gains()[0]
        self.rises()
        os.kill(pid_of("/csa_modeler"), signal.SIGKILL)
        wait_until(lambda: np.isnan(under.message.stiffness_N_m), lambda: str(under.message))
        self.falls_back()
        # It is started again and knows nothing: what is pressed now is learned anew.
        wait_until(lambda: self.state.next().well, lambda: self.state.message.status, 60.0)
        self.surgeon.follow(lambda t: DOWN + np.array([0.004 * np.sin(1.5 * t), 0.004 * np.sin(1.1 * t), 0.0]), 8.0)
        wait_until(lambda: under.message.stiffness_N_m > 100.0, lambda: str(under.message), 60.0)
        self.rises()

    def test_b1_saved_reset_and_loaded(self) -> None:
        save, load_file = self.service("save", KeepModel), self.service("load", KeepModel)
        self.assertIn("must be absolute", save("organ.ply", False).message)
        said = save(str(KEPT), False)
        self.assertTrue(said.success, said.message)
        self.assertIn("force overwrites", save(str(KEPT), False).message)
        self.assertTrue(save(str(KEPT), True).success)
        self.surgeon.go(DOWN + np.array([0.0, 0.0, 0.03]), 3.0)
        self.says("NO_CONTACT")
        self.assertTrue(self.service("reset", Trigger)().success)
        wait_until(lambda: self.state.message.places == 0 and self.state.message.known_share == 0.0, "nothing known")
        self.cloud.next()
        self.assertTrue(np.isnan(self.rows()["stiffness"]).all())
        kept = StiffMesh.load(KEPT)
        self.assertTrue(np.isfinite(kept.stiffness_N_m).any())
        self.assertFalse(load_file("/nowhere/organ.ply", False).success)
        self.assertTrue(load_file(str(KEPT), False).success)
        self.cloud.next()
        rows = self.rows()
        np.testing.assert_allclose(rows["stiffness"], kept.stiffness_N_m, rtol=1e-5)
        np.testing.assert_allclose(rows["z"], kept.vertices[:, 2], atol=1e-6)

    def test_b2_a_file_of_another_place_is_refused(self) -> None:
        kept = StiffMesh.load(KEPT)
        elsewhere = KEPT.with_name("elsewhere.ply")
        StiffMesh(kept.vertices + 1.0, kept.triangles, kept.stiffness_N_m, kept.stiffness_std_N_m).save(elsewhere)
        said = self.service("load", KeepModel)(str(elsewhere), False)
        self.assertFalse(said.success)
        self.assertIn("must be the same organ", said.message)

    def test_c1_a_killed_slave_is_shown_as_stale_and_recovers(self) -> None:
        os.kill(pid_of("/csa_slave"), signal.SIGKILL)
        self.says("STALE: nothing from /csa/slave/")
        self.assertFalse(self.state.message.well)
        self.said_by_diagnostics("STALE")
        self.says("NO_CONTACT")  # it is started again

    def test_c2_other_units_drift_and_stamps_that_differ_are_named(self) -> None:
        """A modeler of its own, fed by hand."""
        parameters = rospy.get_param("/csa_modeler")
        rospy.set_param("/lonely", {**parameters, "source": "/by_hand"})
        pose, twist, force = (
            rospy.Publisher(f"/by_hand/{name}", kind, queue_size=5)
            for name, kind in (
                ("measured_cp", PoseStamped),
                ("measured_cv", TwistStamped),
                ("measured_cf", WrenchStamped),
            )
        )
        mine = Newest("/lonely/state", CsaModelerState)
        process = spawn("csa_modeler", "__name:=lonely", "/csa/modeler/state:=/lonely/state")

        def feed(height_m: float, newton: float, unit: float = 1.0, late_s: float = 0.0):
            def until(word: str) -> None:
                def there() -> bool:
                    at, now = np.eye(4), rospy.Time.now()
                    at[:3, 3] = unit * (self.at_start(0.0, 0.0) + np.array([0.0, 0.0, height_m]))
                    pose.publish(convert.pose_msg(at, self.setup.frame, now))
                    twist.publish(convert.twist_msg(np.zeros(6), self.setup.frame, now))
                    wrench = np.array([0.0, 0.0, -newton, 0.0, 0.0, 0.0])
                    force.publish(convert.wrench_msg(wrench, self.setup.frame, now + rospy.Duration(late_s)))
                    return mine.message and mine.message.status.startswith(word)

                wait_until(there, lambda: f"{word}: {mine.message and mine.message.status}", 60.0)

            return until

        try:
            feed(0.03, 0.0)("NO_CONTACT")
            feed(-0.003, 1.0, unit=1000.0)("IMPLAUSIBLE_POSITION")
            self.assertIn("millimetres for metres", mine.message.status)
            self.assertEqual(mine.message.learned, 0)
            feed(-0.003, 1000.0)("IMPLAUSIBLE_FORCE")
            self.assertEqual(mine.message.learned, 0)
            feed(0.03, 2.0)("SENSOR_DRIFT")
            feed(0.03, 0.0, late_s=0.001)("STALE: stamps of")
            feed(0.03, 0.0)("NO_CONTACT")
        finally:
            process.kill()
            process.wait()

    def test_c3_starts_that_are_refused(self) -> None:
        def refused(change: dict, *words: str) -> None:
            rospy.set_param("/refused", {**rospy.get_param("/csa_modeler"), **change})
            process = spawn("csa_modeler", "__name:=refused")
            said, _ = process.communicate(timeout=60)
            self.assertEqual(process.returncode, 2, said)
            for word in words:
                self.assertIn(word, said)

        exploring = rospy.get_param("/csa_modeler/exploring")
        refused({"exploring": {**exploring, "cost": "cheapest"}}, "cost = 'cheapest'", "upper_confidence")
        refused({"free_m": -1.0}, "/refused/free_m = -1")
        refused({"colour": 1}, "colour: unknown parameter")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "modeler", Modeler, sys.argv)
