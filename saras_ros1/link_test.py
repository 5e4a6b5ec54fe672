"""Self-test of the graph's links: connected, host names known, data flowing. The judgement is pure; see graph_calls.

A link may be registered and yet carry nothing: its host name is unknown to the other side, or its peer hangs. ROS says
nothing of that.
"""

from __future__ import annotations

import enum
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterable
from typing import NamedTuple

from saras_ros1.graph_calls import Bus, CallError, Calls, Pair, unresolvable


class State(enum.Enum):
    """Of one link, best first."""

    FLOWS = "flows"
    SENT = "sent"  # connected, sent, and its subscriber does not count what comes
    IDLE = "idle"  # nothing was sent: says nothing about the link but that it is connected
    SILENT = "silent"
    UNCONNECTED = "unconnected"
    UNRESOLVED = "unresolved"
    UNKNOWN = "unknown"


BROKEN = (State.SILENT, State.UNCONNECTED, State.UNRESOLVED, State.UNKNOWN)


class Verdict(NamedTuple):
    """State of a link, and why."""

    state: State
    why: str = ""


class View(NamedTuple):
    """What was seen of a node. problem: its name does not resolve; mute: it does not answer."""

    uri: str = ""
    problem: str = ""
    mute: str = ""
    first: Bus | None = None
    second: Bus | None = None
    third: Bus | None = None  # of subscribers that seemed silent: a message may have been under way


def judge(pair: Pair, views: dict[str, View], must_flow: Collection[str]) -> Verdict:
    """The verdict on one link."""
    nobody = View(mute="not known to the master")
    publisher, subscriber = views.get(pair.publisher, nobody), views.get(pair.subscriber, nobody)
    for name, view in ((pair.publisher, publisher), (pair.subscriber, subscriber)):
        if view.problem:
            return Verdict(State.UNRESOLVED, f"{name}: {view.problem}: set ROS_IP there")
    if subscriber.first is None or subscriber.second is None:
        return Verdict(State.UNKNOWN, f"{pair.subscriber} does not answer: {subscriber.mute}")
    way = (pair.topic, publisher.uri)
    last = subscriber.third if subscriber.third is not None else subscriber.second
    if way not in last.received:
        return Verdict(State.UNCONNECTED, f"{pair.subscriber} has no connection to {publisher.uri}")
    came, came_before = last.received[way], subscriber.first.received.get(way, 0)
    if came is not None and came_before is not None and came > came_before:
        return Verdict(State.FLOWS)
    if publisher.first is None or publisher.second is None:
        return Verdict(State.UNKNOWN, f"{pair.publisher} does not answer: {publisher.mute}")
    back = (pair.topic, pair.subscriber)
    sent = (publisher.second.sent.get(back) or 0) - (publisher.first.sent.get(back) or 0)
    if sent > 0 and (came is None or came_before is None):
        return Verdict(State.SENT)
    if sent > 0:
        return Verdict(State.SILENT, f"{pair.publisher} sent {sent} bytes, {pair.subscriber} received none")
    if pair.topic in must_flow:
        return Verdict(State.SILENT, f"{pair.publisher} sends nothing, and should always")
    return Verdict(State.IDLE)


class LinkTest:
    """Looks at every node twice, observe_s apart. For a thread of its own: takes seconds, longer with hung nodes."""

    def __init__(
        self,
        calls: Calls,
        must_flow: Iterable[str],
        observe_s: float,
        sleep: Callable[[float], None] = time.sleep,
        pause_s: float = 0.01,
    ) -> None:
        self._calls, self._must_flow = calls, frozenset(must_flow)
        self._observe_s, self._sleep, self._pause_s = observe_s, sleep, pause_s

    def run(self, pairs: Collection[Pair]) -> dict[Pair, Verdict]:
        """Verdicts on these links."""
        views = {name: self._meet(name) for name in sorted({name for pair in pairs for name in pair[1:]})}
        self._look(views, "first", list(views))
        self._sleep(self._observe_s)
        self._look(views, "second", list(views))
        doubtful = {pair.subscriber for pair in pairs if judge(pair, views, self._must_flow).state == State.SILENT}
        if doubtful:
            self._sleep(self._observe_s)  # on a busy computer a message may take its time
            self._look(views, "third", sorted(doubtful))
        return {pair: judge(pair, views, self._must_flow) for pair in pairs}

    def _meet(self, node: str) -> View:
        try:
            uri = self._calls.uri_of(node)
        except CallError as error:
            return View(mute=str(error))
        return View(uri, problem=unresolvable(uri))

    def _look(self, views: dict[str, View], which: str, names: list[str]) -> None:
        for name in names:
            view = views[name]
            if view.problem or view.mute:
                continue
            try:
                views[name] = view._replace(**{which: self._calls.bus(view.uri)})
            except CallError as error:
                views[name] = view._replace(mute=str(error))
            # One node after another, with room between: a control node answers between two of its ticks.
            self._sleep(self._pause_s)


def summary(verdicts: dict[Pair, Verdict]) -> str:
    """One line for a person."""
    counts = Counter(verdict.state for verdict in verdicts.values())
    words = [f"{counts[state]} {state.value}" for state in State if counts[state]]
    return f"{len(verdicts)} links: " + (", ".join(words) or "none")


def broken(verdicts: dict[Pair, Verdict]) -> dict[Pair, Verdict]:
    """Those that are not known to work, worst first."""
    order = list(State)
    found = [(pair, verdict) for pair, verdict in verdicts.items() if verdict.state in BROKEN]
    return dict(sorted(found, key=lambda item: (-order.index(item[1].state), item[0])))
