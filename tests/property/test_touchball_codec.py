"""Touchball codec: identity on everything valid, refusal of everything else; streams never run backwards."""

from __future__ import annotations

import math
import random
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from saras import ProtocolError, Status
from saras.net import (
    ChannelState,
    GuardState,
    LinkAge,
    PortLedger,
    SequenceFilter,
    SimballJoints,
    TouchballDown,
    TouchballDownSide,
    TouchballUp,
    TouchballUpSide,
)

U64 = st.integers(0, 2**64 - 1)
I64 = st.integers(-(2**63), 2**63 - 1)
NUMBER = st.floats(allow_nan=False, allow_infinity=False)
UNIT = st.floats(0, 1)
LENGTH = st.floats(-10, 10)
JOULES = st.floats(0, 1e300)
VECTOR6 = st.lists(NUMBER, min_size=6, max_size=6)


@st.composite
def quaternions(draw):
    q = np.array(draw(st.lists(st.floats(-1, 1), min_size=4, max_size=4)))
    norm = np.linalg.norm(q)
    return q / norm if norm > 1e-3 else np.array([0.0, 0.0, 0.0, 1.0])


LEDGERS = st.builds(PortLedger, session=U64, seq=U64, sent_J=JOULES, requesting=st.booleans(), has_room=st.booleans())
GUARDS = st.builds(
    GuardState,
    **dict.fromkeys(["energy_J", "minimum_J", "request_J", "available_J", "maximum_J"], NUMBER),
    **dict.fromkeys(["work_out_J", "received_J", "vented_J", "granted_J"], NUMBER),
    reduction=UNIT,
    scale=UNIT,
    damping=VECTOR6,
    status=st.sampled_from(list(Status.__members__.values())),
)
UP_SIDES = st.builds(
    TouchballUpSide,
    **dict.fromkeys(["present", "calibrated", "clutch", "clip"], st.booleans()),
    handle_position_m=st.lists(LENGTH, min_size=3, max_size=3),
    handle_quaternion_xyzw=quaternions(),
    joints=st.builds(SimballJoints, yaw_rad=NUMBER, pitch_rad=NUMBER, roll_rad=NUMBER, insertion_m=LENGTH),
    grip=UNIT,
    ledger=LEDGERS,
    guard=GUARDS,
)
DOWN_SIDES = st.builds(
    TouchballDownSide,
    touch_wrench=VECTOR6,
    state=st.sampled_from(list(ChannelState.__members__.values())),
    engagement=U64,
    ledger=LEDGERS,
)
UPS = st.builds(TouchballUp, session=U64, seq=U64, sender_time_ns=I64, left=UP_SIDES, right=UP_SIDES)
DOWNS = st.builds(
    TouchballDown,
    **dict.fromkeys(["session", "seq", "echo_session", "echo_seq"], U64),
    **dict.fromkeys(["sender_time_ns", "echo_time_ns", "echo_hold_ns"], I64),
    left=DOWN_SIDES,
    right=DOWN_SIDES,
)


def leaves(value, path=""):
    """Every scalar of a packet as (path, comparable): floats by their bits."""
    if hasattr(value, "_fields"):
        for name in value._fields:
            if name != "simball_T_handle":  # a view of position and quaternion
                yield from leaves(getattr(value, name), f"{path}.{name}")
    elif isinstance(value, np.ndarray):
        yield path, value.tobytes()
    elif isinstance(value, float):
        yield path, struct.pack("<d", value)
    else:
        yield path, value


@given(UPS | DOWNS)
@settings(print_blob=True)
def test_decode_inverts_encode_bit_for_bit(packet):
    data = packet.encode()
    again = type(packet).decode(data)
    assert len(data) == type(packet).SIZE
    assert dict(leaves(again)) == dict(leaves(packet))
    assert again.encode() == data


def examples():
    pose = {"handle_position_m": [0.01, -0.02, 0.13], "handle_quaternion_xyzw": [0.1, 0.2, 0.3, math.sqrt(0.86)]}
    up = TouchballUp(session=3, seq=4, sender_time_ns=5, left=TouchballUpSide(present=True, grip=0.5, **pose))
    up.right.guard.damping = [1, 2, 3, 4, 5, 6]
    down = TouchballDown(session=7, seq=8, left=TouchballDownSide(touch_wrench=[1, 2, 3, 4, 5, 6], engagement=2))
    return [up, down]


@pytest.mark.parametrize("packet", examples(), ids=["up", "down"])
def test_every_flipped_bit_and_every_other_length_is_refused(packet):
    data = packet.encode()
    for bit in range(8 * len(data)):
        damaged = bytearray(data)
        damaged[bit // 8] ^= 1 << (bit % 8)
        with pytest.raises(ProtocolError):
            type(packet).decode(bytes(damaged))
    for length in range(len(data)):
        with pytest.raises(ProtocolError, match=f"size = {length} bytes"):
            type(packet).decode(data[:length])
    with pytest.raises(ProtocolError, match="size"):
        type(packet).decode(data + b"\0")


def float_setters(value, path=()):
    """(path, setter(packet, bad)) for every float of a packet, vectors element by element."""
    for name in value._fields:
        if name == "simball_T_handle":
            continue
        field = getattr(value, name)
        here = (*path, name)
        if hasattr(field, "_fields"):
            yield from float_setters(field, here)
        elif isinstance(field, np.ndarray):
            for i in range(field.size):
                yield (*here, i), here, i
        elif isinstance(field, float):
            yield here, here, None


def set_at(packet, path, index, bad):
    owner = packet
    for name in path[:-1]:
        owner = getattr(owner, name)
    if index is None:
        setattr(owner, path[-1], bad)
    else:
        vector = getattr(owner, path[-1]).copy()
        vector[index] = bad
        setattr(owner, path[-1], vector)


def marker_offset(packet, path, index):
    """Where a float lies in the datagram: encode with two values and compare the bytes before the CRC."""
    kind = type(packet)
    a, b = kind.decode(packet.encode()), kind.decode(packet.encode())
    if path[-1] == "handle_quaternion_xyzw":
        other = list(np.roll([0.0, 0.6, 0.8, 0.0], index))
        a_q, b_q = list(other), list(other)
        a_q[index], b_q[index] = 1e-5, 2e-5
        set_at(a, (*path[:-1], path[-1]), None, a_q)
        set_at(b, (*path[:-1], path[-1]), None, b_q)
    else:
        set_at(a, path, index, 0.25)
        set_at(b, path, index, 0.75)
    x, y = a.encode()[:-4], b.encode()[:-4]
    first = min(i for i in range(len(x)) if x[i] != y[i])
    low = [i for i in range(max(0, first - 7), first + 1) if (i % 4) == 0]
    return a.encode(), low, struct.pack("<d", 1e-5 if path[-1] == "handle_quaternion_xyzw" else 0.25)


@pytest.mark.parametrize("packet", examples(), ids=["up", "down"])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_each_float_not_finite_is_refused_at_encode_and_at_decode(packet, bad):
    count = 0
    for _, path, index in float_setters(packet):
        kind = type(packet)
        poisoned = kind.decode(packet.encode())
        set_at(poisoned, path, index, bad)
        with pytest.raises(ProtocolError, match=r"must be (finite|1 within)"):
            poisoned.encode()
        data, offsets, bytes_of_value = marker_offset(packet, path, index)
        (offset,) = [o for o in offsets if data[o : o + 8] == bytes_of_value]
        patched = bytearray(data)
        struct.pack_into("<d", patched, offset, bad)
        struct.pack_into("<I", patched, len(data) - 4, zlib.crc32(bytes(patched[:-4])))
        with pytest.raises(ProtocolError, match=r"must be (finite|1 within)") as refusal:
            kind.decode(bytes(patched))
        side, *_, leaf = path
        stem = leaf.replace("_m", "").replace("_xyzw", "") if leaf.startswith("handle") else leaf
        assert side in str(refusal.value) and stem in str(refusal.value)
        count += 1
    assert count == {TouchballUp: 2 * 30, TouchballDown: 2 * 7}[type(packet)]


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 200)), max_size=300))
def test_a_stream_is_never_delivered_backwards_or_twice(stream):
    accept = SequenceFilter()
    delivered = [key for key in stream if accept.accept(*key)]
    assert all(a < b for a, b in zip(delivered, delivered[1:]))
    counts = accept.counts
    assert counts.accepted + counts.duplicate + counts.out_of_order + counts.old_session == len(stream)
    assert counts.accepted == len(delivered)
    newest = (-1, -1)
    for key in stream:  # strictly newer is never withheld
        if key > newest:
            newest = key
            assert key in delivered


@given(st.integers(0, 2**32), st.floats(0, 0.3), st.floats(0, 0.4), st.floats(0, 0.3))
def test_counts_of_an_impaired_stream_match_what_was_done_to_it(seed, loss, duplication, reorder):
    rng = random.Random(seed)
    arrivals = []
    for seq in range(400):
        if rng.random() < loss:
            continue
        at = seq + (rng.randint(1, 20) if rng.random() < reorder else 0)
        arrivals.append((at, seq))
        if rng.random() < duplication:
            arrivals.append((at + rng.randint(0, 20), seq))
    arrivals.sort()
    accept, newest, seen = SequenceFilter(), -1, set()
    expected = {"duplicate": 0, "out_of_order": 0}
    for _, seq in arrivals:
        assert accept.accept(9, seq) == (seq > newest)
        if seq in seen:
            expected["duplicate"] += 1
        elif seq < newest:
            expected["out_of_order"] += 1
        seen.add(seq)
        newest = max(newest, seq)
    assert accept.counts.duplicate == expected["duplicate"]
    assert accept.counts.out_of_order == expected["out_of_order"]


@given(st.integers(-(2**62), 2**62), st.integers(0, 2**62), st.floats(0, 0.5), st.integers(0, 2**32))
def test_a_constant_delay_and_unrelated_clocks_are_not_age(sender_epoch, receiver_epoch, delay, seed):
    rng, link = random.Random(seed), LinkAge()
    for k in range(100):
        sent = k * 10_000_000
        jitter = rng.randint(0, 3_000_000)
        arrival = receiver_epoch // 2 + sent + int(delay * 1e9) + jitter
        age = link.received(sender_epoch // 2 + sent, arrival)
        assert 0 <= age <= 3.1e-3
    assert link.age_s(arrival + 50_000_000) == pytest.approx(age + 0.05, abs=1e-9)


def test_a_backlog_is_old_and_a_longer_route_is_forgotten():
    link = LinkAge(rise_rate=5e-3)
    for k in range(100):
        link.received(k * 10_000_000, k * 10_000_000)
    held = [link.received(k * 10_000_000, 3_990_000_000) for k in range(100, 400)]
    assert held[0] == pytest.approx(2.99, abs=0.02) and held[-1] < 0.02
    ages = [link.received(k * 10_000_000, k * 10_000_000 + 30_000_000) for k in range(400, 1400)]
    assert ages[0] > 0.009 and ages[-1] < 1e-3
    assert math.isinf(LinkAge().age_s(0))
