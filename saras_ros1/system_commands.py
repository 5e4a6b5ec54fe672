"""The whole platform's E-stop, its state and its commands, the last two as CRTK has them (/system/…)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rospy
from crtk_msgs.msg import OperatingState, StringStamped
from std_srvs.srv import Trigger, TriggerResponse

from saras.safety import CrtkState
from saras_ros1.operator_ask import Ask
from saras_ros1.platform_supervisor import State

if TYPE_CHECKING:
    from saras_ros1.nodes.supervisor import Supervisor
    from saras_ros1.supervised_side import SupervisedSide

# CRTK's table, but for one entry: `enable` does not lead out of FAULT, as a reset never moves.
COMMANDS = {
    "enable": ("DISABLED", "ENABLED"),
    "pause": ("ENABLED", "PAUSED"),
    "resume": ("PAUSED",),
    "disable": ("DISABLED", "ENABLED", "PAUSED", "FAULT"),
}


class SystemCommands:
    """Services and topics of the whole. Engaging is asked of each side, with all that this needs."""

    def __init__(self, node: Supervisor, sides: list[SupervisedSide]) -> None:
        self._node, self._sides = node, sides
        self._publisher = node.output("/system/operating_state", OperatingState, latch=True)
        rospy.Service("/system/estop", Trigger, self._on_estop)
        rospy.Service("/system/estop_reset", Trigger, lambda _: TriggerResponse(*node.estop_reset()))
        rospy.Subscriber("/system/state_command", StringStamped, self._on_command, queue_size=20, tcp_nodelay=True)

    @property
    def state(self) -> str:
        """CRTK's name of the whole."""
        return crtk_of_all([side.state.crtk for side in self._sides])

    def publish(self) -> None:
        """The state as it is. is_homed: all arms tell where they are; is_busy: a side may move."""
        message = OperatingState(state=self.state)
        message.header.stamp = rospy.Time.now()
        message.is_homed = all(side.arm.fresh for side in self._sides)
        message.is_busy = any(side.state.may_move for side in self._sides)
        self._publisher.publish(message)

    def _on_estop(self, _) -> TriggerResponse:
        self._node.estop("E-stop")
        return TriggerResponse(True, "all sides stopped: reset with /system/estop_reset, then engage again")

    def _on_command(self, message: StringStamped) -> None:
        word, state = message.string, self.state
        latched = getattr(message, "_connection_header", {}).get("latching") == "1"
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
        if word == "disable" and self.state == "FAULT":
            done, said = self._node.estop_reset()
            if not done:
                return said
        act, states = {
            "enable": ("engage", (State.WAITING, State.READY)),
            "resume": ("engage", (State.HOLD,)),
            "pause": ("hold", (State.ENGAGED,)),
            "disable": ("disengage", (State.ENGAGED, State.HOLD)),
        }[word]
        answers = [self._node.ask(Ask(side.name, act)) for side in self._sides if side.state.state in states]
        return "; ".join(said for done, said in answers if not done)


def crtk_of_all(names: list[str]) -> str:
    """CRTK's name of the whole: FAULT when a side is, else ENABLED when one may move, else PAUSED, else DISABLED."""
    ranks = (CrtkState.FAULT, CrtkState.ENABLED, CrtkState.PAUSED)
    return next((state.name for state in ranks if state.name in names), CrtkState.DISABLED.name)
