"""arm_state, one a side: reads the arm and publishes what it reports, as long as that is worth believing.

Every state goes through the content check and the observer; pose and wrench leave at pose_rate_hz, joints and tool
at joints_rate_hz. A state that is refused publishes nothing: readers see its age.
"""

from __future__ import annotations

import contextlib
from types import SimpleNamespace

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import PointStamped, PoseStamped, Vector3, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Header, String

from saras.kinematics import mesa
from saras.mesa_link import Received, State, Truth
from saras.mesa_link.guard import StateGuard, StateGuardConfig
from saras.mesa_link.poses import to_matrix
from saras.teleop import DisturbanceObserverConfig
from saras_ros1 import convert
from saras_ros1.arm_link import open_driver, stamp_of
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.exerted_wrench import SOURCES, ExertedWrench
from saras_ros1.inputs import Input
from saras_ros1.msg import ArmTruth
from saras_ros1.node import Node, Tick, run


class ArmStateNode(Node):
    """A reader of the arm: any number of them may run, none can move it."""

    def __init__(self) -> None:
        super().__init__("arm_state")
        self.side = side = self.params.text("side", SIDES)
        self.frame = base_frame(side)
        arm_timeout_s = self.params.number("arm_timeout_s", 0.005, 1.0)
        self.pose_rate_hz = self.params.number("pose_rate_hz", 1.0, 1000.0)
        self.joints_rate_hz = self.params.number("joints_rate_hz", 1.0, 1000.0)
        truth_rate_hz = self.params.number("truth_rate_hz", 0.0, 1000.0)
        guard = self.params.section("guard")
        self.guard = StateGuard(StateGuardConfig(**{name: guard.number(name) for name in StateGuardConfig().__dict__}))
        self.wrench = ExertedWrench(
            self,
            side,
            self.params.text("wrench_source", SOURCES),
            self.params.number("contact_timeout_s", 0.005, 1.0),
            self.params.build(DisturbanceObserverConfig, "observer"),
        )
        self.reason = ""
        self.shown = ""
        self.count = 0
        self.rcm_sent: tuple[float, ...] | None = None
        joints = [*mesa.PASSIVE_JOINT_NAMES, *mesa.JOINT_NAMES]
        self.joint_names = [f"mesa_{side}/{name}" for name in joints]
        self.tool_names = [f"mesa_{side}/roll", f"mesa_{side}/jaw"]
        self.pose = self.output(f"/mesa_{side}/ee_pose", PoseStamped)
        self.joints = self.output(f"/mesa_{side}/joint_states", JointState)
        self.tool = self.output(f"/mesa_{side}/tool", JointState)
        self.force = self.output(f"/mesa_{side}/measured_cf", WrenchStamped)
        self.rcm = self.output(f"/mesa_{side}/rcm", PointStamped, latch=True)
        self.operating_state = self.output(f"/mesa_{side}/operating_state", String, latch=True)
        self.tf_static = tf2_ros.StaticTransformBroadcaster()
        self.truth = self.output(f"/mesa_{side}/truth", ArmTruth) if truth_rate_hz else None

        # The arm's states come in as a topic's messages would: same age, same counters, same loop.
        self.source = Input("arm", arm_timeout_s, self._believe, self.lock)
        self.inputs.append(self.source)
        self.loop(self.step, [self.source], period_s=arm_timeout_s)
        self.driver = open_driver(
            self,
            control=False,
            truth_rate_hz=truth_rate_hz,
            on_state=self._on_state,
            on_truth=self._on_truth if truth_rate_hz else None,
        )
        self.params.finish()
        self.every(0.1, self._show)

    def _on_state(self, received: Received) -> None:
        """In the link's thread."""
        header = Header(seq=received.state.tick, stamp=stamp_of(received))
        try:
            self.source.on_message(SimpleNamespace(header=header, received=received))
        except rospy.ROSException:
            pass  # topics are closed: the node shuts down
        except Exception as error:
            rospy.logerr_throttle(1.0, f"{self.name}: {type(error).__name__}: {error}")

    def _believe(self, message: SimpleNamespace) -> State:
        try:
            state = self.guard.check(message.received)
        except ValueError as error:
            self.reason = str(error)
            raise
        self.reason = ""
        return state

    def step(self, tick: Tick) -> None:
        """Publishes the newest state; nothing when there is none."""
        if tick.stale:
            return
        state = self.source.value
        wrench = self.wrench.step(state)
        self.count += 1
        if self.count % _every(state, self.pose_rate_hz) == 0:
            pose = to_matrix(state.position, state.quaternion)
            self.pose.publish(convert.pose_msg(pose, self.frame, tick.stamp_ns))
            if wrench is not None:
                self.force.publish(convert.wrench_msg(wrench, self.frame, tick.stamp_ns))
        if self.count % _every(state, self.joints_rate_hz) == 0:
            self._publish_joints(state, tick.stamp)
        if state.rcm != self.rcm_sent:
            self._publish_rcm(state, tick.stamp)

    def _publish_joints(self, state: State, stamp: rospy.Time) -> None:
        header = Header(stamp=stamp)
        velocities = [0.0] * len(state.passive) + list(state.joint_velocities)
        self.joints.publish(JointState(header, self.joint_names, [*state.passive, *state.joints], velocities, []))
        self.tool.publish(JointState(header, self.tool_names, [state.joints[5], state.jaw], [], []))

    def _publish_rcm(self, state: State, stamp: rospy.Time) -> None:
        self.rcm_sent = state.rcm
        message = PointStamped()
        message.header.frame_id, message.header.stamp = self.frame, stamp
        message.point.x, message.point.y, message.point.z = state.rcm
        self.rcm.publish(message)
        base_T_rcm = np.eye(4)
        base_T_rcm[:3, 3] = state.rcm
        self.tf_static.sendTransform(convert.transform_msg(base_T_rcm, self.frame, f"mesa_{self.side}/rcm", stamp))

    def _on_truth(self, truth: Truth) -> None:
        message = ArmTruth(depth=truth.depth_m, tip_force=Vector3(*truth.tip_force))
        message.rcm_deviation = truth.rcm_deviation_m
        message.header.frame_id, message.header.stamp = self.frame, rospy.Time.now()
        with contextlib.suppress(rospy.ROSException):  # topics are closed: the node shuts down
            self.truth.publish(message)

    def _show(self) -> None:
        """operating_state, in CRTK's words, when it changes."""
        with self.lock:
            state = self.source.fresh_value
            if state is None:
                text = "FAULT"
                self.state = f"FAULT: {self.reason or self.driver.stats().last_error or 'the arm is silent'}"
            else:
                text = "DISABLED" if not state.brakes else "ENABLED" if state.following else "PAUSED"
                self.state = text
            changed, self.shown = text != self.shown, text
        if changed:
            (rospy.logerr if text == "FAULT" else rospy.loginfo)(f"{self.name}: {self.state}")
            self.operating_state.publish(String(text))

    def report(self) -> dict:
        """Link, wrench source, and what the arm itself refused."""
        stats, received = self.driver.stats(), self.driver.latest_state()
        values = {
            "link": "connected" if stats.connected else stats.last_error or "connecting",
            "bad_states": stats.bad_states,
            "wrench_from": self.wrench.used,
            "why": self.reason or "none",
        }
        if received is not None:
            values["lag_ms"] = round(1e3 * received.lag_s, 2)
            values["controller"] = received.state.controller or "none"
            values.update({f"arm_dropped_{reason}": count for reason, count in received.state.dropped.items()})
        return values


def _every(state: State, rate_hz: float) -> int:
    """How many states make one message at rate_hz."""
    return max(1, round(1.0 / (rate_hz * state.period_s)))


def main() -> int:
    """Runs the node."""
    return run(ArmStateNode)
