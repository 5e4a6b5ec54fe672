"""Server and clients on real sockets for the tests of the arm's link."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from saras.mesa_link import ArmLinkError, SocketIoArmDriver
from saras.mesa_link.poses import to_matrix
from saras.mesa_link.server import ArmServer, ArmServerConfig

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "fakes"))

from arm_plant import HOME, FakePlant

PATIENCE_S = 10.0  # an upper bound for waiting, never a measure


def eventually(condition: Callable[[], object], what: str) -> None:
    end = time.monotonic() + PATIENCE_S
    while not condition():
        assert time.monotonic() < end, f"never came true: {what}"
        time.sleep(0.005)


def patiently(call: Callable[[], object]) -> None:
    """``call`` until the link takes it: on a busy machine a state may be too old for the first one."""

    def taken() -> bool:
        try:
            call()
        except ArmLinkError as error:
            if "ms old" in str(error) or "not in control" in str(error) or "expired" in str(error):
                return False
            raise
        return True

    eventually(taken, "the link takes a command")


class ServerThread:
    """An ArmServer with its own loop; ``call`` runs a function between its ticks."""

    def __init__(self, plant: FakePlant, **config: object) -> None:
        self.plant = plant
        self._config = ArmServerConfig(**{"name": "mesa_left", "port": 0, "allow_faults": True, **config})
        self._ready = threading.Event()
        self._thread = threading.Thread(target=lambda: asyncio.run(self._main()), daemon=True)
        self._thread.start()
        assert self._ready.wait(PATIENCE_S)

    async def _main(self) -> None:
        self._loop, self._stop = asyncio.get_running_loop(), asyncio.Event()
        self.server = ArmServer(self._config, self.plant)
        await self.server.start()
        self._ready.set()
        await self._stop.wait()
        await self.server.stop()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self.server.port}"

    @property
    def dropped(self) -> dict[str, int]:
        return dict(self.server.gate.dropped)

    def close(self) -> None:
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join(PATIENCE_S)


@contextmanager
def arm(**config: object) -> Iterator[ServerThread]:
    server = ServerThread(FakePlant(), **config)
    try:
        yield server
    finally:
        server.close()


@contextmanager
def driver(url: str, **options: object) -> Iterator[SocketIoArmDriver]:
    client = SocketIoArmDriver(url, **{"client": "test", **options})
    try:
        client.connect(PATIENCE_S)
        if options.get("control", True):
            eventually(lambda: client.stats().in_control or "busy" in client.stats().last_error, "control or refusal")
        yield client
    finally:
        client.close()


def pose(dx: float = 0.0, dy: float = 0.0, dz: float = 0.0) -> np.ndarray:
    """HOME moved [m]."""
    x, y, z = HOME.position
    return to_matrix((x + dx, y + dy, z + dz), HOME.quaternion)


def python(script: str, *args: str) -> subprocess.Popen[str]:
    """A process of the same interpreter and path; its lines are read from stdout."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    return subprocess.Popen(
        [sys.executable, "-u", "-c", script, *args], stdout=subprocess.PIPE, text=True, env=environment
    )
