"""csa_proxy: the slave of the virtual environment. It follows the hand through the model of the anatomy.

Steps on /csa/teleop/state; gives /csa/proxy/measured_cp, measured_js and contact (depth in the model, outward normal).
"""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PointStamped, PoseStamped
from sensor_msgs.msg import JointState

from saras import csa
from saras_ros1 import convert
from saras_ros1.csa_node import CsaNode, joint_reader, joint_state, vector
from saras_ros1.msg import Contact, CsaTeleopState
from saras_ros1.node import Tick, run


class CsaProxy(CsaNode):
    """Goes to the slave whenever csa_teleop counts another synchronisation, and at its own start."""

    def __init__(self) -> None:
        super().__init__("csa_proxy")
        setup, self.arm = self.setup, self.setup.slave_model
        self.surface = setup.surface()
        self.law = csa.ProxySlave(self.arm.motion())
        self.slave_joints = self.input(
            "/csa/slave/setpoint_js", JointState, joint_reader(len(self.arm.joint_names)), timeout_s=setup.timeout_s
        )
        self.told = self.input("/csa/teleop/state", CsaTeleopState, read_told, timeout_s=setup.timeout_s)
        self.pose_out = self.output("/csa/proxy/measured_cp", PoseStamped)
        self.joints_out = self.output("/csa/proxy/measured_js", JointState)
        self.contact_out = self.output("/csa/proxy/contact", Contact)
        self.closest_out = self.output("/csa/proxy/closest", PointStamped)
        self.q: np.ndarray | None = None
        self.reason, self._synchronisations = "WAITING", -1
        self.loop(self.step, [self.told], period_s=setup.period_s)

    def step(self, tick: Tick) -> None:
        """Follows; stands still under a hold. Says nothing while it does not know where it is."""
        dt = self.pace(tick)
        if dt is None:
            return
        if tick.stale:
            self.reason = f"STALE: nothing from {self.told.topic}"
            return
        message, desired = self.told.message, self.told.value
        if message.synchronisations != self._synchronisations or self.q is None:
            if not self.slave_joints.fresh:
                self.reason = f"WAITING: nothing from {self.slave_joints.topic}"
                return
            self.q, self._synchronisations = self.slave_joints.value.q.copy(), message.synchronisations
        if not message.hold:
            q = self.q
            out = self.law.step(q, self.arm.jacobian(q), self.arm.forward(q), self.arm.within_reach(desired), dt)
            self.q, self.reason = np.array(out.q), out.reason.name
        pose = self.arm.forward(self.q)
        touch = self.surface.touch(pose[:3, 3])
        self.pose_out.publish(convert.pose_msg(pose, self.frame, tick.stamp_ns))
        self.joints_out.publish(joint_state(self.arm.joint_names, tick.stamp, position=self.q))
        contact = Contact(depth=touch.depth_m)
        contact.header.stamp, contact.header.frame_id = tick.stamp, self.frame
        vector(contact.direction, touch.normal)
        self.contact_out.publish(contact)
        closest = PointStamped(header=contact.header)
        vector(closest.point, touch.closest)
        self.closest_out.publish(closest)

    def report(self) -> dict:
        """Why it does less than it is told."""
        return {"reason": self.reason}


def read_told(message: CsaTeleopState) -> np.ndarray:
    """(4, 4) desired pose. Raises ValueError for what is not finite."""
    return convert.pose(PoseStamped(pose=message.desired))


def main() -> int:
    """Runs the node."""
    return run(CsaProxy)
