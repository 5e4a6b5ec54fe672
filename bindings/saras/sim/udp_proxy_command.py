"""An impaired UDP network between two programs on this computer, under control while it runs.

  saras udp-proxy --listen 48012 --to 48010 --send-from 48011 --delay-ms 50 --loss 0.1
  saras console --platform 127.0.0.1:48012 --listen 127.0.0.1:48013

The address that it listens on is printed first, counters last. Each line of its standard input is a command, answered
by one line of JSON; [up|down] is the direction, both without it (up: from the client to --to):

  drop N [up|down]        lose the next N datagrams
  swap N [up|down]        let the next N come after their successors
  duplicate N [up|down]   let the next N come twice
  flip N [up|down]        turn one bit in each of the next N
  replay N [up|down]      send the newest N (at most 4096) once more, at once
  blackout S              lose everything for S seconds
  hold S                  keep everything back for S seconds, then release it at once
  impair KEY=VALUE ...    other impairments from now on; delay_s jitter_s loss duplicate reorder reorder_s
                          burst_rate_hz burst_s
  counters                what was done so far
  quit
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import math
import sys
from typing import Any

from saras import ConfigError, Error
from saras._core.sim import ChannelConfig
from saras.sim.datagram_faults import KINDS
from saras.sim.udp_proxy import UdpProxy, parse_address

COUNTERS = ("sent", "lost", "duplicated", "reordered", "delivered")
IMPAIRMENTS = ("delay_s", "jitter_s", "loss", "duplicate", "reorder", "reorder_s", "burst_rate_hz", "burst_s")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``saras udp-proxy``."""
    address = "[HOST:]PORT"
    parser.add_argument("--listen", type=parse_address, required=True, metavar=address, help="the client sends here")
    parser.add_argument("--to", type=parse_address, required=True, metavar=address, help="the server")
    parser.add_argument(
        "--send-from", type=parse_address, metavar=address, help="own end towards the server (default: any free port)"
    )
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


def run(arguments: argparse.Namespace) -> int:
    """Run until interrupted, told to quit, or the time is over."""
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_serve(arguments))
    return 0


class Control:
    """Commands as text, answers as plain values."""

    def __init__(self, proxy: UdpProxy, config: ChannelConfig) -> None:
        self._proxy, self._config = proxy, config
        self.over = asyncio.Event()

    def obey(self, line: str) -> dict[str, Any]:
        """What one line was answered: {"ok": true, …} or {"ok": false, "error": …}."""
        try:
            return {"ok": True, **self._obey(*line.split())}
        except (Error, ValueError, TypeError) as error:
            return {"ok": False, "error": f"{line.strip()!r}: {error}"}

    def _obey(self, word: str, *rest: str) -> dict[str, Any]:
        if word in KINDS:
            for direction in self._directions(rest[1:]):
                direction.faults.request(word, int(rest[0]))
            return {}
        if word == "replay":
            return {"sent": sum(direction.replay(int(rest[0])) for direction in self._directions(rest[1:]))}
        if word in ("blackout", "hold"):
            (self._proxy.blackout if word == "blackout" else self._proxy.hold)(_seconds(word, rest[0]))
            return {}
        if word == "impair":
            return self._impair(rest)
        if word == "counters":
            return counters(self._proxy)
        if word == "quit":
            self.over.set()
            return {}
        raise ConfigError("no such command; saras udp-proxy --help lists them")

    def _directions(self, rest: tuple[str, ...]) -> list[Any]:
        ways = {"up": self._proxy.up, "down": self._proxy.down}
        if not rest:
            return list(ways.values())
        if len(rest) > 1 or rest[0] not in ways:
            raise ConfigError(f"direction = {' '.join(rest)!r}: must be up or down")
        return [ways[rest[0]]]

    def _impair(self, pairs: tuple[str, ...]) -> dict[str, Any]:
        for pair in pairs:
            key, _, value = pair.partition("=")
            if key not in IMPAIRMENTS:
                raise ConfigError(f"{key}: must be one of {', '.join(IMPAIRMENTS)}")
            setattr(self._config, key, float(value))
        self._proxy.impair(self._config)
        return {}


def _seconds(name: str, text: str) -> float:
    value = float(text)
    if not 0.0 <= value <= 3600.0:
        raise ConfigError(f"{name} = {text}: must be in [0, 3600] s")
    return value


def counters(proxy: UdpProxy) -> dict[str, Any]:
    """Of both directions: what the channel did, and the faults that were asked for."""
    return {
        name: {
            **{field: getattr(direction.link.counters, field) for field in COUNTERS},
            "faults": dict(direction.faults.done),
            "waiting": direction.faults.waiting,
        }
        for name, direction in (("up", proxy.up), ("down", proxy.down))
    }


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
    try:
        proxy = await UdpProxy.start(arguments.listen, arguments.to, config, arguments.send_from)
    except OSError as error:
        raise ConfigError(f"listen, send-from: {error.strerror}") from None
    print("{}:{}".format(*proxy.address), flush=True)
    control = Control(proxy, config)
    listening = asyncio.create_task(_listen(control))
    timeout = arguments.duration if math.isfinite(arguments.duration) else None
    try:
        with contextlib.suppress(asyncio.TimeoutError):
            await asyncio.wait_for(control.over.wait(), timeout)
    finally:
        listening.cancel()
        print(json.dumps(counters(proxy)), flush=True)
        proxy.close()


async def _listen(control: Control) -> None:
    """Commands until the end of the input; the proxy goes on after that."""
    reader = asyncio.StreamReader()
    try:
        await asyncio.get_running_loop().connect_read_pipe(lambda: asyncio.StreamReaderProtocol(reader), sys.stdin)
    except (OSError, ValueError, NotImplementedError):  # no input, or one that cannot be waited for
        return
    while line := await reader.readline():
        if line.strip():
            print(json.dumps(control.obey(line.decode(errors="replace"))), flush=True)
