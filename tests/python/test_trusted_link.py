"""Console and platform with keys on real sockets, and somebody between them who records, replays and forges."""

from __future__ import annotations

import contextlib
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip("rospy")  # the platform's end lies in the ROS package

from saras import ConfigError
from saras.console.link import Address, TouchballLink
from saras.net import TouchballDown, TouchballHandshake, TouchballUp
from saras.net import keys as key_files
from saras.net.keys import draw
from saras.net.trust import TAKEOVER_NS
from saras_ros1.console_link import ConsoleLink, Received

KEYS = draw()


class Relay:
    """Two sockets between the ends, pumped by the test: passes on, records, and lets the test inject."""

    def __init__(self):
        self.front, self.back = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        for one in (self.front, self.back):
            one.bind(("127.0.0.1", 0))
            one.settimeout(0.02)
        self.recorded = {"up": [], "down": []}
        self.peers = {}

    def pump(self):
        """Passes on what waits: from the console (front) up, from the platform (back) down."""
        for direction, source, sink in (("up", self.front, self.back), ("down", self.back, self.front)):
            with contextlib.suppress(TimeoutError):
                while True:
                    data = source.recv(2048)
                    self.recorded[direction].append(data)
                    self.inject(direction, data, sink)

    def inject(self, direction, data, sink=None):
        (sink or {"up": self.back, "down": self.front}[direction]).sendto(data, self.peers[direction])

    def close(self):
        self.front.close()
        self.back.close()


class Link:
    """Console, relay and platform; restartable."""

    def __init__(self, keys=KEYS, platform_keys=KEYS):
        self.keys, self.platform_keys = keys, platform_keys
        self.relay, self.console, self.platform = Relay(), None, None
        self.runs = 0
        self.start_platform()
        self.start_console()

    def start_platform(self):
        port = 0
        if self.platform is not None:
            port = self.platform.port
            self.platform.close()
        console = ("127.0.0.1", self.relay.back.getsockname()[1])
        self.platform = ConsoleLink(("127.0.0.1", port), console, 10.0, self.platform_keys)
        self.relay.peers["up"] = ("127.0.0.1", self.platform.port)

    def start_console(self, session=None):
        if self.console is not None:
            self.console.close()
        self.runs += 1
        front = Address("127.0.0.1", self.relay.front.getsockname()[1])
        session = session if session is not None else time.time_ns()
        self.console = TouchballLink(Address("127.0.0.1", 0), front, session, 10.0, self.keys)
        self.relay.peers["down"] = ("127.0.0.1", self.console.address.port)

    def step(self):
        """Each end sends one datagram and takes what has come; returns what they took: (up, down)."""
        up = TouchballUp()
        up.left.present = True
        self.console.send(up, time.monotonic_ns())
        self.platform.send(TouchballDown())
        self.relay.pump()
        received = self.take()
        self.relay.pump()
        return received, self.console.poll(time.monotonic_ns())

    def take(self):
        """What the platform has, until its socket is empty."""
        newest = None
        self.platform._socket.settimeout(0.005)
        while True:
            before = self.platform.counts()
            received = self.platform.receive()
            newest = received if isinstance(received, Received) else newest
            if received is None and self.platform.counts() == before:
                return newest

    def until_heard(self, patience_s=30.0):
        end = time.monotonic() + patience_s
        while time.monotonic() < end:
            up, down = self.step()
            if up is not None and down is not None and down.echo_session == self.console._session:
                return up, down
        raise AssertionError(f"not heard: {self.platform.counts()} {self.console.counts}")

    def replay(self):
        """Everything that was ever sent, both ways; returns what the ends took of it."""
        taken = []
        for direction in ("up", "down"):
            for data in list(self.relay.recorded[direction]):
                self.relay.inject(direction, data)
                taken += [self.take()] if direction == "up" else [self.console.poll(time.monotonic_ns())]
        return [one for one in taken if one is not None]

    def close(self):
        self.console.close()
        self.platform.close()
        self.relay.close()


@pytest.fixture
def link():
    made = Link()
    yield made
    made.close()


def test_both_directions_pass_and_the_round_trip_is_measured(link):
    up, _ = link.until_heard()
    assert up.packet.left.present and link.console.round_trip_s is not None
    assert link.platform.counts()["handshakes"] == 1 and link.console.counts.refused == 0
    assert all(data[6] == 1 for data in link.relay.recorded["up"] + link.relay.recorded["down"])


def test_nothing_that_was_recorded_passes_again_in_this_session_or_a_later_one(link):
    for _ in range(20):
        link.until_heard()
    assert link.replay() == []
    assert link.platform.counts()["replayed"] >= 20
    for restart in (link.start_console, link.start_platform, link.start_console):
        restart()
        assert link.replay() == []
        link.until_heard()
        assert link.replay() == []
    assert link.platform.counts()["unauthenticated"] > 0


def test_a_restarted_console_begins_at_sequence_1_even_with_its_clock_set_back(link):
    for _ in range(10):
        link.until_heard()
    session = link.console._session
    link.start_console(session - 1)
    up, _ = link.until_heard()
    assert up.packet.session == session - 1 and link.platform.counts()["handshakes"] == 2
    assert link.platform.counts()["old_session"] == 0


def test_a_restarted_platform_is_found_again(link):
    link.until_heard()
    link.start_platform()
    link.until_heard()
    assert link.platform.counts()["handshakes"] == 1 and link.console._trust.counts["handshakes"] == 2


def test_reordered_datagrams_are_late_not_replayed_and_duplicates_count_once(link):
    link.until_heard()
    for _ in range(3):
        link.console.send(TouchballUp(), time.monotonic_ns())
    first, second, third = (link.relay.front.recv(2048) for _ in range(3))
    before = link.platform.counts()
    for data in (third, first, second, first, third):
        link.relay.inject("up", data)
    assert link.take() is not None
    after = link.platform.counts()
    changed = {name: after[name] - before[name] for name in after if after[name] != before[name]}
    assert changed == {"accepted": 1, "out_of_order": 2, "replayed": 2, "gaps": 2}


def test_another_key_and_no_key_are_refused_by_name():
    for keys, platform_keys in ((draw(), KEYS), (None, KEYS), (KEYS, None)):
        link = Link(keys, platform_keys)
        for _ in range(5):
            assert link.step() == (None, None)
        counts = link.platform.counts()
        assert counts["unauthenticated" if platform_keys else "malformed"] > 0 and counts["accepted"] == 0
        if keys is None:
            assert link.console.counts.refused == 0  # the platform has nobody to speak to
        link.close()


def test_forged_and_damaged_datagrams_feed_nothing(link):
    link.until_heard()
    newest, age_s = link.platform.newest, link.platform.age_s()
    good = link.relay.recorded["up"][-1]
    forged = TouchballUp(session=link.console._session, seq=2**63, sender_time_ns=time.monotonic_ns()).encode()
    for data in (good[:-1], good + b"\0", b"", bytes(580), forged, good[:100] + bytes([good[100] ^ 1]) + good[101:]):
        link.relay.inject("up", data)
    assert link.take() is None
    assert link.platform.newest is newest and link.platform.age_s() > age_s
    counts = link.platform.counts()
    assert counts["malformed"] == 4 and counts["unauthenticated"] == 2
    up, _ = link.until_heard()
    assert up.packet.seq < 1000


def test_a_second_console_waits_while_the_first_is_heard(link):
    link.until_heard()
    second = TouchballLink(
        Address("127.0.0.1", 0), Address("127.0.0.1", link.platform.port), time.time_ns(), 10.0, KEYS
    )
    second.send(TouchballUp(), time.monotonic_ns())
    link.take()
    assert link.platform.counts()["busy"] == 1
    link.until_heard()
    time.sleep(1.5 * TAKEOVER_NS * 1e-9)
    second.send(TouchballUp(), time.monotonic_ns())
    link.take()
    assert link.platform.counts()["busy"] == 1
    assert len(link.relay.back.recv(2048)) == TouchballHandshake.SIZE
    second.close()


def test_addresses_beyond_this_computer_need_keys_and_a_socket_that_reaches_them():
    far = Address("192.0.2.1", 48010)
    with pytest.raises(ConfigError, match=r"platform = 192\.0\.2\.1:48010.*--key"):
        TouchballLink(Address("127.0.0.1", 0), far, 1, 0.06)
    with pytest.raises(ConfigError, match=r"listen = 127\.0\.0\.1:0.*--listen 0\.0\.0\.0"):
        TouchballLink(Address("127.0.0.1", 0), far, 1, 0.06, KEYS)
    TouchballLink(Address("0.0.0.0", 0), far, 1, 0.06, KEYS).close()
    with pytest.raises(ConfigError, match=r"bind_host = 0\.0\.0\.0.*key_file"):
        ConsoleLink(("0.0.0.0", 0), ("127.0.0.1", 1), 1.0)
    with pytest.raises(ConfigError, match=r"bind_host = 127\.0\.0\.1.*console_host = 192\.0\.2\.1"):
        ConsoleLink(("127.0.0.1", 0), ("192.0.2.1", 1), 1.0, KEYS)
    ConsoleLink(("0.0.0.0", 0), ("192.0.2.1", 1), 1.0, KEYS).close()
    for host in ("console.lab", "::1", ""):
        with pytest.raises(ConfigError, match=r"console_host = .*numeric IPv4"):
            ConsoleLink(("127.0.0.1", 0), (host, 1), 1.0)


def test_a_console_that_nobody_answers_says_what_it_may_be(caplog):
    console = TouchballLink(Address("127.0.0.1", 0), Address("127.0.0.1", 9), 1, 0.06, KEYS)
    for second in range(12):
        console.send(TouchballUp(), second * 1_000_000_000)
    assert caplog.text.count("answers no handshake") == 2 and "another key file" in caplog.text
    console.close()


def test_the_console_program_with_a_key_file_is_heard_killed_and_heard_again(tmp_path):
    key_file = tmp_path / "saras.key"
    key_files.save(key_file, KEYS)
    reserve = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    reserve.bind(("127.0.0.1", 0))
    console_port = reserve.getsockname()[1]
    reserve.close()
    platform = ConsoleLink(("127.0.0.1", 0), ("127.0.0.1", console_port), 10.0, key_files.load(key_file))
    sessions = []
    for stop in (signal.SIGKILL, signal.SIGTERM):
        command = [sys.executable, "-m", "saras", "console", "--plain", "--motion", "rest", "--key", str(key_file)]
        command += ["--platform", f"127.0.0.1:{platform.port}", "--listen", f"127.0.0.1:{console_port}"]
        console = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        end, accepted = time.monotonic() + 60.0, 0
        while accepted < 50 and time.monotonic() < end:
            received = platform.receive()
            platform.send(TouchballDown())
            if isinstance(received, Received):
                accepted += received.packet.session not in sessions
                newest = received.packet.session
        console.send_signal(stop)
        said, _ = console.communicate(timeout=30)
        assert accepted == 50, said
        sessions.append(newest)
    platform.close()
    assert console.returncode == 0 and "platform heard" in said and KEYS.up.hex() not in said
    assert platform.counts()["handshakes"] == 2


def test_the_console_program_names_what_is_wrong(tmp_path):
    def said(*arguments):
        command = [sys.executable, "-m", "saras", "console", "--plain", "--duration", "1", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        assert done.returncode == 2, done.stdout + done.stderr
        return done.stderr

    key_file = tmp_path / "saras.key"
    key_files.save(key_file, KEYS)
    key_file.chmod(0o644)
    assert "mode = 0644: must be 0600" in said("--key", str(key_file))
    assert "saras keys make" in said("--key", str(Path(tmp_path, "nowhere")))
    assert "platform = 192.0.2.1:48010" in said("--platform", "192.0.2.1:48010")
