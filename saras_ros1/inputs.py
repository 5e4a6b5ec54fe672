"""Subscriptions that know their age, and the loop that steps a law on its primary inputs."""

from __future__ import annotations

import threading
import time
from typing import Any, Callable, NamedTuple

import rospy

from saras_ros1.stamped import NANOSECONDS, Stamped, time_of

CLOCK_STEP_S = 1.0
HEARTBEAT_S = 0.1


class Tick(NamedTuple):
    """One step of a loop.

    dt: seconds since the last step, from the stamps of the primary inputs, so that a recorded run replays exactly;
    stale: the primary inputs are silent: the safe output is due; stamp_ns: of the newest primary input, for outputs.
    """

    dt: float
    stale: bool
    stamp_ns: int

    @property
    def stamp(self) -> rospy.Time:
        """stamp_ns as a ROS time."""
        return time_of(self.stamp_ns)


class Input:
    """The newest good message of one topic.

    `value` is what `convert(message)` gave; a message that convert refuses (ValueError) is counted in `rejected`,
    logged, and does not feed the watchdog. Gaps in header.seq (the link's own count) are counted in `lost`.
    """

    def __init__(
        self, topic: str, timeout_s: float, convert: Callable[[Any], Any] | None, lock: threading.RLock
    ) -> None:
        self.topic, self.timeout_s = topic, timeout_s
        self.message: Any = None
        self.value: Any = None
        self.stamp_ns = 0
        self.received_s: float | None = None
        self.received = self.rejected = self.lost = 0
        self.listeners: list[Callable[[Input], None]] = []
        self._convert, self._lock = convert, lock
        self._seq: int | None = None

    def on_message(self, message: Any) -> None:
        """Subscriber callback: converts, stores and tells the listeners (loops).

        Only who has listeners takes the lock: a step must not see a primary input change under it. Any other input is
        read once a step, and a newer value is as good.
        """
        now = time.monotonic()
        header = getattr(message, "header", None)
        if header is not None and header.seq:
            if self._seq is not None and header.seq > self._seq + 1:
                self.lost += header.seq - self._seq - 1
            self._seq = header.seq
        try:
            value = message if self._convert is None else self._convert(message)
        except ValueError as error:
            self.rejected += 1
            rospy.logwarn_throttle(1.0, f"{self.topic}: message refused ({self.rejected} so far): {error}")
            return
        if not self.listeners:
            self._store(message, value, header, now)
            return
        with self._lock:
            self._store(message, value, header, now)
            for listener in self.listeners:
                listener(self)

    def _store(self, message: Any, value: Any, header: Any, now: float) -> None:
        self.received += 1
        if isinstance(message, Stamped):
            self.stamp_ns = message.stamp_ns
        elif header is not None:
            self.stamp_ns = header.stamp.secs * NANOSECONDS + header.stamp.nsecs
        self.message, self.value, self.received_s = message, value, now

    @property
    def age_s(self) -> float:
        """Seconds since the last good message; infinite when there was none."""
        return float("inf") if self.received_s is None else time.monotonic() - self.received_s

    @property
    def fresh(self) -> bool:
        """Whether the last good message is younger than this input's watchdog."""
        return self.age_s <= self.timeout_s

    @property
    def fresh_value(self) -> Any:
        """`value` while fresh, else None: unknown."""
        return self.value if self.fresh else None


class Loop:
    """Calls `step(tick)` when its primary inputs have news; its timer only times out.

    With several primaries it steps once all that are alive have brought a new message, or one of them a second one:
    a dead primary never holds up the others. While all are silent for longer than their watchdog, step is called
    once per period with tick.stale. `heartbeat` is called at most every 100 ms, by the thread that steps.
    """

    def __init__(
        self,
        step: Callable[[Tick], None],
        primaries: list[Input],
        period_s: float,
        lock: threading.RLock,
        heartbeat: Callable[[], None] = lambda: None,
    ) -> None:
        self.steps = self.stale_steps = self.dropped = self.clock_steps = 0
        self.busy_s = self.worst_s = 0.0
        self.period_s = period_s
        self._step, self._primaries, self._lock = step, primaries, lock
        self._heartbeat, self._heartbeat_due_s = heartbeat, 0.0
        self._pending: set[int] = set()
        self._last_stamp_ns: int | None = None
        self._last_news_s = time.monotonic()
        for primary in primaries:
            primary.listeners.append(self._on_news)

    def _on_news(self, primary: Input) -> None:
        self._last_news_s = time.monotonic()
        second = id(primary) in self._pending
        self._pending.add(id(primary))
        if not second and any(id(other) not in self._pending and other.fresh for other in self._primaries):
            return
        self._pending.clear()
        stamp_ns = max(p.stamp_ns for p in self._primaries if p is primary or p.fresh)
        dt = self.period_s if self._last_stamp_ns is None else (stamp_ns - self._last_stamp_ns) / NANOSECONDS
        if dt <= 0.0 and dt > -CLOCK_STEP_S:
            self.dropped += 1  # duplicate or older than what was already used
            return
        if dt <= 0.0:  # the sender restarted or its clock was set: begin a new count
            self.clock_steps += 1
            dt = self.period_s
        self._last_stamp_ns = stamp_ns
        self._run(Tick(dt, False, stamp_ns))

    def _run(self, tick: Tick) -> None:
        begin = time.perf_counter()
        try:
            self._step(tick)
            if begin >= self._heartbeat_due_s:
                self._heartbeat_due_s = begin + HEARTBEAT_S
                self._heartbeat()
        except rospy.ROSException as error:
            if not rospy.core.is_shutdown_requested():  # else: topics close before the threads end
                rospy.logerr_throttle(1.0, f"step failed: {error}")
        except Exception:  # a node that dies of one bad tick is worse than one that says so
            rospy.logerr_throttle(1.0, f"step failed: {_traceback()}")
        took = time.perf_counter() - begin
        self.steps += 1
        self.busy_s += took
        self.worst_s = max(self.worst_s, took)

    def watch(self) -> None:
        """The watchdog thread: sleeps until the primaries would be late, then steps with stale once per period."""
        timeout_s = max(p.timeout_s for p in self._primaries)
        due_s = time.monotonic() + timeout_s
        while not rospy.is_shutdown():
            time.sleep(max(0.0, min(0.5, due_s - time.monotonic())))
            now = time.monotonic()
            if now < due_s:
                continue
            with self._lock:
                alive_until = self._last_news_s + timeout_s
                if alive_until > now:
                    due_s = alive_until
                    continue
                self.stale_steps += 1
                self._run(Tick(self.period_s, True, time.time_ns()))
            due_s = max(due_s + self.period_s, now)


def _traceback() -> str:
    import traceback

    return traceback.format_exc(limit=6)
