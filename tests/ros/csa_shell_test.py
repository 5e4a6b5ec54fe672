#!/usr/bin/env python3
"""saras csa shell over the wire: --once prints shapes and newest values, the prompt's arrays follow the topics."""

from __future__ import annotations

import subprocess
import sys
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point, PointStamped, PoseStamped, TwistStamped, WrenchStamped
from saras_ros1.msg import CsaTeleopState
from sensor_msgs.msg import PointCloud2, PointField
from visualization_msgs.msg import Marker

from saras_ros1 import convert

SHELL = [sys.executable, "-m", "saras", "csa", "shell"]
PATIENCE_S = 60
VERTICES = np.array([[0.0, 0.0, 0.1], [0.01, 0.0, 0.1], [0.0, 0.01, 0.1], [0.01, 0.01, 0.1]])
STIFFNESS, STD = np.array([250.0, np.nan, 900.0, 300.0]), np.array([20.0, np.inf, 30.0, 40.0])


def stiffness_cloud() -> PointCloud2:
    """With a field between, as others may add some."""
    names = ["x", "y", "z", "seen", "stiffness", "std"]
    rows = np.column_stack([VERTICES, np.ones(4), STIFFNESS, STD]).astype("<f4")
    fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate(names)]
    return PointCloud2(
        height=1, width=4, fields=fields, point_step=24, row_step=96, data=rows.tobytes(), is_dense=False
    )


class Palpation:
    """What slave, teleoperation and modeler say, 50 times a second."""

    def __init__(self) -> None:
        self.count = 0
        topics = {
            "slave/measured_cp": PoseStamped, "slave/measured_cv": TwistStamped, "slave/measured_cf": WrenchStamped,
            "teleop/state": CsaTeleopState, "modeler/stiffness": PointCloud2, "modeler/mesh": Marker,
            "modeler/next_location": PointStamped,
        }  # fmt: skip
        self._out = {name: rospy.Publisher(f"/csa/{name}", kind, queue_size=5) for name, kind in topics.items()}
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        mesh = Marker(type=Marker.TRIANGLE_LIST, points=[Point(*VERTICES[i]) for i in (0, 1, 2, 1, 2, 3)])
        while not rospy.is_shutdown():
            time.sleep(0.02)
            self.count += 1
            now, pose = rospy.Time.now(), np.eye(4)
            pose[:3, 3] = [0.001 * self.count, 0.0, 0.1]
            self._out["slave/measured_cp"].publish(convert.pose_msg(pose, "base", now))
            twist = TwistStamped()
            twist.header.stamp, twist.twist.linear.x = now, 0.05
            self._out["slave/measured_cv"].publish(twist)
            self._out["slave/measured_cf"].publish(convert.wrench_msg(np.array([0, 0, -1.5, 0, 0, 0]), "base", now))
            self._out["teleop/state"].publish(
                CsaTeleopState(state=CsaTeleopState.FULL_CONTACT, hold=self.count % 2 == 0, reason="CLUTCHED")
            )
            self._out["modeler/stiffness"].publish(stiffness_cloud())
            self._out["modeler/mesh"].publish(mesh)
            self._out["modeler/next_location"].publish(PointStamped(point=Point(0.02, 0.03, 0.1)))


class CsaShell(unittest.TestCase):
    def setUp(self) -> None:
        rospy.init_node("csa_shell_test")

    def run_shell(self, *arguments: str, typed: str = "") -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [*SHELL, *arguments], input=typed, capture_output=True, text=True, timeout=PATIENCE_S, check=False
        )

    def test_1_nothing_comes(self) -> None:
        done = self.run_shell("--once", "--wait", "0.5")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("nothing came within 0.5 s on /csa/...", done.stdout)

    def test_2_once(self) -> None:
        Palpation()
        done = self.run_shell("--once", "--wait", "10")
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = {line.split()[0]: line for line in done.stdout.splitlines()}
        for name, said in (
            ("tip", " 0 0.1 "), ("force", "0 0 -1.5"), ("velocity", "0.05 0 0"), ("samples", "x10"),
            ("state", "FULL_CONTACT"), ("vertices", "4x3"), ("stiffness", "250 to 900, 3 known"),
            ("std", "20 to 40, 3 known"), ("mesh", "2x3x3"), ("next_location", "0.02 0.03 0.1"),
            ("proxy", "never came"),
        ):  # fmt: skip
            self.assertIn(said, lines[name], done.stdout)

    def test_3_the_prompt_follows(self) -> None:
        wait = "while not (len(vertices) and len(samples)): time.sleep(0.02)\n\n"
        moved = "while tip[0] <= before[0]: time.sleep(0.02)\n\n"
        done = self.run_shell(
            typed=f"import time\n{wait}before = tip\n{moved}"
            "print('moved', bool(tip[0] > before[0]), samples.shape[1], np.nanmax(stiffness), mesh.shape)\nshow()\n"
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("moved True 10 900.0 (2, 3, 3)", done.stdout)
        self.assertIn("tip of the slave", done.stdout)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "csa_shell", CsaShell, sys.argv)
