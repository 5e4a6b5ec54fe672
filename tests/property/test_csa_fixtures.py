"""Virtual fixtures: closest points against brute force, and motion that never leaves what they allow."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from csa_rig import DT, Q0, motion_config
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from teleop_strategies import pose, vectors

import saras
from saras import csa
from saras.kinematics import dvrk

PSM = dvrk.psm()
UP = np.array([0.0, 0.0, 1.0])


def brute_force(vertices: np.ndarray, triangles: np.ndarray, point: np.ndarray) -> float:
    """Least distance, by projecting on planes and clamping on edges: no shared formula with the tree's."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    height = ((point - a) * normal).sum(axis=1)
    foot = point - height[:, None] * normal
    inside = np.ones(len(a), dtype=bool)
    least = np.full(len(a), np.inf)
    for start, end in ((a, b), (b, c), (c, a)):
        edge = end - start
        inside &= (np.cross(edge, foot - start) * normal).sum(axis=1) >= 0
        t = np.clip(((point - start) * edge).sum(axis=1) / (edge**2).sum(axis=1), 0, 1)
        least = np.minimum(least, np.linalg.norm(start + t[:, None] * edge - point, axis=1))
    return float(np.where(inside, np.abs(height), least).min())


def winding_number(vertices: np.ndarray, triangles: np.ndarray, point: np.ndarray) -> float:
    """Van Oosterom and Strackee 1983: 1 inside a closed mesh, 0 outside."""
    a, b, c = (vertices[triangles[:, k]] - point for k in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    volume = (a * np.cross(b, c)).sum(axis=1)
    below = la * lb * lc + (a * b).sum(axis=1) * lc + (b * c).sum(axis=1) * la + (c * a).sum(axis=1) * lb
    return float(2 * np.arctan2(volume, below).sum() / (4 * np.pi))


MESHES = {
    "box": trimesh.creation.box(extents=(0.04, 0.02, 0.01)),
    "sphere": trimesh.creation.icosphere(subdivisions=3, radius=0.02),
    "torus": trimesh.creation.torus(major_radius=0.02, minor_radius=0.008, major_sections=24, minor_sections=12),
    "spike": trimesh.creation.cone(radius=0.01, height=0.05, sections=8),
}


@pytest.mark.parametrize("name", MESHES)
def test_closest_point_and_sign(name: str, many: int) -> None:
    mesh = MESHES[name]
    vertices, triangles = np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int32)
    ours = csa.TriangleMesh(vertices, triangles)
    rng = np.random.default_rng(len(name))
    hint = -1
    for i in range(500 * many):
        point = rng.uniform(-0.04, 0.04, 3)
        if i % 5 == 0:  # at corners and edges
            point = vertices[rng.integers(len(vertices))] + rng.normal(size=3) * 1e-4
        found = ours.closest(point)
        distance = brute_force(vertices, triangles, point)
        assert abs(abs(found.distance_m) - distance) < 1e-12
        assert abs(np.linalg.norm(found.point - point) - distance) < 1e-12
        if distance > 1e-9:
            assert (found.distance_m < 0) == (winding_number(vertices, triangles, point) > 0.5), point
            assert np.abs(found.point + found.distance_m * found.normal - point).max() < 1e-8
        assert ours.closest(point, hint=hint).distance_m == found.distance_m
        hint = found.triangle
        near = ours.nearby(point, distance + 0.003)
        assert near and abs(abs(near[0].distance_m) - distance) < 1e-12
        assert ours.closest(point, 0.999 * distance).triangle == -1 or distance < 1e-9


def test_meshes_that_are_none_are_refused() -> None:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0]], dtype=float)
    for triangles, words in (([[0, 1, 9]], r"triangles\[0\] = 9"), ([[0, 1, 2], [0, 1, 3]], r"triangles\[1\]")):
        with pytest.raises(saras.ConfigError, match=words):
            csa.TriangleMesh(corners, np.array(triangles, dtype=np.int32))
    corners[1, 1] = np.nan
    with pytest.raises(saras.ConfigError, match=r"vertices\[1\]"):
        csa.TriangleMesh(corners, np.array([[0, 1, 2]], dtype=np.int32))


def fixture_at(kind: str, tip: np.ndarray) -> csa.Fixture:
    """One that the tip obeys with a little room."""
    if kind == "plane":
        return csa.Fixture.plane("f", tip - 0.002 * UP, [0, 0, 1])
    if kind == "line":
        return csa.Fixture.line("f", tip, np.array([1.0, 1.0, 0.5]) / 1.5, 0.003)
    if kind == "path":
        return csa.Fixture.path("f", tip + 0.01 * np.array([[-1, 0, 0], [0, 0, 0], [1, 1, 0], [1, 2, 1]]), 0.002)
    if kind == "hull":
        return csa.Fixture.hull("f", csa.convex_hull(tip + 0.004 * np.array(MESHES["spike"].vertices) / 0.01))
    if kind == "hull_out":
        faces = csa.convex_hull(tip - 0.008 * UP + np.array(MESHES["box"].vertices) * 0.5)
        return csa.Fixture.hull("f", faces, keep_in=False)
    vertices = np.array(MESHES["sphere"].vertices) * (0.3 if kind == "mesh_in" else 0.5)
    offset = tip if kind == "mesh_in" else tip - 0.0125 * UP
    mesh = csa.TriangleMesh(vertices + offset, np.array(MESHES["sphere"].faces, dtype=np.int32))
    return csa.Fixture.mesh("f", mesh, keep_in=kind == "mesh_in")


AT_ORIGIN = {kind: fixture_at(kind, np.zeros(3)) for kind in ("plane", "line", "hull", "mesh_out")}
KINDS = ["plane", "line", "path", "hull", "hull_out", "mesh_in", "mesh_out"]


@pytest.mark.parametrize("kind", KINDS)
def test_motion_stays_inside_whatever_is_asked(kind: str, many: int) -> None:
    """The tip is pulled about at up to 50 mm/s; what it leaves is second order in the step: v^2 dt^2 / radius."""
    rng = np.random.default_rng(KINDS.index(kind))
    for _ in range(4 * many):
        q = Q0 + rng.uniform(-0.05, 0.05, 6) * [1, 1, 0.3, 1, 1, 1]
        fixtures = csa.FixtureSet([fixture_at(kind, PSM.forward(q)[:3, 3])])
        motion = csa.ConstrainedMotion(motion_config())
        twist = np.zeros(6)
        worst = np.inf
        for i in range(300):
            if i % 40 == 0:
                twist = np.r_[rng.normal(size=3), rng.normal(size=3)]
                twist[:3] *= 0.05 / np.linalg.norm(twist[:3])
            found = fixtures.step(PSM.forward(q), DT, shaft=PSM.shaft(q))
            worst = min(worst, found.distance_m[0])
            output = motion.step(q, PSM.jacobian(q), twist, DT, fixtures=found)
            assert not csa.is_hold(output.reason), (i, output.reason)
            assert (np.abs(output.rates) <= motion.config.speed + 1e-9).all()
            if output.reason == csa.MotionReason.FIXTURE_ACTIVE:
                assert output.fixture == 0
            q = output.q
        assert worst > -5e-6, worst


def test_remote_centre_is_kept_by_an_arm_that_does_not_keep_it_by_itself(many: int) -> None:
    """The SARAS arm's own joints know no trocar; the fixture does."""
    from saras.kinematics import mesa

    arm, rcm, rng = mesa.arm(), mesa.NOMINAL_RCM, np.random.default_rng(3)
    limits = np.asarray(arm.limits)
    config = csa.ConstrainedMotionConfig(
        lower=limits[:, 0], upper=limits[:, 1], speed=[1, 1, 1, 1, 0.2, 3], lead=[1.0] * 6
    )
    for _ in range(3 * many):
        q = mesa.home()
        motion = csa.ConstrainedMotion(config)
        fixtures = csa.FixtureSet([csa.Fixture.remote_centre("trocar", rcm, 0.0002)])
        worst, travelled = 0.0, 0.0
        for i in range(400):
            if i % 100 == 0:
                twist = np.r_[rng.normal(size=3) * 0.01, 0, 0, 0]
            shaft = arm.forward(q)[:3, 2]
            found = fixtures.step(arm.forward(q), DT, shaft=shaft)
            output = motion.step(q, arm.jacobian(q), twist, DT, fixtures=found)
            assert not csa.is_hold(output.reason)
            travelled += np.linalg.norm(output.twist[:3]) * DT
            q = output.q
            worst = max(worst, arm.rcm_deviation(q, rcm))
        assert worst < 0.00025
        assert travelled > 0.001


@given(vectors(0.05), vectors(np.pi), vectors(0.02))
def test_fixtures_move_with_what_they_are_registered_to(translation, rotation, offset) -> None:
    world = pose(Rotation.from_rotvec(rotation), translation)
    for kind, one in AT_ORIGIN.items():
        still = csa.FixtureSet([one]).step(pose(Rotation.identity(), offset), DT)
        moved = csa.FixtureSet([one]).step(
            world @ pose(Rotation.identity(), offset), DT, shaft=world[:3, 2], base_T_fixtures=world
        )
        assert abs(still.distance_m[0] - moved.distance_m[0]) < 1e-9, kind
        rows = 1 if kind == "mesh_out" else len(still.rows)  # further triangles of a mesh may tie
        np.testing.assert_allclose(moved.rows[:rows, :3], still.rows[:rows, :3] @ world[:3, :3].T, atol=1e-6)
        np.testing.assert_allclose(moved.rows[:rows, 6:], still.rows[:rows, 6:], atol=1e-6)


def test_fixtures_that_contradict_each_other_hold_with_their_name() -> None:
    tip = PSM.forward(Q0)[:3, 3]
    apart = [csa.Fixture.plane("up", tip + 0.05 * UP, [0, 0, 1]), csa.Fixture.plane("down", tip, [0, 0, -1])]
    found = csa.FixtureSet(apart).step(PSM.forward(Q0), DT)
    assert found.status == saras.Status.LIMITED and found.nearest == 0
    motion = csa.ConstrainedMotion(motion_config())
    output = motion.step(Q0, PSM.jacobian(Q0), np.zeros(6), DT, fixtures=found)
    assert output.reason == csa.MotionReason.INFEASIBLE and csa.is_hold(output.reason)
    assert output.status == saras.Status.INVALID_INPUT
    assert output.fixture == 0 and np.array_equal(output.q, Q0) and not output.rates.any()
    soft = [csa.Fixture.plane("up", tip + 0.05 * UP, [0, 0, 1], soft=True), apart[1]]
    found = csa.FixtureSet(soft).step(PSM.forward(Q0), DT)
    assert not csa.is_hold(motion.step(Q0, PSM.jacobian(Q0), np.zeros(6), DT, fixtures=found).reason)


def test_a_violated_fixture_is_left_at_the_recovery_speed() -> None:
    q, motion = Q0.copy(), csa.ConstrainedMotion(motion_config())
    fixtures = csa.FixtureSet([csa.Fixture.plane("wall", PSM.forward(q)[:3, 3] + [0, 0, 0.002], [0, 0, 1])])
    heights = []
    for _ in range(400):
        found = fixtures.step(PSM.forward(q), DT)
        heights.append(found.distance_m[0])
        q = motion.step(q, PSM.jacobian(q), np.zeros(6), DT, fixtures=found).q
    speed = np.diff(heights) / DT
    assert speed.max() < motion.config.recovery_speed_m_s * 1.01
    assert abs(heights[-1]) < 1e-6


def test_region_of_interest_holds_the_points_and_is_open_above() -> None:
    rng = np.random.default_rng(4)
    for _ in range(50):
        points = np.c_[rng.uniform(-0.02, 0.02, (8, 2)), rng.normal(size=8) * 1e-3]
        turned = Rotation.random(random_state=rng).as_matrix()
        faces = csa.region_of_interest(points @ turned.T, normal=turned[:, 2])
        assert (faces[:, :3] @ (points @ turned.T).T <= faces[:, 3:] + 1e-9).all()
        assert np.abs(faces[:, :3] @ turned[:, 2]).max() < 1e-9
        assert (faces[:, :3] @ (turned @ [0.1, 0, 0]) > faces[:, 3]).any()
    for bad, words in (([[0, 0, 0], [1, 1, 1], [2, 2, 2]], "one line"), ([[0, 0, 0], [1, 1, 1]], "n >= 3")):
        with pytest.raises(saras.ConfigError, match=words):
            csa.region_of_interest(bad)
    with pytest.raises(saras.ConfigError, match="one plane"):
        csa.convex_hull([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])


@given(st.sampled_from([csa.Fixture.plane, csa.Fixture.line]), st.sampled_from([np.nan, np.inf]))
def test_bad_fixtures_are_refused_by_name(make, bad) -> None:
    with pytest.raises(saras.ConfigError, match=r"wall\.point"):
        make("wall", [0, bad, 0], [0, 0, 1])
    with pytest.raises(saras.ConfigError, match=r"wall\."):
        make("wall", [0, 0, 0], [0, 0, 0.5])
