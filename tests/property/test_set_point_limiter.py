"""The last check on set-points: whatever is asked, speed and acceleration of what is sent are bounded."""

from __future__ import annotations

import numpy as np
import pytest

from saras import ConfigError, add_delta, displacement
from saras_ros1.set_point_limiter import SetPointLimiter
from saras_ros1.tracking_watch import TrackingWatch

LIMITS = {
    "speed_m_s": 0.12,
    "speed_rad_s": 1.2,
    "acceleration_m_s2": 10.0,
    "acceleration_rad_s2": 100.0,
    "reach_m": 0.02,
    "reach_rad": 0.35,
    "dt_max_s": 0.03,
}


def started(at=None, **changes):
    limiter = SetPointLimiter(**{**LIMITS, **changes})
    limiter.start(np.eye(4) if at is None else at)
    return limiter


def test_speed_and_acceleration_are_bounded_whatever_is_asked(many: int) -> None:
    rng = np.random.default_rng(7)
    for _ in range(20 * many):
        limiter = started(add_delta(np.eye(4), rng.normal(size=6), 1.0))
        before = np.zeros(6)
        for _ in range(50):
            last = limiter.last
            dt = float(rng.choice([rng.uniform(-0.01, 0.1), 0.01, 0.02]))
            asked = add_delta(last, rng.normal(scale=(0.008,) * 3 + (0.1,) * 3), 1.0)
            delta = displacement(last, asked)
            if np.linalg.norm(delta[:3]) > 0.02 or np.linalg.norm(delta[3:]) > 0.35:
                with pytest.raises(ValueError, match="from the last one sent"):
                    limiter.step(asked, dt)
                assert limiter.last is last
                continue
            sent = limiter.step(asked, dt)
            dt = min(dt, 0.03)
            if dt <= 0.0:
                assert sent is last
                continue
            velocity = displacement(last, sent) / dt
            # A set-point is sent as it is when it is nearer than 1e-12 to what the bounds allow.
            slack = 2e-12 / dt + 1e-9
            assert np.linalg.norm(velocity[:3]) <= 0.12 + slack
            assert np.linalg.norm(velocity[3:]) <= 1.2 + slack
            assert np.linalg.norm(velocity[:3] - before[:3]) <= 10.0 * dt + 2 * slack
            assert np.linalg.norm(velocity[3:] - before[3:]) <= 100.0 * dt + 2 * slack
            before = velocity


def test_a_motion_within_the_bounds_is_sent_as_it_is(many: int) -> None:
    rng = np.random.default_rng(8)
    for _ in range(many):
        limiter, dt = started(), 0.01
        amplitude, omega = rng.uniform(0.0, 0.02, 3), rng.uniform(0.1, 2.0)
        for i in range(300):
            asked = np.eye(4)
            asked[:3, 3] = amplitude * (1.0 - np.cos(omega * i * dt))
            assert limiter.step(asked, dt) is asked
        assert limiter.limited == 0


@pytest.mark.parametrize("dt", [0.005, 0.01, 0.02])
def test_a_far_set_point_is_reached_without_passing_it(dt: float, many: int) -> None:
    rng = np.random.default_rng(9)
    for _ in range(many):
        limiter = started()
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        goal = np.eye(4)
        goal[:3, 3] = rng.uniform(0.0, 0.02) * direction
        distances = [np.linalg.norm(goal[:3, 3])]
        for _ in range(200):
            sent = limiter.step(goal, dt)
            distances.append(np.linalg.norm(goal[:3, 3] - sent[:3, 3]))
            assert direction @ (goal - sent)[:3, 3] >= -1e-12, "passed its goal"
        assert distances[-1] < 1e-9 and np.all(np.diff(distances) <= 1e-12)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_what_is_not_finite_is_refused_and_changes_nothing(value: float) -> None:
    limiter = started()
    for index in np.ndindex(3, 4):
        bad = np.eye(4)
        bad[index] = value
        with pytest.raises(ValueError, match="not finite"):
            limiter.step(bad, 0.01)
        np.testing.assert_array_equal(limiter.last, np.eye(4))


@pytest.mark.parametrize("name", list(LIMITS))
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan, np.inf])
def test_limits_can_not_be_switched_off(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=name):
        started(**{name: value})


def test_an_arm_that_does_not_follow_is_noticed_and_a_short_lag_is_not() -> None:
    watch = TrackingWatch(0.008, 1.0)
    assert not any(watch.step(0.0079, 0.1 * i) for i in range(100))
    assert not any(watch.step(0.01, 100.0 + 0.1 * i) for i in range(10))
    assert not watch.step(0.001, 101.05)
    assert not watch.step(0.01, 102.0) and not watch.step(0.01, 102.9)
    assert "10.0 mm from where it was sent for 1.1 s" in watch.step(0.01, 103.1)
    watch.reset()
    assert not watch.step(float("nan"), 104.0) and watch.step(float("nan"), 105.1), "unknown is too far"
    for values in ((0.0, 1.0), (0.01, float("inf")), (float("nan"), 1.0)):
        with pytest.raises(ConfigError):
            TrackingWatch(*values)
