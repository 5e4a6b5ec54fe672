"""graph_watch, one a host: ports that strangers can reach, links that carry nothing, clocks that are not in step.

It only reports: on /diagnostics, on rosout, and what changes for the worse on /system/events. All that asks others
happens in one thread of its own, with timeouts; a hung master or node costs this node time and nobody else.
"""

from __future__ import annotations

import math
import shlex
import socket
import threading
import time
from collections.abc import Iterable
from urllib.parse import urlparse

import rosgraph
import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse

from saras.net import ntp
from saras_ros1 import chrony_tracking, clock_watch, graph_exposure, link_test
from saras_ros1.clock_watch import Address, ClockWatch
from saras_ros1.graph_calls import CallError, Calls, Pair
from saras_ros1.graph_exposure import Exposure
from saras_ros1.link_test import BROKEN, LinkTest, State, Verdict
from saras_ros1.listening_sockets import is_local
from saras_ros1.node import Node, run
from saras_ros1.params import Params

MOST_SAID = 5  #: lines in the log about links of one test; /diagnostics has them all
THIS = "this computer"  #: its clock, as chrony on it says
FIRST_QUESTIONS = 4  #: for the time, so that the first estimate is already a good one


class GraphWatch(Node):
    """See the module's docstring."""

    def __init__(self) -> None:
        super().__init__("graph_watch", needs_params=False)
        # A further host's shares the first one's settings, but for what it is given itself.
        own = rospy.get_param(self.name, {})
        self.params = Params({**rospy.get_param("/graph_watch", {}), **own}, self.name)
        self.period_s = self.params.number("period_s", 1.0, 600.0)
        self.settle_s = self.params.number("settle_s", 0.5, 600.0)
        self.service_wait_s = self.params.number("service_wait_s", 1.0, 600.0)
        observe_s = self.params.number("observe_s", 0.1, 60.0)
        timeout_s = self.params.number("call_timeout_s", 0.1, 30.0)
        self.closed_interfaces = self.params.texts("closed_interfaces")
        self.ros_clock_limit_s = self.params.number("ros_clock_limit_s", 1e-4, 60.0)
        self.clock_limit_s = self.params.number("clock_limit_s", 1e-4, 3600.0)
        self.chronyc = shlex.split(self.params.text("chronyc"))
        self.chrony_limit_s = self.params.number("chrony_limit_s", 1e-6, 10.0)
        hosts = self.params.text("clock_hosts", empty=True)
        self.given_clocks = clock_watch.parse_hosts(hosts, f"{self.name}/clock_hosts")
        must_flow = self.params.texts("must_flow")
        self.params.finish()
        self.calls = Calls(self.name, rosgraph.get_master_uri().rstrip("/"), timeout_s)
        self.test = LinkTest(self.calls, must_flow, observe_s)
        self.clocks = ClockWatch(stale_s=4.0 * self.period_s)
        self.exposure: Exposure | None = None
        self.verdicts: dict[Pair, Verdict] = {}
        self.tested = False
        self.clock_hosts: dict[str, tuple[Address, bool]] = {}
        self.master_problem = ""
        self._uris: list[str] = []
        self._accepted: list[int] = []
        self._wires: list[tuple[str, Address, bool]] = []
        self._exposure_said: Exposure | None = None
        self._late_clocks: set[str] = set()
        self.tracking: chrony_tracking.Tracking | None = None
        self._all_anew = threading.Event()
        self._done = threading.Condition()
        self._rounds = 0
        self._events = self.output("/system/events", String)
        self.every(1.0, self._show)
        # Further hosts have a graph_watch of another name, and each its own test.
        service = "/system/link_test" if self.name == "/graph_watch" else f"{self.name}/link_test"
        rospy.Service(service, Trigger, self._on_test)
        threading.Thread(target=self._watch, name="graph watch", daemon=True).start()

    def _on_test(self, _) -> TriggerResponse:
        with self._done:
            wanted = self._rounds + 2 if self._all_anew.is_set() else self._rounds + 1
            self._all_anew.set()
            if not self._done.wait_for(lambda: self._rounds >= wanted, self.service_wait_s):
                return TriggerResponse(False, f"unknown: no result within {self.service_wait_s:g} s")
            verdicts = self.verdicts
        bad = link_test.broken(verdicts)
        text = "; ".join([link_test.summary(verdicts), *(_line(*item) for item in bad.items())])
        return TriggerResponse(not bad and bool(verdicts), text)

    def _watch(self) -> None:
        """The thread that asks. Links are tested once nothing new has come for settle_s, then when new ones come."""
        seen: set[Pair] = set()
        changed_s = time.monotonic()
        due_s = 0.0
        while not rospy.is_shutdown():
            now = time.monotonic()
            anew = self._all_anew.is_set()
            if now < due_s and not anew:
                time.sleep(0.2)
                continue
            due_s = now + (self.period_s if self.tested else min(self.period_s, self.settle_s))
            try:
                pairs = self._pairs()
                if not set(pairs) <= seen:
                    changed_s = now
                if not self.master_problem:  # else what it said before still holds, as far as anybody knows
                    seen = set(pairs)
                    self._uris = self._uris_of(pairs)
                    self._accepted, self._wires = _authenticated_ports(), _hosts_of_wires()
                self._look_at_ports()
                self._look_at_links(pairs, anew, settled=time.monotonic() - changed_s >= self.settle_s or self.tested)
                self._look_at_clocks()
            except rospy.ROSException:
                return
            except Exception as error:  # a watch that dies quietly would show its last words for ever
                rospy.logerr(f"{self.name}: {type(error).__name__}: {error}")
                self.master_problem = f"the watch failed: {error}"

    def _pairs(self) -> list[Pair]:
        try:
            pairs = self.calls.pairs()
            self.master_problem = ""
            return pairs
        except CallError as error:
            if not self.master_problem:
                rospy.logwarn(f"{self.name}: roscore does not answer: {error}")
            self.master_problem = f"roscore does not answer: {error}"
            return []

    def _uris_of(self, pairs: list[Pair]) -> list[str]:
        uris = []
        for name in sorted({name for pair in pairs for name in pair[1:]}):
            try:
                uris.append(self.calls.uri_of(name))
            except CallError as error:
                if "Error:" in str(error):  # the master itself fell silent: do not wait once a node
                    break
        return uris

    def _look_at_ports(self) -> None:
        found = graph_exposure.look(
            self.calls.master_uri, self._uris, closed_interfaces=self.closed_interfaces, accepted_udp=self._accepted
        )
        before, self._exposure_said = self._exposure_said, found
        self.exposure = found
        known = set() if before is None or not before.reachable else {each[:3] for each in before.open}
        if found.reachable and not {each[:3] for each in found.open} <= known:
            ports = ", ".join(str(each) for each in found.open)
            self._worse(f"ROS ports can be reached over {' '.join(found.interfaces)}: {ports}: {found.advice}")

    def _look_at_links(self, pairs: list[Pair], anew: bool, settled: bool) -> None:
        if not self.master_problem and (anew or settled):
            known = {pair: self.verdicts[pair] for pair in pairs if pair in self.verdicts}
            # What works is left in peace: asking costs the asked node a little of its time.
            wanted = [pair for pair in pairs if anew or pair not in known or known[pair].state in BROKEN]
            fresh = self.test.run(wanted) if wanted else {}
            worse = {
                pair: verdict
                for pair, verdict in fresh.items()
                if known.get(pair, Verdict(State.FLOWS))[0] != verdict[0]
            }
            self.verdicts = {**known, **fresh}
            if fresh and (not self.tested or anew or worse):
                rospy.loginfo(f"link test: {link_test.summary(self.verdicts)}")
            for pair, verdict in list(link_test.broken(worse).items())[:MOST_SAID]:
                self._worse(f"link test: {_line(pair, verdict)}")
            self.tested = True
        if anew:
            with self._done:
                self._all_anew.clear()
                self._rounds += 1
                self._done.notify_all()

    def _look_at_clocks(self) -> None:
        hosts = {name: (where, False) for name, where in self.given_clocks.items()}
        for name, where, in_graph in [*((n, w, True) for n, w in self._hosts_of_graph()), *self._wires]:
            if where not in [known for known, _ in hosts.values()]:
                hosts[name] = (where, in_graph)
        for name, (where, _) in hosts.items():
            self.clocks.look(where, 1 if name in self.clock_hosts else FIRST_QUESTIONS)
        self.clock_hosts = hosts
        self.tracking = chrony_tracking.ask(self.chronyc)
        if self.tracking is None and any(in_graph for _, in_graph in hosts.values()):
            self.tracking = chrony_tracking.unknown("chrony is not installed here, and the graph has other hosts")
        for name in [*hosts, *([THIS] if self.tracking is not None else [])]:
            level, text, _ = self._clock(name)
            late = level == DiagnosticStatus.WARN
            if late and name not in self._late_clocks:
                self._worse(f"clock of {name}: {text}")
            (self._late_clocks.add if late else self._late_clocks.discard)(name)

    def _hosts_of_graph(self) -> Iterable[tuple[str, Address]]:
        for host in sorted({urlparse(uri).hostname or "" for uri in self._uris}):
            try:
                numeric = socket.gethostbyname(host)
            except OSError:
                continue
            if not is_local(numeric):
                yield host, (numeric, ntp.PORT)

    def _own_clock(self) -> tuple[int, str, dict]:
        """What chrony says here; without chrony and other hosts nothing needs this clock to be right."""
        said, limit_s = self.tracking, self.chrony_limit_s
        text = chrony_tracking.words(said)
        if math.isnan(said.offset_s):
            return DiagnosticStatus.STALE, text, {}
        late = chrony_tracking.beyond(said, limit_s)
        values = {
            "offset_s": f"{said.offset_s:.9f}",
            "rms_s": f"{said.rms_s:.9f}",
            "error_ms": f"{1e3 * said.error_s:.3f}",
            "limit_s": limit_s,
            "source": said.source,
            "stratum": said.stratum,
        }
        text += f"; more than {1e3 * limit_s:g} ms" if late else ""
        return DiagnosticStatus.WARN if late else DiagnosticStatus.OK, text, values

    def _clock(self, name: str) -> tuple[int, str, dict]:
        if name == THIS:
            return self._own_clock()
        where, in_graph = self.clock_hosts[name]
        said = self.clocks.said(where)
        text = clock_watch.words(said)
        if said.offset is None:
            return DiagnosticStatus.STALE, text, {"address": where[0]}
        limit_s = self.ros_clock_limit_s if in_graph else self.clock_limit_s
        late = abs(said.offset.offset_s) - said.offset.error_s > limit_s
        values = {
            "address": where[0],
            "offset_s": f"{said.offset.offset_s:.6f}",
            "error_ms": f"{1e3 * said.offset.error_s:.3f}",
            "round_trip_ms": f"{1e3 * said.offset.round_trip_s:.3f}",
            "limit_s": limit_s,
            "synchronised": said.synchronised,
            "stratum": said.stratum,
            "steps": said.steps,
        }
        return (
            DiagnosticStatus.WARN if late else DiagnosticStatus.OK,
            f"{text}; more than {limit_s:g} s: let chrony set it" if late else text,
            values,
        )

    def _worse(self, text: str) -> None:
        rospy.logwarn(text)
        self._events.publish(String(text))

    def _show(self) -> None:
        """What is known, once a second: what nobody repeats is shown as unknown."""
        prefix = "" if self.name == "/graph_watch" else f" seen by {self.name.lstrip('/')}"
        self._publish(f"graph ports{prefix}", *self._ports())
        self._publish(f"graph links{prefix}", *self._links())
        for name in [*self.clock_hosts, *([THIS] if self.tracking is not None else [])]:
            self._publish(f"clock of {name}{prefix}", *self._clock(name))

    def _ports(self) -> tuple[int, str, dict]:
        found = self.exposure
        if found is None or not found.checked:
            return DiagnosticStatus.STALE, "unknown: not looked at yet" if found is None else found.words, {}
        values = {str(each): f"process {each.pid or 'unknown'}" for each in found.open}
        if found.reachable:
            return DiagnosticStatus.WARN, f"{found.words}: {found.advice}", values
        return DiagnosticStatus.OK, found.words, values

    def _links(self) -> tuple[int, str, dict]:
        if self.master_problem:
            return DiagnosticStatus.STALE, f"unknown: {self.master_problem}", {}
        if not self.tested:
            return DiagnosticStatus.STALE, "unknown: not tested yet", {}
        bad = link_test.broken(self.verdicts)
        values = {f"{pair.topic} {pair.publisher} → {pair.subscriber}": verdict.state.value for pair, verdict in
                  self.verdicts.items()}  # fmt: skip
        text = "; ".join([link_test.summary(self.verdicts), *(_line(*item) for item in list(bad.items())[:1])])
        return DiagnosticStatus.WARN if bad else DiagnosticStatus.OK, text, values

    def _publish(self, name: str, level: int, text: str, values: dict) -> None:
        pairs = [KeyValue(str(key), str(value)) for key, value in values.items()]
        message = DiagnosticArray(status=[DiagnosticStatus(level=level, name=name, message=text, values=pairs)])
        message.header.stamp = rospy.Time.now()
        self._diagnostics.publish(message)


def _line(pair: Pair, verdict: Verdict) -> str:
    return f"{pair.topic} {pair.publisher} → {pair.subscriber}: {verdict.state.value}: {verdict.why}"


def _authenticated_ports() -> list[int]:
    """UDP ports of touchball_receiver that believe authenticated datagrams only."""
    values = _parameters("/touchball_receiver")
    links = [values, *([values["second_console"]] if values.get("has_second_console") else [])]
    return [link["bind_port"] for link in links if link.get("key_file") and "bind_port" in link]


def _hosts_of_wires() -> list[tuple[str, Address, bool]]:
    """Computers that speak only a wire protocol: the console's and the arms'."""
    hosts = {"console": _parameters("/touchball_receiver").get("console_host", "")}
    for side in ("left", "right"):
        hosts[f"arm_{side}"] = urlparse(str(_parameters(f"/arm_driver_{side}").get("url", ""))).hostname or ""
    found = []
    for name, host in hosts.items():
        try:
            numeric = socket.gethostbyname(host) if host else ""
        except OSError:
            continue
        if numeric and not is_local(numeric):
            found.append((name, (numeric, ntp.PORT), False))
    return found


def _parameters(node: str) -> dict:
    try:
        values = rospy.get_param(node, {})
    except Exception:  # the master does not answer: nothing is known
        return {}
    return values if isinstance(values, dict) else {}


def main() -> int:
    """Runs the node."""
    return run(GraphWatch)
