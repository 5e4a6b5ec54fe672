"""saras.model beside scikit-learn, the phantom's truth and plain counting."""

from __future__ import annotations

import numpy as np
import palpation_draws as draws
import pytest
from scipy import stats
from scipy.optimize import check_grad, minimize

import saras
from saras import sim
from saras.model import (
    EstimateStatus,
    GpHyperparameters,
    HashGrid,
    HashGridConfig,
    LocalGp,
    LocalModelConfig,
    SampleVerdict,
    StiffnessGp,
    StiffnessGpConfig,
    StiffnessMap,
    learn_hyperparameters,
)
from saras.sim.palpation import Phantom, palpate, raster_path


def test_local_gp_is_scikit_learns(many):
    for seed in range(60 * many):
        rng = np.random.default_rng(seed)
        h, axes, origin = draws.hyperparameters(rng), draws.frame(rng), rng.normal(0, 0.1, 3)
        count = int(rng.integers(2, 60))
        inputs = np.column_stack([rng.uniform(-8e-3, 8e-3, (count, 3)), rng.uniform(-0.02, 0.02, count)])
        values, noise = rng.normal(1.0, 1.0, count), rng.uniform(0.01, 0.2, count) ** 2
        process = LocalGp(80, h)
        process.restart(origin, axes[2])
        spare = int(rng.integers(0, 20))
        for _ in range(spare):  # come and go
            assert process.append(origin + rng.normal(0, 5e-3, 3), 1.0, 0.01)
        for row, value, variance in zip(inputs, values, noise):
            assert process.append(origin + axes.T @ row[:3], value, variance, row[3])
        for _ in range(spare):
            process.remove(0)
        oracle = draws.regressor(h, inputs, values, noise)
        at = np.column_stack([rng.uniform(-1e-2, 1e-2, (10, 3)), np.zeros(10)])
        mean, std = oracle.predict(at, return_std=True)
        ours = [process.predict(origin + axes.T @ row[:3]) for row in at]
        np.testing.assert_allclose([o.mean for o in ours], mean, atol=1e-5)
        np.testing.assert_allclose([o.variance for o in ours], std**2, atol=1e-5)
        assert process.log_marginal_likelihood == pytest.approx(oracle.log_marginal_likelihood_value_, abs=1e-5)
        # The slope along the normal, and its variance, from the oracle's joint posterior of two near points.
        step = 1e-4
        two = np.array([at[0] + [0, 0, step, 0], at[0] - [0, 0, step, 0]])
        mean, covariance = oracle.predict(two, return_cov=True)
        difference = np.array([0.5, -0.5]) / step
        slope = axes[2] @ ours[0].gradient
        assert slope == pytest.approx(difference @ mean, rel=1e-3, abs=0.5)
        variance = axes[2] @ ours[0].gradient_covariance @ axes[2]
        assert variance == pytest.approx(difference @ covariance @ difference, rel=0.02, abs=10.0)


def test_learned_hyperparameters_are_the_optimum_of_scikit_learns_likelihood():
    rng = np.random.default_rng(5)
    phantom = draws.tissue(rng, damping_N_s_m2=0.0, base_T_surface=np.eye(4), curvature_1_m=0.0)
    recorded = draws.palpation(phantom, rng, size_m=6e-3)
    grid = HashGrid()
    grid.insert(recorded.positions, recorded.forces)
    config = LocalModelConfig(neighbours=300, hyperparameters=GpHyperparameters(damping_scale_s_m=0.0))
    config.radius_m = 0.012
    learned = learn_hyperparameters(grid, config, neighbourhoods=1, prior_log_std=1e3, max_iterations=200)
    x, f, weight = grid.samples
    assert learned.samples == len(x) and learned.converged
    outward = -f.sum(0) / np.linalg.norm(f.sum(0))
    middle = x.mean(0)
    across = np.linalg.svd(outward[None])[2][1:]
    inputs = np.column_stack([(x - middle) @ across.T, (x - middle) @ outward, np.zeros(len(x))])

    def likelihood(h):
        oracle = draws.regressor(h, inputs, -f @ outward, h.noise_N**2 / weight)
        return oracle.log_marginal_likelihood_value_

    assert learned.log_likelihood == pytest.approx(likelihood(learned.hyperparameters), abs=1e-3)
    names = ("force_scale_N", "stiffness_scale_N_m", "tangential_length_m", "noise_N")
    found = learned.hyperparameters

    def cost(logarithms):
        h = found.__copy__()
        for name, value in zip(names, np.exp(logarithms)):
            setattr(h, name, value)
        return -likelihood(h)

    start = np.log([getattr(found, name) for name in names])
    better = minimize(cost, start, method="Nelder-Mead", options={"maxiter": 120})
    assert -better.fun - learned.log_likelihood < 0.05
    assert check_grad(cost, lambda at: np.zeros(4), start, epsilon=1e-4) < 1.0  # flat there


def test_deviations_hold_what_they_say_when_the_prior_is_true(many):
    """Tissue drawn from the prior itself: then 68 % and 95 % is no matter of luck beyond the binomial's."""
    hits, trials = np.zeros(2), 0
    for seed in range(1200 * many):
        rng = np.random.default_rng([seed, 3])
        h, count = draws.hyperparameters(rng), 30
        inputs = np.column_stack([rng.uniform(-8e-3, 8e-3, (count, 3)), rng.uniform(-0.02, 0.02, count)])
        at, step = np.append(rng.uniform(-8e-3, 8e-3, 3), 0.0), 1e-5
        up = np.array([0.0, 0.0, step, 0.0])
        joint = np.vstack([inputs, at + up, at - up])
        covariance = draws.TissueKernel(h)(joint)
        values, vectors = np.linalg.eigh(covariance)
        truth = vectors @ (np.sqrt(np.maximum(values, 0.0)) * rng.normal(size=count + 2))
        process = LocalGp(count, h)
        for row, value in zip(inputs, truth[:count]):
            process.append(row[:3], value + h.noise_N * rng.normal(), h.noise_N**2, row[3])
        found = process.predict(at[:3])
        deviation = (found.gradient[2] - (truth[-2] - truth[-1]) / (2 * step)) / np.sqrt(
            found.gradient_covariance[2, 2]
        )
        hits += np.abs(deviation) < [1.0, 2.0]
        trials += 1
    for hit, share in zip(hits, (0.6827, 0.9545)):
        low, high = stats.binom.interval(0.9999, trials, share)
        assert low <= hit <= high, (hit / trials, share)


def test_the_phantoms_closed_form_is_its_law():
    for seed in range(20):
        rng = np.random.default_rng(seed)
        phantom = draws.tissue(rng, exponent=rng.uniform(1.0, 2.0), friction=0.1)
        law = sim.Tissue(phantom.tissue)
        points = phantom.surface(rng.uniform(-0.02, 0.02, (50, 2))) + rng.normal(0, 3e-3, (50, 3))
        velocities = rng.normal(0, 0.02, (50, 3))
        forces, outputs = phantom.forces(points, velocities), [law.step(*row, 1e-3) for row in zip(points, velocities)]
        np.testing.assert_allclose(forces, [o.wrench[:3] for o in outputs], atol=1e-12)
        np.testing.assert_allclose(phantom.depth(points), [o.depth for o in outputs], atol=1e-15)
        np.testing.assert_allclose(phantom.stiffness(points), [o.stiffness for o in outputs], rtol=1e-12)
        np.testing.assert_allclose(phantom.depth(phantom.surface(rng.uniform(-0.02, 0.02, (9, 2)))), 0.0, atol=1e-15)


def test_the_map_is_the_phantoms_and_its_deviations_hold(many):
    known, within_1, within_2, surface_1, surface_2 = [], [], [], [], []
    for seed in range(4 * many):
        rng = np.random.default_rng([seed, 1])
        phantom = draws.tissue(rng)
        recorded = draws.palpation(phantom, rng)
        model = StiffnessMap().fit(recorded.positions, recorded.forces, recorded.velocities)
        across = np.linspace(-0.013, 0.013, 16)
        vertices = phantom.surface(np.array([(x, y) for x in across for y in across]))
        found = model.estimate(vertices)
        truth = phantom.stiffness(vertices)
        error = found.stiffness_N_m - truth
        depth = phantom.depth(found.surface_point)
        assert np.sqrt(np.mean((error[found.known] / truth[found.known]) ** 2)) < 0.10
        assert np.sqrt(np.mean(depth[found.known] ** 2)) < 1.5e-4
        known.append(found.known.mean())
        for share, sigma in ((within_1, 1.0), (within_2, 2.0)):
            share.append((np.abs(error) < sigma * found.stiffness_std_N_m)[found.known].mean())
        for share, sigma in ((surface_1, 1.0), (surface_2, 2.0)):
            share.append((np.abs(depth) < sigma * found.surface_std_m)[found.known].mean())
        damping = phantom.tissue.damping_N_s_m2 / phantom.tissue.stiffness_N_m
        assert model.hyperparameters.damping_s_m == pytest.approx(damping, abs=1.5)
        mean, std = model.predict(vertices, return_std=True)
        np.testing.assert_array_equal(mean, found.stiffness_N_m)
        np.testing.assert_array_equal(std, found.stiffness_std_N_m)
    assert min(known) > 0.98
    assert np.mean(within_1) > 0.6 and np.mean(within_2) > 0.88
    assert np.mean(surface_1) > 0.6 and np.mean(surface_2) > 0.88


def test_what_was_never_touched_is_unknown():
    phantom = Phantom()
    recorded = palpate(phantom, raster_path(0.01, 3e-3, 0.01, 1e-3), 1e-3)
    model = StiffnessMap().fit(recorded.positions, recorded.forces, recorded.velocities, learn=False)
    found = model.estimate([[0.1, 0.0, 0.0], [0.0, 0.0, 0.0], [np.nan, 0.0, 0.0]])
    assert found.known.tolist() == [False, True, False]
    assert found.status[0] == int(EstimateStatus.TOO_FEW_SAMPLES)
    for name in ("stiffness_N_m", "force_N"):
        assert np.isnan(getattr(found, name)[[0, 2]]).all()
        assert np.isinf(getattr(found, name.replace("_N", "_std_N", 1))[[0, 2]]).all()


def test_order_does_not_matter_for_the_samples():
    """Shuffled, the places hold the same totals; the map differs by less than it says."""
    rng = np.random.default_rng(3)
    phantom = draws.tissue(rng)
    recorded = draws.palpation(phantom, rng, size_m=0.012)
    order = rng.permutation(len(recorded))
    config = StiffnessGpConfig(outlier_sigma=np.inf)
    maps = [
        StiffnessMap(config).partial_fit(recorded.positions[i], recorded.forces[i], recorded.velocities[i])
        for i in (slice(None), order)
    ]
    vertices = phantom.surface(rng.uniform(-5e-3, 5e-3, (50, 2)))
    first, second = (m.estimate(vertices) for m in maps)
    assert (np.abs(first.stiffness_N_m - second.stiffness_N_m) < first.stiffness_std_N_m).mean() > 0.95


def test_refusals_name_what_is_wrong():
    rng = np.random.default_rng(4)
    phantom = draws.tissue(rng)
    recorded = draws.palpation(phantom, rng, size_m=0.006)
    x, f = recorded.positions, recorded.forces
    for positions, forces, said in (
        (1e3 * x, f, "millimetres"),
        (x, 1e3 * f, "force_limit_N"),
        (x[:, :2], f, r"positions: shape .* must be \(n, 3\)"),
        (x[:-1], f, "forces: shape"),
        (np.full_like(x, np.nan), f, "INVALID"),
        ("surface", f, "positions: must be numbers"),
    ):
        with pytest.raises(saras.ModelError, match=said):
            StiffnessMap().fit(positions, forces)
    with pytest.raises(saras.ModelError, match="no neighbourhood"):
        StiffnessMap().fit(x[:3], f[:3])
    with pytest.raises(saras.ConfigError, match="cell_m"):
        HashGridConfig(cell_m=-1.0)
    with pytest.raises(saras.ConfigError, match="tangential_length_m"):
        GpHyperparameters(tangential_length_m=np.nan)


def test_a_refused_recording_leaves_the_map_as_it_was():
    phantom = Phantom()
    recorded = palpate(phantom, raster_path(0.01, 3e-3, 0.01, 1e-3), 1e-3)
    model = StiffnessMap().fit(recorded.positions, recorded.forces, learn=False)
    before = model.predict([[0.0, 0.0, 0.0]])
    with pytest.raises(saras.ModelError):
        model.partial_fit(1e3 * recorded.positions, recorded.forces)
    assert model.predict([[0.0, 0.0, 0.0]]) == before


@pytest.mark.parametrize("spike_N", [2.0, 10.0])
def test_spikes_of_the_sensor_are_left_out(spike_N):
    rng = np.random.default_rng(6)
    phantom = Phantom()
    recorded = palpate(phantom, raster_path(0.02, 3e-3, 0.01, 1e-3), 1e-3)
    spiked = rng.random(len(recorded)) < 0.01
    spiked[:200] = False
    forces = recorded.forces + spike_N * np.outer(spiked, [0, 0, -1.0])
    law = StiffnessGp(StiffnessGpConfig())
    verdicts, _ = law.steps(recorded.positions, forces, 1e-3, recorded.velocities)
    refused = verdicts == int(SampleVerdict.OUTLIER)
    assert refused[spiked].mean() > 0.95
    assert refused[~spiked].mean() < 0.01
