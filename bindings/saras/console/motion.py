"""Intended motions of a simulated hand, as offsets from the home pose.

Offsets are in the handle's frame at home: +z along the shaft towards the pivot (deeper), x and y across. Every scripted
block starts and ends at rest at home, so blocks follow each other without a step.
"""

from __future__ import annotations

import math
import random
from bisect import bisect_right
from collections.abc import Callable
from typing import NamedTuple, Protocol

Offset = tuple[float, float, float]


class Intent(NamedTuple):
    """What the hand wants at one time."""

    offset: Offset  #: [m]
    velocity: Offset  #: [m/s]
    roll: float = 0.0  #: [rad]
    grip: float = 1.0  #: 0 closed to 1 open
    clutch: bool = False


class Motion(Protocol):
    """An intended motion over time."""

    def at(self, t: float) -> Intent:
        """The intent t seconds after the start, t >= 0."""


REST = Intent((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


class Block(NamedTuple):
    """A stretch of a script: at rest at home at both ends."""

    duration: float  #: [s]
    at: Callable[[float], Intent]  #: time since the block's start [s]


class Script:
    """Blocks one after the other, from the first again after the last."""

    def __init__(self, blocks: list[Block]) -> None:
        self._blocks = blocks
        self._starts = [0.0]
        for block in blocks:
            self._starts.append(self._starts[-1] + block.duration)

    def at(self, t: float) -> Intent:
        """The intent at t [s]."""
        t %= self._starts[-1]
        i = min(bisect_right(self._starts, t) - 1, len(self._blocks) - 1)
        return self._blocks[i].at(t - self._starts[i])


def minimum_jerk(s: float) -> tuple[float, float]:
    """Position and slope of the minimum-jerk profile from 0 to 1 over s in [0, 1]."""
    return s * s * s * (10.0 + s * (6.0 * s - 15.0)), 30.0 * s * s * (1.0 - s) ** 2


def _pause(duration: float, clutch: bool = False) -> Block:
    rest = REST._replace(clutch=clutch)
    return Block(duration, lambda t: rest)


def _circle(rng: random.Random, radius: float) -> Block:
    """A circle across the shaft, with slow depth; wound up and down by a minimum-jerk envelope."""
    duration, ramp = 12.0, 2.0
    omega = 2.0 * math.pi * rng.uniform(0.2, 0.3) * rng.choice((-1, 1))
    phase, depth = rng.uniform(0, 2 * math.pi), 0.4 * radius

    def at(t: float) -> Intent:
        s = min(t, duration - t, ramp) / ramp
        w, slope = minimum_jerk(s)
        dw = 0.0 if s >= 1.0 else slope / ramp * (1.0 if t < ramp else -1.0)
        c, n, c2, n2 = math.cos(omega * t + phase), math.sin(omega * t + phase), math.cos(0.5 * t), math.sin(0.5 * t)
        offset = (w * radius * c, w * radius * n, w * depth * n2)
        velocity = (
            dw * radius * c - w * radius * omega * n,
            dw * radius * n + w * radius * omega * c,
            dw * depth * n2 + w * depth * 0.5 * c2,
        )
        return Intent(offset, velocity, roll=0.6 * w * n2)

    return Block(duration, at)


def _stroke(start: Offset, end: Offset, duration: float) -> Callable[[float], Intent]:
    """Straight, minimum jerk."""
    d = (end[0] - start[0], end[1] - start[1], end[2] - start[2])

    def at(t: float) -> Intent:
        p, slope = minimum_jerk(min(1.0, max(0.0, t / duration)))
        v = slope / duration
        return Intent((start[0] + p * d[0], start[1] + p * d[1], start[2] + p * d[2]), (v * d[0], v * d[1], v * d[2]))

    return at


def _through(points: list[Offset], stroke_s: float, pause_s: float) -> list[Block]:
    """Strokes from home through the points and back, with a pause at each."""
    blocks, here = [], REST.offset
    for point in [*points, REST.offset]:
        blocks.append(Block(stroke_s + pause_s, _stroke(here, point, stroke_s)))
        here = point
    return blocks


def _reach(rng: random.Random, amplitude: float) -> list[Block]:
    points = [
        (rng.uniform(-1, 1) * amplitude, rng.uniform(-1, 1) * amplitude, rng.uniform(-0.7, 0.7) * amplitude)
        for _ in range(5)
    ]
    return _through(points, 1.5, 0.4)


def _palpate(rng: random.Random, amplitude: float) -> list[Block]:
    points: list[Offset] = []
    for _ in range(4):
        x, y = rng.uniform(-0.5, 0.5) * amplitude, rng.uniform(-0.5, 0.5) * amplitude
        points += [(x, y, 0.0), (x, y, amplitude), (x, y, 0.0)]
    return _through(points, 1.0, 0.2)


def _clip_and_clutch() -> list[Block]:
    """Closes and opens the clip, turns the handle, presses the clutch for a second."""

    def close(t: float) -> Intent:
        return REST._replace(grip=1.0 - minimum_jerk(min(t, 4.0 - t, 1.0))[0])

    def turn(t: float) -> Intent:
        return REST._replace(roll=0.8 * math.sin(math.pi * t / 2.0) * minimum_jerk(min(t, 4.0 - t, 1.0))[0])

    return [Block(4.0, close), Block(4.0, turn), _pause(1.0, clutch=True), _pause(0.5)]


def _mixed(rng: random.Random, amplitude: float) -> list[Block]:
    return [
        _circle(rng, 0.7 * amplitude),
        *_palpate(rng, amplitude),
        *_clip_and_clutch(),
        *_reach(rng, amplitude),
    ]


MOTIONS: dict[str, Callable[[random.Random, float], list[Block]]] = {
    "rest": lambda rng, amplitude: [_pause(1.0)],
    "circle": lambda rng, amplitude: [_circle(rng, amplitude)],
    "reach": _reach,
    "palpate": _palpate,
    "clip": lambda rng, amplitude: _clip_and_clutch(),
    "mixed": _mixed,
}


def scripted(name: str, seed: int, side: str, amplitude_m: float) -> Script:
    """A motion of ``MOTIONS``, drawn anew for each seed and side. It starts with 1 s of rest."""
    return Script([_pause(1.0), *MOTIONS[name](random.Random(f"{seed}/{side}/{name}"), amplitude_m)])
