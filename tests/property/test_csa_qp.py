"""Quadratic programmes against quadprog (Goldfarb and Idnani) and DAQP's own Python package; 10^5 with --many 100."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import linprog

from saras import csa

quadprog = pytest.importorskip("quadprog")
DRAWS = 1000
BOTH = csa.QpStatus.SOLVED


def draw(rng: np.random.Generator, kind: str, n: int, m: int):
    """H, g, lower, upper, A, row_lower, row_upper."""
    root = rng.normal(size=(n, n))
    hessian = root.T @ root + 10.0 ** rng.uniform(-4, 0) * np.eye(n)
    gradient = rng.normal(size=n) * 10.0 ** rng.uniform(-1, 1)
    lower, upper = -rng.uniform(0.1, 1.0, n), rng.uniform(0.1, 1.0, n)
    rows = rng.normal(size=(m, n))
    centre = rows @ rng.uniform(0.5 * lower, 0.5 * upper)
    row_lower, row_upper = centre - rng.uniform(0, 1, m), centre + rng.uniform(0, 1, m)
    row_lower[rng.random(m) < 0.5] = -np.inf
    if kind == "degenerate":
        half = m // 2  # rows twice, scaled, summed, through one vertex, equations
        rows[half:] = rows[: m - half] * rng.choice([1.0, 1.0, 0.5, 3.0], size=(m - half, 1))
        vertex = rng.uniform(lower, upper)
        row_upper = rows @ vertex
        row_lower[:] = -np.inf
        row_lower[0] = row_upper[0]
        upper[0] = vertex[0]
    elif kind == "infeasible":
        rows[-1] = -rows[0]
        row_upper[0], row_lower[0] = 0.1, -np.inf
        row_upper[-1], row_lower[-1] = -0.1 - rng.uniform(0.01, 1.0), -np.inf
    elif kind == "box":
        rows, row_lower, row_upper = rows[:0], row_lower[:0], row_upper[:0]
    return hessian, gradient, lower, upper, rows, row_lower, row_upper


def halves(lower, upper, rows, row_lower, row_upper):
    """C, b with C x >= b."""
    n = len(lower)
    matrix = np.vstack([np.eye(n), -np.eye(n), rows, -rows])
    bounds = np.concatenate([lower, -upper, row_lower, -row_upper])
    keep = np.isfinite(bounds)
    return matrix[keep], bounds[keep]


def kkt_residual(solver, hessian, gradient, lower, upper, rows, row_lower, row_upper) -> float:
    """Our own sum of what the solver claims, from its solution and multipliers alone."""
    n, m, x = len(gradient), len(rows), solver.solution
    bound, row = solver.multipliers[:n], solver.multipliers[n : n + m]
    stationarity = np.abs(hessian @ x + gradient + bound + rows.T @ row).max()
    stationarity /= max(1.0, np.abs(gradient).max(), np.abs(hessian @ x).max())
    worst = stationarity
    for values, low, high, multiplier in ((x, lower, upper, bound), (rows @ x, row_lower, row_upper, row)):
        for v, lo, hi, z in zip(values, low, high, multiplier):
            worst = max(worst, (lo - v), (v - hi))
            gap = (hi - v) if z > 0 else (v - lo) if z < 0 else 0.0
            worst = max(worst, abs(z * gap) / max(1.0, abs(z)))
    return worst


@pytest.mark.parametrize("n", [6, 7, 24])
@pytest.mark.parametrize("kind", ["ordinary", "degenerate", "infeasible", "box"])
def test_agrees_with_quadprog(many: int, kind: str, n: int) -> None:
    rng = np.random.default_rng([n, len(kind)])
    solver = csa.QpSolver(n, 4 * n)
    for i in range(DRAWS // 12 * many + 1):
        problem = draw(rng, kind, n, int(rng.integers(2, 4 * n)))
        result = solver.solve(*problem)
        matrix, bounds = halves(*problem[2:])
        try:
            expected = quadprog.solve_qp(problem[0], -problem[1], matrix.T, bounds)[0]
        except ValueError:
            expected = None
        if result.status == csa.QpStatus.INFEASIBLE or expected is None:
            # Who is right on the border is asked of a linear programme: how much must the rows give way?
            n_rows = len(matrix)
            slack = linprog(
                np.r_[np.zeros(n), 1.0],
                A_ub=np.c_[-matrix, -np.ones(n_rows)],
                b_ub=-bounds,
                bounds=[(None, None)] * n + [(0, None)],
            )
            feasible = slack.fun <= 1e-8
            assert result.status == (BOTH if feasible else csa.QpStatus.INFEASIBLE), (i, slack.fun)
            assert kind in ("infeasible", "degenerate")
            continue
        assert result.status == BOTH, (i, result.status)
        assert kkt_residual(solver, *problem) <= 1e-8, i
        assert result.kkt_residual <= 1e-8
        np.testing.assert_allclose(solver.solution, expected, atol=1e-6, err_msg=f"draw {i}")


def test_agrees_with_daqp_itself(many: int) -> None:
    daqp = pytest.importorskip("daqp")
    rng = np.random.default_rng(5)
    solver = csa.QpSolver(7, 40)
    for i in range(DRAWS // 10 * many):
        problem = draw(rng, "ordinary", 7, 24)
        hessian, gradient, lower, upper, rows, row_lower, row_upper = problem
        assert solver.solve(*problem).status == BOTH
        low, high = np.r_[lower, np.maximum(row_lower, -1e30)], np.r_[upper, row_upper]
        x, *_ = daqp.solve(
            hessian, gradient, np.ascontiguousarray(rows), high, low, np.zeros(31, dtype=np.int32), primal_tol=1e-10
        )
        np.testing.assert_allclose(solver.solution, x, atol=1e-6, err_msg=f"draw {i}")


def test_the_answer_does_not_depend_on_what_was_solved_before(many: int) -> None:
    rng = np.random.default_rng(6)
    used = csa.QpSolver(7, 30)
    for i in range(100 * many):
        kind = ["ordinary", "degenerate", "infeasible", "box"][i % 4]
        problem = list(draw(rng, kind, 7, 20))
        if i % 10 == 0:
            problem[0] = np.diag(rng.uniform(0.1, 2.0, 7))  # DAQP keeps a diagonal Hessian elsewhere
        fresh = csa.QpSolver(7, 30)
        assert used.solve(*problem).status == fresh.solve(*problem).status
        if fresh.solve(*problem).status == BOTH:
            assert np.array_equal(used.solution, fresh.solution), i


def test_soft_rows_give_way_where_hard_ones_would_leave_nothing() -> None:
    rng = np.random.default_rng(7)
    solver = csa.QpSolver(7, 30, soft_weight=1e6)
    for _ in range(100):
        problem = draw(rng, "infeasible", 7, 20)
        assert solver.solve(*problem).status == csa.QpStatus.INFEASIBLE
        result = solver.solve(*problem, soft=np.ones(20, dtype=np.int32))
        assert result.status == csa.QpStatus.SOFTENED
        x, lower, upper = solver.solution, problem[2], problem[3]
        assert (x >= lower - 1e-9).all() and (x <= upper + 1e-9).all()
        # Two opposite rows that are 2 d apart share the violation.
        gap = -problem[6][0] - problem[6][-1]
        assert result.slack >= 0.5 * gap - 1e-6


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("where", range(7))
def test_numbers_that_are_none_are_refused(bad: float, where: int) -> None:
    rng = np.random.default_rng(8)
    problem = list(draw(rng, "ordinary", 6, 8))
    problem[where].flat[0] = bad
    solver = csa.QpSolver(6, 8)
    if bad == np.inf and where in (3, 6):  # no upper bound at all
        assert solver.solve(*problem).status == BOTH
        return
    expected = csa.QpStatus.INFEASIBLE if bad == np.inf and where in (2, 5) else csa.QpStatus.INVALID_INPUT
    assert solver.solve(*problem).status == expected
