"""contact_force against the simulated tissue, the printed formula, and readings that say nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from saras import ConfigError, Status
from saras.contact import ContactForce, ContactForceConfig, contact_force
from saras.sim import Tissue, TissueConfig

DT = 1.0 / 60.0


def unit(rng: np.random.Generator) -> np.ndarray:
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def test_the_sources_spring(many: int) -> None:
    rng = np.random.default_rng(1)
    for _ in range(1000 * many):
        depth, normal, k = float(rng.uniform(-0.02, 0.02)), unit(rng), float(rng.uniform(1.0, 3000.0))
        force = contact_force(depth, float(rng.uniform(0.01, 100.0)) * normal, k)
        np.testing.assert_allclose(force, k * max(0.0, depth) * normal, atol=1e-12)


@pytest.mark.parametrize("direction", [(0, 0, 0), (math.nan, 0, 1), (0, math.inf, 1), (1e-9, 0, 0)])
def test_no_direction_is_no_estimate(direction: tuple) -> None:
    assert contact_force(0.001, direction, 300.0) is None


@pytest.mark.parametrize("depth", [math.nan, math.inf, -math.inf])
def test_no_depth_is_no_estimate(depth: float) -> None:
    assert contact_force(depth, (0, 0, 1), 300.0) is None


def test_the_signs() -> None:
    """Outward normal up: the tissue pushes the tool up, the tool pushes the tissue down."""
    out = ContactForce().step(DT, 0.004, [0, 0, 2.0])
    assert out.has_estimate and out.status == Status.OK
    np.testing.assert_allclose(out.reaction, [0, 0, 1.2])
    np.testing.assert_allclose(out.exerted, [0, 0, -1.2, 0, 0, 0])


def test_it_equals_the_simulated_tissue_at_rest(many: int) -> None:
    rng = np.random.default_rng(2)
    for _ in range(200 * many):
        k, n = float(rng.uniform(50.0, 2000.0)), float(rng.uniform(1.0, 2.0))
        tissue = Tissue(TissueConfig(stiffness_N_m=k, inclusion_stiffness_N_m=k, exponent=n, friction=0.0))
        tip = np.array([*rng.uniform(-0.02, 0.02, 2), rng.uniform(-0.01, 0.005)])
        truth = tissue.step(tip_position=tip, tip_velocity=np.zeros(3), trocar_deviation=np.zeros(3), dt=DT)
        ours = ContactForce(ContactForceConfig(stiffness_N_m=k, exponent=n, force_limit_N=1e6))
        out = ours.step(DT, truth.depth, truth.normal)
        np.testing.assert_allclose(out.exerted, truth.wrench, atol=1e-9)


def test_hunt_crossley_follows_the_simulated_tissue(many: int) -> None:
    """A slow press and release, seen at 60 Hz: with the damping term the error is a fraction of what it is without."""
    rng = np.random.default_rng(3)
    for _ in range(10 * many):
        k, damping = 300.0, 20000.0
        tissue = Tissue(TissueConfig(damping_N_s_m2=damping, inclusion_stiffness_N_m=k, stiffness_N_m=k, friction=0.0))
        laws = [
            ContactForce(ContactForceConfig(stiffness_N_m=k, damping_N_s_m2=value, rate_cutoff_hz=15.0))
            for value in (damping, 0.0)
        ]
        period, depth, errors = float(rng.uniform(1.0, 2.0)), 0.006, [[], []]
        for i in range(200):
            w = 2.0 * math.pi / period
            z = -depth * math.sin(w * i * DT)
            velocity = np.array([0.0, 0.0, -depth * w * math.cos(w * i * DT)])
            truth = tissue.step(tip_position=[0, 0, z], tip_velocity=velocity, trocar_deviation=np.zeros(3), dt=DT)
            for law, error in zip(laws, errors):
                out = law.step(DT, -z, [0, 0, 1])
                error.append(out.exerted[2] - truth.wrench[2])
        rms = [float(np.sqrt(np.mean(np.square(error)))) for error in errors]
        assert rms[0] < 0.4 * rms[1], rms


def test_a_reading_is_held_with_its_age(many: int) -> None:
    rng = np.random.default_rng(4)
    for _ in range(50 * many):
        limit_s = float(rng.uniform(0.05, 0.4))
        law = ContactForce(ContactForceConfig(age_limit_s=limit_s))
        age = math.inf
        held = 0.0
        for _ in range(120):
            new = rng.random() < 0.1
            age += DT
            if new:
                held, age = float(rng.uniform(0.0, 0.01)), float(rng.uniform(0.0, 0.1))
            out = law.step(DT, *((held, [0, 0, 1.0], age) if new else ()))
            assert out.has_estimate == (age <= limit_s), (age, limit_s)
            if out.has_estimate:
                assert math.isclose(out.age_s, age, rel_tol=1e-9)
                np.testing.assert_allclose(out.reaction, [0, 0, 300.0 * held], atol=1e-12)
            else:
                assert np.isnan(out.exerted).all() and np.isnan(out.reaction).all()
                assert out.status in (Status.STALE, Status.WAITING)


def test_a_reading_that_says_unknown_ends_what_is_held() -> None:
    for bad in ((math.nan, [0, 0, 1]), (0.001, [0, 0, 0]), (0.2, [0, 0, 1]), (0.001, [0, math.nan, 1])):
        law = ContactForce()
        assert law.step(DT, 0.002, [0, 0, 1]).has_estimate
        out = law.step(DT, *bad)
        assert not out.has_estimate and out.status == Status.INVALID_INPUT
        assert not law.step(DT).has_estimate
        assert law.step(DT, 0.001, [0, 0, 1]).has_estimate
    law = ContactForce()
    assert law.step(DT, 0.001, [0, 0, 1], -0.01).status == Status.INVALID_INPUT


def test_a_saturated_force_is_not_told_as_its_bound() -> None:
    law = ContactForce(ContactForceConfig(force_limit_N=2.0))
    assert law.step(DT, 0.006, [0, 0, 1]).has_estimate
    out = law.step(DT, 0.007, [0, 0, 1])
    assert out.status == Status.LIMITED and not out.has_estimate and np.isnan(out.exerted).all()
    assert law.step(DT, 0.006, [0, 0, 1]).has_estimate


def test_it_never_pulls_whatever_the_rate(many: int) -> None:
    rng = np.random.default_rng(5)
    law = ContactForce(ContactForceConfig(damping_N_s_m2=1e5, rate_cutoff_hz=30.0, force_limit_N=1e9))
    for _ in range(2000 * many):
        out = law.step(DT, float(rng.uniform(-0.01, 0.02)), [0, 0, 1])
        assert out.reaction[2] >= 0.0


@pytest.mark.parametrize("dt", [0.0, -1.0, math.nan, math.inf])
def test_a_bad_time_step_gives_no_estimate_and_keeps_the_state(dt: float) -> None:
    law = ContactForce()
    law.step(DT, 0.002, [0, 0, 1])
    out = law.step(dt, 0.009, [0, 0, 1])
    assert not out.has_estimate and out.status == Status.INVALID_TIME_STEP
    assert law.step(DT).depth_m == 0.002


def test_a_stall_makes_what_is_held_older() -> None:
    law = ContactForce(ContactForceConfig(age_limit_s=0.3))
    law.step(DT, 0.002, [0, 0, 1])
    assert law.step(0.5).status == Status.INVALID_TIME_STEP
    assert law.step(DT).status == Status.STALE


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("stiffness_N_m", 0.0),
        ("exponent", 0.5),
        ("damping_N_s_m2", -1.0),
        ("rate_cutoff_hz", 0.0),
        ("depth_limit_m", math.nan),
        ("force_limit_N", -1.0),
        ("age_limit_s", 0.0),
        ("dt_max_s", math.inf),
    ],
)
def test_bad_configurations_are_refused_by_name(field: str, value: float) -> None:
    with pytest.raises(ConfigError, match=field):
        ContactForceConfig(**{field: value})
