"""A TCP relay between the arm's clients and the arm, whose connections can be cut and kept away."""

from __future__ import annotations

import asyncio
import contextlib
import threading


class TcpGate:
    """Relays connections to ``port`` on to ``target_port``; cut() closes all, and refuses new ones while shut."""

    def __init__(self, port: int, target_port: int) -> None:
        self._port, self._target = port, target_port
        self._writers: set[asyncio.StreamWriter] = set()
        self._shut = False
        self._loop = asyncio.new_event_loop()
        threading.Thread(target=self._loop.run_forever, daemon=True).start()
        self._server = self._do(asyncio.start_server(self._serve, "127.0.0.1", port))

    def cut(self, shut: bool) -> None:
        """Resets every connection; shut: new ones are closed at once, until cut(False) or open()."""
        self._shut = shut
        self._do(self._close_all())

    def open(self) -> None:
        """Lets new connections pass again."""
        self._shut = False

    def close(self) -> None:
        """Ends it."""
        self._shut = True
        self._do(self._close_all())
        self._loop.call_soon_threadsafe(self._server.close)

    def _do(self, coroutine):
        return asyncio.run_coroutine_threadsafe(coroutine, self._loop).result(10.0)

    async def _close_all(self) -> None:
        for writer in list(self._writers):
            writer.transport.abort()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if self._shut:
            writer.transport.abort()
            return
        try:
            far_reader, far_writer = await asyncio.open_connection("127.0.0.1", self._target)
        except OSError:
            writer.transport.abort()
            return
        both = {writer, far_writer}
        self._writers |= both
        with contextlib.suppress(OSError):
            await asyncio.gather(_relay(reader, far_writer), _relay(far_reader, writer))
        self._writers -= both


async def _relay(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
    try:
        while data := await reader.read(65536):
            writer.write(data)
            await writer.drain()
    finally:
        writer.transport.abort()
