"""Transparency against a numpy/scipy version of its formulas, and under faults."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from teleop_strategies import FAULTY_DT, pose, poses, spoilt, turn, vectors

import saras
from saras.teleop import Transparency, TransparencyConfig, TransparencyMode, project_on_pivot

DT = 0.01
MODES = st.sampled_from(
    [TransparencyMode.POSITION_POSITION, TransparencyMode.POSITION_FORCE, TransparencyMode.FOUR_CHANNEL]
)


def clamp(v: np.ndarray, limit: float) -> np.ndarray:
    return v * min(1.0, limit / max(np.linalg.norm(v), 1e-300))


@given(st.data(), MODES, st.floats(0.1, 2.0))
def test_outputs_follow_the_formulas(data: st.DataObject, mode: TransparencyMode, scale: float) -> None:
    config = TransparencyConfig(
        mode=mode, scale=scale, rotation_stiffness_Nm_rad=0.3, rotation_damping_Nm_s_rad=0.01, torque_scale=0.1,
        rotation_drift_gain_1_s=0.5, pivoted=False, ramp_s=DT,
    )  # fmt: skip
    law = Transparency(config)
    master_0, slave_0, master, slave = (data.draw(poses(0.02)) for _ in range(4))
    v_m, v_s, tissue = (data.draw(vectors(size, 6)) for size in (0.3, 0.3, 3.0))
    zero = np.zeros(6)
    law.step(master_0, zero, slave_0, zero, zero, np.zeros(3), DT)
    output = law.step(master, v_m, slave, v_s, tissue, np.zeros(3), DT)

    e = (slave - slave_0)[:3, 3] - scale * (master - master_0)[:3, 3]
    turned = (turn(slave) * turn(slave_0).inv()) * (turn(master) * turn(master_0).inv()).inv()
    np.testing.assert_allclose(output.error[:3], e, atol=1e-12)
    assert (Rotation.from_rotvec(output.error[3:]) * turned.inv()).magnitude() < 1e-7
    e_r = output.error[3:]
    force, torque = np.zeros(3), np.zeros(3)
    if mode != TransparencyMode.POSITION_FORCE:
        force += 200.0 * e + 2.0 * (v_s[:3] - scale * v_m[:3])
        torque += 0.3 * e_r + 0.01 * (v_s[3:] - v_m[3:])
    if mode != TransparencyMode.POSITION_POSITION:
        force -= 0.2 * tissue[:3]
        torque -= 0.1 * tissue[3:]
    np.testing.assert_allclose(output.desired_wrench[:3], clamp(force, 3.3), atol=1e-10)
    np.testing.assert_allclose(output.desired_wrench[3:], clamp(torque, 0.1), atol=1e-10)
    np.testing.assert_allclose(output.desired_twist[:3], scale * v_m[:3] - clamp(2.0 * e, 0.02), atol=1e-10)
    np.testing.assert_allclose(output.desired_twist[3:], v_m[3:] - clamp(0.5 * e_r, 0.1), atol=1e-10)


@given(st.data(), st.floats(0.011, 0.3))
def test_projection_is_the_least_squares_choice_of_a_pivoting_arm(data: st.DataObject, insertion: float) -> None:
    """Columns of the arm's freedoms at the tip: two pivots and insertion reach the translation, roll the rest."""
    rcm, rotation, twist = data.draw(vectors(0.3)), turn(data.draw(poses(1.0))), data.draw(vectors(1.0, 6))
    x, y, z = rotation.as_matrix().T
    tip = pose(rotation, rcm + insertion * z)
    arm = np.zeros((6, 4))
    arm[:, 0], arm[:, 1] = np.r_[np.cross(x, insertion * z), x], np.r_[np.cross(y, insertion * z), y]
    arm[:, 2], arm[:, 3] = np.r_[z, 0, 0, 0], np.r_[0, 0, 0, z]
    reach = np.vstack([arm[:3], z @ arm[3:]])  # tip translation and shaft roll are prescribed
    rates = np.linalg.solve(reach, np.r_[twist[:3], z @ twist[3:]])
    np.testing.assert_allclose(project_on_pivot(twist, tip, rcm), arm @ rates, atol=1e-9)


@given(st.data(), MODES)
def test_clutch_toggled_at_peak_speed_gives_no_jump_of_force_or_speed(
    data: st.DataObject, mode: TransparencyMode
) -> None:
    """Force moves at most by the ramp plus what 1 m/s can change, and release begins at zero."""
    law = Transparency(TransparencyConfig(mode=mode))
    slave = pose(turn(np.eye(4)), np.array([0, 0, -0.1]))
    zero, rcm = np.zeros(6), np.zeros(3)
    master = np.eye(4)
    law.step(master, zero, slave, zero, zero, rcm, DT)
    was_pressed = False
    previous = np.zeros(3)
    for pressed in data.draw(st.lists(st.booleans(), min_size=1, max_size=40)):
        moving = np.zeros(6) if pressed else np.array([1.0, 0, 0, 0, 0, 0])
        master = master.copy()
        master[0, 3] += moving[0] * DT
        output = law.step(master, moving, slave, zero, zero, rcm, DT, clutch=pressed)
        if pressed:
            assert not output.desired_twist.any()
        elif was_pressed:  # one tick of motion since the reference
            assert abs(output.error[0]) <= 0.5 * DT + 1e-12
        change = np.linalg.norm(output.desired_wrench[:3] - previous)
        assert change <= 3.3 * DT / 0.1 + 200 * 0.5 * DT + 2 * 0.5 + 1e-9
        previous, was_pressed = output.desired_wrench[:3], pressed


@given(st.data(), MODES)
def test_faults_never_give_a_number_that_is_not_finite_nor_more_than_the_limits(
    data: st.DataObject, mode: TransparencyMode
) -> None:
    law = Transparency(TransparencyConfig(mode=mode))
    for _ in range(data.draw(st.integers(1, 15))):
        inputs = [
            data.draw(poses(0.2)), data.draw(vectors(1.0, 6)), data.draw(poses(0.2)),
            data.draw(vectors(1.0, 6)), data.draw(vectors(5.0, 6)), data.draw(vectors(0.2)),
        ]  # fmt: skip
        if data.draw(st.booleans()):
            i = data.draw(st.integers(0, 5))
            inputs[i] = data.draw(spoilt(inputs[i]))
        output = law.step(
            *inputs, data.draw(FAULTY_DT), clutch=data.draw(st.booleans()), stale=data.draw(st.booleans())
        )
        for value in (output.desired_wrench, output.desired_twist, output.error):
            assert np.isfinite(value).all()
        assert np.linalg.norm(output.desired_wrench[:3]) <= 3.3 * (1 + 1e-12)
        if output.status in (saras.Status.WAITING, saras.Status.STALE, saras.Status.INVALID_TIME_STEP):
            assert not output.desired_twist.any()
