"""supervisor: watches consoles, arms and nodes, and says for each side whether it may teleoperate, and for whom.

It only says so: every receiver has its own watchdog and treats silence of this node as HOLD.
"""

from __future__ import annotations

import socket
import time

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticStatus
from std_msgs.msg import Bool, String

from saras import ConfigError
from saras.safety import MAX_OPERATORS, SafetyState
from saras_ros1.channel import SIDES
from saras_ros1.console_switch import PAUSE_S
from saras_ros1.estop_latch import EstopLatch
from saras_ros1.msg import SideFault
from saras_ros1.node import SOCKET_TIMEOUT_S, Node, run
from saras_ros1.operator_ask import Ask
from saras_ros1.params import Params
from saras_ros1.platform_supervisor import PlatformSupervisor, Side
from saras_ros1.supervised_side import SupervisedSide
from saras_ros1.system_commands import SystemCommands

ANSWER_TIMEOUT_S = 2.0
#: From a new holder to the first data of his console: ConsoleSwitch's pause, and the way of messages on a busy machine.
HAND_OVER_S = PAUSE_S + 0.35


class SideLimits:
    """What a side's inputs are judged by."""

    def __init__(self, params: Params) -> None:
        self.console_s = params.number("console_limit_s", 0.02, 1.0)
        self.arm_s = params.number("arm_limit_s", 0.02, 1.0)
        self.node_s = params.number("node_limit_s", 0.02, 2.0)
        self.jump_m = params.number("jump_limit_m", 0.001, 1.0)
        self.hand_m_s = params.number("align_hand_speed_m_s", 0.001, 1.0)


class Supervisor(Node):
    """Both sides; neither knows of the other but for the E-stop."""

    def __init__(self) -> None:
        super().__init__("supervisor")
        self.period_s = self.params.number("period_s", 0.001, 0.1)
        self.publish_every = self.params.integer("publish_every", 1, 100)
        self.limits = SideLimits(self.params)
        self.node_names = self.params.texts("nodes")
        operators = self.params.texts("operators")
        if not 1 <= len(set(operators)) == len(operators) <= MAX_OPERATORS:
            raise ConfigError(f"{self.name}/operators = {operators}: must be 1 to {MAX_OPERATORS} different names")
        auto_engage = self.params.flag("auto_engage")
        settle_s = self.params.number("auto_engage_settle_s", 0.1, 60.0)
        self.latch = EstopLatch(self.params.text("estop_file"))
        has_button = self.params.flag("estop_button")
        button_limit_s = self.params.number("estop_button_limit_s", 0.02, 1.0)
        self.params.finish()
        self.master_answers = True
        self.faults: dict[str, SideFault] = {}
        self._reset_asked = False
        self._events = self.output("/system/events", String)
        self._heartbeats: dict[str, float] = {}
        self.button = self.input("/system/estop_button", Bool, timeout_s=button_limit_s) if has_button else None
        self.platform = PlatformSupervisor(
            SIDES,
            tuple(operators),
            auto_engage=auto_engage,
            settle_looks=round(settle_s / self.period_s),
            hand_over_looks=round(HAND_OVER_S / self.period_s),
            latched=self.latch.read(),
        )
        rospy.Subscriber("/system/heartbeats", String, self._on_heartbeat, queue_size=100, tcp_nodelay=True)
        rospy.Subscriber("/system/faults", SideFault, self._on_fault, queue_size=20, tcp_nodelay=True)
        with self.lock:  # a call that comes now waits until all is there
            self.sides = [SupervisedSide(self, self.platform.sides[side]) for side in SIDES]
            self.commands = SystemCommands(self, self.sides)
        if self.platform.estop_latched:
            rospy.logerr(f"still latched from before this start: {self.platform.estop_latched}")
        self._looks = 0
        self._due_s = time.monotonic()
        self.every(self.period_s, self._look)
        self.every(1.0, self._check_master)

    def ask(self, ask: Ask) -> tuple[bool, str]:
        """Puts it to the next look and waits; not to be called with the lock."""
        if ask.act == "engage" and not self.master_answers:
            ask.refusal = "roscore does not answer"
        with self.lock:
            self.platform.ask(ask)
        return ask.wait(ANSWER_TIMEOUT_S)

    def estop(self, reason: str) -> None:
        """Stops all sides, before anything else."""
        with self.lock:
            self._changed(self.platform.estop(reason))
            self._keep_latch()

    def estop_reset(self) -> tuple[bool, str]:
        """In the next look; not to be called with the lock."""
        with self.lock:
            if not self.platform.estop_latched:
                return False, "no E-stop is latched"
            if pressed := self._pressed():
                return False, f"not reset: {pressed}"
            self._reset_asked = True
        end = time.monotonic() + ANSWER_TIMEOUT_S
        while self._reset_asked and time.monotonic() < end:
            time.sleep(0.005)
        self._reset_asked = False
        if self.platform.estop_latched:
            return False, f"not reset: {self.platform.estop_latched}"
        return True, "E-stop reset: all sides hold until they are engaged"

    def heartbeat_age_s(self, name: str) -> float:
        """Seconds since a node's loop last stepped; infinite when it never did."""
        return time.monotonic() - self._heartbeats.get(name, -float("inf"))

    def event(self, text: str) -> None:
        """One line for the record."""
        self._events.publish(String(text))

    def _on_heartbeat(self, message: String) -> None:
        self._heartbeats[message.data] = time.monotonic()

    def _on_fault(self, message: SideFault) -> None:
        with self.lock:
            self.faults.setdefault(message.side, message)

    def _pressed(self) -> str:
        """Why the E-stop button counts as pressed; "": it is not, or there is none."""
        if self.button is None:
            return ""
        if not self.button.fresh:
            return "E-stop: nothing from the E-stop button"
        return "E-stop: the button is pressed" if self.button.value.data else ""

    def _look(self) -> None:
        now = time.monotonic()
        late_s, self._due_s = now - self._due_s, now + self.period_s
        with self.lock:
            self._looks += 1
            # Who was asleep himself cannot judge the age of others: their messages wait in our sockets.
            if late_s < self.period_s:
                self._update()
            if self._looks % self.publish_every == 0:
                for side in self.sides:
                    side.publish()
                self.commands.publish()

    def _update(self) -> None:
        signs = {side.name: side.signs(self.faults.pop(side.name, None)) for side in self.sides}
        names = self.platform.operators
        alive = [self.heartbeat_age_s(f"console/{name}") <= self.limits.node_s for name in names]
        latched = bool(self.platform.estop_latched)
        self._changed(self.platform.update(signs, alive, estop=self._pressed(), reset=self._reset_asked))
        self._reset_asked = False
        if latched != bool(self.platform.estop_latched):
            self._keep_latch()

    def _keep_latch(self) -> None:
        try:
            if self.platform.estop_latched:
                self.latch.write(self.platform.estop_latched)
            else:
                self.latch.clear()
        except OSError as error:  # the latch in memory holds all the same
            rospy.logerr(f"the E-stop's latch is not kept over a restart: {error}")

    def _changed(self, sides: list[Side]) -> None:
        for side in self.sides:
            if side.state in sides:
                side.changed()

    def _check_master(self) -> None:
        # Each time: rospy sets it to a minute whenever it connects to a publisher.
        socket.setdefaulttimeout(SOCKET_TIMEOUT_S)
        try:
            rosgraph.Master("/supervisor").getPid()
            answers = True
        except Exception:
            answers = False
        if answers != self.master_answers:
            self.master_answers = answers
            text = "roscore answers again: restart the graph" if answers else "roscore does not answer: links go on"
            rospy.logerr(text)
            self.event(text)

    def _diagnose(self) -> DiagnosticStatus:
        """As every node's, and an E-stop is an error, a HOLD a warning."""
        status = super()._diagnose()
        held = [f"{s.name}: {s.reason}" for s in self.platform.sides.values() if s.state == SafetyState.HOLD]
        if self.platform.estop_latched:
            status.level, status.message = DiagnosticStatus.ERROR, self.platform.estop_latched
        elif held:
            status.level, status.message = DiagnosticStatus.WARN, "; ".join(held)
        return status

    def report(self) -> dict:
        """State, reason and advice a side, who holds the arms, and the E-stop."""
        values = {}
        for side in self.platform.sides.values():
            words = ": ".join(word for word in (side.state.name, side.reason, side.advice) if word)
            values[side.name] = words
            values[f"{side.name} held by"] = self.platform.name_of(side.holder) or "nobody"
        return {**values, "estop": self.platform.estop_latched or "not latched"}


def main() -> int:
    """Runs the node."""
    return run(Supervisor)
