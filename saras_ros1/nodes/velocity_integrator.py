"""velocity_integrator, one a side: from the twist that passivity lets through to the arm's set-point."""

from __future__ import annotations

from typing import Any

import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped
from tf2_msgs.msg import TFMessage

from saras.csa import FixtureIntegrator
from saras.teleop import VelocityIntegrator, VelocityIntegratorConfig
from saras_ros1 import convert
from saras_ros1.arm_inputs import ArmInputs
from saras_ros1.channel import SIDES, Channel, base_frame
from saras_ros1.fixtures import Fixtures
from saras_ros1.node import Node, Tick, run
from saras_ros1.proximity import Proximity


class VelocityIntegratorNode(Node):
    """Each engagement starts from the measured pose. On HOLD the set-point freezes; for a silent arm there is none."""

    def __init__(self) -> None:
        super().__init__("velocity_integrator")
        self.side = side = self.params.text("side", SIDES)
        period_s = self.params.number("period_s", 0.001, 0.1)
        start_pose_wait_s = self.params.number("start_pose_wait_s", 0.1, 600.0)
        twist_timeout_s = self.params.number("twist_timeout_s", 0.005, 1.0)
        arm_timeout_s = self.params.number("arm_timeout_s", 0.005, 1.0)
        self.tf_every = self.params.integer("tf_every", 1, 1000)
        config = self.params.build(VelocityIntegratorConfig, "law")
        slowdown = self.params.section("proximity_slowdown")
        collision_timeout_s = slowdown.number("timeout_s", 0.02, 0.15)
        unknown_speed_m_s = slowdown.number("unknown_speed_m_s", 0.0, config.speed_limit_m_s)
        wanted = slowdown.flag("enabled")
        self.params.finish()

        self.frame = base_frame(side)
        self.channel = Channel(self, side)
        self.arm = ArmInputs(self, side, arm_timeout_s)
        twist = convert.in_frame(self.frame, convert.twist)
        self.twist = self.input(f"/tank_slave/{side}/twist", TwistStamped, twist, timeout_s=twist_timeout_s)
        unknown_scale = unknown_speed_m_s / config.speed_limit_m_s
        self.proximity = Proximity(self, (side,), collision_timeout_s, unknown_scale) if wanted else None
        self.set_point = self.output(f"/mesa_{side}/set_point", PoseStamped)
        self.tf = self.output("/tf", TFMessage)
        self.fixtures = Fixtures(self, (side,), guards=True)
        self.walls = self.fixtures.lists[side]
        law = (FixtureIntegrator, config, self.walls) if self.walls else (VelocityIntegrator, config)
        self.integrator = self.law(f"velocity_integrator_{side}", *law)
        self.last = None
        self.ticks = 0
        self.wait_for(lambda: not self._missing(), start_pose_wait_s, self._missing)
        self.loop(self.step, [self.twist], period_s=period_s)

    def _missing(self) -> str:
        inputs = (self.arm.pose, self.arm.rcm)
        topics = [source.topic for source in inputs if source.value is None]
        return f"no start pose: nothing on {', '.join(topics)}: do the arm and arm_state run?" if topics else ""

    def step(self, tick: Tick) -> None:
        """Engaged: integrate. Else: repeat the last set-point as long as the arm is there to hold it."""
        if self.channel.newly_engaged():
            self.integrator.reset()
        if not self.arm.fresh:
            return
        if self.channel.engaged and self.twist.value is not None:
            self.last = self.integrator.step(
                twist=self.twist.value,
                measured_pose=self.arm.pose.value,
                rcm=self.arm.rcm.value,
                stale=tick.stale,
                dt=tick.dt,
                **self._bounds(),
            )
        if self.last is None or not self.last.has_set_point:
            return
        pose = convert.pose_msg(self.last.set_point, self.frame, tick.stamp_ns)
        self.set_point.publish(pose)
        self.ticks += 1
        if self.ticks % self.tf_every == 0:
            child = f"mesa_{self.side}/set_point"
            transform = convert.transform_msg(self.last.set_point, self.frame, child, rospy.Time.now())
            self.tf.publish(TFMessage([transform]))

    def _bounds(self) -> dict[str, Any]:
        """How fast the tool may go where it is, and whether its fixtures hold."""
        bounds: dict[str, Any] = {}
        if self.walls:
            word = self.fixtures.word(self.side)
            bounds = {"fixtures_on": word.on, "fixtures_known": word.known}
        if self.proximity is None:
            return bounds
        near = self.proximity.of(self.side)
        return {
            **bounds,
            "max_speed_scale": near.max_speed_scale,
            "approach_direction": near.approach_direction,
            "approach_speed_limit_m_s": near.approach_speed_limit_m_s,
        }

    def report(self) -> dict:
        """Law status, lead and which bounds acted."""
        if self.last is None:
            return {"status": "WAITING"}
        bounds = [name[: -len("_limited")] for name in type(self.last)._fields if name.endswith("_limited")]
        acting = [name for name in bounds if getattr(self.last, name + "_limited")]
        return {
            "status": self.last.status.name,
            "lead_mm": round(1e3 * self.last.lead_m, 3),
            "limited_by": " ".join(acting) or "none",
        }


def main() -> int:
    """Runs the node."""
    return run(VelocityIntegratorNode)
