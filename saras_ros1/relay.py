"""Relays between two networks that have no route to each other: bytes pass, packets do not.

Each has a socket on either side, and passes what one named peer sends to one named address. Nothing is kept: a datagram
that finds no room is lost, a stream whose one end is gone is closed on the other, so that both ends notice.
"""

from __future__ import annotations

import asyncio
import contextlib
import socket

Address = tuple[str, int]
_DATAGRAM_BYTES = 2048
_MOST_AT_ONCE = 64
_CHUNK_BYTES = 1 << 16
_CONNECT_S = 2.0


class DatagramRelay:
    """outer ↔ inner. From outside only `outer_peer`'s host is heard, and only `outer_peer` is answered."""

    def __init__(self, outer: socket.socket, outer_peer: Address, inner: socket.socket, inner_peer: Address) -> None:
        self.foreign = self.lost = 0
        self._outer, self._inner = outer, inner
        self._outer_peer, self._inner_peer = outer_peer, inner_peer
        for each in (outer, inner):
            each.setblocking(False)

    async def run(self) -> None:
        """Until cancelled."""
        loop = asyncio.get_running_loop()
        loop.add_reader(self._outer, self._pass, self._outer, self._outer_peer[0], self._inner, self._inner_peer)
        loop.add_reader(self._inner, self._pass, self._inner, self._inner_peer[0], self._outer, self._outer_peer)
        try:
            await asyncio.Event().wait()
        finally:
            loop.remove_reader(self._outer)
            loop.remove_reader(self._inner)

    def _pass(self, source: socket.socket, host: str, sink: socket.socket, peer: Address) -> None:
        for _ in range(_MOST_AT_ONCE):
            try:
                # One byte more than is passed: an oversized datagram must not become a good prefix.
                data, sender = source.recvfrom(_DATAGRAM_BYTES + 1)
            except OSError:  # nothing more, or a peer that is not there
                return
            if sender[0] != host or len(data) > _DATAGRAM_BYTES:
                self.foreign += 1
                continue
            try:
                sink.sendto(data, peer)
            except OSError:
                self.lost += 1


class QuestionRelay:
    """Datagrams from the inside to one address outside; its answers go back to who asked last."""

    def __init__(self, inner: socket.socket, target: Address) -> None:
        self._inner, self._target = inner, target
        self._outer = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._asker: Address | None = None
        for each in (self._inner, self._outer):
            each.setblocking(False)

    async def run(self) -> None:
        """Until cancelled."""
        self._outer.connect(self._target)
        loop = asyncio.get_running_loop()
        loop.add_reader(self._inner, self._ask)
        loop.add_reader(self._outer, self._answer)
        try:
            await asyncio.Event().wait()
        finally:
            loop.remove_reader(self._inner)
            loop.remove_reader(self._outer)
            self._outer.close()

    def _ask(self) -> None:
        with contextlib.suppress(OSError):
            data, self._asker = self._inner.recvfrom(_DATAGRAM_BYTES)
            self._outer.send(data)

    def _answer(self) -> None:
        with contextlib.suppress(OSError):
            data = self._outer.recv(_DATAGRAM_BYTES)
            if self._asker is not None:
                self._inner.sendto(data, self._asker)


class StreamRelay:
    """Connections that come to `listening` inside go to `target` outside."""

    def __init__(self, listening: socket.socket, target: Address) -> None:
        self._listening, self._target = listening, target

    async def run(self) -> None:
        """Until cancelled."""
        server = await asyncio.start_server(self._serve, sock=self._listening)
        async with server:
            await server.serve_forever()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            connecting = asyncio.open_connection(*self._target)
            far_reader, far_writer = await asyncio.wait_for(connecting, _CONNECT_S)
        except (OSError, asyncio.TimeoutError):
            writer.close()
            return
        for each in (writer, far_writer):
            each.get_extra_info("socket").setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        ways = [asyncio.ensure_future(_pump(reader, far_writer)), asyncio.ensure_future(_pump(far_reader, writer))]
        try:
            await asyncio.wait(ways, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for way in ways:
                way.cancel()
            for each in (writer, far_writer):
                each.transport.abort()  # what the far end did not take is old by now


async def _pump(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    with contextlib.suppress(OSError):
        while data := await reader.read(_CHUNK_BYTES):
            writer.write(data)
            await writer.drain()
