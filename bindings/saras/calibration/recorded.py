"""Hand-eye calibration of recorded streams: two clocks, two rates. Finds the time offset too. Numpy only."""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import saras
from saras import CalibrationError, ConfigError
from saras.calibration.hand_eye import HandEye, HandEyeNoise, hand_eye

Array = npt.NDArray[np.float64]

#: Errors of poses nearer than this in time belong together [s].
GROUP_S = 2.0
#: Rounds of interpolation and solution; each makes the remaining offset about a hundred times smaller.
ROUNDS = 6
_RATE_HZ = 50.0
#: Angles are taken over so long a time: over one frame of a camera its noise would be all there is [s].
_BASELINE_S = 0.3


@dataclass(frozen=True)
class Stream:
    """Poses over time."""

    t_s: Array
    """(n,), increasing, on a clock of its own [s]"""
    poses: Array
    """(n, 4, 4)"""

    @staticmethod
    def from_rows(rows: npt.ArrayLike) -> Stream:
        """Of rows t, x, y, z, qx, qy, qz, qw [s, m] (Hamilton, scalar last). Raises ConfigError."""
        table = np.asarray(rows, dtype=float)
        if table.ndim != 2 or table.shape[1] != 8 or not np.isfinite(table).all() or len(table) < 3:
            raise ConfigError(f"rows: shape {table.shape}: must be (n, 8), n >= 3, all finite")
        order = np.argsort(table[:, 0], kind="stable")
        table = table[order]
        table = table[np.concatenate([[True], np.diff(table[:, 0]) > 0.0])]  # a stamp twice says nothing new
        norm = np.linalg.norm(table[:, 4:], axis=1)
        if (np.abs(norm - 1.0) > 1e-3).any():
            raise ConfigError(
                f"rows: quaternion norm = {norm[np.argmax(np.abs(norm - 1.0))]:.4f}: must be 1 within 1e-3"
            )
        return Stream(table[:, 0], _poses(table[:, 1:4], table[:, 4:] / norm[:, None]))

    @staticmethod
    def load(path: str | Path) -> Stream:
        """A text file of such rows, comma separated."""
        return Stream.from_rows(np.loadtxt(path, delimiter=","))

    @property
    def inverse(self) -> Stream:
        """The same motion seen from the other side: camera_T_target of target_T_camera."""
        return Stream(self.t_s, np.linalg.inv(self.poses))

    def thinned(self, spacing_s: float) -> Stream:
        """Poses at least spacing_s apart."""
        chosen, last = [], -np.inf
        for i, t in enumerate(self.t_s):
            if t - last >= spacing_s:
                chosen.append(i)
                last = t
        return Stream(self.t_s[chosen], self.poses[chosen])

    def between(self, start_s: float, end_s: float) -> Stream:
        """The part with start_s <= t < end_s."""
        chosen = (self.t_s >= start_s) & (self.t_s < end_s)
        return Stream(self.t_s[chosen], self.poses[chosen])


@dataclass(frozen=True)
class StreamHandEye:
    """Hand-eye and clocks."""

    result: HandEye
    time_offset_s: float
    """The robot's pose for a camera stamp t is that at t + time_offset_s on the robot's clock."""
    time_offset_std_s: float
    pairs: int


def hand_eye_of_streams(
    robot: Stream,
    camera: Stream,
    *,
    time_offset_s: float | None = None,
    max_offset_s: float = 10.0,
    noise: HandEyeNoise | None = None,
    max_gap_s: float = 0.1,
    spacing_s: float = 0.1,
    **options: Any,
) -> StreamHandEye:
    """Hand-eye with time offset from base_T_gripper over time and camera_T_target over time.

    time_offset_s: a start; None: from the correlation of angular speeds (within max_offset_s, after both streams are
    aligned at their beginnings). max_gap_s: camera poses in larger gaps of the robot's stream are left out. spacing_s:
    of the camera's poses that are used; nearer ones repeat each other's errors. The covariance comes from the spread
    between groups of GROUP_S. options: of hand_eye. Raises CalibrationError.
    """
    camera = camera.thinned(spacing_s)
    offset = correlate(robot, camera, max_offset_s) if time_offset_s is None else time_offset_s
    noise = noise or HandEyeNoise()
    result, t = None, camera.t_s
    for _ in range(ROUNDS):
        gripper, twist, inside = at_times(robot, t + offset, max_gap_s)
        if inside.sum() < 3:
            raise CalibrationError(
                f"streams overlap in {int(inside.sum())} poses: must be >= 3; offset = {offset:.3f} s"
            )
        groups = np.floor((t[inside] - t[0]) / GROUP_S).astype(int).tolist()
        result = hand_eye(
            gripper[inside],
            camera.poses[inside],
            gripper_twist=twist[inside],
            groups=groups,
            allow_repeats=True,
            noise=noise,
            **options,
        )
        offset += result.time_offset_s
        if abs(result.time_offset_s) < 1e-6:
            break
    assert result is not None
    return StreamHandEye(result, offset, result.time_offset_std_s, int(inside.sum()))


def at_times(stream: Stream, t_s: Array, max_gap_s: float) -> tuple[Array, Array, npt.NDArray[np.bool_]]:
    """Poses (n, 4, 4) by interpolation of the displacement, twists (n, 6), and which lie in the stream."""
    after = np.clip(np.searchsorted(stream.t_s, t_s), 1, len(stream.t_s) - 1)
    gap = stream.t_s[after] - stream.t_s[after - 1]
    inside = (t_s >= stream.t_s[0]) & (t_s <= stream.t_s[-1]) & (gap <= max_gap_s)
    poses, twists = np.tile(np.eye(4), (len(t_s), 1, 1)), np.zeros((len(t_s), 6))
    for i in np.flatnonzero(inside):
        before, then = stream.poses[after[i] - 1], stream.poses[after[i]]
        twists[i] = saras.displacement(before, then) / gap[i]
        poses[i] = saras.add_delta(before, twists[i], t_s[i] - stream.t_s[after[i] - 1])
    return poses, twists, inside


def correlate(robot: Stream, camera: Stream, max_offset_s: float) -> float:
    """Offset [s] that makes the angular speeds of both streams most alike: robot time = camera time + offset."""
    speeds = []
    for stream in (robot, camera):
        t = np.arange(stream.t_s[0], stream.t_s[-1] - _BASELINE_S, 1.0 / _RATE_HZ)
        first = np.clip(np.searchsorted(stream.t_s, t), 0, len(stream.t_s) - 1)
        then = np.clip(np.searchsorted(stream.t_s, t + _BASELINE_S), 0, len(stream.t_s) - 1)
        turn = np.swapaxes(stream.poses[first, :3, :3], 1, 2) @ stream.poses[then, :3, :3]
        cosine = 0.5 * (np.trace(turn, axis1=1, axis2=2) - 1.0)
        speed = np.arccos(np.clip(cosine, -1.0, 1.0)) / np.maximum(stream.t_s[then] - stream.t_s[first], 1e-3)
        speed = np.minimum(speed, 3.0 * np.quantile(speed, 0.95))  # jumps of a detector
        speeds.append(speed - speed.mean())
    score = np.correlate(speeds[0], speeds[1], mode="full")
    lags = np.arange(-len(speeds[1]) + 1, len(speeds[0])) / _RATE_HZ
    allowed = np.abs(lags) <= max_offset_s
    lag = float(lags[allowed][np.argmax(score[allowed])])
    return lag + float(robot.t_s[0] - camera.t_s[0])


def _poses(translations: Array, quaternions: Array) -> Array:
    x, y, z, w = quaternions.T
    poses = np.tile(np.eye(4), (len(x), 1, 1))
    poses[:, :3, :3] = np.moveaxis(
        np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        ),
        2,
        0,
    )
    poses[:, :3, 3] = translations
    return poses


def load_stream(path: str | Path) -> Stream:
    """Rows of a CSV file, or of one in a ZIP file named as archive.zip:member. Raises ConfigError, OSError."""
    archive, separator, member = str(path).rpartition(".zip:")
    if not separator:
        return Stream.load(path)
    with zipfile.ZipFile(archive + ".zip") as bundle:
        if member not in bundle.namelist():
            raise ConfigError(f"{archive}.zip: {member}: must be one of {', '.join(bundle.namelist())}")
        return Stream.from_rows(np.loadtxt(io.StringIO(bundle.read(member).decode()), delimiter=","))


def disjoint_parts(
    robot: Stream, camera: Stream, count: int, time_offset_s: float, interleaved: bool = False
) -> list[tuple[int, int, Array, Array]]:
    """Hand-eye of `count` disjoint parts of the camera's stream, each pair compared.

    Gives (i, j, displacement from i to j (6,), its standard deviation (6,) from both covariances). interleaved: pieces
    of GROUP_S dealt out in turn, so that all parts see the whole session; else one part after the other, which also
    shows what drifts or depends on the place, and no covariance of random errors knows that.
    """
    elapsed = (camera.t_s - camera.t_s[0]) / (camera.t_s[-1] - camera.t_s[0] + 1e-9)
    part = np.floor(elapsed * count).astype(int)
    if interleaved:
        part = np.floor((camera.t_s - camera.t_s[0]) / GROUP_S).astype(int) % count
    found = [
        hand_eye_of_streams(
            robot, Stream(camera.t_s[part == i], camera.poses[part == i]), time_offset_s=time_offset_s
        ).result
        for i in range(count)
    ]
    return [
        (
            i,
            j,
            np.asarray(saras.displacement(found[i].gripper_T_camera, found[j].gripper_T_camera)),
            np.sqrt(np.diag(found[i].covariance + found[j].covariance)),
        )
        for i in range(count)
        for j in range(i + 1, count)
    ]


__all__ = [
    "Stream",
    "StreamHandEye",
    "at_times",
    "correlate",
    "disjoint_parts",
    "hand_eye_of_streams",
    "load_stream",
]
