"""touchball_receiver: the consoles' datagrams become topics, wrenches and states become datagrams to the consoles."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import NamedTuple

import numpy as np
import rospy
from geometry_msgs.msg import WrenchStamped
from std_msgs.msg import String

from saras import ConfigError
from saras.net import ChannelState as WireState
from saras.net import TouchballDown, TouchballUp
from saras.net.keys import load as load_keys
from saras_ros1 import convert
from saras_ros1.channel import SIDES, Channel
from saras_ros1.console_link import ConsoleLink, Received
from saras_ros1.console_switch import ConsoleSwitch
from saras_ros1.handle_outputs import HandleOutputs
from saras_ros1.inputs import HEARTBEAT_S
from saras_ros1.msg import TankExchange
from saras_ros1.node import Node, Tick, run
from saras_ros1.params import Params
from saras_ros1.quiet_faults import LinkFaults

HEARD_S = 0.35  #: a console whose newest good datagram is older is not heard


class ConsoleParams(NamedTuple):
    """Whose console it is, and both ends of its link."""

    operator: str
    bind: tuple[str, int]
    console: tuple[str, int]
    key_file: str

    @classmethod
    def read(cls, params: Params) -> ConsoleParams:
        """From a node's parameters or a section of them."""
        bind = (params.text("bind_host"), params.integer("bind_port", 0, 65535))
        console = (params.text("console_host"), params.integer("console_port", 1, 65535))
        return cls(params.text("operator"), bind, console, params.text("key_file", empty=True))


class Console:
    """One operator's console: its link, and when it was last heard."""

    def __init__(self, params: ConsoleParams, age_limit_s: float) -> None:
        self.operator = params.operator
        keys = load_keys(Path(params.key_file).expanduser()) if params.key_file else None
        self.link = ConsoleLink(params.bind, params.console, age_limit_s, keys)
        self.heard_at_s = self.beat_at_s = -float("inf")

    @property
    def heard(self) -> bool:
        """Whether it is there."""
        return time.monotonic() - self.heard_at_s <= HEARD_S


class TouchballReceiver(Node):
    """Up: a thread a console on its socket. Down: a datagram whenever both wrenches are new, else once a period.

    Each operator's console has a link of its own; of each side only one console's data passes (ConsoleSwitch).
    """

    def __init__(self) -> None:
        super().__init__("touchball_receiver")
        period_s = self.params.number("period_s", 0.001, 0.1)
        wrench_timeout_s = self.params.number("wrench_timeout_s", 0.005, 1.0)
        peer_timeout_s = self.params.number("peer_timeout_s", 0.005, 2.0)
        buttons_every = self.params.integer("buttons_every", 1, 100)
        state_every = self.params.integer("state_every", 1, 100)
        age_limit_s = self.params.number("age_limit_s", 0.005, 1.0)
        first = ConsoleParams.read(self.params)
        second = ConsoleParams.read(self.params.section("second_console"))
        wanted = [first, second] if self.params.flag("has_second_console") else [first]
        self.params.finish()
        if first.operator == second.operator:
            raise ConfigError(f"{self.name}/second_console/operator = {second.operator!r}: must be another one")
        self.consoles = {params.operator: Console(params, age_limit_s) for params in wanted}
        self.outputs = {side: HandleOutputs(self, side, buttons_every, state_every) for side in SIDES}
        self.channels = {side: Channel(self, side) for side in SIDES}
        self.switches = {side: ConsoleSwitch(tuple(self.consoles)) for side in SIDES}
        self.wrenches, self.ledgers = {}, {}
        for side in SIDES:
            wrench = convert.in_frame(f"touchball_{side}/touch_base", convert.wrench)
            topic = f"/touchball_{side}/wrench"
            self.wrenches[side] = self.input(topic, WrenchStamped, wrench, timeout_s=wrench_timeout_s)
            ledger = f"/tank_master/port_{side}/exchange"
            self.ledgers[side] = self.input(ledger, TankExchange, timeout_s=peer_timeout_s)
        self.loop(self.send_down, list(self.wrenches.values()), period_s=period_s)
        self._events = self.output("/system/events", String)
        self._faults = {operator: LinkFaults(operator) for operator in self.consoles}
        self.every(1.0, self._tell_faults)
        for console in self.consoles.values():
            rospy.on_shutdown(console.link.close)
            threading.Thread(target=self._receive, args=(console,), daemon=True).start()

    def _tell_faults(self) -> None:
        for operator, console in self.consoles.items():
            if text := self._faults[operator].update(console.link.counts(), time.monotonic()):
                self._events.publish(String(text))

    def _receive(self, console: Console) -> None:
        say_next = 0.0
        while not rospy.is_shutdown():
            try:
                received = console.link.receive()
            except OSError:
                return
            if isinstance(received, Received):
                self._publish(console, received.packet, received.stamp_ns)
            elif received is not None and time.monotonic() >= say_next:
                # Not logwarn_throttle: in a flood of forged datagrams finding its caller costs more than refusing.
                say_next = time.monotonic() + 1.0
                rospy.logwarn(f"{console.operator}: datagram refused: {received}; counts {console.link.counts()}")

    def _publish(self, console: Console, packet: TouchballUp, stamp_ns: int) -> None:
        console.heard_at_s = now = time.monotonic()
        for side in SIDES:
            up, switch = getattr(packet, side), self.switches[side]
            if up.present and switch.passes(console.operator, now):
                self.outputs[side].publish(up, packet.seq, stamp_ns, switch.session(up.ledger.session))
        if now - console.beat_at_s >= HEARTBEAT_S:
            console.beat_at_s = now
            self._heartbeats.publish(String(f"console/{console.operator}"))

    def send_down(self, tick: Tick) -> None:
        """To each console its own sides."""
        now = time.monotonic()
        for side, switch in self.switches.items():
            message = self.channels[side].input.message
            if switch.update("" if message is None else message.holder, self._heard, now):
                rospy.loginfo(f"{side}: the hand is {switch.source}'s from now on")
        for operator, console in self.consoles.items():
            packet = TouchballDown()
            for side, switch in self.switches.items():
                if switch.passes(operator, now):
                    self._fill(getattr(packet, side), side, switch)
            console.link.send(packet)

    def _heard(self, operator: str) -> bool:
        return self.consoles[operator].heard

    def _fill(self, down, side: str, switch: ConsoleSwitch) -> None:
        """What is stale goes down as zero force, HOLD, and a tank that neither asks nor takes.

        So does all, but as WAITING, to a console whose operator does not hold the arm: it is never filled.
        """
        wrench = self.wrenches[side].fresh_value
        down.touch_wrench = np.zeros(6) if wrench is None else wrench
        down.state = WireState(self.channels[side].state)
        down.engagement = self.channels[side].engagement
        exchange = self.ledgers[side].message
        if exchange is not None:
            fresh = self.ledgers[side].fresh
            down.ledger.session, down.ledger.seq = switch.session(exchange.session), exchange.seq
            down.ledger.sent_J = exchange.sent_J
            down.ledger.requesting = fresh and exchange.requesting
            down.ledger.has_room = fresh and exchange.has_room

    def report(self) -> dict:
        """Counts and age of each link; the first one's without a name before them."""
        values = {}
        for i, (operator, console) in enumerate(self.consoles.items()):
            prefix = f"{operator} " if i else ""
            values.update({prefix + name: count for name, count in console.link.counts().items()})
            values[f"{prefix}link_age_ms"] = round(1e3 * console.link.age_s(), 1)
        return values


def main() -> int:
    """Runs the node."""
    return run(TouchballReceiver)
