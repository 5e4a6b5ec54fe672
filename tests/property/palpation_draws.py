"""Random tissues, samples and kernels for the tests of saras.model, with scikit-learn as the oracle."""

from __future__ import annotations

import numpy as np
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import Kernel

from saras import sim
from saras.model import GpHyperparameters
from saras.sim.palpation import Phantom, palpate, raster_path

DT = 1e-3


class TissueKernel(Kernel):
    """The prior of local_gp.hpp for scikit-learn. Columns of X: two across the surface, u along the normal, power."""

    def __init__(self, prior=None):
        self.prior = prior

    def __call__(self, X, Y=None, eval_gradient=False):
        assert not eval_gradient
        h, Y = self.prior, X if Y is None else Y
        across = ((X[:, None, :2] - Y[None, :, :2]) ** 2).sum(2)
        product = np.outer(X[:, 2], Y[:, 2])
        polynomial = h.force_scale_N**2 + h.stiffness_scale_N_m**2 * product + h.bend_scale_N_m2**2 * product**2
        near = np.exp(-0.5 * across / h.tangential_length_m**2)
        return near * polynomial + h.damping_scale_s_m**2 * np.outer(X[:, 3], Y[:, 3])

    def diag(self, X):
        return np.array([self(row[None])[0, 0] for row in X])

    def is_stationary(self):
        return False


def regressor(hyperparameters, inputs, values, noise_variances):
    """scikit-learn's exact process at the same hyper-parameters."""
    process = GaussianProcessRegressor(TissueKernel(hyperparameters), alpha=noise_variances, optimizer=None)
    return process.fit(inputs, values)


def hyperparameters(rng):
    return GpHyperparameters(
        force_scale_N=rng.uniform(0.5, 3.0),
        stiffness_scale_N_m=rng.uniform(200.0, 2000.0),
        bend_scale_N_m2=rng.choice([0.0, 2e4]),
        tangential_length_m=rng.uniform(3e-3, 2e-2),
        damping_scale_s_m=rng.choice([0.0, 15.0]),
        noise_N=rng.uniform(0.01, 0.2),
    )


def frame(rng):
    """(3, 3) with rows: two tangents and the normal."""
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return axes * np.sign(np.linalg.det(axes))


def tissue(rng, **fields):
    """A phantom at a random pose, with its inclusion somewhere."""
    base_T_surface = np.eye(4)
    base_T_surface[:3, :3] = frame(rng).T
    base_T_surface[:3, 3] = rng.uniform(-0.3, 0.3, 3)
    values = {
        "base_T_surface": base_T_surface,
        "curvature_1_m": rng.uniform(-8.0, 12.0),
        "stiffness_N_m": rng.uniform(200.0, 500.0),
        "inclusion_stiffness_N_m": rng.uniform(900.0, 1800.0),
        "inclusion_x_m": rng.uniform(-0.008, 0.008),
        "inclusion_y_m": rng.uniform(-0.008, 0.008),
        "damping_N_s_m2": rng.uniform(0.0, 5000.0),
    }
    return Phantom(sim.TissueConfig(**{**values, **fields}))


def palpation(phantom, rng, size_m=0.03):
    path = raster_path(size_m, 3e-3, 0.01, DT)
    return palpate(
        phantom,
        path,
        DT,
        force_N=1.0,
        amplitude_N=rng.uniform(0.5, 0.8),
        frequency_Hz=rng.uniform(0.8, 2.0),
        force_noise_N=0.02,
        position_noise_m=2e-5,
        seed=int(rng.integers(1 << 31)),
    )
