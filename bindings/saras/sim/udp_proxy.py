"""An impaired network in user space: forwards datagrams between two UDP peers, over the experiments' Channel.

The client sends to the proxy; the proxy forwards to the server from a socket of its own, and what comes back goes to
the client's last address. Both directions have the same impairments and draw from their own seeds. As a program with
control over its standard input: ``saras udp-proxy`` (saras.sim.udp_proxy_command).
"""

from __future__ import annotations

import asyncio
import copy
import math
import sys
from collections.abc import Callable

from saras._core.sim import ChannelConfig, ChannelCounters
from saras.sim.datagram_faults import DatagramFaults
from saras.sim.link import Link

Address = tuple[str, int]

LOCALHOST = "127.0.0.1"


class Direction:
    """One way: faults counted in datagrams, then a link, and a timer for its next arrival."""

    def __init__(self, config: ChannelConfig, deliver: Callable[[bytes], None]) -> None:
        self.link: Link[bytes] = Link(config)
        self.faults = DatagramFaults(config.seed)
        self._deliver = deliver
        self._loop = asyncio.get_running_loop()
        self._timer: asyncio.TimerHandle | None = None

    def accept(self, datagram: bytes) -> None:
        """A datagram of this direction's sender."""
        for each in self.faults.pass_on(datagram):
            self.link.send(each, self._loop.time())
        self.flush()

    def replay(self, count: int) -> int:
        """Sends the newest ``count`` recorded datagrams once more, at once; returns how many there were."""
        recorded = self.faults.recorded(count)
        for datagram in recorded:
            self._deliver(datagram)
        return len(recorded)

    def impair(self, config: ChannelConfig) -> None:
        """From now on these impairments; what is under way comes at once."""
        for datagram in self.link.receive(math.inf):
            self._deliver(datagram)
        self.link = Link(config)
        self.flush()

    def flush(self) -> None:
        """Delivers what is due and sets the timer for the rest."""
        for datagram in self.link.receive(self._loop.time()):
            self._deliver(datagram)
        self.close()
        due = self.link.next_arrival
        if math.isfinite(due):
            self._timer = self._loop.call_at(due, self.flush)

    def close(self) -> None:
        """Stops the timer."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


class _Endpoint(asyncio.DatagramProtocol):
    """A socket whose datagrams go to a callback."""

    def __init__(self, received: Callable[[bytes, Address], None]) -> None:
        self._received = received

    def datagram_received(self, data: bytes, address: Address) -> None:
        self._received(data, address)

    def error_received(self, error: Exception) -> None:
        """Ignore it: the peer's port may be closed now; a network does not mind either."""


class UdpProxy:
    """Proxy between a client and a server. Use ``await UdpProxy.start(…)`` and ``close()``."""

    def __init__(self, server: Address, config: ChannelConfig) -> None:
        """Take the server's address and the impairments of each direction."""
        self._server = server
        self._client: Address | None = None
        self._front: asyncio.DatagramTransport | None = None
        self._back: asyncio.DatagramTransport | None = None
        self.up = Direction(config, self._to_server)
        self.down = Direction(_for_down(config), self._to_client)

    @classmethod
    async def start(
        cls, listen: Address, server: Address, config: ChannelConfig | None = None, send_from: Address | None = None
    ) -> UdpProxy:
        """Open both sockets; port 0 listens on a free port (``address``).

        ``send_from``: where the server is sent from, for a server that answers to a fixed address (the platform's
        console_host and console_port) instead of the sender's.
        """
        proxy = cls(server, config if config is not None else ChannelConfig())
        loop = asyncio.get_running_loop()
        proxy._front, _ = await loop.create_datagram_endpoint(lambda: _Endpoint(proxy._from_client), local_addr=listen)
        proxy._back, _ = await loop.create_datagram_endpoint(
            lambda: _Endpoint(proxy._from_server), local_addr=send_from, remote_addr=server
        )
        return proxy

    @property
    def address(self) -> Address:
        """Where the client should send to."""
        assert self._front is not None
        host, port = self._front.get_extra_info("sockname")[:2]
        return str(host), int(port)

    @property
    def counters(self) -> tuple[ChannelCounters, ChannelCounters]:
        """What the channels did: client to server, server to client."""
        return self.up.link.counters, self.down.link.counters

    def blackout(self, seconds: float) -> None:
        """Lose everything, both ways, for some seconds from now."""
        until = asyncio.get_running_loop().time() + seconds
        self.up.link.blackout_until(until)
        self.down.link.blackout_until(until)

    def hold(self, seconds: float) -> None:
        """Keep everything back for some seconds from now, then release it at once."""
        until = asyncio.get_running_loop().time() + seconds
        for direction in (self.up, self.down):
            direction.link.hold_until(until)
            direction.flush()

    def impair(self, config: ChannelConfig) -> None:
        """From now on these impairments in both directions."""
        self.up.impair(config)
        self.down.impair(_for_down(config))

    def close(self) -> None:
        """Close the sockets and drop what is under way."""
        for direction in (self.up, self.down):
            direction.close()
        for transport in (self._front, self._back):
            if transport is not None:
                transport.close()

    def _from_client(self, data: bytes, address: Address) -> None:
        self._client = address
        self.up.accept(data)

    def _from_server(self, data: bytes, _address: Address) -> None:
        self.down.accept(data)

    def _to_server(self, data: bytes) -> None:
        if self._back is not None and not self._back.is_closing():
            self._back.sendto(data)

    def _to_client(self, data: bytes) -> None:
        if self._front is not None and self._client is not None and not self._front.is_closing():
            self._front.sendto(data, self._client)


def _for_down(config: ChannelConfig) -> ChannelConfig:
    """The same impairments, drawn anew."""
    other = copy.copy(config)
    other.seed = config.seed + 1
    return other


def parse_address(text: str) -> Address:
    """``48010`` or ``host:48010``."""
    host, _, port = text.rpartition(":")
    return host or LOCALHOST, int(port)


if __name__ == "__main__":
    from saras.cli import main

    sys.exit(main(["udp-proxy", *sys.argv[1:]]))
