"""CSA UDP: the codec against one written from the table of docs/protocols.md, sessions, and the rules at both ends."""

from __future__ import annotations

import math
import random
import struct
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from saras import ConfigError, ProtocolError
from saras.csa.udp import GateConfig, HoldReason, RemoteSlave, RemoteSlaveConfig, SlaveGate
from saras.net import CSA_MAX_JOINTS, CsaDown, CsaHandshake, CsaHold, CsaMode, CsaSlaveState, CsaUp, TouchballHandshake
from saras.net.keys import Keys
from saras.net.trust import ConsoleEnd, CsaPlatformEnd, CsaSlaveEnd, TrustError

KEYS = Keys(bytes(range(32)), bytes(range(32, 64)))
MS = 1_000_000
NUMBER = st.floats(allow_nan=False, allow_infinity=False)
U64 = st.integers(0, 2**64 - 1)


def framed(magic: bytes, body: bytes) -> bytes:
    data = magic + struct.pack("<HH", 1, 0) + body + bytes(16)
    return data + struct.pack("<I", zlib.crc32(data))


def slots(values) -> bytes:
    return struct.pack("<12d", *values, *[0.0] * (12 - len(values)))


@given(
    st.lists(NUMBER, min_size=1, max_size=12),
    st.lists(U64, min_size=4, max_size=4),
    st.integers(-(2**63), 2**63 - 1),
    st.sampled_from(list(CsaSlaveState.__members__.values())),
    st.sampled_from(list(CsaHold.__members__.values())),
    st.booleans(),
    st.lists(NUMBER, min_size=12, max_size=12),
    st.lists(st.floats(-10, 10), min_size=3, max_size=3),
)
def test_up_is_as_the_table_says(q, words, time_ns, state, hold, has_force, six, position):
    session, seq, echo, engagement = words
    up = CsaUp(session=session, seq=seq, sender_time_ns=time_ns, echo_session=echo, state=state, hold=hold)
    up.has_force, up.engagement, up.position, up.velocity = has_force, engagement, q, q[::-1]
    up.tip_position_m, up.tip_quaternion_xyzw = position, [0.5, -0.5, 0.5, 0.5]
    up.tip_twist, up.tip_wrench = six[:6], six[6:]
    body = struct.pack("<QQqQQqq", session, seq, time_ns, echo, 0, 0, 0)
    body += struct.pack("<IIIIQ", 2 * has_force, state.value, hold.value, len(q), engagement)
    body += slots(q) + slots(q[::-1]) + slots([])
    body += struct.pack("<3d4d6d6d", *position, 0.5, -0.5, 0.5, 0.5, *six)
    assert up.encode() == framed(b"SCSU", body)
    assert CsaUp.decode(up.encode()).encode() == up.encode()
    np.testing.assert_array_equal(CsaUp.decode(up.encode()).position, q)


@given(st.lists(NUMBER, max_size=12), U64, st.lists(st.floats(-10, 10), min_size=3, max_size=3))
def test_down_is_as_the_table_says(q, engagement, position):
    mode = CsaMode.JOINTS if q else CsaMode.CARTESIAN
    down = CsaDown(session=1, seq=2, sender_time_ns=3, mode=mode, position=q, engagement=engagement)
    down.tip_position_m = position
    body = struct.pack("<QQqQQqqIIQ", 1, 2, 3, 0, 0, 0, 0, mode.value, len(q), engagement)
    body += slots(q) + struct.pack("<3d4d", *position, 0, 0, 0, 1)
    assert down.encode() == framed(b"SCSD", body)
    assert CsaDown.decode(down.encode()).encode() == down.encode()


def test_what_is_not_of_this_protocol_is_refused():
    data = CsaUp(position=[0.1] * 6).encode()
    for length in [*range(len(data)), len(data) + 1]:
        with pytest.raises(ProtocolError, match="size"):
            CsaUp.decode((data + b"\0")[:length])
    for bit in range(8 * len(data)):
        damaged = bytearray(data)
        damaged[bit // 8] ^= 1 << (bit % 8)
        with pytest.raises(ProtocolError):
            CsaUp.decode(bytes(damaged))
    for at in range(88, 528, 8):
        patched = bytearray(data[:-4])
        struct.pack_into("<d", patched, at, math.nan)
        with pytest.raises(ProtocolError, match=r"must be (finite|1 within)"):
            CsaUp.decode(bytes(patched) + struct.pack("<I", zlib.crc32(patched)))
    with pytest.raises(ProtocolError, match="at most 12"):
        CsaUp(position=[0.0] * (CSA_MAX_JOINTS + 1))
    with pytest.raises(ProtocolError, match=r"joints = 0: must be in \[1, 12\]"):
        CsaDown(mode=CsaMode.JOINTS).encode()


def connected():
    slave, platform = CsaSlaveEnd(KEYS), CsaPlatformEnd(KEYS)
    answer = platform.handshake(slave.handshake_due(0), 0)
    platform.handshake(slave.handshake(answer, 0), 0)
    return slave, platform


def test_a_session_is_this_protocols_own_and_takes_each_number_once():
    slave, platform = connected()
    with pytest.raises(ProtocolError, match="magic"):
        platform.handshake(ConsoleEnd(KEYS).handshake_due(0), 0)  # the same keys, the console's protocol
    with pytest.raises(ProtocolError, match="magic"):
        TouchballHandshake.check_frame(CsaHandshake().encode())
    recorded = [slave.seal(CsaUp(session=1, seq=seq)) for seq in range(5)]
    for data in random.Random(1).sample(recorded, 5):
        platform.open(data, 0)
    for data in recorded:
        with pytest.raises(TrustError, match="received before"):
            platform.open(data, 0)
    later_slave, later_platform = connected()
    for data in recorded:
        with pytest.raises(TrustError):
            later_platform.open(data, 0)
    assert later_platform.open(later_slave.seal(CsaUp(seq=9)), 0).seq == 9
    with pytest.raises(TrustError):
        platform.open(CsaUp().encode(), 0)


# ---- the slave's rules

GATE = GateConfig(joint_reach=(0.2,) * 6)
Q, POSE = np.zeros(6), np.eye(4)


def set_point(q, engagement=1, **more):
    return CsaDown(mode=CsaMode.JOINTS, position=q, engagement=engagement, **more)


def test_an_engagement_once_ended_stays_ended():
    gate = SlaveGate(GATE)
    assert not gate.take(CsaDown(), Q, POSE, 0) and gate.hold == CsaHold.NOT_ENGAGED
    assert gate.take(set_point(Q), Q, POSE, 0) and gate.check(99 * MS)
    assert not gate.check(101 * MS) and gate.hold == CsaHold.NO_SET_POINT
    assert not gate.take(set_point(Q), Q, POSE, 102 * MS)
    assert gate.take(set_point(Q, 2), Q, POSE, 103 * MS)
    assert not gate.take(set_point(Q + 0.21, 2), Q, POSE, 104 * MS) and gate.hold == CsaHold.REFUSED
    assert "joint 0: 0.2100 away, limit 0.2" in gate.reason
    assert not gate.take(set_point(Q, 2), Q, POSE, 105 * MS)
    assert gate.take(set_point(Q, 3), Q, POSE, 106 * MS)
    assert not gate.take(CsaDown(engagement=3), Q, POSE, 107 * MS) and gate.hold == CsaHold.NOT_ENGAGED
    assert not gate.take(set_point(Q, 3), Q, POSE, 108 * MS)
    assert not gate.take(set_point(np.zeros(7), 4), Q, POSE, 0) and "7 joints" in gate.reason


@given(st.lists(st.floats(-1, 1), min_size=6, max_size=6), st.lists(st.floats(-0.05, 0.05), min_size=3, max_size=3))
def test_what_is_followed_is_always_within_reach(q, way):
    gate = SlaveGate(GATE)
    assert gate.take(set_point(q), Q, POSE, 0) == (np.abs(q).max() <= 0.2)
    pose = np.eye(4)
    pose[:3, 3] = way
    taken = SlaveGate(GATE).take(CsaDown(mode=CsaMode.CARTESIAN, base_T_tip=pose, engagement=5), Q, POSE, 0)
    assert taken == (np.linalg.norm(way) <= 0.02)


def test_numbers_that_are_none_are_not_followed():
    assert not SlaveGate(GATE).take(set_point([math.nan] * 6), Q, POSE, 0)
    assert not SlaveGate(GATE).take(CsaDown(mode=CsaMode.CARTESIAN, base_T_tip=POSE * math.nan), Q, POSE, 0)
    for bad in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ConfigError, match="joint_reach"):
            GateConfig(joint_reach=(bad,))


# ---- the platform's end


class Rig:
    """A RemoteSlave and a slave that obeys at once; one tick is 10 ms."""

    def __init__(self):
        numbers = iter(range(1, 1000))
        self.remote = RemoteSlave(RemoteSlaveConfig(GATE), lambda: next(numbers))
        self.gate, self.q, self.now, self.heard, self.session = SlaveGate(GATE), np.zeros(6), 0, None, 1
        self.up_state, self.target = CsaSlaveState.ENABLED, None

    def tick(self, alive=True, count=1):
        for _ in range(count):
            self.now += 10 * MS
            if alive:
                self.heard = self.now
                self.remote.take(self.up())
            if self.target is not None:
                self.remote.servo_jp(self.target, self.now)
            age = math.inf if self.heard is None else (self.now - self.heard) * 1e-9
            down = self.remote.step(self.now, age)
            down.encode()
            if alive:
                self.gate.check(self.now)
                if self.gate.take(down, self.q, POSE, self.now):
                    self.q = down.position.copy()
        return down

    def up(self):
        return CsaUp(
            session=self.session,
            homed=True,
            state=self.up_state,
            hold=self.gate.hold,
            engagement=self.gate.engagement,
            position=self.q,
        )

    def engage(self):
        self.tick()
        self.remote.state_command("enable")
        self.target = np.full(6, 0.1)
        self.tick(count=3)
        assert self.remote.hold is HoldReason.OK and np.allclose(self.q, 0.1)

    def holds(self, reason, down):
        assert self.remote.hold is reason and self.remote.machine.state == "PAUSED"
        assert down.mode == CsaMode.HOLD and len(down.position) == 0
        ((level, text),) = self.remote.take_events()
        assert level == "error" and reason.name in text and "resume" in text

    def comes_back(self):
        """Nothing moves by itself; after resume it follows under another number."""
        before, number = self.q.copy(), self.gate.engagement
        self.target = self.q + 0.05
        self.tick(count=20)
        assert np.array_equal(self.q, before) and self.remote.machine.state == "PAUSED"
        self.remote.state_command("resume")
        self.tick(count=3)
        assert np.allclose(self.q, before + 0.05) and self.gate.engagement not in (0, number)


@pytest.fixture
def rig():
    return Rig()


def test_it_waits_for_the_slave_and_for_a_command(rig):
    rig.tick(alive=False)
    with pytest.raises(ValueError, match="WAITING"):
        rig.remote.state_command("enable")
    rig.target = np.full(6, 0.1)
    rig.tick(count=5)
    assert rig.remote.hold is HoldReason.DISABLED and not rig.q.any()
    rig.engage()


def test_a_lost_slave_is_a_hold_until_resume(rig):
    rig.engage()
    down = rig.tick(alive=False, count=12)
    rig.holds(HoldReason.SLAVE_LOST, down)
    with pytest.raises(ValueError, match="SLAVE_LOST"):
        rig.remote.state_command("resume")
    rig.comes_back()


def test_a_restarted_slave_is_a_hold(rig):
    rig.engage()
    rig.session, rig.gate = 2, SlaveGate(GATE)
    rig.holds(HoldReason.SLAVE_RESTARTED, rig.tick())
    rig.comes_back()


def test_a_slave_with_other_joints_is_not_taken(rig):
    rig.q = np.zeros(7)
    rig.tick(count=3)
    assert rig.remote.hold is HoldReason.JOINTS_DIFFER and rig.remote.up is None
    ((_, text),) = rig.remote.take_events()
    assert "it has 7, must be 6" in text
    with pytest.raises(ValueError, match="JOINTS_DIFFER"):
        rig.remote.state_command("enable")
    rig.q = np.zeros(6)
    rig.engage()
    kept, rig.q = rig.q, np.zeros(5)
    rig.target, rig.gate.take = kept, lambda *_: False
    rig.holds(HoldReason.JOINTS_DIFFER, rig.tick())
    assert len(rig.remote.up.position) == 6
    rig.q, rig.gate = kept, SlaveGate(GATE)
    rig.comes_back()


def test_a_slave_in_fault_is_a_hold(rig):
    rig.engage()
    rig.up_state = CsaSlaveState.FAULT
    rig.holds(HoldReason.SLAVE_FAULT, rig.tick())
    with pytest.raises(ValueError, match="SLAVE_FAULT"):
        rig.remote.state_command("resume")
    rig.up_state = CsaSlaveState.ENABLED
    rig.comes_back()


def test_a_slave_that_stops_following_is_a_hold(rig):
    rig.engage()
    rig.gate.hold = CsaHold.REFUSED
    rig.holds(HoldReason.SLAVE_HOLDS, rig.tick())
    rig.comes_back()


def test_a_silent_controller_is_a_hold(rig):
    rig.engage()
    rig.target = None
    rig.holds(HoldReason.SET_POINT_LOST, rig.tick(count=12))
    rig.comes_back()


def test_a_controller_that_falls_silent_with_the_slave_is_the_slaves_loss(rig):
    numbers = iter(range(1, 1000))
    rig.remote = RemoteSlave(RemoteSlaveConfig(GATE, state_timeout_s=0.5), lambda: next(numbers))
    rig.engage()
    rig.tick(alive=False)  # one more set-point goes out
    rig.target = None
    rig.holds(HoldReason.SLAVE_LOST, rig.tick(alive=False, count=12))
    rig.tick()
    rig.comes_back()


def test_a_set_point_far_away_is_a_hold_and_does_not_go_out(rig):
    rig.engage()
    rig.target = rig.q + 0.3
    rig.holds(HoldReason.SET_POINT_REFUSED, rig.tick())
    rig.comes_back()


def test_a_slave_that_never_begins_is_a_hold(rig):
    rig.tick()
    rig.remote.state_command("enable")
    rig.target = rig.q.copy()
    rig.gate.take = lambda *_: False
    rig.holds(HoldReason.SLAVE_HOLDS, rig.tick(count=120))


@given(st.lists(st.tuples(st.sampled_from("adlsfmr"), st.integers(1, 30)), max_size=30))
def test_whatever_happens_nothing_jumps_and_a_hold_has_a_name(story):
    """alive, dead, lost controller, restarted, fault, moved far, resume: the slave's step is never beyond its reach."""
    rig = Rig()
    rig.engage()
    for what, ticks in story:
        rig.up_state = CsaSlaveState.FAULT if what == "f" else CsaSlaveState.ENABLED
        rig.target = None if what == "l" else rig.q + (0.5 if what == "m" else 0.01)
        if what == "s":
            rig.session, rig.gate = rig.session + 1, SlaveGate(GATE)
        if what == "r" and rig.remote.machine.state == "PAUSED" and rig.remote.ready:
            rig.remote.state_command("resume")
        for _ in range(ticks):
            before = rig.q.copy()
            down = rig.tick(alive=what != "d")
            assert np.abs(rig.q - before).max() <= 0.2
            engaged = rig.remote.machine.state == "ENABLED"
            assert engaged == (rig.remote.hold is HoldReason.OK)
            assert engaged or down.mode == CsaMode.HOLD
