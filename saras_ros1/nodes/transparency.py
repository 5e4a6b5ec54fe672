"""transparency: what master and slave of each side should do to each other, before passivity has its word."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped

from saras.collision import RepulsiveForce, RepulsiveForceConfig
from saras.teleop import Transparency, TransparencyConfig, TransparencyMode, TwistEstimatorConfig
from saras_ros1 import convert
from saras_ros1.arm_inputs import ArmInputs
from saras_ros1.channel import SIDES, Channel, base_frame
from saras_ros1.fixtures import Fixtures, HandFixtures
from saras_ros1.node import Node, Tick, run
from saras_ros1.proximity import Proximity

ZERO = np.zeros(6)
FORCE_SOURCES = ("arm", "contact")


class Side:
    """One side: its inputs, its law, its two outputs."""

    def __init__(self, node: TransparencyNode, side: str) -> None:
        self.frame = base_frame(side)
        self.channel = Channel(node, side)
        feels_force = node.config.mode != TransparencyMode.POSITION_POSITION
        of_arm = feels_force and node.force_source == "arm"
        self.arm = ArmInputs(node, side, node.arm_timeout_s, wrench=of_arm, twist=node.twist_config)
        self.contact = None
        if feels_force and not of_arm:
            read_wrench = convert.in_frame(self.frame, convert.wrench)
            topic = f"/contact_force/{side}/wrench"
            self.contact = node.input(topic, WrenchStamped, read_wrench, timeout_s=node.arm_timeout_s)
        timeout_s, source = node.master_timeout_s, f"/tf_transformer_{side}"
        read_pose = convert.in_frame(self.frame, convert.pose)
        read_twist = convert.in_frame(self.frame, convert.twist)
        self.pose = node.input(f"{source}/tracked_pose", PoseStamped, read_pose, timeout_s=timeout_s)
        self.twist = node.input(f"{source}/tracked_twist", TwistStamped, read_twist, timeout_s=timeout_s)
        self.filtered = node.input(f"{source}/tracked_twist_filtered", TwistStamped, read_twist, timeout_s=timeout_s)
        self.law = node.law(f"transparency_{side}", Transparency, node.config)
        self.side, self.proximity = side, node.proximity
        self.repulsion = RepulsiveForce(node.repulsion_config)
        self.fixtures = HandFixtures(node, node.fixtures, side)
        self.wrench_out = node.output(f"/transparency/{side}/desired_wrench", WrenchStamped)
        self.twist_out = node.output(f"/transparency/{side}/desired_twist", TwistStamped)
        self.status = "WAITING"
        self.error = ZERO
        node.loop(self.step, [self.pose, self.twist, self.filtered], period_s=node.period_s, name=side)

    def step(self, tick: Tick) -> None:
        """Engaged and all fresh: the law. Else its stale branch: the slave stands, the force fades out in 100 ms."""
        tip = self.arm.pose.value if self.arm.fresh else None
        felt = self.fixtures.step(tip, -self.error[:3], tick.dt, tick.stamp_ns)
        master = (self.pose.value, self.twist.value, self.filtered.value)
        if any(value is None for value in master) or self.arm.pose.value is None or self.arm.rcm.value is None:
            self.error = ZERO
            return self._publish(ZERO, ZERO, tick)
        if self.channel.newly_engaged():
            self.law.reset()
        live = not tick.stale and self.twist.fresh and self.filtered.fresh and self.arm.fresh
        out = self.law.step(
            master_pose=master[0],
            master_twist=master[1],
            master_twist_filtered=master[2],
            slave_pose=self.arm.pose.value,
            slave_twist=self.arm.twist_filtered,
            tissue_wrench=self._tissue_wrench(),
            rcm=self.arm.rcm.value,
            clutch=self.channel.clutch,
            guidance_wrench=self._repulsion(tick.dt) + felt,
            stale=not (live and self.channel.engaged),
            dt=tick.dt,
        )
        self.status, self.error = out.status.name, out.error
        return self._publish(out.desired_wrench, out.desired_twist, tick)

    def _tissue_wrench(self) -> np.ndarray:
        """(6,) on the tissue; NaN when unknown: modes that need it then fade their force out, motion goes on."""
        if self.contact is None:
            return self.arm.exerted_wrench
        value = self.contact.fresh_value
        return np.full(6, np.nan) if value is None else value

    def _repulsion(self, dt: float) -> np.ndarray:
        """(6,) on the hand, away from what the tool is near to; zero when that is not known."""
        if self.proximity is None:
            return ZERO
        near = self.proximity.of(self.side)
        return self.repulsion.step(distance_m=near.distance_m, normal=near.approach_direction, dt=dt).wrench

    def _publish(self, wrench: np.ndarray, twist: np.ndarray, tick: Tick) -> None:
        self.twist_out.publish(convert.twist_msg(twist, self.frame, tick.stamp_ns))
        self.wrench_out.publish(convert.wrench_msg(wrench, self.frame, tick.stamp_ns))


class TransparencyNode(Node):
    """Two sides that share parameters and nothing else."""

    def __init__(self) -> None:
        super().__init__("transparency")
        self.period_s = self.params.number("period_s", 0.001, 0.1)
        self.master_timeout_s = self.params.number("master_timeout_s", 0.005, 1.0)
        self.arm_timeout_s = self.params.number("arm_timeout_s", 0.005, 1.0)
        self.force_source = self.params.text("force_source", FORCE_SOURCES)
        self.config = self.params.build(TransparencyConfig, "law")
        self.twist_config = self.params.build(TwistEstimatorConfig, "slave_twist")
        proximity = self.params.section("proximity_force")
        collision_timeout_s = proximity.number("timeout_s", 0.02, 0.15)
        wanted = proximity.flag("enabled")
        self.repulsion_config = proximity.build(RepulsiveForceConfig, "law")
        self.params.finish()
        # No force comes from what is unknown: the speed scale does not matter here.
        self.proximity = Proximity(self, SIDES, collision_timeout_s, 0.0) if wanted else None
        self.fixtures = Fixtures(self, SIDES)
        self.sides = {side: Side(self, side) for side in SIDES}

    def report(self) -> dict:
        """Status and position error a side."""
        return {
            f"{name} {key}": value
            for name, side in self.sides.items()
            for key, value in (
                ("status", side.status),
                ("error_mm", round(1e3 * float(np.linalg.norm(side.error[:3])), 3)),
            )
        }


def main() -> int:
    """Runs the node."""
    return run(TransparencyNode)
