"""Whether a clock stepped while it stamped: told from a result that is merely older, or arrived in a bunch."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from saras.recording.survey import Integers, Publisher

_ENOUGH = 20  # messages that make a rate
_AROUND = 11  # messages before and after a step
_WITNESSES = 3  # messages of another topic, before and after
_WITNESS_NS = 15 * 10**9  # from the step


def steps_of_clock(received_ns: Integers, stamp_ns: Integers, bound_s: float) -> list[tuple[int, float]]:
    """Where the stamps jump against the receptions by more than ``bound_s`` and stay there.

    Index of the first message after it, and jump [s]. Messages that were held up and arrive in a bunch are none: their
    stamps go on as before. Nor is a publisher that paused: then receptions jump too.
    """
    if len(stamp_ns) < _ENOUGH:
        return []
    age = (received_ns - stamp_ns) * 1e-9
    advance, period = np.diff(stamp_ns) * 1e-9, np.diff(received_ns) * 1e-9
    nominal = np.median(period)
    odd = np.abs(advance - np.median(advance)) > 0.5 * bound_s
    odd &= (period > 0.2 * nominal) & (period < 3.0 * nominal)
    found: list[tuple[int, float]] = []
    for at in np.flatnonzero(odd & (np.abs(np.diff(age)) > 0.5 * bound_s)) + 1:
        if found and at - found[-1][0] < _AROUND:
            continue
        jump = float(np.median(age[max(0, at - _AROUND) : at]) - np.median(age[at : at + _AROUND]))
        if abs(jump) > bound_s:
            found.append((int(at), jump))
    return found


def agrees_with_node(publisher: Publisher, publishers: Iterable[Publisher], moment_ns: int, jump_s: float) -> bool:
    """Whether the node's other topics step with it [s], or none of them can tell.

    A clock steps for all that a node stamps. A result that carries the stamp of what it was made from, as a contact
    seen in a picture, grows older alone when the picture comes late.
    """
    for other in publishers:
        if other.node != publisher.node or not other.node or other.stamp_ns is None or other.latched:
            continue
        if other.topic == publisher.topic:
            continue
        stamped = other.stamp_ns != 0
        received = other.received_ns[stamped]
        age = (received - other.stamp_ns[stamped]) * 1e-9
        before = age[(received < moment_ns) & (received > moment_ns - _WITNESS_NS)][-_AROUND:]
        after = age[(received > moment_ns) & (received < moment_ns + _WITNESS_NS)][:_AROUND]
        if len(before) < _WITNESSES or len(after) < _WITNESSES:
            continue
        if abs(float(np.median(before) - np.median(after)) - jump_s) > 0.5 * abs(jump_s):
            return False
    return True
