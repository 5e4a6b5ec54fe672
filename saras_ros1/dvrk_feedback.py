"""What a simulated da Vinci arm publishes, under CRTK's names and under the older ones.

One table; a message is built only for topics that someone reads.
"""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, Header, MultiArrayDimension

from saras.crtk import SimulatedCrtkArm
from saras_ros1 import convert

# CRTK's name → the name before it, under /dvrk/<arm>/.
OLD_FEEDBACK = {
    "measured_js": "state_joint_current",
    "setpoint_js": "state_joint_desired",
    "measured_cp": "position_cartesian_current",
    "setpoint_cp": "position_cartesian_desired",
    "local/measured_cp": "position_cartesian_local_current",
    "body/measured_cv": "twist_body_current",
    "body/measured_cf": "wrench_body_current",
    "jacobian": "jacobian_spatial",
    "body/jacobian": "jacobian_body",
    "jaw/measured_js": "state_jaw_current",
    "gripper/measured_js": "state_gripper_current",
}
REFRESH_EVERY = 20  # ticks between two looks at who reads what


class Snapshot:
    """One tick of one arm; what is costly is computed when the first topic asks for it."""

    def __init__(self, arm: SimulatedCrtkArm, frame: str, stamp: rospy.Time) -> None:
        self.arm, self.frame, self.stamp = arm, frame, stamp
        self.q, self.v, self.goal = arm.joints.q, arm.joints.v, arm.joints.goal
        self._local: np.ndarray | None = None
        self._jacobian: np.ndarray | None = None

    @property
    def base_T_tip(self) -> np.ndarray:
        """(4, 4) from the remote centre."""
        if self._local is None:
            self._local = self.arm.kinematics.forward(self.q)
        return self._local

    @property
    def reference_T_tip(self) -> np.ndarray:
        """(4, 4) with the base frame."""
        return self.arm.reference_T_base @ self.base_T_tip

    @property
    def jacobian(self) -> np.ndarray:
        """(6, n) in the axes of the reference frame."""
        if self._jacobian is None:
            self._jacobian = rotated(self.arm.reference_T_base[:3, :3]) @ self.arm.kinematics.jacobian(self.q)
        return self._jacobian

    @property
    def body_jacobian(self) -> np.ndarray:
        """(6, n) in the axes of the tip."""
        return rotated(self.reference_T_tip[:3, :3].T) @ self.jacobian


def rotated(rotation: np.ndarray) -> np.ndarray:
    """(6, 6) that turns twists and wrenches."""
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = rotation
    return both


def joint_state(names: list[str], stamp: rospy.Time, q: Any, v: Any, effort: Any) -> JointState:
    """A JointState; a vector that is not empty has the joint count."""
    return JointState(Header(stamp=stamp), names, q.tolist(), v.tolist(), effort.tolist())


def matrix_msg(matrix: np.ndarray) -> Float64MultiArray:
    """A matrix, row by row."""
    rows, columns = matrix.shape
    message = Float64MultiArray(data=matrix.ravel().tolist())
    message.layout.dim = [
        MultiArrayDimension("rows", rows, rows * columns),
        MultiArrayDimension("cols", columns, columns),
    ]
    return message


class Feedback:
    """The publishers of one arm.

    old_names: also those under /dvrk/<arm>/. display_every: ticks between two joint states for robot_state_publisher,
    on /visualization/<arm>/joint_states: at the full rate three of those cost more than this node.
    """

    def __init__(self, arm: SimulatedCrtkArm, old_names: bool, display_every: int) -> None:
        names, zeros = list(arm.kinematics.joint_names), np.zeros(len(arm.joints.q))
        base, tip = arm.name, f"{arm.name}_tool_tip"
        builders: dict[str, tuple[type, Callable[[Snapshot], Any]]] = {
            "measured_js": (JointState, lambda s: joint_state(names, s.stamp, s.q, s.v, arm.effort)),
            "measured_cp": (PoseStamped, lambda s: convert.pose_msg(s.reference_T_tip, s.frame, s.stamp)),
            "setpoint_js": (JointState, lambda s: joint_state(names, s.stamp, s.q, s.v, arm.effort)),
            "setpoint_cp": (PoseStamped, lambda s: convert.pose_msg(s.reference_T_tip, s.frame, s.stamp)),
            "goal_js": (JointState, lambda s: joint_state(names, s.stamp, s.goal, zeros, zeros)),
            "goal_cp": (PoseStamped, lambda s: convert.pose_msg(arm.forward(s.goal), s.frame, s.stamp)),
            "local/measured_cp": (PoseStamped, lambda s: convert.pose_msg(s.base_T_tip, base, s.stamp)),
            "local/setpoint_cp": (PoseStamped, lambda s: convert.pose_msg(s.base_T_tip, base, s.stamp)),
            "measured_cv": (TwistStamped, lambda s: convert.twist_msg(s.jacobian @ s.v, s.frame, s.stamp)),
            "body/measured_cv": (TwistStamped, lambda s: convert.twist_msg(s.body_jacobian @ s.v, tip, s.stamp)),
            "spatial/measured_cv": (TwistStamped, lambda s: convert.twist_msg(s.jacobian @ s.v, s.frame, s.stamp)),
            # Nothing pushes the simulated arm.
            "measured_cf": (WrenchStamped, lambda s: convert.wrench_msg(np.zeros(6), tip, s.stamp)),
            "body/measured_cf": (WrenchStamped, lambda s: convert.wrench_msg(np.zeros(6), tip, s.stamp)),
            "spatial/measured_cf": (WrenchStamped, lambda s: convert.wrench_msg(np.zeros(6), s.frame, s.stamp)),
            "jacobian": (Float64MultiArray, lambda s: matrix_msg(s.jacobian)),
            "spatial/jacobian": (Float64MultiArray, lambda s: matrix_msg(s.jacobian)),
            "body/jacobian": (Float64MultiArray, lambda s: matrix_msg(s.body_jacobian)),
        }
        jaw = arm.jaw
        if jaw is not None:
            zero = np.zeros(1)
            for name in ("jaw/measured_js", "jaw/setpoint_js", "gripper/measured_js"):
                label = [name.split("/")[0]]
                builders[name] = (
                    JointState,
                    lambda s, label=label: joint_state(label, s.stamp, jaw.q, jaw.v, zero),
                )
        self._arm = arm
        self._display = rospy.Publisher(f"/visualization/{arm.name}/joint_states", JointState, queue_size=20)
        self._display_every, self._build_display = display_every, builders["measured_js"][1]
        self._topics: list[tuple[rospy.Publisher, Callable[[Snapshot], Any]]] = []
        for name, (message_class, build) in builders.items():
            self._add(f"/{arm.name}/{name}", message_class, build)
            if old_names and name in OLD_FEEDBACK:
                self._add(f"/dvrk/{arm.name}/{OLD_FEEDBACK[name]}", message_class, build)
        self._read: list[tuple[rospy.Publisher, Callable[[Snapshot], Any]]] = []
        self._tick = 0

    def _add(self, topic: str, message_class: type, build: Callable[[Snapshot], Any]) -> None:
        self._topics.append((rospy.Publisher(topic, message_class, queue_size=20), build))

    def publish(self, frame: str, stamp: rospy.Time) -> None:
        """One message on each topic that someone reads; all carry the same stamp, measured_js first."""
        if self._tick % REFRESH_EVERY == 0:
            self._read = [topic for topic in self._topics if topic[0].get_num_connections()]
        self._tick += 1
        shown = self._tick % self._display_every == 0 and self._display.get_num_connections() > 0
        if not self._read and not shown:
            return
        snapshot = Snapshot(self._arm, frame, stamp)
        for publisher, build in self._read:
            publisher.publish(build(snapshot))
        if shown:
            self._display.publish(self._build_display(snapshot))
