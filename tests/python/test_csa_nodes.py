"""Parts of the csa nodes that need no graph."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("rospy")
from saras_ros1.msg import CsaAdmittance, CsaStiffness, CsaTeleopState
from scipy.spatial.transform import Rotation
from sensor_msgs.msg import JointState
from visualization_msgs.msg import Marker

from saras import ConfigError, csa
from saras_ros1 import csa_markers as markers
from saras_ros1.csa_exploring import Exploring
from saras_ros1.csa_node import DT_MAX_S, Pace, joint_reader
from saras_ros1.inputs import Tick
from saras_ros1.nodes.csa_slave import in_base, palpation, read_stiffness
from saras_ros1.nodes.csa_teleop import axes_with_z
from saras_ros1.stiffness_under_tip import StiffnessUnderTip

MS = 1_000_000


def test_pace_thins_out_what_is_too_fast_and_bounds_what_is_late() -> None:
    pace = Pace(0.01)
    assert pace(Tick(0.01, False, 0)) == 0.01
    assert [pace(Tick(0.002, False, t * MS)) for t in (2, 4)] == [None, None]
    assert pace(Tick(0.002, False, 8 * MS)) == pytest.approx(0.008)
    assert pace(Tick(5.0, False, 5000 * MS)) == DT_MAX_S
    assert pace(Tick(0.01, False, 100 * MS)) == 0.01  # a clock that was set back
    assert pace(Tick(0.01, True, 0)) == 0.01


def test_joints_are_found_by_place_or_by_name() -> None:
    message = JointState(name=["x", "b", "a"], position=[9.0, 2.0, 1.0], velocity=[0.9, 0.2, 0.1])
    np.testing.assert_array_equal(joint_reader(2, ["a", "b"])(message).q, [1.0, 2.0])
    np.testing.assert_array_equal(joint_reader(2, ["a", "b"])(message).v, [0.1, 0.2])
    np.testing.assert_array_equal(joint_reader(2)(message).q, [9.0, 2.0])
    assert np.isnan(joint_reader(3)(JointState(position=[1.0, 2.0, 3.0])).v).all()
    for bad in (JointState(position=[1.0]), JointState(position=[np.nan, 0.0])):
        with pytest.raises(ValueError, match="must be 2"):
            joint_reader(2)(bad)
    with pytest.raises(ValueError, match="c"):
        joint_reader(1, ["c"])(message)


def test_exploring_is_bounded_in_speed_and_stays_in_the_surface() -> None:
    rng, exploring = np.random.default_rng(1), Exploring(0.01)
    hand, normal, target = np.zeros(3), np.array([0.0, 0.6, 0.8]), np.array([0.02, 0.01, 0.0])
    before = exploring.offset.copy()
    for i in range(2000):
        goal = target if i < 1000 else None
        offset = exploring.step(hand, goal, normal, 0.01 * rng.uniform(0.5, 1.5))
        assert np.linalg.norm(offset - before) <= 0.01 * 0.015 + 1e-12
        assert abs(offset @ normal) < 1e-12
        before = offset.copy()
        if i == 999:
            np.testing.assert_allclose(offset, target - normal * (normal @ target), atol=1e-12)
    np.testing.assert_allclose(before, 0.0, atol=1e-12)
    exploring.offset = np.array([0.01, 0.0, 0.0])
    np.testing.assert_array_equal(exploring.step(hand, target, np.zeros(3), 0.01), [0.01, 0.0, 0.0])  # no normal


def test_wrenches_of_the_tip_and_frames_of_the_model() -> None:
    for seed in range(50):
        turn = Rotation.random(random_state=seed).as_matrix()
        pose = np.eye(4)
        pose[:3, :3] = turn
        wrench = np.random.default_rng(seed).normal(size=6)
        np.testing.assert_allclose(in_base(wrench, pose), np.r_[turn @ wrench[:3], turn @ wrench[3:]])
        axes = axes_with_z(turn[:, 0])
        np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
        np.testing.assert_allclose(axes[:, 2], turn[:, 0])
        assert np.linalg.det(axes) == pytest.approx(1.0)


def test_what_is_not_known_is_refused() -> None:
    with pytest.raises(ConfigError, match="kind = 'rub'"):
        palpation("rub", 0.0, 1.0)


def slave_law() -> csa.SlaveMlc:
    motion = csa.ConstrainedMotionConfig(
        lower=np.full(6, -1.0), upper=np.ones(6), speed=np.ones(6), lead=np.full(6, 0.1)
    )
    return csa.SlaveMlc(csa.SlaveMlcConfig(motion=motion, period_s=0.01, admittance_m_Ns=0.05))


def test_an_estimate_raises_the_gain_only_as_far_as_two_deviations_allow() -> None:
    rng, law = np.random.default_rng(3), slave_law()
    least = law.admittance(np.nan)
    assert law.admittance(300.0) > least == law.admittance(law.config.stiffness_max_N_m)
    for _ in range(2000):
        stiffness, std = rng.uniform(20.0, 3000.0), rng.uniform(0.0, 1000.0)
        gain = law.admittance(read_stiffness(CsaStiffness(stiffness_N_m=stiffness, std_N_m=std)))
        assert least <= gain <= law.admittance(stiffness + 2.0 * std) + 1e-12
    for bad in ((0.0, 0.0), (-1.0, 0.0), (np.nan, 1.0), (np.inf, 1.0), (300.0, np.nan), (300.0, np.inf), (300.0, -1.0)):
        bound = read_stiffness(CsaStiffness(stiffness_N_m=bad[0], std_N_m=bad[1]))
        assert np.isnan(bound) and law.admittance(bound) == least


def test_what_is_under_the_tip_is_known_only_where_all_around_it_is() -> None:
    rng, law = np.random.default_rng(4), slave_law()
    side = np.linspace(-0.02, 0.02, 41)
    vertices = np.array([(x, y, 0.0) for x in side for y in side])
    for _ in range(300):
        stiffness, std = rng.uniform(200.0, 1500.0, len(vertices)), rng.uniform(1.0, 300.0, len(vertices))
        hole = np.linalg.norm(vertices[:, :2] - rng.uniform(-0.02, 0.02, 2), axis=1) < rng.uniform(0.0, 0.01)
        stiffness[hole], std[hole] = np.nan, np.inf
        under = StiffnessUnderTip(reach_m=0.003, depth_m=0.01)
        assert np.isnan(under.at(np.zeros(3))[0])
        under.take_map(vertices, stiffness, std)
        tip = np.r_[rng.uniform(-0.025, 0.025, 2), -rng.uniform(0.0, 0.012)]
        across = np.linalg.norm(vertices[:, :2] - tip[:2], axis=1)
        found = under.at(tip)
        gain = law.admittance(read_stiffness(CsaStiffness(stiffness_N_m=found[0], std_N_m=found[1])))
        if np.isfinite(found[0]):
            assert across.min() <= 0.003 + 1e-12
            near = across**2 <= across.min() ** 2 + 0.003**2
            assert not hole[near].any()
            # Never more than the stiffest of what is near would allow.
            assert gain <= law.admittance((stiffness + 2.0 * std)[near].max()) + 1e-12
        else:
            assert gain == law.admittance(np.nan)
            assert hole[across <= 0.0045].any() or across.min() > 0.002 or tip[2] < -0.0099
    under.take_touched(np.arange(len(vertices)), np.full(len(vertices), 400.0), np.full(len(vertices), 10.0))
    assert under.at(np.array([0.0, 0.0, -0.003])) == (400.0, 10.0)
    under.take_touched(np.array([len(vertices)]), np.array([1.0]), np.array([1.0]))  # of another mesh
    assert under.at(np.array([0.0, 0.0, -0.003])) == (400.0, 10.0)
    assert np.isnan(under.at(np.full(3, np.nan))[0])
    under.forget()
    assert np.isnan(under.at(np.zeros(3))[0])


def test_markers_show_what_is_known_and_take_away_what_is_not() -> None:
    from geometry_msgs.msg import Point, WrenchStamped

    corners = [Point(x, y, 0.0) for x, y in ((0, 0), (1, 0), (0.5, 0.5), (1, 1), (0, 1))]
    assert [(p.x, p.y) for p in markers.hull(corners)] == [(0, 0), (1, 0), (1, 1), (0, 1)]
    dots, walls, border = markers.region("base", corners, closed=True)
    assert len(dots.points) == 5 and len(walls.points) == 4 * 12 and len(border.points) == 4 * 6
    assert {m.action for m in markers.region("base", [], closed=False)} == {Marker.DELETE}
    push = WrenchStamped()
    push.wrench.force.z = 2.0
    arrow = markers.force("base", Point(0, 0, 1), push)
    assert arrow.points[1].z - arrow.points[0].z == pytest.approx(2.0 * markers.METRES_PER_N)
    assert markers.force("base", None, push).action == Marker.DELETE
    push.wrench.force.z = float("nan")
    assert markers.force("base", Point(0, 0, 1), push).action == Marker.DELETE
    assert markers.label("base", np.zeros(3), None, None).text == "?"
    told = CsaTeleopState(state=3, hold=True, reason="FORCE_UNKNOWN: nothing from /x")
    shown = markers.label("base", np.zeros(3), told, None)
    assert shown.text.startswith("HOLD in FULL CONTACT") and shown.color == markers.RED
    told.hold = False
    assert (
        "2.0 N of 1.9 N"
        in markers.label("base", np.zeros(3), told, CsaAdmittance(normal_force_N=2.01, desired_force_N=1.92)).text
    )
