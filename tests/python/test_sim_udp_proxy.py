"""The impaired UDP proxy with real sockets on free ports."""

import asyncio
import json
import subprocess
import sys

import pytest

from saras import ConfigError, sim
from saras.sim.datagram_faults import DatagramFaults
from saras.sim.udp_proxy import UdpProxy, parse_address

LOCAL = ("127.0.0.1", 0)


class Peer(asyncio.DatagramProtocol):
    """Keeps what it gets; echoes it when asked to."""

    def __init__(self, echo=False):
        self.echo = echo
        self.received = []

    def connection_made(self, transport):
        self.transport = transport

    def datagram_received(self, data, address):
        self.received.append(data)
        if self.echo:
            self.transport.sendto(data, address)


async def session(config, count, wait_s=0.3, during=None):
    loop = asyncio.get_running_loop()
    transport, server = await loop.create_datagram_endpoint(lambda: Peer(echo=True), local_addr=LOCAL)
    proxy = await UdpProxy.start(LOCAL, transport.get_extra_info("sockname")[:2], config)
    client_transport, client = await loop.create_datagram_endpoint(Peer, remote_addr=proxy.address)
    if during is not None:
        during(proxy)
    for i in range(count):
        client_transport.sendto(b"%d" % i)
        await asyncio.sleep(0)
    await asyncio.sleep(wait_s)
    counters = proxy.counters
    proxy.close()
    transport.close()
    client_transport.close()
    return server.received, client.received, counters


def test_forwards_both_ways_in_order():
    server, client, _ = asyncio.run(session(sim.ChannelConfig(delay_s=0.02), 50))
    assert server == client == [b"%d" % i for i in range(50)]


def test_loses_and_duplicates_as_the_channel_says():
    server, client, (up, down) = asyncio.run(session(sim.ChannelConfig(loss=0.4, duplicate=0.3), 200))
    assert up.sent == 200
    assert 40 < up.lost < 120
    assert len(server) == up.delivered == up.sent - up.lost + up.duplicated
    assert down.sent == len(server)
    assert len(client) == down.delivered


def test_blackout_and_hold():
    server, _, _ = asyncio.run(session(sim.ChannelConfig(), 20, during=lambda proxy: proxy.blackout(10.0)))
    assert server == []
    server, client, _ = asyncio.run(session(sim.ChannelConfig(), 20, during=lambda proxy: proxy.hold(0.1)))
    assert server == client == [b"%d" % i for i in range(20)]


def test_command_line():
    command = [sys.executable, "-m", "saras.sim.udp_proxy", "--listen", "0", "--to", "9", "--duration", "0.1"]
    out = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True).stdout.splitlines()
    assert out[0].startswith("127.0.0.1:")
    assert json.loads(out[1])["up"]["sent"] == 0


def pass_all(faults, count):
    return [each for i in range(count) for each in faults.pass_on(b"%04d" % i)]


def test_faults_are_done_to_so_many_datagrams():
    faults = DatagramFaults(seed=7)
    for kind, count in (("drop", 3), ("duplicate", 5), ("swap", 2)):
        faults.request(kind, count)
    out = pass_all(faults, 20)
    assert faults.done == {"drop": 3, "duplicate": 5, "swap": 2} and faults.waiting == 0
    assert len(out) == 20 - 3 + 5
    assert set(out) == {b"%04d" % i for i in range(3, 20)}
    assert faults.recorded(4) == [b"%04d" % i for i in range(16, 20)]


def test_a_swapped_datagram_comes_after_its_successor():
    faults = DatagramFaults(seed=1)
    faults.request("swap", 2)
    assert pass_all(faults, 6) == [b"%04d" % i for i in (1, 0, 3, 2, 4, 5)]


def test_one_bit_is_turned_and_the_seed_says_which():
    def damaged(seed):
        faults = DatagramFaults(seed)
        faults.request("flip", 50)
        return [faults.pass_on(bytes(100))[0] for _ in range(50)]

    for each in damaged(3):
        assert int.from_bytes(each, "big").bit_count() == 1
    assert damaged(3) == damaged(3) != damaged(4)


def test_faults_that_cannot_be_are_refused():
    with pytest.raises(ConfigError, match="'burn': must be one of drop"):
        DatagramFaults(1).request("burn", 1)
    with pytest.raises(ConfigError, match="drop = -1"):
        DatagramFaults(1).request("drop", -1)


def test_a_replay_sends_once_more_and_new_impairments_deliver_what_is_under_way():
    def during(proxy):
        loop = asyncio.get_running_loop()
        loop.call_later(0.15, lambda: proxy.up.replay(5))
        loop.call_later(0.10, lambda: proxy.impair(sim.ChannelConfig()))

    server, _, _ = asyncio.run(session(sim.ChannelConfig(delay_s=3.0), 10, wait_s=0.4, during=during))
    assert server == [b"%d" % i for i in [*range(10), *range(5, 10)]]


def test_it_sends_from_the_address_that_a_server_answers_to():
    async def run():
        loop = asyncio.get_running_loop()
        server_transport, server = await loop.create_datagram_endpoint(Peer, local_addr=LOCAL)
        free, _ = await loop.create_datagram_endpoint(Peer, local_addr=LOCAL)
        answers_to = free.get_extra_info("sockname")[:2]
        free.close()
        await asyncio.sleep(0.01)
        proxy = await UdpProxy.start(LOCAL, server_transport.get_extra_info("sockname")[:2], None, answers_to)
        client_transport, client = await loop.create_datagram_endpoint(Peer, remote_addr=proxy.address)
        client_transport.sendto(b"up")
        await asyncio.sleep(0.1)
        server_transport.sendto(b"down", answers_to)
        await asyncio.sleep(0.1)
        for transport in (server_transport, client_transport, proxy):
            transport.close()
        return server.received, client.received

    assert asyncio.run(run()) == ([b"up"], [b"down"])


def test_the_program_obeys_its_input():
    command = [sys.executable, "-m", "saras", "udp-proxy", "--listen", "0", "--to", "9"]
    lines = [
        "drop 3 up",
        "blackout 0.1",
        "impair loss=0.5 delay_s=0.01",
        "replay 4",
        "hold nan",
        "swap 1 no",
        "dance",
    ]
    program = subprocess.run(
        command, input="\n".join([*lines, "quit"]), capture_output=True, text=True, timeout=60, check=True
    )
    answers = [json.loads(line) for line in program.stdout.splitlines()[1:]]
    assert [answer.get("ok") for answer in answers[: len(lines)]] == [True] * 4 + [False] * 3
    assert answers[3]["sent"] == 0
    assert "up or down" in answers[5]["error"] and "no such command" in answers[6]["error"]
    assert answers[-1]["up"]["waiting"] == 3


def test_refuses_a_loss_above_one():
    with pytest.raises(ConfigError, match="loss"):
        asyncio.run(session(sim.ChannelConfig(loss=1.1), 1))
    assert parse_address("host:12") == ("host", 12)
    assert parse_address("12") == ("127.0.0.1", 12)
