"""Topics of one handle and its port guard."""

from __future__ import annotations

from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import JointState, Joy

from saras.net import TouchballUpSide
from saras_ros1 import convert, tank_messages
from saras_ros1.msg import TankExchange, TankState
from saras_ros1.node import Node
from saras_ros1.stamped import time_of


class HandleOutputs:
    """Publishes what one datagram says of one side."""

    def __init__(self, node: Node, side: str, buttons_every: int, state_every: int) -> None:
        self.console = f"touchball_{side}"
        self.joint_names = [f"{self.console}/{name}" for name in ("yaw", "pitch", "roll", "insertion")]
        self.grip_name = [f"{self.console}/grip"]
        self.pressed: list[int] = []
        self.buttons_every, self.state_every = buttons_every, state_every
        self.count = 0
        self.pose = node.output(f"/{self.console}/pose", PoseStamped)
        self.joints = node.output(f"/{self.console}/joint_states", JointState)
        self.buttons = node.output(f"/{self.console}/buttons", Joy)
        self.grip = node.output(f"/{self.console}/grip", JointState)
        self.exchange = node.output(f"/port_guard_{side}/exchange", TankExchange)
        self.guard = node.output(f"/port_guard_{side}/state", TankState)

    def publish(self, up: TouchballUpSide, seq: int, stamp_ns: int, ledger_session: int) -> None:
        """The pose goes last: who steps on it finds the buttons of the same moment."""
        # Counted here: a network that loses every second datagram would else take all buttons, or all ledgers.
        self.count += 1
        # A level, repeated at a lower rate, and at once when it changes.
        pressed = [int(up.clutch), int(up.clip)]
        if self.count % self.buttons_every == 0 or pressed != self.pressed:
            self.pressed = pressed
            buttons = Joy(axes=[up.grip], buttons=pressed)
            buttons.header.stamp = time_of(stamp_ns)
            self.buttons.publish(buttons)
        if self.count % self.state_every == 0:
            self._publish_state(up, stamp_ns, ledger_session)
            self._publish_guard(up, seq, stamp_ns)
        self.pose.publish(convert.pose_msg(up.simball_T_handle, f"{self.console}/simball_base", stamp_ns))

    def _publish_state(self, up: TouchballUpSide, stamp_ns: int, ledger_session: int) -> None:
        ledger, joints, stamp = up.ledger, up.joints, time_of(stamp_ns)
        exchange = tank_messages.exchange(ledger_session, ledger.seq, ledger.sent_J, wishes=ledger, stamp_ns=stamp_ns)
        grip = JointState(name=self.grip_name, position=[up.grip])
        angles = [joints.yaw_rad, joints.pitch_rad, joints.roll_rad, joints.insertion_m]
        state = JointState(name=self.joint_names, position=angles)
        grip.header.stamp = state.header.stamp = stamp
        self.exchange.publish(exchange)
        self.grip.publish(grip)
        self.joints.publish(state)

    def _publish_guard(self, up: TouchballUpSide, seq: int, stamp_ns: int) -> None:
        guard, ledger = up.guard, up.ledger
        state = tank_messages.state(
            ledger.session,
            seq,
            levels=guard,
            out=guard,
            sums=guard,
            sent_J=ledger.sent_J,
            wishes=ledger,
            stamp_ns=stamp_ns,
        )
        self.guard.publish(state)
