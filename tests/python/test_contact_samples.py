"""Where a tip was at the time of a picture, from poses before and after it."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("rospy")
from saras_ros1.contact_samples import HISTORY, TipHistory

MS = 1_000_000


def path(t_s: float) -> np.ndarray:
    return np.array([0.01 * np.sin(2.0 * t_s), 0.02 * t_s, -0.1 + 0.005 * np.cos(3.0 * t_s)])


def speed(t_s: float) -> np.ndarray:
    return np.array([0.02 * np.cos(2.0 * t_s), 0.02, -0.015 * np.sin(3.0 * t_s)])


def filled(stamps_ms) -> TipHistory:
    history = TipHistory()
    for stamp in stamps_ms:
        history.add(int(stamp * MS), path(1e-3 * stamp))
    return history


def test_position_and_velocity_are_those_of_the_moment() -> None:
    rng = np.random.default_rng(1)
    stamps = np.cumsum(rng.uniform(5.0, 15.0, 100)) + 1.6e9
    history = filled(stamps)
    for at in rng.uniform(stamps[4], stamps[-5], 200):
        position, velocity = history.at(int(at * MS))
        np.testing.assert_allclose(position, path(1e-3 * at), atol=5e-6)
        np.testing.assert_allclose(velocity, speed(1e-3 * at), atol=1e-3)


def test_what_is_not_covered_is_not_known() -> None:
    history = filled(range(0, 1000, 10))
    assert TipHistory().at(0) is None and not TipHistory().covers(0)
    assert history.covers(960 * MS) and not history.covers(980 * MS)
    assert history.at(10 * MS) is None and history.at(980 * MS) is None and history.at(500 * MS) is not None
    silent = filled([*range(0, 500, 10), *range(700, 1000, 10)])
    assert silent.at(600 * MS) is None and silent.at(480 * MS) is None and silent.at(400 * MS) is not None


def test_a_clock_that_is_set_back_begins_anew() -> None:
    history = filled(range(1000, 2000, 10))
    history.add(1990 * MS, np.zeros(3))  # the same pose again
    for stamp in range(0, 200, 10):
        history.add(stamp * MS, path(1e-3 * stamp))
    assert history.at(1500 * MS) is None and history.at(100 * MS) is not None
    assert len(filled(range(0, 100_000, 10))._stamps) == HISTORY
