#!/usr/bin/env python3
"""csa_modeler learns from seen force: each reading once, where the tip was then; what has no force is no sample."""

from __future__ import annotations

import contextlib
import math
import sys
import threading
import time
import unittest
from collections import deque

import numpy as np
import rospy
import rostest
import yaml
from geometry_msgs.msg import PoseStamped, Vector3, WrenchStamped
from saras_ros1.msg import Contact, CsaModelerState
from sensor_msgs.msg import PointCloud2
from support import ROOT, Newest, spawn, wait_until

from saras.csa.system import load
from saras_ros1 import convert
from saras_ros1.modeler_messages import read_cloud

BASE = "mesa_left/sbs_world"
STIFFNESS = yaml.safe_load((ROOT / "config" / "contact.yaml").read_text())["contact_force"]["law"]["stiffness_N_m"]
LATE_S = 0.08  # from a picture to what is seen in it


class Arm:
    """The tip at 100 Hz, pressing here and there; stereo_contact at 10 Hz, each reading of a while ago."""

    def __init__(self, surface: np.ndarray) -> None:
        self.surface, self.sees = surface, lambda depth: depth
        self._seen: deque[tuple[rospy.Time, float]] = deque()
        self._pose = rospy.Publisher("/mesa_left/ee_pose", PoseStamped, queue_size=5)
        self._contact = rospy.Publisher("/contact/left", Contact, queue_size=5)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        count = 0
        while not rospy.is_shutdown():
            with contextlib.suppress(rospy.ROSException):  # topics close before this thread ends
                self._step(count)
            count += 1
            time.sleep(0.01)

    def _step(self, count: int) -> None:
        now = rospy.Time.now()
        t = now.to_sec() % 10000.0
        depth = 0.0035 + 0.0015 * math.sin(2.3 * t)
        tip = np.eye(4)
        tip[:3, 3] = self.surface + np.array([0.004 * math.sin(0.9 * t), 0.004 * math.cos(1.3 * t), -depth])
        self._pose.publish(convert.pose_msg(tip, BASE, now))
        if count % 10 == 0:
            self._seen.append((now, depth))
        while self._seen and (now - self._seen[0][0]).to_sec() > LATE_S:
            stamp, depth = self._seen.popleft()
            message = Contact(depth=self.sees(depth), direction=Vector3(0.0, 0.0, 1.0))
            message.header.stamp, message.header.frame_id = stamp, BASE
            self._contact.publish(message)


class ModelerContact(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("modeler_contact_test")
        setup = load(ROOT / "config" / "csa" / "saras_arm.json").setup()
        cls.arm = Arm(setup.surface().touch(setup.start()).closest)
        cls.state = Newest("/csa/modeler/state", CsaModelerState)
        cls.cloud = Newest("/csa/modeler/stiffness", PointCloud2)
        cls.wrench = Newest("/contact_force/left/wrench", WrenchStamped)
        wait_until(lambda: cls.state.message and cls.wrench.message, "the nodes", 60.0)

    def says(self, word: str) -> None:
        wait_until(lambda: word in self.state.message.status, lambda: f"{word}: {self.state.message.status}")

    def test_a_the_map_has_the_stiffness_that_was_put_in(self) -> None:
        self.says("OK")
        wait_until(lambda: self.state.message.samples > 150, lambda: f"{self.state.message}", 90.0)

        def learned() -> bool:
            rows = read_cloud(self.cloud.next())
            across = np.hypot(rows["x"] - self.arm.surface[0], rows["y"] - self.arm.surface[1])
            near = rows[across < 0.003]
            error = np.abs(near["stiffness"] / STIFFNESS - 1.0)
            height = np.abs(near["z"] - self.arm.surface[2])
            self.last = f"stiffness {near['stiffness']}, height {height.max()}"
            return bool(np.isfinite(error).all() and np.median(error) < 0.15 and height.max() < 0.0006)

        wait_until(learned, lambda: f"a map: {self.last}", 60.0)

    def test_b_each_reading_is_one_sample(self) -> None:
        self.says("OK")
        self.wrench.clear()
        before = self.state.next().samples
        rospy.sleep(4.0)
        samples = self.state.next().samples - before
        stamps = {m.header.stamp for m in self.wrench.all}
        self.assertGreater(len(self.wrench.all), 2 * len(stamps), "readings are held")
        self.assertLess(abs(samples - len(stamps)), 0.3 * len(stamps) + 4)

    def test_c_unknown_and_saturated_force_is_no_sample(self) -> None:
        for sees in (lambda depth: math.nan, lambda depth: depth + 0.035):
            self.arm.sees = sees
            self.says("STALE: nothing from /contact_force/left/wrench: /contact/left speaks, without a force")
            before = self.state.next()
            rospy.sleep(1.0)
            after = self.state.next()
            self.assertEqual((after.samples, after.learned), (before.samples, before.learned))
            self.assertFalse(after.well)
            self.arm.sees = lambda depth: depth
            self.says("OK")

    def test_d_a_side_that_is_none_is_refused(self) -> None:
        rospy.set_param("/refused", {**rospy.get_param("/csa_modeler"), "source": "contact/up"})
        process = spawn("csa_modeler", "__name:=refused")
        said, _ = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 2, said)
        self.assertIn("/refused/source = 'contact/up': must be contact/left or contact/right", said)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "modeler_contact", ModelerContact, sys.argv)
