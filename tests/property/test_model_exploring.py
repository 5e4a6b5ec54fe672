"""Where to touch next: both costs, costs of others that fail, and the paths' bounds."""

from __future__ import annotations

import threading
from importlib import metadata

import numpy as np
import pytest

import saras
from saras import sim
from saras.model import StiffnessMap, exploring
from saras.model.exploring import CostError, TrajectoryOptimizer
from saras.sim.palpation import Phantom, along_path, palpate

DT, HALF_M = 5e-3, 0.02


@pytest.fixture
def phantom():
    return Phantom(sim.TissueConfig(inclusion_x_m=0.008, inclusion_y_m=0.004))


def optimizer(model, phantom, cost, **options):
    return TrajectoryOptimizer(model, phantom.surface, [-HALF_M] * 2, [HALF_M] * 2, cost=cost, **options)


def explored(phantom, cost, paths, seed):
    """A map after some paths, and how far its stiffest known vertex is from the inclusion."""
    model, at = StiffnessMap(), np.full(2, -HALF_M)
    plans = optimizer(model, phantom, cost, seed=seed)
    for i in range(paths):
        plan = plans.next(at)
        assert plan.error is None
        assert (np.abs(plan.corners) <= HALF_M + 1e-12).all()
        np.testing.assert_allclose(plan.corners[0], at)
        np.testing.assert_allclose(phantom.depth(plan.points), 0.0, atol=1e-9)
        recorded = palpate(phantom, along_path(plan.corners, 0.01, DT), DT, seed=seed * 100 + i)
        model.partial_fit(recorded.positions, recorded.forces, recorded.velocities)
        at = plan.corners[-1]
    side = np.linspace(-HALF_M, HALF_M, 21)
    vertices = phantom.surface(np.array([(x, y) for x in side for y in side]))
    found = model.estimate(vertices)
    sure = found.known & (found.stiffness_std_N_m < 200.0)
    stiffest = vertices[np.argmax(np.where(sure, found.stiffness_N_m, -np.inf))]
    return found, np.linalg.norm(stiffest - phantom.inclusion)


def test_the_upper_confidence_bound_finds_the_inclusion(phantom):
    assert np.median([explored(phantom, "upper_confidence", 12, seed)[1] for seed in range(3)]) < 4e-3


def test_variance_makes_all_of_it_known(phantom):
    few, _ = explored(phantom, "variance", 3, 1)
    many, _ = explored(phantom, "variance", 20, 1)
    assert many.known.mean() > 0.9 > few.known.mean()


@pytest.mark.parametrize("cost", ["lump", "upper_confidence", "variance"])
def test_paths_keep_to_where_the_tip_may_go(phantom, cost):
    def inside(across):
        return across * np.minimum(1.0, 0.01 / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12))

    plans = optimizer(StiffnessMap(), phantom, cost, inside=inside)
    for start in ([0.0, 0.0], [0.01, 0.0], [0.0, -0.01]):
        plan = plans.next(start)
        assert (np.linalg.norm(plan.corners, axis=1) <= 0.01 + 1e-9).all() and np.ptp(plan.corners, axis=0).max() > 5e-4


def test_a_found_lump_leaves_the_rest_to_the_upper_confidence_bound(phantom):
    search = exploring.LumpSearch()
    plans = optimizer(StiffnessMap(), phantom, search)
    asked = []
    search.judge = lambda paths: asked.append(1) or -paths.sum((1, 2))
    plans.next([0.0, 0.0])
    assert len(asked) == 6
    search.survey = lambda *known: setattr(search, "found", True)
    assert plans.next([0.0, 0.0]).error is None and len(asked) == 6


def test_a_users_cost_is_followed(phantom):
    def towards_the_corner(estimates, points):
        return -points[:, :, :2].sum(axis=(1, 2))

    plan = optimizer(StiffnessMap(), phantom, towards_the_corner).next([0.0, 0.0])
    assert plan.error is None and (plan.corners[-1] > 0.005).all()


@pytest.mark.parametrize(
    ("cost", "said"),
    [
        (lambda estimates, points: 1 / 0, "raised ZeroDivisionError"),
        (lambda estimates, points: "cheap", "raised ValueError"),
        (lambda estimates, points: np.zeros(3), "gave shape"),
        (lambda estimates, points: np.full(len(points), np.nan), "0 of them finite"),
    ],
)
def test_a_cost_that_fails_is_named_and_the_loop_goes_on(phantom, cost, said):
    plans = optimizer(StiffnessMap(), phantom, cost)
    for _ in range(3):
        plan = plans.next([0.0, 0.0])
        assert isinstance(plan.error, CostError) and said in str(plan.error)
        assert np.isfinite(plan.points).all() and len(plan.points) > 3


def test_a_cost_that_hangs_is_named_and_not_called_again(phantom):
    release, calls = threading.Event(), []

    def hangs(estimates, points):
        calls.append(1)
        release.wait(60)
        return np.zeros(len(points))

    plans = optimizer(StiffnessMap(), phantom, hangs, time_limit_s=0.2)
    assert "no answer within time_limit_s" in str(plans.next([0.0, 0.0]).error)
    assert "still busy" in str(plans.next([0.0, 0.0]).error)
    assert len(calls) == 1
    release.set()


def test_costs_by_name(monkeypatch):
    assert exploring.find_cost("variance") is exploring.variance
    entry = metadata.EntryPoint("mine", "saras.model.exploring:upper_confidence", exploring.ENTRY_POINTS)
    monkeypatch.setattr(exploring, "entry_points", lambda group: [entry] if group == exploring.ENTRY_POINTS else [])
    assert exploring.find_cost("mine") is exploring.upper_confidence
    assert isinstance(exploring.find_cost("lump"), exploring.LumpSearch)
    with pytest.raises(saras.ConfigError, match=r"cost = 'theirs': must be one of .*mine"):
        exploring.find_cost("theirs")


def test_bad_settings_are_refused_by_name(phantom):
    for options in ({"step_m": 0.0}, {"spacing_m": np.nan}, {"time_limit_s": -1.0}, {"corners": 0}, {"candidates": 1}):
        with pytest.raises(saras.ConfigError, match=next(iter(options))):
            optimizer(StiffnessMap(), phantom, "variance", **options).next([0.0, 0.0])
