"""The impaired network between console and platform: the program ``saras udp-proxy`` under control."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

from .platform import Platform


class Proxy:
    """One line in, one line out; see saras.sim.udp_proxy_command."""

    def __init__(self, platform: Platform, seed: int = 1) -> None:
        command = [
            sys.executable, "-m", "saras", "udp-proxy", "--seed", str(seed), "--listen", str(platform.proxy_port),
            "--to", str(platform.bind_port), "--send-from", str(platform.console_port),
        ]  # fmt: skip
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, bufsize=1, env=platform.env)
        platform.children[f"udp-proxy {platform.proxy_port}"] = self._process
        self._process.stdout.readline()  # its address: it listens now

    def __call__(self, line: str) -> dict[str, Any]:
        """Does what the line says."""
        self._process.stdin.write(line + "\n")
        answer = json.loads(self._process.stdout.readline())
        if not answer["ok"]:
            raise AssertionError(answer["error"])
        return answer

    def passed(self, direction: str = "up") -> int:
        """Datagrams that came out so far."""
        return int(self("counters")[direction]["delivered"])
