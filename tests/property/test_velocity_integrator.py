"""What must hold for the set-point whatever comes in: no step above v_max * dt, always finite, always bounded."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from teleop_strategies import BAD_NUMBERS, FAULTY_DT, move, pose, poses, rotations, spoilt, turn, vectors

import saras
from saras.teleop import FrameMapping, Transparency, VelocityIntegrator, VelocityIntegratorConfig

DT = 0.01
RCM = np.zeros(3)
CONFIG = VelocityIntegratorConfig()


def tip(rotation: object = None) -> np.ndarray:
    """A (4, 4) tip in the middle of the workspace."""
    return pose(turn(np.eye(4)) if rotation is None else rotation, np.array([0, 0, -0.1]))  # type: ignore[arg-type]


def allowed_dt(dt: float) -> float:
    """The time over which the set-point may move in a step of dt."""
    if not np.isfinite(dt) or dt <= 0:
        return 0.0
    return CONFIG.nominal_dt_s if dt > CONFIG.dt_max_s else dt


@given(rotations(), st.lists(vectors(0.05, 6), min_size=1, max_size=20))
def test_free_motion_is_scipys_exponential(rotation: object, twists: list[np.ndarray]) -> None:
    law = VelocityIntegrator()
    expected = tip(rotation)
    for twist in twists:
        output = law.step(twist, expected, RCM, DT)
        expected = move(expected, twist, DT)
        assert output.status == saras.Status.OK
        np.testing.assert_allclose(output.set_point, expected, atol=1e-12)


@given(st.data(), st.booleans(), st.booleans())
def test_no_step_above_the_speed_limit_and_nothing_but_finite(
    data: st.DataObject, pivoted: bool, believe_jumps: bool
) -> None:
    law = VelocityIntegrator(
        VelocityIntegratorConfig(shaft_through_rcm=pivoted, measured_jump_m=10.0 if believe_jumps else 0.02)
    )
    measured = tip()
    previous = law.step(np.zeros(6), measured, RCM, DT).set_point
    for _ in range(data.draw(st.integers(1, 20))):
        twist = data.draw(st.one_of(vectors(0.1, 6), vectors(100.0, 6)))
        measured = data.draw(st.one_of(st.just(measured), poses(0.3)))
        rcm = data.draw(st.one_of(st.just(RCM), vectors(0.2)))
        dt = data.draw(FAULTY_DT)
        fault = data.draw(st.integers(0, 6))
        output = law.step(
            data.draw(spoilt(twist)) if fault == 0 else twist,
            data.draw(spoilt(measured)) if fault == 1 else measured,
            data.draw(spoilt(rcm)) if fault == 2 else rcm,
            dt,
            stale=data.draw(st.booleans()),
            max_speed_scale=data.draw(BAD_NUMBERS) if fault == 3 else 1.0,
            approach_direction=data.draw(spoilt(np.ones(3))) if fault == 4 else None,
            approach_speed_limit_m_s=data.draw(BAD_NUMBERS) if fault == 5 else 0.05,
        )
        assert np.isfinite(output.set_point).all()
        np.testing.assert_allclose(output.set_point[:3, :3] @ output.set_point[:3, :3].T, np.eye(3), atol=1e-12)
        step = np.linalg.norm(output.set_point[:3, 3] - previous[:3, 3])
        assert step <= CONFIG.speed_limit_m_s * allowed_dt(dt) * (1 + 1e-9) + 1e-15
        angle = (turn(output.set_point) * turn(previous).inv()).magnitude()
        assert angle <= CONFIG.speed_limit_rad_s * allowed_dt(dt) * (1 + 1e-6) + 1e-7
        previous = output.set_point


@given(st.lists(vectors(0.2, 6), min_size=1, max_size=60))
def test_a_held_arm_is_never_led_by_more_than_the_bound(twists: list[np.ndarray]) -> None:
    law = VelocityIntegrator()
    for twist in twists:
        output = law.step(twist, tip(), RCM, 0.05)
        assert output.lead_m <= CONFIG.lead_limit_m * (1 + 1e-9)
        assert turn(output.set_point).magnitude() <= CONFIG.lead_limit_rad + 1e-9


@given(st.integers(0, 2**32 - 1))
def test_workspace_is_never_left_by_an_arm_that_follows(seed: int) -> None:
    rng = np.random.default_rng(seed)
    law = VelocityIntegrator()
    measured = tip()
    twist = np.zeros(6)
    for i in range(300):
        if i % 60 == 0:
            twist[:3] = 0.1 * rng.normal(size=3) / np.sqrt(3)
        measured = law.step(twist, measured, RCM, 0.05).set_point
        insertion = np.linalg.norm(measured[:3, 3])
        # A step along the inner sphere is a chord of it.
        sagitta = (CONFIG.speed_limit_m_s * 0.05) ** 2 / (8 * CONFIG.insertion_min_m)
        assert CONFIG.insertion_min_m - sagitta <= insertion <= CONFIG.insertion_max_m + 1e-9
        assert np.arccos(np.clip(-measured[2, 3] / insertion, -1, 1)) <= CONFIG.cone_half_angle_rad + 1e-6


@given(st.lists(st.booleans(), min_size=20, max_size=80), st.floats(0.1, 2.0))
def test_clutch_toggled_at_peak_speed_through_all_three_laws(clutch: list[bool], speed: float) -> None:
    """A handle at peak speed; the arm follows its set-point with one tick of delay."""
    mapping, transparency, integrator = FrameMapping(), Transparency(), VelocityIntegrator()
    handle, measured, zero = np.eye(4), tip(), np.zeros(6)
    mapping.step(handle, DT)
    previous = measured[:3, 3]
    for i, pressed in enumerate(clutch):
        handle = handle.copy()
        handle[0, 3] = 0.05 * np.sin(speed / 0.05 * (i + 1) * DT)
        mapped = mapping.step(handle, DT, clutch=pressed)
        wanted = transparency.step(
            mapped.tracked_pose, mapped.tracked_twist, measured, zero, zero, RCM, DT, clutch=pressed
        )
        output = integrator.step(wanted.desired_twist, measured, RCM, DT)
        step = np.linalg.norm(output.set_point[:3, 3] - previous)
        assert step <= CONFIG.speed_limit_m_s * DT * (1 + 1e-9)
        if pressed:
            assert step == 0.0
        measured, previous = output.set_point, output.set_point[:3, 3]
