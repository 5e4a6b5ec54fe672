"""The offset of another host's clock: within its stated error whatever the network does, unknown without data.

The oracle is the simulation's true offset; that of the datagrams is Debian's chronyd.
"""

from __future__ import annotations

import math
import shutil
import socket
import subprocess
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from saras import ConfigError, ProtocolError
from saras.net import ntp
from saras.net.clock_offset import DRIFT, ClockOffset, Exchange

NOW_NS = 1_790_000_000_000_000_000
TIMES_NS = st.integers(0, 2**62)
COOKIES = st.binary(min_size=8, max_size=8)


def exchanges(rng: np.random.Generator, count: int, offset_s: float, drift: float):
    """(time, exchange, true offset) over a network whose two ways are never equally long."""
    now_s = 0.0
    for _ in range(count):
        now_s += rng.uniform(0.1, 20.0)
        there_s, held_s, back_s = rng.exponential([5e-3, 1e-4, 1e-3])
        ours = [now_s, now_s + there_s, now_s + there_s + held_s, now_s + there_s + held_s + back_s]
        theirs = [t + offset_s + drift * t for t in ours]
        times = (ours[0], theirs[1], theirs[2], ours[3])
        yield ours[3], Exchange(*(NOW_NS + round(1e9 * t) for t in times)), offset_s + drift * ours[3]


@pytest.mark.parametrize("drift", [-DRIFT, 0.0, DRIFT])
def test_the_true_offset_is_within_the_error(drift: float, many: int) -> None:
    rng = np.random.default_rng(1)
    for _ in range(200 * many):
        clock = ClockOffset(keep=int(rng.integers(1, 12)))
        for at_s, exchange, true_s in exchanges(rng, 20, rng.normal(0.0, 100.0), drift):
            assert clock.add(exchange, at_s)
            for later_s in (0.0, rng.uniform(0.0, 60.0)):
                found = clock.estimate(at_s + later_s)
                assert abs(found.offset_s - true_s - drift * later_s) <= found.error_s + 1e-6
        assert clock.steps == 0


def test_the_shortest_round_trip_wins() -> None:
    """The mean over the same exchanges is off by half the mean difference of the two ways."""
    rng = np.random.default_rng(2)
    ours, mean = [], []
    for _ in range(300):
        clock, offsets = ClockOffset(keep=8), []
        for at_s, exchange, true_s in exchanges(rng, 8, 3.0, 0.0):
            clock.add(exchange, at_s)
            offsets.append(exchange.offset_s - true_s)
        ours.append(abs(clock.estimate(at_s).offset_s - true_s))
        mean.append(abs(np.mean(offsets)))
    assert np.median(ours) < 0.5 * np.median(mean)


@given(st.floats(-1e5, 1e5).filter(lambda step: abs(step) > 0.5), st.integers(1, 8))
def test_a_clock_that_is_set_is_believed_at_once(step_s: float, before: int) -> None:
    rng = np.random.default_rng(3)
    clock = ClockOffset()
    for at_s, exchange, _ in exchanges(rng, before, 0.0, 0.0):
        clock.add(exchange, at_s)
    moved = round(1e9 * step_s)
    clock.add(exchange._replace(heard_ns=exchange.heard_ns + moved, answered_ns=exchange.answered_ns + moved), at_s)
    assert clock.steps == 1
    assert abs(clock.estimate(at_s).offset_s - step_s) <= clock.estimate(at_s).error_s + 1e-6


def test_unknown_without_data_and_when_they_are_old() -> None:
    clock = ClockOffset(stale_s=30.0)
    assert clock.estimate(0.0) is None
    clock.add(Exchange(0, 5, 6, 11), 100.0)
    assert clock.estimate(130.0) is not None
    assert clock.estimate(130.1) is None


@given(TIMES_NS, TIMES_NS, TIMES_NS, TIMES_NS)
def test_an_exchange_during_which_a_clock_was_set_is_refused(sent: int, heard: int, answered: int, back: int) -> None:
    clock = ClockOffset()
    good = answered >= heard and back - sent >= answered - heard
    assert clock.add(Exchange(sent, heard, answered, back), 0.0) == good
    assert (clock.estimate(0.0) is None) != good
    assert clock.refused == (not good)


@pytest.mark.parametrize(("arguments", "name"), [({"keep": 0}, "keep = 0"), ({"stale_s": math.nan}, "stale_s = nan")])
def test_bad_settings_are_named(arguments: dict, name: str) -> None:
    with pytest.raises(ConfigError, match=name):
        ClockOffset(**arguments)


@given(st.integers(-(2**60), 2**62), st.integers(-(10**17), 10**17))
def test_timestamps_survive_and_eras_do_not_matter(unix_ns: int, away_ns: int) -> None:
    assert abs(ntp.from_ntp(ntp.to_ntp(unix_ns), unix_ns + away_ns) - unix_ns) <= 1


@given(COOKIES, TIMES_NS, st.integers(0, 10**9), st.integers(1, 16))
def test_an_answer_says_what_the_server_meant(cookie: bytes, heard_ns: int, held_ns: int, stratum: int) -> None:
    data = ntp.answer(ntp.request(cookie), heard_ns, heard_ns + held_ns, stratum)
    assert len(data) == ntp.SIZE
    said = ntp.read_answer(data, cookie, heard_ns)
    assert abs(said.heard_ns - heard_ns) <= 1
    assert abs(said.answered_ns - heard_ns - held_ns) <= 1
    assert said.synchronised == (stratum < 16)


@given(COOKIES, COOKIES, st.binary(max_size=100))
def test_what_is_no_answer_to_this_question_is_refused(cookie: bytes, other: bytes, noise: bytes) -> None:
    good = ntp.answer(ntp.request(cookie), NOW_NS, NOW_NS)
    kiss = good[:1] + b"\0" + good[2:12] + b"RATE" + good[16:]
    for data in (noise, good[:-1], ntp.request(cookie), kiss, good[:32] + bytes(16)):
        with pytest.raises(ProtocolError):
            ntp.read_answer(data, cookie, NOW_NS)
    if other != cookie:
        with pytest.raises(ProtocolError, match="another question"):
            ntp.read_answer(good, other, NOW_NS)


@pytest.mark.skipif(shutil.which("chronyd") is None, reason="chronyd is not installed (Debian: chrony)")
def test_chronyd_understands_the_question_and_shares_our_clock(tmp_path) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    settings = [f"port {port}", "local stratum 8", "allow 127.0.0.1", "bindaddress 127.0.0.1", "cmdport 0"]
    settings += [f"pidfile {tmp_path}/pid", f"bindcmdaddress {tmp_path}/socket"]
    server = subprocess.Popen(
        [shutil.which("chronyd"), "-x", "-d", "-U", *settings], stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    clock, cookie, end_s = ClockOffset(), b"8 random", time.monotonic() + 30.0
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
            client.settimeout(0.5)
            client.connect(("127.0.0.1", port))
            while clock.estimate(time.monotonic()) is None:
                if server.poll() is not None:
                    pytest.skip(f"chronyd does not run here: {server.stdout.read().decode()[-300:]}")
                assert time.monotonic() < end_s, "no answer of chronyd"
                sent_ns = time.time_ns()
                try:
                    client.send(ntp.request(cookie))
                    data = client.recv(512)
                except OSError:
                    time.sleep(0.1)
                    continue
                received_ns = time.time_ns()
                said = ntp.read_answer(data, cookie, received_ns)
                clock.add(Exchange(sent_ns, said.heard_ns, said.answered_ns, received_ns), time.monotonic())
    finally:
        server.kill()
        server.wait()
    found = clock.estimate(time.monotonic())
    assert abs(found.offset_s) <= found.error_s + 1e-5
    assert said.stratum == 8
