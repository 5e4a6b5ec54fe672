"""The whole platform's E-stop, its state and its commands, the last two as CRTK has them (/system/…)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rospy
from crtk_msgs.msg import OperatingState, StringStamped
from std_srvs.srv import Trigger, TriggerResponse

from saras_ros1.side_supervisor import State, crtk_of_all

if TYPE_CHECKING:
    from saras_ros1.nodes.supervisor import Side, Supervisor

# CRTK's table, but for one entry: `enable` does not lead out of FAULT, as a reset never moves.
COMMANDS = {
    "enable": ("DISABLED", "ENABLED"),
    "pause": ("ENABLED", "PAUSED"),
    "resume": ("PAUSED",),
    "disable": ("DISABLED", "ENABLED", "PAUSED", "FAULT"),
}


class SystemCommands:
    """Services and topics of the whole. Engaging is asked of each side, with all that this needs."""

    def __init__(self, node: Supervisor, sides: list[Side]) -> None:
        self._node, self._sides = node, sides
        self._publisher = node.output("/system/operating_state", OperatingState, latch=True)
        rospy.Service("/system/estop", Trigger, self._on_estop)
        rospy.Service("/system/estop_reset", Trigger, self._on_reset)
        rospy.Subscriber("/system/state_command", StringStamped, self._on_command, queue_size=20, tcp_nodelay=True)

    @property
    def state(self) -> str:
        """CRTK's name of the whole."""
        return crtk_of_all([side.table.crtk for side in self._sides])

    def publish(self) -> None:
        """The state as it is. is_homed: all arms tell where they are; is_busy: a side may move."""
        message = OperatingState(state=self.state)
        message.header.stamp = rospy.Time.now()
        message.is_homed = all(side.arm.fresh for side in self._sides)
        message.is_busy = any(side.may_move for side in self._sides)
        self._publisher.publish(message)

    def _each(self, act: str) -> None:
        for side in self._sides:
            before = side.table.state
            getattr(side.table, act)()
            if side.table.state != before:
                side.changed()

    def _on_estop(self, _) -> TriggerResponse:
        with self._node.lock:
            self._each("estop")
        return TriggerResponse(True, "all sides stopped: reset with /system/estop_reset, then engage again")

    def _on_reset(self, _) -> TriggerResponse:
        with self._node.lock:
            if self.state != "FAULT":
                return TriggerResponse(False, "no E-stop is latched")
            self._each("estop_reset")
        return TriggerResponse(True, "E-stop reset: all sides hold until they are engaged")

    def _on_command(self, message: StringStamped) -> None:
        word = message.string
        latched = getattr(message, "_connection_header", {}).get("latching") == "1"
        with self._node.lock:
            state = self.state
            if word not in COMMANDS:
                refusal = f"must be one of {', '.join(COMMANDS)}"
            elif state not in COMMANDS[word]:
                refusal = f"is invalid in state {state}"
            elif latched and word in ("enable", "resume"):
                refusal = "comes from a latching publisher: an old word must not move an arm"
            else:
                refusal = self._obey(word)
            if refusal:
                text = f"/system/state_command '{word}' {refusal}"
                rospy.logwarn(text)
                self._node.event(text)

    def _obey(self, word: str) -> str:
        """Does it; what a side said against it."""
        if word in ("enable", "resume"):
            from_states = (State.HOLD,) if word == "resume" else (State.WAITING, State.READY)
            asked = [side for side in self._sides if side.table.state in from_states]
            return "; ".join(said for done, said in (side.engage() for side in asked) if not done)
        if word == "pause":
            for side in self._sides:
                if side.table.state == State.ENGAGED:
                    side.table.hold()
                    side.changed()
        else:
            self._each("estop_reset")
            self._each("disengage")
        return ""
