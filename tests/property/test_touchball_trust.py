"""Authenticated sessions: only what the live peer made for this session is believed, and once; nothing stays stuck.

The two ends of ``saras.net.trust`` over a simulated network that drops, doubles and reorders, and on which somebody
replays everything that was ever sent, to either end, and forges. Times are simulated.
"""

from __future__ import annotations

import hmac
import random
import sys
import zlib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from saras import ProtocolError
from saras.net import ReplayVerdict, ReplayWindow, TouchballDown, TouchballHandshake, TouchballUp, seal
from saras.net.keys import Keys
from saras.net.trust import (
    LIFETIME_NS,
    RETRY_NS,
    TAKEOVER_NS,
    UNHEARD_NS,
    ConsoleEnd,
    PlatformEnd,
    Session,
    TrustError,
    tag,
)

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "faults"))
from support import results

KEYS = Keys(bytes(range(32)), bytes(range(32, 64)))
OTHER = Keys(bytes(range(64, 96)), bytes(range(96, 128)))
STEP_NS = 10_000_000


class Peer:
    """One run of an end: numbers its datagrams from 0, remembers what it has accepted."""

    def __init__(self, kind, run, rng, keys=KEYS):
        self.end = kind(keys, rng.randbytes)
        self.outgoing = TouchballUp if kind is ConsoleEnd else TouchballDown
        self.run, self.seq, self.sent, self.accepted = run, 0, set(), []

    def data(self, now_ns):
        packet = self.outgoing(session=self.run, seq=self.seq, sender_time_ns=now_ns)
        datagram = self.end.seal(packet)
        if datagram is None:
            return []
        self.sent.add(self.seq)
        self.seq += 1
        return [datagram]

    def send(self, now_ns):
        due = self.end.handshake_due(now_ns) if isinstance(self.end, ConsoleEnd) else None
        return [due] * (due is not None) + self.data(now_ns)

    def receive(self, datagram, now_ns):
        """What it answers."""
        try:
            if len(datagram) == TouchballHandshake.SIZE:
                answer = self.end.handshake(datagram, now_ns)
                return [] if answer is None else [answer]
            packet = self.end.open(datagram, now_ns)
        except ProtocolError:
            return []
        self.accepted.append((packet.session, packet.seq))
        if isinstance(self.end, ConsoleEnd):
            self.end.hears_us(now_ns)
        return []


def connect(console, platform, now_ns=0):
    (question,) = console.send(now_ns)
    (answer,) = platform.receive(question, now_ns)
    (confirmation,) = console.receive(answer, now_ns)
    assert platform.receive(confirmation, now_ns) == [] and platform.end.session is not None
    return [question, answer, confirmation]


@pytest.fixture
def pair():
    rng = random.Random(1)
    console, platform = Peer(ConsoleEnd, 1, rng), Peer(PlatformEnd, 1, rng)
    connect(console, platform)
    return console, platform


def test_the_tag_is_that_of_rfc_4231():
    assert tag(b"\x0b" * 20, b"Hi There" + bytes(20)).hex() == "b0344c61d8db38535ca8afceaf0bf12b"


@given(st.lists(st.one_of(st.integers(0, 300), st.integers(0, 2**64 - 1)), max_size=400))
def test_the_window_says_what_a_set_of_all_numbers_says(stream):
    window, seen = ReplayWindow(), set()
    for seq in stream:
        newest = max(seen, default=seq)
        if seq > newest + ReplayWindow.MOST_AHEAD:
            expected = ReplayVerdict.FAR_AHEAD
        elif seq + ReplayWindow.SIZE <= newest:
            expected = ReplayVerdict.TOO_OLD
        else:
            expected = ReplayVerdict.REPLAYED if seq in seen else ReplayVerdict.NEW
        assert window.accept(seq) == expected
        if expected == ReplayVerdict.NEW:
            seen.add(seq)
        assert window.newest == max(seen, default=0)


@given(st.integers(0, 2**32), st.floats(0, 0.3), st.floats(0, 0.3), st.integers(0, 20))
def test_replays_restarts_and_forgeries_never_pass_and_the_link_comes_back(seed, loss, doubled, slowest):
    rng = random.Random(seed)
    runs = {ConsoleEnd: 1, PlatformEnd: 1}
    live = {kind: Peer(kind, 1, rng) for kind in runs}
    other = {ConsoleEnd: PlatformEnd, PlatformEnd: ConsoleEnd}
    history = {kind: [] for kind in runs}  # datagrams to each end, of all time
    flying = []  # (arrival, order, to, datagram)
    past = []  # peers that are dead

    def post(datagrams, to, now):
        for datagram in datagrams:
            history[to].append(datagram)
            for _ in range((rng.random() >= loss) + (rng.random() < doubled)):
                flying.append((now + rng.randint(0, slowest) * STEP_NS // 2, rng.random(), to, datagram))

    def deliver(to, datagram, now):
        post(live[to].receive(datagram, now), other[to], now)

    now = 0
    for _ in range(200):
        now += STEP_NS
        for kind in runs:
            if rng.random() < 0.01:
                past.append(live[kind])
                runs[kind] += 1
                live[kind] = Peer(kind, runs[kind], rng)
            post(live[kind].send(now), other[kind], now)
            if rng.random() < 0.5:
                to = rng.choice(list(runs))
                evil = rng.choice(history[to] or [b""])
                if rng.random() < 0.3 and evil:
                    spoilt = bytearray(evil)
                    spoilt[rng.randrange(len(spoilt))] ^= 1 << rng.randrange(8)
                    spoilt[-4:] = zlib.crc32(spoilt[:-4]).to_bytes(4, "little")
                    evil = bytes(spoilt)
                if evil:
                    post([evil], to, now)
        for item in sorted(one for one in flying if one[0] <= now):
            flying.remove(item)
            deliver(item[2], item[3], now)
    everyone = past + list(live.values())
    for peer in everyone:
        assert len(set(peer.accepted)) == len(peer.accepted)  # nothing twice
        senders = {(one.outgoing, one.run): one.sent for one in everyone}
        heard = TouchballDown if isinstance(peer.end, ConsoleEnd) else TouchballUp
        assert all(seq in senders[heard, run] for run, seq in peer.accepted)  # nothing that was not said
        assert [run for run, _ in peer.accepted] == sorted(run for run, _ in peer.accepted)  # no earlier run again
    # The network heals: within the time that the constants promise both ends hear each other.
    flying.clear()
    for peer in live.values():
        peer.accepted.clear()
    for _ in range((UNHEARD_NS + TAKEOVER_NS + LIFETIME_NS + 5 * RETRY_NS) // STEP_NS):
        now += STEP_NS
        for kind in runs:
            for datagram in live[kind].send(now):
                for answer in live[other[kind]].receive(datagram, now):
                    for last in live[kind].receive(answer, now):
                        live[other[kind]].receive(last, now)
    for kind, peer in live.items():
        assert (runs[other[kind]], live[other[kind]].seq - 1) in peer.accepted


def test_every_flipped_bit_and_every_other_length_is_refused_and_changes_nothing(pair):
    console, platform = pair
    for sender, receiver in ((console, platform), (platform, console)):
        (datagram,) = sender.data(0)
        # With the checksum made good again, so that the tag is what refuses.
        for bit in range(8 * (len(datagram) - 4)):
            spoilt = bytearray(datagram)
            spoilt[bit // 8] ^= 1 << (bit % 8)
            spoilt[-4:] = zlib.crc32(spoilt[:-4]).to_bytes(4, "little")
            with pytest.raises(ProtocolError):
                receiver.end.open(bytes(spoilt), 0)
        for bit in range(32):
            spoilt = bytearray(datagram)
            spoilt[len(datagram) - 4 + bit // 8] ^= 1 << (bit % 8)
            with pytest.raises(ProtocolError, match="CRC-32"):
                receiver.end.open(bytes(spoilt), 0)
        for length in [*range(len(datagram)), len(datagram) + 1, 2048]:
            with pytest.raises(ProtocolError, match="size"):
                receiver.end.open((datagram + bytes(2048))[:length], 0)
        assert receiver.end.open(datagram, 0).seq == 0
        with pytest.raises(TrustError, match="received before"):
            receiver.end.open(datagram, 0)


def test_every_flipped_bit_of_a_handshake_is_refused():
    rng = random.Random(2)
    console, platform = Peer(ConsoleEnd, 1, rng), Peer(PlatformEnd, 1, rng)
    for datagram in connect(console, platform):
        for bit in range(8 * (len(datagram) - 4)):
            spoilt = bytearray(datagram)
            spoilt[bit // 8] ^= 1 << (bit % 8)
            spoilt[-4:] = zlib.crc32(spoilt[:-4]).to_bytes(4, "little")
            for peer in (console, platform):
                with pytest.raises(ProtocolError):
                    peer.end.handshake(bytes(spoilt), TAKEOVER_NS)


def test_a_forged_sequence_far_ahead_moves_nothing_and_a_true_one_is_refused(pair):
    console, platform = pair
    (first,) = console.data(0)
    platform.end.open(first, 0)
    forger = Peer(ConsoleEnd, 1, random.Random(3), OTHER)
    forger.end._adopt(console.end.session.console_nonce, console.end.session.platform_nonce, 0)
    forger.seq = 2**63
    with pytest.raises(TrustError) as refusal:
        platform.end.open(forger.data(0)[0], 0)
    assert refusal.value.count == "unauthenticated"
    console.seq, next_seq = 2**63, console.seq
    with pytest.raises(TrustError) as refusal:
        platform.end.open(console.data(0)[0], 0)
    assert refusal.value.count == "far_ahead"
    console.seq = next_seq
    assert platform.end.open(console.data(0)[0], 0).seq == next_seq


def test_a_datagram_is_not_believed_by_the_end_that_sent_it_nor_without_a_tag(pair):
    console, platform = pair
    (up,), (down,) = console.data(0), platform.data(0)
    for end, datagram in ((console.end, up), (platform.end, down)):
        with pytest.raises(ProtocolError):
            end.open(datagram, 0)
    with pytest.raises(TrustError, match=r"not authenticated.*key file") as refusal:
        platform.end.open(TouchballUp(session=1, seq=9).encode(), 0)
    assert refusal.value.count == "unauthenticated"
    with pytest.raises(ProtocolError, match="no key file"):
        TouchballUp.decode(up)


def test_fields_are_checked_behind_a_good_tag_and_a_bad_one_feeds_nothing(pair):
    console, platform = pair
    packet = TouchballUp(seq=7)
    data = bytearray(packet.encode(True))
    data[40:48] = b"\xff" * 8  # a position that is not a number, by somebody who has the key
    key = console.end.session.up_key
    datagram = seal(bytes(data), hmac.new(key, data[:-20], "sha256").digest()[:16])
    heard_ns = platform.end.session.heard_ns
    with pytest.raises(ProtocolError, match=r"handle_position\[0\]"):
        platform.end.open(datagram, 1000)
    assert platform.end.session.heard_ns == heard_ns
    assert platform.end.open(console.end.seal(packet), 1000).seq == 7  # its number was not used up


def test_a_console_that_is_heard_is_not_displaced_and_a_silent_one_is(pair):
    console, platform = pair
    newcomer = Peer(ConsoleEnd, 2, random.Random(4))
    now = 0
    for _ in range(200):
        now += STEP_NS
        platform.receive(console.data(now)[0], now)
        for datagram in newcomer.send(now):
            assert platform.receive(datagram, now) == []
    assert platform.end.counts["busy"] > 10 and platform.end.counts["handshakes"] == 1
    connect(newcomer, platform, now + TAKEOVER_NS + RETRY_NS)
    platform.receive(newcomer.data(now)[0], now)
    assert platform.receive(console.data(now)[0], now) == [] and platform.accepted[-1] == (2, 0)
    assert platform.end.counts["unauthenticated"] == 1


def test_recorded_handshakes_begin_nothing():
    rng = random.Random(5)
    console, platform = Peer(ConsoleEnd, 1, rng), Peer(PlatformEnd, 1, rng)
    recorded = connect(console, platform)
    recorded += console.data(0)
    later = 60_000_000_000
    session = platform.end.session
    for datagram in recorded * 3:
        platform.receive(datagram, later)
    assert platform.end.session is session and platform.end.counts["handshakes"] == 1
    restarted = Peer(PlatformEnd, 2, rng)
    for datagram in recorded * 3:
        restarted.receive(datagram, later)
    assert restarted.end.session is None and not restarted.accepted
    assert restarted.end.counts["handshake_refused"] == 3
    fresh = Peer(ConsoleEnd, 2, rng)
    fresh.send(later)
    for datagram in recorded:
        fresh.receive(datagram, later)
    assert fresh.end.session is None


def test_messages_that_were_held_back_begin_nothing():
    rng = random.Random(6)
    console, platform = Peer(ConsoleEnd, 1, rng), Peer(PlatformEnd, 1, rng)
    (question,) = console.send(0)
    (answer,) = platform.receive(question, 0)
    (confirmation,) = console.receive(answer, 0)
    platform.receive(confirmation, LIFETIME_NS + 1)
    assert platform.end.session is None
    connect(Peer(ConsoleEnd, 1, rng), platform, 10 * LIFETIME_NS)
    console, platform = Peer(ConsoleEnd, 1, rng), Peer(PlatformEnd, 1, rng)
    connect(console, platform)
    held = console.data(0)[0]
    platform.receive(held, LIFETIME_NS + 1)  # the first of a session, and late: no age could be told
    assert not platform.accepted and platform.end.counts["handshake_refused"] == 1


def test_a_lost_confirmation_is_sent_again_under_the_same_session():
    rng = random.Random(8)
    console, platform = Peer(ConsoleEnd, 1, rng), Peer(PlatformEnd, 1, rng)
    (question,) = console.send(0)
    (answer,) = platform.receive(question, 0)
    console.receive(answer, 0)  # and what it answers is lost
    session = console.end.session
    confirmation, data = console.send(RETRY_NS)
    platform.receive(confirmation, RETRY_NS)
    platform.receive(data, RETRY_NS)
    assert platform.accepted and console.end.session is session
    platform.receive(confirmation, RETRY_NS)  # doubled on the way: nothing begins anew
    console.receive(platform.data(RETRY_NS)[0], RETRY_NS)
    assert len(console.send(2 * RETRY_NS)) == 1 and platform.end.counts["handshakes"] == 1


def test_an_answer_that_comes_after_the_link_has_healed_displaces_nothing(pair):
    console, platform = pair
    session, now = console.end.session, UNHEARD_NS
    question, _ = console.send(now)  # the network was cut
    (answer,) = platform.receive(question, now)
    console.receive(platform.data(now)[0], now)  # it is back
    console.receive(answer, now)
    assert console.end.session is session and console.end.counts["handshake_refused"] == 1


def test_keys_of_a_session_are_its_own_and_differ_by_direction():
    nonces = [bytes([i]) * 16 for i in range(3)]
    sessions = [Session(KEYS, a, b, 0) for a in nonces for b in nonces]
    keys = {key for session in sessions for key in (session.up_key, session.down_key)}
    assert len(keys) == 2 * len(sessions) and not keys & {KEYS.up, KEYS.down}


def test_forged_replayed_and_truncated_datagrams_in_bulk(pair, many):
    console, platform = pair
    rng = random.Random(7)
    recorded = [console.data(0)[0] for _ in range(50)]
    for datagram in recorded:
        platform.receive(datagram, 0)
    count = 2000 * many
    test = "tests/property/test_touchball_trust.py::test_forged_replayed_and_truncated_datagrams_in_bulk"
    with results.recorded(
        results.Row(7, f"{count} forged, replayed, truncated datagrams to one end", test, "bulk")
    ) as row:
        for _ in range(count):
            kind = rng.randrange(3)
            datagram = rng.choice(recorded)
            if kind == 0:
                datagram = seal(datagram, rng.randbytes(16))
            elif kind == 1:
                datagram = datagram[: rng.randrange(len(datagram))]
            assert platform.receive(datagram, 0) == []
        assert len(platform.accepted) == 50
        assert platform.receive(console.data(0)[0], 0) == [] and len(platform.accepted) == 51
        row.saw("none accepted, and the true one that follows is (the link's end alone, without sockets)")
