"""Every distance is right, whatever the pair: by certificates and by scipy, over random and degenerate pairs."""

from __future__ import annotations

import collision_pairs as pairs
import numpy as np
import pytest

from saras.collision import DistanceStatus, Parallelepiped, capsule_capsule, capsule_parallelepiped

CHUNK = 2000
PAIRS = 10_000
SEPARATED, DEPTH = pairs.SEPARATED_TOLERANCE_M, pairs.DEPTH_TOLERANCE_M


def check_form(results):
    """What every answer must be: finite, unit normal, witnesses that belong to it."""
    distance, normal = pairs.stack(results, "distance"), pairs.stack(results, "normal")
    point_a, point_b = pairs.stack(results, "point_a"), pairs.stack(results, "point_b")
    for numbers in (distance, normal, point_a, point_b):
        assert np.isfinite(numbers).all()
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0, atol=1e-12)
    np.testing.assert_allclose(point_b - point_a, distance[:, None] * normal, atol=1e-11)
    status = [result.status for result in results]
    penetrating = np.array([s == DistanceStatus.PENETRATING for s in status])
    separated = np.array([s == DistanceStatus.SEPARATED for s in status])
    assert (distance[penetrating] < 0).all() and (distance[separated] > 0).all()
    assert (np.abs(distance[~penetrating & ~separated]) < 1e-11).all()
    return distance, normal, point_a, point_b


def normal_tolerance(gap):
    """A normal is the quotient of a difference of coordinates (error 1e-15) by its length."""
    return SEPARATED + 4e-15 / np.maximum(gap, 1e-15)


@pytest.mark.parametrize("chunk", range(PAIRS // 2 // CHUNK + 1))
def test_capsule_capsule(chunk, many):
    for repeat in range(many):
        rng = np.random.default_rng([chunk, repeat, 1])
        drawn = [pairs.capsule_pair(rng, i) for i in range(CHUNK)]
        results = [capsule_capsule(*pair) for pair in drawn]
        distance, n, pa, pb = check_form(results)
        a0, a1, ra, b0, b1, rb = (np.array(column) for column in zip(*drawn))
        gap = distance + ra + rb
        assert (gap > -1e-12).all()
        np.testing.assert_allclose(pairs.distance_to_segment(pa, a0, a1), ra, atol=SEPARATED)
        np.testing.assert_allclose(pairs.distance_to_segment(pb, b0, b1), rb, atol=SEPARATED)
        # Two planes across the normal: this proves the distance, and inside, that the translation separates.
        slack_a = pairs.segment_support(n, a0, a1) + ra - (n * pa).sum(1)
        slack_b = (n * pb).sum(1) + pairs.segment_support(-n, b0, b1) + rb
        proved = (gap > 1e-5) | (gap < 1e-12)
        tolerance = np.where(gap < 1e-12, DEPTH, normal_tolerance(gap))
        assert (np.maximum(slack_a, slack_b) <= tolerance).all()
        for i in np.flatnonzero(~proved):
            truth = pairs.least_squares_gap(a0[i], a1[i], b0[i], (b1 - b0)[i][:, None])
            assert gap[i] <= truth + SEPARATED
        # Depth: no shorter translation separates, as the axes are then still nearer than ra + rb (1-Lipschitz).
        # A few against scipy, all kinds.
        for i in range(0, CHUNK, 41):
            truth = pairs.least_squares_gap(a0[i], a1[i], b0[i], (b1 - b0)[i][:, None])
            assert abs(gap[i] - truth) <= 1e-8 and gap[i] <= truth + SEPARATED


@pytest.mark.parametrize("chunk", range(PAIRS // 2 // CHUNK + 1))
def test_capsule_parallelepiped(chunk, many):
    for repeat in range(many):
        rng = np.random.default_rng([chunk, repeat, 2])
        drawn = [pairs.box_pair(rng, i) for i in range(CHUNK)]
        shapes = [Parallelepiped(box.vertices) for *_, box in drawn]
        results = [capsule_parallelepiped(*pair[:3], shape) for pair, shape in zip(drawn, shapes)]
        distance, n, pa, pb = check_form(results)
        a0, a1, r = (np.array([pair[k] for pair in drawn]) for k in range(3))
        center = np.array([box.center for *_, box in drawn])
        edges = np.array([box.edges for *_, box in drawn])
        gap = distance + r
        np.testing.assert_allclose(pairs.distance_to_segment(pa, a0, a1), r, atol=SEPARATED)
        # point_b on the surface: by affine coordinates, in metres across the faces.
        normals = np.cross(edges[:, :, [1, 2, 0]], edges[:, :, [2, 0, 1]], axis=1)
        normals /= np.linalg.norm(normals, axis=1)[:, None, :]
        across = np.abs(np.einsum("nij,ni->nj", normals, pb - center))
        beyond = across - np.abs(np.einsum("nij,nij->nj", normals, edges)) / 2
        np.testing.assert_allclose(beyond.max(axis=1), 0.0, atol=SEPARATED)
        slack_a = pairs.segment_support(n, a0, a1) + r - (n * pa).sum(1)
        box_support = 0.5 * np.abs(np.einsum("nij,ni->nj", edges, n)).sum(1)
        slack_b = (n * pb).sum(1) - (n * center).sum(1) + box_support
        proved = gap > 1e-5
        inside = gap < 1e-12
        tolerance = np.where(inside, DEPTH, normal_tolerance(gap))
        assert (np.maximum(slack_a, slack_b) <= tolerance).all()
        for i in np.flatnonzero(~proved):
            depth = pairs.hull_depth(a0[i], a1[i], drawn[i][3])
            if depth > 0:
                assert abs(gap[i] + depth) <= DEPTH, (i, gap[i], depth)
            else:
                assert gap[i] >= -DEPTH
        for i in range(0, CHUNK, 41):
            box = drawn[i][3]
            truth = pairs.least_squares_gap(a0[i], a1[i], box.vertices[0], box.edges)
            assert abs(max(gap[i], 0.0) - truth) <= 1e-8


def test_no_direction_separates_sooner():
    """Brute force: the support of the Minkowski difference over a dense sphere of directions, then refined."""
    rng = np.random.default_rng(3)
    k = np.arange(20_000) + 0.5
    polar, around = np.arccos(1 - 2 * k / len(k)), np.pi * (1 + 5**0.5) * k
    sphere = np.column_stack([np.cos(around) * np.sin(polar), np.sin(around) * np.sin(polar), np.cos(polar)])
    checked = near_ours = 0
    for i in range(180):
        a0, a1, r, box = pairs.box_pair(rng, i)
        result = capsule_parallelepiped(a0, a1, r, box.vertices)
        if not result.distance + r < -1e-6:
            continue
        points = np.concatenate([box.vertices - a0, box.vertices - a1])
        support = (sphere @ points.T).max(axis=1)
        depth = support.min()
        for best in sphere[np.argsort(support)[:400:20]]:
            least = (points @ best).max()
            for step in 10.0 ** -np.arange(1.5, 8, 0.125):
                near = best + step * rng.normal(size=(60, 3))
                near /= np.linalg.norm(near, axis=1)[:, None]
                support = (near @ points.T).max(axis=1)
                if support.min() < least:
                    best, least = near[np.argmin(support)], support.min()
            depth = min(depth, least)
        assert -result.distance <= depth + r + 1e-12  # no direction is better than ours
        near_ours += depth + r <= -result.distance + 1e-4
        checked += 1
    # The search comes there, but for a few boxes so flat that it takes the wrong valley.
    assert checked > 60 and near_ours > 0.9 * checked


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e300])
@pytest.mark.parametrize("place", range(14))
def test_what_is_not_finite_is_unknown(bad, place):
    numbers = np.array([0, 0, 0, 0, 0, 0.1, 0.01, 0.2, 0, 0, 0.2, 0, 0.1, 0.01])
    numbers[place] = bad
    a0, a1, ra, b0, b1, rb = numbers[:3], numbers[3:6], numbers[6], numbers[7:10], numbers[10:13], numbers[13]
    results = [capsule_capsule(a0, a1, ra, b0, b1, rb)]
    if place < 7:
        results.append(capsule_parallelepiped(a0, a1, ra, pairs.Region(np.ones(3), np.eye(3)).vertices))
    for result in results:
        if bad == 1e300 and result.status != DistanceStatus.UNKNOWN:
            assert np.isfinite(result.distance)
            continue
        assert result.status == DistanceStatus.UNKNOWN
        assert np.isnan(result.distance) and np.isnan(result.point_a).all() and np.isnan(result.normal).all()


def test_negative_radius_is_unknown():
    assert capsule_capsule([0, 0, 0], [0, 0, 1], -0.1, [1, 0, 0], [1, 0, 1], 0.1).status == DistanceStatus.UNKNOWN
