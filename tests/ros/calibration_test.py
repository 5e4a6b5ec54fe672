#!/usr/bin/env python3
"""Registration over the wire, frames that load it, and a frame that is unknown once its arm was moved."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import numpy as np
import rospy
import rostest
import yaml
from geometry_msgs.msg import PoseStamped
from saras_ros1.srv import LoadCalibration, SaveCalibration, TakeMeasurement
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from support import ROOT, wait_until

import saras
from saras.calibration.calibration_file import Calibration as FileOfCalibration
from saras.calibration.simulated import MESA_ARMS, PSM_ARMS, SimulatedRoom
from saras.kinematics import scene
from saras_ros1 import convert
from saras_ros1.live_frames import LiveFrames, UnknownFrameError

REGISTRATION = "/global_frame_registration/"
POSES = {"mesa_left": "/mesa_left/ee_pose", "mesa_right": "/mesa_right/ee_pose"} | {
    name: f"/{name}/local/measured_cp" for name in PSM_ARMS
}


class Calibration(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("calibration_test")
        cls.room = SimulatedRoom(scene.load(ROOT / "config" / "scene.yaml"))
        cls.tips = {arm: np.zeros(3) for arm in POSES}
        cls.joints = {arm: cls.room.joints_rad(arm) for arm in MESA_ARMS}
        cls.poses = {arm: rospy.Publisher(topic, PoseStamped, queue_size=1) for arm, topic in POSES.items()}
        cls.states = {arm: rospy.Publisher(f"/{arm}/joint_states", JointState, queue_size=1) for arm in MESA_ARMS}
        threading.Thread(target=cls.speak, daemon=True).start()
        cls.frames = LiveFrames(0.5)
        cls.path = str(Path(tempfile.mkdtemp()) / "calibration.yaml")
        for name in ("take", "undo", "compute", "save", "status"):
            rospy.wait_for_service(REGISTRATION + name, 60.0)
        rospy.wait_for_service("/frames/load_calibration", 60.0)

    @classmethod
    def speak(cls) -> None:
        while not rospy.core.is_shutdown_requested():
            now = rospy.Time.now()
            for arm, tip in cls.tips.items():
                pose = np.eye(4)
                pose[:3, 3] = tip
                cls.poses[arm].publish(convert.pose_msg(pose, cls.room.frame(arm), now))
            for arm, joints in cls.joints.items():
                message = JointState(name=list(joints), position=list(joints.values()))
                message.header.stamp = now
                cls.states[arm].publish(message)
            rospy.rostime.wallsleep(0.02)

    def call(self, name: str, kind=Trigger, *arguments):
        return rospy.ServiceProxy(REGISTRATION + name, kind)(*arguments)

    def place(self, frame: str) -> np.ndarray | None:
        try:
            return self.frames.fresh("world", frame)
        except UnknownFrameError:
            return None

    def test_1_take_undo_compute_save(self) -> None:
        self.assertFalse(self.call("compute").success)
        self.assertFalse(self.call("save", SaveCalibration, self.path, False).success)
        self.assertIn("must be one of", self.call("take", TakeMeasurement, "mesa_middle", 1).message)
        wait_until(lambda: "nothing taken" in self.call("status").message, "an empty registration")
        for arm in POSES:
            for dot in self.room.reachable_dots(arm) * 2:
                type(self).tips[arm] = self.room.touch(arm, dot).mean(axis=0)
                rospy.sleep(0.2)
                answer = self.call("take", TakeMeasurement, arm, dot)
                self.assertTrue(answer.success, answer.message)
        self.assertIn("forgotten: touch", self.call("undo").message)
        answer = self.call("compute")
        self.assertTrue(answer.success, answer.message)
        answer = self.call("save", SaveCalibration, self.path, False)
        self.assertTrue(answer.success, answer.message)
        self.assertIn("4 frames", answer.message)
        self.assertIn("exists", self.call("save", SaveCalibration, self.path, False).message)

    def test_2_the_platforms_frames_have_moved(self) -> None:
        for arm in POSES:
            frame = self.room.frame(arm)

            def near(frame=frame, arm=arm) -> bool:
                place = self.place(frame)
                if place is None or np.array_equal(place, self.room.truth(arm)):
                    return False
                off = saras.displacement(place, self.room.truth(arm))
                return bool(1e-6 < np.linalg.norm(off[:3]) < 5e-3)

            wait_until(near, f"{frame} near the truth, but not the scene's")

    def test_3_wrong_files_are_refused_and_change_nothing(self) -> None:
        before = self.place("PSM1")
        load = rospy.ServiceProxy("/frames/load_calibration", LoadCalibration)
        edited = Path(self.path).with_name("edited.yaml")
        edited.write_text(Path(self.path).read_text().replace("measurements: ", "measurements: 1"))
        for path, why in ((str(edited), "checksum"), ("calibration.yaml", "absolute"), ("/nowhere/c.yaml", "No such")):
            answer = load(path)
            self.assertFalse(answer.success)
            self.assertIn(why, answer.message)
        np.testing.assert_array_equal(self.place("PSM1"), before)

    def test_4_an_arm_that_was_moved_is_unknown_until_calibrated_anew(self) -> None:
        joint = "mesa_left/passive_4"
        type(self).joints["mesa_left"] = {**self.joints["mesa_left"], joint: self.joints["mesa_left"][joint] + 0.01}
        wait_until(lambda: self.place("mesa_left/sbs_world") is None, "the moved arm's base unknown")
        self.assertIsNotNone(self.place("mesa_right/sbs_world"))
        type(self).joints["mesa_left"] = self.room.joints_rad("mesa_left")  # moved back: nobody knows how exactly
        rospy.sleep(1.0)
        self.assertIsNone(self.place("mesa_left/sbs_world"))
        answer = rospy.ServiceProxy("/frames/load_calibration", LoadCalibration)(self.path)
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: self.place("mesa_left/sbs_world") is not None, "the base known again")

    def test_5_the_guided_procedure_in_a_terminal(self) -> None:
        arms = ("mesa_left", "mesa_right")
        config = yaml.safe_load((ROOT / "config" / "calibration.yaml").read_text(encoding="utf-8"))
        config["global_frame_registration"].update(register=list(arms), touch_s=0.2)
        directory = Path(tempfile.mkdtemp())
        (directory / "calibration.yaml").write_text(yaml.safe_dump(config), encoding="utf-8")
        out = directory / "guided.yaml"
        command = ["rosrun", "saras_ros1", "calibrate", "--config", str(directory / "calibration.yaml")]
        command += ["--out", str(out), "--rounds", "2", "--known-to-mm", "2"]
        said: list[str] = []
        with subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env={**os.environ, "COLUMNS": "200"}
        ) as program:
            undone = False
            for text in prompts(program.stdout):
                said.append(text)
                if "(Enter, u, s, q)" not in text:
                    continue
                arm, dot = re.findall(r"(mesa_\w+): tip on dot (\d)", text)[-1]
                answer = ""
                if int(dot) not in self.room.reachable_dots(arm):
                    answer = "s"
                elif "taken" in text and not undone:
                    answer, undone = "u", True
                else:
                    type(self).tips[arm] = self.room.touch(arm, int(dot)).mean(axis=0)
                    rospy.sleep(0.2)
                program.stdin.write(answer + "\n")
                program.stdin.flush()
            self.assertEqual(program.wait(30.0), 0, "".join(said)[-2000:])
        self.assertIn("forgotten: touch", "".join(said))
        found = FileOfCalibration.load(out, frames=[self.room.frame(arm) for arm in arms])
        for arm in arms:
            off = saras.displacement(found.frames[self.room.frame(arm)].parent_T_frame, self.room.truth(arm))
            self.assertLess(np.linalg.norm(off[:3]), 3e-3)


def prompts(stream):
    """What a program prints, cut at each of its prompts and at each line."""
    text = ""
    while character := stream.read(1):
        text += character
        if text.endswith(("(Enter, u, s, q) ", "\n")):
            yield text
            text = "" if text.endswith("\n") and "taken" not in text else text if text.endswith("\n") else ""
    yield text


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "calibration", Calibration)
