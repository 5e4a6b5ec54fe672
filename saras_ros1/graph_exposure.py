"""Which ports of this graph a stranger on the network can reach, as far as this computer can tell."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple
from urllib.parse import urlparse

from saras_ros1 import listening_sockets, network_namespace
from saras_ros1.listening_sockets import Listening


class Exposure(NamedTuple):
    """What was found. interfaces: those that strangers may be behind; open: sockets bound to more than loopback."""

    interfaces: list[str]
    open: list[Listening]
    checked: int

    @property
    def words(self) -> str:
        """One line for a person."""
        if not self.checked:
            return "unknown: none of the graph's sockets may be looked at"
        if not self.open:
            return f"closed: {self.checked} listening sockets, all on loopback"
        if not self.interfaces:
            return f"closed: {self.checked} listening sockets, none behind an interface that leads outside"
        return f"{len(self.open)} of {self.checked} ports can be reached over {' '.join(self.interfaces)}"

    @property
    def reachable(self) -> bool:
        """Whether somebody outside may reach one."""
        return bool(self.interfaces and self.open)

    @property
    def advice(self) -> str:
        """What to do about it."""
        return "start with script/closed-graph, or close the interface by a firewall and name it in closed_interfaces"


def look(
    master_uri: str,
    node_uris: Iterable[str],
    pids: Iterable[int] = (),
    closed_interfaces: Iterable[str] = (),
    accepted_udp: Iterable[int] = (),
) -> Exposure:
    """Sockets of the graph's processes on this computer.

    Processes are those that have this master in their environment, and pids. Ports of the master and of nodes count too
    when their process belongs to another user. accepted_udp: ports that are meant to be reached, as what comes is
    authenticated.
    """
    sockets = listening_sockets.listening()
    # A process is named by what it listens on even when its sockets may not be looked at.
    found = {each.inode: each for each in listening_sockets.with_processes(sockets, {*pids, *_processes(master_uri)})}
    ports = {port for uri in (master_uri, *node_uris) if (port := _local_port(uri)) is not None}
    for each in sockets:
        if each.protocol == "tcp" and each.port in ports:
            found.setdefault(each.inode, each)
    accepted = set(accepted_udp)
    open_ones = [
        each for each in found.values() if each.outside and not (each.protocol == "udp" and each.port in accepted)
    ]
    interfaces = [name for name in network_namespace.outside_interfaces() if name not in set(closed_interfaces)]
    return Exposure(interfaces, sorted(open_ones, key=lambda each: (each.process, each.port)), len(found))


def _processes(master_uri: str) -> list[int]:
    return listening_sockets.graph_processes(master_uri)


def _local_port(uri: str) -> int | None:
    """The port when the host is this computer."""
    try:
        parts = urlparse(uri)
        host = parts.hostname or ""
        return parts.port if host in ("localhost", "") or listening_sockets.is_local(host) else None
    except (ValueError, OSError):
        return None
