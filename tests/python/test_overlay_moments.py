"""Stills of the overlay: one of each state, and a known danger is never called unknown or clear."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from saras_ros1.overlay_moments import AGAIN_S, CLEAR, COLLISION, UNKNOWN, WARNING, Moments, worst


@given(st.lists(st.sampled_from([UNKNOWN, CLEAR, WARNING, COLLISION]), max_size=6))
def test_the_worst_of_all_tools(states):
    found = worst(states)
    if COLLISION in states:
        assert found == COLLISION
    elif WARNING in states:
        assert found == WARNING
    else:
        assert (found == CLEAR) == (bool(states) and UNKNOWN not in states)


def test_each_state_once_and_again_later():
    moments, taken = Moments(), []
    for k in range(1000):
        now_s = 0.1 * k
        moments.update([CLEAR, [CLEAR, WARNING, COLLISION, UNKNOWN][k // 30 % 4]], now_s)
        if moments.due(now_s):
            taken.append((moments.taken(now_s), now_s))
    assert {name for name, _ in taken} == {"clear", "warning", "collision", "unknown"}
    times = [now_s for name, now_s in taken if name == "warning"]
    assert all(b - a >= AGAIN_S for a, b in zip(times, times[1:])) and 3 <= len(times) <= 5


def test_a_state_of_an_instant_has_no_picture():
    moments = Moments()
    moments.update([CLEAR], 0.0)
    assert not moments.due(0.1) and moments.due(0.4)
    moments.taken(0.4)
    moments.update([COLLISION], 0.5)
    moments.update([CLEAR], 0.6)
    assert not moments.due(2.0)
