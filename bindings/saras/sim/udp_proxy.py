"""An impaired network in user space: forwards datagrams between two UDP peers over the same Channel as the experiments.

    python -m saras.sim.udp_proxy --listen 48110 --to 127.0.0.1:48010 --delay-ms 100 --loss 0.1

The client sends to ``--listen``; the proxy forwards to ``--to`` from a port of its own, and what comes back goes to the
client's last address. Both directions have the same impairments and draw from their own seeds.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import copy
import json
import math
import sys
from collections.abc import Callable

from saras._core.sim import ChannelConfig, ChannelCounters
from saras.sim.link import Link

Address = tuple[str, int]

LOCALHOST = "127.0.0.1"


class _Direction:
    """One way: a link, and a timer for its next arrival."""

    def __init__(self, config: ChannelConfig, deliver: Callable[[bytes], None]) -> None:
        self.link: Link[bytes] = Link(config)
        self._deliver = deliver
        self._loop = asyncio.get_running_loop()
        self._timer: asyncio.TimerHandle | None = None

    def accept(self, datagram: bytes) -> None:
        self.link.send(datagram, self._loop.time())
        self.flush()

    def flush(self) -> None:
        for datagram in self.link.receive(self._loop.time()):
            self._deliver(datagram)
        self.close()
        due = self.link.next_arrival
        if math.isfinite(due):
            self._timer = self._loop.call_at(due, self.flush)

    def close(self) -> None:
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
        back_config = copy.copy(config)
        back_config.seed = config.seed + 1
        self._up = _Direction(config, self._to_server)
        self._down = _Direction(back_config, self._to_client)

    @classmethod
    async def start(cls, listen: Address, server: Address, config: ChannelConfig | None = None) -> UdpProxy:
        """Open both sockets; port 0 listens on a free port (``address``)."""
        proxy = cls(server, config if config is not None else ChannelConfig())
        loop = asyncio.get_running_loop()
        proxy._front, _ = await loop.create_datagram_endpoint(lambda: _Endpoint(proxy._from_client), local_addr=listen)
        proxy._back, _ = await loop.create_datagram_endpoint(lambda: _Endpoint(proxy._from_server), remote_addr=server)
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
        return self._up.link.counters, self._down.link.counters

    def blackout(self, seconds: float) -> None:
        """Lose everything, both ways, for some seconds from now."""
        until = asyncio.get_running_loop().time() + seconds
        self._up.link.blackout_until(until)
        self._down.link.blackout_until(until)

    def hold(self, seconds: float) -> None:
        """Keep everything back for some seconds from now, then release it at once."""
        until = asyncio.get_running_loop().time() + seconds
        for direction in (self._up, self._down):
            direction.link.hold_until(until)
            direction.flush()

    def close(self) -> None:
        """Close the sockets and drop what is under way."""
        for direction in (self._up, self._down):
            direction.close()
        for transport in (self._front, self._back):
            if transport is not None:
                transport.close()

    def _from_client(self, data: bytes, address: Address) -> None:
        self._client = address
        self._up.accept(data)

    def _from_server(self, data: bytes, _address: Address) -> None:
        self._down.accept(data)

    def _to_server(self, data: bytes) -> None:
        if self._back is not None and not self._back.is_closing():
            self._back.sendto(data)

    def _to_client(self, data: bytes) -> None:
        if self._front is not None and self._client is not None and not self._front.is_closing():
            self._front.sendto(data, self._client)


def parse_address(text: str) -> Address:
    """``48010`` or ``host:48010``."""
    host, _, port = text.rpartition(":")
    return host or LOCALHOST, int(port)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m saras.sim.udp_proxy", description=__doc__.split("\n")[0])
    parser.add_argument(
        "--listen", type=parse_address, required=True, metavar="[HOST:]PORT", help="the client sends here"
    )
    parser.add_argument("--to", type=parse_address, required=True, metavar="[HOST:]PORT", help="the server")
    parser.add_argument("--delay-ms", type=float, default=0.0, help="one way")
    parser.add_argument("--jitter-ms", type=float, default=0.0)
    parser.add_argument("--loss", type=float, default=0.0, help="probability, 0 to 1")
    parser.add_argument("--duplicate", type=float, default=0.0, help="probability, 0 to 1")
    parser.add_argument("--reorder", type=float, default=0.0, help="probability, 0 to 1")
    parser.add_argument("--reorder-ms", type=float, default=20.0, help="how late an overtaken datagram comes")
    parser.add_argument("--burst-rate-hz", type=float, default=0.0, help="how often a loss burst begins")
    parser.add_argument("--burst-ms", type=float, default=100.0, help="how long it lasts")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--duration", type=float, default=math.inf, help="seconds; for ever by default")
    return parser


async def _serve(arguments: argparse.Namespace) -> None:
    config = ChannelConfig(
        delay_s=arguments.delay_ms * 1e-3,
        jitter_s=arguments.jitter_ms * 1e-3,
        loss=arguments.loss,
        duplicate=arguments.duplicate,
        reorder=arguments.reorder,
        reorder_s=arguments.reorder_ms * 1e-3,
        burst_rate_hz=arguments.burst_rate_hz,
        burst_s=arguments.burst_ms * 1e-3,
        seed=arguments.seed,
    )
    proxy = await UdpProxy.start(arguments.listen, arguments.to, config)
    print("{}:{}".format(*proxy.address), flush=True)
    try:
        await asyncio.sleep(arguments.duration if math.isfinite(arguments.duration) else 1e9)
    finally:
        up, down = proxy.counters
        proxy.close()
        fields = ("sent", "lost", "duplicated", "reordered", "delivered")
        print(json.dumps({n: {f: getattr(c, f) for f in fields} for n, c in (("up", up), ("down", down))}), flush=True)


def main() -> int:
    """Run until interrupted; print the address first and the counters last."""
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_serve(_parser().parse_args()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
