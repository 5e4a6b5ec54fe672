"""Compliance wrench against algorithm 1 in numpy; walls; half turns. Master torques against a closed form."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from teleop_strategies import FAULTY_DT, pose, poses, spoilt, turn, vectors

import saras
from saras import csa
from saras.kinematics import Chain, Joint, JointType

DT = 0.01
FREE = {"force_limit_N": 1e6, "torque_limit_Nm": 1e6, "walls_never_pull": False}


def gains(draw: st.DrawFn, sign: float) -> csa.ComplianceGains:
    positive = st.lists(st.floats(0.0, 500.0), min_size=3, max_size=3).map(np.array)
    return csa.ComplianceGains(
        stiffness_N_m=sign * draw(positive), damping_N_s_m=sign * draw(positive) / 50.0,
        force_bias_N=draw(vectors(2.0)),
        rotation_stiffness_Nm_rad=sign * draw(positive) / 500.0, torque_bias_Nm=draw(vectors(0.1)),
    )  # fmt: skip


def algorithm_1(low, high, handle, twist, frame):
    r_c = frame[:3, :3]
    eps, v = r_c.T @ (handle[:3, 3] - frame[:3, 3]), r_c.T @ twist[:3]
    theta = Rotation.from_matrix(r_c.T @ handle[:3, :3]).as_rotvec()
    g, tau = np.zeros(3), np.zeros(3)
    for i in range(3):
        side = low if eps[i] <= 0 else high
        g[i] = side.force_bias_N[i] + side.stiffness_N_m[i] * eps[i] + side.damping_N_s_m[i] * v[i]
        turned = low if theta[i] <= 0 else high
        tau[i] = turned.torque_bias_Nm[i] + turned.rotation_stiffness_Nm_rad[i] * theta[i]
    return np.r_[r_c @ g, r_c @ tau], theta


@given(st.data(), poses(0.1), vectors(0.2, 6), poses(0.1))
def test_as_printed_is_algorithm_1(data, handle, twist, frame) -> None:
    low, high = gains(data.draw, -1.0), gains(data.draw, -1.0)
    law = csa.ComplianceWrench(
        csa.ComplianceConfig(convention=csa.ComplianceConvention.AS_PRINTED, negative=low, positive=high, **FREE)
    )
    output = law.step(handle, twist, frame, DT)
    expected, theta = algorithm_1(low, high, handle, twist, frame)
    np.testing.assert_allclose(output.wrench[:3], expected[:3], atol=1e-8)
    if np.linalg.norm(theta) < np.pi - 1e-6:  # at a half turn either sign is right
        np.testing.assert_allclose(output.wrench[3:], expected[3:], atol=1e-6)


@given(st.data(), poses(0.1), vectors(0.2, 6), poses(0.1))
def test_positive_stiffness_is_the_same_with_signs_turned(data, handle, twist, frame) -> None:
    low, high = gains(data.draw, 1.0), gains(data.draw, 1.0)
    ours = csa.ComplianceWrench(csa.ComplianceConfig(negative=low, positive=high, **FREE)).step(
        handle, twist, frame, DT
    )
    for side in (low, high):
        side.stiffness_N_m, side.damping_N_s_m = -side.stiffness_N_m, -side.damping_N_s_m
        side.rotation_stiffness_Nm_rad = -side.rotation_stiffness_Nm_rad
    printed = csa.ComplianceConfig(convention=csa.ComplianceConvention.AS_PRINTED, negative=low, positive=high, **FREE)
    np.testing.assert_allclose(ours.wrench, csa.ComplianceWrench(printed).step(handle, twist, frame, DT).wrench)


@given(vectors(0.05), vectors(1.0), poses(0.1), st.floats(1.0, 2000.0), st.floats(0.0, 100.0), st.floats(0.0, 0.002))
def test_a_one_sided_wall_never_pulls(offset, velocity, frame, stiffness, damping, deadband) -> None:
    """However fast the hand leaves: the force is outward or zero, and there is none on the free side."""
    wall = csa.ComplianceGains(stiffness_N_m=[0, 0, stiffness], damping_N_s_m=[0, 0, damping])
    law = csa.ComplianceWrench(csa.ComplianceConfig(negative=wall, deadband_m=deadband))
    handle = frame.copy()
    handle[:3, 3] += frame[:3, :3] @ offset
    output = law.step(handle, np.r_[frame[:3, :3] @ velocity, 0, 0, 0], frame, DT)
    force = frame[:3, :3].T @ output.wrench[:3]
    assert force[2] >= -1e-12
    assert np.abs(force[:2]).max() < 1e-9
    if offset[2] > 1e-12:
        assert np.abs(force).max() < 1e-9


@given(vectors(1.0).filter(lambda v: np.linalg.norm(v) > 0.1), st.floats(-1e-7, 1e-7), poses(0.1))
def test_half_turns_give_a_bounded_restoring_torque(axis, beyond, frame) -> None:
    axis = axis / np.linalg.norm(axis)
    turned = turn(frame) * Rotation.from_rotvec(axis * (np.pi + beyond))
    spring = csa.ComplianceGains(rotation_stiffness_Nm_rad=[0.01] * 3)
    law = csa.ComplianceWrench(csa.ComplianceConfig(negative=spring, positive=spring))
    output = law.step(pose(turned, frame[:3, 3]), np.zeros(6), frame, DT)
    assert output.status == saras.Status.OK
    assert abs(np.linalg.norm(output.wrench[3:]) - 0.01 * np.pi) < 1e-6
    assert abs(abs(frame[:3, :3] @ axis @ output.wrench[3:]) - 0.01 * np.pi) < 1e-5


@given(st.data(), FAULTY_DT)
def test_bad_input_is_no_force_and_a_name(data, dt) -> None:
    spring = csa.ComplianceGains(stiffness_N_m=[300.0] * 3)
    law = csa.ComplianceWrench(csa.ComplianceConfig(negative=spring, positive=spring))
    output = law.step(data.draw(spoilt(np.eye(4))), np.zeros(6), np.eye(4), dt)
    assert output.status in (saras.Status.INVALID_INPUT, saras.Status.INVALID_TIME_STEP)
    assert not output.wrench.any()


def test_gains_that_would_push_away_are_refused() -> None:
    with pytest.raises(saras.ConfigError, match=r"negative\.stiffness_N_m"):
        csa.ComplianceConfig(negative=csa.ComplianceGains(stiffness_N_m=[0, -1, 0]))


def pendulum(lengths: tuple[float, float]) -> list[Joint]:
    """Two revolute joints about y, links along x."""
    second = np.eye(4)
    second[0, 3] = lengths[0]
    return [
        Joint(name=f"j{i}", link=f"l{i}", type=JointType.REVOLUTE, parent_T_joint=at, axis=[0, 1, 0], lower=-4, upper=4)
        for i, at in enumerate((np.eye(4), second))
    ]


@given(vectors(3.0, 2), st.floats(0.1, 3.0), st.floats(0.1, 3.0))
def test_gravity_of_a_double_pendulum(q, m1, m2) -> None:
    """Closed form: torque_i = -sum of m g x_ij for a rotation about +y, which turns x towards -z."""
    model = csa.GravityModel(pendulum((0.3, 0.2)), [m1, m2], [[0.1, 0, 0], [0.15, 0, 0]])
    x1, x_joint = 0.1 * np.cos(q[0]), 0.3 * np.cos(q[0])
    x2 = x_joint + 0.15 * np.cos(q[0] + q[1])
    expected = -9.81 * np.array([m1 * x1 + m2 * x2, m2 * (x2 - x_joint)])
    np.testing.assert_allclose(model.torque(q), expected, atol=1e-9)


@given(st.data(), vectors(2.0, 2), vectors(5.0, 6), vectors(0.5, 2))
def test_master_torque_is_the_sum_within_limits(data, q, wrench, external) -> None:
    chain = Chain(pendulum((0.3, 0.2)))
    gravity = csa.GravityModel(pendulum((0.3, 0.2)), [0.2, 0.1], [[0.1, 0, 0], [0.1, 0, 0]])
    limit = np.array([2.0, 1.0])
    law = csa.MasterMlc(csa.MasterMlcConfig(torque_limit=limit), gravity)
    jacobian = chain.jacobian(q)
    output = law.step(q, jacobian, wrench, 0.001, external_torque=external)
    added, held = jacobian.T @ wrench + external, gravity.torque(q)
    room = np.where(added > 0, limit - held, limit + held)
    scale = min(1.0, (room / np.maximum(np.abs(added), 1e-300)).min())
    np.testing.assert_allclose(output.torque, held + scale * added, atol=1e-9)
    assert (np.abs(output.torque) <= limit + 1e-9).all()
    bad = law.step(q, jacobian, data.draw(spoilt(wrench)), 0.001)
    assert np.isfinite(bad.torque).all()
    stale = law.step(q, jacobian, wrench, 0.001, wrench_stale=True)
    np.testing.assert_allclose(stale.torque, held)
