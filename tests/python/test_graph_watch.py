"""What graph_watch reads and how it judges: sockets of real processes, nodes that answer as rospy and roscpp do."""

from __future__ import annotations

import itertools
import os
import socket
import threading
from xmlrpc.server import SimpleXMLRPCServer

import numpy as np
import pytest

pytest.importorskip("rospy")
from saras import ConfigError
from saras_ros1 import clock_watch, graph_exposure, link_test, listening_sockets
from saras_ros1.graph_calls import Bus, CallError, Calls, Pair, unresolvable
from saras_ros1.link_test import BROKEN, State, View, judge

NOWHERE = "no-such-host.invalid"


def opened(kind: int, family: int, host: str) -> socket.socket:
    made = socket.socket(family, kind)
    made.bind((host, 0))
    if kind == socket.SOCK_STREAM:
        made.listen()
    return made


def test_listening_sockets_are_those_that_the_process_opened() -> None:
    places = [
        (socket.AF_INET, "127.0.0.1"),
        (socket.AF_INET, "0.0.0.0"),
        (socket.AF_INET6, "::"),
        (socket.AF_INET6, "::1"),
    ]
    made = {}
    for (family, host), kind in itertools.product(places, (socket.SOCK_STREAM, socket.SOCK_DGRAM)):
        try:
            made[opened(kind, family, host)] = host
        except OSError:  # no IPv6 here
            continue
    connected = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)  # hears one peer only: does not wait for strangers
    connected.connect(("127.0.0.1", 9))
    found = listening_sockets.with_processes(listening_sockets.listening(), [os.getpid()])
    by_port = {(each.protocol, each.port): each for each in found}
    for one, host in made.items():
        protocol = "tcp" if one.type == socket.SOCK_STREAM else "udp"
        each = by_port[protocol, one.getsockname()[1]]
        assert str(each.address) == host
        assert each.outside == (host in ("0.0.0.0", "::"))
        assert each.pid == os.getpid()
    assert ("udp", connected.getsockname()[1]) not in by_port
    for one in [*made, connected]:
        one.close()


def test_exposure_needs_an_open_port_and_an_interface(monkeypatch: pytest.MonkeyPatch) -> None:
    with (
        opened(socket.SOCK_STREAM, socket.AF_INET, "0.0.0.0") as one,
        opened(socket.SOCK_DGRAM, socket.AF_INET, "0.0.0.0") as authenticated,
    ):
        port, udp = one.getsockname()[1], authenticated.getsockname()[1]
        for interfaces, closed, reachable in ((["eth0"], [], True), (["eth0"], ["eth0"], False), ([], [], False)):
            monkeypatch.setattr(
                graph_exposure.network_namespace, "outside_interfaces", lambda interfaces=interfaces: interfaces
            )
            found = graph_exposure.look("http://127.0.0.1:1", [], [os.getpid()], closed, [udp])
            assert found.reachable == reachable
            assert port in [each.port for each in found.open]
            assert udp not in [each.port for each in found.open]
            assert ("closed" in found.words) != reachable


def test_ports_of_another_users_nodes_count_by_their_address() -> None:
    with opened(socket.SOCK_STREAM, socket.AF_INET, "0.0.0.0") as one:
        uri = f"http://127.0.0.1:{one.getsockname()[1]}"
        assert [each.port for each in graph_exposure.look("http://127.0.0.1:1", [uri]).open] == [one.getsockname()[1]]


def test_nothing_to_look_at_is_unknown_not_closed() -> None:
    assert "unknown" in graph_exposure.look("http://127.0.0.1:1", []).words


class FakeNode:
    """Answers as a node or as the master does; counts[topic, peer] are bytes, read and raised by each look."""

    def __init__(self, cpp: bool = False) -> None:
        self.server = SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False, allow_none=True)
        self.uri = f"http://127.0.0.1:{self.server.server_address[1]}"
        self.sent: dict[tuple[str, str], list[int]] = {}
        self.received: dict[tuple[str, str], list[int]] = {}
        self.cpp = cpp
        self.server.register_function(self.bus_info, "getBusInfo")
        self.server.register_function(self.bus_stats, "getBusStats")
        threading.Thread(target=self.server.serve_forever, args=(0.01,), daemon=True).start()

    def rows(self):
        ways = [(way, "o") for way in self.sent] + [(way, "i") for way in self.received]
        return [(i, way, direction) for i, (way, direction) in enumerate(ways)]

    def bus_info(self, _):
        return [1, "", [[i, peer + "/" * (d == "i"), d, "TCPROS", topic, True] for i, (topic, peer), d in self.rows()]]

    def bus_stats(self, _):
        published, subscribed = [], []
        for i, way, direction in self.rows():
            counts = (self.sent if direction == "o" else self.received)[way]
            count = counts.pop(0) if len(counts) > 1 else counts[0]
            if direction == "o":
                published.append([way[0], count, [[i, count, 1, 0 if self.cpp else True]]])
            else:
                subscribed.append([way[0], [[i, count, 1, 0 if self.cpp else -1, 0 if self.cpp else True]]])
        if self.cpp:
            return [published, []]  # roscpp leaves all but one of a topic out, and code and text
        return [1, "", [published, subscribed, []]]


def graph(nodes: dict[str, FakeNode | str], topics: dict[str, tuple[list[str], list[str]]]) -> Calls:
    master = FakeNode()
    state = [[[t, p] for t, (p, _) in topics.items()], [[t, s] for t, (_, s) in topics.items()], []]
    uris = {name: node if isinstance(node, str) else node.uri for name, node in nodes.items()}
    master.server.register_function(lambda _: [1, "", state], "getSystemState")
    master.server.register_function(
        lambda _, name: [1, "", uris[name] + "/"] if name in uris else [-1, "?", 0], "lookupNode"
    )
    return Calls("/test", master.uri, 2.0)


def test_links_as_rospy_and_roscpp_count_them() -> None:
    talker, listener, cpp = FakeNode(), FakeNode(), FakeNode(cpp=True)
    silent = opened(socket.SOCK_STREAM, socket.AF_INET, "127.0.0.1")  # a hung node: takes the connection, never answers
    nodes = {"/t": talker, "/l": listener, "/cpp": cpp, "/far": f"http://{NOWHERE}:1234"}
    nodes["/hung"] = f"http://127.0.0.1:{silent.getsockname()[1]}"
    topics = {f"/{word}": (["/t"], ["/l"]) for word in ("flows", "idle", "must", "lost", "late", "unconnected")}
    topics |= {
        "/cpp": (["/t"], ["/cpp"]),
        "/far": (["/far"], ["/l"]),
        "/hung": (["/t"], ["/hung"]),
        "/gone": (["/x"], ["/l"]),
    }
    counts = {"flows": ([5, 9], [1, 2]), "idle": ([5], [5]), "must": ([0], [0]), "lost": ([0, 7], [0])}
    counts |= {"late": ([0, 7], [0, 0, 7])}  # what was under way at the second look came with the third
    for word, (sent, received) in counts.items():
        talker.sent[f"/{word}", "/l"], listener.received[f"/{word}", talker.uri] = list(sent), list(received)
    talker.sent["/unconnected", "/l"] = [0]
    talker.sent["/cpp", "/cpp"], cpp.received["/cpp", talker.uri] = [1, 2], [0]
    calls = graph(nodes, topics)
    verdicts = link_test.LinkTest(calls, ["/must"], 0.01).run(calls.pairs())
    states = {pair.topic.strip("/"): verdict.state for pair, verdict in verdicts.items()}
    assert states == {
        "flows": State.FLOWS, "idle": State.IDLE, "must": State.SILENT, "lost": State.SILENT, "late": State.FLOWS,
        "unconnected": State.UNCONNECTED, "cpp": State.SENT, "far": State.UNRESOLVED, "hung": State.UNKNOWN,
        "gone": State.UNCONNECTED,
    }  # fmt: skip
    assert NOWHERE in next(verdict.why for pair, verdict in verdicts.items() if pair.topic == "/far")
    assert "2 silent" in link_test.summary(verdicts)
    assert {pair.topic for pair in link_test.broken(verdicts)} == {
        "/must",
        "/lost",
        "/unconnected",
        "/far",
        "/hung",
        "/gone",
    }


def test_a_hung_or_absent_master_is_an_error_not_a_wait_for_ever() -> None:
    with opened(socket.SOCK_STREAM, socket.AF_INET, "127.0.0.1") as hung:
        with pytest.raises(CallError, match="getSystemState"):
            Calls("/test", f"http://127.0.0.1:{hung.getsockname()[1]}", 0.3).pairs()
        port = hung.getsockname()[1]
    with pytest.raises(CallError, match="Connection refused"):
        Calls("/test", f"http://127.0.0.1:{port}", 0.3).pairs()


def test_what_is_not_known_to_work_is_never_shown_as_working(many: int) -> None:
    """Random views: a link is good only when its subscriber answered twice and is connected, and both names resolve."""
    rng = np.random.default_rng(5)
    pair, uri = Pair("/x", "/p", "/s"), "http://p:1"

    def count():
        return [None, 0, 5, 9][rng.integers(4)]

    def bus(table: dict) -> Bus:
        return Bus(*(({key: count()} if rng.random() < 0.7 else {}) for key in table))

    def view(uri: str) -> View:
        looks = [bus({("/x", "/s"): 0, ("/x", "http://p:1"): 0}) if rng.random() < 0.7 else None for _ in range(3)]
        return View(uri, "no name" if rng.random() < 0.1 else "", "", *looks)

    good = 0
    for _ in range(3000 * many):
        views = {"/p": view(uri), "/s": view("http://s:2")}
        verdict = judge(pair, views, {"/x"} if rng.random() < 0.3 else ())
        publisher, subscriber = views["/p"], views["/s"]
        if verdict.state in BROKEN:
            assert verdict.why
            continue
        good += 1
        assert not publisher.problem
        assert not subscriber.problem
        assert None not in (subscriber.first, subscriber.second)
        assert ("/x", uri) in (subscriber.third or subscriber.second).received
        if verdict.state == State.FLOWS:
            came = (subscriber.third or subscriber.second).received["/x", uri]
            assert came > (subscriber.first.received.get(("/x", uri), 0) or 0)
    assert good > 100


def test_names_that_resolve_and_one_that_does_not() -> None:
    assert unresolvable("http://127.0.0.1:11311") == ""
    assert unresolvable("http://localhost:11311") == ""
    assert NOWHERE in unresolvable(f"http://{NOWHERE}:11311")


@pytest.mark.parametrize("text", ["console", "console=", "=1.2.3.4", "a=host.name", "a=1.2.3.4:0", "a=1.2.3.4:x"])
def test_clock_hosts_are_refused_by_name(text: str) -> None:
    with pytest.raises(ConfigError, match="/graph_watch/clock_hosts"):
        clock_watch.parse_hosts(f"good=1.2.3.4 {text}", "/graph_watch/clock_hosts")


def test_a_host_that_does_not_answer_is_unknown() -> None:
    with opened(socket.SOCK_DGRAM, socket.AF_INET, "127.0.0.1") as mute:
        watch = clock_watch.ClockWatch(stale_s=10.0)
        where = mute.getsockname()
        assert watch.said(where).offset is None
        watch.look(where)
        said = watch.said(where)
    assert said.offset is None
    assert "unknown" in clock_watch.words(said)
    assert str(where[1]) in clock_watch.words(said)
