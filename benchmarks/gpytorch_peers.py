"""GPyTorch over the palpation of model.py, in bench-venv: python gpytorch_peers.py FOLDER.

exact: the exact process; an update is get_fantasy_model with one sample, its posterior asked under the tip. svgp:
variational with 512 inducing points; it has no update for one sample: what is timed is an epoch over the samples with
it. Inputs [mm], forces [N]. Hyper-parameters: exact: learned over a part, as scikit-learn's; svgp: with the rest.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import gpytorch
import numpy as np
import torch

SEARCHED, SEARCH_STEPS, EPOCHS, BATCH, INDUCING = 600, 150, 30, 512, 512
UPDATES = 3


class Exact(gpytorch.models.ExactGP):
    def __init__(self, x, y, likelihood):
        super().__init__(x, y, likelihood)
        self.mean_module = gpytorch.means.ZeroMean()
        self.covar_module = gpytorch.kernels.ScaleKernel(gpytorch.kernels.RBFKernel(ard_num_dims=3))
        self.covar_module.base_kernel.lengthscale = torch.tensor([[5.0, 5.0, 10.0]])
        self.covar_module.outputscale = 25.0

    def forward(self, x):
        return gpytorch.distributions.MultivariateNormal(self.mean_module(x), self.covar_module(x))


class Variational(gpytorch.models.ApproximateGP):
    def __init__(self, inducing):
        distribution = gpytorch.variational.CholeskyVariationalDistribution(len(inducing))
        super().__init__(gpytorch.variational.VariationalStrategy(self, inducing, distribution))
        self.mean_module = gpytorch.means.ZeroMean()
        self.covar_module = gpytorch.kernels.ScaleKernel(gpytorch.kernels.RBFKernel(ard_num_dims=3))
        self.covar_module.base_kernel.lengthscale = torch.tensor([[5.0, 5.0, 10.0]])
        self.covar_module.outputscale = 25.0

    def forward(self, x):
        return gpytorch.distributions.MultivariateNormal(self.mean_module(x), self.covar_module(x))


def descend(parameters, loss_of, steps, rate=0.05):
    optimizer = torch.optim.Adam(parameters, lr=rate)
    for step in range(steps):
        optimizer.zero_grad()
        loss = loss_of(step)
        loss.backward()
        optimizer.step()


def exact(x, y, points, new_x, new_y):
    """(times of updates [s], predictions at points)"""
    likelihood = gpytorch.likelihoods.GaussianLikelihood()
    some = torch.as_tensor(np.random.default_rng(3).choice(len(x), min(SEARCHED, len(x)), replace=False))
    model = Exact(x[some], y[some], likelihood)
    model.train(), likelihood.train()
    evidence = gpytorch.mlls.ExactMarginalLogLikelihood(likelihood, model)
    descend(model.parameters(), lambda _: -evidence(model(x[some]), y[some]), SEARCH_STEPS)
    model.set_train_data(x, y, strict=False)
    model.eval(), likelihood.eval()
    times = []
    with torch.no_grad(), gpytorch.settings.fast_computations(False, False, False), gpytorch.settings.fast_pred_var():
        predicted = model(points).mean
        for i in range(UPDATES):
            begin = time.perf_counter()
            grown = model.get_fantasy_model(new_x[i : i + 1], new_y[i : i + 1])
            _ = grown(new_x[i : i + 1]).variance
            times.append(time.perf_counter() - begin)
    return times, predicted


def svgp(x, y, points, new_x, new_y):
    """(times of an epoch [s], predictions at points)"""
    generator = torch.Generator().manual_seed(3)
    likelihood = gpytorch.likelihoods.GaussianLikelihood()
    model = Variational(x[torch.randperm(len(x), generator=generator)[:INDUCING]].clone())
    model.train(), likelihood.train()
    evidence = gpytorch.mlls.VariationalELBO(likelihood, model, num_data=len(x))

    def epoch():
        order = torch.randperm(len(x), generator=generator)
        for begin in range(0, len(x), BATCH):
            batch = order[begin : begin + BATCH]
            optimizer.zero_grad()
            (-evidence(model(x[batch]), y[batch])).backward()
            optimizer.step()

    optimizer = torch.optim.Adam([*model.parameters(), *likelihood.parameters()], lr=0.03)
    for _ in range(EPOCHS):
        epoch()
    x, y = torch.cat([x, new_x[:1]]), torch.cat([y, new_y[:1]])
    times = []
    for _ in range(UPDATES):
        begin = time.perf_counter()
        epoch()
        times.append(time.perf_counter() - begin)
    model.eval()
    with torch.no_grad():
        return times, model(points).mean


def main() -> None:
    torch.set_default_dtype(torch.float64)
    torch.manual_seed(1)
    folder = Path(sys.argv[1])
    with np.load(folder / "palpation.npz") as given:
        arrays = {name: torch.as_tensor(given[name]) for name in given.files}
    results = {}
    for name, process in (("exact", exact), ("svgp", svgp)):
        times, predicted = process(*(arrays[k] for k in ("x", "y", "points", "new_x", "new_y")))
        results[f"{name}_us"], results[f"{name}_force"] = 1e6 * np.array(times), predicted.numpy()
    np.savez(folder / "results.npz", **results)


if __name__ == "__main__":
    main()
