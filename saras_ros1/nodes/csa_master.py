"""csa_master: the surgeon's arm for the rest of the system, and the wrench on the hand as torques of its joints.

Gives /csa/master/measured_cp and measured_cv in the slave's axes; takes /csa/master/servo_cf (csa_teleop) or, where the
system file says so, /csa/master/external_wrench. A wrench that is too old is none. The arm is commanded only while
teleoperation is enabled; when that ends, or csa_teleop falls silent, it is told to hold where it is.
"""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import Empty

from saras import csa
from saras_ros1 import convert
from saras_ros1.csa_node import CsaNode, Need, joint_reader, joint_state
from saras_ros1.msg import CsaTeleopState
from saras_ros1.node import Tick, run


class CsaMaster(CsaNode):
    """Steps on the arm's joints, or on its pose when it takes forces instead of torques."""

    def __init__(self) -> None:
        super().__init__("csa_master")
        name, setup = self.master, self.setup
        model = setup.master_model
        self.model = model
        if model is not None:
            self.require(
                Need(f"/{name}/measured_js", JointState, "its joints"),
                Need(f"/{name}/servo_jf", JointState, "its torque", listens=True),
            )
            read = joint_reader(len(model.joint_names))
            self.arm = self.input(f"/{name}/measured_js", JointState, read, timeout_s=setup.timeout_s)
            config = csa.MasterMlcConfig(torque_limit=model.torque_limit, gravity=model.gravity is not None)
            self.law = csa.MasterMlc(config, model.gravity)
            self.out = self.output(f"/{name}/servo_jf", JointState)
        else:
            self.require(
                Need(f"/{name}/measured_cp", PoseStamped, "its position"),
                Need(f"/{name}/servo_cf", WrenchStamped, "its force", listens=True),
            )
            self.arm = self.input(f"/{name}/measured_cp", PoseStamped, convert.pose, timeout_s=setup.timeout_s)
            self.out = self.output(f"/{name}/servo_cf", WrenchStamped)
        external = setup.teleop.get("wrench", "computed") == "external"
        source = "/csa/master/external_wrench" if external else "/csa/master/servo_cf"
        read_wrench = convert.in_frame(self.frame, convert.wrench)
        self.wrench = self.input(source, WrenchStamped, read_wrench, timeout_s=setup.timeout_s)
        self.told = self.input("/csa/teleop/state", CsaTeleopState, timeout_s=setup.timeout_s)
        self.hold_out = self.output(f"/{name}/hold", Empty)
        self.commanding = False
        self.pose_out = self.output("/csa/master/measured_cp", PoseStamped)
        self.twist_out = self.output("/csa/master/measured_cv", TwistStamped)
        self.slave_T_master = np.eye(4)
        self.slave_T_master[:3, :3] = setup.slave_R_master
        self.status = "WAITING"
        self._last: np.ndarray | None = None
        self.loop(self.step, [self.arm], period_s=setup.period_s)

    def step(self, tick: Tick) -> None:
        """The pose up, the torques down; nothing of both while the arm is silent."""
        dt = self.pace(tick)
        if tick.stale:
            self._last, self.status = None, f"STALE: nothing from {self.arm.topic}"
        if dt is None or tick.stale:
            return
        rotation = self.slave_T_master[:3, :3]
        pose = self.arm.value if self.model is None else self.model.forward(self.arm.value.q)
        seen = self.slave_T_master @ pose
        before, self._last = self._last, seen
        twist = np.zeros(6)
        if before is not None:
            twist[:3] = (seen[:3, 3] - before[:3, 3]) / dt
        self.pose_out.publish(convert.pose_msg(seen, self.frame, tick.stamp_ns))
        self.twist_out.publish(convert.twist_msg(twist, self.frame, tick.stamp_ns))
        if not self._may_command():
            return
        wrench = self.wrench.fresh_value
        self.status = "OK" if wrench is not None else f"no wrench: nothing from {self.wrench.topic}"
        axes = np.zeros(6)
        if wrench is not None:
            axes[:3], axes[3:] = rotation.T @ wrench[:3], rotation.T @ wrench[3:]
        if self.model is None:
            self.out.publish(convert.wrench_msg(axes, self.master, tick.stamp_ns))
            return
        q = self.arm.value.q
        out = self.law.step(q, self.model.jacobian(q), axes, dt, wrench_stale=wrench is None)
        self.out.publish(joint_state(self.model.joint_names, tick.stamp, effort=np.array(out.torque)))

    def _may_command(self) -> bool:
        """Without the surgeon nobody would bear an arm that is told to have no torque."""
        enabled = self.told.fresh and self.told.message.enabled
        if self.commanding and not enabled:
            self.hold_out.publish(Empty())
        self.commanding = enabled
        if not enabled:
            self.status = "WAITING: not enabled" if self.told.fresh else f"STALE: nothing from {self.told.topic}"
        return enabled

    def report(self) -> dict:
        """Whether the hand gets its wrench."""
        return {"status": self.status}


def main() -> int:
    """Runs the node."""
    return run(CsaMaster)
