"""The observer against scipy's integration of the servo that it models, and against the simulated arm."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import saras
from saras.teleop import DisturbanceObserver, DisturbanceObserverConfig

OMEGA, MASS, DT = 60.0, 2.0, 0.01


def servo(x: np.ndarray, set_point: np.ndarray, force: np.ndarray, zeta: float = 1.0) -> np.ndarray:
    """(6,) position and velocity of the servo after DT, by Runge-Kutta (independent of the law's closed form)."""

    def rate(_t: float, x: np.ndarray) -> np.ndarray:
        acceleration = OMEGA**2 * (set_point - x[:3]) - 2 * zeta * OMEGA * x[3:] + force / MASS
        return np.concatenate([x[3:], acceleration])

    return np.asarray(solve_ivp(rate, (0, DT), x, rtol=1e-10, atol=1e-13).y[:, -1])


def observe(set_points: np.ndarray, forces: np.ndarray, **config: float) -> np.ndarray:
    """(n, 3) wrench on the tissue for n held set-points and external forces on the tip; NaN where unknown."""
    observer = DisturbanceObserver(DisturbanceObserverConfig(**config))
    x = np.concatenate([set_points[0], np.zeros(3)])
    observer.step(set_points[0], x[:3], DT)
    wrenches = []
    for set_point, force in zip(set_points, forces):
        x = servo(x, set_point, force, config.get("damping_ratio", 1.0))
        output = observer.step(set_point, x[:3], DT)
        wrenches.append(output.wrench[:3] if output.has_wrench else np.full(3, np.nan))
    return np.array(wrenches)


@pytest.mark.parametrize("direction", [+1, -1])
def test_lag_of_free_motion_gives_no_force(direction: int) -> None:
    t = np.arange(150) * DT
    set_points = direction * np.stack([0.03 * np.sin(6 * t), 0.1 * t * (t < 1), 0.02 * np.sign(np.sin(9 * t))], axis=1)
    wrenches = observe(set_points, np.zeros((len(t), 3)), deadband_N=0.0)
    # A lag of 2 zeta/omega at 0.1 m/s would pass for 24 N.
    assert np.nanmax(np.abs(wrenches)) < 1e-4
    assert np.isfinite(wrenches[-1]).all()


def test_constant_contact_force_is_recovered_with_the_sign_of_the_tissue() -> None:
    external = np.array([1.0, -0.5, 2.0])
    wrenches = observe(np.zeros((150, 3)), np.tile(external, (150, 1)))
    np.testing.assert_allclose(wrenches[-1], -external, atol=1e-6)


def test_force_during_motion_is_the_low_passed_force() -> None:
    t = np.arange(300) * DT
    force = 2.0 * np.sin(2 * np.pi * 0.5 * t)
    set_points = np.stack([0.05 * np.sin(2 * np.pi * 1.3 * t), 0 * t, 0 * t], axis=1)
    forces = np.stack([force, 0 * t, 0 * t], axis=1)
    wrenches = observe(set_points, forces, deadband_N=0.0)
    # H(s) of the header at 0.5 Hz: its delay is 2/c; force held over each interval is half a period older.
    delay = 2 / (2 * np.pi * 8.0) - DT / 2
    expected = -2.0 * np.sin(2 * np.pi * 0.5 * (t + DT / 2 - delay - DT / 2))
    settled = t > 0.6
    assert np.max(np.abs(wrenches[settled, 0] - expected[settled])) < 0.06


@pytest.mark.parametrize("zeta", [0.4, 1.0, 2.5])
def test_model_is_exact_below_at_and_above_critical_damping(zeta: float) -> None:
    t = np.arange(60) * DT
    set_points = np.stack([0.03 * np.sin(6 * t), 0.1 * t, 0 * t], axis=1)
    wrenches = observe(set_points, np.zeros((60, 3)), deadband_N=0.0, damping_ratio=zeta)
    assert np.nanmax(np.abs(wrenches)) < 1e-4


def test_unknown_is_not_zero() -> None:
    observer = DisturbanceObserver()
    zero = np.zeros(3)
    for _ in range(15):
        output = observer.step(zero, zero, DT)
        assert not output.has_wrench
        assert output.status == saras.Status.WAITING
    for _ in range(15):
        output = observer.step(zero, zero, DT)
    assert output.has_wrench
    output = observer.step(zero, zero, DT, stale=True)
    assert (output.has_wrench, output.status) == (False, saras.Status.STALE)
    output = observer.step(zero, [np.nan, 0, 0], DT)
    assert (output.has_wrench, output.status) == (False, saras.Status.INVALID_INPUT)
    assert observer.step(zero, zero, DT).has_wrench  # bridged
    assert observer.step(zero, zero, 0.5).status == saras.Status.INVALID_TIME_STEP
    assert observer.step(zero, zero, DT).status == saras.Status.WAITING  # restarted


def test_one_missed_input_is_bridged_without_a_false_force() -> None:
    observer = DisturbanceObserver(DisturbanceObserverConfig(deadband_N=0.0, settle_s=0.0))
    x = np.zeros(6)
    observer.step(x[:3], x[:3], DT)
    worst = 0.0
    for i in range(100):
        set_point = np.array([1e-3 * (i // 2), 0, 0])  # held over two ticks
        x = servo(x, set_point, np.zeros(3))
        output = observer.step(set_point, x[:3], DT, stale=i % 4 == 0)
        worst = max(worst, np.abs(output.wrench).max())
    assert worst < 1e-4


def test_deadband_hides_small_forces_only() -> None:
    def steady(force: float) -> float:
        return float(observe(np.zeros((120, 3)), np.tile([force, 0, 0], (120, 1)), deadband_N=0.2)[-1, 0])

    assert steady(0.19) == 0.0
    assert -0.3 < steady(0.3) < 0.0
    assert steady(0.41) == pytest.approx(-0.41, abs=1e-6)


def test_refusals_name_field_value_and_bound() -> None:
    with pytest.raises(saras.ConfigError, match=r"damping_ratio = 0: must be in \[0.1, 10\]"):
        DisturbanceObserverConfig(damping_ratio=0.0)
    with pytest.raises(saras.ConfigError, match="mass_kg = nan"):
        DisturbanceObserverConfig(mass_kg=np.nan)
