"""Peers of script/bench csa, in the venv of the peers: csa_peers.py FILE. Prints times [ns] and worst differences.

Times are those that the solvers' own C and C++ clocks give, without Python; quadprog has none, and its call is timed.
Memory is kept between calls where the package allows it. Reads the programmes
and our answers that saras_csa_benchmark wrote.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path

import daqp
import numpy as np
import osqp
import proxsuite
import quadprog
from scipy import sparse

ACCURACY = 1e-8


def programmes(path: Path):
    """Yields H, g, lower, upper, A, row_lower, row_upper, our x."""
    numbers = np.fromfile(path)
    at = 0

    def take(*shape):
        nonlocal at
        count = int(np.prod(shape))
        at += count
        return numbers[at - count : at].reshape(shape)

    while at < len(numbers):
        n, m = (int(value) for value in take(2))
        shapes = ((n, n), (n,), (n,), (n,), (m, n), (m,), (m,), (n,))
        yield [np.ascontiguousarray(take(*shape)) for shape in shapes]


class Quadprog:
    def __call__(self, hessian, gradient, lower, upper, rows, row_lower, row_upper):
        n = len(gradient)
        matrix = np.vstack([np.eye(n), -np.eye(n), -rows]).T
        bounds = np.concatenate([lower, -upper, -row_upper])
        start = time.perf_counter_ns()
        x = quadprog.solve_qp(hessian, -gradient, matrix, bounds)[0]
        return x, time.perf_counter_ns() - start


class Daqp:
    def __call__(self, hessian, gradient, lower, upper, rows, row_lower, row_upper):
        high, low = np.r_[upper, row_upper], np.r_[lower, np.maximum(row_lower, -1e30)]
        sense = np.zeros(len(high), dtype=np.int32)
        x, _, _, info = daqp.solve(hessian, gradient, rows, high, low, sense, primal_tol=1e-10)
        return x, 1e9 * (info["setup_time"] + info["solve_time"])


class ProxQp:
    """Memory kept, each programme from its unconstrained solution."""

    def __init__(self):
        self.solver = None

    def __call__(self, hessian, gradient, lower, upper, rows, row_lower, row_upper):
        low = np.maximum(row_lower, -1e20)
        if self.solver is None:
            self.solver = proxsuite.proxqp.dense.QP(len(gradient), 0, len(rows), True)
            self.solver.settings.eps_abs, self.solver.settings.eps_rel = ACCURACY, 0.0
            self.solver.settings.compute_timings = True
            self.solver.settings.initial_guess = proxsuite.proxqp.InitialGuess.EQUALITY_CONSTRAINED_INITIAL_GUESS
            self.solver.init(hessian, gradient, None, None, rows, low, row_upper, lower, upper)
        else:
            self.solver.update(hessian, gradient, None, None, rows, low, row_upper, lower, upper, True)
        self.solver.solve()
        info = self.solver.results.info
        return self.solver.results.x.copy(), 1e3 * (info.setup_time + info.solve_time)


class Osqp:
    """Set up anew each time: a Jacobian that changes changes all of its matrices."""

    def __call__(self, hessian, gradient, lower, upper, rows, row_lower, row_upper):
        upper_half = sparse.csc_matrix(np.triu(hessian))
        matrix = sparse.csc_matrix(np.vstack([np.eye(len(gradient)), rows]))
        solver = osqp.OSQP()
        solver.setup(
            upper_half, gradient, matrix, np.r_[lower, row_lower], np.r_[upper, row_upper], verbose=False,
            eps_abs=ACCURACY, eps_rel=0.0, polishing=True, max_iter=20000,
        )  # fmt: skip
        result = solver.solve()
        return result.x, 1e9 * result.info.run_time


def main():
    times, worst, missed = {}, {}, {}
    solvers = {"quadprog": Quadprog(), "DAQP": Daqp(), "OSQP": Osqp()}
    prox = {}
    for *problem, ours in programmes(Path(sys.argv[1])):
        name = f"qp_{len(problem[4])}"
        expected = None
        for peer, solve in [*solvers.items(), ("ProxQP", prox.setdefault(name, ProxQp()))]:
            x, took = solve(*problem)
            expected = x if expected is None else expected
            difference = float(np.abs(x - expected).max())
            times.setdefault(name, {}).setdefault(peer, []).append(took)
            worst.setdefault(name, {})[peer] = max(worst.get(name, {}).get(peer, 0.0), difference)
            count = missed.setdefault(name, {})
            count[peer] = count.get(peer, 0) + (not difference <= 1e-6)
        difference = float(np.abs(ours - expected).max())
        worst[name]["ours"] = max(worst[name].get("ours", 0.0), difference)
    percentiles = {
        name: {
            peer: {"p50": float(np.percentile(s, 50)), "p99": float(np.percentile(s, 99))} for peer, s in row.items()
        }
        for name, row in times.items()
    }
    print(json.dumps({"times": percentiles, "worst": worst, "missed": missed}))


if __name__ == "__main__":
    main()
