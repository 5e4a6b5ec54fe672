"""Virtual fixtures of ordinary teleoperation as nodes see them: from the file, where they are, whether they are on."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import Point, Vector3
from std_msgs.msg import Bool

from saras import ConfigError
from saras.csa import FixtureForce, FixtureForceConfig, FixtureForceOutput, FixtureWord, TeleopFixture
from saras.csa.fixtures_file import FixturesFile, load
from saras_ros1.channel import base_frame
from saras_ros1.msg import SideFault, SideFixtures
from saras_ros1.node import Node
from saras_ros1.stamped import time_of
from saras_ros1.static_frames import StaticFrames

FILE_PARAMETER = "/saras/fixtures_file"
CHECK_S = 0.1  #: how often it is seen whether frames are where they were
SAME = 1e-6  #: [m, and of a rotation matrix]
PUBLISH_EVERY = 4


def read_file() -> FixturesFile | None:
    """The launch's `fixtures`; None: no file. Raises ConfigError naming place, value and bound."""
    path = rospy.get_param(FILE_PARAMETER, "")
    if not path:
        return None
    if not Path(path).is_absolute():  # roslaunch starts nodes in a directory of its own
        raise ConfigError(f"{FILE_PARAMETER} = {path!r}: must be an absolute path, or empty")
    try:
        return load(path)
    except OSError as error:
        raise ConfigError(f"{FILE_PARAMETER}: {error}") from None


class Fixtures:
    """Those of some sides, each in its arm's base. Waits at the start for the frames, which must be static.

    A frame that is unknown later, or elsewhere, makes its side's fixtures unknown until it is back. guards: of the node
    that moves the set-point; it has the supervisor hold a side with a wall that nobody knows where it is.
    /fixtures/enable (std_msgs/Bool) switches all off and on; they begin on.
    """

    def __init__(self, node: Node, sides: tuple[str, ...], *, guards: bool = False) -> None:
        self.file = read_file()
        self.force = FixtureForceConfig() if self.file is None else self.file.force
        self.lists: dict[str, list[TeleopFixture]] = {side: [] for side in sides}
        self.names: dict[str, list[str]] = {side: [] for side in sides}
        self.reasons = dict.fromkeys(sides, "")
        self._switch = None
        if self.file is None:
            return
        self._frames = StaticFrames()
        self._wait(node)
        self._places = {
            (side, frame): self._frames.lookup(base_frame(side), frame)
            for side in sides
            for frame in self.file.frames(side)
        }
        for side in sides:
            self.lists[side] = self.file.build(side, lambda frame, side=side: self._places[side, frame])
            self.names[side] = [entry.name for entry in self.file.of(side)]
        self._switch = node.input("/fixtures/enable", Bool, lambda message: bool(message.data))
        self._name = node.name.lstrip("/")
        self._faults = node.output("/system/faults", SideFault) if guards else None
        node.every(CHECK_S, self.check)

    @property
    def on(self) -> bool:
        """Whether they are switched on."""
        return self._switch is None or self._switch.value is None or self._switch.value

    def word(self, side: str) -> FixtureWord:
        """What holds now."""
        return FixtureWord(on=self.on, known=not self.reasons[side])

    def check(self) -> None:
        """Notes which frames are no longer where the fixtures were built."""
        found = dict.fromkeys(self.reasons, "")
        for (side, frame), then in self._places.items():
            try:
                moved = not np.abs(self._frames.lookup(base_frame(side), frame) - then).max() <= SAME
            except (tf2_ros.TransformException, ValueError) as error:
                found[side] = f"no transform {frame} to {base_frame(side)}: {error}"
            else:
                if moved:
                    found[side] = f"{frame} has moved since the start: start this node anew"
        for side, reason in found.items():
            if reason and not self.reasons[side]:
                rospy.logerr(f"fixtures of the {side} side: unknown from now on: {reason}")
        self.reasons = found
        for side in found:
            self._hold(side)

    def _hold(self, side: str) -> None:
        walls = any(not each.fixture.soft for each in self.lists[side])
        if self._faults is None or not self.reasons[side] or not self.on or not walls:
            return
        reason = f"virtual walls are unknown: {self.reasons[side]}"
        advice = "calibrate the frame again and start anew, or switch the fixtures off"
        fault = SideFault(side=side, source=self._name, reason=reason, advice=advice)
        fault.header.stamp = rospy.Time.now()
        self._faults.publish(fault)

    def _wait(self, node: Node) -> None:
        state, node.state = node.state, "WAITING"
        wanted = [(base_frame(side), frame) for side in self.lists for frame in sorted(self.file.frames(side))]
        while not rospy.is_shutdown():
            missing = [f"{base} ← {frame}" for base, frame in wanted if not self._frames.known(base, frame)]
            if not missing:
                break
            rospy.loginfo_throttle(5.0, f"fixtures wait for the static transforms {', '.join(missing)}")
            rospy.rostime.wallsleep(0.05)
        node.state = state

    def message(self, side: str, out: FixtureForceOutput, stamp_ns: int) -> SideFixtures:
        """For /fixtures/{side}."""
        names = self.names[side]
        message = SideFixtures(status=out.status.name, reason=self.reasons[side], on=self.on, names=names)
        message.header.stamp, message.header.frame_id = time_of(stamp_ns), base_frame(side)
        message.distance = list(out.distance_m[: len(names)])
        message.nearest = out.nearest
        known = out.nearest >= 0
        unknown = np.full(3, math.nan)
        message.closest = Point(*(out.closest if known else unknown))
        message.normal = Vector3(*(out.normal if known else unknown))
        message.violation = out.violation_m if known else math.nan
        message.force = Vector3(*out.wrench[:3])
        return message


class HandFixtures:
    """What one hand feels of them, and its topic."""

    def __init__(self, node: Node, fixtures: Fixtures, side: str) -> None:
        self.side, self._fixtures, self._count = side, fixtures, 0
        self.law: Any = None
        if fixtures.lists[side]:
            self.law = node.law(f"fixture_force_{side}", FixtureForce, fixtures.force, fixtures.lists[side])
            self._out = node.output(f"/fixtures/{side}", SideFixtures)

    def step(self, tip: np.ndarray | None, hand_ahead: np.ndarray, dt: float, stamp_ns: int) -> np.ndarray:
        """(6,) on the hand. tip: (4, 4) measured, None when it is not known; hand_ahead: (3,) [m]."""
        if self.law is None:
            return np.zeros(6)
        word = self._fixtures.word(self.side)
        out = self.law.step(
            base_T_tip=np.eye(4) if tip is None else tip,
            hand_ahead=hand_ahead,
            fixtures_on=word.on,
            fixtures_known=word.known and tip is not None,
            dt=dt,
        )
        self._count += 1
        if self._count % PUBLISH_EVERY == 0:
            self._out.publish(self._fixtures.message(self.side, out, stamp_ns))
        return out.wrench
