"""csa_udp_slave: a slave arm elsewhere on the network (CSA UDP, docs/protocols.md) as an arm with CRTK's topics.

For a system file whose slave is of type udp; of another one it does nothing.
Gives /<arm>/measured_js, measured_cp, measured_cv and, while the slave has a force, measured_cf, with one stamp; takes
servo_jp, servo_cp and state_command. A HOLD is PAUSED with its name on hold_reason, and is left by resume only.
"""

from __future__ import annotations

import threading
import time
from typing import Any

import numpy as np
import rospy
from crtk_msgs.msg import OperatingState, StringStamped
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from saras.csa.udp import HoldReason, PlatformLink, RemoteSlave
from saras.net import CsaUp
from saras.net.keys import load as load_keys
from saras_ros1 import convert
from saras_ros1.csa_node import CsaNode, joint_state
from saras_ros1.node import run

CLOCK_STEP_NS = 1_000_000_000


class CsaUdpSlave(CsaNode):
    """One thread receives and publishes, one sends each period; the state machine is theirs under the lock."""

    def __init__(self) -> None:
        super().__init__("csa_udp_slave")
        udp = self.setup.udp()
        self.remote: RemoteSlave | None = None
        if udp is None:
            rospy.loginfo(f"{self.name}: {self.slave} is a {self.setup.slave['type']}: nothing to do")
            return
        self.arm, self.names = self.slave, self.setup.slave_model.joint_names
        self.remote = RemoteSlave(udp.remote)
        self._enable_once = udp.auto_enable
        keys = load_keys(udp.key_file) if udp.key_file is not None else None
        self.link = PlatformLink(udp.bind, udp.slave, udp.age_limit_s, keys)
        rospy.on_shutdown(self.link.close)

        self._anchor_ns: int | None = None
        self._told: tuple[Any, ...] = ()
        self._warn_at_s = 0.0
        self.outputs = {
            name: self.output(f"/{self.arm}/{name}", kind)
            for name, kind in (
                ("measured_js", JointState),
                ("measured_cp", PoseStamped),
                ("measured_cv", TwistStamped),
                ("measured_cf", WrenchStamped),
                ("error", String),
            )
        }
        self.state_out = self.output(f"/{self.arm}/operating_state", OperatingState, latch=True)
        self.reason_out = self.output(f"/{self.arm}/hold_reason", String, latch=True)
        self._tell()
        rospy.Subscriber(f"/{self.arm}/state_command", StringStamped, self._on_state_command, queue_size=5)
        self._subscribe("servo_jp", JointState, convert.positions, self.remote.servo_jp)
        self._subscribe("servo_cp", PoseStamped, convert.in_frame(self.frame, convert.pose), self.remote.servo_cp)
        threading.Thread(target=self._receive, daemon=True).start()
        self.every(udp.period_s, self._send)

    def _subscribe(self, name: str, message_class: type, read: Any, servo: Any) -> None:
        def on_message(message: Any) -> None:
            try:
                value = read(message)
            except ValueError as error:  # feeds no watchdog
                rospy.logwarn_throttle(1.0, f"/{self.arm}/{name} refused: {error}")
                return
            with self.lock:
                servo(value, time.monotonic_ns())
                self._tell()

        rospy.Subscriber(f"/{self.arm}/{name}", message_class, on_message, queue_size=1, tcp_nodelay=True)

    def _on_state_command(self, message: StringStamped) -> None:
        with self.lock:
            self._obey(message.string)
            self._tell()

    def _obey(self, command: str) -> bool:
        try:
            self.remote.state_command(command)
        except ValueError as error:
            self._say(f"{error}")
            return False
        return True

    # ---- up

    def _receive(self) -> None:
        while not rospy.is_shutdown():
            if not self.link.wait(0.2):
                continue
            try:
                with self.lock:
                    up = self.link.poll(time.monotonic_ns())
                    if up is not None:
                        self._take(up)
            except (OSError, rospy.ROSException):
                return
            if up is None and self.link.last_refusal and time.monotonic() >= self._warn_at_s:
                self._warn_at_s = time.monotonic() + 1.0
                rospy.logwarn(f"{self.name}: datagram refused: {self.link.last_refusal}")
                self.link.last_refusal = ""

    def _take(self, up: CsaUp) -> None:
        new_run = self.remote.up is None or self.remote.up.session != up.session
        self.remote.take(up)
        if self.remote.up is not up:  # not an arm of these kinematics: nothing of it is published
            self._tell()
            return
        if new_run:
            self._anchor_ns = None
        stamp_ns = self._stamp_ns(up.sender_time_ns)
        stamp = rospy.Time(*divmod(stamp_ns, 1_000_000_000))
        joints = joint_state(self.names, stamp, position=up.position, velocity=up.velocity, effort=up.effort)
        self.outputs["measured_js"].publish(joints)
        self.outputs["measured_cp"].publish(convert.pose_msg(up.base_T_tip, self.frame, stamp_ns))
        self.outputs["measured_cv"].publish(convert.twist_msg(up.tip_twist, self.frame, stamp_ns))
        if up.has_force:
            self.outputs["measured_cf"].publish(convert.wrench_msg(up.tip_wrench, self.frame, stamp_ns))
        self._tell()

    def _stamp_ns(self, sent_ns: int) -> int:
        """The slave's time on the ROS clock: its exact spacing, never in the future; a stepped clock anchors anew."""
        now_ns = time.time_ns()
        if self._anchor_ns is not None:
            stamp_ns = sent_ns + self._anchor_ns
            if 0 <= now_ns - stamp_ns <= CLOCK_STEP_NS:
                return stamp_ns
        self._anchor_ns = now_ns - sent_ns
        return now_ns

    # ---- down

    def _send(self) -> None:
        with self.lock:
            now_ns = time.monotonic_ns()
            down = self.remote.step(now_ns, self.link.age_s(now_ns))
            if self._enable_once and self.remote.hold is HoldReason.DISABLED and self.remote.ready:
                self._enable_once = not self._obey("enable")
            self._tell()
            self.link.send(down, now_ns)

    # ---- what is told

    def _tell(self) -> None:
        """State and reason when they change, and what went wrong."""
        for _, text in self.remote.take_events():
            self._say(text)
        machine = self.remote.machine
        now = (machine.state, machine.is_homed, self.remote.hold)
        if now == self._told:
            return
        self._told = now
        message = OperatingState(state=machine.state, is_homed=machine.is_homed, is_busy=False)
        message.header.stamp = rospy.Time.now()
        self.state_out.publish(message)
        self.reason_out.publish(String(self.remote.hold.name))

    def _say(self, text: str) -> None:
        rospy.logerr(f"{self.arm}: {text}")
        self.outputs["error"].publish(String(f"{self.arm}: {text}"))

    def report(self) -> dict:
        """Hold, link and its counts."""
        if self.remote is None:
            return {}
        age_s, round_trip_s = self.link.age_s(time.monotonic_ns()), self.link.round_trip_s
        return {
            "hold": self.remote.hold.name,
            "operating_state": self.remote.machine.state,
            "link_age_ms": round(1e3 * age_s, 1) if np.isfinite(age_s) else "unknown",
            "round_trip_ms": "unknown" if round_trip_s is None else round(1e3 * round_trip_s, 2),
            **self.link.counts(),
        }


def main() -> int:
    """Runs the node."""
    return run(CsaUdpSlave)
