"""script/closed-graph without ROS: what is passed in and out of the namespace, as any user, and what is refused."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import sys
import threading
from pathlib import Path

import pytest

pytest.importorskip("rospy")
from saras import ConfigError
from saras.net import keys as key_files
from saras_ros1 import closed_graph

# What roslaunch would be: asks through each door, and for what must not be there.
PROGRAM = """
import socket, sys
outside_port = int(sys.argv[1])
arm = socket.create_connection(("127.0.0.1", 48020), timeout=10)
arm.sendall(b"hello"); assert arm.recv(99) == b"HELLO"
receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
receiver.bind(("127.0.0.1", 48110)); receiver.settimeout(10)
data, sender = receiver.recvfrom(99)
assert sender == ("127.0.0.1", 48111), sender
receiver.sendto(data.upper(), sender)
clock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM); clock.settimeout(10)
clock.sendto(b"time?", ("127.0.0.1", 48130)); assert clock.recv(99) == b"TIME?"
closed = socket.socket(); closed.settimeout(2)
private = closed.connect_ex(("127.0.0.1", outside_port)) != 0
sys.exit(17 if private else 18)
"""
PRIVATE, SHARED = 17, 18


class Peers:
    """The arm, the host with the time, and the console: each answers in capitals."""

    def __init__(self) -> None:
        self.arm = socket.create_server(("127.0.0.1", 0))
        self.clock, self.console = (socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(2))
        for each in (self.clock, self.console):
            each.bind(("127.0.0.1", 0))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
            free.bind(("127.0.0.1", 0))
            self.listen = free.getsockname()[1]
        self.console.settimeout(0.1)
        self.heard = b""
        self.ended = threading.Event()
        for serve in (self._serve_arm, self._serve_clock, self._serve_console):
            threading.Thread(target=serve, daemon=True).start()

    def _serve_arm(self) -> None:
        while True:
            one, _ = self.arm.accept()
            one.sendall(one.recv(99).upper())

    def _serve_clock(self) -> None:
        while True:
            data, asker = self.clock.recvfrom(99)
            self.clock.sendto(data.upper(), asker)

    def _serve_console(self) -> None:
        while not self.ended.is_set():
            self.console.sendto(b"pose", ("127.0.0.1", self.listen))
            try:
                self.heard = self.console.recv(99)
            except OSError:
                continue

    def arguments(self) -> list[str]:
        arm = f"127.0.0.1:{self.arm.getsockname()[1]}"
        words = ["--console", f"127.0.0.1:{self.console.getsockname()[1]}", "--listen", f"127.0.0.1:{self.listen}"]
        clock = f"room=127.0.0.1:{self.clock.getsockname()[1]}"
        return [*words, "--arm-left", arm, "--arm-right", arm, "--clock", clock]


@pytest.fixture
def peers(monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    made = Peers()
    monkeypatch.setenv("ROS_HOME", str(tmp_path))
    program = [sys.executable, "-c", PROGRAM, str(made.arm.getsockname()[1])]
    monkeypatch.setattr(closed_graph, "launch_command", lambda plan, given: program)
    yield made
    made.ended.set()


def namespaces_permitted() -> bool:
    return subprocess.run(["unshare", "-rn", "true"], capture_output=True, check=False).returncode == 0


needs_namespaces = pytest.mark.skipif(not namespaces_permitted(), reason="network namespaces are not permitted here")


@needs_namespaces
def test_inside_there_are_the_doors_and_nothing_else(peers: Peers, tmp_path: Path) -> None:
    assert closed_graph.main(["--strict", *peers.arguments()]) == PRIVATE
    assert peers.heard == b"POSE"
    assert not list(tmp_path.glob("closed_graph_*"))


def test_where_namespaces_are_not_permitted_it_says_so_and_works_on_loopback(
    peers: Peers, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture
) -> None:
    def refuse() -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(closed_graph.network_namespace, "enter_new", refuse)
    assert closed_graph.main(["--strict", *peers.arguments()]) == 2
    assert "Operation not permitted" in capfd.readouterr().err
    assert closed_graph.main(peers.arguments()) == SHARED
    said = capfd.readouterr().err
    assert "no network namespace is permitted here" in said
    assert "firewall" in said


@needs_namespaces
@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("setpriv"), reason="needs root, to become somebody else")
def test_an_ordinary_user_needs_no_privilege() -> None:
    """Enters, sees nothing but loopback, and another process of the same user may join."""
    inside = (
        "from saras_ros1 import network_namespace as n; import socket, subprocess, os, sys\n"
        "outer = os.stat('/proc/self/ns/net').st_ino\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    n.enter_new(); server = socket.create_server(('127.0.0.1', 11311)); open(sys.argv[1], 'w').close()\n"
        "    print(n.outside_interfaces(), [name for _, name in socket.if_nameindex()], os.geteuid(), flush=True)\n"
        "    server.accept(); os._exit(0)\n"
        "import time\n"
        "while not os.path.exists(sys.argv[1]): time.sleep(0.02)\n"
        "connect = 'import socket; socket.create_connection((\"127.0.0.1\", 11311), 5)'\n"
        "sys.exit(subprocess.call([*n.join_command(child), sys.executable, '-c', connect]))\n"
    )
    mark = f"/tmp/saras_namespace_{os.getpid()}"
    nobody = ["setpriv", "--reuid", "65534", "--regid", "65534", "--clear-groups"]
    try:
        done = subprocess.run(
            [*nobody, sys.executable, "-c", inside, mark], capture_output=True, text=True, timeout=60, check=False
        )
    finally:
        Path(mark).unlink(missing_ok=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout.split("\n")[0] == "[] ['lo'] 65534"


def plan(*words: str) -> closed_graph.Plan:
    return closed_graph.make_plan(closed_graph.parse(list(words))[0])


@pytest.fixture
def key_file(tmp_path: Path) -> str:
    key_files.save(tmp_path / "saras.key", key_files.draw())
    return str(tmp_path / "saras.key")


def test_all_simulated_without_options() -> None:
    made = plan()
    assert (made.console, made.arms, made.clocks, made.key_file) == (None, {}, {}, "")
    command = closed_graph.launch_command(made, ["rviz:=true"])
    assert {"sim:=true", "rviz:=true"} <= set(command)


def test_the_key_reaches_the_receiver_and_hosts_are_asked_for_the_time(key_file: str) -> None:
    arms = ("--arm-left", "10.0.1.2", "--arm-right", "10.0.1.3:5000")
    made = plan("--console", "10.0.0.2", "--listen", "10.0.0.1:48010", "--key", key_file, *arms)
    assert made.console == ("10.0.0.2", 48011)
    assert made.arms == {"left": ("10.0.1.2", 48020), "right": ("10.0.1.3", 5000)}
    assert list(made.clocks) == ["console", "arm_left", "arm_right"]
    command = closed_graph.launch_command(made, [])
    assert {"sim:=false", f"key_file:={key_file}", "bind_port:=48110", "console_port:=48111"} <= set(command)


ARMS = ("--arm-left", "10.0.1.2", "--arm-right", "10.0.1.2")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--console", "10.0.0.2", "--listen", "10.0.0.1:48010", *ARMS), "10.0.0.1.*key file"),
        (("--listen", "0.0.0.0:48010", *ARMS), "0.0.0.0.*key file"),
        (("--console", "10.0.0.2", *ARMS), "10.0.0.2.*key file"),
        (("--arm-left", "10.0.1.2"), "--arm-left alone"),
        (("--console", "127.0.0.1"), "--console without"),
        (("--arm-left", "arm.local", "--arm-right", "10.0.1.2"), "--arm-left 'arm.local'.*numeric"),
        (("--arm-left", "10.0.1.2:99999", "--arm-right", "10.0.1.2"), "--arm-left '10.0.1.2:99999'"),
        (("--key", "/nowhere/saras.key", *ARMS), "/nowhere/saras.key"),
    ],
)
def test_refusals_name_the_option(words: tuple, said: str) -> None:
    with pytest.raises(ConfigError, match=said):
        plan(*words)


@pytest.mark.parametrize(
    "word", ["key_file:=", "bind_host:=0.0.0.0", "console_host:=10.0.0.2", "sim:=false", "--screen"]
)
def test_arguments_that_would_go_past_the_keys_are_refused(word: str) -> None:
    with pytest.raises(ConfigError, match=word.split(":=")[0]):
        closed_graph.launch_command(plan(), [word])
