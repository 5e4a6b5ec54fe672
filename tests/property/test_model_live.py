"""The live map: learned, bent, refreshed, kept; and regions on a mesh."""

from __future__ import annotations

import time
from typing import Callable

import numpy as np
import pytest
from scipy.spatial import ConvexHull
from scipy.spatial.transform import Rotation

from saras import ConfigError
from saras.model import Mesh
from saras.model.live import Bending, LiveMap, refine
from saras.model.region import Region
from saras.sim import TissueConfig
from saras.sim.palpation import Phantom, palpate, raster_path

COUNT = 9


def grid_triangles(count: int) -> np.ndarray:
    corner = [i * count + j for i in range(count - 1) for j in range(count - 1)]
    parts = [((a, a + count, a + count + 1), (a, a + count + 1, a + 1)) for a in corner]
    return np.array(parts, dtype=np.int32).reshape(-1, 3)


def bent_prior() -> Mesh:
    side = np.linspace(-0.024, 0.024, COUNT)
    x, y = (axis.reshape(-1) for axis in np.meshgrid(side, side, indexing="ij"))
    return Mesh(np.column_stack([x, y, 0.0015 + 0.0015 * np.sin(60.0 * x) + 0.02 * y]), grid_triangles(COUNT))


@pytest.fixture(scope="module")
def phantom() -> Phantom:
    return Phantom(TissueConfig(base_T_surface=np.eye(4), inclusion_x_m=0.006, inclusion_y_m=-0.004))


@pytest.fixture(scope="module")
def recorded(phantom):
    return palpate(phantom, raster_path(0.03, 3e-3, 0.01, 0.01), 0.01)


DT = 0.01


def learn(live: LiveMap, recorded, begin: int = 0, end: int | None = None) -> None:
    part = slice(begin, len(recorded) if end is None else end)
    stamps = DT * np.arange(len(recorded))[part]
    live.learn(stamps, recorded.positions[part], recorded.forces[part], recorded.velocities[part])


def wait_for(there: Callable[[], bool]) -> None:
    end = time.monotonic() + 120.0
    while not there():
        assert time.monotonic() < end
        time.sleep(1e-3)


def learned(recorded, bending: Bending | None = None, prior: Mesh | None = None) -> LiveMap:
    live = LiveMap(refine(bent_prior() if prior is None else prior, 2000), bending=bending)
    learn(live, recorded)
    return live


def test_the_mesh_is_laid_to_what_was_touched_and_the_untouched_stays_unknown(phantom, recorded) -> None:
    live = learned(recorded)
    before = live.laid.vertices
    for _ in range(3):
        assert live.bend(live.snapshot()) < 5e-4
    laid = live.refresh()
    inside = (np.abs(laid.vertices[:, :2]) < 0.013).all(1)
    assert np.sqrt((phantom.depth(laid.vertices[inside]) ** 2).mean()) < 3e-4
    assert np.sqrt((phantom.depth(before[inside]) ** 2).mean()) > 1e-3
    known = np.isfinite(laid.stiffness_N_m)
    assert known[inside].all()
    assert (np.isfinite(laid.stiffness_std_N_m) == known).all()
    path = recorded.positions
    away = np.array([((path - v) ** 2).sum(1).min() ** 0.5 for v in laid.vertices])
    assert not known[away > live.config.law.local.radius_m + 1.5e-3].any()


@pytest.mark.parametrize("seed", range(10))
def test_a_prior_that_lies_elsewhere_is_laid_as_a_whole_and_does_not_slide_unseen(phantom, recorded, seed) -> None:
    rng = np.random.default_rng(seed)
    side = np.linspace(-0.03, 0.03, COUNT)
    x, y = (axis.reshape(-1) for axis in np.meshgrid(side, side, indexing="ij"))
    flat = np.column_stack([x, y, np.zeros(COUNT**2)])
    turned = Rotation.from_rotvec([*np.deg2rad(rng.uniform(-8, 8, 2)), 0.0]).as_matrix()
    prior = Mesh(flat @ turned.T + [0.0, 0.0, rng.uniform(-5e-3, 5e-3)], grid_triangles(COUNT))
    live = learned(recorded, Bending(bent_m=2e-4), prior)  # believed to be hardly bent
    for _ in range(3):
        assert live.bend(live.snapshot()) < 5e-4
    found = live.base_T_prior
    # What the whole was off is found by the whole, not by bending; along the surface nothing was seen, nothing moved.
    assert np.linalg.norm(Rotation.from_matrix(found[:3, :3] @ turned).as_rotvec()[:2]) < np.deg2rad(2.0)
    assert np.abs(found[:3, :3] @ np.zeros(3) + found[:3, 3])[:2].max() < 2e-3
    outer = np.abs(live.laid.vertices[:, :2]).max(1) > 0.025
    assert np.abs(live.laid.vertices[outer][:, 2]).max() < 1.5e-3  # the untouched part follows


def test_bending_alone_is_to_be_had(recorded) -> None:
    live = learned(recorded, Bending(shift_m=0.0))
    live.bend(live.snapshot())
    np.testing.assert_array_equal(live.base_T_prior, np.eye(4))


def test_threads_say_what_the_callers_own_would(recorded) -> None:
    stepped, threaded = LiveMap(refine(bent_prior(), 2000)), LiveMap(refine(bent_prior(), 2000))
    learn(stepped, recorded)
    threaded.start()
    stamps = DT * np.arange(len(recorded))
    for begin in range(0, len(recorded), 500):
        part = slice(begin, begin + 500)
        dropped = threaded.push(
            stamps[part], recorded.positions[part], recorded.forces[part], recorded.velocities[part]
        )
        assert dropped == 0
        wait_for(lambda: threaded.statistics().waiting <= 1000)
    wait_for(lambda: threaded.statistics().learning.count == len(recorded))
    threaded.stop()
    assert threaded.failure == ""
    a, b = threaded.refresh(), stepped.refresh()
    np.testing.assert_array_equal(a.stiffness_N_m, b.stiffness_N_m)
    np.testing.assert_array_equal(a.stiffness_std_N_m, b.stiffness_std_N_m)
    assert threaded.statistics().verdicts == stepped.statistics().verdicts


def test_what_was_asked_before_a_reset_does_not_come_back(recorded) -> None:
    live = learned(recorded)
    old = live.snapshot()
    live.refresh()
    live.reset()
    live.refresh()
    assert live.bend(old) is None
    assert np.isnan(live.laid.stiffness_N_m).all()
    assert live.statistics().places == 0


def test_a_kept_map_is_shown_until_it_is_touched(tmp_path, recorded) -> None:
    live = learned(recorded)
    live.bend(live.snapshot())
    live.refresh()
    kept = live.stiff_mesh()
    other = LiveMap(bent_prior())
    other.take(kept)
    np.testing.assert_array_equal(other.laid.stiffness_N_m, kept.stiffness_N_m)
    other.refresh()
    np.testing.assert_array_equal(other.laid.stiffness_N_m, kept.stiffness_N_m)
    other.reset()
    np.testing.assert_array_equal(other.laid.vertices, kept.vertices)
    assert np.isnan(other.laid.stiffness_N_m).all()


def test_the_offset_in_free_air_is_taken_and_a_drift_named() -> None:
    live = LiveMap(bent_prior())
    at, rest, stamps = np.tile([0.0, 0.0, 0.03], (300, 1)), np.zeros((300, 3)), DT * np.arange(300)
    assert set(live.learn(stamps, at, rest + np.array([0.0, 0.0, 0.2]), rest)) == {"NOT_TOUCHING"}
    np.testing.assert_allclose(live.statistics().bias_N, [0.0, 0.0, 0.2], atol=1e-2)
    assert "SENSOR_DRIFT" in live.learn(stamps + 3.0, at, rest + np.array([0.0, 0.0, 3.0]), rest)


def test_refining_keeps_the_surface() -> None:
    coarse = bent_prior()
    fine = refine(coarse, 3000)
    assert len(coarse.vertices) < len(fine.vertices) <= 3000
    np.testing.assert_array_equal(fine.vertices[: len(coarse.vertices)], coarse.vertices)
    assert coarse.closest(fine.vertices)[3].max() < 1e-18
    assert refine(coarse, 1).triangles.shape == coarse.triangles.shape


@pytest.mark.parametrize("seed", range(20))
def test_a_region_is_the_hull_of_its_corners(seed) -> None:
    rng = np.random.default_rng(seed)
    mesh = bent_prior()
    corners = np.column_stack([rng.uniform(-0.012, 0.012, (8, 2)), np.zeros(8)])
    region = Region(corners, mesh)
    assert region.normal[2] > 0.9
    hull = ConvexHull(corners[:, :2])
    points = np.column_stack([rng.uniform(-0.015, 0.015, (200, 2)), np.zeros(200)])
    beyond = (points[:, :2] @ hull.equations[:, :2].T + hull.equations[:, 2]).max(1)
    clear = np.abs(beyond) > 1e-9
    np.testing.assert_array_equal(region.contains(points)[clear], (beyond < 0.0)[clear])
    surface = region.surface(region.chart(points))
    assert region.contains(surface, 3e-4).all()
    assert mesh.closest(surface)[3].max() < 1e-16
    moved = region.inside(region.chart(points))
    dense = np.concatenate(
        [
            a + t * (b - a)
            for t in np.linspace(0, 1, 400)[:, None, None]
            for a, b in [(region.corners, np.roll(region.corners, -1, axis=0))]
        ]
    )
    for point, to in zip(region.chart(points)[beyond > 1e-9], moved[beyond > 1e-9]):
        assert np.linalg.norm(point - to) <= np.linalg.norm(dense - point, axis=1).min() + 1e-12


def test_no_regions() -> None:
    mesh = bent_prior()
    for corners, word in (
        ([[0.0, 0.0, 0.0]] * 2, "n at least 3"),
        ([[0.0, 0.0, 0.0], [0.01, 0.0, 0.0], [0.02, 0.0, 0.0]], "must span an area"),
        ([[0.0, 0.0, np.nan], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0]], "must be finite"),
    ):
        with pytest.raises(ConfigError, match=word):
            Region(corners, mesh)


def test_the_whole_of_an_open_mesh_is_a_region_but_its_border_and_a_closed_one_has_none() -> None:
    mesh = bent_prior()
    region = Region.whole(mesh, 5e-3)
    inner = np.abs(mesh.vertices[:, :2]).max(1) < 0.016
    assert region.contains(mesh.vertices[inner]).all()
    assert not region.contains(mesh.vertices[np.abs(mesh.vertices[:, :2]).max(1) > 0.022]).any()
    corners = np.array([[0, 0, 0], [0.02, 0, 0], [0, 0.02, 0], [0, 0, 0.02]], dtype=float)
    assert (
        Region.whole(Mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], dtype=np.int32)), 0.0) is None
    )


@pytest.mark.parametrize("seed", range(20))
def test_the_stiffest_vertex_is_the_surest_one_and_never_an_unknown_one(seed) -> None:
    rng = np.random.default_rng(seed)
    laid = LiveMap(bent_prior()).laid
    assert laid.stiffest() is None  # nothing was touched
    count = len(laid.vertices)
    laid.stiffness_N_m = np.where(rng.random(count) < 0.5, np.nan, rng.uniform(100.0, 1500.0, count))
    laid.stiffness_std_N_m = np.where(np.isnan(laid.stiffness_N_m), np.inf, rng.uniform(1.0, 500.0, count))
    region = Region(rng.uniform(-0.02, 0.02, (5, 3)) * (1, 1, 0), laid.mesh) if seed % 2 else None
    there = [
        (laid.stiffness_N_m[i] - laid.stiffness_std_N_m[i], i)
        for i in range(count)
        if np.isfinite(laid.stiffness_N_m[i]) and (region is None or region.contains(laid.vertices[i], 1e-3)[0])
    ]
    assert laid.stiffest(region) == (max(there)[1] if there else None)
