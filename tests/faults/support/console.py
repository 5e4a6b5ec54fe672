"""The console program as a process: started, killed, frozen; what it shows its operator is read from its lines."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from .platform import Platform
from .waiting import wait_until


class Console:
    """``saras console`` behind the proxy (or, with direct=True, straight to the platform; or by other ports)."""

    def __init__(
        self,
        platform: Platform,
        *words: str,
        name: str = "console",
        direct: bool = False,
        to: int | None = None,
        listen: int | None = None,
    ) -> None:
        self.platform, self.name = platform, name
        to = to or (platform.bind_port if direct else platform.proxy_port)
        own = listen or (platform.console_port if direct else platform.console_own_port)
        self.command = [
            sys.executable, "-m", "saras", "console", "--plain",
            "--platform", f"127.0.0.1:{to}", "--listen", f"127.0.0.1:{own}", *words,
        ]  # fmt: skip
        self.process: subprocess.Popen[bytes] | None = None
        self.starts = 0

    @property
    def log(self) -> Path:
        """Of the newest run."""
        return self.platform.out / f"{self.name}_{self.starts}.log"

    def start(self) -> None:
        """A new run: a new session, its numbers begin anew."""
        self.starts += 1
        with self.log.open("wb") as output:
            env = {**self.platform.env, **self.platform.node_env}
            self.process = subprocess.Popen(self.command, env=env, stdout=output, stderr=subprocess.STDOUT)
        self.platform.children[f"{self.name} {self.starts}"] = self.process

    def kill(self, how: signal.Signals = signal.SIGKILL) -> None:
        """Ends it."""
        self.process.send_signal(how)
        self.process.wait(timeout=30.0)

    def freeze(self) -> None:
        """SIGSTOP."""
        os.kill(self.process.pid, signal.SIGSTOP)

    def thaw(self) -> None:
        """SIGCONT."""
        os.kill(self.process.pid, signal.SIGCONT)

    def lines(self) -> list[str]:
        """What it showed in this run, a line a second."""
        return self.log.read_text(errors="replace").splitlines() if self.log.exists() else []

    def shown(self, side: str) -> str:
        """The newest state that it showed for a side, "" before the first one."""
        for line in reversed(self.lines()):
            for part in line.split("|"):
                words = part.split()
                if words[:1] == [side]:
                    return "unknown" if words[1] == "?" else words[1]
        return ""

    def count(self, word: str) -> int:
        """The newest number behind a word of its link's line: sent, received, lost, late, doubled, refused."""
        for line in reversed(self.lines()):
            words = line.split()
            if "sent" in words and word in words:
                return int(words[words.index(word) + 1])
        return 0

    def await_shown(self, side: str, *states: str) -> None:
        """Waits until a line that comes from now on shows one of these."""
        before = len(self.lines())
        wait_until(
            lambda: len(self.lines()) > before and self.shown(side) in states,
            lambda: f"the console shows {side} {' or '.join(states)}; it shows {self.shown(side)!r}",
        )
