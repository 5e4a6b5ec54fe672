#!/usr/bin/env python3
"""The simulated da Vinci over the wire. Tests run in the order of their names: the last one kills."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import unittest
import xmlrpc.client

import crtk_msgs.srv
import numpy as np
import PyKDL
import rosgraph
import rospy
import rostest
import tf2_ros
from diagnostic_msgs.msg import KeyValue
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, TransformStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState, Joy
from std_msgs.msg import Bool, Empty, Float64, String
from support import ROOT, Newest, wait_until

from saras.kinematics import dvrk, scene
from saras_ros1 import convert
from saras_ros1.dvrk_inputs import DvrkArmInput

sys.path.insert(0, str(ROOT / "tests"))
from fakes.crtk_client import Arm, DvrkArm

PATIENT_S = 2.0  # a busy machine is no fault: the client's interval here
START = np.array([0.1, 0.05, 0.1, 0.3, 0.2, -0.1])


def pid_of(node: str) -> int:
    return xmlrpc.client.ServerProxy(rosgraph.Master("/dvrk_test").lookupNode(node)).getPid("/dvrk_test")[2]


def matrix(frame: PyKDL.Frame) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, :3] = [[frame.M[i, j] for j in range(3)] for i in range(3)]
    pose[:3, 3] = list(frame.p)
    return pose


class Dvrk(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("dvrk_test")
        cls.arm = Arm("PSM1", PATIENT_S)
        cls.errors = Newest("/PSM1/error", String)
        cls.arm.ral.check_connections(30.0)
        wait_until(lambda: cls.arm.operating_state() == "ENABLED", "PSM1 enabled")
        wait_until(lambda: cls.errors.subscriber.get_num_connections(), "PSM1/error")

    def refused(self, *words: str) -> None:
        """The newest error says all the words, and comes once."""
        wait_until(lambda: self.errors.all, f"an error with {words}")
        text = self.errors.all[-1].data
        for word in words:
            self.assertIn(word, text)
        self.errors.clear()

    def go_to(self, q: np.ndarray) -> None:
        self.assertTrue(self.arm.move_jp(q).wait())
        np.testing.assert_allclose(self.arm.measured_jp(age=0.0, wait=PATIENT_S), q, atol=1e-9)

    # ---- a CRTK client

    def test_a1_types_are_those_of_crtk(self) -> None:
        said = subprocess.run(["rostopic", "type", "/PSM1/operating_state"], capture_output=True, text=True, check=True)
        self.assertEqual(said.stdout.strip(), "crtk_msgs/OperatingState")
        said = subprocess.run(
            ["rostopic", "echo", "-n1", "/PSM1/operating_state/state"], capture_output=True, text=True, check=True
        )
        self.assertIn("ENABLED", said.stdout)

    def test_a2_move_jp_is_busy_until_it_is_there(self) -> None:
        handle = self.arm.move_jp(START)
        self.assertTrue(handle.wait(is_busy=True))
        self.assertTrue(handle.wait())
        self.assertFalse(self.arm.is_busy())
        np.testing.assert_allclose(self.arm.measured_jp(age=0.0, wait=PATIENT_S), START, atol=1e-9)
        self.assertTrue(self.arm.move_jp(START).wait())  # to where it is: busy for a moment, then not
        self.assertTrue(self.arm.move_jr(np.array([0.1, 0, 0, 0, 0, 0])).wait())
        self.assertAlmostEqual(self.arm.measured_jp(age=0.0, wait=PATIENT_S)[0], START[0] + 0.1)

    def test_a3_cartesian(self) -> None:
        self.go_to(START)
        goal = self.arm.setpoint_cp(age=0.0, wait=PATIENT_S)
        goal.p += PyKDL.Vector(0.01, 0.01, 0.005)
        self.assertTrue(self.arm.move_cp(goal).wait())
        np.testing.assert_allclose(matrix(self.arm.measured_cp(age=0.0, wait=PATIENT_S)), matrix(goal), atol=1e-6)
        goal.p += PyKDL.Vector(0.0, 0.0, 0.002)
        self.arm.servo_cp(goal)
        wait_until(lambda: (self.arm.measured_cp(age=0.0, wait=PATIENT_S).p - goal.p).Norm() < 1e-6, "servo_cp")
        self.arm.servo_jp(START)
        wait_until(lambda: np.allclose(self.arm.setpoint_jp(age=0.0, wait=PATIENT_S), START, atol=1e-9), "servo_jp")

    def test_a4_services_and_jacobian(self) -> None:
        self.go_to(START)
        psm = dvrk.psm()
        frame, result, message = self.arm.forward_kinematics(START)
        self.assertTrue(result, message)
        np.testing.assert_allclose(matrix(frame), psm.forward(START), atol=1e-9)
        q, result, message = self.arm.inverse_kinematics(START + 0.01, frame)
        self.assertTrue(result, message)
        np.testing.assert_allclose(q, START, atol=1e-6)
        frame.p = PyKDL.Vector(0, 0, -0.9)
        _, result, message = self.arm.inverse_kinematics(START, frame)
        self.assertFalse(result)
        self.assertIn("insertion", message)
        _, result, message = self.arm.forward_kinematics(START[:4])
        self.assertFalse(result)
        self.assertIn("must be 6", message)
        wait_until(lambda: np.allclose(self.arm.jacobian(), psm.jacobian(START), atol=1e-6), "the jacobian")

    def test_a5_one_stamp_and_what_else_is_said(self) -> None:
        topics = {
            "measured_js": JointState, "measured_cp": PoseStamped, "local/measured_cp": PoseStamped,
            "measured_cv": TwistStamped, "body/measured_cf": WrenchStamped, "goal_js": JointState,
            "goal_cp": PoseStamped, "jaw/measured_js": JointState, "gripper/measured_js": JointState,
        }  # fmt: skip
        newest = {name: Newest(f"/PSM1/{name}", kind) for name, kind in topics.items()}
        for topic in newest.values():
            wait_until(lambda topic=topic: topic.message, topic.topic)

        def stamps(name: str) -> set:
            return {m.header.stamp.to_nsec() for m in newest[name].all}

        wait_until(lambda: len(stamps("measured_js") & stamps("measured_cp")) > 20, "shared stamps")
        js = newest["measured_js"].message
        self.assertEqual(js.name, list(dvrk.PSM_JOINT_NAMES))
        self.assertEqual({len(js.position), len(js.velocity), len(js.effort)}, {6})
        self.assertEqual(newest["local/measured_cp"].message.header.frame_id, "PSM1")
        np.testing.assert_array_equal(convert.wrench(newest["body/measured_cf"].message), 0.0)
        for topic in newest.values():
            topic.subscriber.unregister()

    def test_a6_the_state_table_over_the_wire(self) -> None:
        arm = self.arm
        self.errors.clear()
        for command, state in (("pause", "PAUSED"), ("resume", "ENABLED"), ("disable", "DISABLED")):
            arm.state_command(command)
            self.assertTrue(arm.wait_for_operating_state(state, 10.0), command)
        for command in ("pause", "resume", "dance"):
            arm.state_command(command)
            self.refused("PSM1", command)
            self.assertEqual(arm.operating_state(), "DISABLED")
        arm.move_jp(START)
        self.refused("move_jp refused", "DISABLED")
        self.assertTrue(arm.enable(10.0))
        arm.state_command("unhome")
        wait_until(lambda: not arm.is_homed(), "not homed")
        arm.servo_jp(START)
        self.refused("servo_jp refused", "not homed")
        self.assertTrue(arm.home(10.0))
        arm.state_command("pause")
        self.assertTrue(arm.wait_for_operating_state("PAUSED", 10.0))
        arm.state_command("enable")
        self.refused("enable", "PAUSED")
        arm.state_command("resume")
        self.assertTrue(arm.wait_for_operating_state("ENABLED", 10.0))

    def test_a7_invalid_commands_are_refused_and_reported(self) -> None:
        self.go_to(START)
        self.errors.clear()
        self.arm.move_jp(np.array([0, 0, 0.5, 0, 0, 0]))
        self.refused("insertion [m] = 0.5: must be in [0, 0.24]")
        self.arm.servo_jp(START[:3])
        self.refused("3 values: must be 6")
        self.arm.servo_jp(START * np.nan)
        self.refused("must be finite")
        far = PyKDL.Frame(PyKDL.Vector(1.0, 0, 0))
        self.arm.move_cp(far)
        self.refused("move_cp refused", "must be in [")
        publisher = rospy.Publisher("/PSM1/servo_cp", PoseStamped, queue_size=1)
        wait_until(publisher.get_num_connections, "servo_cp")
        bad = PoseStamped()  # a zero quaternion
        publisher.publish(bad)
        self.refused("servo_cp refused", "quaternion norm 0")
        wrong = convert.pose_msg(dvrk.psm().forward(START), "mesa_left/sbs_world", rospy.Time.now())
        publisher.publish(wrong)
        self.refused("frame_id 'mesa_left/sbs_world'", "must be 'PSM1'")
        np.testing.assert_allclose(self.arm.measured_jp(age=0.0, wait=PATIENT_S), START, atol=1e-9)
        self.assertFalse(self.arm.is_busy())

    def test_a8_the_endoscope_is_commanded_alike(self) -> None:
        ecm = Arm("ECM", PATIENT_S)
        ecm.ral.check_connections(30.0)
        q = np.array([0.1, -0.1, 0.12, 0.2])
        self.assertTrue(ecm.move_jp(q).wait())
        np.testing.assert_allclose(matrix(ecm.measured_cp(age=0.0, wait=PATIENT_S)), dvrk.ecm().forward(q), atol=1e-9)

    def test_a9_the_jaw_waits_on_the_arms_state(self) -> None:
        jaw = self.dvrk_psm().jaw
        for angle in (0.8, 0.8, 0.0):
            self.assertTrue(jaw.move_jp(np.array([angle])).wait())
            np.testing.assert_allclose(jaw.measured_jp(age=0.0, wait=PATIENT_S), [angle], atol=1e-9)

    def dvrk_psm(self) -> DvrkArm:
        """As dvrk_python makes it: it will not start when one of its topics has no peer."""
        psm = DvrkArm("PSM1", PATIENT_S)
        psm.check_connections(30.0)
        wait_until(lambda: psm.operating_state() == "ENABLED", "its state")
        return psm

    def test_b0_a_move_that_begins_while_busy_is_waited_for_too(self) -> None:
        arm = self.dvrk_psm()
        reached = Newest("/PSM1/goal_reached", Bool)
        wait_until(lambda: reached.subscriber.get_num_connections(), "goal_reached")
        self.go_to(START)
        wait_until(lambda: reached.message, "the goal reached")
        self.assertTrue(reached.message.data)
        away = START + np.array([0.4, 0, 0, 0, 0, 0])
        self.assertTrue(arm.move_jp(away).wait(is_busy=True))
        self.assertTrue(arm.move_jp(START).wait())  # a goal that changes on the way
        np.testing.assert_allclose(arm.measured_jp(age=0.0, wait=PATIENT_S), START, atol=1e-9)
        for opening, insertion in ((0.9, 0.12), (0.0, 0.1)):  # jaw and arm together
            self.assertTrue(arm.jaw.move_jp(np.array([opening])).wait(is_busy=True))
            goal = START.copy()
            goal[2] = insertion
            self.assertTrue(arm.move_jp(goal).wait())
            np.testing.assert_allclose(arm.jaw.measured_jp(age=0.0, wait=PATIENT_S), [opening], atol=1e-9)
        handle = arm.move_jp(away)
        self.assertTrue(handle.wait(is_busy=True))
        arm.servo_jp(START)
        self.assertTrue(handle.wait())
        wait_until(lambda: not reached.message.data, "the goal not reached")

    def test_b5_what_dvrk_python_expects_beside_crtk(self) -> None:
        arm = self.dvrk_psm()
        wait_until(lambda: arm.ratio == 1.0, "the ratio at the start")
        arm.trajectory_j_set_ratio(0.25)
        wait_until(lambda: arm.ratio == 0.25, "the ratio")
        self.errors.clear()
        arm.trajectory_j_set_ratio(1.5)
        self.refused("ratio = 1.5", "must be in (0, 1]")
        self.assertEqual(arm.ratio, 0.25)
        arm.trajectory_j_set_ratio(1.0)
        wait_until(lambda: arm.ratio == 1.0, "the ratio as it was")
        for switch in arm.switches.values():
            switch.publish(True)
        frame, result, message = arm.local.forward_kinematics(START)
        self.assertTrue(result, message)
        np.testing.assert_allclose(matrix(frame), dvrk.psm().forward(START), atol=1e-9)
        state = rospy.ServiceProxy("/PSM1/operating_state", crtk_msgs.srv.TriggerOperatingState)().operating_state
        self.assertEqual((state.state, state.is_homed, state.is_busy), ("ENABLED", True, False))
        DvrkArm("ECM", PATIENT_S, jaw=False).check_connections(30.0)

    def test_b6_the_console_powers_all_arms(self) -> None:
        for place in ("console", "system"):
            off, home = (rospy.Publisher(f"/{place}/{n}", Empty, queue_size=1) for n in ("power_off", "home"))
            for publisher in (off, home):
                wait_until(publisher.get_num_connections, publisher.name)
            off.publish()
            self.assertTrue(self.arm.wait_for_operating_state("DISABLED", 10.0))
            home.publish()
            self.assertTrue(self.arm.wait_for_operating_state("ENABLED", 10.0))

    # ---- names before CRTK, console, frames

    def test_b1_older_names_both_ways(self) -> None:
        old = Newest("/dvrk/PSM1/position_cartesian_current", PoseStamped)
        joints = Newest("/dvrk/PSM1/state_joint_current", JointState)
        state = Newest("/dvrk/PSM1/current_state", String)
        wait_until(lambda: old.message and joints.message and state.message, "older names")
        self.assertEqual(state.message.data, "ENABLED")
        joint_goal = rospy.Publisher("/dvrk/PSM1/set_position_goal_joint", JointState, queue_size=1)
        pose_goal = rospy.Publisher("/dvrk/PSM1/set_position_goal_cartesian", Pose, queue_size=1)
        jaw = rospy.Publisher("/dvrk/PSM1/set_position_jaw", JointState, queue_size=1)
        desired = rospy.Publisher("/dvrk/PSM1/set_desired_state", String, queue_size=1)
        for publisher in (joint_goal, pose_goal, jaw, desired):
            wait_until(publisher.get_num_connections, publisher.name)
        goal = START + np.array([0.05, 0, 0.01, 0, 0, 0])
        joint_goal.publish(JointState(position=goal.tolist()))
        wait_until(lambda: np.allclose(joints.message.position, goal, atol=1e-9), "the old joint goal")
        psm = dvrk.psm()
        wait_until(lambda: np.allclose(convert.pose(old.message), psm.forward(goal), atol=1e-9), "the old pose")
        there = psm.forward(START)
        pose_goal.publish(Pose(Point(*there[:3, 3]), Quaternion(*convert.quaternion(there))))
        wait_until(lambda: np.allclose(joints.message.position, START, atol=1e-6), "the old pose goal")
        opened = Newest("/dvrk/PSM1/state_jaw_current", JointState)
        jaw.publish(JointState(position=[0.5]))
        wait_until(lambda: opened.message and opened.message.position[0] == 0.5, "the jaw")
        desired.publish("DISABLED")
        wait_until(lambda: self.arm.operating_state() == "DISABLED", "disabled by the old name")
        desired.publish("READY")
        wait_until(lambda: self.arm.operating_state() == "ENABLED", "ready by the old name")

    def test_b2_console_and_pedals(self) -> None:
        clutch = Newest("/footpedals/clutch", Joy)
        old_clutch = Newest("/dvrk/console/clutch", Joy)
        present = Newest("/console/operator_present", Joy)
        scale, enabled = Newest("/console/teleop/scale", Float64), Newest("/dvrk/console/teleop/enabled", Bool)
        selected = Newest("/console/teleop/selected", KeyValue)
        wait_until(lambda: clutch.message and present.message and scale.message and enabled.message, "console")
        self.assertEqual((clutch.message.buttons, present.message.buttons), ((0,), (1,)))
        self.assertEqual(scale.message.data, 0.2)
        press = rospy.Publisher("/dvrk_sim/press", KeyValue, queue_size=1)
        enable = rospy.Publisher("/console/teleop/enable", Bool, queue_size=1)
        set_scale = rospy.Publisher("/dvrk/console/teleop/set_scale", Float64, queue_size=1)
        select = rospy.Publisher("/console/teleop/select_teleop", KeyValue, queue_size=1)
        for publisher in (press, enable, set_scale, select):
            wait_until(publisher.get_num_connections, publisher.name)
        press.publish("clutch", "1")
        wait_until(lambda: clutch.message.buttons == (1,) and old_clutch.message.buttons == (1,), "pressed")
        enable.publish(True)
        wait_until(lambda: enabled.message.data, "enabled")
        set_scale.publish(0.4)
        wait_until(lambda: scale.message.data == 0.4, "the scale")
        select.publish("MTML", "PSM1")
        wait_until(lambda: selected.message and selected.message.value == "PSM1", "the selection")

    def test_b3_instruments_are_in_tf_where_measured_cp_says(self) -> None:
        self.go_to(START)
        buffer = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(buffer)
        room = scene.load(ROOT / "config" / "scene.yaml")

        def at(name: str, pose: np.ndarray) -> bool:
            try:
                found = convert.transform(buffer.lookup_transform("world", f"{name}_tool_tip", rospy.Time(0)))
            except tf2_ros.TransformException:
                return False
            return np.allclose(found, room.world_T(name) @ pose, atol=1e-6)

        wait_until(lambda: at("PSM1", dvrk.psm().forward(START)), "world → PSM1_tool_tip")
        del listener

    def test_b4_base_frame(self) -> None:
        publisher = rospy.Publisher("/PSM2/set_base_frame", PoseStamped, queue_size=1)
        measured = Newest("/PSM2/measured_cp", PoseStamped)
        local = Newest("/PSM2/local/measured_cp", PoseStamped)
        wait_until(lambda: publisher.get_num_connections() and measured.message and local.message, "PSM2")
        # Configured relative to the endoscope, as the dVRK does: the tf tree gives the same.
        self.assertEqual(measured.message.header.frame_id, "ECM_tool_tip")
        room = scene.load(ROOT / "config" / "scene.yaml")
        ecm = Newest("/ECM/local/measured_cp", PoseStamped)
        wait_until(lambda: ecm.message, "ECM")
        world_T_view = room.world_T("ECM") @ convert.pose(ecm.message)
        np.testing.assert_allclose(
            world_T_view @ convert.pose(measured.next()), room.world_T("PSM2") @ convert.pose(local.message), atol=1e-6
        )
        base = np.array([[1, 0, 0, 0.2], [0, -0.866, 0.5, 0], [0, -0.5, -0.866, 0], [0, 0, 0, 1.0]])
        base[1:3, 1:3] /= np.sqrt(0.866**2 + 0.25)
        publisher.publish(convert.pose_msg(base, "ECM", rospy.Time.now()))
        wait_until(lambda: measured.message.header.frame_id == "ECM", "the new frame")
        expected = base @ convert.pose(local.message)
        np.testing.assert_allclose(convert.pose(measured.next()), expected, atol=1e-6)
        self.assertEqual(local.message.header.frame_id, "PSM2")

    # ---- the platform's reader

    def reader(self, name: str, **options) -> DvrkArmInput:
        return DvrkArmInput(None, name, timeout_s=options.pop("timeout_s", 2.0), **options)

    def test_c1_reads_the_simulated_arm(self) -> None:
        self.go_to(START)
        reader = self.reader("PSM1")
        wait_until(lambda: reader.fresh, lambda: reader.unknown_reason)
        np.testing.assert_allclose(reader.pose, dvrk.psm().forward(START), atol=1e-9)
        self.assertEqual(reader.frame_id, "PSM1")
        self.assertEqual(self.reader("PSM1", frame_override="elsewhere").frame_id, "elsewhere")
        self.assertTrue(self.arm.disable(10.0))
        wait_until(lambda: not reader.fresh, "not believed while disabled")
        self.assertIn("DISABLED", reader.unknown_reason)
        self.assertTrue(self.arm.enable(10.0))
        wait_until(lambda: reader.fresh, lambda: reader.unknown_reason)

    def test_c2_reads_any_naming_type_and_doubts_what_it_should(self) -> None:
        pose = dvrk.psm().forward(START)
        cases = [
            ("OLD", "/dvrk/OLD/position_cartesian_current", PoseStamped, "DVRK_POSITION_JOINT"),
            ("TRANSFORM", "/TRANSFORM/measured_cp", TransformStamped, "READY"),
        ]
        for name, topic, kind, word in cases:
            reader = self.reader(name)
            self.assertIn("nothing on", reader.unknown_reason)
            state = rospy.Publisher(f"/dvrk/{name}/current_state", String, queue_size=1, latch=True)
            publisher = rospy.Publisher(topic, kind, queue_size=1)
            wait_until(publisher.get_num_connections, topic)

            def message(frame="base", stamp=None, kind=kind, pose=pose):
                stamp = rospy.Time.now() if stamp is None else stamp
                if kind is PoseStamped:
                    return convert.pose_msg(pose, frame, stamp)
                return convert.transform_msg(pose, frame, "tip", stamp)

            def say(reader=reader, publisher=publisher, **how):
                count = reader.received + reader.rejected
                publisher.publish(message(**how))
                wait_until(lambda: reader.received + reader.rejected > count, "the pose")

            say()
            self.assertTrue(reader.fresh, "an arm that never says its state")
            reader.require_state = True
            self.assertIn("state is not known", reader.unknown_reason)
            state.publish(word)
            wait_until(lambda reader=reader: reader.state, "the state")
            say()
            self.assertTrue(reader.fresh, reader.unknown_reason)
            np.testing.assert_allclose(reader.pose, pose, atol=1e-12)
            say(stamp=rospy.Time(0))
            self.assertIn("zero stamp", reader.unknown_reason)
            say(frame="")
            self.assertIn("names no frame", reader.unknown_reason)
            count = reader.received
            publisher.publish(message(pose=pose * np.nan))
            wait_until(lambda reader=reader, count=count: reader.received > count, "the bad pose")
            self.assertIn("not finite", reader.unknown_reason)
            say()
            self.assertTrue(reader.fresh)
            reader.timeout_s = 0.1
            wait_until(lambda reader=reader: "old" in reader.unknown_reason, "its age")

    def test_d_killed_arm_is_unknown(self) -> None:
        reader = self.reader("PSM1", timeout_s=0.15)
        wait_until(lambda: reader.fresh, lambda: reader.unknown_reason)
        os.kill(pid_of("/dvrk_sim"), signal.SIGKILL)
        wait_until(lambda: not reader.fresh, "unknown")
        wait_until(lambda: "s old" in reader.unknown_reason, lambda: reader.unknown_reason)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "dvrk", Dvrk, sys.argv)
