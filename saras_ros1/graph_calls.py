"""Questions to master and nodes over XML-RPC that always end: a hung master hangs ROS's own calls for ever."""

from __future__ import annotations

import http.client
import socket
import xmlrpc.client
from typing import Any, NamedTuple
from urllib.parse import urlparse


class CallError(Exception):
    """No answer, or a refusal; the text says which."""


class Pair(NamedTuple):
    """A link that the master has brought about."""

    topic: str
    publisher: str
    subscriber: str


class Bus(NamedTuple):
    """A node's links and its own count [bytes]: sent by (topic, subscriber), received by (topic, publisher's URI).

    None: connected, but not counted. roscpp counts only one publisher of each topic that it receives.
    """

    sent: dict[tuple[str, str], int | None]
    received: dict[tuple[str, str], int | None]


class _Transport(xmlrpc.client.Transport):
    def __init__(self, timeout_s: float) -> None:
        super().__init__()
        self._timeout_s = timeout_s

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = self._timeout_s
        return connection


class Calls:
    """As `caller`, a node's name. Each call raises CallError within about timeout_s."""

    def __init__(self, caller: str, master_uri: str, timeout_s: float) -> None:
        self._caller, self._master_uri, self._timeout_s = caller, master_uri, timeout_s

    def _call(self, uri: str, method: str, *arguments: Any) -> Any:
        try:
            with xmlrpc.client.ServerProxy(uri, transport=_Transport(self._timeout_s)) as server:
                return getattr(server, method)(self._caller, *arguments)
        except (OSError, http.client.HTTPException, xmlrpc.client.Error) as error:
            raise CallError(f"{uri} {method}: {type(error).__name__}: {error}") from None

    def _ask(self, uri: str, method: str, *arguments: Any) -> Any:
        answer = self._call(uri, method, *arguments)
        if not isinstance(answer, list) or len(answer) != 3:
            raise CallError(f"{uri} {method}: not an answer of ROS: {str(answer)[:80]}")
        if answer[0] != 1:
            raise CallError(f"{uri} {method}: {answer[1]}")
        return answer[2]

    def pairs(self) -> list[Pair]:
        """All links that should be."""
        publishers, subscribers, _ = self._ask(self._master_uri, "getSystemState")
        subscribed = dict(subscribers)
        return [
            Pair(topic, publisher, subscriber)
            for topic, names in publishers
            for publisher in names
            for subscriber in subscribed.get(topic, [])
        ]

    def uri_of(self, node: str) -> str:
        """Where the node says that it can be reached, without a slash at its end."""
        return str(self._ask(self._master_uri, "lookupNode", node)).rstrip("/")

    def pid(self, uri: str) -> int:
        """Process number of a node, or of the master, on its own computer."""
        return int(self._ask(uri, "getPid"))

    @property
    def master_uri(self) -> str:
        """Of the master that is asked."""
        return self._master_uri

    def bus(self, uri: str) -> Bus:
        """What the node counts."""
        ways = {row[0]: row for row in self._ask(uri, "getBusInfo") if row[5]}
        stats = self._call(uri, "getBusStats")
        try:
            return _read_bus(ways, stats[2] if len(stats) == 3 else stats)  # roscpp answers without code and text
        except (TypeError, ValueError, IndexError, KeyError) as error:
            raise CallError(f"{uri} getBusStats: {type(error).__name__}: {error}") from None


def _read_bus(ways: dict[int, list], stats: list) -> Bus:
    """ways: rows of getBusInfo by their number."""
    count: dict[int, int] = {}
    published = [row for entry in stats[0] for row in entry[-1]]
    subscribed = [row for entry in stats[1] for row in entry[1]]
    for row in [*published, *subscribed]:
        # The last field is "connected": rospy says True or False, roscpp 0 whatever it is.
        if row[-1] is False:
            ways.pop(row[0], None)
        else:
            count[row[0]] = int(row[1])
    bus = Bus({}, {})
    for number, peer, direction, _, topic, *_ in ways.values():
        if direction != "i":
            bus.sent[topic, peer] = count.get(number)
        if direction != "o":
            bus.received[topic, peer.rstrip("/")] = count.get(number)
    return bus


def unresolvable(uri: str) -> str:
    """Why the host of a URI cannot be found from this computer; empty when it can. May take a resolver's patience."""
    host = urlparse(uri).hostname or ""
    try:
        socket.getaddrinfo(host, None)
    except (OSError, UnicodeError) as error:
        return f"host name '{host}' does not resolve here ({error})"
    return ""
