"""The arm's link over real sockets: what may move the arm, and what each end notices."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import time
from pathlib import Path

import aiohttp
import numpy as np
import pytest
import socketio
from mesa_link_peers import HOME, PATIENCE_S, arm, driver, eventually, patiently, pose, python

from saras.mesa_link import ArmLinkError, LinkTimes, MaxVelocity, Reason, SocketIoArmDriver, Tool
from saras.mesa_link.gate import GateConfig
from saras.mesa_link.protocol import Header, command


def test_target_moves_the_arm_and_state_echoes_it() -> None:
    with arm() as server, driver(server.url) as client:
        goal = pose(dx=0.005)

        def arrived() -> bool:
            patiently(lambda: client.command_pose(goal))
            latest = client.latest_state()
            return latest is not None and np.allclose(latest.state.position, goal[:3, 3], atol=1e-6)

        eventually(arrived, "the tip at its target")
        state = client.latest_state().state
        assert state.following and state.controller == "test" and state.session == client.stats().session
        assert state.target.session == state.session and np.allclose(state.target.position, goal[:3, 3])
        eventually(lambda: not client.latest_state().state.following, "hold when targets cease")
        assert set(server.dropped) <= {Reason.EXPIRED}  # a busy machine may be late


def test_tool_and_settings_are_answered() -> None:
    with arm() as server, driver(server.url) as client:
        patiently(lambda: client.command_tool(Tool(0.5, 1.0, None, 1.0)))
        patiently(lambda: client.set_rcm((0.1, 0.0, -0.1)))
        patiently(lambda: client.set_max_velocity(MaxVelocity(0.02, 0.5)))
        patiently(lambda: client.set_mode("parallel"))
        patiently(lambda: client.brake(False))
        eventually(lambda: server.plant.tool == Tool(0.5, 1.0, None, 1.0), "tool")
        assert (server.plant.rcm, server.plant.speed) == ((0.1, 0.0, -0.1), 0.02)
        assert (server.plant.mode, server.plant.brakes) == ("parallel", False)
        with pytest.raises(ArmLinkError, match=r"set_mode\.mode: expected pivot or parallel"):
            patiently(lambda: client.set_mode("free"))
        patiently(lambda: client.command_pose(pose()))
        eventually(lambda: client.stats().nacks[Reason.BRAKES_OPEN], "nack: brakes open")
        assert server.plant.followed == []


def test_second_controller_is_refused_and_readers_are_not() -> None:
    with arm() as server, driver(server.url, client="first") as first:
        with driver(server.url, client="second") as second, driver(server.url, client="eye", control=False) as reader:
            assert "busy: hello.control: 'first' is in control" in second.stats().last_error
            with pytest.raises(ArmLinkError, match="not in control"):
                second.command_pose(pose())
            with pytest.raises(ArmLinkError, match="not in control"):
                reader.command_pose(pose())
            assert second.latest_state() and reader.latest_state()  # both may read
            first.close()
            eventually(lambda: second.stats().in_control, "control passes on when the first one leaves")
        assert server.plant.followed == []


def test_first_target_must_start_from_measured() -> None:
    with arm() as server, driver(server.url) as client:
        with pytest.raises(ArmLinkError, match=r"must start from the measured pose: 50\.0 mm"):
            patiently(lambda: client.command_pose(pose(dx=0.05)))
        with pytest.raises(ValueError, match="finite"):
            client.command_pose(pose(dx=np.nan))
        assert client.stats().sent == 0 and server.plant.followed == []


class RawClient:
    """A client without our driver's manners."""

    async def __aenter__(self) -> RawClient:
        self.sio = socketio.AsyncClient(reconnection=False)
        self.ticks: list[int] = []
        self.nacks: list[dict[str, object]] = []
        self.sio.on("state", lambda data: self.ticks.append(data["tick"]))
        self.sio.on("nack", self.nacks.append)
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.sio.disconnect()

    async def connect(self, url: str) -> int:
        await self.sio.connect(url, transports=["websocket"])
        answer = await self.sio.call("hello", {"protocol": 1, "client": "raw", "control": True})
        while not self.ticks:
            await asyncio.sleep(0.005)
        return int(answer["session"])

    async def target(self, header: Header, **changes: object) -> str:
        answer = await self.sio.call("set_target", {**command(header, HOME), **changes})
        return str(answer.get("reason", "ok"))


def test_expired_replayed_foreign_and_bad_commands_never_move_the_arm() -> None:
    async def scenario(url: str) -> None:
        async with RawClient() as raw:
            session = await raw.connect(url)
            late = raw.ticks[-1]
            await asyncio.sleep(0.4)  # the age itself
            assert await raw.target(Header(session, 1, late, 1.0)) == Reason.EXPIRED
            assert await raw.target(Header(session, 1, raw.ticks[-1], 1.0)) == "ok"
            assert await raw.target(Header(session, 1, raw.ticks[-1], 1.0)) == Reason.REPLAYED
            assert await raw.target(Header(session - 1, 2, raw.ticks[-1], 1.0)) == Reason.OLD_SESSION
            assert await raw.target(Header(session, 3, raw.ticks[-1] + 10**6, 1.0)) == Reason.MALFORMED
            for position in ([float("nan"), 0, 0], [float("inf"), 0, 0]):
                assert await raw.target(Header(session, 4, raw.ticks[-1], 1.0), position=position) == Reason.NON_FINITE
            assert await raw.target(Header(session, 5, raw.ticks[-1], 1.0), position=[9, 9, 9]) == Reason.UNREACHABLE
            assert await raw.target(Header(session, 6, raw.ticks[-1], 1.0), position="here") == Reason.MALFORMED
            assert [nack["reason"] for nack in raw.nacks][-1] == Reason.MALFORMED
            assert "set_target.position: expected 3 numbers" in str(raw.nacks[-1]["detail"])

    with arm(gate=GateConfig(command_age_limit_s=0.35, heartbeat_timeout_s=5.0)) as server:
        asyncio.run(asyncio.wait_for(scenario(server.url), PATIENCE_S))
        assert len(server.plant.followed) == 1  # the one good command
        assert server.dropped == {
            Reason.EXPIRED: 1,
            Reason.REPLAYED: 1,
            Reason.OLD_SESSION: 1,
            Reason.MALFORMED: 2,
            Reason.NON_FINITE: 2,
            Reason.UNREACHABLE: 1,
        }


def test_broken_json_is_refused_by_name_and_the_connection_lives() -> None:
    async def scenario(url: str) -> None:
        address = url.replace("http", "ws") + "/socket.io/?EIO=4&transport=websocket"
        async with aiohttp.ClientSession() as web, web.ws_connect(address) as socket:
            await socket.receive()  # Engine.IO open
            await socket.send_str("40")  # Socket.IO connect
            await socket.receive()
            for packet in ('42["set_target",{"seq":', "42nonsense", '42["set_target"]', '42["set_target",7]'):
                await socket.send_str(packet)
                answer = await socket.receive_str()
                assert answer.startswith('42["nack"') and "malformed" in answer, answer
            await socket.send_str('421["hello",{"protocol":1,"client":"raw","control":false}]')
            assert '"ok":true' in (await socket.receive_str()).replace(" ", "")

    with arm() as server:
        asyncio.run(asyncio.wait_for(scenario(server.url), PATIENCE_S))
        assert server.dropped == {Reason.MALFORMED: 4}


FREEZABLE = """
import sys, time
sys.path[:0] = [sys.argv[2]]
from mesa_link_peers import driver, pose
from saras.mesa_link import ArmLinkError
with driver(sys.argv[1], client="freezable") as client:
    print("in control")
    x = 0.0
    while True:
        x += 1e-6
        try:
            client.command_pose(pose(dx=x))
        except ArmLinkError:
            pass
        time.sleep(0.005)
"""


def test_frozen_client_loses_control_and_its_backlog_never_arrives() -> None:
    with arm() as server:
        process = python(FREEZABLE, server.url, str(Path(__file__).parent))
        try:
            assert process.stdout.readline().strip() == "in control"
            eventually(lambda: len(server.plant.followed) > 20, "targets followed")
            os.kill(process.pid, signal.SIGSTOP)
            eventually(lambda: not server.server.gate.controller, "control lost by heartbeat")
            session = server.server.commands.in_effect[0]
            followed, holds = len(server.plant.followed), server.plant.holds
            assert holds >= 1
            time.sleep(3.0)  # the freeze itself
            assert len(server.plant.followed) == followed
            os.kill(process.pid, signal.SIGCONT)
            eventually(lambda: len(server.plant.followed) > followed, "a new session from measured")
            assert server.server.commands.in_effect[0] > session  # nothing of the old session was followed
        finally:
            process.kill()
            process.wait()


def test_closed_server_is_noticed_and_the_other_arm_goes_on() -> None:
    with arm() as left, arm() as right, driver(left.url) as left_client, driver(right.url) as right_client:
        left.close()
        eventually(lambda: not left_client.stats().connected, "the loss is noticed")
        with pytest.raises(ArmLinkError):
            left_client.command_pose(pose())
        before = len(right.plant.followed)
        patiently(lambda: right_client.command_pose(pose(dx=0.001)))
        eventually(lambda: len(right.plant.followed) > before, "the other arm follows")


def test_silent_server_half_open() -> None:
    with arm() as server, driver(server.url) as client:
        client.inject("silent")

        def stale() -> bool:
            try:
                client.command_pose(pose())
            except ArmLinkError as error:
                return "ms old" in str(error) or "not in control" in str(error)
            return False

        eventually(stale, "commands refused while the arm is silent")
        eventually(lambda: "no state from the arm" in client.stats().last_error, "the connection is given up")


def test_nothing_given_while_down_is_sent_after_reconnecting() -> None:
    with arm() as server, driver(server.url) as client:
        session, port = client.stats().session, server.server.port
        server.close()
        eventually(lambda: not client.stats().connected, "down")
        for _ in range(50):
            with pytest.raises(ArmLinkError):
                client.command_pose(pose(dx=0.001))
        with arm(port=port) as again:
            eventually(lambda: client.stats().in_control, "control again")
            assert client.stats().session != session
            time.sleep(0.2)
            assert again.plant.followed == [] and again.server.gate.session == client.stats().session


def test_only_the_newest_command_is_kept() -> None:
    patient = arm(gate=GateConfig(command_age_limit_s=5.0))
    with patient as server, driver(server.url, times=LinkTimes(max_age_s=5.0)) as client:
        for k in range(200):
            patiently(lambda k=k: client.command_pose(pose(dx=1e-5 * k)))
        last = tuple(pose(dx=1e-5 * 199)[:3, 3].tolist())
        eventually(lambda: server.plant.followed and server.plant.followed[-1].position == last, "the newest")
        assert client.stats().sent + client.stats().superseded == 200


def test_bad_states_are_counted_and_not_taken() -> None:
    with arm() as server, driver(server.url) as client:
        server.plant.position = (float("nan"), 0.0, 0.0)
        eventually(lambda: client.stats().bad_states, "bad states counted")
        assert "state.position" in client.stats().last_error
        assert np.isfinite(client.latest_state().state.position).all()


def test_faults_are_refused_where_not_allowed() -> None:
    refusal = pytest.raises(ArmLinkError, match="unsupported: inject")
    with arm(allow_faults=False) as server, driver(server.url) as client, refusal:
        client.inject("frozen")


def test_no_arm_at_all_says_so() -> None:
    lonely = SocketIoArmDriver("http://127.0.0.1:9", "test")  # the discard port: nobody listens
    with pytest.raises(ArmLinkError, match=r"no state from the arm within 0\.5 s"):
        lonely.connect(0.5)
    lonely.close()


def test_each_reader_gets_the_rate_and_truth_that_it_asks_for() -> None:
    truths = []
    with arm(state_rate_hz=200.0) as server, driver(server.url, control=False) as every:
        options = {"control": False, "state_rate_hz": 50.0, "truth_rate_hz": 20.0, "on_truth": truths.append}
        ticks = []
        with driver(server.url, client="slow", on_state=lambda received: ticks.append(received.state.tick), **options):
            eventually(lambda: len(ticks) > 10 and len(truths) > 3, "states and truths")
        assert all(tick % 4 == 0 for tick in ticks) and all(truth.tick % 10 == 0 for truth in truths)
        assert every.stats().states > len(ticks)


def test_the_arms_log_says_what_was_taken_and_what_was_not(tmp_path) -> None:
    async def scenario(url: str) -> None:
        async with RawClient() as raw:
            session = await raw.connect(url)
            assert await raw.target(Header(session, 1, raw.ticks[-1], 0.15)) == "ok"
            assert await raw.target(Header(session, 1, raw.ticks[-1], 0.15)) == Reason.REPLAYED

    with arm(log=tmp_path / "arm.jsonl") as server:
        asyncio.run(scenario(server.url))
    lines = [json.loads(line) for line in (tmp_path / "arm.jsonl").read_text().splitlines()]
    (taken,) = [line for line in lines if "command" in line and "refused" not in line]
    (refused,) = [line for line in lines if "refused" in line]
    ticks = [line["tick"] for line in lines if "tick" in line]
    assert (taken["command"], taken["seq"], tuple(taken["position"])) == ("set_target", 1, HOME.position)
    assert (refused["refused"], refused["command"], refused["seq"]) == (Reason.REPLAYED, "set_target", 1)
    assert ticks == list(range(1, len(ticks) + 1))
    assert lines == sorted(lines, key=lambda line: line["t_s"])
