"""Typed views on topics: poses, twists and wrenches, joints."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras.recording.bag import Floats, Topic


@dataclass(frozen=True)
class PoseSeries:
    """Poses of one body over time."""

    t: Floats  #: (n,) stamp [s]
    t_received: Floats  #: (n,) reception by the recorder [s]
    frame: str  #: frame_id of the messages: pose is frame_T_body
    pose: Floats  #: (n, 4, 4)
    seq: NDArray[Any] | None = None

    @property
    def position(self) -> Floats:
        """(n, 3) origin of the body in ``frame`` [m]."""
        return self.pose[:, :3, 3]


@dataclass(frozen=True)
class VectorSeries:
    """Twists [m/s, rad/s] or wrenches [N, N m] over time, linear/force first."""

    t: Floats
    t_received: Floats
    frame: str
    value: Floats  #: (n, 6)
    seq: NDArray[Any] | None = None


@dataclass(frozen=True)
class JointSeries:
    """Joint states; all messages name the same joints."""

    t: Floats
    t_received: Floats
    names: list[str]
    position: Floats  #: (n, joints) [rad or m]
    velocity: Floats | None  #: (n, joints) [rad/s or m/s]; None when not sent


def rotation_matrices(x: Floats, y: Floats, z: Floats, w: Floats) -> Floats:
    """(n, 3, 3) of unit quaternions; NaN where the norm is off by more than 1e-3."""
    norm = np.sqrt(x * x + y * y + z * z + w * w)
    bad = ~(np.abs(norm - 1.0) < 1e-3)
    x, y, z, w = (np.where(bad, np.nan, c / np.where(bad, 1.0, norm)) for c in (x, y, z, w))
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def pose_series(topic: Topic | None) -> PoseSeries | None:
    """From PoseStamped (or any message with a ``pose``)."""
    if topic is None:
        return None
    pose = np.zeros((len(topic), 4, 4))
    pose[:, 3, 3] = 1.0
    pose[:, :3, :3] = rotation_matrices(*(topic[f"pose.orientation.{axis}"] for axis in "xyzw"))
    pose[:, :3, 3] = np.stack([topic[f"pose.position.{axis}"] for axis in "xyz"], axis=1)
    return PoseSeries(topic.t, topic.t_received, _frame(topic), pose, topic.seq)


def twist_series(topic: Topic | None) -> VectorSeries | None:
    """From TwistStamped, else from Twist."""
    return _vector_series(topic, "twist", "linear", "angular")


def wrench_series(topic: Topic | None) -> VectorSeries | None:
    """From WrenchStamped, else from Wrench."""
    return _vector_series(topic, "wrench", "force", "torque")


def joint_series(topic: Topic | None) -> JointSeries | None:
    """From JointState; messages that name other joints than the first one are left out."""
    if topic is None:
        return None
    names = [str(name) for name in topic["name"][0]]
    same = np.array([list(row) == names for row in topic["name"]])
    position = np.array([np.asarray(row, dtype=float) for row in topic["position"][same]])
    velocity = None
    if all(len(row) == len(names) for row in topic["velocity"][same]):
        velocity = np.array([np.asarray(row, dtype=float) for row in topic["velocity"][same]])
    return JointSeries(topic.t[same], topic.t_received[same], names, position, velocity)


def _vector_series(topic: Topic | None, stamped: str, first: str, second: str) -> VectorSeries | None:
    if topic is None:
        return None
    prefix = f"{stamped}." if f"{stamped}.{first}.x" in topic.columns else ""
    value = np.stack([topic[f"{prefix}{part}.{axis}"] for part in (first, second) for axis in "xyz"], axis=1)
    return VectorSeries(topic.t, topic.t_received, _frame(topic), value, topic.seq)


def _frame(topic: Topic) -> str:
    column = topic.columns.get("header.frame_id")
    return str(column[0]) if column is not None else ""
