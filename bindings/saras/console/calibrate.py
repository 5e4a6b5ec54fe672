"""Guided calibration: the operator holds, turns, squeezes; the program measures and checks."""

from __future__ import annotations

import logging
import statistics
import time
from collections.abc import Callable, Mapping

import numpy as np

from saras import ConfigError
from saras.console.arrays import Array
from saras.console.calibration import JOINT_NAMES, HandleCalibration, zero_from_home
from saras.console.device import HandleDevice, HandleReading

log = logging.getLogger("saras.console")

STEPS = {
    "home": "hold the {side} handle upright in the middle of its range, clip forwards, and keep it still",
    "roll": "turn the {side} handle about its shaft to and fro",
    "open": "let the clip of the {side} handle go",
    "closed": "squeeze the clip of the {side} handle fully and keep it so",
}
STILL = np.array([0.01, 0.01, 0.02, 0.001])  #: largest standard deviation that counts as held still [rad], [m]
LEAST_TURN_RAD = 0.3

Ask = Callable[[str], None]  #: shows an instruction and returns when the operator is ready


class Sampler:
    """Reads all handles at a fixed rate, applying no force."""

    def __init__(self, devices: Mapping[str, HandleDevice], rate_hz: float = 200.0) -> None:
        self._devices, self._period_s = devices, 1.0 / rate_hz

    def take(self, seconds: float) -> dict[str, list[HandleReading]]:
        """Readings of every handle over a while. Raises ConfigError naming a handle that gives none."""
        taken: dict[str, list[HandleReading]] = {side: [] for side in self._devices}
        for _ in range(max(2, int(seconds / self._period_s))):
            now_ns = time.monotonic_ns()
            for side, device in self._devices.items():
                reading = device.read(now_ns)
                device.apply(np.zeros(6), now_ns)
                if reading is not None:
                    taken[side].append(reading)
            time.sleep(self._period_s)
        for side, readings in taken.items():
            if len(readings) < 2:
                raise ConfigError(f"{side}: the handle gives no readings; is it plugged in?")
            if not all(np.isfinite(reading.joints).all() for reading in readings):
                raise ConfigError(f"{side}: the handle's joints are not finite")
        return taken


def calibrate(
    devices: Mapping[str, HandleDevice], ask: Ask, seconds: float = 1.0, settle_s: float = 0.5
) -> dict[str, HandleCalibration]:
    """Calibrates every handle. Raises ConfigError saying what was wrong and what to do about it.

    seconds: how long each pose is measured; settle_s: how long to wait for it after the operator is ready.
    """
    sampler = Sampler(devices)
    results = {}
    for side, device in devices.items():
        taken: dict[str, dict[str, list[HandleReading]]] = {}
        for step, instruction in STEPS.items():
            device.cue(step)
            ask(instruction.format(side=side.upper()))
            sampler.take(settle_s)
            taken[step] = sampler.take(2.5 * seconds if step == "roll" else seconds)
        device.cue("run")
        home = np.array([reading.joints for reading in taken["home"][side]])
        _check_still(side, home)
        _check_turned(side, taken["roll"])
        clip_open = statistics.median(reading.clip for reading in taken["open"][side])
        clip_closed = statistics.median(reading.clip for reading in taken["closed"][side])
        result = HandleCalibration(zero_from_home(home.mean(axis=0)), clip_closed, clip_open)
        result.validate(side)
        log.info("%s: zero %s, clip %.4g to %.4g", side, np.round(result.joint_zero, 4), clip_closed, clip_open)
        results[side] = result
    return results


def _check_still(side: str, joints: Array) -> None:
    deviation = joints.std(axis=0)
    if (deviation > STILL).any():
        worst = int((deviation / STILL).argmax())
        raise ConfigError(
            f"{side}: {JOINT_NAMES[worst]} moved (standard deviation {deviation[worst]:.4f}, at most {STILL[worst]}) "
            "while it was to be kept still: rest the hand and repeat"
        )


def _check_turned(side: str, taken: Mapping[str, list[HandleReading]]) -> None:
    """The handle that was asked to turn must have turned, and no other more than it: else they are swapped."""
    turned = {name: float(np.ptp([reading.joints[2] for reading in readings])) for name, readings in taken.items()}
    most = max(turned, key=lambda name: turned[name])
    if turned[most] >= LEAST_TURN_RAD and most != side:
        raise ConfigError(f"{side}: the {most} handle turned ({turned[most]:.2f} rad): left and right are swapped")
    if turned[side] < LEAST_TURN_RAD:
        raise ConfigError(f"{side}: turned by {turned[side]:.2f} rad: range too small, at least {LEAST_TURN_RAD} rad")
