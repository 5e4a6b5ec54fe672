"""realtime_host: the whole teleoperation in one C++ loop at 1 kHz; this node starts, feeds and observes it.

Console datagrams are received and answered inside the loop. Topics have the names, types and rates of the separate
nodes, and each of those nodes' heartbeats goes out while the loop steps, so that the supervisor works as with them.
"""

from __future__ import annotations

import os
import threading
import time
from datetime import datetime, timezone
from functools import partial
from pathlib import Path

import numpy as np
import rospy
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse

from saras import Error
from saras.runtime import TeleopHost
from saras_ros1 import convert, realtime_config
from saras_ros1.channel import SIDES, Channel, base_frame
from saras_ros1.fixtures import CHECK_S, Fixtures
from saras_ros1.inputs import HEARTBEAT_S, Input
from saras_ros1.msg import ChannelState, SideFault
from saras_ros1.node import Node, run
from saras_ros1.nodes.touchball_receiver import HEARD_S
from saras_ros1.params import Params
from saras_ros1.quiet_faults import LinkFaults
from saras_ros1.realtime_outputs import Topics
from saras_ros1.realtime_scene import SECTION, RealtimeScene
from saras_ros1.realtime_trust import Handshakes, merged
from saras_ros1.static_frames import StaticFrames

HOSTED = ("tf_transformer_{s}", "transparency/{s}", "tank_master", "tank_slave", "velocity_integrator_{s}")
STEPS_S = 0.2  #: a loop without a step for so long beats no more; it steps at 100 Hz without a console
RECORD_DELAY_S = 0.5  #: what happened after a fault belongs to its record
RECORD_EVERY_S = 10.0  #: one fault leads to another: they share a record
ASKED = ("the operator asked", "disengaged by the operator")


class RealtimeHost(Node):
    """Feeds mailboxes from topics, publishes the newest step, writes the flight record on a fault."""

    def __init__(self) -> None:
        super().__init__("realtime_host")
        self.params.text("hosting", ("realtime",))  # a misspelt hosting must not choose this one
        settings = realtime_config.read(self.params)
        directory = self.params.text("record_directory", empty=True)
        self.publish_period_s = self.params.number("publish_period_s", 0.001, 0.1)
        self.params.finish()
        home = Path(os.environ.get("ROS_HOME", "~/.ros")).expanduser()
        self.record_directory = Path(directory).expanduser() if directory else home / "flight"
        self.scene = self._read_scene(settings)
        self._wait_for_frames(settings.host.pipeline)
        self.fixtures = self._read_fixtures(settings.host.pipeline)

        self.host = TeleopHost(settings.host)
        self.handshakes = Handshakes(self.host, settings.keys) if settings.keys is not None else None
        self.topics = Topics(self, settings.host.pipeline, settings.publishing, self.fixtures)
        self._events = self.output("/system/events", String)
        self._faults = self.output("/system/faults", SideFault)
        self.operator = settings.operator
        self._names = list(dict.fromkeys(name.format(s=side) for name in HOSTED for side in SIDES))
        self._state: dict[str, int] = {}
        self._stepped_s = self._recorded_s = float("-inf")
        self._held = False
        self._records = 0
        for side in SIDES:
            self._subscribe(side, settings.force_topic)
        rospy.Service("~write_record", Trigger, self._on_write_record)
        rospy.on_shutdown(self.host.stop)
        self.host.start()
        rospy.loginfo(f"loop: {self.host.report.text()}")
        self._at_last_report = self.host.statistics()
        threading.Thread(target=self._publish, daemon=True).start()
        self.every(HEARTBEAT_S, self._beat_all)
        self._link_faults = LinkFaults(settings.operator)
        self.every(1.0, self._tell_link_faults)
        if self.fixtures.file is not None:
            self.every(CHECK_S, self._tell_fixtures)
        if self.scene is not None:
            self.every(self.scene.period_s, partial(self.scene.update, self.host))

    def _read_scene(self, settings: realtime_config.Settings) -> RealtimeScene | None:
        """The loop takes the distances itself when somebody acts on them."""
        if not settings.wants_nearness:
            return None
        scene = RealtimeScene(self, Params(rospy.get_param(SECTION, {}), SECTION))
        settings.host.pipeline.distances = scene.config()
        return scene

    def _read_fixtures(self, pipeline) -> Fixtures:
        """The same file as the separate nodes read, into the pipeline."""
        fixtures = Fixtures(self, SIDES, guards=True)
        pipeline.fixture_force = fixtures.force
        for side in SIDES:
            setattr(pipeline, f"{side}_fixtures", fixtures.lists[side])
        return fixtures

    def _tell_fixtures(self) -> None:
        for side in SIDES:
            self.host.set_fixtures(side, self.fixtures.word(side))

    def _wait_for_frames(self, pipeline) -> None:
        """Static frames of both consoles; nothing is late before there is a loop."""
        self.state = "WAITING"
        frames = StaticFrames()
        wanted = {
            side: (
                (base_frame(side), f"touchball_{side}/simball_base"),
                (f"touchball_{side}/touch_base", f"touchball_{side}/simball_base"),
            )
            for side in SIDES
        }
        while not rospy.is_shutdown():
            missing = [f"{a} ← {b}" for pairs in wanted.values() for a, b in pairs if not frames.known(a, b)]
            if not missing:
                break
            rospy.loginfo_throttle(5.0, f"waits for the transforms {', '.join(missing)}: does the node 'frames' run?")
            rospy.rostime.wallsleep(0.05)
        for side, (base, touch) in wanted.items():
            mapping = getattr(pipeline, f"{side}_mapping")
            mapping.base_T_console, mapping.touch_T_console = frames.lookup(*base), frames.lookup(*touch)

    def _subscribe(self, side: str, force_topic: str) -> None:
        frame, host = base_frame(side), self.host
        pose = self.input(f"/mesa_{side}/ee_pose", PoseStamped, convert.in_frame(frame, convert.pose))
        pose.listeners.append(lambda source: host.set_arm_pose(side, source.value, source.stamp_ns))
        wrench = self.input(force_topic.format(s=side), WrenchStamped, convert.in_frame(frame, convert.wrench))
        wrench.listeners.append(lambda source: host.set_arm_wrench(side, source.value))
        rcm = self.input(f"/mesa_{side}/rcm", PointStamped, convert.in_frame(frame, convert.point))
        rcm.listeners.append(lambda source: host.set_arm_rcm(side, source.value))
        channel = Channel(self, side)
        channel.input.listeners.append(partial(self._on_channel, channel))

    def _on_channel(self, channel: Channel, source: Input) -> None:
        word, side = source.message, channel.side
        # The loop counts the age of this word by itself. Nobody moves an arm that another operator holds.
        state = channel.state if word.holder in ("", self.operator) else ChannelState.WAITING
        self.host.set_supervisor(side, state, channel.engagement, word.clutch)
        before, self._state[side] = self._state.get(side), word.state
        if before == ChannelState.ENGAGED and word.state == ChannelState.HOLD and word.reason not in ASKED:
            self._record_later(f"{side}: {word.reason}")

    def _tell_link_faults(self) -> None:
        if text := self._link_faults.update(merged(self.host.counts(), self.handshakes), time.monotonic()):
            self._events.publish(String(text))

    def _publish(self) -> None:
        """A thread of its own: the newest step, as soon as it is there and the last one is old enough."""
        due_s = 0.0
        while not rospy.is_shutdown():
            if not self.host.wait(0.1):
                continue
            now = time.monotonic()
            self._stepped_s = now
            # A little early is on time: steps come with the console's own jitter.
            if now < due_s - 0.5 * self.publish_period_s:
                continue
            due_s = max(due_s + self.publish_period_s, now)
            try:
                snapshot = self.host.snapshot()
                if snapshot.held and not self._held:
                    self._tell_hold()
                self._held = snapshot.held
                self.topics.publish(snapshot)
            except rospy.ROSException:
                return
            except Exception as error:  # the loop goes on, and so must its picture
                rospy.logerr_throttle(1.0, f"publishing failed: {type(error).__name__}: {error}")

    def _tell_hold(self) -> None:
        """The loop has stopped both arms by itself: the supervisor is to hold them until somebody engages."""
        reason = "the real-time loop woke up too late"
        for side in SIDES:
            advice = "look what else runs on this computer, then engage again"
            fault = SideFault(side=side, source=self.name.lstrip("/"), reason=reason, advice=advice)
            fault.header.stamp = rospy.Time.now()
            self._faults.publish(fault)

    def _beat_all(self) -> None:
        """For each node that this loop is; none while it does not step, or while an engagement runs that is older."""
        if self.host.failure:
            rospy.logfatal_throttle(1.0, f"the loop ended: {self.host.failure}")
        if not self.host.running or time.monotonic() - self._stepped_s > STEPS_S:
            return
        for name in self._names:
            self._beat(String(name))
        if self.host.link_age_s() <= HEARD_S:
            self._heartbeats.publish(String(f"console/{self.operator}"))

    def _record_later(self, reason: str) -> None:
        now = time.monotonic()
        if now - self._recorded_s < RECORD_EVERY_S or not self.host.config.record_s:
            return
        self._recorded_s = now
        timer = threading.Timer(RECORD_DELAY_S, self._write_record, (reason,))
        timer.daemon = True
        timer.start()

    def _write_record(self, reason: str) -> tuple[bool, str]:
        name = f"{datetime.now(timezone.utc):%Y-%m-%d_%H-%M-%S-%f}.flight"
        try:
            self.record_directory.mkdir(parents=True, exist_ok=True)
            path = self.record_directory / name
            steps = self.host.write_record(str(path), reason)
        except (Error, OSError) as error:
            rospy.logerr(f"flight record not written: {error}")
            return False, str(error)
        self._records += 1
        text = f"flight record {path}: {steps} steps: {reason}"
        rospy.loginfo(text)
        self._events.publish(String(text))
        return True, text

    def _on_write_record(self, _) -> TriggerResponse:
        return TriggerResponse(*self._write_record("asked for"))

    def report(self) -> dict:
        """Link, rate and punctuality; rates are of the last second."""
        now, before = self.host.statistics(), self._at_last_report
        self._at_last_report = now
        return {
            **merged(self.host.counts(), self.handshakes),
            "link_age_ms": round(1e3 * self.host.link_age_s(), 1) if np.isfinite(self.host.link_age_s()) else "never",
            "rate_hz": now.steps - before.steps,
            "overruns": now.loop.overruns,
            "holds": now.loop.holds,
            "late_p99_us": round(1e-3 * now.loop.lateness.quantile_ns(0.99), 1),
            "step_p99_us": round(1e-3 * now.loop.execution.quantile_ns(0.99), 1),
            "reply_p99_us": round(1e-3 * now.reply.quantile_ns(0.99), 1),
            "realtime": self.host.report.text(),
            "records": self._records,
            **self.topics.limits(),
            **({} if self.scene is None else {"distances": "; ".join(self.scene.reasons) or "all known"}),
        }


def main() -> int:
    """Runs the node."""
    return run(RealtimeHost)
