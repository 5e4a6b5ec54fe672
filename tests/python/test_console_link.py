"""The console against a platform end on real loopback sockets: force, stale link, hold, ledgers, bad datagrams."""

from __future__ import annotations

import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

from saras import ConfigError
from saras.console.device import open_device
from saras.console.link import Address, TouchballLink, new_session
from saras.console.loop import PeriodicLoop
from saras.console.program import SIDES, Program, ProgramConfig
from saras.net import ChannelState, TouchballDown

sys.path.insert(0, str(Path(__file__).parents[1]))
from fakes.touchball_platform import FakePlatform


@contextmanager
def running_console(platform, device="script", **options):
    """A console in this process, its control loop in a thread."""
    options = {"motion": "rest", **{name: str(value) for name, value in options.items()}}
    session = new_session()
    config = ProgramConfig()
    link = TouchballLink(Address("127.0.0.1", 0), Address.parse(platform.address), session, config.guard.link_timeout_s)
    devices = {side: open_device(device, side, options) for side in SIDES}
    program = Program(config, link, devices, {}, session)
    loop = PeriodicLoop(program.tick, config.device_rate_hz)
    loop.start()
    try:
        platform.wait_for(lambda: bool(platform.ups), "the first datagram")
        yield program
    finally:
        loop.stop()
        program.close()
    assert loop.error is None


def test_both_handles_arrive_and_round_trip_is_measured():
    with FakePlatform() as platform, running_console(platform) as program:
        platform.wait_for(lambda: program.link.round_trip_s is not None, "an echo")
        up = platform.newest
        assert up.left.present and up.right.present
        np.testing.assert_allclose(up.left.handle_position_m, [0, 0, 0.16], atol=1e-3)
        assert up.left.joints.insertion_m == pytest.approx(0.06, abs=1e-3)
        assert 0.0 <= program.link.round_trip_s < 1.0
        assert platform.refused == 0


def test_no_force_until_engaged_and_none_within_100_ms_of_a_hold():
    with FakePlatform() as platform, running_console(platform, operator="firm") as program:
        for side in platform.sides.values():
            side.wrench = lambda up: np.array([2.0, 0, 0, 0, 0, 0])
        guard = program.hands["left"].guard
        platform.wait_for(lambda: guard.state == ChannelState.WAITING and guard.engagement == 0, "the platform")
        assert guard.force_N < 0.1
        platform.engage()
        platform.wait_for(lambda: guard.ramp == 1.0 and guard.force_N > 1.5, "force")
        # The touch frame is turned by pi about z: +x of the touch is -x of the Simball.
        platform.wait_for(lambda: platform.newest.left.handle_position_m[0] < -0.003, "the hand to give way")
        platform.hold()
        ramps = []
        platform.wait_for(lambda: ramps.append((time.monotonic(), guard.ramp)) or guard.ramp == 0.0, "the ramp's end")
        assert all(a >= b for (_, a), (_, b) in zip(ramps, ramps[1:]))
        levels = program.config.guard.law.tank  # granted: up to the initial charge, less what the ledger brought before
        assert levels.minimum_J < guard.law.state.tank.granted_J <= levels.initial_J + 1e-12


def test_a_silent_platform_is_stale_and_a_returning_one_needs_no_new_grant():
    with FakePlatform() as platform, running_console(platform) as program:
        guard = program.hands["right"].guard
        platform.wait_for(lambda: guard.engagement == 0, "the platform")
        platform.engage()
        platform.wait_for(lambda: guard.ramp == 1.0, "full ramp")
        granted = guard.law.state.tank.granted_J
        platform.muted = True
        platform.wait_for(lambda: guard.ramp == 0.0, "no force on a dead link")
        assert not program.link.is_fresh(time.monotonic_ns())
        platform.muted = False
        platform.wait_for(lambda: guard.ramp == 1.0, "force again")
        assert guard.law.state.tank.granted_J == granted
        for side in platform.sides.values():
            side.engage()
        platform.wait_for(lambda: guard.engagement == 2, "the next engagement")
        assert guard.law.state.tank.granted_J <= 2 * granted


def test_a_console_that_starts_into_a_running_engagement_begins_at_the_minimum():
    with FakePlatform() as platform:
        platform.engage()
        with running_console(platform) as program:
            guard = program.hands["left"].guard
            platform.wait_for(lambda: guard.engagement == 1, "the platform")
            assert guard.law.state.tank.granted_J == pytest.approx(program.config.guard.law.tank.minimum_J)
            # Energy comes by the ledger instead, on request.
            platform.wait_for(lambda: guard.law.state.tank.received_J > 0.05, "energy from the platform")


def test_energy_is_conserved_over_both_ledgers():
    with FakePlatform() as platform, running_console(platform, motion="circle", operator="weak", seed=3) as program:
        guard = program.hands["left"].guard
        platform.wait_for(lambda: guard.engagement == 0, "the platform")
        stiff = np.diag([200.0, 200.0, 200.0])
        for side in platform.sides.values():  # a spring to home, as position-position teleoperation is at rest
            side.wrench = lambda up: np.concatenate(
                [np.diag([-1, -1, 1]) @ stiff @ ([0, 0, 0.16] - up.handle_position_m), np.zeros(3)]
            )
        platform.engage()
        begin = len(platform.ups)
        platform.wait_for(lambda: len(platform.ups) > begin + 300, "3 s of motion")
    state = guard.law.state.tank
    put_in = state.granted_J + state.received_J
    assert abs(state.energy_J + state.work_out_J + state.sent_J + state.vented_J - put_in) < 1e-9
    side = platform.sides["left"]
    assert state.received_J <= side.sender.sent_J + 1e-12  # what is missing is in flight
    assert side.credited_J <= state.sent_J + 1e-12
    assert state.energy_J >= 0.0


def test_bad_datagrams_are_counted_and_change_nothing():
    with FakePlatform() as platform, running_console(platform) as program:
        link, guard = program.link, program.hands["left"].guard
        platform.wait_for(lambda: guard.engagement == 0, "the platform")
        good = platform.down()
        good.left.engagement, good.left.state = 7, ChannelState.ENGAGED
        data = good.encode()
        platform.send_raw(data[:-1])
        platform.send_raw(data[:40] + bytes([data[40] ^ 1]) + data[41:])
        platform.send_raw(b"noise")
        old = TouchballDown(session=platform.session - 1, seq=10**9)
        old.left.engagement = 9
        platform.send_raw(old.encode())
        platform.wait_for(lambda: link.counts.refused == 3 and link.filter.counts.old_session == 1, "the counts")
        assert "CRC-32" in link.counts.last_refusal or "bytes" in link.counts.last_refusal
        assert guard.engagement == 0 and guard.state == ChannelState.WAITING


def test_addresses_beyond_this_computer_are_refused():
    loopback, far = Address("127.0.0.1", 0), Address("192.0.2.1", 48010)
    with pytest.raises(ConfigError, match=r"platform = 192\.0\.2\.1:48010.*loopback"):
        TouchballLink(loopback, far, 1, 0.06)
    with pytest.raises(ConfigError, match=r"listen = 0\.0\.0\.0:0.*loopback"):
        TouchballLink(Address("0.0.0.0", 0), Address("127.0.0.1", 1), 1, 0.06)
    with pytest.raises(ConfigError, match="HOST:PORT"):
        Address.parse("localhost", "platform")


def test_a_taken_port_is_named():
    first = TouchballLink(Address("127.0.0.1", 0), Address("127.0.0.1", 1), 1, 0.06)
    with pytest.raises(ConfigError, match="another console"):
        TouchballLink(first.address, Address("127.0.0.1", 1), 1, 0.06)
    first.close()
