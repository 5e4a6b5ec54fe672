"""A recorded surgeon: joints over time of one da Vinci arm, from a bag of a real or simulated dVRK."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from saras import Error
from saras.recording.bag import Bag, Topic
from saras.recording.series import rotation_matrices

Array = npt.NDArray[np.float64]

JOINTS = ("/{}/measured_js", "/dvrk/{}/state_joint_current")
POSES = (
    "/{}/local/measured_cp",
    "/dvrk/{}/position_cartesian_local_current",
    "/{}/measured_cp",
    "/dvrk/{}/position_cartesian_current",
)


class Playback:
    """(n,) joints at any time from the recording's start; it begins anew at its end.

    Joint topics are taken first, else poses through the inverse; poses that carry a base frame are taken as if they
    did not. Either naming. Raises saras.Error naming the bag and what it lacks.
    """

    def __init__(self, bag: Bag, arm: str, kinematics: Any) -> None:
        count = len(kinematics.limits)
        self.topic = ""
        self.t: Array = np.zeros(0)
        for pattern in (*JOINTS, *POSES):
            topic = bag.topic(pattern.format(arm))
            if topic is not None:
                read = _joints if pattern in JOINTS else _from_poses
                self.topic, (self.t, self.q) = topic.name, read(topic, kinematics, count)
                break
        if len(self.t) < 2:
            raise Error(
                f"{bag.path}: no motion of {arm}: none of {', '.join(p.format(arm) for p in (*JOINTS, *POSES))}"
            )
        self.t = self.t - self.t[0]

    def joints(self, t: float) -> Array:
        """(n,) at t [s], between the recorded ones by straight lines."""
        t = t % float(self.t[-1])
        return np.array([np.interp(t, self.t, column) for column in self.q.T])


def _joints(topic: Topic, kinematics: Any, count: int) -> tuple[Array, Array]:
    positions = np.asarray(topic["position"], dtype=float)
    if positions.ndim != 2 or positions.shape[1] < count:
        raise Error(f"{topic.name}: position has shape {positions.shape}: must be (n, {count})")
    return _increasing(topic.t, np.clip(positions[:, :count], *np.asarray(kinematics.limits).T))


def _from_poses(topic: Topic, kinematics: Any, count: int) -> tuple[Array, Array]:
    if "pose.position.x" in topic.columns:
        where, turn = "pose.position", "pose.orientation"
    else:  # CRTK before 2022
        where, turn = "transform.translation", "transform.rotation"
    points = np.column_stack([topic[f"{where}.{axis}"] for axis in "xyz"])
    poses = np.tile(np.eye(4), (len(points), 1, 1))
    poses[:, :3, :3] = rotation_matrices(*(topic[f"{turn}.{axis}"] for axis in "xyzw"))
    poses[:, :3, 3] = points
    rows, times = [], []
    near = np.asarray(kinematics.limits).mean(axis=1)
    for t, pose in zip(topic.t, poses):
        try:
            near = kinematics.inverse(pose, near, *((np.pi,) if count == 4 else ()))
        except Error:
            continue  # outside the limits of this body or tool: the motion goes on without it
        rows.append(near)
        times.append(t)
    if not rows:
        raise Error(
            f"{topic.name}: none of {len(points)} poses is in reach of the arm: another base frame, body or tool?"
        )
    return _increasing(np.array(times), np.array(rows))


def _increasing(t: Array, q: Array) -> tuple[Array, Array]:
    keep = np.concatenate([[True], np.diff(np.maximum.accumulate(t)) > 0.0]) & np.isfinite(q).all(axis=1)
    return t[keep], q[keep]


__all__ = ["Playback"]
