"""Meshes, most likely points, registration and bending: beside trimesh, ICP and the truth of seeded draws."""

from __future__ import annotations

import numpy as np
import pytest
import registration_draws as draws
import trimesh

import saras
from saras.model import DeformationGrid, Mesh, register, register_rigid

VERTICES, TRIANGLES = draws.organ(1, subdivisions=3)


@pytest.fixture(scope="module")
def mesh():
    return Mesh(VERTICES, TRIANGLES)


def brute_force(vertices, points):
    """Distances to the nearest of all triangles, each by trimesh."""
    corners, distances = vertices[TRIANGLES], []
    for point in points:
        nearest = trimesh.triangles.closest_point(corners, np.tile(point, (len(corners), 1)))
        distances.append(np.linalg.norm(nearest - point, axis=1).min())
    return np.array(distances)


def test_most_likely_points_are_trimeshs_closest_ones_in_the_whitened_space(mesh, many):
    for seed in range(10 * many):
        rng = np.random.default_rng(seed)
        points = rng.uniform(-0.09, 0.09, (40, 3))
        axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        covariance = axes @ np.diag(rng.uniform(0.3e-3, 5e-3, 3) ** 2) @ axes.T
        found, triangles, weights, squared = mesh.likely(points, np.tile(covariance, (len(points), 1, 1)))
        whitening = np.linalg.cholesky(np.linalg.inv(covariance)).T
        distance = brute_force(VERTICES @ whitening.T, points @ whitening.T)
        np.testing.assert_allclose(np.sqrt(squared), distance, rtol=1e-6, atol=1e-9)
        on_mesh = (VERTICES[TRIANGLES[triangles]] * weights[:, :, None]).sum(1)
        np.testing.assert_allclose(found, on_mesh, atol=1e-12)
        assert (weights >= -1e-12).all()
        np.testing.assert_allclose(weights.sum(1), 1.0, atol=1e-12)
        _, _, _, squared = mesh.closest(points)
        distance = brute_force(VERTICES, points)
        np.testing.assert_allclose(np.sqrt(squared), distance, rtol=1e-6, atol=1e-9)


def test_without_noise_it_finds_the_pose(mesh):
    for seed in range(5):
        rng = np.random.default_rng(seed)
        truth = draws.rigid(rng, (0, 180), (0.0, 0.5))
        points = draws.on_surface(VERTICES, TRIANGLES, rng, 100) @ truth[:3, :3].T + truth[:3, 3]
        start = truth @ draws.rigid(rng, (5, 15), (0.005, 0.015))
        found = register_rigid(mesh, points, base_T_mesh=start, tolerance_m=1e-9, max_iterations=1000)
        assert found.converged and found.rms_m < 1e-5
        assert draws.target_error_m(VERTICES, np.linalg.inv(truth) @ found.base_T_mesh) < 2e-5


def errors(mesh, name, seeds, **icp):
    along, across, outliers, gate = draws.PROTOCOL[name]
    ours, theirs = [], []
    for seed in seeds:
        one = draws.draw(VERTICES, TRIANGLES, seed, along, across, outliers)
        found = register_rigid(mesh, one.points, one.covariances, one.start, gate=gate, tolerance_m=1e-6)
        ours.append(draws.target_error_m(VERTICES, found.base_T_mesh))
        found = register_rigid(mesh, one.points, base_T_mesh=one.start, most_likely=False, max_iterations=1000)
        theirs.append(draws.target_error_m(VERTICES, found.base_T_mesh))
    return np.array(ours), np.array(theirs)


def test_it_is_better_than_icp_where_noise_has_directions_and_gross_errors(mesh, many):
    ours, theirs = errors(mesh, "noise_2_0.5mm", range(20 * many))
    assert ours.mean() / theirs.mean() < 0.85
    ours, theirs = errors(mesh, "outliers_20", range(20 * many))
    assert ours.mean() / theirs.mean() < 0.35
    assert (ours < 5e-3).all()


def test_it_is_icp_where_noise_has_no_direction(mesh):
    ours, theirs = errors(mesh, "isotropic_1mm", range(10))
    np.testing.assert_allclose(ours, theirs, atol=1e-4)


def test_its_covariance_holds_what_it_says(mesh, many):
    inside = []
    for seed in range(60 * many):
        one = draws.draw(VERTICES, TRIANGLES, seed, 1e-3, 1e-3, 0.0, count=150)
        found = register_rigid(mesh, one.points, one.covariances, np.eye(4), gate=1e9)
        middle = np.eye(4)
        middle[:3, 3] = one.points.mean(0)
        off = saras.displacement(found.base_T_mesh @ middle, middle)
        inside.append(off @ np.linalg.solve(found.covariance, off) < 12.592)
    assert np.mean(inside) > 0.85


def test_bending_finds_the_shape(mesh):
    grid = DeformationGrid(mesh, 0.03)
    for seed in range(4):
        rng = np.random.default_rng(seed)
        truth = draws.bent(VERTICES, seed, 0.01)
        points = draws.on_surface(truth, TRIANGLES, rng, 300) + rng.normal(0, 0.5e-3, (300, 3))
        points[:15] *= 1.6
        covariances = np.tile(0.25e-6 * np.eye(3), (300, 1, 1))
        found = grid.deform(points, covariances)
        before, after = (np.sqrt(Mesh(truth, TRIANGLES).closest(v)[3]).mean() for v in (VERTICES, found.vertices))
        assert after < 0.5e-3 and after < 0.35 * before
        used = np.array(found.used)
        assert used[:15].mean() < 0.2 and used[15:].mean() > 0.9
        np.testing.assert_allclose(grid.apply(found.displacements), found.vertices, atol=1e-12)
        again = grid.deform(points, covariances, start=found.displacements)
        assert again.rounds <= found.rounds
        assert np.linalg.norm(again.vertices - found.vertices, axis=1).mean() < 2e-4


def test_what_is_not_bent_stays(mesh):
    rng = np.random.default_rng(1)
    points = draws.on_surface(VERTICES, TRIANGLES, rng, 300) + rng.normal(0, 0.3e-3, (300, 3))
    found = DeformationGrid(mesh, 0.03).deform(points, np.tile(0.09e-6 * np.eye(3), (300, 1, 1)))
    assert np.linalg.norm(found.vertices - VERTICES, axis=1).mean() < 0.6e-3
    assert np.isfinite(found.vertices).all()


def test_laid_and_bent(mesh):
    rng = np.random.default_rng(2)
    truth = draws.bent(VERTICES, 2, 0.006)
    base_T_mesh = draws.rigid(rng, (5, 10), (0.01, 0.02))
    points = draws.on_surface(truth, TRIANGLES, rng, 400) @ base_T_mesh[:3, :3].T + base_T_mesh[:3, 3]
    found = register(mesh, points, None, gate=1e9, grid=DeformationGrid(mesh, 0.03))
    there = truth @ base_T_mesh[:3, :3].T + base_T_mesh[:3, 3]
    assert np.sqrt(Mesh(there, TRIANGLES).closest(found.vertices)[3]).mean() < 0.5e-3


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda v, t: (v[:0], t), "empty"),
        (lambda v, t: (v, t[:0]), "empty"),
        (lambda v, t: (np.where(np.arange(len(v))[:, None] == 7, np.nan, v), t), "vertex 7: must be finite"),
        (lambda v, t: (v, np.where(np.arange(len(t))[:, None] == 3, len(v), t)), "triangle 3: vertex"),
        (lambda v, t: (v, np.where(np.arange(len(t))[:, None] == 3, t[3, 0], t)), "triangle 3: must have an area"),
        (lambda v, t: (v, np.concatenate([t, t[:1]])), "non-manifold"),
        (lambda v, t: (v, np.concatenate([t[:-1], t[-1:, ::-1]])), "non-manifold"),
        (lambda v, t: (1e3 * v, t), "millimetres"),
    ],
)
def test_bad_meshes_are_refused_by_name(change, said):
    with pytest.raises(saras.ModelError, match=said):
        Mesh(*change(VERTICES, TRIANGLES))


def test_bad_points_are_refused_by_name(mesh):
    points = VERTICES[:50].copy()
    for bad, covariances, said in (
        (points[:2], None, "points: 2: must be at least 3"),
        (np.where(np.arange(50)[:, None] == 4, np.nan, points), None, "points: 4: must be finite"),
        (1e3 * points, None, "another unit"),
        (points, np.zeros((50, 3, 3)), "positive definite"),
    ):
        with pytest.raises(saras.ModelError, match=said):
            register_rigid(mesh, bad, covariances)
        with pytest.raises(saras.ModelError, match=said):
            DeformationGrid(mesh, 0.04).deform(bad, covariances)
    with pytest.raises(saras.ModelError, match="start"):
        DeformationGrid(mesh, 0.04).deform(points, start=np.zeros((3, 3)))
    with pytest.raises(saras.ConfigError, match="spacing_m"):
        DeformationGrid(mesh, 0.0)
    with pytest.raises(saras.ConfigError, match="gate"):
        register_rigid(mesh, points, gate=-1.0)
    assert mesh.closed and not Mesh(VERTICES, TRIANGLES[:-1]).closed
