"""Children of a script: started in a process group of their own, with a log file, and surely ended."""

from __future__ import annotations

import contextlib
import os
import signal
import socket
import subprocess
import time
from collections.abc import Sequence
from pathlib import Path


def free_ports(tcp: int = 0, udp: int = 0) -> tuple[list[int], list[int]]:
    """Loopback ports that nobody uses now; all different."""
    held = []
    try:
        for kind, count in ((socket.SOCK_STREAM, tcp), (socket.SOCK_DGRAM, udp)):
            for _ in range(count):
                held.append(socket.socket(socket.AF_INET, kind))
                held[-1].bind(("127.0.0.1", 0))
        ports = [each.getsockname()[1] for each in held]
    finally:
        for each in held:
            each.close()
    return ports[:tcp], ports[tcp:]


class Child:
    """A running program. Use as a context manager: leaving it ends the program and all that it started."""

    def __init__(self, name: str, command: Sequence[str], log: Path, env: dict[str, str] | None = None) -> None:
        self.name = name
        self.log = log
        log.parent.mkdir(parents=True, exist_ok=True)
        with log.open("wb") as output:
            self._process = subprocess.Popen(
                list(command), stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT, env=env,
                start_new_session=True,
            )  # fmt: skip

    @property
    def pid(self) -> int:
        """Of the program itself; what it started: descendants()."""
        return self._process.pid

    @property
    def exit_code(self) -> int | None:
        """None while it runs."""
        return self._process.poll()

    def stop(self, patience_s: float = 20.0) -> int:
        """SIGINT, then SIGTERM, then SIGKILL to it and to whatever it left behind; returns its exit code."""
        # roslaunch gives its nodes sessions of their own: when it is killed only their pids reach them.
        family = [self._process.pid, *descendants(self._process.pid)]
        if self.exit_code is None:
            self._process.send_signal(signal.SIGINT)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self._process.wait(patience_s)
        for sign, wait_s in ((signal.SIGTERM, 3.0), (signal.SIGKILL, 1.0)):
            left = [pid for pid in family if _alive(pid)]
            if not left:
                break
            for pid in left:
                _send(pid, sign)
            end = time.monotonic() + wait_s
            while time.monotonic() < end and any(_alive(pid) for pid in left):
                self._process.poll()
                time.sleep(0.05)
        return self._process.wait()

    def tail(self, lines: int = 15) -> str:
        """The end of its log."""
        text = self.log.read_text(encoding="utf-8", errors="replace") if self.log.exists() else ""
        return "\n".join(text.splitlines()[-lines:])

    def __enter__(self) -> Child:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()


def descendants(pid: int) -> list[int]:
    """Pids of all children and theirs, from /proc."""
    parents: dict[int, list[int]] = {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                # The name in parentheses may hold spaces: fields count from the last parenthesis.
                fields = (entry / "stat").read_text().rsplit(")", 1)[1].split()
            except (OSError, IndexError):
                continue
            parents.setdefault(int(fields[1]), []).append(int(entry.name))
    found, open_pids = [], [pid]
    while open_pids:
        children = parents.get(open_pids.pop(), [])
        found += children
        open_pids += children
    return found


def _alive(pid: int) -> bool:
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except (OSError, IndexError):
        return False
    return state != "Z"


def _send(pid: int, sign: signal.Signals) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, sign)
