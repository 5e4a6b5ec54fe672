"""csa_sim: stands in for the arms of a system file that are simulated ones, with CRTK's topics under their names.

The simulated hand goes where /<master>/hand/intended says (PointStamped, from its start). One thread does it all.
"""

from __future__ import annotations

import time

import numpy as np
import rospy
from crtk_msgs.msg import OperatingState, StringStamped
from geometry_msgs.msg import PointStamped, PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState

from saras.crtk import StateMachine
from saras.csa.arms import SIMULATED
from saras.csa.simulated_arms import SimulatedMaster, SimulatedSlave
from saras_ros1 import convert
from saras_ros1.csa_node import CsaNode, joint_state
from saras_ros1.node import run

DT_MAX_S = 0.05


class State:
    """operating_state and state_command of one arm."""

    def __init__(self, node: CsaSim, name: str) -> None:
        self.machine = StateMachine("ENABLED", is_homed=True)
        self.name, self._lock = name, node.lock
        self._out = node.output(f"/{name}/operating_state", OperatingState, latch=True)
        rospy.Subscriber(f"/{name}/state_command", StringStamped, self._on_command, queue_size=5)
        self._tell()

    def _on_command(self, message: StringStamped) -> None:
        with self._lock:
            try:
                self.machine.command(message.string)
            except ValueError as error:
                rospy.logerr(f"{self.name}: {error}")
            self._tell()

    def _tell(self) -> None:
        message = OperatingState(state=self.machine.state, is_homed=self.machine.is_homed, is_busy=False)
        message.header.stamp = rospy.Time.now()
        self._out.publish(message)


class CsaSim(CsaNode):
    """Those arms of the teleoperation whose type begins with simulated_."""

    def __init__(self) -> None:
        super().__init__("csa_sim")
        self.hand = self.arm = None
        if self.setup.master["type"] in SIMULATED:
            self._make_master(self.master)
        if self.setup.slave["type"] in SIMULATED:
            self._make_slave(self.slave)
        if self.hand is None and self.arm is None:
            rospy.loginfo(f"{self.name}: {self.setup.name} has no simulated arm: nothing to do")
        self._last_s = time.monotonic()
        self.ticks = self._ticks_at_report = 0
        self.every(self.setup.period_s, self.tick)

    def _make_master(self, name: str) -> None:
        self.hand, self.hand_state = SimulatedMaster(self.setup), State(self, name)
        self.hand_pose = self.output(f"/{name}/measured_cp", PoseStamped)
        self.hand_twist = self.output(f"/{name}/measured_cv", TwistStamped)
        self._subscribe(f"/{name}/hand/intended", PointStamped, self._on_intended)
        if self.hand.model is None:
            self._subscribe(f"/{name}/servo_cf", WrenchStamped, lambda m: self.hand.obey_force(convert.wrench(m)[:3]))
        else:
            self.hand_joints = self.output(f"/{name}/measured_js", JointState)
            self._subscribe(f"/{name}/servo_jf", JointState, self._on_torques)

    def _make_slave(self, name: str) -> None:
        self.arm, self.arm_state = SimulatedSlave(self.setup), State(self, name)
        self.arm_outputs = [
            self.output(f"/{name}/{topic}", kind)
            for topic, kind in (
                ("measured_js", JointState),
                ("setpoint_js", JointState),
                ("measured_cp", PoseStamped),
                ("measured_cv", TwistStamped),
            )
        ]
        self._subscribe(f"/{name}/servo_jp", JointState, self._on_set_point)

    def _subscribe(self, topic: str, message_class: type, obey) -> None:
        def on_message(message) -> None:
            try:
                with self.lock:
                    obey(message)
            except ValueError as error:
                rospy.logerr_throttle(1.0, f"{topic} refused: {error}")

        rospy.Subscriber(topic, message_class, on_message, queue_size=1, tcp_nodelay=True)

    def _on_intended(self, message: PointStamped) -> None:
        self.hand.intended = convert.point(message)

    def _on_torques(self, message: JointState) -> None:
        torque = np.array(message.effort, dtype=float)
        if torque.shape != self.hand.q.shape or not np.isfinite(torque).all():
            raise ValueError(f"{torque.tolist()}: must be {len(self.hand.q)} finite efforts")
        if self.hand_state.machine.ready:
            self.hand.obey_torques(torque)

    def _on_set_point(self, message: JointState) -> None:
        if not self.arm_state.machine.ready:
            raise ValueError(f"arm is {self.arm_state.machine.state}")
        if refused := self.arm.obey(message.position):
            raise ValueError(refused)

    def tick(self) -> None:
        """One step of what is simulated, and what it publishes."""
        now = time.monotonic()
        with self.lock:
            dt, self._last_s = min(now - self._last_s, DT_MAX_S), now
            stamp = rospy.Time.now()
            if self.arm is not None:
                self.arm.step(dt)
                self._publish_slave(stamp)
            if self.hand is not None:
                self.hand.step(dt)
                self._publish_master(stamp)
            self.ticks += 1

    def _publish_slave(self, stamp: rospy.Time) -> None:
        arm, names = self.arm, self.arm.model.joint_names
        joints, set_point, pose, twist = self.arm_outputs
        joints.publish(joint_state(names, stamp, position=arm.joints.measured, velocity=arm.joints.rate))
        set_point.publish(joint_state(names, stamp, position=arm.set_point))
        pose.publish(convert.pose_msg(arm.pose, self.frame, stamp))
        twist.publish(convert.twist_msg(arm.twist, self.frame, stamp))

    def _publish_master(self, stamp: rospy.Time) -> None:
        hand = self.hand
        if hand.model is not None:
            self.hand_joints.publish(joint_state(hand.model.joint_names, stamp, position=hand.q))
        self.hand_pose.publish(convert.pose_msg(hand.pose, self.master, stamp))
        twist = np.concatenate([hand.velocity, np.zeros(3)])
        self.hand_twist.publish(convert.twist_msg(twist, self.master, stamp))

    def report(self) -> dict:
        """Its rate, and the force on the hand."""
        ticks, self._ticks_at_report = self.ticks - self._ticks_at_report, self.ticks
        force = 0.0 if self.hand is None else float(np.linalg.norm(self.hand.force))
        return {"rate_hz": ticks, "hand_force_N": round(force, 2)}


def main() -> int:
    """Runs the node."""
    return run(CsaSim)
