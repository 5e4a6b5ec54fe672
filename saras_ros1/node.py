"""The life cycle that all nodes share.

    class Relay(Node):
        def __init__(self):
            super().__init__("relay")
            self.config = self.params.build(RelayConfig, "law")
            self.pose = self.input("/in/pose", PoseStamped, convert.pose, timeout_s=0.06)
            self.wrench = self.input("/in/wrench", WrenchStamped, convert.wrench, timeout_s=0.06)
            self.out = self.output("/out/pose", PoseStamped)
            self.loop(self.step, [self.pose], period_s=0.01)     # steps when a pose arrives; else it times out

        def step(self, tick):                                    # under self.lock
            if not tick.stale: self.out.publish(convert.pose_msg(self.pose.value, "world", tick.stamp_ns))

    def main(): return run(Relay)

Parameters (`self.params`) are read in __init__; run() refuses unknown ones. Errors there (saras.Error, StartupError)
end the process with code 2 and one line on stderr and in the log. Every node publishes /diagnostics once a second.
"""

from __future__ import annotations

import gc
import socket
import sys
import threading
import time
from typing import Any, Callable

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rospy.impl.paramserver import get_param_server_cache
from std_msgs.msg import String

from saras import ConfigError, Error
from saras_ros1 import direct_publishing, direct_reception
from saras_ros1.inputs import Input, Loop, Tick
from saras_ros1.law_publisher import PublishedLaw
from saras_ros1.params import Params
from saras_ros1.scheduling import wake_without_preempting
from saras_ros1.stamped import lean_class

__all__ = ["Input", "Loop", "Node", "StartupError", "Tick", "run"]

# XML-RPC has no timeout of its own: without this a hung master hangs start and shutdown for ever.
SOCKET_TIMEOUT_S = 5.0
# Recorded topics: a frozen subscriber must neither block publish() (queue None) nor lose the last messages.
QUEUE = 20


class StartupError(RuntimeError):
    """Something that the node needs did not come; the text says what is missing."""


class Node:
    """Base class: parameters, inputs, outputs, loops, diagnostics, clean shutdown. See the module's docstring."""

    def __init__(self, name: str, *, needs_params: bool = True) -> None:
        socket.setdefaulttimeout(SOCKET_TIMEOUT_S)
        wake_without_preempting()
        direct_publishing.install()
        direct_reception.install()
        rospy.core.add_preshutdown_hook(_log_shutdown)
        rospy.init_node(name)
        _log_without_asking()
        self.name = rospy.get_name()
        values = rospy.get_param(self.name, {})
        self.params = Params(values, self.name) if values or needs_params else None
        if rospy.get_param("/use_sim_time", False) and not rospy.get_param("/saras/simulated", True):
            raise StartupError("use_sim_time is set while real arms are connected: unset it")
        self.lock = threading.RLock()
        self.state = "STARTING"
        self.inputs: list[Input] = []
        self.loops: list[Loop] = []
        self.heard_channels: list[Any] = []  # each Channel of this node
        self._timers: list[tuple[float, Callable[[], None]]] = []
        self._steps_at_last_report: list[int] = []
        self._received_at_last_report: list[int] = []
        self._heartbeats = rospy.Publisher("/system/heartbeats", String, queue_size=QUEUE)
        self._diagnostics = rospy.Publisher("/diagnostics", DiagnosticArray, queue_size=QUEUE)

    def input(
        self,
        topic: str,
        message_class: type,
        convert: Callable[[Any], Any] | None = None,
        *,
        timeout_s: float = float("inf"),
    ) -> Input:
        """Subscribes; see Input. timeout_s is its watchdog. Stamped poses, twists, wrenches: saras_ros1.stamped."""
        source = Input(topic, timeout_s, convert, self.lock)
        self.inputs.append(source)
        rospy.Subscriber(topic, lean_class(message_class), source.on_message, queue_size=1, tcp_nodelay=True)
        return source

    def output(self, topic: str, message_class: type, *, latch: bool = False) -> rospy.Publisher:
        """Advertises with a bounded queue."""
        return rospy.Publisher(topic, message_class, queue_size=QUEUE, latch=latch)

    def loop(self, step: Callable[[Tick], None], primaries: list[Input], *, period_s: float, name: str = "") -> Loop:
        """Steps on the primary inputs; see Loop. Its heartbeat on /system/heartbeats is "node" or "node/name"."""
        beat = String(self.name.lstrip("/") + (f"/{name}" if name else ""))
        loop = Loop(step, primaries, period_s, self.lock, lambda: self._beat(beat))
        self.loops.append(loop)
        return loop

    def _beat(self, beat: String) -> None:
        """None while an engagement runs that is older than this node: the supervisor is to end it."""
        if not any(channel.inherited for channel in self.heard_channels):
            self._heartbeats.publish(beat)

    def law(self, name: str, law_class: type, *args: Any) -> Any:
        """Builds a law; its step takes keywords only. With /saras/trace_laws each step goes out on /laws/<name>."""
        return PublishedLaw(name, law_class, *args) if rospy.get_param("/saras/trace_laws", False) else law_class(*args)

    def every(self, period_s: float, callback: Callable[[], None]) -> None:
        """Calls back each period from a thread of its own, without the lock: for displays and reports, not for laws."""
        self._timers.append((period_s, callback))

    def wait_for(self, ready: Callable[[], bool], timeout_s: float, missing: Callable[[], str]) -> None:
        """Blocks the start until ready(), at most timeout_s; then StartupError(missing())."""
        end = time.monotonic() + timeout_s
        while not ready():
            if rospy.is_shutdown():
                raise StartupError("shut down while waiting: " + missing())
            if time.monotonic() > end:
                raise StartupError(f"waited {timeout_s:g} s: " + missing())
            time.sleep(0.02)

    def report(self) -> dict[str, Any]:
        """Further key/value pairs for /diagnostics; nodes override it."""
        return {}

    def run(self) -> None:
        """Starts loops and timers, then serves until shutdown."""
        if self.params is not None:
            self.params.finish()
        self.every(1.0, self._publish_diagnostics)
        # The collector would otherwise stop the control thread for milliseconds to walk the imported modules.
        gc.collect()
        gc.freeze()
        self.state = "RUNNING"
        for loop in self.loops:
            threading.Thread(target=loop.watch, daemon=True).start()
        for period_s, callback in self._timers:
            threading.Thread(target=_tick, args=(period_s, callback), daemon=True).start()
        rospy.loginfo(f"{self.name} runs")
        rospy.spin()

    def _publish_diagnostics(self) -> None:
        with self.lock:
            status = self._diagnose()
        message = DiagnosticArray(status=[status])
        message.header.stamp = rospy.Time.now()
        self._diagnostics.publish(message)

    def _diagnose(self) -> DiagnosticStatus:
        """Called once a second: counts since the last call are rates in Hz."""
        level, text, values = DiagnosticStatus.OK, self.state, {}
        steps, self._steps_at_last_report = self._steps_at_last_report, [loop.steps for loop in self.loops]
        for i, loop in enumerate(self.loops):
            before = steps[i] if i < len(steps) else 0
            suffix = f" {i}" if len(self.loops) > 1 else ""
            values["rate_hz" + suffix] = loop.steps - before
            values["step_mean_ms" + suffix] = round(1e3 * loop.busy_s / max(1, loop.steps), 3)
            values["step_worst_ms" + suffix] = round(1e3 * loop.worst_s, 3)
            values["stale_steps" + suffix] = loop.stale_steps
            values["dropped" + suffix] = loop.dropped
            values["clock_steps" + suffix] = loop.clock_steps
        received, self._received_at_last_report = self._received_at_last_report, [i.received for i in self.inputs]
        for i, source in enumerate(self.inputs):
            before = received[i] if i < len(received) else 0
            values[source.topic] = (
                f"age_ms={1e3 * source.age_s:.0f} rate_hz={source.received - before} "
                f"received={source.received} lost={source.lost} rejected={source.rejected}"
            )
            if source.timeout_s != float("inf") and not source.fresh:
                level, text = DiagnosticStatus.WARN, f"{self.state}: nothing from {source.topic}"
        values.update(self.report())
        return DiagnosticStatus(
            level=level, name=self.name, message=text, values=[KeyValue(str(k), str(v)) for k, v in values.items()]
        )


def run(factory: Callable[[], Node]) -> int:
    """main() of every node: the process's exit code (0 clean, 2 start refused)."""
    try:
        factory().run()
    except (Error, StartupError) as error:
        kind = "configuration refused" if isinstance(error, ConfigError) else "start failed"
        line = f"{rospy.get_name()}: {kind}: {error}"
        rospy.logfatal(line)
        print(line, file=sys.stderr, flush=True)
        rospy.signal_shutdown(line)
        return 2
    except rospy.ROSInterruptException:
        pass
    return 0


def _tick(period_s: float, callback: Callable[[], None]) -> None:
    due_s = time.monotonic()
    while not rospy.is_shutdown():
        due_s = max(due_s + period_s, time.monotonic())
        time.sleep(max(0.0, due_s - time.monotonic()))
        try:
            callback()
        except rospy.ROSException:
            return
        except Exception as error:
            rospy.logerr_throttle(1.0, f"{rospy.get_name()}: {type(error).__name__}: {error}")


def _log_without_asking() -> None:
    """Lets log lines wait for nobody.

    rospy asks the master for this parameter at every line, as long as nobody has set it: a hung master would stop
    whoever logs, control threads too, for SOCKET_TIMEOUT_S a line.
    """
    name = "/rosout_disable_topics_generation"
    get_param_server_cache().set(name, bool(rospy.get_param(name, False)))


def _log_shutdown(reason: str) -> None:
    """Says that rospy ends the older of two nodes of one name: it looks like a crash otherwise."""
    if "same name" in str(reason):
        rospy.logerr(f"{rospy.get_name()}: another node of this name was started; this one ends ({reason})")
