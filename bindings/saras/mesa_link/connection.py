"""The thread that holds the Socket.IO connection to one arm, with an asyncio loop of its own.

Nothing old is ever sent: one slot an event holds the newest command; slots are emptied when the link or the
session ends or the arm's state is stale; each reconnection uses a new client, so that what the old one still
held in its queues is gone with it.
"""

from __future__ import annotations

import asyncio
import contextlib
import copy
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import aiohttp
import socketio

from saras.mesa_link import wire_json
from saras.mesa_link.driver import ArmLinkError, LinkStats, Received
from saras.mesa_link.fields import MessageError
from saras.mesa_link.lag import LagMeter
from saras.mesa_link.protocol import Header, Hello, Reason, State, Target, Tool, Truth, command

_CONTROL_LOST = (Reason.OLD_SESSION, Reason.NOT_IN_CONTROL)
_CONNECT_TIMEOUT_S = 2.0


@dataclass(frozen=True)
class LinkTimes:
    """Times of one connection [s]."""

    max_age_s: float = 0.10  # after the state it was decided on, a command is void
    heartbeat_s: float = 0.05
    stale_s: float = 0.10  # no command leaves when the newest state is older
    silence_s: float = 0.50  # without any state for this long the connection is made anew
    retry_s: float = 0.25  # between attempts to connect, and to get control


@dataclass(frozen=True)
class Command:
    """A command that waits to be sent: decided on state ``echo_tick``, good for ``session`` only."""

    event: str
    part: Target | Tool
    echo_tick: int
    session: int


class _Packet(socketio.packet.Packet):  # type: ignore[misc]
    json = wire_json
    uses_binary_events = False


class Connection:
    """Connects, greets, sends heartbeats and the newest commands, until stopped. Methods from any thread."""

    def __init__(
        self,
        url: str,
        hello: Hello,
        times: LinkTimes,
        on_state: Callable[[Received], None] | None,
        on_truth: Callable[[Truth], None] | None,
    ) -> None:
        self.latest: Received | None = None
        self.first_state = threading.Event()
        self._url, self._hello, self._times = url, hello, times
        self._state_callback, self._truth_callback = on_state, on_truth
        self._lock = threading.Lock()
        self._stats = LinkStats()
        self._slots: dict[str, Command] = {}
        self._seq = 0
        self._closing = threading.Event()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._wake: asyncio.Event  # made with the loop
        self._client: Any = None
        self._lag = LagMeter()
        self._thread = threading.Thread(target=self._run, name=f"arm link {hello.client}", daemon=True)

    def start(self) -> None:
        """Begin to connect; a second call does nothing."""
        if not self._thread.is_alive():
            self._thread.start()

    def stop(self) -> None:
        """Disconnect and end the thread."""
        self._closing.set()
        self._poke()
        if self._thread.is_alive():
            self._thread.join(timeout=2.0)

    def stats(self) -> LinkStats:
        """A copy of the counters."""
        with self._lock:
            return copy.deepcopy(self._stats)

    def standing(self) -> tuple[bool, int, str]:
        """In control, session, last error."""
        with self._lock:
            return self._stats.in_control, self._stats.session, self._stats.last_error

    def put(self, item: Command) -> None:
        """Send ``item`` soon; it replaces an older one of the same event that has not left yet."""
        with self._lock:
            self._stats.superseded += item.event in self._slots
            self._slots[item.event] = item
        self._poke()

    def request(self, event: str, fields: dict[str, Any], timeout_s: float, echo_tick: int | None = None) -> None:
        """Send and wait for the answer; with ``echo_tick`` it is a command. ArmLinkError when refused or unanswered."""
        if self._loop is None or not self._stats.connected:
            raise ArmLinkError(f"{self._url}: not connected ({self._stats.last_error or 'connecting'})")
        future = asyncio.run_coroutine_threadsafe(self._call(event, fields, timeout_s, echo_tick), self._loop)
        try:
            answer = future.result(timeout_s + 0.5)
        except (TimeoutError, asyncio.TimeoutError, socketio.exceptions.SocketIOError) as error:
            future.cancel()
            raise ArmLinkError(f"{self._url}: no answer to {event} within {timeout_s:g} s") from error
        if not isinstance(answer, dict) or not answer.get("ok"):
            refusal = answer if isinstance(answer, dict) else {"reason": Reason.MALFORMED, "detail": str(answer)[:80]}
            raise ArmLinkError(f"{refusal.get('reason')}: {refusal.get('detail')}")

    def _poke(self) -> None:
        if self._loop is not None:
            with contextlib.suppress(RuntimeError):  # the loop has just been closed
                self._loop.call_soon_threadsafe(self._wake.set)

    # -- the loop thread ---------------------------------------------------------------------------------------

    def _run(self) -> None:
        asyncio.run(self._main())

    async def _main(self) -> None:
        self._wake, self._loop = asyncio.Event(), asyncio.get_running_loop()
        while not self._closing.is_set():
            error_text = "the arm closed the connection"
            try:
                async with aiohttp.ClientSession() as http:
                    await self._connect_and_serve(http)
            except Exception as error:  # whatever it is, the session ends, the reason is shown and we try again
                error_text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
            with self._lock:
                self._end_session()
                self._stats.connected = False
                self._stats.last_error = error_text
            if not self._closing.is_set():
                await asyncio.sleep(self._times.retry_s)

    async def _connect_and_serve(self, http: aiohttp.ClientSession) -> None:
        self._client = client = socketio.AsyncClient(
            reconnection=False, handle_sigint=False, http_session=http, serializer=_Packet
        )
        client.on("state", self._on_state)
        client.on("truth", self._on_truth)
        client.on("nack", self._on_nack)
        try:
            await asyncio.wait_for(client.connect(self._url, transports=["websocket"]), _CONNECT_TIMEOUT_S)
            with self._lock:
                self._stats.connected = True
            await self._serve(client)
        finally:
            with contextlib.suppress(asyncio.TimeoutError, OSError):
                await asyncio.wait_for(client.disconnect(), 0.2)

    def _end_session(self) -> None:
        """Under the lock: no command outlives its session."""
        self._stats.session = 0
        self._stats.in_control = False
        self._stats.discarded += len(self._slots)
        self._slots.clear()

    async def _greet(self, client: Any) -> None:
        """Say hello; when control is refused the reason is kept and it is tried again later."""
        answer = await client.call("hello", self._hello.__dict__, timeout=1)
        with self._lock:
            self._end_session()
            if answer.get("ok"):
                self._seq = 0
                self._stats.session = int(answer["session"])
                self._stats.in_control = self._hello.control
                self._stats.sessions += 1
                self._stats.last_error = ""
            else:
                self._stats.last_error = f"{answer.get('reason')}: {answer.get('detail')}"

    async def _serve(self, client: Any) -> None:
        self._lag = LagMeter()
        await self._greet(client)
        began = greeted = sent = time.monotonic()
        while client.connected and not self._closing.is_set():
            with contextlib.suppress(asyncio.TimeoutError):
                await asyncio.wait_for(self._wake.wait(), self._times.heartbeat_s)
            self._wake.clear()
            now = time.monotonic()
            silent_s = now - max(began, self.latest.received_s if self.latest else began)
            if silent_s > self._times.silence_s:
                raise ArmLinkError(f"no state from the arm for {1e3 * silent_s:.0f} ms")
            in_control, _, _ = self.standing()
            if self._hello.control and not in_control and now - greeted > self._times.retry_s:
                greeted = now
                await self._greet(client)
            if await self._send_newest(client, silent_s):
                sent = now
            elif in_control and self.latest is not None and now - sent >= 0.9 * self._times.heartbeat_s:
                await client.emit("heartbeat", command(self._header(self.latest.state.tick)))
                sent = now

    async def _send_newest(self, client: Any, state_age_s: float) -> bool:
        with self._lock:
            waiting, self._slots = list(self._slots.values()), {}
            fresh = state_age_s <= self._times.stale_s
            good = [item for item in waiting if fresh and item.session == self._stats.session]
            self._stats.discarded += len(waiting) - len(good)
            self._stats.sent += len(good)
        for item in good:
            await client.emit(item.event, command(self._header(item.echo_tick), item.part))
        return bool(good)

    async def _call(self, event: str, fields: dict[str, Any], timeout_s: float, echo_tick: int | None) -> object:
        data = fields if echo_tick is None else command(self._header(echo_tick), **fields)
        return await self._client.call(event, data, timeout=timeout_s)

    def _header(self, echo_tick: int) -> Header:
        """In the loop thread only, so that seq rises in the order of sending."""
        self._seq += 1
        return Header(self._stats.session, self._seq, echo_tick, self._times.max_age_s)

    def _on_state(self, data: object) -> None:
        now = time.monotonic()
        try:
            state = State.parse(data)
        except MessageError as error:
            with self._lock:
                self._stats.bad_states += 1
                self._stats.last_error = str(error)
            return
        received = Received(state, now, self._lag.step(now, state.time_s))
        self.latest = received
        with self._lock:
            self._stats.states += 1
        self.first_state.set()
        if self._state_callback is not None:
            self._state_callback(received)

    def _on_truth(self, data: object) -> None:
        if self._truth_callback is not None:
            self._truth_callback(Truth.parse(data))

    def _on_nack(self, data: object) -> None:
        fields = data if isinstance(data, dict) else {}
        reason = str(fields.get("reason", Reason.MALFORMED))
        with self._lock:
            self._stats.nacks[reason] += 1
            self._stats.last_error = f"{reason}: {str(fields.get('detail'))[:200]}"
            if reason in _CONTROL_LOST and self._stats.in_control:
                self._end_session()  # a new one begins with the next hello, from the measured pose
