"""csa_teleop: contact states, references, wrench on the hand; the region of interest and the primitive.

Steps on /csa/master/measured_cp; gives /csa/teleop/state (what slave and proxy obey), mismatch and primitive,
/csa/master/compliance (from the model, as it is), border (from the fixtures that the slave obeys) and servo_cf (both,
ramped, by contact state).
"""

from __future__ import annotations

import math
from typing import Callable

import numpy as np
import rospy
from crtk_msgs.msg import OperatingState
from geometry_msgs.msg import Point32, PointStamped, PolygonStamped, PoseStamped, Vector3Stamped, WrenchStamped
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolResponse, Trigger, TriggerResponse

from saras import ConfigError, csa
from saras.csa.region import RegionPicker
from saras_ros1 import convert
from saras_ros1.channel import Channel
from saras_ros1.csa_exploring import Exploring
from saras_ros1.csa_gains import Gains
from saras_ros1.csa_node import PRESSED, CsaNode, Pedal, vector, warm_up
from saras_ros1.msg import Contact, CsaPrimitive, CsaTeleopState
from saras_ros1.node import Tick, run
from saras_ros1.nodes.csa_slave import palpation
from saras_ros1.srv import SetPrimitive, SetPrimitiveResponse

TELEOP_GAINS = ("scale", "desired_force_N", "stiffness_N_m", "force_limit_N")
GAINS = (*TELEOP_GAINS, "damping_N_s_m")
KINDS = {kind: name.lower() for name, kind in csa.PalpationKind.__members__.items()}


class CsaTeleop(CsaNode):
    """Holds, with a reason, while anything is missing; whoever comes back is re-referenced."""

    def __init__(self) -> None:
        super().__init__("csa_teleop")
        setup = self.setup
        self.enabled = self.params.flag("enable")
        rospy.set_param("~enable", False)  # one that died does not begin by itself when it is started again
        pose, timeout_s = convert.in_frame(self.frame, convert.pose), setup.timeout_s
        self.hand = self.input("/csa/master/measured_cp", PoseStamped, pose, timeout_s=timeout_s)
        self.tip = self.input("/csa/slave/setpoint_cp", PoseStamped, pose, timeout_s=timeout_s)
        self.proxy = self.input("/csa/proxy/measured_cp", PoseStamped, pose, timeout_s=timeout_s)
        self.contact = self.input("/csa/proxy/contact", Contact, read_contact, timeout_s=timeout_s)
        force = convert.in_frame(self.frame, convert.wrench)
        self.force = self.input("/csa/slave/measured_cf", WrenchStamped, force, timeout_s=timeout_s)
        self.measured = self.input("/csa/slave/measured_cp", PoseStamped, pose, timeout_s=timeout_s)
        point = convert.in_frame(self.frame, convert.point)
        self.next_location = self.input("/csa/modeler/next_location", PointStamped, point)
        self.arms = [self._arm_state(arm) for arm in (setup.master, setup.slave)]
        self.law = csa.CsaTeleop(setup.teleop_config())
        self.compliance = csa.ComplianceWrench(setup.compliance_config())
        self.fixtures, self.border = csa.FixtureSet(setup.fixtures()), csa.BorderWrench(setup.border_config())
        self.exploring = Exploring(setup.teleop.get("exploring_speed_m_s", 0.01))
        start = setup.palpation()
        self.primitive = CsaPrimitive(KINDS[start.kind], start.amplitude, start.frequency_hz, False)
        self.picker, self.reason = RegionPicker(), "WAITING"
        warm_up()
        self._synchronisations = 0
        self._last_proxy: np.ndarray | None = None
        self.state_out = self.output("/csa/teleop/state", CsaTeleopState)
        self.mismatch_out = self.output("/csa/teleop/mismatch", Vector3Stamped)
        self.primitive_out = self.output("/csa/teleop/primitive", CsaPrimitive, latch=True)
        self.compliance_out = self.output("/csa/master/compliance", WrenchStamped)
        self.border_out = self.output("/csa/master/border", WrenchStamped)
        self.wrench_out = self.output("/csa/master/servo_cf", WrenchStamped)
        self.region_out = self.output("/csa/modeler/roi", PolygonStamped, latch=True)
        self.picked_out = self.output("/csa/teleop/picked", PolygonStamped, latch=True)
        self.primitive_out.publish(self.primitive)
        self._pedals(setup.teleop.get("pedals", {}))
        self._services()
        rospy.Subscriber("/csa/slave/region", PolygonStamped, self._on_region, queue_size=5)
        self.loop(self.step, [self.hand], period_s=setup.period_s)

    def _pedals(self, topics: dict) -> None:
        self.clutch = Pedal(topics["clutch"]) if "clutch" in topics else None
        self.present = Pedal(topics["present"]) if "present" in topics else None
        self.pick = Pedal(topics["pick"], self._on_pick, self._on_clear) if "pick" in topics else None

    def _services(self) -> None:
        rospy.Service("/csa/teleop/enable", SetBool, self._on_enable)
        rospy.Service("/csa/teleop/set_primitive", SetPrimitive, self._on_primitive)
        rospy.Service("/csa/teleop/set_exploring", SetBool, self._on_exploring)
        rospy.Service("/csa/teleop/pick", Trigger, lambda _: TriggerResponse(*self._on_pick()))
        rospy.Service("/csa/teleop/close_region", Trigger, lambda _: TriggerResponse(*self._on_close()))
        rospy.Service("/csa/teleop/clear_region", Trigger, lambda _: TriggerResponse(*self._on_clear()))
        Gains("/csa/teleop/set_gains", GAINS, self._take_gains)

    # ---- each tick

    def step(self, tick: Tick) -> None:
        """What slave, proxy and hand are told."""
        dt = self.pace(tick)
        if dt is None:
            return
        enabled, missing = self._not_enabled() == "", self._missing(tick)
        proxy = self.proxy.value if self.proxy.fresh else None
        depth, normal = self.contact.value if self.contact.fresh else (math.nan, np.zeros(3))
        velocity = self._velocity(proxy, dt)
        compliance = self._compliance(proxy, velocity, depth, normal, dt)
        border = self._border(proxy, velocity, dt)
        wrench = self.force.fresh_value
        out = self.law.step(
            self.hand.value if self.hand.fresh else np.eye(4),
            self.tip.value if self.tip.fresh else np.eye(4),
            proxy if proxy is not None else np.eye(4),
            dt,
            None if wrench is None else float(np.linalg.norm(wrench[:3])),
            None if not math.isfinite(depth) else depth,
            normal,
            compliance,
            clutch=self.clutch is not None and self.clutch.state == PRESSED,
            enabled=enabled,
            stale=bool(missing),
            fixture_wrench=border,
        )
        self._synchronisations += int(out.synchronise)
        self.reason = (self._not_enabled() or missing or out.status.name) if out.hold else ""
        self._publish(tick, out, compliance, border, normal, enabled, dt)

    def _not_enabled(self) -> str:
        """Why teleoperation is off; empty: it is on."""
        if not self.enabled:
            return "WAITING: not enabled: rosservice call /csa/teleop/enable true"
        if self.present is not None and self.present.state != PRESSED:
            return f"WAITING: operator not present ({self.present.topic})"
        return next((f"WAITING: {said}" for said in (arm() for arm in self.arms) if said), "")

    def _arm_state(self, arm: dict) -> Callable[[], str]:
        """Says why the arm must not be moved; nothing when it may. An arm that never tells its state may."""
        if arm["type"] == "saras_arm":
            side = Channel(self, arm["side"], inherits=True)
            return lambda: "" if side.engaged else f"{arm['side']} is not engaged ({side.input.topic})"
        source = self.input(f"/{arm['name']}/operating_state", OperatingState)
        why = self.input(f"/{arm['name']}/hold_reason", String) if arm["type"] == "udp" else None

        def why_not() -> str:
            state = "ENABLED" if source.message is None else source.message.state
            more = f" ({why.message.data})" if why is not None and why.message is not None else ""
            return "" if state == "ENABLED" else f"{source.topic} says {state}{more}"

        return why_not

    def _missing(self, tick: Tick) -> str:
        if not self.force.fresh:
            return f"FORCE_UNKNOWN: nothing from {self.force.topic}"
        if not self.contact.fresh:
            return f"MODEL_UNKNOWN: nothing from {self.contact.topic}"
        silent = next((s for s in (self.hand, self.tip, self.proxy) if not s.fresh), None)
        silent = self.hand if tick.stale else silent
        return f"STALE: nothing from {silent.topic}" if silent is not None else ""

    def _velocity(self, proxy: np.ndarray | None, dt: float) -> np.ndarray:
        """(3,) of the proxy's tip."""
        last, self._last_proxy = self._last_proxy, proxy
        return np.zeros(3) if proxy is None or last is None else (proxy[:3, 3] - last[:3, 3]) / dt

    def _compliance(
        self, proxy: np.ndarray | None, velocity: np.ndarray, depth: float, normal: np.ndarray, dt: float
    ) -> np.ndarray:
        """(6,) of the wall at the model's surface; zero where there is none."""
        if proxy is None or not math.isfinite(depth) or np.linalg.norm(normal) < 0.5:
            return np.zeros(6)
        frame = np.eye(4)
        frame[:3, :3] = axes_with_z(normal)
        frame[:3, 3] = proxy[:3, 3] + depth * normal
        return np.array(self.compliance.step(proxy, np.r_[velocity, 0.0, 0.0, 0.0], frame, dt).wrench)

    def _border(self, proxy: np.ndarray | None, velocity: np.ndarray, dt: float) -> np.ndarray:
        """(6,) back to where the fixtures let the slave's tip go; zero while the proxy is there."""
        if proxy is None:
            return np.zeros(6)
        return np.array(self.border.step(self.fixtures.step(proxy, dt), velocity, dt).wrench)

    def _on_region(self, message: PolygonStamped) -> None:
        """The region that the slave obeys; no points: none."""
        points = np.array([(p.x, p.y, p.z) for p in message.polygon.points], dtype=float)
        try:
            fixtures = csa.FixtureSet(self.setup.fixtures(points if len(points) else None))
        except ConfigError as error:
            rospy.logerr(f"{self.name}: region refused: {error}")
            return
        with self.lock:
            self.fixtures = fixtures

    def _publish(
        self,
        tick: Tick,
        out: csa.CsaTeleopOutput,
        compliance: np.ndarray,
        border: np.ndarray,
        normal: np.ndarray,
        enabled: bool,
        dt: float,
    ) -> None:
        desired = np.array(out.desired)
        if not out.hold:
            target = self.next_location.value if self.primitive.exploring else None
            full = out.state == csa.ContactState.FULL_CONTACT
            desired[:3, 3] += self.exploring.step(desired[:3, 3], target, normal if full else np.zeros(3), dt)
        message = CsaTeleopState(
            state=int(out.state), enabled=enabled, hold=out.hold, reason=self.reason, mode=int(out.mode)
        )
        message.header.stamp, message.header.frame_id = tick.stamp, self.frame
        position, rotation = message.desired.position, message.desired.orientation
        vector(position, desired[:3, 3])
        rotation.x, rotation.y, rotation.z, rotation.w = convert.quaternion(desired)
        vector(message.normal, out.normal)
        message.desired_force_N, message.synchronisations = out.desired_force_N, self._synchronisations
        known = self.tip.fresh and self.proxy.fresh
        message.mismatch_m = out.mismatch_m if known else math.nan
        message.primitive = self.primitive
        self.state_out.publish(message)
        stamp_ns = tick.stamp_ns
        self.wrench_out.publish(convert.wrench_msg(out.wrench, self.frame, stamp_ns))
        self.compliance_out.publish(convert.wrench_msg(compliance, self.frame, stamp_ns))
        self.border_out.publish(convert.wrench_msg(border, self.frame, stamp_ns))
        if known:
            mismatch = Vector3Stamped(header=message.header)
            vector(mismatch.vector, self.tip.value[:3, 3] - self.proxy.value[:3, 3])
            self.mismatch_out.publish(mismatch)

    # ---- what the operator asks for

    def _on_enable(self, request) -> SetBoolResponse:
        with self.lock:
            self.enabled = request.data
            return SetBoolResponse(True, self._not_enabled() or "enabled")

    def _on_primitive(self, request) -> SetPrimitiveResponse:
        try:
            found = palpation(request.kind, request.amplitude, request.frequency_hz)
            limit = 0.02 if found.kind == csa.PalpationKind.MOTION else self.law.config.force_cap_N
            if found.kind != csa.PalpationKind.NONE:
                if not 0.0 <= request.amplitude <= limit:
                    raise ConfigError(f"amplitude = {request.amplitude}: must be in [0, {limit:g}]")
                if not 0.0 < request.frequency_hz <= 10.0:
                    raise ConfigError(f"frequency_hz = {request.frequency_hz}: must be in (0, 10]")
        except ConfigError as error:
            return SetPrimitiveResponse(False, str(error))
        with self.lock:
            exploring = self.primitive.exploring
            self.primitive = CsaPrimitive(request.kind, request.amplitude, request.frequency_hz, exploring)
        self.primitive_out.publish(self.primitive)
        return SetPrimitiveResponse(True, request.kind)

    def _on_exploring(self, request) -> SetBoolResponse:
        with self.lock:
            p = self.primitive
            self.primitive = CsaPrimitive(p.kind, p.amplitude, p.frequency_hz, request.data)
        self.primitive_out.publish(self.primitive)
        return SetBoolResponse(True, "exploring" if request.data else "where the hand is")

    def _take_gains(self, gains: dict[str, float]) -> None:
        teleop = csa.CsaTeleop(self.setup.teleop_config(**{k: v for k, v in gains.items() if k in TELEOP_GAINS}))
        walls = {k: v for k, v in gains.items() if k in ("stiffness_N_m", "damping_N_s_m")}
        compliance = csa.ComplianceWrench(self.setup.compliance_config(**walls))
        border = csa.BorderWrench(self.setup.border_config(**walls))
        with self.lock:
            state = self.law.state
            if teleop.config.scale != self.law.config.scale:
                state.has_reference = False  # the old reference with the new scale would be a step
            teleop.reset(state)
            self.law, self.compliance, self.border = teleop, compliance, border

    def _on_pick(self) -> tuple[bool, str]:
        with self.lock:
            if not self.measured.fresh:
                return False, f"nothing from {self.measured.topic}"
            was_closed = self.picker.closed
            return self._picking(lambda: self.picker.pick(self.measured.value[:3, 3]), was_closed)

    def _on_close(self) -> tuple[bool, str]:
        with self.lock:
            return self._picking(self.picker.close, self.picker.closed)

    def _on_clear(self) -> tuple[bool, str]:
        with self.lock:
            return self._picking(self.picker.clear, True)  # a region may be older than this process

    def _picking(self, act, was_closed: bool) -> tuple[bool, str]:
        """The closed region goes out on /csa/modeler/roi, an empty polygon when it ends."""
        try:
            said = act()
        except ConfigError as error:
            rospy.logwarn(f"{self.name}: {error}")
            return False, str(error)
        rospy.loginfo(f"{self.name}: {said}")
        self.picked_out.publish(self._polygon(self.picker.points))
        if self.picker.closed != was_closed:
            self.region_out.publish(self._polygon(self.picker.points if self.picker.closed else []))
        return True, said

    def _polygon(self, points: list[np.ndarray]) -> PolygonStamped:
        message = PolygonStamped()
        message.header.stamp, message.header.frame_id = rospy.Time.now(), self.frame
        message.polygon.points = [Point32(*map(float, point)) for point in points]
        return message

    def report(self) -> dict:
        """State and why it holds."""
        return {"state": csa.ContactState(int(self.law.state.state)).name, "hold": self.reason or "none"}


def axes_with_z(normal: np.ndarray) -> np.ndarray:
    """(3, 3) rotation whose third axis is the unit vector (3,)."""
    x = np.cross(np.eye(3)[np.abs(normal).argmin()], normal)
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(normal, x), normal])


def read_contact(message: Contact) -> tuple[float, np.ndarray]:
    """Depth [m] and outward normal (3,). Raises ValueError for a normal that is not finite."""
    normal = np.array([message.direction.x, message.direction.y, message.direction.z])
    if not np.isfinite(normal).all():
        raise ValueError(f"normal {normal} is not finite")
    return message.depth, normal


def main() -> int:
    """Runs the node."""
    return run(CsaTeleop)
