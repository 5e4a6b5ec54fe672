"""A clock that steps is told from results that grow older and from messages that were held up."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from saras.recording.clock_steps import agrees_with_node, steps_of_clock
from saras.recording.survey import Publisher

MOMENT_NS = 30 * 10**9


def publisher(topic, rate_hz, jump_s=0.0, node="/eye", age_s=0.02, latched=False):
    """A minute of messages whose stamps step at MOMENT_NS."""
    received = (np.arange(int(60 * rate_hz)) * 1e9 / rate_hz).astype(np.int64) + 7
    stamp = received - int(1e9 * age_s) + np.where(received >= MOMENT_NS, int(1e9 * jump_s), 0)
    return Publisher(topic, "x/X", node, latched, received, None, stamp, 0)


def test_a_held_up_bunch_is_no_step_of_a_clock():
    stamp = np.arange(600) * 10_000_000
    received = stamp.copy()
    received[200:300] = received[300]
    assert steps_of_clock(received, stamp, 0.2) == []


@given(
    jump_s=st.floats(0.25, 3600.0).flatmap(lambda jump: st.sampled_from([jump, -jump])),
    rate_hz=st.sampled_from([1.0, 10.0, 100.0]),
)
def test_a_clock_steps_for_all_that_a_node_stamps(jump_s, rate_hz):
    contact = publisher("/contact/left", 10.0, jump_s, age_s=0.3)
    ((at, found),) = steps_of_clock(contact.received_ns, contact.stamp_ns, 0.2)
    assert found == pytest.approx(jump_s, abs=1e-6)
    moment = int(contact.received_ns[at])
    with_it = publisher("/diagnostics", rate_hz, jump_s)
    steady = publisher("/diagnostics", rate_hz)
    assert agrees_with_node(contact, [contact, with_it], moment, found)
    assert not agrees_with_node(contact, [contact, steady], moment, found)
    # Who cannot tell does not contradict: another node, a latched topic, nothing at all.
    foreign = publisher("/diagnostics", rate_hz, node="/other")
    kept = publisher("/kept", rate_hz, latched=True)
    assert agrees_with_node(contact, [contact, foreign, kept], moment, found)
