"""Claps in made-up sources: what is shifted on purpose is found, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest

from saras import Error
from saras.recording.alignment import Onsets, align, onsets
from saras.sim.clap import CLAP_NS, SECOND_NS, is_on

SOURCES = {"left eye": ("picture", 66_700_000), "PSM1": ("motion", 10_000_000), "sound": ("sound", 62_500)}
HEIGHT = {"picture": 80.0, "motion": 0.005, "sound": 20000.0}


def made(rng: np.random.Generator, name: str, shift_ns: int, seconds: int) -> Onsets:
    """Sampled unevenly; its stamps are later than the truth by shift_ns."""
    kind, period_ns = SOURCES[name]
    begin = 1_700_000_000 * SECOND_NS + int(rng.integers(SECOND_NS))
    steps = rng.uniform(0.7, 1.3, int(seconds * SECOND_NS / period_ns)) * period_ns
    true_ns = begin + np.cumsum(steps).astype(np.int64)
    on = true_ns % SECOND_NS < CLAP_NS
    levels = HEIGHT[kind] * (on + rng.normal(0.0, 0.02, len(on)))
    return onsets(name, kind, true_ns + shift_ns, levels)


def test_shifts_are_found_to_a_sample(many: int) -> None:
    for seed in range(5 * many):
        rng = np.random.default_rng(seed)
        shifts = {name: int(rng.choice([0, 0, rng.integers(-150_000_000, 150_000_000)])) for name in SOURCES}
        found = align([made(rng, name, shifts[name], 6) for name in SOURCES], 0.0667)
        assert len(found.late_s) >= 4
        for column, name in enumerate(SOURCES):
            period_s = 1.3e-9 * SOURCES[name][1]
            late_s = found.late_s[:, column] - 1e-9 * shifts[name]
            assert np.isfinite(late_s).all() and (late_s >= -1e-9).all() and (late_s <= period_s).all()
            error = found.error_s[:, column]
            assert (error <= abs(1e-9 * shifts[name]) + 1e-9).all()
            assert (error >= abs(1e-9 * shifts[name]) - period_s).all()
        worst = max(abs(shift) for shift in shifts.values())
        if worst < 60_000_000:
            assert found.within_a_frame
        if worst > 66_700_000 + 1.3 * 66_700_000:
            assert not found.within_a_frame
        assert "seen by all" in found.lines()[-2] and found.lines()[-1].endswith("within one picture")
        assert found.facts()["seen_by_all"] == len(found.late_s)


def test_a_source_that_misses_claps_is_not_aligned() -> None:
    rng = np.random.default_rng(3)
    whole = [made(rng, name, 0, 8) for name in SOURCES]
    blind = Onsets("left eye", whole[0].before_ns[:1], whole[0].at_ns[:1], whole[0].span_ns)
    assert align(whole, 0.0667).within_a_frame
    found = align([blind, *whole[1:]], 0.0667)
    assert not found.known and not found.within_a_frame and found.facts()["within_a_frame"] is None
    assert found.lines()[-1].startswith("unknown: ")
    with pytest.raises(Error, match="no clap"):
        onsets("left eye", "picture", np.arange(100) * 10**7, np.full(100, 90.0))


def test_the_clap_is_on_at_full_seconds() -> None:
    assert is_on(5 * SECOND_NS) and is_on(5 * SECOND_NS + CLAP_NS - 1)
    assert not is_on(5 * SECOND_NS - 1) and not is_on(5 * SECOND_NS + CLAP_NS)
