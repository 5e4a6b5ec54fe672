"""Topics of the real-time host: the names, types and rates of the separate nodes."""

from __future__ import annotations

from typing import Any

import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from std_msgs.msg import String
from tf2_msgs.msg import TFMessage

from saras.runtime import HostSnapshot
from saras_ros1 import convert, tank_messages
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.fixtures import PUBLISH_EVERY, Fixtures
from saras_ros1.handle_outputs import HandleOutputs
from saras_ros1.msg import SideFixtures, TankExchange, TankState
from saras_ros1.node import Node
from saras_ros1.quiet_faults import TankFaults
from saras_ros1.realtime_config import Publishing

LIMITS = ("speed", "approach", "lead", "workspace", "fixture")


class SideTopics:
    """Of one side, from the set-point, which somebody waits for, to what is only looked at."""

    def __init__(self, node: Node, side: str, every: Publishing, fixtures: Fixtures) -> None:
        self.side, self.frame, self._every = side, base_frame(side), every
        self._fixtures = fixtures
        self.fixtures = node.output(f"/fixtures/{side}", SideFixtures) if fixtures.lists[side] else None
        self.touch = f"touchball_{side}/touch_base"
        self.console = HandleOutputs(node, side, every.buttons_every, every.state_every)
        self.set_point = node.output(f"/mesa_{side}/set_point", PoseStamped)
        self.tf = node.output("/tf", TFMessage)
        twist, wrench = TwistStamped, WrenchStamped
        self.tracked_pose = node.output(f"/tf_transformer_{side}/tracked_pose", PoseStamped)
        self.tracked_twist = node.output(f"/tf_transformer_{side}/tracked_twist", twist)
        self.tracked_twist_filtered = node.output(f"/tf_transformer_{side}/tracked_twist_filtered", twist)
        self.handle_twist = node.output(f"/tf_transformer_{side}/handle_twist", twist)
        self.desired_wrench = node.output(f"/transparency/{side}/desired_wrench", wrench)
        self.desired_twist = node.output(f"/transparency/{side}/desired_twist", twist)
        self.wrench = node.output(f"/tank_master/{side}/wrench", wrench)
        self.touch_wrench = node.output(f"/touchball_{side}/wrench", wrench)
        self.twist = node.output(f"/tank_slave/{side}/twist", twist)
        self.ledger = node.output(f"/tank_master/port_{side}/exchange", TankExchange)

    def publish(self, out: Any, up: Any, count: int, stamp_ns: int) -> None:
        """out: PipelineSideOutput; up: TouchballUpSide when a new datagram is behind it, else None."""
        if out.has_set_point:
            self.set_point.publish(convert.pose_msg(out.set_point, self.frame, stamp_ns))
        if up is not None and up.present:
            self.console.publish(up, count, stamp_ns, up.ledger.session)
        if out.is_mapped:
            self.handle_twist.publish(convert.twist_msg(out.handle_twist, self.frame, stamp_ns))
            self.tracked_twist.publish(convert.twist_msg(out.tracked_twist, self.frame, stamp_ns))
            filtered = convert.twist_msg(out.tracked_twist_filtered, self.frame, stamp_ns)
            self.tracked_twist_filtered.publish(filtered)
            self.tracked_pose.publish(convert.pose_msg(out.tracked_pose, self.frame, stamp_ns))
        self.desired_twist.publish(convert.twist_msg(out.desired_twist, self.frame, stamp_ns))
        self.desired_wrench.publish(convert.wrench_msg(out.desired_wrench, self.frame, stamp_ns))
        self.wrench.publish(convert.wrench_msg(out.base_wrench, self.frame, stamp_ns))
        self.touch_wrench.publish(convert.wrench_msg(out.touch_wrench, self.touch, stamp_ns))
        self.twist.publish(convert.twist_msg(out.twist, self.frame, stamp_ns))
        if count % self._every.exchange_every["tank_master"] == 0:
            ledger = out.to_guard
            sums = (ledger.session, ledger.seq, ledger.sent_J)
            self.ledger.publish(tank_messages.exchange(*sums, wishes=ledger, stamp_ns=stamp_ns))
        if self.fixtures is not None and count % PUBLISH_EVERY == 0:
            self.fixtures.publish(self._fixtures.message(self.side, out.fixtures, stamp_ns))
        if out.has_set_point and count % self._every.tf_every == 0:
            child = f"mesa_{self.side}/set_point"
            transform = convert.transform_msg(out.set_point, self.frame, child, rospy.Time.now())
            self.tf.publish(TFMessage([transform]))


class TankTopics:
    """State and ledger of one tank."""

    def __init__(self, node: Node, name: str, config: Any, every: Publishing, session: int) -> None:
        self._config, self._session = config, session
        self._exchange_every, self._state_every = every.exchange_every[name], every.tank_state_every[name]
        self._state = node.output(f"/{name}/state", TankState)
        self._exchange = node.output(f"/{name}/exchange", TankExchange)
        self._events, self._faults = node.output("/system/events", String), TankFaults(name)
        self._seq = 0

    def publish(self, out: Any, count: int, stamp_ns: int) -> None:
        """out: TankOutput."""
        if text := self._faults.update(out.reduction, out.energy_J):
            self._events.publish(String(text))
        if count % self._exchange_every == 0:
            self._exchange.publish(tank_messages.exchange(*out.to_peer, wishes=out, stamp_ns=stamp_ns))
        if count % self._state_every:
            return
        self._seq += 1
        message = tank_messages.state(
            self._session,
            self._seq,
            levels=self._config,
            out=out,
            sums=out,
            sent_J=out.sent_J,
            wishes=out,
            stamp_ns=stamp_ns,
        )
        self._state.publish(message)


class Topics:
    """All of them."""

    def __init__(self, node: Node, pipeline: Any, every: Publishing, fixtures: Fixtures) -> None:
        self._sides = {side: SideTopics(node, side, every, fixtures) for side in SIDES}
        tanks = {"tank_master": pipeline.tank_master, "tank_slave": pipeline.tank_slave}
        self._tanks = {name: TankTopics(node, name, tanks[name], every, pipeline.session) for name in tanks}
        self._count = 0
        self._newest_seq: tuple[int, int] | None = None
        self._output: Any = None

    def limits(self) -> dict[str, str]:
        """Which bounds held back each side's set-point in the step published last."""
        if self._output is None:
            return {}
        found = {}
        for side in SIDES:
            out = getattr(self._output, side)
            acting = [name for name in LIMITS if getattr(out, f"{name}_limited")]
            found[f"{side}_limited_by"] = " ".join(acting) or "none"
        return found

    def publish(self, snapshot: HostSnapshot) -> None:
        """One step. What the console said is published once, so that its age shows when it is silent."""
        self._count += 1
        tick, up = snapshot.tick, snapshot.up
        key = None if up is None else (up.session, up.seq)
        fresh = key is not None and key != self._newest_seq
        self._newest_seq = key
        self._output = tick.output
        for side, topics in self._sides.items():
            handle = getattr(up, side) if fresh else None
            topics.publish(getattr(tick.output, side), handle, self._count, tick.stamp_ns)
        for name, topics in self._tanks.items():
            topics.publish(getattr(tick.output, name), self._count, tick.stamp_ns)
