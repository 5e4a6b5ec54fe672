"""Device ``script``: a simulated hand that follows a scripted motion."""

from __future__ import annotations

from collections.abc import Mapping

from saras.console import options as option
from saras.console.devices.simulated import COMMON_OPTIONS, SimulatedHandle
from saras.console.motion import MOTIONS, scripted


def make(side: str, options: Mapping[str, str]) -> SimulatedHandle:
    """Options: motion (see ``saras.console.motion.MOTIONS``), amplitude_m, and those of every simulated handle."""
    option.refuse_unknown(options, (*COMMON_OPTIONS, "motion", "amplitude_m"), "script")
    name = option.choice(options, "motion", "mixed", MOTIONS)
    amplitude = option.number(options, "amplitude_m", 0.03, 0.0, 0.05)
    seed = option.integer(options, "seed", 1, 0, 2**62)
    return SimulatedHandle(scripted(name, seed, side, amplitude), side, options)
