"""The group latency among processes: the platform in both hostings, and a chain of roscpp nodes that compute nothing.

A console process (saras_console_benchmark) sends to each over loopback. Phases: at rest, stress-ng on
all processors, the ROS master stopped (SIGSTOP), a subscriber of the fast topics stopped, rosbag recording everything.

round_trip   from a datagram's sending to the first answer that knows it, as the console sees it (realtime host, chain)
force        from a datagram's arrival to its force, where the node that sends it to the console hears it (a subscriber)
set_point    from a datagram's arrival to its set-point, where the arm's node hears it (a subscriber)

An answer of the separate graph echoes the newest datagram, not the one its force comes from: it has no round trip.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from saras_ros1.processes import Child, descendants, free_ports  # noqa: E402

RATES_HZ = {"realtime": 1000.0, "separate": 100.0, "chain": 1000.0}
PHASES = ("at_rest", "under_load", "master_stopped", "subscriber_stopped", "recording")
SECONDS = 10.0
SETTLE_S = 1.0
START_TIMEOUT_S = 120.0
TOPICS = ("/touchball_left/wrench:wrench", "/mesa_left/set_point")
STATIONS = {"/touchball_left/wrench": "force", "/mesa_left/set_point": "set_point"}
#: Between the receiver and itself a force passes tf_transformer, transparency, tank_master and tf_transformer again.
RELAYS = 4


class NoResult(RuntimeError):
    """A peer did not come up; the text is for the user."""


class Meter:
    """A program that prints a line of JSON for each line it reads."""

    def __init__(self, command: list[str], env: dict[str, str]) -> None:
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=env)

    def end_phase(self) -> dict:
        """What it has measured since the last call."""
        self._process.stdin.write("\n")
        self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            raise NoResult(f"{self._process.args[0]} ended by itself ({self._process.wait()})")
        return json.loads(line)

    def __enter__(self) -> Meter:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.stdin.close()
        self._process.wait(10.0)


class Bench:
    """A ROS master of its own, and what was measured on it."""

    def __init__(self, programs: Path, directory: Path, seconds: float) -> None:
        self.programs, self.directory, self.seconds = programs, directory, seconds
        ((port,), _) = free_ports(tcp=1)
        self.env = dict(os.environ, ROS_MASTER_URI=f"http://127.0.0.1:{port}", ROS_IP="127.0.0.1")
        self.env.update(ROS_LOG_DIR=str(directory / "log"), ROS_HOME=str(directory))
        self.env.pop("ROS_HOSTNAME", None)
        self.port = port

    def child(self, name: str, command: list[str]) -> Child:
        """A process of this bench, with its log."""
        return Child(name, command, self.directory / f"{name}.log", self.env)

    def program(self, name: str, *arguments: object) -> list[str]:
        """Its command line."""
        return [str(self.programs / f"saras_{name}"), *map(str, arguments)]

    @contextlib.contextmanager
    def master(self) -> Iterator[int]:
        """A roscore; gives the pid of its rosmaster."""
        import rosgraph

        with self.child("roscore", ["roscore", "-p", str(self.port)]) as core:
            self._wait(lambda: rosgraph.is_master_online(self.env["ROS_MASTER_URI"]), "roscore", core)
            pids = [pid for pid in descendants(core.pid) if b"rosmaster" in Path(f"/proc/{pid}/cmdline").read_bytes()]
            yield pids[0]

    @staticmethod
    def _wait(done, what: str, child: Child) -> None:
        end = time.monotonic() + START_TIMEOUT_S
        while not done():
            if time.monotonic() > end or child.exit_code is not None:
                raise NoResult(f"{what} did not come up:\n{child.tail()}")
            time.sleep(0.1)

    @contextlib.contextmanager
    def platform(self, hosting: str) -> Iterator[Meter]:
        """The launched platform with both sides engaged; gives its console."""
        import rospy
        from saras_ros1.msg import ChannelState

        (arms, (up, down)) = free_ports(tcp=2, udp=2)
        given = dict(hosting=hosting, console="false", auto_engage="true", surgeon="rest", watch="false")
        given.update(bind_port=up, console_port=down, arm_port_left=arms[0], arm_port_right=arms[1])
        command = ["roslaunch", str(ROOT / "launch" / "saras_mrs.launch"), *(f"{k}:={v}" for k, v in given.items())]
        states: dict[str, int] = {}
        watched = [
            rospy.Subscriber(f"/system/{side}/state", ChannelState, lambda m: states.update({m.side: m.state}))
            for side in ("left", "right")
        ]
        console = Meter(self.program("console_benchmark", up, down, RATES_HZ[hosting]), self.env)
        with self.child(hosting, command) as launched, console:
            self._wait(lambda: list(states.values()) == [ChannelState.ENGAGED] * 2, f"{hosting}, engaged", launched)
            yield console
        for subscriber in watched:
            subscriber.unregister()

    @contextlib.contextmanager
    def chain(self) -> Iterator[Meter]:
        """A gateway and RELAYS relays; gives their console."""
        (_, (up, down)) = free_ports(udp=2)
        with contextlib.ExitStack() as stack:
            for i in range(RELAYS):
                relay = self.program("ros_relay", "relay", f"/chain_{i}", f"/chain_{i + 1}")
                stack.enter_context(self.child(f"relay_{i}", relay))
            gateway = self.program("ros_relay", "gateway", up, down, "/chain_0", f"/chain_{RELAYS}")
            child = stack.enter_context(self.child("gateway", gateway))
            console = stack.enter_context(Meter(self.program("console_benchmark", up, down, 1000.0), self.env))
            self._wait(lambda: console.end_phase()["round_trip"]["count"] > 0, "the relays", child)
            yield console

    @contextlib.contextmanager
    def disturbance(self, phase: str, master: int) -> Iterator[None]:
        """What is done to the graph while a phase is measured."""
        with contextlib.ExitStack() as stack:
            if phase == "under_load":
                command = ["stress-ng", "--quiet", "--cpu", str(os.cpu_count()), "--timer", "1"]
                stack.enter_context(self.child("stress", command))
            elif phase == "master_stopped":
                os.kill(master, signal.SIGSTOP)
                stack.callback(os.kill, master, signal.SIGCONT)
            elif phase == "subscriber_stopped":
                frozen = stack.enter_context(self.child("frozen", ["rostopic", "hz", *STATIONS]))
                time.sleep(2.0)  # it connects
                os.kill(frozen.pid, signal.SIGSTOP)
                stack.callback(os.kill, frozen.pid, signal.SIGCONT)
            elif phase == "recording":
                record = ["rosbag", "record", "-a", "-O", str(self.directory / "everything.bag")]
                stack.enter_context(self.child("recorder", record))
                time.sleep(2.0)
            time.sleep(SETTLE_S)
            yield

    def measure(self, name: str, console: Meter, master: int, phases: tuple[str, ...]) -> dict[str, dict]:
        """phase → station → times [ns]."""
        answer = {}
        with contextlib.ExitStack() as stack:
            meters = [console]
            if name != "chain":
                meters.append(stack.enter_context(Meter(self.program("ros_meter", *TOPICS), self.env)))
                time.sleep(2.0)  # it connects
            for phase in phases:
                if phase == "under_load" and not shutil.which("stress-ng"):
                    print("latency: without load, for want of stress-ng: apt-get install stress-ng", file=sys.stderr)
                    continue
                with self.disturbance(phase, master):
                    for meter in meters:
                        meter.end_phase()
                    time.sleep(self.seconds)
                    found = {k: v for meter in meters for k, v in meter.end_phase().items()}
                answer[phase] = {STATIONS.get(k, k): v for k, v in found.items()}
                seen = ", ".join(f"{k} p50 {v['p50'] / 1e3:.0f} us of {v['count']}" for k, v in answer[phase].items())
                print(f"latency: {name} {phase}: {seen}", file=sys.stderr)
        return answer


def measure_all(programs: Path, seconds: float = SECONDS) -> dict[str, dict[str, dict]]:
    """Peer → phase → station → times [ns]."""
    import rospy

    answer = {}
    with tempfile.TemporaryDirectory() as directory:
        bench = Bench(programs, Path(directory), seconds)
        os.environ.update({k: bench.env[k] for k in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR", "ROS_HOME")})
        with bench.master() as master:
            rospy.init_node("bench", disable_signals=True, disable_rosout=True)
            for hosting in ("realtime", "separate"):
                with bench.platform(hosting) as console:
                    answer[hosting] = bench.measure(hosting, console, master, PHASES)
            with bench.chain() as console:
                answer["chain"] = bench.measure("chain", console, master, ("at_rest", "under_load"))
            rospy.signal_shutdown("bench over")
    return answer
