"""Simulated hands, motions, recorded tracks, manual and OpenHaptics devices without their hardware."""

from __future__ import annotations

import math
import sys
import types
import zipfile

import numpy as np
import pytest

from saras import ConfigError
from saras.console.device import device_names, open_device
from saras.console.devices import openhaptics
from saras.console.motion import MOTIONS, scripted
from saras.console.recorded_motion import RecordedMotion, RecordedMotionConfig, drop_repeats, load_rows
from saras.console.simball import HANDLE, SIMBALL_T_HOME

MS = 1_000_000


def position(device, now_ns):
    return HANDLE.forward(device.read(now_ns).joints)[:3, 3]


@pytest.mark.parametrize("name", sorted(MOTIONS))
@pytest.mark.parametrize("seed", [1, 2])
def test_scripted_motions_are_smooth_and_their_velocity_is_their_derivative(name, seed):
    motion, h = scripted(name, seed, "left", 0.03), 1e-5
    before = motion.at(0.0)
    for k in range(1, 12000):
        now = motion.at(k * 0.005)
        assert math.dist(now.offset, before.offset) < 0.005 * 0.4  # no step
        if k % 7 == 0:
            slope = (np.array(motion.at(k * 0.005 + h).offset) - motion.at(k * 0.005 - h).offset) / (2 * h)
            np.testing.assert_allclose(slope, now.velocity, atol=2e-4)
        assert math.hypot(*now.offset) < 0.05 and 0.0 <= now.grip <= 1.0
        before = now


def test_seed_and_side_decide_the_motion():
    a, b, c = (scripted("reach", seed, side, 0.03) for seed, side in ((1, "left"), (1, "left"), (1, "right")))
    assert [a.at(t) for t in range(20)] == [b.at(t) for t in range(20)]
    assert [a.at(t) for t in range(20)] != [c.at(t) for t in range(20)]


def test_force_moves_the_simulated_hand_and_its_work_is_counted():
    hand = open_device("script", "left", {"motion": "rest", "operator": "normal"})
    start = position(hand, 0)
    for k in range(1, 3000):
        hand.apply(np.array([0, 2.0, 0, 0, 0, 0]), (k - 1) * MS)
        reading = hand.read(k * MS)
    moved = HANDLE.forward(reading.joints)[:3, 3] - start
    np.testing.assert_allclose(moved, [0, -2.0 / 200.0, 0], atol=2e-4)  # touch y is -y of the Simball; 200 N/m
    assert reading.work_J == pytest.approx(2.0 * 0.01, rel=0.02)


def test_force_falls_to_zero_when_it_is_not_refreshed():
    hand = open_device("script", "left", {"motion": "rest"})
    hand.read(0)
    hand.apply(np.array([3.0, 0, 0, 0, 0, 0]), 0)
    work = [hand.read(k * 50 * MS).work_J for k in range(1, 10)]
    assert work[0] > 0.0 and len(set(work)) == 1  # only the first 2 ms worked


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("script", {"motion": "dance"}, "motion = 'dance': must be one of"),
        ("script", {"operator": "giant"}, "operator = 'giant'"),
        ("script", {"amplitude_m": "30"}, r"amplitude_m = 30: must be in \[0, 0.05\]"),
        ("script", {"amplitude_m": "nan"}, "amplitude_m = nan"),
        ("script", {"sped": "1"}, "no option 'sped'"),
        ("recorded", {}, "needs a motion file"),
        ("recorded", {"file": "/nowhere.csv"}, "no such file"),
        ("joystick9000", {}, "device = 'joystick9000': must be one of"),
    ],
)
def test_bad_options_are_named(name, options, message):
    with pytest.raises(ConfigError, match=message):
        open_device(name, "left", options)


def track(seconds=20.0, rate=33.0):
    """A drifting, wobbling track with repeats."""
    t = np.arange(0.0, seconds, 1.0 / rate)
    xyz = np.column_stack([0.2 * np.sin(3.0 * t) + 0.1 * t, 0.1 * np.cos(2.0 * t) - 0.05 * t, 0.05 * np.sin(5.0 * t)])
    half = 0.3 * np.sin(1.5 * t)
    rows = np.column_stack([t + 1.5e9, xyz, np.zeros((len(t), 2)), np.sin(half), np.cos(half)])
    rows[5::7, 1:] = rows[4::7, 1:][: len(rows[5::7])]
    return rows


def test_recorded_track_loses_repeats_drift_and_size_but_not_its_motion():
    rows = track()
    assert len(drop_repeats(rows)) == len(rows) - len(rows[5::7])
    motion = RecordedMotion(rows, RecordedMotionConfig(amplitude_m=0.03))
    offsets = np.array([motion.at(t).offset for t in np.arange(0.0, motion.duration_s, 0.01)])
    assert np.percentile(np.linalg.norm(offsets, axis=1), 99) <= 0.0301
    assert np.abs(offsets.mean(axis=0)).max() < 0.002  # drift of 2 m in 20 s is gone
    spectrum = np.abs(np.fft.rfft(offsets[:, 0]))
    assert np.fft.rfftfreq(len(offsets), 0.01)[spectrum.argmax()] == pytest.approx(3.0 / (2 * math.pi), abs=0.06)
    assert math.hypot(*motion.at(0.0).offset) < 1e-6
    for t in np.arange(0.1, motion.duration_s - 0.1, 0.0473):
        slope = (np.array(motion.at(t + 1e-5).offset) - motion.at(t - 1e-5).offset) / 2e-5
        np.testing.assert_allclose(slope, motion.at(t).velocity, atol=2e-3)
        assert math.hypot(*motion.at(t).velocity) < 0.3


def test_motion_files_are_read_strictly(tmp_path):
    good = "\n".join(",".join(map(repr, row)) for row in track().tolist())
    (tmp_path / "a.csv").write_text(good)
    assert load_rows(tmp_path / "a.csv").shape == track().shape
    with zipfile.ZipFile(tmp_path / "two.zip", "w") as archive:
        archive.writestr("x/ONE.csv", good)
        archive.writestr("x/TWO.csv", good)
    assert load_rows(tmp_path / "two.zip", "TWO").shape == track().shape
    assert load_rows(tmp_path / "two.zip", nth=1).shape == track().shape
    with pytest.raises(ConfigError, match="2 of the files"):
        load_rows(tmp_path / "two.zip")
    lines = good.splitlines()
    for bad, message in (
        ("1,2,3", "line 4: must be 8 finite"),
        ("a,b,c,d,e,f,g,h", "line 4: .* not a row of numbers"),
        (lines[3].rsplit(",", 1)[0] + ",nan", "line 4: must be 8 finite"),
        (lines[3].rsplit(",", 1)[0] + ",7", "line 4: quaternion norm"),
        ("0," + lines[3].split(",", 1)[1], "line 4: time 0.0 runs backwards"),
    ):
        (tmp_path / "bad.csv").write_text("\n".join([*lines[:3], bad, *lines[4:]]))
        with pytest.raises(ConfigError, match=message):
            load_rows(tmp_path / "bad.csv")


def test_plugins_are_found_by_entry_point(monkeypatch):
    class Point:
        name = "mine"

        @staticmethod
        def load():
            return lambda side, options: (side, dict(options))

    class Points(list):
        def select(self, group):
            return [Point()] if group == "saras.console_devices" else []

    monkeypatch.setattr("saras.console.device.metadata.entry_points", lambda: Points())
    assert open_device("mine", "left", {"a": "b"}) == ("left", {"a": "b"})
    assert "mine" in device_names() and "script" in device_names()


def fake_pyopenhaptics(monkeypatch):
    """The parts of pyOpenHaptics that the device uses, with one handle a name."""
    hd = types.ModuleType("pyOpenHaptics.hd")
    hd.forces, hd.position, hd.buttons, hd.current, hd.calls = {}, {}, {}, 0, []
    names = {}

    def init_device(name):
        if name == "Nobody":
            return None
        hd.current = names.setdefault(name, len(names) + 1)
        hd.position.setdefault(hd.current, (0.0, 0.0, 0.0))
        return hd.current

    hd.init_device = init_device
    hd.get_current_device = lambda: hd.current
    hd.get_transform = lambda: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [*hd.position[hd.current], 1]]
    hd.get_gimbals = lambda: (0.0, 0.0, 0.25)
    hd.get_buttons = lambda: hd.buttons.get(hd.current, 0)
    hd.set_force = lambda force: hd.forces.__setitem__(hd.current, tuple(force))
    for name in ("enable_force", "start_scheduler", "stop_scheduler"):
        setattr(hd, name, lambda name=name: hd.calls.append(name))
    hd.begin_frame = hd.end_frame = lambda handle: None
    hd.close_device = lambda handle: hd.calls.append(f"close {handle}")
    hd._lib_hd = types.SimpleNamespace(hdMakeCurrentDevice=lambda handle: setattr(hd, "current", handle))
    callback = types.ModuleType("pyOpenHaptics.hd_callback")
    callback.hd_callback = lambda function: function
    callback.hdAsyncSheduler = lambda function: setattr(hd, "tick", function)
    package = types.ModuleType("pyOpenHaptics")
    package.hd, package.hd_callback = hd, callback
    for module in (package, hd, callback):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    return hd


def test_openhaptics_serves_both_devices_from_one_callback(monkeypatch):
    hd = fake_pyopenhaptics(monkeypatch)
    left, right = (open_device("openhaptics", side, {}) for side in ("left", "right"))
    now = 1000 * MS
    openhaptics.Scheduler.shared().clock_ns = lambda: now
    hd.position[1], hd.buttons[2] = (0.0, 0.0, 20.0), 3  # left 20 mm towards the user
    left.apply(np.array([1.0, 2.0, 3.0, 0, 0, 0]), now)
    hd.tick()
    # touch_base: x towards the operator, z up. HD: z towards the user, y up, x right.
    assert hd.forces[1] == (2.0, 3.0, 1.0) and hd.forces[2] == (0.0, 0.0, 0.0)
    reading = left.read(now)
    np.testing.assert_allclose(HANDLE.forward(reading.joints)[:3, 3] - SIMBALL_T_HOME[:3, 3], [-0.02, 0, 0], atol=1e-9)
    assert reading.joints[2] == pytest.approx(0.25) and not reading.clutch and reading.clip == 1.0
    other = right.read(now)
    assert other.clutch and other.clip == 0.0
    hd.position[1] = (0.0, 10.0, 20.0)
    hd.tick()
    assert left.read(now).work_J == pytest.approx(3.0 * 0.01)
    now += 3 * MS
    hd.tick()
    assert hd.forces[1] == (0.0, 0.0, 0.0)  # not refreshed
    now += 25 * MS
    assert left.read(now) is None  # the servo loop stands still
    left.close()
    right.close()
    assert hd.calls[-3:] == ["start_scheduler", "stop_scheduler", "close 2"]


def test_openhaptics_names_a_device_that_does_not_answer(monkeypatch):
    fake_pyopenhaptics(monkeypatch)
    with pytest.raises(ConfigError, match="left: no device named 'Nobody'"):
        open_device("openhaptics", "left", {"name": "Nobody"})


def test_manual_pointer_moves_the_hand(monkeypatch):
    pytest.importorskip("pygame")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    left, right = (open_device("manual", side, {}) for side in ("left", "right"))
    import pygame

    pygame.event.post(pygame.event.Event(pygame.MOUSEMOTION, rel=(0, -100), buttons=(1, 0, 0), pos=(0, 0)))
    start = position(left, 0)
    assert left.pump({"state": "READY"}) and right.pump({})
    for k in range(1, 2000):
        left.read(k * MS)
    np.testing.assert_allclose(position(left, 2000 * MS) - start, [0.02, 0, 0], atol=5e-4)  # up on the screen: away
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    assert not left.pump({})
    left.close()
    right.close()
