"""The impaired UDP proxy with real sockets on free ports."""

import asyncio
import json
import subprocess
import sys

import pytest

from saras import ConfigError, sim
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


def test_refuses_a_loss_above_one():
    with pytest.raises(ConfigError, match="loss"):
        asyncio.run(session(sim.ChannelConfig(loss=1.1), 1))
    assert parse_address("host:12") == ("host", 12)
    assert parse_address("12") == ("127.0.0.1", 12)
