"""arm_driver, one a side: holds control of the arm and sends it set-points, only while the side is engaged."""

from __future__ import annotations

import math
import time

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState
from std_srvs.srv import SetBool, SetBoolResponse

from saras.mesa_link import ArmLinkError, MaxVelocity, Tool
from saras.mesa_link.poses import to_matrix
from saras_ros1 import convert
from saras_ros1.arm_link import open_driver
from saras_ros1.channel import SIDES, Channel, base_frame
from saras_ros1.msg import SideFault
from saras_ros1.node import Node, Tick, run
from saras_ros1.set_point_limiter import SetPointLimiter
from saras_ros1.srv import SetMode, SetModeResponse, SetRcm, SetRcmResponse
from saras_ros1.tracking_watch import TrackingWatch


class ArmDriverNode(Node):
    """Each engagement starts from the measured pose; at its end the arm is told to stay where it is."""

    def __init__(self) -> None:
        super().__init__("arm_driver")
        self.side = side = self.params.text("side", SIDES)
        self.frame = base_frame(side)
        period_s = self.params.number("period_s", 0.001, 0.1)
        set_point_timeout_s = self.params.number("set_point_timeout_s", 0.005, 1.0)
        self.age_limit_s = self.params.number("set_point_age_limit_s", 0.005, 1.0)
        self.send_every = self.params.integer("send_every", 1, 10)
        self.roll_source = self.params.text("roll_source", ("tool_command", "set_point"))
        self.bounds = MaxVelocity(
            self.params.number("arm_speed_limit_m_s", 0.001, 1.0),
            self.params.number("arm_speed_limit_rad_s", 0.01, 10.0),
        )
        limits = self.params.section("limiter")
        self.limiter = SetPointLimiter(
            speed_m_s=limits.number("speed_m_s", 0.001, 1.0),
            speed_rad_s=limits.number("speed_rad_s", 0.01, 10.0),
            acceleration_m_s2=limits.number("acceleration_m_s2", 0.1, 100.0),
            acceleration_rad_s2=limits.number("acceleration_rad_s2", 1.0, 1000.0),
            reach_m=limits.number("reach_m", 0.001, 0.05),
            reach_rad=limits.number("reach_rad", 0.01, 1.0),
            dt_max_s=limits.number("dt_max_s", 0.001, 0.1),
        )
        tracking = self.params.section("tracking")
        self.tracking = TrackingWatch(tracking.number("limit_m", 0.001, 0.05), tracking.number("limit_s", 0.05, 5.0))
        self.driver = open_driver(self, control=True, state_rate_hz=self.params.number("state_rate_hz", 10.0, 1000.0))
        self.params.finish()

        self.channel = Channel(self, side)
        self.sending = False
        self.sent_at = 0.0
        self.ticks = 0
        self.refused = 0
        self.last_refusal = ""
        self.bounded_session = 0
        pose = convert.in_frame(self.frame, convert.pose)
        self.set_point = self.input(f"/mesa_{side}/set_point", PoseStamped, pose, timeout_s=set_point_timeout_s)
        self.tool = self.input(f"/mesa_{side}/tool_command", JointState, self._read_tool)
        self.tool.listeners.append(self._on_tool)
        self.faults = self.output("/system/faults", SideFault)
        self.faulty_engagement = 0
        self.loop(self.step, [self.set_point], period_s=period_s)
        self.every(0.1, self._bound_speed)
        rospy.Service(f"/mesa_{side}/set_rcm", SetRcm, self._on_set_rcm)
        rospy.Service(f"/mesa_{side}/set_mode", SetMode, self._on_set_mode)
        rospy.Service(f"/mesa_{side}/brake", SetBool, self._on_brake)

    def step(self, tick: Tick) -> None:
        """One set-point to the arm, or the one that stops it."""
        if tick.stale or not self.channel.engaged or self.channel.engagement == self.faulty_engagement:
            self._stop()
            return
        self.ticks += 1
        if self.sending and self.ticks % self.send_every:
            return
        age_s = rospy.get_time() - 1e-9 * tick.stamp_ns
        if abs(age_s) > self.age_limit_s:  # made before this process or its machine slept
            self._refuse(f"set-point is {1e3 * age_s:.0f} ms old")
            return
        now = time.monotonic()
        try:
            if not self.sending or self.channel.newly_engaged():
                self.limiter.start(self._measured())
                self.tracking.reset()
                self.sent_at = now - self.set_point.timeout_s
            self.driver.command_pose(self.limiter.step(self.set_point.value, now - self.sent_at))
        except (ArmLinkError, ValueError) as error:
            self._refuse(str(error))
            return
        self.sending, self.sent_at = True, now
        self._watch_tracking(now)

    def _watch_tracking(self, now: float) -> None:
        """Ends the engagement when the arm does not follow: it is blocked, or moved by somebody else."""
        error_m = float(np.linalg.norm(self.limiter.last[:3, 3] - self._measured()[:3, 3]))
        reason = self.tracking.step(error_m, now)
        if reason:
            self.faulty_engagement = self.channel.engagement
            self._stop()
            fault = SideFault(side=self.side, source=self.name.lstrip("/"), reason=reason)
            fault.advice = "look what keeps the arm from moving, then engage again"
            fault.header.stamp = rospy.Time.now()
            self.faults.publish(fault)

    def _measured(self) -> np.ndarray:
        """(4, 4) of the newest state."""
        received = self.driver.latest_state()
        if received is None:
            raise ArmLinkError("no state from the arm")
        return to_matrix(received.state.position, received.state.quaternion)

    def _stop(self) -> None:
        """Once at the end of an engagement; the arm's own watchdog would do the same a little later."""
        if not self.sending:
            return
        self.sending = False
        try:
            # Bounded as every other step: what the arm reports may be the very fault that ends the engagement.
            self.driver.command_pose(self.limiter.step(self._measured(), time.monotonic() - self.sent_at))
        except (ArmLinkError, ValueError) as error:
            self._refuse(f"stop not sent: {error}")

    def _refuse(self, reason: str) -> None:
        self.sending = False
        self.refused += 1
        self.last_refusal = reason
        rospy.logwarn_throttle(1.0, f"{self.name}: not sent ({self.refused} so far): {reason}")

    def _read_tool(self, message: JointState) -> Tool:
        """The tool command of a JointState that names roll, jaw or both (with or without the arm's name)."""
        if not len(message.name) == len(message.position) == len(message.velocity):
            raise ValueError("names, positions and velocities must be as many")
        values = {
            name.split("/")[-1]: (position, velocity)
            for name, position, velocity in zip(message.name, message.position, message.velocity)
        }
        if "jaw" not in values or not all(math.isfinite(v) for pair in values.values() for v in pair):
            raise ValueError(f"{dict(values)}: a jaw and finite values are needed")
        jaw, jaw_speed = values["jaw"]
        roll, roll_speed = values.get("roll", (None, 1.0))
        if not 0.0 <= jaw <= 1.0 or jaw_speed < 0.0 or roll_speed < 0.0:
            raise ValueError(f"jaw {jaw:g} must be in [0, 1], speeds {jaw_speed:g}, {roll_speed:g} not negative")
        return Tool(jaw, jaw_speed, roll if self.roll_source == "tool_command" else None, roll_speed)

    def _on_tool(self, source) -> None:
        if not self.channel.engaged:
            return
        try:
            self.driver.command_tool(source.value)
        except ArmLinkError as error:
            rospy.logwarn_throttle(1.0, f"{self.name}: tool command not sent: {error}")

    def _bound_speed(self) -> None:
        """Each new session gets the speed bound before anything else matters."""
        stats = self.driver.stats()
        if stats.in_control and stats.session != self.bounded_session:
            try:
                self.driver.set_max_velocity(self.bounds)
                self.bounded_session = stats.session
            except ArmLinkError as error:
                rospy.logwarn_throttle(1.0, f"{self.name}: speed bound not set: {error}")

    def _at_rest(self, act) -> tuple[bool, str]:
        """Runs a request that the arm allows at rest only; what went wrong as text."""
        if self.channel.engaged or self.channel.inherited:
            return False, f"{self.side} is engaged: hold it first (/system/{self.side}/hold)"
        try:
            act()
        except ArmLinkError as error:
            return False, str(error)
        return True, "done"

    def _on_set_rcm(self, request) -> SetRcmResponse:
        if request.rcm.header.frame_id.lstrip("/") != self.frame:
            return SetRcmResponse(False, f"frame_id '{request.rcm.header.frame_id}', must be '{self.frame}'")
        point = request.rcm.point
        return SetRcmResponse(*self._at_rest(lambda: self.driver.set_rcm((point.x, point.y, point.z))))

    def _on_set_mode(self, request) -> SetModeResponse:
        return SetModeResponse(*self._at_rest(lambda: self.driver.set_mode(request.mode)))

    def _on_brake(self, request) -> SetBoolResponse:
        return SetBoolResponse(*self._at_rest(lambda: self.driver.brake(request.data)))

    def report(self) -> dict:
        """Link, session, and what was not sent."""
        stats = self.driver.stats()
        return {
            "link": "in control" if stats.in_control else stats.last_error or "connecting",
            "sessions": stats.sessions,
            "sent": stats.sent,
            "discarded": stats.discarded,
            "nacks": " ".join(f"{reason}={count}" for reason, count in sorted(stats.nacks.items())) or "none",
            "refused": self.refused,
            "last_refusal": self.last_refusal or "none",
            "speed_limited": self.limiter.limited,
        }


def main() -> int:
    """Runs the node."""
    return run(ArmDriverNode)
