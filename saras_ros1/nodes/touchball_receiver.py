"""touchball_receiver: the console's datagrams become topics, wrenches and states become datagrams to the console."""

from __future__ import annotations

import threading
import time
from pathlib import Path

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState, Joy

from saras.net import ChannelState as WireState
from saras.net import TouchballDown, TouchballUp, TouchballUpSide
from saras.net.keys import load as load_keys
from saras_ros1 import convert
from saras_ros1.channel import SIDES, Channel
from saras_ros1.console_link import ConsoleLink, Received
from saras_ros1.msg import TankExchange, TankState
from saras_ros1.node import Node, Tick, run
from saras_ros1.stamped import NANOSECONDS


class Outputs:
    """Topics of one handle and its port guard."""

    def __init__(self, node: Node, side: str, buttons_every: int, state_every: int) -> None:
        self.console = f"touchball_{side}"
        self.joint_names = [f"{self.console}/{name}" for name in ("yaw", "pitch", "roll", "insertion")]
        self.grip_name = [f"{self.console}/grip"]
        self.pressed: list[int] = []
        self.buttons_every, self.state_every = buttons_every, state_every
        self.pose = node.output(f"/{self.console}/pose", PoseStamped)
        self.joints = node.output(f"/{self.console}/joint_states", JointState)
        self.buttons = node.output(f"/{self.console}/buttons", Joy)
        self.grip = node.output(f"/{self.console}/grip", JointState)
        self.exchange = node.output(f"/port_guard_{side}/exchange", TankExchange)
        self.guard = node.output(f"/port_guard_{side}/state", TankState)

    def publish(self, up: TouchballUpSide, seq: int, stamp_ns: int) -> None:
        """One datagram's side. The pose goes last: who steps on it finds the buttons of the same moment."""
        # A level, repeated at a lower rate, and at once when it changes.
        pressed = [int(up.clutch), int(up.clip)]
        if seq % self.buttons_every == 0 or pressed != self.pressed:
            self.pressed = pressed
            buttons = Joy(axes=[up.grip], buttons=pressed)
            buttons.header.stamp = _time(stamp_ns)
            self.buttons.publish(buttons)
        if seq % self.state_every == 0:
            self._publish_state(up, _time(stamp_ns))
            self._publish_guard(up, seq, _time(stamp_ns))
        self.pose.publish(convert.pose_msg(up.simball_T_handle, f"{self.console}/simball_base", stamp_ns))

    def _publish_state(self, up: TouchballUpSide, stamp: rospy.Time) -> None:
        ledger, joints = up.ledger, up.joints
        exchange = TankExchange(
            session=ledger.session,
            seq=ledger.seq,
            sent_J=ledger.sent_J,
            requesting=ledger.requesting,
            has_room=ledger.has_room,
        )
        grip = JointState(name=self.grip_name, position=[up.grip])
        angles = [joints.yaw_rad, joints.pitch_rad, joints.roll_rad, joints.insertion_m]
        state = JointState(name=self.joint_names, position=angles)
        exchange.header.stamp = grip.header.stamp = state.header.stamp = stamp
        self.exchange.publish(exchange)
        self.grip.publish(grip)
        self.joints.publish(state)

    def _publish_guard(self, up: TouchballUpSide, seq: int, stamp: rospy.Time) -> None:
        guard = up.guard
        state = TankState(
            seq=seq,
            session=up.ledger.session,
            energy_J=guard.energy_J,
            minimum_J=guard.minimum_J,
            request_J=guard.request_J,
            available_J=guard.available_J,
            maximum_J=guard.maximum_J,
            reduction=guard.reduction,
            scale=guard.scale,
            damping=guard.damping.tolist(),
            work_out_J=guard.work_out_J,
            received_J=guard.received_J,
            sent_J=up.ledger.sent_J,
            vented_J=guard.vented_J,
            granted_J=guard.granted_J,
            requesting=up.ledger.requesting,
            has_room=up.ledger.has_room,
            status=guard.status.name,
        )
        state.header.stamp = stamp
        self.guard.publish(state)


class TouchballReceiver(Node):
    """Up: a thread of its own on the socket. Down: a datagram whenever both wrenches are new, else once a period."""

    def __init__(self) -> None:
        super().__init__("touchball_receiver")
        period_s = self.params.number("period_s", 0.001, 0.1)
        wrench_timeout_s = self.params.number("wrench_timeout_s", 0.005, 1.0)
        peer_timeout_s = self.params.number("peer_timeout_s", 0.005, 2.0)
        buttons_every = self.params.integer("buttons_every", 1, 100)
        state_every = self.params.integer("state_every", 1, 100)
        bind = (self.params.text("bind_host"), self.params.integer("bind_port", 0, 65535))
        console = (self.params.text("console_host"), self.params.integer("console_port", 1, 65535))
        key_file = self.params.text("key_file", empty=True)
        keys = load_keys(Path(key_file).expanduser()) if key_file else None
        self.link = ConsoleLink(bind, console, self.params.number("age_limit_s", 0.005, 10.0), keys)
        self.params.finish()
        self.outputs = {side: Outputs(self, side, buttons_every, state_every) for side in SIDES}
        self.channels = {side: Channel(self, side) for side in SIDES}
        self.wrenches, self.ledgers = {}, {}
        for side in SIDES:
            wrench = convert.in_frame(f"touchball_{side}/touch_base", convert.wrench)
            topic = f"/touchball_{side}/wrench"
            self.wrenches[side] = self.input(topic, WrenchStamped, wrench, timeout_s=wrench_timeout_s)
            ledger = f"/tank_master/port_{side}/exchange"
            self.ledgers[side] = self.input(ledger, TankExchange, timeout_s=peer_timeout_s)
        self.loop(self.send_down, list(self.wrenches.values()), period_s=period_s)
        rospy.on_shutdown(self.link.close)
        threading.Thread(target=self._receive, daemon=True).start()

    def _receive(self) -> None:
        say_next = 0.0
        while not rospy.is_shutdown():
            try:
                received = self.link.receive()
            except OSError:
                return
            if isinstance(received, Received):
                self._publish(received.packet, received.stamp_ns)
            elif received is not None and time.monotonic() >= say_next:
                # Not logwarn_throttle: in a flood of forged datagrams finding its caller costs more than refusing.
                say_next = time.monotonic() + 1.0
                rospy.logwarn(f"console datagram refused: {received}; counts {self.link.counts()}")

    def _publish(self, packet: TouchballUp, stamp_ns: int) -> None:
        for side in SIDES:
            up = getattr(packet, side)
            if up.present:
                self.outputs[side].publish(up, packet.seq, stamp_ns)

    def send_down(self, tick: Tick) -> None:
        """What is stale goes down as zero force, HOLD, and a tank that neither asks nor takes."""
        packet = TouchballDown()
        for side in SIDES:
            down = getattr(packet, side)
            wrench = self.wrenches[side].fresh_value
            down.touch_wrench = np.zeros(6) if wrench is None else wrench
            down.state = WireState(self.channels[side].state)
            down.engagement = self.channels[side].engagement
            exchange = self.ledgers[side].message
            if exchange is not None:
                fresh = self.ledgers[side].fresh
                down.ledger.session, down.ledger.seq = exchange.session, exchange.seq
                down.ledger.sent_J = exchange.sent_J
                down.ledger.requesting = fresh and exchange.requesting
                down.ledger.has_room = fresh and exchange.has_room
        self.link.send(packet)

    def report(self) -> dict:
        """Counts and age of the link."""
        return {**self.link.counts(), "link_age_ms": round(1e3 * self.link.age_s(), 1)}


def _time(stamp_ns: int) -> rospy.Time:
    return rospy.Time(*divmod(stamp_ns, NANOSECONDS))


def main() -> int:
    """Runs the node."""
    return run(TouchballReceiver)
