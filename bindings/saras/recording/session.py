"""One recorded session: arms, consoles, tanks, events by the platform's topic names."""

from __future__ import annotations

import json
from dataclasses import dataclass
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from saras.recording.bag import Bag, Floats, Topic
from saras.recording.collision import ToolDistances, tool_distances
from saras.recording.series import (
    JointSeries,
    PoseSeries,
    VectorSeries,
    joint_series,
    pose_series,
    twist_series,
    wrench_series,
)

CHANNEL_STATES = {0: "WAITING", 1: "READY", 2: "ENGAGED", 3: "HOLD"}


@dataclass(frozen=True)
class Event:
    """Something an operator would want to know the time of."""

    t: float  #: [s since session start]
    source: str
    severity: str  #: info, warning, error
    text: str


class Arm:
    """What was recorded of one SARAS arm (``mesa_left``, ``mesa_right``); None where nothing was."""

    def __init__(self, bag: Bag, name: str) -> None:
        self._bag = bag
        self.name = name

    @property
    def ee_pose(self) -> PoseSeries | None:
        """Measured tool tip in the arm's base frame."""
        return pose_series(self._bag.topic(f"/{self.name}/ee_pose"))

    @property
    def set_point(self) -> PoseSeries | None:
        """Commanded tool tip."""
        return pose_series(self._bag.topic(f"/{self.name}/set_point"))

    @property
    def joint_states(self) -> JointSeries | None:
        """Measured joints."""
        return joint_series(self._bag.topic(f"/{self.name}/joint_states"))

    @property
    def measured_cf(self) -> VectorSeries | None:
        """Wrench that the arm exerts on the tissue, as measured or estimated."""
        return wrench_series(self._bag.topic(f"/{self.name}/measured_cf"))

    @property
    def truth(self) -> Topic | None:
        """What the simulator alone knows (saras_ros1/ArmTruth)."""
        return self._bag.topic(f"/{self.name}/truth")


class Console:
    """What was recorded of one side's console and its frame mapping; None where nothing was."""

    def __init__(self, bag: Bag, side: str) -> None:
        self._bag = bag
        self.side = side

    @property
    def handle_pose(self) -> PoseSeries | None:
        """Handle in the console's own frame."""
        return pose_series(self._bag.topic(f"/touchball_{self.side}/pose"))

    @property
    def tracked_pose(self) -> PoseSeries | None:
        """Handle mapped into the arm's base frame (frozen under the clutch)."""
        return pose_series(self._bag.topic(f"/tf_transformer_{self.side}/tracked_pose"))

    @property
    def handle_twist(self) -> VectorSeries | None:
        """True twist of the handle in the arm's base frame. The demo's bags hold it in /laws/frame_mapping_* only."""
        return twist_series(self._bag.topic(f"/tf_transformer_{self.side}/handle_twist"))

    @property
    def wrench(self) -> VectorSeries | None:
        """Wrench sent to the hand, in the touch frame."""
        return wrench_series(self._bag.topic(f"/touchball_{self.side}/wrench"))

    @property
    def desired_wrench(self) -> VectorSeries | None:
        """Wrench on the hand that transparency asks for, in the arm's base frame."""
        return wrench_series(self._bag.topic(f"/transparency/{self.side}/desired_wrench"))

    @property
    def applied_wrench(self) -> VectorSeries | None:
        """Wrench on the hand that tank_master lets through, in the arm's base frame."""
        return wrench_series(self._bag.topic(f"/tank_master/{self.side}/wrench"))

    @property
    def desired_twist(self) -> VectorSeries | None:
        """Twist of the slave that transparency asks for."""
        return twist_series(self._bag.topic(f"/transparency/{self.side}/desired_twist"))

    @property
    def applied_twist(self) -> VectorSeries | None:
        """Twist of the slave that tank_slave lets through."""
        return twist_series(self._bag.topic(f"/tank_slave/{self.side}/twist"))

    @property
    def state(self) -> Topic | None:
        """saras_ros1/ChannelState of this side."""
        return self._bag.topic(f"/system/{self.side}/state")


class Session:
    """A recorded session. Use ``Session.open(path)``; topics are read when first asked for."""

    def __init__(self, bag: Bag) -> None:
        self._bag = bag
        self.path: Path = bag.path
        self.duration_s: float = bag.duration_s
        self.start_ns: int = bag.start_ns  #: unix time of the first message
        self.start = datetime.fromtimestamp(bag.start_ns * 1e-9, tz=timezone.utc)

    @classmethod
    def open(cls, path: str | Path) -> Session:
        """Opens a ROS 1 bag. Raises saras.Error when it is missing, foreign, truncated or empty."""
        return cls(Bag(path))

    def close(self) -> None:
        """Closes the file; what was read stays usable."""
        self._bag.close()

    def __enter__(self) -> Session:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def topics(self) -> dict[str, int]:
        """Number of messages of each recorded topic."""
        return dict(self._bag.counts)

    def topic(self, name: str) -> Topic | None:
        """Any topic as columns, or None when no message of it was recorded."""
        return self._bag.topic(name)

    def heads(self, name: str) -> tuple[Floats, Floats] | None:
        """(n,) stamps and receptions [s] of a topic of large messages (pictures); None when none was recorded."""
        return self._bag.heads(name)

    def arm(self, name: str) -> Arm:
        """``mesa_left`` or ``mesa_right``."""
        return Arm(self._bag, name)

    def console(self, side: str) -> Console:
        """``left`` or ``right``."""
        return Console(self._bag, side)

    def tank(self, name: str) -> Topic | None:
        """saras_ros1/TankState of ``tank_master``, ``tank_slave``, ``port_guard_left``, ``port_guard_right``."""
        return self._bag.topic(f"/{name}/state")

    @property
    def distances(self) -> list[ToolDistances]:
        """How near each tool was to the others and to the forbidden regions; empty when that was not recorded."""
        return tool_distances(self._bag.topic("/collision/state"))

    @property
    def info(self) -> dict[str, Any]:
        """Facts that the platform published about itself (``/saras/session``, JSON); empty when it did not."""
        topic = self._bag.topic("/saras/session")
        if topic is None:
            return {}
        try:
            facts = json.loads(str(topic["data"][-1]))
        except json.JSONDecodeError:
            return {}
        return facts if isinstance(facts, dict) else {}

    @property
    def events(self) -> list[Event]:
        """Changes of state and diagnostics, warnings and errors of the log, in order of time."""
        from saras.recording.events import collect

        return collect(self)
