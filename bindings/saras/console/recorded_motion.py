"""A recorded 6-DoF hand motion, made fit for a handle.

Rows ``t [s], x, y, z [m], qx, qy, qz, qw`` (Hamilton, scalar last), plain or as a member of a zip file. In this order:
repeated poses are dropped (a tracker that lost a frame repeats the last one), the track is resampled at ``rate_hz``,
slow drift is removed (zero-phase first-order high-pass at ``highpass_hz``) and jitter too (low-pass at ``lowpass_hz``),
both ends fade to rest, and the whole is scaled to ``amplitude_m`` and, if that is still too fast, to ``speed_m_s``.
"""

from __future__ import annotations

import math
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from saras import ConfigError
from saras.console.arrays import Array
from saras.console.motion import Intent, Offset

COLUMNS = 8
LARGEST_FILE = 200_000_000  #: bytes


@dataclass
class RecordedMotionConfig:
    """How a track is made fit for a handle."""

    rate_hz: float = 100.0  #: of the resampled track; between its points the motion is a cubic
    highpass_hz: float = 0.3  #: below it is drift (walking about)
    lowpass_hz: float = 4.0  #: above it is tracker noise
    fade_s: float = 2.0  #: from rest to motion, and back before it repeats
    amplitude_m: float = 0.03  #: 99th percentile of the distance from home
    speed_m_s: float = 0.25  #: largest speed
    roll_rad: float = 1.0  #: largest turn about the shaft


def load_rows(path: Path, member: str | None = None, nth: int | None = None) -> Array:
    """(n, 8) rows of a CSV file or of a member of a zip file.

    member: any part of its name; when it is left out, the only member, or of several the nth one (in order of names).

    Raises ConfigError naming file and line for anything that is not a track: wrong columns, not finite, time running
    backwards, quaternions that are not unit.
    """
    name, data = _read(path, member, nth)
    rows: list[list[float]] = []
    for number, line in enumerate(data.decode("utf-8", errors="replace").splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            row = [float(text) for text in line.split(",")]
        except ValueError:
            raise ConfigError(f"{name}, line {number}: {line[:60]!r} is not a row of numbers") from None
        if len(row) != COLUMNS or not all(map(math.isfinite, row)):
            raise ConfigError(f"{name}, line {number}: must be 8 finite numbers t, x, y, z, qx, qy, qz, qw")
        if rows and row[0] < rows[-1][0]:
            raise ConfigError(f"{name}, line {number}: time {row[0]} runs backwards")
        if abs(math.hypot(*row[4:]) - 1.0) > 1e-3:
            raise ConfigError(f"{name}, line {number}: quaternion norm {math.hypot(*row[4:]):.4f}, must be 1")
        rows.append(row)
    if len(rows) < 10:
        raise ConfigError(f"{name}: {len(rows)} rows, a motion needs at least 10")
    return np.array(rows)


def _read(path: Path, member: str | None, nth: int | None) -> tuple[str, bytes]:
    if not path.is_file():
        raise ConfigError(f"file = {path}: no such file")
    if not zipfile.is_zipfile(path):
        if member:
            raise ConfigError(f"member = {member!r}: {path} is not a zip file")
        if path.stat().st_size > LARGEST_FILE:
            raise ConfigError(f"file = {path}: larger than {LARGEST_FILE} bytes")
        return str(path), path.read_bytes()
    with zipfile.ZipFile(path) as archive:
        names = [info.filename for info in archive.infolist() if not info.is_dir() and info.file_size <= LARGEST_FILE]
        found = sorted(name for name in names if member is None or member in name)
        if member is None and nth is not None and len(found) > nth:
            found = [found[nth]]
        if len(found) != 1:
            raise ConfigError(f"member = {member!r}: {len(found)} of the files in {path} match: {', '.join(names)}")
        return f"{path}:{found[0]}", archive.read(found[0])


def drop_repeats(rows: Array) -> Array:
    """Rows whose pose or time differs from the row before."""
    moved = np.any(np.diff(rows[:, 1:], axis=0) != 0.0, axis=1) & (np.diff(rows[:, 0]) > 0.0)
    kept: Array = rows[np.concatenate([[True], moved])]
    return kept


class RecordedMotion:
    """The track as an intended motion; repeats after its end."""

    def __init__(self, rows: Array, config: RecordedMotionConfig | None = None) -> None:
        c = config or RecordedMotionConfig()
        rows = drop_repeats(rows)
        times = np.arange(rows[0, 0], rows[-1, 0], 1.0 / c.rate_hz)
        if len(times) < 4 * c.fade_s * c.rate_hz:
            raise ConfigError(f"the motion lasts {rows[-1, 0] - rows[0, 0]:.2f} s: must be at least {4 * c.fade_s:g} s")
        # Turn about the rig's own z axis (swing-twist), unwrapped.
        roll = np.unwrap(2.0 * np.arctan2(rows[:, 6], rows[:, 7]))
        track = np.column_stack([*(np.interp(times, rows[:, 0], rows[:, k]) for k in (1, 2, 3))])
        turn = np.interp(times, rows[:, 0], roll)
        both = np.column_stack([track, turn])
        both -= _lowpass(both, c.highpass_hz, c.rate_hz)
        both = _lowpass(both, c.lowpass_hz, c.rate_hz)
        both *= _fade(len(times), int(c.fade_s * c.rate_hz))[:, None]
        reach = float(np.percentile(np.linalg.norm(both[:, :3], axis=1), 99.0))
        speed = float(np.linalg.norm(np.gradient(both[:, :3], 1.0 / c.rate_hz, axis=0), axis=1).max())
        if reach < 1e-6:
            raise ConfigError("the motion stands still after its drift was removed")
        self.scale = min(c.amplitude_m / reach, c.speed_m_s / speed)
        both[:, :3] *= self.scale
        both[:, 3] *= min(1.0, c.roll_rad / max(1e-9, float(np.abs(both[:, 3]).max())))
        self.points = both
        self.rate_hz = c.rate_hz
        self.duration_s = (len(both) - 1) / c.rate_hz
        # Plain lists: the control thread indexes them much faster than arrays.
        self._points = both.tolist()
        self._slopes = np.gradient(both, 1.0 / c.rate_hz, axis=0).tolist()

    def at(self, t: float) -> Intent:
        """Cubic Hermite between the points."""
        i, s = divmod((t % self.duration_s) * self.rate_hz, 1.0)
        k = min(int(i), len(self._points) - 2)
        h = 1.0 / self.rate_hz
        p, q, m, n = self._points[k], self._points[k + 1], self._slopes[k], self._slopes[k + 1]
        b, a01 = (s - 1.0) ** 2, s * s * (3.0 - 2.0 * s)
        a10, a11 = h * s * b, h * s * s * (s - 1.0)
        d01, d10, d11 = 6.0 * s * (1.0 - s) / h, b + 2.0 * s * (s - 1.0), s * (3.0 * s - 2.0)
        x = [p[j] + a01 * (q[j] - p[j]) + a10 * m[j] + a11 * n[j] for j in range(4)]
        v = [d01 * (q[j] - p[j]) + d10 * m[j] + d11 * n[j] for j in range(3)]
        offset: Offset = (x[0], x[1], x[2])
        velocity: Offset = (v[0], v[1], v[2])
        return Intent(offset, velocity, roll=x[3])


def _lowpass(values: Array, cutoff_hz: float, rate_hz: float) -> Array:
    """First-order low-pass forward and backward: zero phase."""
    gain = 1.0 - math.exp(-2.0 * math.pi * cutoff_hz / rate_hz)
    for _ in range(2):
        out, state = np.empty_like(values), values[0].copy()
        for i, value in enumerate(values):
            state += gain * (value - state)
            out[i] = state
        values = out[::-1]
    return values


def _fade(count: int, edge: int) -> Array:
    window = np.ones(count)
    window[:edge] = 0.5 - 0.5 * np.cos(np.pi * np.arange(edge) / edge)
    window[-edge:] = window[:edge][::-1]
    return window
