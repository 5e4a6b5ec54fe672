"""What the hand feels of fixtures: the way back against trimesh, one-sided, without a step, in every contact state."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

import saras
from saras import csa

DT = 0.001
UP = np.array([0.0, 0.0, 1.0])
SEED = st.integers(0, 10**6)


def at(point: np.ndarray) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, 3] = point
    return pose


def random_hull(rng: np.random.Generator) -> tuple[csa.FixtureSet, trimesh.Trimesh]:
    points = rng.uniform(-0.02, 0.02, size=(rng.integers(5, 16), 3))
    fixtures = csa.FixtureSet([csa.Fixture.hull("region", csa.convex_hull(points))])
    return fixtures, trimesh.convex.convex_hull(points)


@given(SEED)
def test_the_way_back_is_the_shortest(seed: int) -> None:
    rng = np.random.default_rng(seed)
    fixtures, mesh = random_hull(rng)
    law = csa.BorderWrench(csa.BorderWrenchConfig(force_limit_N=100.0))
    tips = rng.uniform(-0.04, 0.04, size=(20, 3))
    closest, _, _ = trimesh.proximity.closest_point_naive(mesh, tips)
    in_front = ((tips[:, None] - mesh.triangles_center) * mesh.face_normals).sum(axis=2)
    for tip, expected, inside in zip(tips, closest, (in_front <= 0.0).all(axis=1)):
        out = law.step(fixtures.step(at(tip), DT), np.zeros(3), DT)
        way = np.zeros(3) if inside else expected - tip
        np.testing.assert_allclose(out.way, way, atol=1e-6)
        np.testing.assert_allclose(out.wrench[:3], 300.0 * way, atol=1e-3)
        assert not out.wrench[3:].any()


@given(SEED)
def test_it_is_one_sided_bounded_and_without_a_step(seed: int) -> None:
    """A path at random over the border and back; the change of force is at most stiffness times way."""
    rng = np.random.default_rng(seed)
    fixtures, _ = random_hull(rng)
    config = csa.BorderWrenchConfig(damping_N_s_m=0.0)
    law, damped = csa.BorderWrench(config), csa.BorderWrench(csa.BorderWrenchConfig(damping_N_s_m=20.0))
    tip, velocity, before = rng.uniform(-0.02, 0.02, 3), np.zeros(3), None
    for _ in range(300):
        velocity = 0.97 * velocity + 0.01 * rng.normal(size=3) - 0.2 * tip
        moved = velocity * 0.005
        tip = tip + moved
        found = fixtures.step(at(tip), DT)
        out, slowed = law.step(found, velocity, DT), damped.step(found, velocity, DT)
        for one in (out, slowed):
            assert np.linalg.norm(one.wrench) <= config.force_limit_N + 1e-9
            assert one.wrench[:3] @ one.way >= 0.0
            assert np.isclose(one.wrench[:3] @ one.way, np.linalg.norm(one.wrench) * np.linalg.norm(one.way), atol=1e-9)
        inside = found.distance_m[0] >= 0.0
        assert not inside or not (out.wrench.any() or slowed.wrench.any())
        if before is not None:
            assert np.linalg.norm(out.wrench[:3] - before) <= 300.0 * np.linalg.norm(moved) + 1e-3
        before = np.array(out.wrench[:3])


def test_contradicting_fixtures_and_bad_input_give_no_force() -> None:
    walls = [csa.Fixture.plane("up", [0, 0, 0.01], UP), csa.Fixture.plane("down", [0, 0, -0.01], -UP)]
    found = csa.FixtureSet(walls).step(np.eye(4), DT)
    law = csa.BorderWrench(csa.BorderWrenchConfig())
    out = law.step(found, np.zeros(3), DT)
    assert out.status == saras.Status.LIMITED and not out.wrench.any() and not out.way.any()
    found = csa.FixtureSet(walls[:1]).step(np.eye(4), DT)
    assert law.step(found, np.full(3, np.nan), DT).status == saras.Status.INVALID_INPUT
    assert law.step(found, np.zeros(3), 5.0).status == saras.Status.INVALID_TIME_STEP
    assert not law.step(None, np.zeros(3), DT).wrench.any()
    np.testing.assert_allclose(law.step(found, np.zeros(3), DT).wrench[:3], 3.0 * UP, atol=1e-6)
    with pytest.raises(saras.ConfigError, match="stiffness_N_m"):
        csa.BorderWrench(csa.BorderWrenchConfig(stiffness_N_m=0.0))


def test_a_remote_centre_is_not_felt_at_the_tip() -> None:
    fixtures = csa.FixtureSet([csa.Fixture.remote_centre("trocar", [0.01, 0.0, 0.1], 0.0)])
    found = fixtures.step(np.eye(4), DT, shaft=-UP)
    assert found.distance_m[0] < -0.005
    assert not csa.BorderWrench(csa.BorderWrenchConfig()).step(found, np.zeros(3), DT).wrench.any()


@given(SEED, st.booleans())
def test_it_is_felt_in_every_state_with_the_ramp_and_not_under_the_clutch(seed: int, clutch: bool) -> None:
    rng = np.random.default_rng(seed)
    config = csa.CsaTeleopConfig(debounce_s=0.0)
    law, pose = csa.CsaTeleop(config), np.eye(4)
    border, wall = np.r_[rng.normal(size=3), np.zeros(3)], np.r_[rng.normal(size=3), np.zeros(3)]
    before, states = np.zeros(6), set()
    for i in range(1200):
        force, depth = (2.0 if i // 300 in (1, 3) else 0.0), (0.003 if i // 300 in (2, 3) else -0.003)
        out = law.step(pose, pose, pose, DT, force, depth, UP, wall, clutch=clutch, fixture_wrench=border)
        assert not out.hold
        assert np.linalg.norm(out.wrench[:3] - before[:3]) <= config.force_limit_N * DT / config.ramp_s + 1e-9
        before = np.array(out.wrench)
        if i % 300 == 299:
            states.add(out.state)
            expected = np.zeros(6) if clutch else border + (wall if depth > 0.0 else 0.0)
            expected = expected * min(1.0, config.force_limit_N / max(np.linalg.norm(expected), 1e-12))
            np.testing.assert_allclose(out.wrench, expected, atol=1e-9)
    assert len(states) == 4
    spoilt = law.step(pose, pose, pose, DT, 0.0, -1.0, UP, wall, fixture_wrench=np.full(6, np.nan))
    assert spoilt.hold
