"""What keeps an engagement from making anything jump: the hand's speed, and the jaw that waits for the clip."""

import math

import numpy as np
import pytest

pytest.importorskip("rospy")

from saras.kinematics import simball
from saras_ros1.alignment import HandSpeed, misalignment
from saras_ros1.nodes.tool_command import JawPickup


def test_speed_of_the_hand_is_that_of_its_handle(many: int) -> None:
    rng = np.random.default_rng(3)
    handle = simball.handle()
    for _ in range(20 * many):
        speed, dt_ns = HandSpeed(), int(rng.uniform(1e6, 4e8))
        before = rng.uniform((-0.5, -0.5, -1.0, 0.05), (0.5, 0.5, 1.0, 0.2))
        after = before + rng.normal(scale=0.01, size=4)
        speed.update(before, 1_000)
        assert math.isnan(speed.m_s)
        speed.update(after, 1_000 + dt_ns)
        moved = np.linalg.norm((handle.forward(after) - handle.forward(before))[:3, 3])
        assert speed.m_s == pytest.approx(moved / (1e-9 * dt_ns), rel=1e-9)
        speed.update(before, 1_000 + dt_ns)
        assert math.isnan(speed.m_s), "no time between the two"


def test_what_is_not_known_is_not_aligned() -> None:
    assert "not known" in misalignment(math.nan, 0.1)
    assert "110 mm/s (limit 100)" in misalignment(0.11, 0.1)
    assert misalignment(0.1, 0.1) == ""


def test_the_jaw_stays_until_the_clip_comes_by(many: int) -> None:
    rng = np.random.default_rng(4)
    for _ in range(20 * many):
        jaw = float(rng.uniform())
        clips = np.clip(np.cumsum(rng.normal(scale=0.1, size=200)) + rng.uniform(), 0.0, 1.0)
        pickup = JawPickup(jaw)
        commands = np.array([pickup.step(float(clip)) for clip in clips])
        near = np.abs(clips - jaw) <= JawPickup.REACHED
        passed = np.concatenate([[False], (clips[:-1] - jaw) * (clips[1:] - jaw) <= 0.0])
        taken = np.maximum.accumulate(near | passed)
        np.testing.assert_array_equal(commands, np.where(taken, clips, jaw))
        first = int(np.argmax(taken)) if taken.any() else len(clips)
        step = abs(commands[first] - jaw) if first < len(clips) else 0.0
        assert step <= max(JawPickup.REACHED, abs(clips[first] - clips[first - 1]) if 0 < first < len(clips) else 0.0)
