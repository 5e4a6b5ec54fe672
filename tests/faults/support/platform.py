"""The whole platform as a user starts it: a roscore and saras_mrs.launch of its own, on free ports.

Nodes are killed, frozen and started again by their process. A node is restarted with the command line and the
environment that roslaunch gave it.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import subprocess
import sys
import time
import xml.etree.ElementTree as ElementTree
import xmlrpc.client
from pathlib import Path

import rosgraph

from saras_ros1.processes import Child, descendants, free_ports

from .options import HOSTING, LIMITS, WIDE
from .waiting import wait_until

ROOT = Path(__file__).resolve().parents[3]
SIDES = ("left", "right")
START_S = 200.0
CALLER = "/fault_test"


class Platform:
    """Start with start(), end with stop(). ``out`` is for logs; ``params`` override what the launch files set."""

    def __init__(self, out: Path, params: dict[str, object] | None = None, env: dict[str, str] | None = None) -> None:
        self.out = out
        (self.master_port, self.arm_port_left, self.arm_port_right, *gates), udp = free_ports(tcp=5, udp=4)
        self.bind_port, self.console_port, self.proxy_port, self.console_own_port = udp
        self.gate_ports = dict(zip(SIDES, gates))
        self.params = {**(WIDE if LIMITS == "wide" else {}), **(params or {})}
        self.env = {
            **os.environ,
            "ROS_MASTER_URI": f"http://127.0.0.1:{self.master_port}",
            "ROS_IP": "127.0.0.1",
            "ROS_LOG_DIR": str(out / "log"),
            "ROS_HOME": str(out / "home"),  # where a latched E-stop is kept
            "PYTHONUNBUFFERED": "1",
        }
        self.node_env = env or {}
        self.core: Child | None = None
        self.launch: Child | None = None
        self.children: dict[str, subprocess.Popen[bytes]] = {}
        self._commands: dict[str, tuple[list[bytes], dict[bytes, bytes], str]] = {}
        self._frozen: set[int] = set()
        self._respawned = _respawned()

    def start(self, **arguments: object) -> None:
        """Returns when all nodes are registered and the arms' servers run."""
        self.out.mkdir(parents=True, exist_ok=True)
        signal.signal(signal.SIGTERM, self._on_sigterm)
        os.environ.update({key: self.env[key] for key in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR")})
        guarded = ["setpriv", "--pdeathsig", "TERM"] if shutil.which("setpriv") else []
        core = [*guarded, "roscore", "-p", str(self.master_port)]
        self.core = Child("roscore", core, self.out / "roscore.log", self.env)
        wait_until(lambda: rosgraph.is_master_online(), "roscore", 30.0)
        given = {
            "bind_port": self.bind_port,
            "console_port": self.console_port,
            "arm_port_left": self.arm_port_left,
            "arm_port_right": self.arm_port_right,
            "arm_faults": True,
            "arm_log": self.out,
            "console": False,
            "model_rate_hz": 1,
            **({} if HOSTING == "separate" else {"hosting": HOSTING}),
            **arguments,
        }
        words = [f"{name}:={str(value).lower() if isinstance(value, bool) else value}" for name, value in given.items()]
        files = [str(ROOT / "launch" / "saras_mrs.launch"), str(self._write_params())]
        command = [*guarded, "roslaunch", "--wait", *files, *words]
        self.launch = Child("roslaunch", command, self.out / "roslaunch.log", {**self.env, **self.node_env})
        self.expected = _nodes_of(files, words, self.env)
        wait_until(
            lambda: self.launch.exit_code is not None or set(self.nodes()) >= self.expected,
            lambda: f"nodes {sorted(self.expected - set(self.nodes()))}:\n{self.launch.tail(40)}",
            START_S,
        )
        if self.launch.exit_code is not None:
            raise AssertionError(f"roslaunch ended:\n{self.launch.tail(60)}")
        for node in self.expected:
            self._remember(node, self.pid(node))
        for side in SIDES:
            self._remember(f"/sim_arm_{side}", self.arm_server(side))

    def stop(self) -> None:
        """Ends everything that was started, frozen or not."""
        for pid in list(self._frozen):
            self.thaw(pid)
        for child in self.children.values():
            if child.poll() is None:
                child.kill()
                child.wait()
        for each in (self.launch, self.core):
            if each is None:
                continue
            # At once: a shutdown waits for a master that may be dead, and says nothing that a test wants to know.
            for pid in (each._process.pid, *descendants(each._process.pid)):
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
            each.stop()

    def _on_sigterm(self, *_: object) -> None:
        """A test whose time is over leaves no platform behind."""
        self.stop()
        os._exit(1)

    # -- who runs ----------------------------------------------------------------------------------------------

    def nodes(self) -> list[str]:
        """Names of the nodes that the master knows and that answer, without tests."""
        try:
            publishers, subscribers, services = rosgraph.Master(CALLER).getSystemState()
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
            return []
        names = {name for part in (publishers, subscribers, services) for _, who in part for name in who}
        return sorted(name for name in names if name not in ("/rosout", CALLER) and "test" not in name)

    def pid(self, node: str) -> int:
        """Process of a node; 0 when it does not answer."""
        try:
            uri = rosgraph.Master(CALLER).lookupNode(node)
            with _timeout(5.0):
                return int(xmlrpc.client.ServerProxy(uri).getPid(CALLER)[2])
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
            return 0

    def arm_server(self, side: str) -> int:
        """Process of a simulated arm; 0 when there is none."""
        words = f"--name mesa_{side} "
        roots = [self.launch._process.pid, *(child.pid for child in self.children.values())]
        for pid in [pid for root in roots for pid in (root, *descendants(root))]:
            command = _read(pid, "cmdline").replace(b"\0", b" ").decode()
            if words in command and "sim_arm_server" in command and "roslaunch" not in command:
                return pid
        return 0

    def core_pid(self) -> int:
        """Process of the ROS master."""
        for pid in descendants(self.core._process.pid):
            if b"rosmaster" in _read(pid, "cmdline"):
                return pid
        raise AssertionError("no rosmaster")

    # -- what is done to them ----------------------------------------------------------------------------------

    def running(self, node: str) -> int:
        """Process of a node or of /sim_arm_SIDE; 0 when it does not run."""
        return self.arm_server(node.split("_")[-1]) if node.startswith("/sim_arm_") else self.pid(node)

    def kill(self, node: str, how: signal.Signals = signal.SIGKILL) -> int:
        """Ends a node at once; returns its pid."""
        pid = self.running(node)
        assert pid, f"{node} does not run"
        self._remember(node, pid)
        os.kill(pid, how)
        child = self.children.get(node)
        if child is not None:
            child.wait(timeout=30.0)
        else:
            wait_until(lambda: not _read(pid, "cmdline"), f"the end of {node}")
        return pid

    def freeze(self, pid: int) -> None:
        """SIGSTOP."""
        self._frozen.add(pid)
        os.kill(pid, signal.SIGSTOP)

    def thaw(self, pid: int) -> None:
        """SIGCONT."""
        self._frozen.discard(pid)
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGCONT)

    def restart(self, node: str) -> None:
        """Starts a killed node again, as a user would; waits when roslaunch does it by itself."""
        if node not in self._respawned:
            self.spawn(node)
        wait_until(lambda: self.running(node), f"{node} again", START_S)

    def spawn(self, node: str) -> subprocess.Popen[bytes]:
        """Starts a node (once more) with its own command line, whether it runs or not."""
        command, environment, cwd = self._commands[node]
        count = sum(name.startswith(node) for name in self.children)
        log = self.out / f"{node.strip('/')}_again_{count}.log"
        with log.open("wb") as output:
            child = subprocess.Popen(command, env=environment, cwd=cwd, stdout=output, stderr=subprocess.STDOUT)
        if node in self.children:
            self.children[f"{node} {count}"] = self.children[node]
        self.children[node] = child
        return child

    def _remember(self, node: str, pid: int) -> None:
        if node in self._commands or not pid:
            return
        pairs = (pair.partition(b"=") for pair in _read(pid, "environ").split(b"\0") if pair)
        cwd = str(Path(f"/proc/{pid}/cwd").readlink())
        words = _read(pid, "cmdline").rstrip(b"\0").split(b"\0")
        self._commands[node] = (words, {key: value for key, _, value in pairs}, cwd)

    def _write_params(self) -> Path:
        launch = ElementTree.Element("launch")
        for name, value in self.params.items():
            ElementTree.SubElement(launch, "param", name=name, value=str(value))
        path = self.out / "params.launch"
        ElementTree.ElementTree(launch).write(path)
        return path


@contextlib.contextmanager
def _timeout(seconds: float):
    before = socket.getdefaulttimeout()
    socket.setdefaulttimeout(seconds)
    try:
        yield
    finally:
        socket.setdefaulttimeout(before)


def _read(pid: int, what: str) -> bytes:
    try:
        return Path(f"/proc/{pid}/{what}").read_bytes()
    except OSError:
        return b""


def _nodes_of(files: list[str], words: list[str], env: dict[str, str]) -> set[str]:
    """Names of the nodes of these launch files, without the arms' servers, which are no ROS nodes."""
    found: set[str] = set()
    for file in files:
        listed = subprocess.run(
            ["roslaunch", "--nodes", file, *words], capture_output=True, text=True, env=env, check=True
        )
        found |= {line.strip() for line in listed.stdout.splitlines() if line.startswith("/")}
    return {name for name in found if not name.startswith("/sim_arm_")}


def _respawned() -> set[str]:
    """Nodes that roslaunch starts again by itself."""
    root = ElementTree.parse(ROOT / "launch" / "teleoperation.launch").getroot()
    return {f"/{node.get('name')}" for node in root.findall("node") if node.get("respawn") == "true"}


def python() -> str:
    """The interpreter of the tests."""
    return sys.executable


def pause(seconds: float) -> None:
    """Lets time pass in which something is, or is not, to happen."""
    time.sleep(seconds)
