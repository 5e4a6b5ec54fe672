"""Device ``recorded``: a simulated hand that follows a recorded 6-DoF motion."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from saras import ConfigError
from saras.console import options as option
from saras.console.devices.simulated import COMMON_OPTIONS, SimulatedHandle
from saras.console.recorded_motion import RecordedMotion, RecordedMotionConfig, load_rows

LIMITS = {
    "highpass_hz": (0.001, 2.0),
    "lowpass_hz": (0.5, 20.0),
    "fade_s": (0.1, 10.0),
    "amplitude_m": (0.001, 0.05),
    "speed_m_s": (0.01, 1.0),
    "roll_rad": (0.0, 3.0),
}


def make(side: str, options: Mapping[str, str]) -> SimulatedHandle:
    """Options: file (CSV or zip), member (part of a name in the zip), the fields of RecordedMotionConfig, and those of
    every simulated handle.
    """
    option.refuse_unknown(options, (*COMMON_OPTIONS, "file", "member", *LIMITS), "recorded")
    if "file" not in options:
        raise ConfigError("device recorded needs a motion file: --file MOTION.csv (or .zip with --member NAME)")
    config = RecordedMotionConfig()
    for name, (lowest, highest) in LIMITS.items():
        setattr(config, name, option.number(options, name, getattr(config, name), lowest, highest))
    # Of a zip with several tracks the left hand takes the first, the right hand the second.
    rows = load_rows(Path(options["file"]).expanduser(), options.get("member"), ("left", "right").index(side))
    return SimulatedHandle(RecordedMotion(rows, config), side, options)
