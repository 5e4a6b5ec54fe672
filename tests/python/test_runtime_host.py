"""The real-time host from Python, with and without keys, against the console's own end of the link."""

import socket
import time

import numpy as np
import pytest

from saras import ConfigError, Error, ProtocolError
from saras.net import TouchballDown, TouchballHandshake, TouchballUp
from saras.net import keys as key_files
from saras.net.trust import ConsoleEnd, PlatformEnd
from saras.pipeline import PipelineConfig

pytest.importorskip("saras.runtime")
from saras.runtime import (
    ConsoleSocketConfig,
    HostConfig,
    LoopConfig,
    RealtimeRequest,
    TeleopHost,
    read_flight,
    replay_flight,
)

SIDES = ("left", "right")
PATIENCE_S = 30.0


def eventually(condition):
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.005)
    raise AssertionError("not in time")


@pytest.fixture
def console():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        one.settimeout(PATIENCE_S)
        yield one


def host_for(console, *, keyed=False, record_s=2.0, **pipeline):
    limits = dict.fromkeys(("handle_timeout_s", "arm_timeout_s", "channel_timeout_s"), 10.0)
    return TeleopHost(
        HostConfig(
            loop=LoopConfig(hold_after_s=5.0, realtime=RealtimeRequest(priority=0, lock_memory=False)),
            console=ConsoleSocketConfig(
                bind_port=0, console_port=console.getsockname()[1], keyed=keyed, age_limit_s=10.0, session=3
            ),
            pipeline=PipelineConfig(**{**limits, **pipeline}),
            record_s=record_s,
        )
    )


def up(seq, session=5):
    packet = TouchballUp(session=session, seq=seq, sender_time_ns=time.monotonic_ns())
    for side in SIDES:
        handle = getattr(packet, side)
        handle.present = True
        handle.handle_position_m = [1e-5 * seq, 0.0, -0.2]
    return packet


def feed(host, engagement=1):
    tip = np.diag([1.0, -1.0, -1.0, 1.0])
    tip[:3, 3] = [0.18, 0.0, -0.18]
    for side in SIDES:
        host.set_arm_rcm(side, [0.18, 0.0, -0.1])
        host.set_arm_pose(side, tip, time.time_ns())
        host.set_arm_wrench(side, np.zeros(6))
        host.set_supervisor(side, 2, engagement, False)


def test_a_record_replays_and_reads_as_arrays(console, tmp_path):
    host = host_for(console)
    feed(host)
    host.start()
    for seq in range(1, 201):
        feed(host)
        console.sendto(up(seq).encode(), ("127.0.0.1", host.port))
        while TouchballDown.decode(console.recv(2048)).echo_seq != seq:
            pass
    eventually(lambda: host.wait(PATIENCE_S) and host.snapshot().up.seq == 200)
    out = host.snapshot().tick.output
    assert out.left.has_set_point
    path = tmp_path / "one.flight"
    steps = host.write_record(str(path), "a test of records")
    host.stop()
    record = read_flight(str(path))
    assert record.reason == "a test of records"
    replay = replay_flight(record)
    assert replay.ticks == replay.exact == steps
    arrays = record.arrays()
    assert arrays["set_point"].shape == (steps, 2, 3)
    np.testing.assert_array_equal(np.diff(arrays["index"]), 1.0)
    np.testing.assert_array_equal(record.ticks(record.chunks - 1)[-1].output.left.set_point, out.left.set_point)


def test_the_command_replays_and_reports(console, tmp_path, capsys):
    from saras.cli import main

    host = host_for(console)
    feed(host)
    host.start()
    for seq in range(1, 31):
        console.sendto(up(seq).encode(), ("127.0.0.1", host.port))
        console.recv(2048)
    path = tmp_path / "one.flight"
    host.write_record(str(path), "right: no arm state")
    host.stop()
    assert main(["replay-flight", str(path), "--report", str(tmp_path / "report")]) == 0
    assert "equal to the bit" in capsys.readouterr().out
    html = (tmp_path / "report" / "flight.html").read_text(encoding="utf-8")
    assert "right: no arm state" in html
    assert "<svg" in html
    path.write_bytes(path.read_bytes()[:1000])
    assert main(["replay-flight", str(path)]) == 2


def test_what_is_no_record_is_refused(tmp_path):
    path = tmp_path / "text.flight"
    path.write_text("no flight record at all")
    with pytest.raises(ProtocolError, match="no flight record"):
        read_flight(str(path))
    with pytest.raises(Error):
        read_flight(str(tmp_path / "absent"))


def test_configurations_are_refused_by_name(console):
    with pytest.raises(ConfigError, match="period_s"):
        LoopConfig(period_s=0.0)
    with pytest.raises(ConfigError, match="loopback"):
        ConsoleSocketConfig(bind_host="0.0.0.0")
    host = host_for(console, record_s=0.0)
    with pytest.raises(Error, match="record_s"):
        host.write_record("/tmp/never", "")
    with pytest.raises(ValueError, match="left or right"):
        host.set_arm_rcm("middle", [0.0, 0.0, 0.0])


class Platform:
    """The handshake's thread of the node, step by step."""

    def __init__(self, host, keys):
        self.host, self.trust = host, PlatformEnd(keys)

    def serve(self):
        data = self.host.take_handshake()
        if data is None:
            return
        begun = self.trust.session
        try:
            answer = self.trust.handshake(data, time.monotonic_ns())
        except ProtocolError:
            return
        if answer is not None:
            self.host.send(answer)
        if self.trust.session is not begun:
            self.host.set_session(self.trust.session.up_key, self.trust.session.down_key)


def shake(console, host, platform, end):
    """Until the console's end has a session that the host answers under."""
    address = ("127.0.0.1", host.port)
    console.settimeout(0.01)

    def answered():
        due = end.handshake_due(time.monotonic_ns())
        if due is not None:
            console.sendto(due, address)
        platform.serve()
        try:
            data = console.recv(2048)
        except TimeoutError:
            return False
        if len(data) == TouchballHandshake.SIZE:
            confirmation = end.handshake(data, time.monotonic_ns())
            if confirmation is not None:
                console.sendto(confirmation, address)
            return False
        try:
            end.open(data, time.monotonic_ns())
        except ProtocolError:
            return False
        return True

    eventually(answered)
    console.settimeout(PATIENCE_S)


def test_with_keys_only_a_session_is_believed(console):
    keys = key_files.draw()
    host = host_for(console, keyed=True, handle_timeout_s=0.05)
    feed(host)
    host.start()
    address = ("127.0.0.1", host.port)
    console.sendto(up(1).encode(), address)
    eventually(lambda: host.counts()["unauthenticated"] == 1)

    end, platform = ConsoleEnd(keys), Platform(host, keys)
    shake(console, host, platform, end)
    for seq in range(10, 40):
        console.sendto(end.seal(up(seq)), address)
    eventually(lambda: host.counts()["accepted"] == 30)
    assert host.heard_ns() > 0

    replayed = end.seal(up(40))
    console.sendto(replayed, address)
    console.sendto(replayed, address)
    forged = bytearray(end.seal(up(41)))
    forged[100] ^= 1
    console.sendto(bytes(forged), address)
    eventually(lambda: host.counts()["replayed"] == 1 and host.counts()["unauthenticated"] == 2)
    assert host.counts()["accepted"] == 31

    # Another run of the console: the old session's datagrams are worth nothing any more.
    old = end.seal(up(50))
    platform.trust.session.heard_ns -= 10**9
    again = ConsoleEnd(keys)
    shake(console, host, platform, again)
    console.sendto(old, address)
    eventually(lambda: host.counts()["unauthenticated"] == 3)
    console.sendto(again.seal(up(1, session=6)), address)
    eventually(lambda: host.counts()["accepted"] == 32)
    host.stop()
