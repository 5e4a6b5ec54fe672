#!/usr/bin/env python3
"""A start that cannot be good is refused: exit code 2, and a line that names parameter, value and bound."""

import copy
import math
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
import yaml
from support import ROOT, spawn

CONFIG = ROOT / "config"
PATIENCE_S = 60.0


def load(file, node):
    return yaml.safe_load((CONFIG / file).read_text(encoding="utf-8"))[node]


class StartTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("start_test")

    def refuse(self, executable, name, values, *words):
        """Starts the node with these parameters; it must end with code 2 and say all the words."""
        if rospy.has_param(f"/{name}"):
            rospy.delete_param(f"/{name}")
        if values:
            rospy.set_param(f"/{name}", values)
        child = spawn(executable, f"__name:={name}")
        said, _ = child.communicate(timeout=PATIENCE_S)
        self.assertEqual(child.returncode, 2, said)
        for word in words:
            self.assertIn(word, said)

    def spoil(self, executable, file, name, path, value, *words):
        values = copy.deepcopy(load(file, name))
        target = values
        for key in path[:-1]:
            target = target[key]
        if value is KeyError:
            del target[path[-1]]
        else:
            target[path[-1]] = value
        self.refuse(executable, name, values, *words)

    def test_no_parameters(self):
        self.refuse("tank_master", "tank_master", None, "/tank_master", "no parameters")

    def test_missing(self):
        self.spoil(
            "transparency",
            "teleop.yaml",
            "transparency",
            ("law", "scale"),
            KeyError,
            "/transparency/law/scale: missing",
        )

    def test_not_a_number(self):
        self.spoil(
            "tank_slave",
            "tanks.yaml",
            "tank_slave",
            ("tank", "initial_J"),
            math.nan,
            "tank_slave/tank/initial_J",
            "nan",
        )

    def test_out_of_range(self):
        self.spoil(
            "supervisor", "supervisor.yaml", "supervisor", ("period_s",), 7.0, "/supervisor/period_s = 7", "0.1]"
        )

    def test_wrong_order_of_levels(self):
        self.spoil("tank_master", "tanks.yaml", "tank_master", ("tank", "request_J"), 0.3, "request_J", "available_J")

    def test_damping_of_wrong_sign(self):
        self.spoil("tank_slave", "tanks.yaml", "tank_slave", ("tank", "damping_min"), [-1.0] * 6, "damping_min", "-1")

    def test_unknown_key(self):
        self.spoil("touchball_receiver", "console.yaml", "touchball_receiver", ("prot",), 1, "prot: unknown parameter")

    def test_an_address_outside_loopback(self):
        self.spoil(
            "touchball_receiver", "console.yaml", "touchball_receiver", ("bind_host",), "0.0.0.0", "0.0.0.0", "loopback"
        )

    def test_a_key_file_that_others_can_read(self):
        with tempfile.NamedTemporaryFile() as file:
            Path(file.name).chmod(0o644)
            self.spoil(
                "touchball_receiver",
                "console.yaml",
                "touchball_receiver",
                ("key_file",),
                file.name,
                file.name,
                "mode = 0644",
                "0600",
            )

    def spoil_da_vinci(self, path, value, *words):
        values = {**load("dvrk.yaml", "dvrk_sim"), "scene_file": str(CONFIG / "scene.yaml")}
        values[path[0]] = {**values[path[0]], path[1]: value}
        self.refuse("dvrk_sim", "dvrk_sim", values, *words)

    def test_da_vinci_with_a_wrong_pairing(self):
        self.spoil_da_vinci(("PSM2", "body"), "si", "400006", "Si body")

    def test_da_vinci_with_an_unknown_tool(self):
        self.spoil_da_vinci(("PSM1", "tool"), "4711", "4711", "LARGE_NEEDLE_DRIVER:400006")

    def test_da_vinci_that_starts_out_of_reach(self):
        self.spoil_da_vinci(("ECM", "home_m"), [0.5, 0.0, 0.1], "/dvrk_sim/ECM/home_m", "must be in [")

    def test_da_vinci_with_a_bag_that_is_not_there(self):
        self.spoil_da_vinci(("surgeon", "bag"), "/nowhere.bag", "/nowhere.bag")

    def test_frames_without_a_file(self):
        self.refuse("frames", "frames", {"scene_file": "/nowhere/scene.yaml"}, "/nowhere/scene.yaml")

    def test_sim_time_with_real_arms(self):
        rospy.set_param("/use_sim_time", True)
        rospy.set_param("/saras/simulated", False)
        try:
            self.refuse("supervisor", "supervisor", load("supervisor.yaml", "supervisor"), "use_sim_time")
        finally:
            rospy.delete_param("/use_sim_time")
            rospy.delete_param("/saras/simulated")

    def test_velocity_integrator_without_an_arm_says_so(self):
        name = "velocity_integrator_left"
        values = {**load("teleop.yaml", name), "start_pose_wait_s": 0.5}
        self.refuse("velocity_integrator", name, values, "waited 0.5 s", "no start pose", "/mesa_left/ee_pose")

    def test_tf_transformer_without_frames_says_which(self):
        from geometry_msgs.msg import PoseStamped

        from saras_ros1 import convert

        name = "tf_transformer_right"
        publisher = rospy.Publisher("/touchball_right/pose", PoseStamped, queue_size=1)
        pose = convert.pose_msg(np.eye(4), "touchball_right/simball_base", rospy.Time.now())
        timer = rospy.Timer(rospy.Duration(0.05), lambda _: publisher.publish(pose))
        try:
            values = {**load("teleop.yaml", name), "frames_wait_s": 0.5}
            self.refuse(
                "tf_transformer", name, values, "mesa_right/sbs_world", "touchball_right/simball_base", "/tf_static"
            )
        finally:
            timer.shutdown()


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "start", StartTest)
