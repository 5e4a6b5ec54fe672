"""Values at other times: oracle scipy's Slerp and interp1d, pandas' merge_asof; never across a gap."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import interp1d
from scipy.spatial.transform import Rotation, Slerp

from saras.dataset import resample

pandas = pytest.importorskip("pandas")


def series(rng, n=40):
    """Ascending times with gaps, and instants everywhere, also on samples and outside."""
    t = np.cumsum(rng.choice([0.01, 0.02, 0.3], n, p=[0.6, 0.3, 0.1]) * rng.uniform(0.5, 1.5, n))
    at = np.concatenate([rng.uniform(t[0] - 0.2, t[-1] + 0.2, 200), rng.choice(t, 20)])
    return t, at


def inside(t, at, gap_s):
    """By definition, one instant after the other."""
    flags = []
    for instant in at:
        if instant in t:
            flags.append(True)
            continue
        before, after = t[t < instant], t[t > instant]
        flags.append(bool(len(before) and len(after) and after[0] - before[-1] <= gap_s))
    return np.array(flags)


def test_linear_is_scipys_inside_and_unknown_in_gaps(many):
    rng = np.random.default_rng(1)
    for _ in range(30 * many):
        t, at = series(rng)
        values = rng.normal(size=(len(t), 3))
        result, valid = resample.linear(t, values, at, 0.1)
        np.testing.assert_array_equal(valid, inside(t, at, 0.1))
        assert np.isnan(result[~valid]).all()
        expected = interp1d(t, values, axis=0, bounds_error=False)(at)
        np.testing.assert_allclose(result[valid], expected[valid], atol=1e-9)


def test_rotations_are_scipys_slerp_whatever_their_signs(many):
    rng = np.random.default_rng(2)
    for _ in range(30 * many):
        t, at = series(rng)
        # From tiny to half a turn between neighbours.
        steps = Rotation.from_rotvec(rng.normal(size=(len(t), 3)) * 10.0 ** rng.uniform(-9, 0, (len(t), 1)))
        rotations = [Rotation.random(random_state=int(rng.integers(1 << 30)))]
        for step in steps[1:]:
            rotations.append(rotations[-1] * step)
        rotation = Rotation.concatenate(rotations)
        signs = rng.choice([-1.0, 1.0], (len(t), 1))
        result, valid = resample.slerp(t, signs * rotation.as_quat(), at, 0.1)
        np.testing.assert_array_equal(valid, inside(t, at, 0.1))
        assert np.isnan(result[~valid]).all()
        expected = Slerp(t, rotation)(at[valid])
        assert (Rotation.from_quat(result[valid]).inv() * expected).magnitude().max() < 1e-7
        np.testing.assert_allclose(np.linalg.norm(result[valid], axis=1), 1.0, atol=1e-12)
        assert (result[valid][:, 3] >= 0).all()


def test_a_quaternion_off_the_sphere_spoils_its_neighbourhood_only():
    t = np.arange(5.0)
    q = np.tile([0.0, 0.0, 0.0, 1.0], (5, 1))
    q[2] *= 1.1
    result, _ = resample.slerp(t, q, np.array([0.5, 1.5, 2.0, 2.5, 3.0, 3.5]), 1.0)
    np.testing.assert_array_equal(np.isnan(result[:, 0]), [False, True, True, True, False, False])


def test_previous_is_pandas_merge_asof(many):
    rng = np.random.default_rng(3)
    for _ in range(30 * many):
        t, at = series(rng)
        at = np.sort(at)
        place, age, valid = resample.previous(t, at, 0.1)
        left = pandas.DataFrame({"t": at})
        right = pandas.DataFrame({"t": t, "sample": t, "place": np.arange(len(t), dtype=float)})
        expected = pandas.merge_asof(left, right, on="t", tolerance=0.1)
        np.testing.assert_array_equal(valid, expected["place"].notna())
        np.testing.assert_array_equal(place[valid], expected["place"][valid])
        np.testing.assert_allclose(age[valid], at[valid] - expected["sample"][valid])
        assert np.isnan(age[at < t[0]]).all()


def test_few_samples_and_unknown_values():
    at = np.array([0.0, 1.0, 2.0])
    for n in (0, 1):
        result, valid = resample.linear(np.ones(n), np.ones((n, 2)), at, 1.0)
        np.testing.assert_array_equal(valid, [False, n == 1, False])
        assert np.isnan(result[~valid]).all()
        result, valid = resample.slerp(np.ones(n), np.tile([0.0, 0, 0, 1], (n, 1)), at, 1.0)
        np.testing.assert_array_equal(valid, [False, n == 1, False])
        _, _, valid = resample.previous(np.ones(n), at, 0.5)
        np.testing.assert_array_equal(valid, [False, n == 1, False])
    values, _ = resample.linear(np.arange(3.0), np.array([[0.0], [np.nan], [2.0]]), np.array([0.0, 0.5, 1.5, 2.0]), 1.0)
    np.testing.assert_array_equal(np.isnan(values[:, 0]), [False, True, True, False])


def test_stamps_far_from_their_reception_and_doubled_ones_are_left_out():
    t = np.array([0.0, 0.1, 3600.0, 0.2, 0.2, 0.15, np.nan])
    received = np.array([0.0, 0.1, 0.15, 0.2, 0.21, 0.22, 0.3])
    order, dropped = resample.usable(t, received, 5.0)
    assert dropped == 2
    np.testing.assert_array_equal(order, [0, 1, 5, 4])


def test_signs_do_not_jump_and_rotations_stay(many):
    rng = np.random.default_rng(9)
    for _ in range(20 * many):
        smooth = Rotation.from_rotvec(np.cumsum(rng.normal(0, 0.05, (100, 3)), axis=0)).as_quat()
        smooth[rng.random(100) < 0.1] = np.nan
        signs = rng.choice([-1.0, 1.0], (100, 1))
        result = resample.continuous(signs * smooth)
        known = np.isfinite(smooth[:, 0])
        np.testing.assert_array_equal(np.isfinite(result[:, 0]), known)
        np.testing.assert_array_equal(np.abs(result[known]), np.abs(smooth[known]))
        assert (np.sum(np.diff(result[known], axis=0) ** 2, axis=1) < 1.0).all()
