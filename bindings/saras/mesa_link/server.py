"""The arm's side of the Socket.IO protocol: one server a machine, asyncio, one thread.

Order of one tick: watchdogs, machine, state out. Commands come in between ticks, so the target that a state
reports is the one the servo used for it.
"""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import Awaitable, Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import socketio
from aiohttp import web

from saras import ConfigError
from saras.mesa_link import wire_json
from saras.mesa_link.arm_log import ArmLog
from saras.mesa_link.commands import CommandTable
from saras.mesa_link.faults import FaultInjector
from saras.mesa_link.fields import MessageError
from saras.mesa_link.gate import CommandGate, GateConfig
from saras.mesa_link.plant import ArmPlant
from saras.mesa_link.protocol import (
    COMMANDS,
    MODES,
    PROTOCOL_VERSION,
    Hello,
    Reason,
    State,
    TargetInEffect,
)


@dataclass(frozen=True)
class ArmServerConfig:
    """Where the server listens and how fast it runs. ``port`` 0 takes a free one."""

    name: str
    port: int
    host: str = "127.0.0.1"
    state_rate_hz: float = 200.0
    catch_up_ticks: int = 4  # after a stall at most these are made good at once, the rest is skipped
    ping_interval_s: float = 2.0  # a client that answers no ping for interval + timeout is dropped
    ping_timeout_s: float = 4.0
    allow_faults: bool = False
    log: Path | None = None  # where commands and ticks are written, see arm_log
    gate: GateConfig = field(default_factory=GateConfig)

    def __post_init__(self) -> None:
        if not 0 <= self.port <= 65535:
            raise ConfigError(f"ArmServerConfig.port: {self.port} is not in [0, 65535]")
        if not 10.0 <= self.state_rate_hz <= 1000.0:
            raise ConfigError(f"ArmServerConfig.state_rate_hz: {self.state_rate_hz} is not in [10, 1000] Hz")
        if self.catch_up_ticks < 0:
            raise ConfigError(f"ArmServerConfig.catch_up_ticks: {self.catch_up_ticks} is below 0")


class _Json:
    """JSON for packets; what cannot be parsed becomes a ``malformed`` event, so that its sender can be told."""

    dumps = staticmethod(wire_json.dumps)

    @staticmethod
    def loads(text: str) -> Any:
        try:
            return json.loads(text)  # reads NaN too, so that its sender hears that it is not finite
        except ValueError as error:
            return ["malformed", str(error)]


class _Packet(socketio.packet.Packet):  # type: ignore[misc]
    json = _Json
    uses_binary_events = False  # spares a walk through every state in search of bytes


class ArmServer:
    """Serves one machine. ``await start()``, ``await stop()``; ``port`` tells where it listens."""

    def __init__(self, config: ArmServerConfig, plant: ArmPlant) -> None:
        self.config = config
        self.gate = CommandGate(config.gate, first_session=time.time_ns() // 1_000_000)
        self.commands = CommandTable(plant, self.gate)
        self.faults = FaultInjector()
        self.log = ArmLog(config.log) if config.log is not None else None
        self.port = config.port
        self.skipped_ticks = 0
        self._plant = plant
        self._tick = 0
        self._following = False
        self._readers: dict[str, tuple[int, int]] = {}  # ticks between states, between truths
        self._sio = socketio.AsyncServer(
            async_mode="aiohttp",
            transports=["websocket"],
            serializer=_Packet,
            async_handlers=False,  # commands are taken in the order they were sent
            ping_interval=config.ping_interval_s,
            ping_timeout=config.ping_timeout_s,
            max_http_buffer_size=65536,
        )
        self._runner: web.AppRunner | None = None
        self._loop_task: asyncio.Task[None] | None = None
        self._register()

    async def start(self) -> None:
        """Listen and run."""
        app = web.Application()
        self._sio.attach(app)
        self._runner = web.AppRunner(app, access_log=None, shutdown_timeout=0.5)
        await self._runner.setup()
        site = web.TCPSite(self._runner, self.config.host, self.config.port)
        await site.start()
        self.port = self._runner.addresses[0][1]
        self._loop_task = asyncio.create_task(self._run())

    async def stop(self) -> None:
        """Stop the machine's loop, close all connections."""
        if self._loop_task is not None:
            self._loop_task.cancel()
            await asyncio.gather(self._loop_task, return_exceptions=True)
        await self._sio.shutdown()
        if self._runner is not None:
            await self._runner.cleanup()
        if self.log is not None:
            self.log.close()

    async def wait(self) -> None:
        """Return when the loop ends, raise what ended it."""
        if self._loop_task is not None:
            await self._loop_task

    # -- the machine's loop ------------------------------------------------------------------------------------

    async def _run(self) -> None:
        period = 1.0 / self.config.state_rate_hz
        due = time.monotonic() + period
        while True:
            delay = due - time.monotonic()
            if delay < -self.config.catch_up_ticks * period:
                self.skipped_ticks += int(-delay / period)
                due = time.monotonic()
            await asyncio.sleep(max(0.0, delay))
            await self.tick(period, due)
            due += period

    async def tick(self, period_s: float, sample_time_s: float) -> None:
        """Watchdogs, machine, state out. The state's time is the scheduled one: machine time has no jitter."""
        now = time.monotonic()
        following = self.gate.step(now)
        if self._following and not following:
            self._plant.hold()
        self._following = following
        self._plant.step(period_s)
        self._tick += 1
        self.gate.note_state(self._tick, now)
        if self.log is not None:
            self.log.tick(now, self._tick, following, self._plant.sample())
        state = self.faults.alter(self._state(sample_time_s, period_s))
        if state is not None:
            await self._publish("state", state.to_json, {every for every, _ in self._readers.values()})
        await self._publish("truth", self._truth, {every for _, every in self._readers.values()})

    async def _publish(self, event: str, data: Callable[[], object], intervals: set[int]) -> None:
        """To the rooms whose interval is due; encoded once, and not at all when none is."""
        rooms = [f"{event}_{every}" for every in intervals if every and self._tick % every == 0]
        content = data() if rooms else None
        if content is not None:
            await self._sio.emit(event, content, room=rooms)

    def _truth(self) -> object:
        truth = self._plant.truth(self._tick)
        return None if truth is None else truth.__dict__

    def _state(self, time_s: float, period_s: float) -> State:
        sample = self._plant.sample()
        fields = dict(sample.__dict__)
        fields["target"] = TargetInEffect(*self.commands.in_effect, sample.target.position, sample.target.quaternion)
        return State(
            tick=self._tick,
            time_s=time_s,
            period_s=period_s,
            following=self._following,
            controller=self.gate.controller,
            session=self.gate.session,
            last_seq=self.gate.last_seq,
            dropped=dict(self.gate.dropped),
            **fields,
        )

    # -- what clients send -------------------------------------------------------------------------------------

    def _register(self) -> None:
        self._sio.on("hello", self._on_hello)
        self._sio.on("disconnect", self._on_disconnect)
        self._sio.on("malformed", self._on_malformed)
        for event in COMMANDS:
            self._sio.on(event, self._handler(event))
        self._sio.on("inject", self._on_inject)

    async def _on_hello(self, sid: str, data: object = None, *_: object) -> dict[str, Any]:
        try:
            hello = Hello.parse(data)
        except MessageError as error:
            return self._refusal(error)
        await self._subscribe(sid, hello)
        try:
            session = self.gate.take_control(sid, hello.client, time.monotonic()) if hello.control else 0
        except MessageError as error:
            return self._refusal(error)  # it stays a reader
        return {"ok": True, "session": session, "arm": self._capabilities()}

    async def _subscribe(self, sid: str, hello: Hello) -> None:
        for event, every in zip(("state", "truth"), self._readers.get(sid, ())):
            await self._sio.leave_room(sid, f"{event}_{every}")
        self._readers[sid] = (self._interval(hello.state_rate_hz), self._interval(hello.truth_rate_hz))
        for event, every in zip(("state", "truth"), self._readers[sid]):
            await self._sio.enter_room(sid, f"{event}_{every}")

    def _interval(self, rate_hz: float) -> int:
        """Every how many ticks; 0 never."""
        return max(1, round(self.config.state_rate_hz / rate_hz)) if rate_hz > 0.0 else 0

    def _capabilities(self) -> dict[str, Any]:
        sample = self._plant.sample()
        return {
            "protocol": PROTOCOL_VERSION,
            "name": self.config.name,
            "state_rate_hz": self.config.state_rate_hz,
            "modes": list(MODES),
            "force_sensor": sample.wrench is not None,
            "command_age_limit_s": self.config.gate.command_age_limit_s,
            "target_timeout_s": self.config.gate.target_timeout_s,
            "heartbeat_timeout_s": self.config.gate.heartbeat_timeout_s,
        }

    async def _on_disconnect(self, sid: str, *_: object) -> None:
        self._readers.pop(sid, None)
        self.gate.release(sid)

    async def _on_malformed(self, sid: str, *data: object) -> None:
        await self._nack(sid, 0, MessageError(Reason.MALFORMED, f"packet: {data[0] if data else 'no JSON'}"))

    async def _on_inject(self, sid: str, data: object = None, *_: object) -> dict[str, Any]:
        try:
            if not self.config.allow_faults:
                raise MessageError(Reason.UNSUPPORTED, "inject: this arm does not take faults")
            self.faults.inject(data)
        except MessageError as error:
            return self._refusal(error)
        return {"ok": True}

    def _handler(self, event: str) -> Callable[..., Awaitable[dict[str, Any]]]:
        async def handle(sid: str, data: object = None, *_: object) -> dict[str, Any]:
            now = time.monotonic()
            try:
                self.commands.obey(event, sid, data, now)
            except MessageError as error:
                field = data.get("seq") if isinstance(data, dict) else 0
                seq = field if type(field) is int else 0
                if self.log is not None:
                    self.log.refused(now, event, seq, error.reason)
                return await self._nack(sid, seq, error)
            if self.log is not None:
                self.log.taken(now, event, data)
            return {"ok": True}

        return handle

    async def _nack(self, sid: str, seq: int, error: MessageError) -> dict[str, Any]:
        await self._sio.emit("nack", {"seq": seq, "reason": error.reason, "detail": error.detail}, to=sid)
        return self._refusal(error)

    def _refusal(self, error: MessageError) -> dict[str, Any]:
        self.gate.dropped[error.reason] += 1
        return {"ok": False, "reason": error.reason, "detail": error.detail}
