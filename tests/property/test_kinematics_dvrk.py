"""What holds for every pose of the da Vinci's arms, against the dVRK's table multiplied out with numpy and scipy."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import saras
from saras.kinematics import dvrk

PSM = dvrk.psm()
DRAWS = 1000  # times --many; 100 gives the 1e5 of the acceptance run
HALF = np.pi / 2
TIP = np.array([[0, -1, 0], [0, 0, 1], [-1, 0, 0]])


def row(alpha, a, theta, d):
    """Modified DH: Rot_x(alpha) Trans_x(a) Rot_z(theta) Trans_z(d)."""
    pose = np.eye(4)
    about_x = Rotation.from_euler("x", alpha).as_matrix()
    pose[:3, :3] = about_x @ Rotation.from_euler("z", theta).as_matrix()
    pose[:3, 3] = np.array([a, 0, 0]) + about_x @ [0, 0, d]
    return pose


def product(rows, tip):
    pose = np.eye(4)
    for one in rows:
        pose = pose @ row(*one)
    pose[:3, :3] = pose[:3, :3] @ tip
    return pose


def psm_table(q, insertion=0.4318, length=0.4162, wrist=0.0091):
    rows = [
        (HALF, 0, q[0] + HALF, 0),
        (-HALF, 0, q[1] - HALF, 0),
        (HALF, 0, 0, q[2] - insertion),
        (0, 0, q[3], length),
        (-HALF, 0, q[4] - HALF, 0),
        (-HALF, wrist, q[5] - HALF, 0),
    ]
    return product(rows, TIP)


def ecm_table(q, view_deg):
    tip = np.array([[0, 1, 0], [-1, 0, 0], [0, 0, 1]]) @ Rotation.from_euler("x", view_deg, degrees=True).as_matrix()
    rows = [(HALF, 0, q[0] + HALF, 0), (-HALF, 0, q[1] - HALF, 0), (HALF, 0, 0, q[2] - 0.3822), (0, 0, q[3], 0.3829)]
    return product(rows, tip)


def random_joints(arm, count, seed):
    lower, upper = arm.limits.T
    return np.random.default_rng(seed).uniform(lower, upper, (count, len(lower)))


def joints(arm, margin=1e-5):
    return st.tuples(*(st.floats(lower + margin, upper - margin) for lower, upper in arm.limits)).map(np.array)


def finite_difference(forward, q, step=1e-6):
    columns = []
    for i in range(len(q)):
        h = np.zeros(len(q))
        h[i] = step
        columns.append(saras.displacement(forward(q - h), forward(q + h)) / (2 * step))
    return np.array(columns).T


@pytest.mark.parametrize(
    ("q", "point"),
    [([0, 0, 0.1, 0, 0, 0], (0, 0, -0.0935)), ([0.3, -0.2, 0.15, 0.5, 0.4, -0.3], (0.039913, 0.025318, -0.134778))],
)
def test_check_values_of_the_large_needle_driver(q, point):
    np.testing.assert_allclose(PSM.forward(q)[:3, 3], point, atol=1e-6)


@pytest.mark.parametrize(
    ("tool", "body", "insertion", "length", "wrist"),
    [
        ("400006", "classic", 0.4318, 0.4162, 0.0091),
        ("LARGE_NEEDLE_DRIVER:420006", "classic", 0.4318, 0.4670, 0.0091),
        ("LARGE_NEEDLE_DRIVER:420006[12]", "si", 0.4826, 0.4670, 0.0091),
        ("400093", "classic", 0.4318, 0.4162, 0.0107),
        ("420172", "si", 0.4826, 0.4670, 0.0107),
        ("400194", "classic", 0.4318, 0.4162, 0.0112),
        ("420309", "si", 0.4826, 0.4670, 0.0100),
        ("400183", "classic", 0.4318, 0.4162, 0.0093),
    ],
)
def test_forward_is_the_product_of_the_table(tool, body, insertion, length, wrist):
    arm = dvrk.psm(tool, body)
    for q in random_joints(arm, 100, 1):
        np.testing.assert_allclose(arm.forward(q), psm_table(q, insertion, length, wrist), atol=1e-12)
        np.testing.assert_allclose(np.cross(arm.wrist_position(q), arm.shaft(q)), 0, atol=1e-15)


@pytest.mark.parametrize(("endoscope", "view_deg"), [("straight", 0), ("up", -30), ("down", 30)])
def test_endoscope_is_the_product_of_the_table(endoscope, view_deg):
    for body in ("classic", "si"):
        arm = dvrk.ecm(endoscope, body)
        for q in random_joints(arm, 100, 2):
            np.testing.assert_allclose(arm.forward(q), ecm_table(q, view_deg), atol=1e-12)
            np.testing.assert_allclose(arm.inverse(arm.forward(q), q), q, atol=1e-7)


def test_inverse_of_forward_is_the_identity(many):
    for arm in (PSM, dvrk.psm("420194", "si")):
        for q in random_joints(arm, DRAWS * many, 3):
            np.testing.assert_allclose(arm.inverse(arm.forward(q), q), q, atol=1e-7)


def test_inverse_of_forward_near_singularities(many):
    random = np.random.default_rng(4)
    lower, upper = PSM.limits.T
    behind = 0.4162 - 0.4318
    for q in random_joints(PSM, DRAWS * many, 5):
        off = random.choice([-1, 1]) * 10 ** random.uniform(-14, -3)
        kind = random.integers(4)
        if kind == 0:  # the wrist in the remote centre
            q[2] = off - behind
        elif kind == 1:  # the tip on the wrist's yaw axis through the remote centre
            q[4] = random.uniform(-0.9, 0.9)
            q[2] = off - 0.0091 / np.cos(q[4]) - behind
        elif kind == 2:  # wrist bent to its ends
            q[4:] = random.choice([-1, 1], 2) * (upper[4:] - abs(off))
        else:  # straight, at the end of something
            q[4:] = off, -off
            i = random.integers(4)
            q[i] = random.choice([lower[i], upper[i]])
        q = np.clip(q, lower, upper)
        solution = PSM.inverse(PSM.forward(q), q)
        np.testing.assert_allclose(solution, q, atol=1e-6)
        np.testing.assert_allclose(PSM.forward(solution), PSM.forward(q), atol=1e-8)


@given(joints(PSM), joints(PSM))
def test_from_anywhere_the_inverse_lands_on_the_pose_inside_the_limits(q, q0):
    solution = PSM.inverse(PSM.forward(q), q0)
    np.testing.assert_allclose(PSM.forward(solution), PSM.forward(q), atol=1e-7)
    assert PSM.limit_violation(solution) == ""


@given(joints(PSM))
def test_jacobian_is_the_derivative_of_forward(q):
    np.testing.assert_allclose(PSM.jacobian(q), finite_difference(PSM.forward, q), atol=1e-8)


@given(joints(dvrk.ecm("up")))
def test_jacobian_of_the_endoscope(q):
    arm = dvrk.ecm("up")
    np.testing.assert_allclose(arm.jacobian(q), finite_difference(arm.forward, q), atol=1e-8)


@given(st.tuples(*[st.floats(-0.5, 0.5)] * 3), st.tuples(*[st.floats(-3, 3)] * 3))
def test_what_cannot_be_reached_is_refused_by_name_and_nothing_else_is(point, turn):
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_rotvec(turn).as_matrix()
    pose[:3, 3] = point
    try:
        q = PSM.inverse(pose, [0, 0, 0.1, 0, 0, 0])
    except saras.KinematicsError as error:
        assert str(error).split(" ")[0] in dvrk.PSM_JOINT_NAMES and "must be in [" in str(error)
    else:
        np.testing.assert_allclose(PSM.forward(q), pose, atol=1e-7)


def test_a_rotation_that_four_joints_do_not_reach():
    arm = dvrk.ecm()
    q = np.array([0.2, 0.1, 0.1, 0.3])
    pose = arm.forward(q)
    pose[:3, :3] = pose[:3, :3] @ Rotation.from_euler("y", 0.2).as_matrix()
    with pytest.raises(saras.KinematicsError, match=r"rotation .* = 0.2: must be in \[0, 1e-06\]"):
        arm.inverse(pose, q)
    np.testing.assert_allclose(arm.inverse(pose, q, rotation_tolerance_rad=np.pi), q, atol=1e-9)
    assert arm.rotation_error(pose, q) == pytest.approx(0.2)


def test_wrong_pairings_and_unknown_names_are_refused():
    with pytest.raises(saras.ConfigError, match=r"400006.*Si body.*50.8 mm"):
        dvrk.psm("400006", "si")
    assert dvrk.psm("420006", "classic").config.tool_length_m == 0.4670
    with pytest.raises(saras.ConfigError, match=r"tool = 'LARGE_NEEDLE_DRIVER': .*LARGE_NEEDLE_DRIVER:400006"):
        dvrk.psm("LARGE_NEEDLE_DRIVER")
    with pytest.raises(saras.ConfigError, match="body = 'xi': must be one of classic, si"):
        dvrk.psm(body="xi")
    with pytest.raises(saras.ConfigError, match="endoscope = 'left'"):
        dvrk.ecm("left")
    assert PSM.joint_names == list(dvrk.PSM_JOINT_NAMES) and dvrk.ecm().joint_names == list(dvrk.ECM_JOINT_NAMES)


@given(st.integers(0, 5), st.sampled_from([np.nan, np.inf]))
def test_what_is_not_finite_is_named(i, value):
    q = np.array([0, 0, 0.1, 0, 0, 0])
    pose = PSM.forward(q)
    q[i] = value
    for call in (PSM.forward, PSM.jacobian, lambda q: PSM.inverse(pose, q)):
        with pytest.raises(saras.KinematicsError, match=dvrk.PSM_JOINT_NAMES[i]):
            call(q)
    pose[0, 3] = value
    with pytest.raises(saras.KinematicsError, match="finite"):
        PSM.inverse(pose, [0, 0, 0.1, 0, 0, 0])
