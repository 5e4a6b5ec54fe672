"""The platform with its ROS graph out of everybody's reach: a network namespace that has loopback and nothing else.

ROS 1 knows no authentication, and roscpp listens on all addresses whatever ROS_IP says. Here roscore, all nodes and all
their ports are in a network of their own; only the console's datagrams, the connections to the arms and questions for
the time are passed, each between one named peer and one port inside. No privilege is needed.

    script/closed-graph                                             all simulated, inside
    script/closed-graph --console 192.168.5.2 --key saras.key --listen 192.168.5.1:48010
        --arm-left 192.168.6.2:48020 --arm-right 192.168.6.2:48021 regions:=$HOME/bones.yaml
    script/closed-graph --join rosservice call /system/left/engage  a program inside (without one: a shell)

Further NAME:=VALUE are arguments of launch/saras_mrs.launch.
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import ipaddress
import json
import os
import signal
import socket
import sys
from pathlib import Path
from typing import NamedTuple

from saras import ConfigError, Error
from saras.net import keys as key_files
from saras.net import ntp
from saras_ros1 import network_namespace
from saras_ros1.relay import Address, DatagramRelay, QuestionRelay, StreamRelay

ROOT = Path(__file__).resolve().parents[1]
MASTER_PORT = 11311
ARM_PORTS = {"left": 48020, "right": 48021}  # config/arms.yaml expects real arms there
BIND_PORT, CONSOLE_PORT, CLOCK_PORT = 48110, 48111, 48130  # inside; the first of the clocks
LISTEN, CONSOLE = ("127.0.0.1", 48010), ("127.0.0.1", 48011)
# Ours to say: with another value the relays would lead nowhere, or past the keys.
RESERVED = ("key_file", "bind_host", "bind_port", "console_host", "console_port", "clock_hosts", "sim")


class Plan(NamedTuple):
    """What is passed through; console None: simulated, like the arms, inside."""

    listen: Address
    console: Address | None
    key_file: str
    arms: dict[str, Address]
    clocks: dict[str, Address]


class Doors(NamedTuple):
    """The inner ends of the relays, made in the namespace."""

    console: socket.socket | None
    arms: dict[str, socket.socket]
    clocks: dict[str, socket.socket]

    def sockets(self) -> list[socket.socket]:
        """All, in a fixed order."""
        return [*([self.console] if self.console else []), *self.arms.values(), *self.clocks.values()]


def parse(argv: list[str] | None = None) -> tuple[argparse.Namespace, list[str]]:
    """The command line, and the launch file's arguments."""
    parser = argparse.ArgumentParser(
        prog="script/closed-graph", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--console", metavar="HOST[:PORT]", help="the console's computer; port 48011 if not given")
    parser.add_argument(
        "--listen", metavar="HOST:PORT", default="127.0.0.1:48010", help="own address for its datagrams"
    )
    parser.add_argument("--key", metavar="FILE", default="", help="of saras keys make; needed beyond loopback")
    parser.add_argument("--arm-left", metavar="HOST[:PORT]", help="the left arm's server; port 48020 if not given")
    parser.add_argument("--arm-right", metavar="HOST[:PORT]", help="the right arm's; port 48021 if not given")
    parser.add_argument(
        "--clock", metavar="NAME=HOST[:PORT]", action="append", default=[], help="a further host whose clock is shown"
    )
    parser.add_argument("--loopback", action="store_true", help="no namespace: ROS on loopback as far as it can")
    parser.add_argument("--strict", action="store_true", help="refuse where namespaces are not permitted")
    parser.add_argument("--name", default="saras", help="of this graph, for --join")
    parser.add_argument("--join", nargs=argparse.REMAINDER, metavar="PROGRAM", help="run a program inside, or a shell")
    return parser.parse_known_args(argv)


def make_plan(arguments: argparse.Namespace) -> Plan:
    """Checked addresses. Raises ConfigError that names the option."""
    arms = {side: address(f"--arm-{side}", getattr(arguments, f"arm_{side}"), port) for side, port in ARM_PORTS.items()
            if getattr(arguments, f"arm_{side}")}  # fmt: skip
    if len(arms) == 1:
        raise ConfigError(f"--arm-{next(iter(arms))} alone: name both arms, or none: both are simulated then")
    if arms and not arguments.console:
        arguments.console = "127.0.0.1"
    if arguments.console and not arms:
        raise ConfigError("--console without --arm-left and --arm-right: simulated arms have a simulated console")
    listen = address("--listen", arguments.listen, LISTEN[1])
    console = address("--console", arguments.console, CONSOLE[1]) if arguments.console else None
    if console is not None:
        outside = [each for each in (listen, console) if not ipaddress.IPv4Address(each[0]).is_loopback]
        if outside and not arguments.key:
            raise ConfigError(f"{outside[0][0]} is not on loopback: name a key file (--key FILE; saras keys make FILE)")
        if arguments.key:
            key_files.load(Path(arguments.key).expanduser())  # refused now, not by a node later
    clocks = {"console": (console[0], ntp.PORT)} if console else {}
    clocks |= {f"arm_{side}": (host, ntp.PORT) for side, (host, _) in arms.items()}
    clocks = {name: where for name, where in clocks.items() if not ipaddress.IPv4Address(where[0]).is_loopback}
    if clocks.get("arm_left") == clocks.get("arm_right") is not None:
        clocks["arms"] = clocks.pop("arm_left")
        del clocks["arm_right"]
    for text in arguments.clock:
        name, _, where = text.partition("=")
        clocks[name] = address("--clock", where, ntp.PORT)
    key_file = str(Path(arguments.key).expanduser().resolve()) if arguments.key else ""
    return Plan(listen, console, key_file, arms, clocks)


def address(option: str, text: str, port: int) -> Address:
    """HOST or HOST:PORT, numeric: no name server is asked on the way to an arm."""
    host, _, number = text.partition(":")
    try:
        host = str(ipaddress.IPv4Address(host))
        port = int(number) if number else port
        if not 1 <= port <= 65535:
            raise ValueError
    except ValueError:
        raise ConfigError(f"{option} {text!r}: must be HOST or HOST:PORT, with a numeric IPv4 address") from None
    return host, port


def launch_command(plan: Plan, given: list[str]) -> list[str]:
    """What runs inside. ConfigError for an argument that is ours to say."""
    for each in given:
        if ":=" not in each or each.startswith("-"):
            raise ConfigError(f"{each!r}: neither an option nor NAME:=VALUE")
        if each.split(":=")[0] in RESERVED:
            raise ConfigError(f"{each!r}: said by the options --console, --listen, --key, --arm-left and --arm-right")
    own = {"sim": str(not plan.arms).lower(), "bind_port": str(BIND_PORT), "console_port": str(CONSOLE_PORT)}
    own["key_file"] = plan.key_file
    hosts = [f"{name}=127.0.0.1:{CLOCK_PORT + i}" for i, name in enumerate(plan.clocks)]
    own["clock_hosts"] = " ".join(hosts)
    launch_file = ROOT / "launch" / "saras_mrs.launch"
    return ["roslaunch", str(launch_file), *given, *(f"{name}:={value}" for name, value in own.items())]


def make_doors(plan: Plan) -> Doors:
    """In the namespace of the caller."""
    console = _bound(socket.SOCK_DGRAM, ("127.0.0.1", CONSOLE_PORT)) if plan.console else None
    arms = {}
    for side, target in plan.arms.items():
        inside = ("127.0.0.1", ARM_PORTS[side])
        if target != inside or not _same_network():
            arms[side] = _bound(socket.SOCK_STREAM, inside)
            arms[side].listen(8)
    clocks = {
        name: _bound(socket.SOCK_DGRAM, ("127.0.0.1", CLOCK_PORT + i)) for i, name in enumerate(plan.clocks)
    }  # fmt: skip
    return Doors(console, arms, clocks)


def _same_network() -> bool:
    return Path(f"/proc/{os.getppid()}/ns/net").samefile("/proc/self/ns/net")


def _bound(kind: int, where: Address) -> socket.socket:
    made = socket.socket(socket.AF_INET, kind)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, int(kind == socket.SOCK_STREAM))
    try:
        made.bind(where)
    except OSError as error:
        made.close()
        raise ConfigError(f"{where[0]}:{where[1]}: {error.strerror}") from None
    return made


def environment() -> dict[str, str]:
    """ROS on loopback, for what runs inside."""
    env = {**os.environ, "ROS_IP": "127.0.0.1", "ROS_MASTER_URI": f"http://127.0.0.1:{MASTER_PORT}"}
    env.pop("ROS_HOSTNAME", None)
    return env


def inside(plan: Plan, command: list[str], pipe: socket.socket, namespace: bool) -> None:
    """The child: makes the namespace and the doors, hands them out, becomes the command. Does not return."""
    try:
        os.setpgid(0, 0)  # Ctrl-C comes from the parent, once
        if namespace:
            network_namespace.enter_new()
        doors = make_doors(plan)
        # A user namespace changes credentials, which clears this; so it comes after it.
        network_namespace.end_with_parent(signal.SIGINT)
        kinds = {"console": doors.console is not None, "arms": list(doors.arms), "clocks": list(doors.clocks)}
        socket.send_fds(pipe, [json.dumps(kinds).encode()], [each.fileno() for each in doors.sockets()])
    except OSError as error:
        pipe.send(json.dumps({"error": f"{error.strerror or error}", "namespace": namespace}).encode())
        os._exit(2)
    except Error as error:
        pipe.send(json.dumps({"error": str(error), "namespace": False}).encode())
        os._exit(2)
    try:
        if pipe.recv(1) == b"g":  # else the parent could not open its ends
            os.execvpe(command[0], command, environment())
    except OSError as error:
        say(f"{command[0]}: {error.strerror}")
    os._exit(2)


def start(plan: Plan, command: list[str], namespace: bool) -> tuple[int, Doors, socket.socket]:
    """Forks; returns the child's pid, the doors, and the pipe on which "g" lets it go. PermissionError, ConfigError."""
    ours, theirs = socket.socketpair()
    pid = os.fork()
    if pid == 0:
        ours.close()
        inside(plan, command, theirs, namespace)
    theirs.close()
    data, numbers, _, _ = socket.recv_fds(ours, 4096, 64)
    said = json.loads(data or b'{"error": "the child ended", "namespace": false}')
    if "error" in said:
        os.waitpid(pid, 0)
        raise (PermissionError if said["namespace"] else ConfigError)(said["error"])
    made = [socket.socket(fileno=number) for number in numbers]
    console = made.pop(0) if said["console"] else None
    arms = {side: made.pop(0) for side in said["arms"]}
    return pid, Doors(console, arms, {name: made.pop(0) for name in said["clocks"]}), ours


async def serve(plan: Plan, doors: Doors, outer: socket.socket | None, pid: int) -> int:
    """Relays until the child ends; its exit code. SIGINT and SIGTERM end the child, and so us."""
    relays: list[DatagramRelay | QuestionRelay | StreamRelay] = []
    if plan.console is not None and doors.console is not None and outer is not None:
        relays.append(DatagramRelay(outer, plan.console, doors.console, ("127.0.0.1", BIND_PORT)))
    relays += [StreamRelay(door, plan.arms[side]) for side, door in doors.arms.items()]
    relays += [QuestionRelay(door, plan.clocks[name]) for name, door in doors.clocks.items()]
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, _tell, pid)
    tasks = [asyncio.ensure_future(relay.run()) for relay in relays]
    _, status = await loop.run_in_executor(None, os.waitpid, pid, 0)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)
    return os.waitstatus_to_exitcode(status)


def _tell(pid: int) -> None:
    with contextlib.suppress(ProcessLookupError):
        os.kill(pid, signal.SIGINT)


def standing_file(name: str) -> Path:
    """Where the running graph of this name says its process number."""
    home = Path(os.environ.get("ROS_HOME", Path.home() / ".ros"))
    return home / f"closed_graph_{name}.json"


def join(name: str, program: list[str]) -> int:
    """Becomes the program, inside. ConfigError when no graph of this name runs."""
    try:
        pid = int(json.loads(standing_file(name).read_text(encoding="utf-8"))["pid"])
        command = network_namespace.join_command(pid)
    except (OSError, ValueError, KeyError):
        raise ConfigError(f"no closed graph '{name}' runs ({standing_file(name)})") from None
    command += program or [os.environ.get("SHELL", "/bin/sh")]
    os.execvpe(command[0], command, environment())


def run(arguments: argparse.Namespace, given: list[str]) -> int:
    """The whole of it. Raises ConfigError."""
    plan = make_plan(arguments)
    command = launch_command(plan, given)
    try:
        pid, doors, pipe = start(plan, command, not arguments.loopback)
    except PermissionError as error:
        if arguments.strict:
            raise ConfigError(f"no network namespace is permitted here ({error})") from None
        say(f"no network namespace is permitted here ({error})")
        arguments.loopback = True
        pid, doors, pipe = start(plan, command, False)
    if arguments.loopback:
        say("ROS on loopback only; C++ nodes still listen on all addresses: close them by a firewall (docs/network.md)")
    else:
        say(f"the graph is in a network of its own; --name {arguments.name} --join PROGRAM runs one inside")
    file = standing_file(arguments.name)
    try:
        outer = _bound(socket.SOCK_DGRAM, plan.listen) if plan.console else None
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps({"pid": pid}), encoding="utf-8")
        pipe.send(b"g")
        return asyncio.run(serve(plan, doors, outer, pid))
    finally:
        pipe.close()  # without its "g" the child ends by itself
        file.unlink(missing_ok=True)


def say(text: str) -> None:
    """One line on stderr."""
    print(f"[closed graph] {text}", file=sys.stderr, flush=True)


def main(argv: list[str] | None = None) -> int:
    """Exit code of roslaunch, or 2: refused."""
    arguments, given = parse(argv)
    try:
        if arguments.join is not None:
            return join(arguments.name, arguments.join)
        return run(arguments, given)
    except Error as error:
        say(str(error))
        return 2


if __name__ == "__main__":
    sys.exit(main())
