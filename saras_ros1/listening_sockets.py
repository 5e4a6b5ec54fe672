"""Sockets that wait for strangers: those of a network namespace from /proc/net, and whose they are from /proc/*/fd."""

from __future__ import annotations

import ipaddress
import os
import socket
import struct
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

_TCP_LISTEN, _UDP_UNCONNECTED = 0x0A, 0x07
_TABLES = {"tcp": _TCP_LISTEN, "tcp6": _TCP_LISTEN, "udp": _UDP_UNCONNECTED, "udp6": _UDP_UNCONNECTED}


class Listening(NamedTuple):
    """A socket that takes what comes. protocol: "tcp" or "udp"; pid 0: its process may not be looked into."""

    protocol: str
    address: ipaddress.IPv4Address | ipaddress.IPv6Address
    port: int
    inode: int
    pid: int = 0
    process: str = ""

    @property
    def outside(self) -> bool:
        """Whether it is bound to more than loopback."""
        mapped = getattr(self.address, "ipv4_mapped", None)
        return not (mapped or self.address).is_loopback

    def __str__(self) -> str:
        host = f"[{self.address}]" if self.address.version == 6 else str(self.address)
        return f"{self.process or 'unknown process'} {self.protocol} {host}:{self.port}"


def parse_table(text: str, name: str) -> list[Listening]:
    """Rows of /proc/net/<name> that wait for strangers."""
    found = []
    for line in text.splitlines()[1:]:
        fields = line.split()
        if len(fields) < 10 or int(fields[3], 16) != _TABLES[name]:
            continue
        host, port = fields[1].split(":")
        found.append(Listening(name[:3], _address(host), int(port, 16), int(fields[9])))
    return found


def _address(digits: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address:
    """The kernel prints 32-bit words of network order as numbers of this machine."""
    words = [int(digits[i : i + 8], 16) for i in range(0, len(digits), 8)]
    return ipaddress.ip_address(struct.pack(f"={len(words)}I", *words))


def listening(proc: Path = Path("/proc")) -> list[Listening]:
    """All of this network namespace; their processes are not looked up."""
    found = []
    for name in _TABLES:
        table = proc / "self" / "net" / name
        if table.exists():  # no IPv6: no table
            found += parse_table(table.read_text(encoding="ascii"), name)
    return found


def with_processes(sockets: Iterable[Listening], pids: Iterable[int]) -> list[Listening]:
    """Those of `sockets` that belong to one of the processes, with its number and name."""
    wanted = {each.inode: each for each in sockets}
    found = []
    for pid in pids:
        for inode in _inodes(pid):
            if inode in wanted:
                found.append(wanted[inode]._replace(pid=pid, process=process_name(pid)))
    return found


def _inodes(pid: int) -> set[int]:
    inodes = set()
    try:
        with os.scandir(f"/proc/{pid}/fd") as entries:
            for entry in entries:
                try:
                    target = os.readlink(entry.path)  # noqa: PTH115 (a thousand of them each time)
                except OSError:  # closed meanwhile
                    continue
                if target.startswith("socket:["):
                    inodes.add(int(target[8:-1]))
    except OSError:  # ended, or another user's
        pass
    return inodes


def process_name(pid: int) -> str:
    """The node's name if it has one, else the program's."""
    try:
        words = Path(f"/proc/{pid}/cmdline").read_bytes().decode(errors="replace").split("\0")
    except OSError:
        return f"process {pid}"
    for word in words:
        if word.startswith("__name:="):
            return word[len("__name:=") :]
    programs = [Path(word).name for word in words[:2] if word]
    return programs[-1] if programs and programs[0].startswith("python") else (programs or [f"process {pid}"])[0]


def graph_processes(master_uri: str, proc: Path = Path("/proc")) -> list[int]:
    """Processes that were started for this master in this network namespace: its address is in their environment."""
    wanted = b"ROS_MASTER_URI=" + master_uri.rstrip("/").encode()
    own_network = os.stat("/proc/self/ns/net").st_ino  # noqa: PTH116
    found = []
    for entry in os.scandir(proc):
        if not entry.name.isdigit():
            continue
        try:
            environment = Path(entry.path, "environ").read_bytes().split(b"\0")
            if not any(each.rstrip(b"/") == wanted for each in environment if each.startswith(b"ROS_MASTER_URI=")):
                continue
            if os.stat(f"{entry.path}/ns/net").st_ino == own_network:  # noqa: PTH116
                found.append(int(entry.name))
        except OSError:  # ended, or another user's
            continue
    return found


def is_local(host: str) -> bool:
    """Whether this computer has the numeric address: only then can something be bound to it."""
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.bind((host, 0))
        return True
    except OSError:
        return False
