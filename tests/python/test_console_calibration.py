"""Calibration: seeded encoder offsets are found; what cannot be right is refused and named."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from saras import ConfigError
from saras.console.calibrate import calibrate
from saras.console.calibration import HandleCalibration, load, save
from saras.console.device import HandleDevice, HandleReading, open_device
from saras.console.simball import HOME_JOINTS


def test_simulated_offsets_are_found_and_used():
    devices = {
        side: open_device("script", side, {"motion": "rest", "encoder_offset": "1", "seed": "5"})
        for side in ("left", "right")
    }
    results = calibrate(devices, lambda text: None, seconds=0.5)
    for side, device in devices.items():
        np.testing.assert_allclose(results[side].joint_zero, device._joint_offset, atol=2e-3)
        assert results[side].grip(device._clip_closed) == pytest.approx(0.0, abs=1e-6)
        assert results[side].grip(device._clip_closed + 0.5 * device._clip_span) == pytest.approx(0.5, abs=1e-6)
    assert results["left"] != results["right"]


class Puppet(HandleDevice):
    """Readings as a test wants them, by cue."""

    simulated = True

    def __init__(self, readings):
        self._readings, self._cue, self._n = readings, "home", 0

    def cue(self, instruction):
        self._cue = instruction

    def read(self, now_ns):
        self._n += 1
        turn, clip = self._readings.get(self._cue, (0.0, 1.0))
        joints = HOME_JOINTS + np.array([0.0, 0.0, turn * (self._n % 2), 0.0])
        return HandleReading(joints, clip, False, 0.0)

    def apply(self, wrench, now_ns):
        assert not wrench.any()

    def close(self):
        pass


GOOD = {"roll": (0.6, 1.0), "open": (0.0, 1.0), "closed": (0.0, 0.1)}


@pytest.mark.parametrize(
    ("left", "right", "message"),
    [
        ({**GOOD, "home": (0.3, 1.0)}, GOOD, "left: roll_rad moved .* rest the hand"),
        ({**GOOD, "roll": (0.1, 1.0)}, GOOD, "left: turned by 0.10 rad: range too small"),
        ({**GOOD, "roll": (0.0, 1.0)}, {**GOOD, "home": (0.6, 1.0)}, "left: the right handle turned .* swapped"),
        ({**GOOD, "open": (0.0, 0.1), "closed": (0.0, 0.9)}, GOOD, "left: clip_open = 0.1 is below .* swapped"),
        ({**GOOD, "closed": (0.0, 0.98)}, GOOD, "left: the clip's range 0.02 is too small"),
        ({**GOOD, "home": (float("nan"), 1.0)}, GOOD, "left: the handle's joints are not finite"),
    ],
)
def test_bad_measurements_are_refused(left, right, message):
    devices = {"left": Puppet(left), "right": Puppet(right)}
    if "right handle turned" in message:
        devices["right"].cue("home")
    with pytest.raises(ConfigError, match=message):
        calibrate(devices, lambda text: None, seconds=0.05, settle_s=0.0)


def test_the_file_keeps_handles_that_were_not_measured_and_is_checked(tmp_path):
    path, one = tmp_path / "deep" / "c.json", HandleCalibration((0.1, -0.2, 0.3, 0.01), 0.2, 0.9)
    save(path, {"left": one}, "2020-01-01")
    save(path, {"right": replace(one, clip_open=0.8)}, "2020-01-02")
    assert load(path) == {"left": one, "right": replace(one, clip_open=0.8)}
    content = json.loads(path.read_text())
    for change, message in (
        ({"clip_open": 0.1}, "left: clip_open = 0.1 .* swapped"),
        ({"joint_zero": [0.1, 9.0, 0.0, 0.0]}, r"left.joint_zero pitch_rad = 9.0: must be finite and within"),
        ({"joint_zero": [0.1, 0.0, 0.0]}, "must be 4 numbers"),
        ({"clip_closed": float("nan")}, "clip_closed = nan"),
    ):
        bad = json.loads(path.read_text())
        bad["handles"]["left"].update(change)
        (tmp_path / "bad.json").write_text(json.dumps(bad))
        with pytest.raises(ConfigError, match=message):
            load(tmp_path / "bad.json")
    assert content["version"] == 1
    (tmp_path / "bad.json").write_text("{")
    with pytest.raises(ConfigError, match="not JSON"):
        load(tmp_path / "bad.json")
    with pytest.raises(ConfigError, match="saras console calibrate"):
        load(tmp_path / "none.json")
