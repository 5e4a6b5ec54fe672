"""supervisor: watches consoles, arms and nodes, and says for each side whether it may teleoperate.

It only says so: every receiver has its own watchdog and treats silence of this node as HOLD.
"""

from __future__ import annotations

import time

import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Joy
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse

from saras_ros1 import convert
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.inputs import Input
from saras_ros1.msg import ChannelState
from saras_ros1.node import Node, run
from saras_ros1.nodes.tf_transformer import CLUTCH
from saras_ros1.side_supervisor import SideSupervisor, State, Watch
from saras_ros1.system_commands import SystemCommands


class Side:
    """Inputs, state table and outputs of one side."""

    def __init__(self, node: Supervisor, side: str) -> None:
        self.node, self.side = node, side
        self.table = SideSupervisor(side, node.auto_engage, round(node.auto_engage_settle_s / node.period_s))
        pose = convert.in_frame(base_frame(side), convert.pose)
        self.buttons = node.input(f"/touchball_{side}/buttons", Joy, timeout_s=node.console_limit_s)
        self.arm = node.input(f"/mesa_{side}/ee_pose", PoseStamped, pose, timeout_s=node.arm_limit_s)
        self.buttons.listeners.append(self._on_buttons)
        self.nodes = [name.format(s=side) for name in node.node_names]
        self.publisher = node.output(f"/system/{side}/state", ChannelState, latch=True)
        self.arm.listeners.append(self._on_arm)
        self._tip: np.ndarray | None = None
        self._tip_at = 0.0
        self._jump = ""
        self._clutch = False
        self._seq = 0
        rospy.Service(f"/system/{side}/engage", Trigger, self._on_engage)
        rospy.Service(f"/system/{side}/hold", Trigger, self._on_hold)

    def _on_arm(self, source: Input) -> None:
        tip, before = source.value[:3, 3], self._tip_at
        self._tip_at = source.received_s
        if self._tip is not None and self._tip_at - before < self.node.arm_limit_s:
            moved = float(np.linalg.norm(tip - self._tip))
            if moved > self.node.jump_limit_m:
                self._jump = f"the arm's pose jumped {moved * 1e3:.0f} mm (limit {self.node.jump_limit_m * 1e3:.0f})"
        self._tip = tip

    def _on_buttons(self, source: Input) -> None:
        pressed = bool(source.value.buttons and source.value.buttons[CLUTCH])
        if pressed != self._clutch:
            self._clutch = pressed
            self.publish()

    def update(self) -> None:
        """Ages into the table; a changed state is published and logged at once."""
        watches = [
            Watch("console data", self.buttons.age_s, self.node.console_limit_s, "check the console and its link"),
            Watch("arm state", self.arm.age_s, self.node.arm_limit_s, "check the arm and arm_state"),
        ]
        watches += [
            Watch(f"heartbeat of {name}", self.node.heartbeat_age_s(name), self.node.node_limit_s, f"restart {name}")
            for name in self.nodes
        ]
        jump, self._jump = self._jump, ""
        if self.table.update(watches, jump):
            self.changed()

    def changed(self) -> None:
        """Publishes now, logs, and leaves an event."""
        self.publish()
        text = f"{self.side}: {self.table.state.name}: {self.table.reason}"
        (rospy.logerr if self.table.state in (State.HOLD, State.ESTOP) else rospy.loginfo)(text)
        self.node.event(text)
        self.node.commands.publish()

    def publish(self) -> None:
        """The state as it is."""
        self._seq += 1
        message = ChannelState(
            seq=self._seq,
            side=self.side,
            state=min(int(self.table.state), ChannelState.HOLD),  # an E-stop is a HOLD to who only needs to stop
            engagement=self.table.engagement,
            clutch=self._clutch and self.buttons.fresh,
            reason=self.table.reason,
            advice=self.table.advice,
        )
        message.header.stamp = rospy.Time.now()
        self.publisher.publish(message)

    def engage(self) -> tuple[bool, str]:
        """(whether engaged now, what was said)."""
        before = self.table.state
        said = self.table.engage("" if self.node.master_answers else "roscore does not answer")
        if self.table.state != before:
            self.changed()
        return said

    @property
    def may_move(self) -> bool:
        """Whether motion flows now."""
        return self.table.state == State.ENGAGED and not self._clutch

    def _on_engage(self, _) -> TriggerResponse:
        with self.node.lock:
            return TriggerResponse(*self.engage())

    def _on_hold(self, _) -> TriggerResponse:
        with self.node.lock:
            self.table.hold()
            self.changed()
        if self.table.state == State.ESTOP:
            return TriggerResponse(True, f"{self.side} stands by E-stop")
        return TriggerResponse(True, f"{self.side} holds")


class Supervisor(Node):
    """Both sides; neither knows of the other."""

    def __init__(self) -> None:
        super().__init__("supervisor")
        self.period_s = self.params.number("period_s", 0.001, 0.1)
        self.publish_every = self.params.integer("publish_every", 1, 100)
        self.console_limit_s = self.params.number("console_limit_s", 0.02, 10.0)
        self.arm_limit_s = self.params.number("arm_limit_s", 0.02, 10.0)
        self.node_limit_s = self.params.number("node_limit_s", 0.02, 10.0)
        self.node_names = self.params.texts("nodes")
        self.jump_limit_m = self.params.number("jump_limit_m", 0.001, 1.0)
        self.auto_engage = self.params.flag("auto_engage")
        self.auto_engage_settle_s = self.params.number("auto_engage_settle_s", 0.1, 60.0)
        self.params.finish()
        self.master_answers = True
        self._events = self.output("/system/events", String)
        self._heartbeats: dict[str, float] = {}
        rospy.Subscriber("/system/heartbeats", String, self._on_heartbeat, queue_size=100, tcp_nodelay=True)
        with self.lock:  # a call that comes now waits until all is there
            self.sides = [Side(self, side) for side in SIDES]
            self.commands = SystemCommands(self, self.sides)
        self._updates = 0
        self._due_s = time.monotonic()
        self.every(self.period_s, self._update)
        self.every(1.0, self._check_master)

    def _on_heartbeat(self, message: String) -> None:
        self._heartbeats[message.data] = time.monotonic()

    def heartbeat_age_s(self, name: str) -> float:
        """Seconds since a node's loop last stepped; infinite when it never did."""
        return time.monotonic() - self._heartbeats.get(name, -float("inf"))

    def event(self, text: str) -> None:
        """One line for the record."""
        self._events.publish(String(text))

    def _update(self) -> None:
        now = time.monotonic()
        late_s, self._due_s = now - self._due_s, now + self.period_s
        with self.lock:
            self._updates += 1
            # Who was asleep himself cannot judge the age of others: their messages wait in our sockets.
            if late_s < self.period_s:
                for side in self.sides:
                    side.update()
            if self._updates % self.publish_every == 0:
                for side in self.sides:
                    side.publish()
                self.commands.publish()

    def _check_master(self) -> None:
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

    def report(self) -> dict:
        """State and reason a side."""
        return {side.side: f"{side.table.state.name}: {side.table.reason}" for side in self.sides}


def main() -> int:
    """Runs the node."""
    return run(Supervisor)
