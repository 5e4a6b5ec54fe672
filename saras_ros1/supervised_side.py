"""One side of the supervisor node: its inputs as signs, its state as messages, its services."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState, Joy
from std_srvs.srv import Trigger, TriggerResponse

from saras.kinematics import simball
from saras_ros1 import convert
from saras_ros1.alignment import HandSpeed, misalignment
from saras_ros1.channel import base_frame
from saras_ros1.inputs import Input
from saras_ros1.msg import ChannelState, SideFault
from saras_ros1.nodes.tf_transformer import CLUTCH
from saras_ros1.operator_ask import Ask
from saras_ros1.platform_supervisor import Side, SideSigns, State
from saras_ros1.srv import OperatorAct, OperatorActResponse
from saras_ros1.watch import Watch

if TYPE_CHECKING:
    from saras_ros1.nodes.supervisor import Supervisor

HAND_AGE_S = 1.0  #: an older speed of the hand is not known


def read_joints(message: JointState) -> np.ndarray:
    """(4,) of the Simball."""
    joints = convert.positions(message)
    if joints.shape != (len(simball.JOINT_NAMES),):
        raise ValueError(f"joints {list(message.position)}: must be {len(simball.JOINT_NAMES)}")
    return joints


class SupervisedSide:
    """Ages, jumps, alignment in; ChannelState and services out. The state itself is PlatformSupervisor's."""

    def __init__(self, node: Supervisor, state: Side) -> None:
        self.node, self.state, self.name = node, state, state.name
        side = self.name
        pose = convert.in_frame(base_frame(side), convert.pose)
        self.buttons = node.input(f"/touchball_{side}/buttons", Joy, timeout_s=node.limits.console_s)
        self.arm = node.input(f"/mesa_{side}/ee_pose", PoseStamped, pose, timeout_s=node.limits.arm_s)
        self.hand = node.input(f"/touchball_{side}/joint_states", JointState, read_joints)
        self.hand_speed = HandSpeed()
        self.buttons.listeners.append(self._on_buttons)
        self.arm.listeners.append(self._on_arm)
        self.hand.listeners.append(lambda source: self.hand_speed.update(source.value, source.stamp_ns))
        self.nodes = [name.format(s=side) for name in node.node_names]
        self.publisher = node.output(f"/system/{side}/state", ChannelState, latch=True)
        self._tip: np.ndarray | None = None
        self._tip_at = 0.0
        self._jump = ""
        self._clutch = False
        self._seq = 0
        rospy.Service(f"/system/{side}/engage", Trigger, self._on_engage)
        rospy.Service(f"/system/{side}/hold", Trigger, self._on_hold)
        rospy.Service(f"/system/{side}/operator", OperatorAct, self._on_operator)

    def _on_arm(self, source: Input) -> None:
        tip, before = source.value[:3, 3], self._tip_at
        self._tip_at = source.received_s
        if self._tip is not None and self._tip_at - before < self.node.limits.arm_s:
            moved, limit = float(np.linalg.norm(tip - self._tip)), self.node.limits.jump_m
            if moved > limit:
                self._jump = f"the arm's pose jumped {moved * 1e3:.0f} mm (limit {limit * 1e3:.0f})"
        self._tip = tip

    def _on_buttons(self, source: Input) -> None:
        pressed = bool(source.value.buttons and source.value.buttons[CLUTCH])
        if pressed != self._clutch:
            self._clutch = pressed
            self.publish()

    def signs(self, fault: SideFault | None) -> SideSigns:
        """What is seen now. fault: what a node said since the last look."""
        limits = self.node.limits
        watches = [
            Watch("console data", self.buttons.age_s, limits.console_s, "check the console and its link"),
            Watch("arm state", self.arm.age_s, limits.arm_s, "check the arm and arm_state"),
        ]
        watches += [
            Watch(f"heartbeat of {name}", self.node.heartbeat_age_s(name), limits.node_s, f"restart {name}")
            for name in self.nodes
        ]
        signs = SideSigns(watches, misaligned=self._misaligned(), clutch=self._clutch and self.buttons.fresh)
        jump, self._jump = self._jump, ""
        if jump:
            return signs._replace(fault=jump)
        if fault is not None:
            return signs._replace(fault=f"{fault.source}: {fault.reason}", fault_advice=fault.advice)
        return signs

    def _misaligned(self) -> str:
        if self.state.state == State.ENGAGED:
            return ""
        known = self.hand.age_s < HAND_AGE_S
        return misalignment(self.hand_speed.m_s if known else float("nan"), self.node.limits.hand_m_s)

    def changed(self) -> None:
        """Publishes now, logs, and leaves an event."""
        self.publish()
        state = self.state
        text = f"{self.name}: {state.state.name}: {state.reason}" + (f" → {state.advice}" if state.advice else "")
        (rospy.logerr if state.state in (State.HOLD, State.ESTOP) else rospy.loginfo)(text)
        self.node.event(text)
        self.node.commands.publish()

    def publish(self) -> None:
        """The state as it is."""
        self._seq += 1
        state, name_of = self.state, self.node.platform.name_of
        message = ChannelState(
            seq=self._seq,
            side=self.name,
            state=min(int(state.state), ChannelState.HOLD),  # an E-stop is a HOLD to who only needs to stop
            engagement=state.engagement,
            clutch=self._clutch and self.buttons.fresh,
            estop=state.state == State.ESTOP,
            holder=name_of(state.holder),
            offered_to=name_of(state.offered_to),
            misaligned=state.misaligned,
            reason=state.reason,
            advice=state.advice,
        )
        message.header.stamp = rospy.Time.now()
        self.publisher.publish(message)

    def _on_engage(self, _) -> TriggerResponse:
        return TriggerResponse(*self.node.ask(Ask(self.name, "engage")))

    def _on_hold(self, _) -> TriggerResponse:
        return TriggerResponse(*self.node.ask(Ask(self.name, "hold")))

    def _on_operator(self, request) -> OperatorActResponse:
        names = self.node.platform.operators
        if request.operator not in names:
            return OperatorActResponse(False, f"operator '{request.operator}': must be one of {', '.join(names)}")
        if request.act == "offer" and (request.to not in names or request.to == request.operator):
            return OperatorActResponse(False, f"to '{request.to}': must be another one of {', '.join(names)}")
        to = names.index(request.to) + 1 if request.act == "offer" else 0
        try:
            ask = Ask(self.name, request.act, names.index(request.operator) + 1, to)
        except ValueError as error:
            return OperatorActResponse(False, str(error))
        return OperatorActResponse(*self.node.ask(ask))
