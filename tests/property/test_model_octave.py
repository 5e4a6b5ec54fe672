"""Costs of exploration as .m functions: by Octave where it is installed, and by a fake that speaks the same pipes."""

from __future__ import annotations

import shlex
import shutil
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import saras
from saras import sim
from saras.model import OctaveCost, OctaveError, StiffnessMap, SurfaceEstimates
from saras.model.exploring import CostError, TrajectoryOptimizer
from saras.sim.palpation import Phantom

ROOT = Path(__file__).parents[2]
LONG_S = 60.0
needs_octave = pytest.mark.skipif(
    not (shutil.which("octave-cli") or shutil.which("octave")), reason="Octave is not installed (optional)"
)


@pytest.fixture(scope="module")
def program(tmp_path_factory):
    """The fake, run by the Python that runs the tests."""
    path = tmp_path_factory.mktemp("fake") / "octave"
    fake = shlex.join([sys.executable, str(ROOT / "tests/fakes/fake_octave.py")])
    path.write_text(f'#!/bin/sh\nexec {fake} "$@"\n')
    path.chmod(0o755)
    return str(path)


@pytest.fixture
def written(tmp_path):
    """Writes a .m file, gives its path."""

    def write(name, text):
        (tmp_path / f"{name}.m").write_text(text)
        return tmp_path / f"{name}.m"

    return write


@pytest.fixture
def fake(written, program):
    """OctaveCost beside a fake that does what is said."""

    def made(does, **options):
        return OctaveCost(written("cost_of_mine", f"% {does}\n"), octave=program, **{"time_limit_s": LONG_S, **options})

    return made


def random_estimates(seed, rows, count):
    rng = np.random.default_rng(seed)
    n = rows * count
    std = np.where(rng.random(n) < 0.3, np.inf, rng.random(n))
    estimates = SurfaceEstimates(
        surface_point=rng.standard_normal((n, 3)),
        surface_std_m=rng.random(n),
        stiffness_N_m=np.where(np.isinf(std), np.nan, rng.random(n)),
        stiffness_std_N_m=std,
        force_N=rng.standard_normal(n),
        force_std_N=rng.random(n),
        normal=rng.standard_normal((n, 3)),
        samples=rng.integers(0, 60, n, dtype=np.int32),
        status=rng.integers(0, 3, n).astype(np.uint8),
    )
    return estimates, rng.standard_normal((rows, count, 3))


@pytest.fixture(scope="module")
def kept(tmp_path_factory, program):
    """One fake for each field, over all draws."""
    costs = {}
    for field in ("points", "surface_point", "normal", "force_N", "samples", "known"):
        path = tmp_path_factory.mktemp(field) / "cost.m"
        path.write_text(f"% {field}\n")
        costs[field] = OctaveCost(path, octave=program, time_limit_s=LONG_S)
    yield costs
    for cost in costs.values():
        cost.close()


@settings(deadline=None)
@given(seed=st.integers(0, 2**32 - 1), rows=st.integers(1, 40), count=st.integers(1, 30))
def test_every_field_arrives_a_path_a_row(kept, seed, rows, count):
    estimates, points = random_estimates(seed, rows, count)
    for field, cost in kept.items():
        values = points if field == "points" else np.asarray(getattr(estimates, field), dtype=float)
        np.testing.assert_allclose(cost(estimates, points), values.reshape(rows, -1).sum(1), atol=1e-9)


def test_more_than_a_pipe_holds(fake):
    with fake("points") as cost:
        estimates, points = random_estimates(1, 200, 300)
        np.testing.assert_allclose(cost(estimates, points), points.sum(axis=(1, 2)), atol=1e-9)


def test_one_that_raises_is_named_and_asked_again(fake):
    with fake("raises") as cost:
        for _ in range(2):
            with pytest.raises(OctaveError, match=r"cost_of_mine.m: out of memory or dimension too large"):
                cost(*random_estimates(1, 3, 4))


@pytest.mark.parametrize(("does", "said"), [("hangs", "no answer within time_limit_s = 0.2 s"), ("exits", "has ended")])
def test_one_that_hangs_or_exits_is_ended_and_not_called_again(fake, does, said):
    cost = fake(does, time_limit_s=0.2 if does == "hangs" else LONG_S)
    with pytest.raises(OctaveError, match=said):
        cost(*random_estimates(1, 3, 4))
    assert cost._process.poll() is not None
    with pytest.raises(OctaveError, match=said + ".*, and is not called again"):
        cost(*random_estimates(1, 3, 4))


def test_one_that_does_not_start_is_named(fake):
    with pytest.raises(OctaveError, match=r"did not start within start_limit_s = 0.2 s"):
        fake("never starts", start_limit_s=0.2)
    with pytest.raises(OctaveError, match="parse error"):
        fake("is broken")


def test_the_loop_goes_on(fake):
    phantom = Phantom(sim.TissueConfig())
    with fake("raises") as cost:
        plans = TrajectoryOptimizer(
            StiffnessMap(), phantom.surface, [-0.02] * 2, [0.02] * 2, cost=cost, time_limit_s=LONG_S
        )
        for _ in range(2):
            plan = plans.next([0.0, 0.0])
            assert isinstance(plan.error, CostError) and "out of memory" in str(plan.error)
            assert np.isfinite(plan.points).all()


def test_no_octave_no_file_no_name(written, program, tmp_path, monkeypatch):
    good = written("cost", "")
    for bad in (tmp_path / "missing.m", written("not a name", ""), tmp_path):
        with pytest.raises(saras.ConfigError, match=r"cost = .*must be a file NAME\.m"):
            OctaveCost(bad, octave=program)
    with pytest.raises(saras.ConfigError, match="time_limit_s = 0"):
        OctaveCost(good, octave=program, time_limit_s=0.0)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(saras.ConfigError, match=r"needs Octave; Debian: apt install octave"):
        OctaveCost(good)


@needs_octave
def test_octave_computes_what_numpy_does(written):
    path = written(
        "asked",
        "function costs = asked (estimates, points)\n"
        '  disp ("printing does no harm");\n'
        "  std = estimates.stiffness_std_N_m;\n"
        "  std(isinf (std)) = 7;\n"
        "  costs = sum (std, 2) + sum (sum (points .* estimates.normal, 3), 2) - sum (estimates.known, 2);\n"
        "end\n",
    )
    with OctaveCost(path, time_limit_s=LONG_S, start_limit_s=LONG_S) as cost:
        for seed in range(5):
            estimates, points = random_estimates(seed, 32, 8)
            std = np.where(np.isinf(estimates.stiffness_std_N_m), 7.0, estimates.stiffness_std_N_m)
            expected = std + (points.reshape(-1, 3) * estimates.normal).sum(1) - estimates.known
            np.testing.assert_allclose(cost(estimates, points), expected.reshape(32, 8).sum(1), atol=1e-9)


@needs_octave
@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("costs = missing_function (points);", "missing_function"),
        ("error ('no %s today', 'plan');", "no plan today"),
        ("costs = {1};", "gave a cell, not real numbers"),
        ("costs = 1i * ones (4, 1);", "not real numbers"),
        ("x = 1;", "undefined"),
    ],
)
def test_octave_raises(written, body, said):
    path = written("raising", f"function costs = raising (estimates, points)\n{body}\nend\n")
    with OctaveCost(path, time_limit_s=LONG_S, start_limit_s=LONG_S) as cost:
        for _ in range(2):
            with pytest.raises(OctaveError, match=said):
                cost(*random_estimates(1, 4, 3))


@needs_octave
def test_octave_does_not_parse(written):
    with (
        pytest.raises(OctaveError, match="parse error"),
        OctaveCost(written("broken", "function costs = broken (\n"), time_limit_s=LONG_S, start_limit_s=LONG_S) as cost,
    ):
        cost(*random_estimates(1, 4, 3))


@needs_octave
def test_octave_hangs(written):
    path = written("hanging", "function costs = hanging (estimates, points)\nwhile true, end\nend\n")
    cost = OctaveCost(path, time_limit_s=0.3, start_limit_s=LONG_S)
    with pytest.raises(OctaveError, match="no answer within"):
        cost(*random_estimates(1, 4, 3))
    assert cost._process.poll() is not None


@needs_octave
def test_the_example_plans():
    phantom = Phantom(sim.TissueConfig())
    cost = OctaveCost(ROOT / "examples/exploration_cost.m", time_limit_s=LONG_S, start_limit_s=LONG_S)
    with cost:
        plans = TrajectoryOptimizer(
            StiffnessMap(), phantom.surface, [-0.02] * 2, [0.02] * 2, cost=cost, time_limit_s=LONG_S
        )
        plan = plans.next([0.0, 0.0])
    assert plan.error is None and np.isfinite(plan.points).all()
