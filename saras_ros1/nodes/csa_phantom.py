"""csa_phantom: the simulated phantom on its plate, and the force sensor underneath, in a process of their own.

Steps on /<slave>/measured_cp; gives the force on the slave's force topic and, where the system file says that it is
known, the stiffness under the tip on /csa/slave/stiffness.
"""

from __future__ import annotations

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped

from saras import ConfigError, sim
from saras_ros1 import convert
from saras_ros1.csa_node import CsaNode
from saras_ros1.msg import CsaStiffness
from saras_ros1.node import Tick, run


class CsaPhantom(CsaNode):
    """Silent while the arm is."""

    def __init__(self) -> None:
        super().__init__("csa_phantom")
        setup, force = self.setup, self.setup.slave.get("force", {})
        if "phantom" not in setup.teleop:
            rospy.loginfo(f"{self.name}: {setup.name} has no phantom: nothing to do")
            return
        if force.get("axes", "base") != "base" or force.get("exerted_on", "tissue") != "tissue":
            raise ConfigError(f"{setup.path}: {self.slave}: force: the plate's is exerted on the tissue, base axes")
        self.tissue = sim.Tissue(setup.tissue_config())
        pose, twist = convert.in_frame(self.frame, convert.pose), convert.in_frame(self.frame, convert.twist)
        self.pose = self.input(f"/{self.slave}/measured_cp", PoseStamped, pose, timeout_s=setup.timeout_s)
        self.twist = self.input(f"/{self.slave}/measured_cv", TwistStamped, twist, timeout_s=setup.timeout_s)
        self.force_out = self.output(force.get("topic", f"/{self.slave}/measured_cf"), WrenchStamped)
        known = setup.phantom().get("stiffness_known", True)
        self.stiffness_out = self.output("/csa/slave/stiffness", CsaStiffness) if known else None
        self.force_N = 0.0
        self.loop(self.step, [self.pose], period_s=setup.period_s)

    def step(self, tick: Tick) -> None:
        """One reading of the sensor."""
        dt = self.pace(tick)
        if dt is None or tick.stale:
            return
        velocity = self.twist.value[:3] if self.twist.fresh else np.zeros(3)
        felt = self.tissue.step(self.pose.value[:3, 3], velocity, dt)
        self.force_N = float(np.linalg.norm(felt.wrench[:3]))
        self.force_out.publish(convert.wrench_msg(np.array(felt.measured_wrench), self.frame, tick.stamp_ns))
        if self.stiffness_out is not None:
            message = CsaStiffness(stiffness_N_m=felt.stiffness, std_N_m=0.0)
            message.header.stamp, message.header.frame_id = tick.stamp, self.frame
            self.stiffness_out.publish(message)

    def report(self) -> dict:
        """What the sensor reads."""
        if not self.loops:
            return {}
        return {"force_N": round(self.force_N, 3)}


def main() -> int:
    """Runs the node."""
    return run(CsaPhantom)
