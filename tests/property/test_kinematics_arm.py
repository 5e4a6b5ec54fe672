"""What holds for every pose of the SARAS arm and the hand piece."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import saras
from saras.kinematics import mesa, simball

ARM = mesa.arm()
HANDLE = simball.handle()
RCM = mesa.NOMINAL_RCM


def joints(limits, margin=1e-6):
    return st.tuples(*(st.floats(lower + margin, upper - margin) for lower, upper in limits)).map(np.array)


tips = st.tuples(st.floats(0.0, np.deg2rad(50)), st.floats(-np.pi, np.pi), st.floats(0.03, 0.17)).map(
    lambda polar: (
        RCM
        + polar[2]
        * np.array([np.sin(polar[0]) * np.cos(polar[1]), np.sin(polar[0]) * np.sin(polar[1]), -np.cos(polar[0])])
    )
)
elbows = st.sampled_from([-1.0, 1.0])


def finite_difference(forward, q, step=1e-6):
    columns = []
    for i in range(len(q)):
        h = np.zeros(len(q))
        h[i] = step
        columns.append(saras.displacement(forward(q - h), forward(q + h)) / (2 * step))
    return np.array(columns).T


@given(joints(ARM.limits))
def test_jacobian_is_the_derivative_of_forward(q):
    np.testing.assert_allclose(ARM.jacobian(q), finite_difference(ARM.forward, q), atol=1e-8)
    np.testing.assert_allclose(ARM.chain().jacobian(q), ARM.jacobian(q), atol=1e-12)


@given(joints(HANDLE.limits))
def test_jacobian_of_the_hand_piece(q):
    np.testing.assert_allclose(HANDLE.jacobian(q), finite_difference(HANDLE.forward, q), atol=1e-8)


@given(joints(ARM.limits))
def test_inverse_of_forward_lands_on_the_same_pose(q):
    solution = ARM.inverse(ARM.forward(q), q)
    np.testing.assert_allclose(ARM.forward(solution), ARM.forward(q), atol=1e-7)
    if abs(q[1]) > 1e-3:
        np.testing.assert_allclose(solution, q, atol=1e-8)


@given(tips, st.floats(-4.6, 4.6), elbows)
def test_pivot_keeps_the_trocar_and_reaches_the_documented_cone(tip, roll, elbow):
    q = ARM.inverse_pivot(tip, roll, RCM, [0, elbow, 0, 0, 0, 0])
    np.testing.assert_allclose(ARM.forward(q)[:3, 3], tip, atol=1e-12)
    assert ARM.rcm_deviation(q, RCM) < 1e-12
    assert ARM.limit_violation(q) == ""
    assert q[5] == roll
    shaft = ARM.forward(q)[:3, 2]
    assert shaft @ (tip - RCM) > 0.0  # from the trocar to the tip


@given(tips, elbows, st.lists(st.floats(-1, 1), min_size=4, max_size=4))
def test_rates_of_the_pivot_jacobian_move_the_inverse(tip, elbow, rates):
    tip = RCM + 0.98 * (tip - RCM) - [0.0, 0.0, 0.002]  # off the edge of the workspace
    near = [0, elbow, 0, 0, 0, 0]
    q = ARM.inverse_pivot(tip, 0.0, RCM, near)
    step, rates = 1e-6, np.array([*rates[:3], 0.0])
    ahead = ARM.inverse_pivot(tip + step * rates[:3], 0.0, RCM, q)
    behind = ARM.inverse_pivot(tip - step * rates[:3], 0.0, RCM, q)
    slope = (ahead - behind) / (2 * step)
    moved = ARM.pivot_jacobian(q, RCM) @ rates
    np.testing.assert_allclose(moved[:5], slope[:5], rtol=1e-5, atol=1e-5)


@given(st.tuples(*[st.floats(-0.4, 0.4)] * 3), elbows)
def test_what_cannot_be_reached_is_refused_by_name_and_nothing_else_is(tip, elbow):
    tip = np.array(tip)
    try:
        q = ARM.inverse_pivot(tip, 0.0, RCM, [0, elbow, 0, 0, 0, 0])
    except saras.KinematicsError as error:
        assert " = " in str(error) and "must be in [" in str(error)
    else:
        assert ARM.reachable(tip, RCM)
        np.testing.assert_allclose(ARM.forward(q)[:3, 3], tip, atol=1e-9)


@given(tips, st.integers(0, 5))
def test_nan_is_named_never_answered(tip, i):
    q = mesa.home()
    q[i] = np.nan
    with pytest.raises(saras.KinematicsError, match=mesa.JOINT_NAMES[i]):
        ARM.forward(q)
    with pytest.raises(saras.KinematicsError, match="must be finite"):
        ARM.inverse_pivot(tip, 0.0, RCM, q)


@given(joints(HANDLE.limits))
def test_hand_piece_inverse_of_forward(q):
    pose = HANDLE.forward(q)
    np.testing.assert_allclose(HANDLE.inverse(pose), q, atol=1e-9)
    np.testing.assert_allclose(HANDLE.inverse_position(pose[:3, 3], q[2]), q, atol=1e-9)


@given(joints(HANDLE.limits))
def test_touch_points_at_what_it_cannot_reach(q):
    pose = HANDLE.forward(q)
    pose[:3, 3] *= 4.0
    assert np.isfinite(simball.touch_joints_from_handle(pose)).all()


def test_touch_refuses_nan():
    with pytest.raises(ValueError, match="finite"):
        simball.touch_joints_from_handle(np.full((4, 4), np.nan))
