"""A handle held by a simulated hand: an intended motion, a hand around it, the Simball's encoders."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping

import numpy as np

from saras.console import options as option
from saras.console.arrays import Array
from saras.console.device import HandleDevice, HandleReading
from saras.console.motion import REST, Intent, Motion
from saras.console.simball import HANDLE, SIMBALL_T_HOME, TOUCH_R_SIMBALL
from saras.sim import Operator, OperatorConfig, OperatorState

OPERATORS: dict[str, Callable[[], OperatorConfig]] = {
    "firm": OperatorConfig.firm,
    "normal": OperatorConfig.normal,
    "weak": OperatorConfig.weak,
    "active": OperatorConfig.active,
}
#: Options that every simulated handle knows.
COMMON_OPTIONS = ("operator", "seed", "encoder_offset", "workspace_m")

WATCHDOG_NS = 2_000_000  #: the motor falls back to zero when a wrench is not refreshed for so long
LONGEST_STALL_NS = 100_000_000  #: after a longer one (a suspended process) the hand has waited, too


class SimulatedHandle(HandleDevice):
    """Force moves the hand: the handle is where the Operator law says, not where the motion wants it.

    ``encoder_offset`` (0 to 1) shifts the raw joints by seeded amounts of up to that share of 0.2 rad and 10 mm, and
    the clip's range likewise: a device that was not calibrated.
    """

    simulated = True

    def __init__(self, motion: Motion, side: str, options: Mapping[str, str]) -> None:
        operator = OPERATORS[option.choice(options, "operator", "normal", OPERATORS)]()
        operator.workspace_centre_m = SIMBALL_T_HOME[:3, 3]
        operator.workspace_radius_m = option.number(options, "workspace_m", 0.055, 0.01, 0.055)
        self._motion = motion
        self._operator = Operator(operator)
        self._operator.reset(OperatorState(position=SIMBALL_T_HOME[:3, 3]))
        self._home_R_transposed = SIMBALL_T_HOME[:3, :3].T
        self._home_p = SIMBALL_T_HOME[:3, 3]
        self._position: Array = self._home_p.copy()
        self._roll = 0.0
        self._force = np.zeros(3)  # on the hand, simball frame
        self._no_force = np.zeros(3)
        self._refreshed_ns = 0
        self._started_ns: int | None = None
        self._last_ns = 0
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
            self._started_ns = self._last_ns = now_ns
        intent = self.intent((now_ns - self._started_ns) * 1e-9)
        if now_ns > self._last_ns:
            self._move(intent, now_ns)
        joints = HANDLE.inverse_position(self._position, self._roll)
        if joints is None:
            return None
        joints += self._joint_offset
        return HandleReading(joints, self._clip_closed + self._clip_span * intent.grip, intent.clutch, self._work_J)

    def _move(self, intent: Intent, now_ns: int) -> None:
        """Force until the motor's watchdog falls, then none."""
        from_ns = max(self._last_ns, now_ns - LONGEST_STALL_NS)
        force_off_ns = min(now_ns, self._refreshed_ns + WATCHDOG_NS)
        position, velocity = np.array((intent.offset, intent.velocity)) @ self._home_R_transposed
        position += self._home_p
        for until_ns, force in ((force_off_ns, self._force), (now_ns, self._no_force)):
            if until_ns <= from_ns:
                continue
            dt = (until_ns - from_ns) * 1e-9
            moved = self._operator.step(force, position, dt, intended_velocity=velocity, intended_roll=intent.roll)
            after = moved.position
            self._work_J += float(force @ (after - self._position))
            self._position, self._roll, from_ns = after, moved.roll, until_ns
        self._last_ns = now_ns

    def apply(self, wrench: Array, now_ns: int) -> None:
        """Sets the motors' force; there is no motor about the shaft."""
        self._force = wrench[:3] @ TOUCH_R_SIMBALL  # the transposed rotation: touch to simball
        self._refreshed_ns = now_ns

    def close(self) -> None:
        """Force to zero."""
        self._force = np.zeros(3)
