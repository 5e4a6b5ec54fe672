"""Intended motions of an operator: displacement from the start and roll of the handle, over time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class Motion(Protocol):
    """What an operator intends, in the console frame, zero at t = 0."""

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Displacement (n, 3) [m] and roll (n,) [rad] at the times t (n,) [s]."""
        ...


def smooth_step(t: Array, begin: float, duration: float) -> Array:
    """0 before begin, 1 after begin + duration, with zero velocity and acceleration at both ends (minimum jerk)."""
    u = np.clip((t - begin) / duration, 0.0, 1.0)
    return np.asarray(u**3 * (10.0 - 15.0 * u + 6.0 * u**2))


@dataclass(frozen=True)
class Still:
    """The operator holds the handle where it is."""

    def sample(self, t: Array) -> tuple[Array, Array]:
        """No displacement."""
        return np.zeros((len(t), 3)), np.zeros(len(t))


@dataclass(frozen=True)
class SumOfSines:
    """Free motion: a few sines an axis, faded in over ``fade_s``.

    amplitudes_m, frequencies_hz: (k, 3), sine by axis. seed draws the phases. roll_rad swings at roll_hz.
    """

    amplitudes_m: tuple[tuple[float, float, float], ...] = ((0.02, 0.02, 0.01), (0.006, 0.006, 0.004))
    frequencies_hz: tuple[tuple[float, float, float], ...] = ((0.2, 0.27, 0.23), (0.7, 0.6, 0.53))
    seed: int = 1
    roll_rad: float = 0.2
    roll_hz: float = 0.15
    fade_s: float = 1.0

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Sum of the sines, faded in."""
        amplitudes = np.array(self.amplitudes_m)
        frequencies = np.array(self.frequencies_hz)
        phases = np.random.default_rng(self.seed).uniform(0.0, 2.0 * np.pi, amplitudes.shape)
        angles = 2.0 * np.pi * frequencies * t[:, None, None] + phases
        fade = smooth_step(t, 0.0, self.fade_s)
        displacement = fade[:, None] * (amplitudes * np.sin(angles)).sum(axis=1)
        return displacement, fade * self.roll_rad * np.sin(2.0 * np.pi * self.roll_hz * t)


@dataclass(frozen=True)
class Palpate:
    """Reach down, then press and release at a few points in a row.

    Each press: ``reach_m`` above the deepest point, down in ``press_s``, ``hold_s`` there, up, ``step_m`` (3,) on.
    """

    approach_m: tuple[float, float, float] = (0.0, 0.0, -0.02)
    press_m: float = 0.02
    step_m: tuple[float, float, float] = (0.01, 0.0, 0.0)
    presses: int = 5
    reach_s: float = 1.5
    press_s: float = 1.0
    hold_s: float = 0.5

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Minimum-jerk segments."""
        displacement = smooth_step(t, 0.0, self.reach_s)[:, None] * np.array(self.approach_m)
        begin = self.reach_s
        for _ in range(self.presses):
            down = smooth_step(t, begin, self.press_s)
            up = smooth_step(t, begin + self.press_s + self.hold_s, self.press_s)
            displacement[:, 2] -= self.press_m * (down - up)
            begin += 2.0 * self.press_s + self.hold_s
            displacement += smooth_step(t, begin, self.hold_s)[:, None] * np.array(self.step_m)
            begin += self.hold_s
        return displacement, np.zeros(len(t))


@dataclass(frozen=True)
class PressAndHold:
    """Reach by ``reach_m`` (3,) within ``reach_s`` after ``begin_s``, and stay."""

    reach_m: tuple[float, float, float] = (0.0, 0.0, -0.04)
    begin_s: float = 0.5
    reach_s: float = 1.0

    def sample(self, t: Array) -> tuple[Array, Array]:
        """One minimum-jerk reach."""
        return smooth_step(t, self.begin_s, self.reach_s)[:, None] * np.array(self.reach_m), np.zeros(len(t))


@dataclass(frozen=True)
class Recorded:
    """A recorded motion, linear between its samples, relative to its first one, ended by holding the last.

    time_s (n,), position_m (n, 3), roll_rad (n,) or None.
    """

    time_s: Array
    position_m: Array
    roll_rad: Array | None = field(default=None)

    def __post_init__(self) -> None:
        """Refuse what is no motion."""
        n = len(self.time_s)
        if n < 2 or np.shape(self.position_m) != (n, 3) or not np.all(np.diff(self.time_s) > 0.0):
            raise ValueError(
                f"recorded motion: time_s must increase and position_m be ({n}, 3), got {np.shape(self.position_m)}"
            )
        if not np.all(np.isfinite(self.position_m)):
            raise ValueError("recorded motion: position_m is not finite")

    def sample(self, t: Array) -> tuple[Array, Array]:
        """Interpolated."""
        since = self.time_s - self.time_s[0]
        position = self.position_m - self.position_m[0]
        displacement = np.stack([np.interp(t, since, position[:, axis]) for axis in range(3)], axis=1)
        if self.roll_rad is None:
            return displacement, np.zeros(len(t))
        return displacement, np.interp(t, since, self.roll_rad - self.roll_rad[0])
