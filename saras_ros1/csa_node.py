"""What the nodes of complementary situational awareness share: the system file, the check of arms, pace, pedals."""

from __future__ import annotations

import time
from typing import Any, NamedTuple

import numpy as np
import rosgraph
import rospy
from sensor_msgs.msg import JointState, Joy

from saras import csa
from saras.csa.setup import Setup
from saras.csa.system import load
from saras_ros1.inputs import Tick
from saras_ros1.node import Node

DT_MAX_S = 0.1
LOOK_S = 0.2
PRESSED, TAPPED = 1, 2


class CsaNode(Node):
    """Parameters: system (path of the file), teleop (name in it; empty: the first)."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        teleop = self.params.text("teleop", empty=True)
        self.setup: Setup = load(self.params.text("system")).setup(teleop or None)
        self.master, self.slave = self.setup.master["name"], self.setup.slave["name"]
        self.frame = self.setup.frame
        self.pace = Pace(self.setup.period_s)

    def require(self, *needs: Need) -> None:
        """Waits until all are there. Raises StartupError naming what is missing, and what for."""
        missing, looked_s = list(needs), 0.0

        def ready() -> bool:
            nonlocal looked_s, missing
            if time.monotonic() - looked_s >= LOOK_S:
                looked_s = time.monotonic()
                missing = missing_of(self.name, list(needs))
            return not missing

        def said() -> str:
            return f"{self.setup.path}: {self.setup.name}: " + "; ".join(map(str, missing))

        self.wait_for(ready, self.setup.start_timeout_s, said)


class Need(NamedTuple):
    """A topic that somebody must publish, or listen to."""

    topic: str
    message_class: type
    purpose: str
    listens: bool = False

    def __str__(self) -> str:
        verb = "listens to" if self.listens else "publishes"
        return f"nobody {verb} {self.topic} ({self.message_class._type}): {self.purpose}"


def missing_of(name: str, needs: list[Need]) -> list[Need]:
    """Those that are not there now, by the master's word."""
    master = rosgraph.Master(name)
    publishers, listeners, _ = master.getSystemState()
    types = dict(master.getTopicTypes())

    def there(need: Need) -> bool:
        nodes = dict(listeners if need.listens else publishers).get(need.topic, [])
        kind = types.get(need.topic, "*")
        return any(node != name for node in nodes) and kind in (need.message_class._type, "*")

    return [need for need in needs if not there(need)]


class Pace:
    """Time steps from stamps; a source that is faster than the period is thinned out."""

    def __init__(self, period_s: float) -> None:
        self.period_s = period_s
        self._last_ns: int | None = None

    def __call__(self, tick: Tick) -> float | None:
        """Seconds of this step; None: too early for one."""
        if tick.stale:
            return self.period_s
        dt = self.period_s if self._last_ns is None else 1e-9 * (tick.stamp_ns - self._last_ns)
        if 0.0 < dt < 0.6 * self.period_s:
            return None
        self._last_ns = tick.stamp_ns
        return min(dt, DT_MAX_S) if dt > 0.0 else self.period_s


class Pedal:
    """A button (sensor_msgs/Joy, the first one): 0 released, 1 pressed, 2 tapped."""

    def __init__(self, topic: str, on_press: Any = None, on_tap: Any = None) -> None:
        self.topic = topic
        self.state: int | None = None
        self._on_press, self._on_tap = on_press, on_tap
        rospy.Subscriber(topic, Joy, self._on_joy, queue_size=10, tcp_nodelay=True)

    def _on_joy(self, message: Joy) -> None:
        if not message.buttons:
            return
        before, self.state = self.state, message.buttons[0]
        if self.state == PRESSED and before is not None and before != PRESSED and self._on_press:
            self._on_press()
        elif self.state == TAPPED and self._on_tap:
            self._on_tap()


class Joints(NamedTuple):
    """A JointState of one arm."""

    q: np.ndarray
    v: np.ndarray


def joint_reader(count: int, names: list[str] | None = None) -> Any:
    """Converts the JointState of an arm with so many joints; a gripper behind them is left out.

    names: its joints are found by these instead of by their place.
    """

    def read(message: JointState) -> Joints:
        position, velocity = message.position, message.velocity
        if names is not None:
            at = [message.name.index(name) for name in names]  # ValueError when one is not there
            position = [position[i] for i in at]
            velocity = [velocity[i] for i in at] if len(velocity) == len(message.name) else []
        q, v = np.array(position[:count], dtype=float), np.array(velocity[:count], dtype=float)
        if len(q) != count or not np.isfinite(q).all():
            raise ValueError(f"joint positions {list(message.position)}: must be {count} finite numbers")
        if len(v) != count or not np.isfinite(v).all():
            v = np.full(count, np.nan)
        return Joints(q, v)

    return read


def joint_state(names: tuple[str, ...], stamp: rospy.Time, **values: np.ndarray) -> JointState:
    """A JointState with position, velocity or effort (n,)."""
    message = JointState(name=list(names), **{name: array.tolist() for name, array in values.items()})
    message.header.stamp = stamp
    return message


def warm_up() -> None:
    """Scipy takes a moment to import: not under the lock, when the first region is closed."""
    csa.region_of_interest([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]])


def vector(message: Any, values: np.ndarray) -> Any:
    """Writes (3,) into a Vector3 or Point and returns it."""
    message.x, message.y, message.z = (float(value) for value in values)
    return message
