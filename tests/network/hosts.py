"""Several hosts on one switch, as network namespaces: processes of one share nothing with the others but files."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from saras_ros1.processes import Child

ROOT = Path(__file__).resolve().parents[2]
SHIM = ROOT / "tests" / "fakes" / "clock_shim"
SUBNET = "10.77.0"


def ip(*arguments: str) -> None:
    """The command ip; RuntimeError with its own words."""
    done = subprocess.run(["ip", *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(f"ip {' '.join(arguments)}: {done.stderr.strip()}")


def why_not_permitted() -> str:
    """Why hosts cannot be made here; empty when they can."""
    name = f"saras-{os.getpid()}-try"
    try:
        ip("netns", "add", name)
        ip("netns", "exec", name, "ip", "link", "set", "lo", "up")
        ip("-n", name, "link", "add", "name", "switch", "type", "bridge")
    except (RuntimeError, OSError) as error:
        return f"network namespaces are not permitted here: {error}"
    finally:
        with contextlib.suppress(RuntimeError, OSError):
            ip("netns", "del", name)
    return ""


class Hosts:
    """Context manager: leaving it ends all processes and takes the namespaces away."""

    def __init__(self, names: list[str], log_dir: Path) -> None:
        self._prefix = f"saras-{os.getpid()}-"
        self._log_dir = log_dir
        self._names = names
        self._ahead_s = dict.fromkeys(names, 0.0)
        self._made: list[str] = []
        self._children: list[Child] = []

    def __enter__(self) -> Hosts:
        try:
            # A bridge in a namespace of its own: the firewall of the computer's own network does not see it.
            switch = self._make("switch")
            ip("-n", switch, "link", "add", "name", "switch", "type", "bridge")
            ip("-n", switch, "link", "set", "switch", "up")
            for i, name in enumerate(self._names):
                host = self._make(name)
                ip("-n", switch, "link", "add", f"to{i}", "type", "veth", "peer", "name", "eth0", "netns", host)
                ip("-n", switch, "link", "set", f"to{i}", "master", "switch", "up")
                ip("-n", host, "address", "add", f"{self.address(name)}/24", "dev", "eth0")
                ip("-n", host, "link", "set", "eth0", "up")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        with ThreadPoolExecutor(max_workers=16) as pool:
            list(pool.map(lambda child: child.stop(patience_s=15.0), self._children))
        self._children.clear()
        while self._made:
            with contextlib.suppress(RuntimeError):
                ip("netns", "del", self._made.pop())

    def _make(self, name: str) -> str:
        ip("netns", "add", self._prefix + name)
        self._made.append(self._prefix + name)
        ip("-n", self._made[-1], "link", "set", "lo", "up")
        return self._made[-1]

    def address(self, name: str) -> str:
        """IPv4 address of a host."""
        return f"{SUBNET}.{self._names.index(name) + 1}"

    def set_clock(self, name: str, ahead_s: float) -> None:
        """The time of day of what is started there from now on."""
        self._ahead_s[name] = ahead_s

    def command(self, name: str, *words: str) -> list[str]:
        """A command that runs there."""
        return ["ip", "netns", "exec", self._prefix + name, *words]

    def environment(self, name: str, **further: str) -> dict[str, str]:
        """ROS variables of a host; None of the caller's own."""
        env = {key: value for key, value in os.environ.items() if not key.startswith("ROS_") or "ROOT" in key}
        env.update(ROS_IP=self.address(name), ROS_HOME=str(self._log_dir / "ros"), PYTHONUNBUFFERED="1")
        env["ROS_PACKAGE_PATH"] = os.environ.get("ROS_PACKAGE_PATH", "")
        if self._ahead_s[name]:
            env["SARAS_CLOCK_AHEAD_S"] = str(self._ahead_s[name])
            env["PYTHONPATH"] = f"{SHIM}:{env.get('PYTHONPATH', '')}"
        return {**env, **further}

    def start(self, name: str, label: str, *words: str, **environment: str) -> Child:
        """Starts a program there, ended with the hosts."""
        env = self.environment(name, **environment)
        self._children.append(Child(label, self.command(name, *words), self._log_dir / f"{label}.log", env))
        return self._children[-1]

    def python(self, name: str, *words: str, **environment: str) -> subprocess.CompletedProcess:
        """Runs a Python program there to its end."""
        return subprocess.run(
            self.command(name, sys.executable, *words),
            env=self.environment(name, **environment), capture_output=True, text=True, timeout=400, check=False,
        )  # fmt: skip
