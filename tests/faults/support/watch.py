"""Eyes on the ROS side: states, events, counts, and every number that leaves for an arm or a hand."""

from __future__ import annotations

import math
from collections import Counter

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from rosgraph_msgs.msg import Log
from saras_ros1.msg import ChannelState, TankState
from std_msgs.msg import String

from saras_ros1.stamped import lean_class

from .options import process_of
from .platform import SIDES
from .waiting import wait_until

NAMES = {0: "WAITING", 1: "READY", 2: "ENGAGED", 3: "HOLD"}
#: what leaves for the arms and the hands, and what is one step before
NUMBERS = {
    "/mesa_{s}/set_point": PoseStamped,
    "/tank_slave/{s}/twist": TwistStamped,
    "/tank_master/{s}/wrench": WrenchStamped,
    "/touchball_{s}/wrench": WrenchStamped,
}
TANKS = ("tank_master", "tank_slave", "port_guard_left", "port_guard_right")


class Watch:
    """Subscribes to all of it; needs an initialised rospy node."""

    def __init__(self) -> None:
        self.states: dict[str, list[ChannelState]] = {side: [] for side in SIDES}
        self.events: list[str] = []
        self.warnings: list[str] = []
        self.diagnostics: dict[str, dict[str, str]] = {}
        self.reports: Counter[str] = Counter()
        self.tanks: dict[str, TankState] = {}
        self.newest: dict[str, tuple[float, ...]] = {}
        self.received: Counter[str] = Counter()
        self.not_finite: Counter[str] = Counter()
        for side in SIDES:
            rospy.Subscriber(f"/system/{side}/state", ChannelState, self.states[side].append, tcp_nodelay=True)
            for name, kind in NUMBERS.items():
                topic = name.format(s=side)
                rospy.Subscriber(topic, lean_class(kind), self._on_numbers, topic, tcp_nodelay=True)
        for tank in TANKS:
            rospy.Subscriber(f"/{tank}/state", TankState, self._on_tank, tank)
        rospy.Subscriber("/system/events", String, lambda m: self.events.append(m.data))
        rospy.Subscriber("/rosout", Log, self._on_log)
        rospy.Subscriber("/diagnostics", DiagnosticArray, self._on_diagnostics)

    def _on_numbers(self, message, topic: str) -> None:
        self.received[topic] += 1
        self.newest[topic] = message.numbers
        if not math.isfinite(sum(message.numbers)):
            self.not_finite[topic] += 1

    def _on_tank(self, message: TankState, tank: str) -> None:
        self.tanks[tank] = message
        if not math.isfinite(message.energy_J + message.work_out_J + message.received_J + message.sent_J):
            self.not_finite[tank] += 1

    def _on_log(self, message: Log) -> None:
        if message.level >= Log.WARN:
            self.warnings.append(f"{message.name}: {message.msg}")

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            self.diagnostics[status.name] = {pair.key: pair.value for pair in status.values}
            self.reports[status.name] += 1

    def state(self, side: str) -> str:
        """Name of the newest state, "" before the first."""
        return NAMES[self.states[side][-1].state] if self.states[side] else ""

    def reason(self, side: str) -> str:
        """Of the newest state."""
        return self.states[side][-1].reason if self.states[side] else ""

    def engagement(self, side: str) -> int:
        """Number of the newest engagement."""
        return self.states[side][-1].engagement if self.states[side] else 0

    def await_state(self, side: str, *states: str) -> None:
        """Until a side is in one of these states."""
        wait_until(
            lambda: self.state(side) in states,
            lambda: f"{side} {' or '.join(states)}; it is {self.state(side)}: {self.reason(side)}",
        )

    def await_event(self, word: str, since: int) -> str:
        """The first event after the mark that holds this word."""
        return wait_until(
            lambda: next((event for event in self.events[since:] if word in event), ""),
            lambda: f"an event with {word!r}; there were {self.events[since:]}",
        )

    def report(self, node: str) -> dict[str, str]:
        """The node's next /diagnostics."""
        before = self.reports[node]
        wait_until(lambda: self.reports[node] > before, f"/diagnostics of {node}")
        return self.diagnostics[node]

    def counts(self) -> dict[str, int]:
        """What touchball_receiver counts, as it says next."""
        return {
            key: int(value)
            for key, value in self.report(process_of("/touchball_receiver")).items()
            if value.lstrip("-").isdigit()
        }

    def await_count(self, name: str, least: int) -> dict[str, int]:
        """Counts of touchball_receiver once ``name`` is at least so many."""
        return wait_until(lambda: (c := self.counts())[name] >= least and c, f"{name} >= {least}")
