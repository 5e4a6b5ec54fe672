import math
import socket
import time

import numpy as np
import pytest

pytest.importorskip("rospy")
from saras import ConfigError
from saras.net import TouchballDown, TouchballUp
from saras_ros1.console_link import ConsoleLink, Received


class Ends:
    """A ConsoleLink and a socket that plays the console."""

    def __init__(self, age_limit_s=10.0):
        self.console = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.console.bind(("127.0.0.1", 0))
        self.console.settimeout(5.0)
        self.link = ConsoleLink(("127.0.0.1", 0), self.console.getsockname(), age_limit_s)
        self.begin_ns = time.monotonic_ns()

    def packet(self, session=1, seq=1, after_s=0.0):
        packet = TouchballUp(session=session, seq=seq, sender_time_ns=self.begin_ns + round(after_s * 1e9))
        packet.left.present = True
        return packet

    def send(self, data):
        self.console.sendto(data, ("127.0.0.1", self.link.port))
        return self.link.receive()


@pytest.fixture
def ends():
    made = Ends()
    yield made
    made.link.close()
    made.console.close()


def test_a_good_datagram_arrives(ends):
    received = ends.send(ends.packet().encode())
    assert isinstance(received, Received) and received.packet.left.present
    assert ends.link.counts()["accepted"] == 1


@pytest.mark.parametrize(
    ("spoil", "count"),
    [
        (lambda data: data[:-1], "malformed"),
        (lambda data: data + b"\0", "malformed"),
        (lambda data: b"\0" * len(data), "malformed"),
        (lambda data: data[:100] + bytes([data[100] ^ 1]) + data[101:], "malformed"),
        (lambda data: b"", "malformed"),
    ],
)
def test_a_spoilt_datagram_is_counted_and_changes_nothing(ends, spoil, count):
    ends.send(ends.packet(seq=1).encode())
    newest = ends.link.newest
    refusal = ends.send(spoil(ends.packet(seq=2).encode()))
    assert isinstance(refusal, str) and refusal
    assert ends.link.counts()[count] == 1 and ends.link.newest is newest
    assert isinstance(ends.send(ends.packet(seq=2).encode()), Received)


def test_replayed_and_reordered_datagrams_are_refused(ends):
    first, second = ends.packet(seq=1).encode(), ends.packet(seq=3).encode()
    assert isinstance(ends.send(first), Received) and isinstance(ends.send(second), Received)
    for data in (second, first, ends.packet(seq=2).encode()):
        assert isinstance(ends.send(data), str)
    counts = ends.link.counts()
    assert counts["accepted"] == 2 and counts["duplicate"] + counts["out_of_order"] == 3


def test_a_restarted_console_is_accepted_and_its_old_session_is_not(ends):
    ends.send(ends.packet(session=1, seq=900).encode())
    assert isinstance(ends.send(ends.packet(session=2, seq=1).encode()), Received)
    assert isinstance(ends.send(ends.packet(session=1, seq=901).encode()), str)
    assert ends.link.counts()["old_session"] == 1


def test_bunched_datagrams_are_dropped_not_caught_up():
    ends = Ends(age_limit_s=0.05)
    assert isinstance(ends.send(ends.packet(seq=1, after_s=0.0).encode()), Received)
    # sent 1 s and 0.5 s before the first one was: they waited somewhere
    for seq, after_s in ((2, -1.0), (3, -0.5)):
        assert "late" in ends.send(ends.packet(seq=seq, after_s=after_s).encode())
    assert ends.link.counts()["overdue"] == 2


def test_stamps_keep_the_senders_spacing(ends):
    stamps = []
    for k in range(5):
        stamps.append(ends.send(ends.packet(seq=k + 1, after_s=0.01 * k).encode()).stamp_ns)
        time.sleep(0.013)  # arrivals are spaced otherwise
    np.testing.assert_array_equal(np.diff(stamps), 10_000_000)


def test_the_answer_echoes_the_newest_datagram(ends):
    ends.send(ends.packet(session=5, seq=7).encode())
    ends.link.send(TouchballDown())
    down = TouchballDown.decode(ends.console.recv(2048))
    assert (down.echo_session, down.echo_seq) == (5, 7) and down.echo_hold_ns >= 0


def test_age_is_infinite_before_the_first_datagram(ends):
    assert math.isinf(ends.link.age_s())


@pytest.mark.parametrize("host", ["0.0.0.0", "192.0.2.1"])
def test_without_authentication_only_loopback_is_bound(host):
    with pytest.raises(ConfigError, match=r"must be a loopback address.*key_file"):
        ConsoleLink((host, 0), ("127.0.0.1", 1), 1.0)
    with pytest.raises(ConfigError, match=r"must be a loopback address.*key_file"):
        ConsoleLink(("127.0.0.1", 0), (host, 1), 1.0)


def test_a_taken_port_is_named(ends):
    with pytest.raises(ConfigError, match=f"127.0.0.1:{ends.link.port}"):
        ConsoleLink(("127.0.0.1", ends.link.port), ("127.0.0.1", 1), 1.0)
