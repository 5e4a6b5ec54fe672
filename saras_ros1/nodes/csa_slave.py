"""csa_slave: the slave's arm under hybrid control of force and motion, inside virtual fixtures.

Steps on the arm's joints; takes /csa/teleop/state, the force, /csa/modeler/roi and /csa/slave/stiffness; gives the arm
servo_jp, and under /csa/slave what is measured (one stamp: measured_cp, measured_cv, measured_cf), the set-point,
what the controller did (admittance) and the region that is in force. What it does not know is a hold with its reason.
"""

from __future__ import annotations

import math
import time

import numpy as np
import rospy
from geometry_msgs.msg import PolygonStamped, PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from saras import ConfigError, csa
from saras.csa import arms
from saras_ros1 import convert
from saras_ros1.csa_gains import Gains
from saras_ros1.csa_node import CsaNode, Need, joint_reader, joint_state, vector, warm_up
from saras_ros1.msg import CsaAdmittance, CsaStiffness, CsaTeleopState
from saras_ros1.node import StartupError, Tick, run
from saras_ros1.nodes.csa_proxy import read_told
from saras_ros1.stiffness_under_tip import upper_bound

GAINS = ("admittance_m_Ns", "stiffness_max_N_m", "approach_speed_m_s", "speed_limit_m_s", "force_cap_N")
MEASURE_S = 0.5  # for so long the arm's rate is looked at
STIFFNESS_TIMEOUT_S = 0.3  # at 10 mm/s the tip is 3 mm further: what the estimate is made for
SLOWER = 1.1  # an arm whose period is longer than so many of the file's counts as slower than the file says


class CsaSlave(CsaNode):
    """Nothing goes to the arm before teleoperation is enabled; then the set-point starts where the arm is."""

    def __init__(self) -> None:
        super().__init__("csa_slave")
        setup, slave = self.setup, self.setup.slave
        self.arm = setup.slave_model
        force = slave.get("force", {})
        topic = force.get("topic", arms.topic(slave, "measured_cf"))
        joints, self.in_joints = arms.topic(slave, "measured_js"), "servo_jp" in arms.capabilities(slave)
        command = arms.topic(slave, "servo_jp" if self.in_joints else "servo_cp")
        command_class = JointState if self.in_joints else PoseStamped
        self.in_tip_axes, self.sign = force.get("axes") == "tip", -1.0 if force.get("exerted_on") == "tool" else 1.0
        self.require(
            Need(joints, JointState, "its joints"),
            Need(command, command_class, "its set-point", listens=True),
            Need(topic, WrenchStamped, "a source of force"),
        )
        named = [f"mesa_{slave['side']}/{name}" for name in self.arm.joint_names] if "side" in slave else None
        read = joint_reader(len(self.arm.joint_names), named)
        self.joints = self.input(joints, JointState, read, timeout_s=setup.timeout_s)
        self.force = self.input(topic, WrenchStamped, convert.wrench, timeout_s=setup.timeout_s)
        self.told = self.input("/csa/teleop/state", CsaTeleopState, read_told, timeout_s=setup.timeout_s)
        self.stiffness = self.input("/csa/slave/stiffness", CsaStiffness, read_stiffness, timeout_s=STIFFNESS_TIMEOUT_S)
        measured_s = self._measured_period()
        self.period_s = measured_s if measured_s > SLOWER * setup.period_s else setup.period_s
        self.law = csa.SlaveMlc(setup.slave_config(self.period_s))
        self.speed = np.asarray(self.arm.speed)
        self.fixtures = csa.FixtureSet(setup.fixtures())
        warm_up()
        self.command = self.output(command, command_class)
        self.outputs = {
            topic: self.output(f"/csa/slave/{topic}", kind)
            for topic, kind in (
                ("measured_js", JointState),
                ("measured_cp", PoseStamped),
                ("measured_cv", TwistStamped),
                ("measured_cf", WrenchStamped),
                ("setpoint_js", JointState),
                ("setpoint_cp", PoseStamped),
                ("admittance", CsaAdmittance),
            )
        }
        self.q: np.ndarray | None = None
        self.enabled, self.reason, self.region = False, "WAITING", "none"
        self.region_out = self.output("/csa/slave/region", PolygonStamped, latch=True)
        self.region_out.publish(PolygonStamped())
        rospy.Subscriber("/csa/modeler/roi", PolygonStamped, self._on_region, queue_size=5)
        Gains("/csa/slave/set_gains", GAINS, self._take_gains)
        self.loop(self.step, [self.joints], period_s=setup.period_s)

    def _measured_period(self) -> float:
        """How often the arm speaks: the bound of K_g is that of the real period. Raises StartupError."""
        why = self.input(f"/{self.slave}/hold_reason", String) if self.setup.slave["type"] == "udp" else None

        def silent() -> str:
            more = f": {self.slave} says {why.message.data}" if why is not None and why.message is not None else ""
            return f"nothing from {self.joints.topic}{more}"

        self.wait_for(lambda: self.joints.received > 1, self.setup.start_timeout_s, silent)
        count, begin = self.joints.received, time.monotonic()
        time.sleep(MEASURE_S)
        heard = self.joints.received - count
        if heard == 0:
            raise StartupError(f"nothing more from {self.joints.topic}")
        return (time.monotonic() - begin) / heard

    def _take_gains(self, gains: dict[str, float]) -> None:
        law = csa.SlaveMlc(self.setup.slave_config(self.period_s, **gains))
        with self.lock:
            law.reset(self.law.state)
            self.law = law

    def _on_region(self, message: PolygonStamped) -> None:
        """Corners of a region of interest; none: no region. One that is no region leaves the old one in force."""
        points = np.array([(p.x, p.y, p.z) for p in message.polygon.points], dtype=float)
        try:
            if message.header.frame_id.lstrip("/") != self.frame:
                raise ConfigError(f"frame_id '{message.header.frame_id}', must be '{self.frame}'")
            fixtures = csa.FixtureSet(self.setup.fixtures(points if len(points) else None))
        except ConfigError as error:
            rospy.logerr(f"{self.name}: region refused: {error}")
            return
        with self.lock:
            self.fixtures, self.region = fixtures, f"{len(points)} points" if len(points) else "none"
        self.region_out.publish(message)

    def step(self, tick: Tick) -> None:
        """One set-point; nothing is said while the arm is silent, so that everybody knows."""
        dt = self.pace(tick)
        if tick.stale:
            self.reason = f"STALE: nothing from {self.joints.topic}"
        if dt is None or tick.stale:
            return
        measured = self.joints.value
        tip = self.arm.forward(measured.q)
        wrench = self._wrench(tip)
        told = self.told.message
        heard = self.told.fresh
        if self.q is None or (heard and not told.enabled):
            self.q, self.enabled = measured.q.copy(), False
            self.law.reset()
        if heard and told.enabled and not self.enabled:
            self.q, self.enabled = measured.q.copy(), True
        self._publish_measured(tick, measured, tip, wrench)
        if self.enabled:
            self._control(tick, dt, measured.q, wrench, stale=not heard or told.hold)
        else:
            self.reason = "WAITING: not enabled" if heard else f"STALE: nothing from {self.told.topic}"
            self._publish_admittance(tick, None, None)
        pose = self.arm.forward(self.q)
        self.outputs["setpoint_js"].publish(joint_state(self.arm.joint_names, tick.stamp, position=self.q))
        self.outputs["setpoint_cp"].publish(convert.pose_msg(pose, self.frame, tick.stamp_ns))

    def _control(self, tick: Tick, dt: float, q_measured: np.ndarray, wrench: np.ndarray | None, stale: bool) -> None:
        told, q = self.told.message, self.q
        pose = self.arm.forward(q)
        found = self.fixtures.step(pose, dt, shaft=self.arm.shaft(q))
        primitive = told.primitive
        full = told.state == CsaTeleopState.FULL_CONTACT
        stiffness = self.stiffness.fresh_value
        out = self.law.step(
            q,
            self.arm.jacobian(q),
            pose,
            self.arm.within_reach(self.told.value),
            dt,
            tissue_wrench=wrench,
            mode=csa.SlaveMode(told.mode),
            desired_force_N=told.desired_force_N,
            normal=[told.normal.x, told.normal.y, told.normal.z],
            stiffness_N_m=math.nan if stiffness is None else stiffness,
            palpation=palpation(primitive.kind, primitive.amplitude, primitive.frequency_hz)
            if full
            else csa.Palpation(),
            q_measured=q_measured,
            fixtures=found,
            stale=stale,
        )
        self.q, self.reason = np.array(out.motion.q), out.motion.reason.name
        if self.in_joints:
            self.command.publish(joint_state(self.arm.joint_names, tick.stamp, position=self.q))
        else:
            self.command.publish(convert.pose_msg(self.arm.forward(self.q), self.frame, tick.stamp_ns))
        self._publish_admittance(tick, out, found)

    def _wrench(self, tip: np.ndarray) -> np.ndarray | None:
        """(6,) exerted on the tissue, base axes; None: not known."""
        wrench = self.force.fresh_value
        return None if wrench is None else self.sign * (in_base(wrench, tip) if self.in_tip_axes else wrench)

    def _publish_measured(self, tick: Tick, measured, tip: np.ndarray, wrench: np.ndarray | None) -> None:
        out, frame, stamp_ns = self.outputs, self.frame, tick.stamp_ns
        out["measured_js"].publish(joint_state(self.arm.joint_names, tick.stamp, position=measured.q))
        out["measured_cp"].publish(convert.pose_msg(tip, frame, stamp_ns))
        if np.isfinite(measured.v).all():
            twist = self.arm.jacobian(measured.q) @ measured.v
            out["measured_cv"].publish(convert.twist_msg(twist, frame, stamp_ns))
        if wrench is not None:
            out["measured_cf"].publish(convert.wrench_msg(wrench, frame, stamp_ns))

    def _publish_admittance(self, tick: Tick, out, found) -> None:
        message = CsaAdmittance(hold=True, reason=self.reason, desired_force_N=math.nan, fixture_distance_m=math.nan)
        message.header.stamp, message.header.frame_id = tick.stamp, self.frame
        if out is not None:
            message.hold = csa.is_hold(out.motion.reason)
            message.admittance_m_Ns, message.normal_force_N = out.admittance_m_Ns, out.normal_force_N
            hybrid = self.told.message.mode == CsaTeleopState.HYBRID and not message.hold
            message.desired_force_N = out.desired_force_N if hybrid else math.nan
            message.joint_speed_share = float((np.abs(out.motion.rates) / self.speed).max())
            message.kkt_residual = out.motion.kkt_residual
            vector(message.normal, out.normal)
        if found is not None and found.nearest >= 0:
            message.fixture = self.fixtures.names[found.nearest]
            message.fixture_distance_m = found.distance_m[found.nearest]
            vector(message.fixture_closest, found.closest)
        self.outputs["admittance"].publish(message)

    def report(self) -> dict:
        """Hold or not and why; the period that the bound of K_g was checked with."""
        return {"reason": self.reason, "region": self.region, "bound_period_ms": round(1e3 * self.period_s, 2)}


def in_base(wrench: np.ndarray, base_T_tip: np.ndarray) -> np.ndarray:
    """(6,) in the tip's axes -> base axes."""
    rotation = base_T_tip[:3, :3]
    return np.concatenate([rotation @ wrench[:3], rotation @ wrench[3:]])


def palpation(kind: str, amplitude: float, frequency_hz: float) -> csa.Palpation:
    """Of its names. Raises ConfigError for a kind that is none."""
    found = csa.PalpationKind.__members__.get(kind.upper())
    if found is None:
        raise ConfigError(f"kind = {kind!r}: must be one of none, force, motion")
    return csa.Palpation(kind=found, amplitude=amplitude, frequency_hz=frequency_hz)


def read_stiffness(message: CsaStiffness) -> float:
    """Upper bound [N/m] that the gain must be stable for; NaN: not known."""
    bound = float(upper_bound(message.stiffness_N_m, message.std_N_m))
    known = math.isfinite(bound) and message.stiffness_N_m > 0.0 and message.std_N_m >= 0.0
    return bound if known else math.nan


def main() -> int:
    """Runs the node."""
    return run(CsaSlave)
