"""One test for each defect of the source's listings (SPEC §5): each fails on the listing and must pass here."""

from __future__ import annotations

import numpy as np
import pytest

from saras.collision import DistanceStatus, Scene, capsule_capsule, capsule_parallelepiped
from saras.collision.forbidden_regions import box_vertices
from saras.kinematics.scene import pose_from_xyz_rpy

CUBE = box_vertices([0, 0, 0], [2, 2, 2])
ORIGIN, X, Y, Z = np.zeros(3), *np.eye(3)


def test_each_tool_has_its_own_distance():
    """``distance_tr = dist_temp1``: the right tool got the left tool's distance."""
    tools = [([2, 0, 0], [20, 0, 0], 0.1), ([0, 4, 0], [0, 40, 0], 0.2), ([0, 0, 8], [0, 0, 80], 0.3)]
    found = Scene(tools, [CUBE]).distances()
    np.testing.assert_allclose([d.distance for d in found], [0.9, 2.8, 6.7])


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("side", [-1, 1])
def test_each_axis_and_side_counts(axis, side):
    """``dx`` assigned where dy and dz belong: beyond a face of y or z the distance was wrong."""
    tip = 3.0 * side * np.eye(3)[axis] + 0.3 * np.eye(3)[axis - 1]
    result = capsule_parallelepiped(tip, tip, 0.1, CUBE)
    assert result.distance == pytest.approx(1.9, abs=1e-12)
    np.testing.assert_allclose(result.normal, -side * np.eye(3)[axis], atol=1e-12)


def test_a_turned_box_away_from_the_origin():
    """``inv * s - origin`` instead of ``inv * (s - origin)``: right for boxes at the origin or not turned only."""
    rotation = pose_from_xyz_rpy([0, 0, 0], [0.3, -0.7, 1.1])[:3, :3]
    center = np.array([0.4, -0.2, 0.7])
    vertices = box_vertices(center, [0.2, 0.4, 0.6], rotation)
    tip = center + rotation @ [0.1 + 0.05, 0.1, 0.1]
    result = capsule_parallelepiped(tip, tip + rotation @ [0.5, 0, 0], 0.01, vertices)
    assert result.distance == pytest.approx(0.04, abs=1e-12)
    np.testing.assert_allclose(result.point_b, center + rotation @ [0.1, 0.1, 0.1], atol=1e-12)


@pytest.mark.parametrize("pitch", [np.pi / 2, -np.pi / 2])
def test_no_detour_over_roll_pitch_yaw(pitch):
    """Axes → roll, pitch, yaw → rotation lost boxes at pitch = ±90° (and multiplied in another order than it took)."""
    for roll, yaw in [(0.4, 0.0), (0.0, -1.2), (0.4, -1.2)]:
        rotation = pose_from_xyz_rpy([0, 0, 0], [roll, pitch, yaw])[:3, :3]
        vertices = box_vertices([0.1, 0.2, 0.3], [0.2, 0.4, 0.6], rotation)
        tip = np.array([0.1, 0.2, 0.3]) + rotation @ [0.0, 0.0, 0.3 + 0.07]
        assert capsule_parallelepiped(tip, tip, 0.02, vertices).distance == pytest.approx(0.05, abs=1e-12)


def test_inside_the_distance_is_the_depth():
    """Inside, the listing always said −r, however deep."""
    for depth in (0.1, 0.4, 0.9):
        tip = (1.0 - depth) * X
        assert capsule_parallelepiped(tip, tip, 0.05, CUBE).distance == pytest.approx(-(depth + 0.05), abs=1e-12)


def test_touching_can_be_reached():
    """Status 0 could not be returned: distance < SMALL_NUM gave −1 first."""
    assert capsule_parallelepiped([1.1, 0, 0], [2, 0, 0], 0.1, CUBE).status == DistanceStatus.TOUCHING
    assert capsule_capsule(ORIGIN, Z, 0.1, 0.3 * X, 0.3 * X + Z, 0.2).status == DistanceStatus.TOUCHING


def test_the_deepest_counts_not_the_first_hit():
    """Early return: the first end or edge that hit ended the search, and the region's later ones were not seen."""
    # End a barely inside by a face; end b deep.
    assert capsule_parallelepiped(0.95 * X, 0.2 * X, 0.1, CUBE).distance == pytest.approx(-0.9, abs=1e-12)
    found = Scene([(0.95 * X, 0.95 * X, 0.0)], [box_vertices(0.96 * X, [0.1, 0.1, 0.1]), CUBE + 0.5 * X]).distances()
    assert (found[0].index, found[0].distance) == (1, pytest.approx(-0.55))


@pytest.mark.parametrize(
    "result",
    [
        capsule_capsule(X, X + Z, 0.1, 2 * X, 2 * X + Z, 0.1),  # parallel: (0, 0, 0) in the listing
        capsule_capsule(X, X + Z, 0.1, X, X + Z, 0.1),
        capsule_capsule(X - Y, X + Y, 0.1, X - Z, X + Z, 0.1),  # crossing: returned before they were computed
        capsule_capsule(X, X, 0.1, 3 * X, 3 * X, 0.1),
        capsule_parallelepiped(5 * X, 5 * X + Z, 0.1, CUBE + 2 * X),
        capsule_parallelepiped(2 * X, 2 * X + Z, 0.1, CUBE + 2 * X),
    ],
)
def test_witnesses_are_never_zero_by_default(result):
    for point in (result.point_a, result.point_b):
        assert np.isfinite(point).all() and np.linalg.norm(point) > 0.5
    assert np.linalg.norm(result.normal) == pytest.approx(1.0)
    np.testing.assert_allclose(result.point_b, result.point_a + result.distance * result.normal, atol=1e-12)


def test_an_axis_that_pierces_a_face_with_both_ends_outside_is_a_collision():
    """Only ends against faces and axis against edges were looked at: straight through two faces was 'free'."""
    result = capsule_parallelepiped(-3 * Z, 3 * Z, 0.01, CUBE)
    assert result.status == DistanceStatus.PENETRATING
    assert result.distance == pytest.approx(-1.01, abs=1e-12)


def test_regions_follow_the_live_transform():
    """The transform of the bones was fetched once."""
    scene = Scene([(ORIGIN, 0.1 * Z, 0.0)], [CUBE])
    moved = np.eye(4)
    for x in (2.0, 3.0, 1.5):
        moved[0, 3] = x
        assert scene.distances(base_T_regions=moved)[0].distance == pytest.approx(x - 1.0)


def test_random_poses_miss_no_collision():
    """The listing missed 44–46 % of true collisions on random poses. Truth: a dense sample of the axis."""
    rng = np.random.default_rng(1)
    collisions = 0
    for _ in range(2000):
        rotation = pose_from_xyz_rpy([0, 0, 0], rng.uniform(-3, 3, 3))[:3, :3]
        center, size = rng.uniform(-0.5, 0.5, 3), rng.uniform(0.05, 0.5, 3)
        a, b = rng.uniform(-0.7, 0.7, (2, 3))
        local = (a + np.linspace(0, 1, 200)[:, None] * (b - a) - center) @ rotation
        gap = np.linalg.norm(np.maximum(np.abs(local) - size / 2, 0), axis=1).min()
        result = capsule_parallelepiped(a, b, 0.01, box_vertices(center, size, rotation))
        if gap <= 0.01:
            collisions += 1
            assert result.distance <= 1e-12
        if result.distance > 0:
            assert result.distance <= gap - 0.01 + 1e-12
    assert collisions > 100
