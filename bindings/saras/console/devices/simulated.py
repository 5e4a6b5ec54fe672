"""A handle held by a simulated hand: an intended motion, a hand around it, the Simball's encoders."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping

import numpy as np

from saras._core.console import SimulatedHandle as SimulatedHandleLaw
from saras._core.console import SimulatedHandleConfig
from saras.console import options as option
from saras.console.arrays import Array
from saras.console.device import HandleDevice, HandleReading
from saras.console.motion import REST, Intent, Motion
from saras.sim import OperatorConfig

OPERATORS: dict[str, Callable[[], OperatorConfig]] = {
    "firm": OperatorConfig.firm,
    "normal": OperatorConfig.normal,
    "weak": OperatorConfig.weak,
    "active": OperatorConfig.active,
}
#: Options that every simulated handle knows.
COMMON_OPTIONS = ("operator", "seed", "encoder_offset", "workspace_m")


class SimulatedHandle(HandleDevice):
    """Force moves the hand: the handle is where the Operator law says, not where the motion wants it.

    ``encoder_offset`` (0 to 1) shifts the raw joints by seeded amounts of up to that share of 0.2 rad and 10 mm, and
    the clip's range likewise: a device that was not calibrated.
    """

    simulated = True

    def __init__(self, motion: Motion, side: str, options: Mapping[str, str]) -> None:
        hand = OPERATORS[option.choice(options, "operator", "normal", OPERATORS)]()
        workspace = option.number(options, "workspace_m", 0.055, 0.01, 0.055)
        self._law = SimulatedHandleLaw(SimulatedHandleConfig(hand=hand, workspace_radius_m=workspace))
        self._motion = motion
        self._wrench: Array | None = None
        self._started_ns: int | None = None
        self._last_ns = 0
        self._joints: Array | None = None
        self._work_J = 0.0
        self._cue = "run"
        amount = option.number(options, "encoder_offset", 0.0, 0.0, 1.0)
        rng = random.Random(f"{option.integer(options, 'seed', 1, 0, 2**62)}/{side}/encoders")
        self.needs_calibration = amount > 0.0
        self._joint_offset = amount * np.array([*(rng.uniform(-0.2, 0.2) for _ in range(3)), rng.uniform(-0.01, 0.01)])
        self._clip_closed = amount * rng.uniform(0.05, 0.2)
        self._clip_span = 1.0 - amount * rng.uniform(0.05, 0.2) - self._clip_closed

    def intent(self, t: float) -> Intent:
        """What the hand wants t seconds after the start; while calibrating, what it was asked for."""
        if self._cue == "run":
            return self._motion.at(t)
        roll = 0.5 * math.sin(3.0 * t) if self._cue == "roll" else 0.0
        return REST._replace(roll=roll, grip=0.0 if self._cue == "closed" else 1.0)

    def cue(self, instruction: str) -> None:
        """The simulated hand does as it is asked."""
        self._cue = instruction

    def read(self, now_ns: int) -> HandleReading | None:
        """Moves the hand up to now and reads the encoders."""
        if self._started_ns is None:
            self._started_ns, self._last_ns = now_ns, now_ns - 1_000_000
        offset, velocity, roll, grip, clutch = self.intent((now_ns - self._started_ns) * 1e-9)
        if now_ns > self._last_ns:
            dt = (now_ns - self._last_ns) * 1e-9
            self._joints, self._work_J = self._law.step(offset, velocity, roll, self._wrench, dt)
            self._last_ns, self._wrench = now_ns, None
        if self._joints is None:
            return None
        return HandleReading(
            self._joints + self._joint_offset, self._clip_closed + self._clip_span * grip, clutch, self._work_J
        )

    def apply(self, wrench: Array, now_ns: int) -> None:
        """Sets the motors' force until the next reading, and no longer than the law's watchdog."""
        self._wrench = wrench

    def close(self) -> None:
        """Force to zero."""
        self._wrench = None
