"""Three hosts and a stranger: the console's, the arms' and the core's computer, in network namespaces.

Real processes over real sockets; the wrong clocks are those of Python's time of day (tests/fakes/clock_shim).
"""

from __future__ import annotations

import json
import shutil
import sys
import time
from pathlib import Path

import pytest
from hosts import ROOT, Hosts, why_not_permitted

from saras.net import keys as key_files

FAKES, HERE = ROOT / "tests" / "fakes", Path(__file__).parent
NAMES = ["core", "console", "arms", "stranger"]
CONSOLE_AHEAD_S, ARMS_AHEAD_S = 2.5, -0.3
OK, WARN, STALE = 0, 1, 3

WHY_NOT = why_not_permitted() or ("" if shutil.which("roslaunch") else "ROS is not installed")
pytestmark = pytest.mark.skipif(bool(WHY_NOT), reason=WHY_NOT)


@pytest.fixture(scope="module")
def hosts(tmp_path_factory: pytest.TempPathFactory):
    with Hosts(NAMES, tmp_path_factory.mktemp("hosts")) as made:
        made.set_clock("console", CONSOLE_AHEAD_S)
        made.set_clock("arms", ARMS_AHEAD_S)
        for name in ("console", "arms"):
            made.start(name, f"time_{name}", sys.executable, str(FAKES / "ntp_server.py"), made.address(name))
        yield made


@pytest.fixture(scope="module")
def platform(hosts: Hosts, tmp_path_factory: pytest.TempPathFactory):
    """The closed graph with console and arms elsewhere. Gives what runs a program inside."""
    key_file = str(tmp_path_factory.mktemp("keys") / "saras.key")
    key_files.save(Path(key_file), key_files.draw())
    core, console, arms = (hosts.address(name) for name in ("core", "console", "arms"))
    for side, port in (("left", "48020"), ("right", "48021")):
        where = ("--host", arms, "--port", port, "--state-rate", "100", "--scene", str(ROOT / "config" / "scene.yaml"))
        hosts.start("arms", f"arm_{side}", sys.executable, "-m", "saras.mesa_link", "--name", f"mesa_{side}", *where)
    addresses = ("--platform", f"{core}:48010", "--listen", f"{console}:48011", "--key", key_file)
    hosts.start(
        "console", "console", sys.executable, "-m", "saras", "console", "--plain", "--motion", "circle", *addresses
    )
    module = (sys.executable, "-m", "saras_ros1.closed_graph")
    doors = (
        "--console",
        console,
        "--listen",
        f"{core}:48010",
        "--key",
        key_file,
        "--arm-left",
        arms,
        "--arm-right",
        arms,
    )
    hosts.start("core", "platform", *module, "--strict", *doors, "collision:=false", "dvrk:=false")

    def inside(*words: str) -> dict:
        joined = ("-m", "saras_ros1.closed_graph", "--join", sys.executable, str(HERE / "probe.py"), *words)
        end_s = time.monotonic() + 60.0
        while True:
            done = hosts.python("core", *joined)
            if done.returncode == 0 or time.monotonic() > end_s:
                break
            time.sleep(1.0)  # not up yet
        assert done.returncode == 0, done.stdout + done.stderr
        return json.loads(done.stdout.splitlines()[-1])

    return inside


@pytest.fixture(scope="module")
def closed(platform):
    """What the closed graph says of itself when it has looked at everything, and its ports."""
    return platform(
        "diagnostics", "graph links=links:", "graph ports=closed", "clock of console=against", "clock of arms=against"
    )


def wait_until(condition, what: str, patience_s: float = 60.0) -> None:
    end_s = time.monotonic() + patience_s
    while not condition():
        assert time.monotonic() < end_s, f"not within {patience_s:g} s: {what}"
        time.sleep(0.2)


def reachable(hosts: Hosts, name: str, ports: list[int]) -> list[int]:
    """TCP ports of the core's computer that answer to a host."""
    done = hosts.python(name, str(HERE / "reach.py"), hosts.address("core"), *map(str, ports))
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_console_and_arms_on_other_hosts_are_teleoperated_with_clocks_out_of_step(platform) -> None:
    done = platform("teleoperate")
    assert done["engaged"], done
    assert min(done["moved_m"].values()) > 0.003, done


def test_a_stranger_reaches_no_port_of_the_closed_graph(hosts: Hosts, closed: dict) -> None:
    ports = [port for protocol, port in closed["listening"] if protocol == "tcp"]
    assert 11311 in ports
    assert len(ports) > 30
    for name in ("stranger", "console", "arms", "core"):
        assert reachable(hosts, name, ports) == []


def test_the_cores_computer_itself_listens_to_the_console_alone(hosts: Hosts, closed: dict) -> None:
    look = (
        "import json; from saras_ros1.listening_sockets import listening as l; print(json.dumps([str(x) for x in l()]))"
    )
    done = hosts.python("core", "-c", look)
    assert json.loads(done.stdout) == [f"unknown process udp {hosts.address('core')}:48010"], done.stderr


def test_the_closed_graph_says_that_it_is_closed_and_that_its_links_carry(closed: dict) -> None:
    assert closed["complete"], closed["status"]
    ports, links = closed["status"]["graph ports"], closed["status"]["graph links"]
    assert ports["level"] == OK, ports
    assert links["level"] == OK, links
    states = links["values"]
    assert states["/tank_slave/left/twist /tank_slave → /velocity_integrator_left"] == "flows"
    assert states["/mesa_right/ee_pose /arm_state_right → /supervisor"] == "flows"


@pytest.mark.parametrize(("name", "ahead_s"), [("console", CONSOLE_AHEAD_S), ("arms", ARMS_AHEAD_S)])
def test_clocks_out_of_step_are_shown(closed: dict, name: str, ahead_s: float) -> None:
    """Only the console's is off by more than a second: for hosts outside the graph that is the limit."""
    clock = closed["status"][f"clock of {name}"]
    assert abs(float(clock["values"]["offset_s"]) - ahead_s) <= 1e-3 * float(clock["values"]["error_ms"]) + 1e-4
    assert clock["level"] == (WARN if abs(ahead_s) > 1.0 else OK), clock
    assert abs(float(clock["message"].split(" s ")[0]) - ahead_s) < 0.05


@pytest.fixture(scope="module")
def open_graph(hosts: Hosts):
    """A graph as ROS starts it, over two hosts, where one talker's host name is known to nobody: what is said of it."""
    uri = {"ROS_MASTER_URI": f"http://{hosts.address('core')}:11311"}
    hosts.start("core", "roscore", "roscore", "-p", "11311", **uri)
    wait_until(lambda: reachable(hosts, "core", [11311]), "roscore")
    node = str(ROOT / "devel" / "lib" / "saras_ros1" / "graph_watch")
    fast = ("_period_s:=2.0", "_settle_s:=1.0", "_observe_s:=1.0")
    load = hosts.start("core", "parameters", "rosparam", "load", str(ROOT / "config" / "graph_watch.yaml"), **uri)
    wait_until(lambda: load.exit_code == 0, "parameters")
    hosts.start("core", "watch", node, "__name:=graph_watch", *fast, **uri)
    hosts.start("core", "listener", "rostopic", "echo", "/heard", **uri)
    hosts.start("core", "deaf_listener", "rostopic", "echo", "/unheard", **uri)
    for topic, further in (("/heard", {}), ("/unheard", {"ROS_HOSTNAME": "operating-room-7"})):
        talk = ("rostopic", "pub", "-r", "10", topic, "std_msgs/String", "here")
        hosts.start("arms", f"talker{topic.strip('/')}", *talk, **uri, **further)
    arms = hosts.address("arms")
    wanted = ("graph links=/unheard", "graph links=/heard", f"clock of {arms}=against", "graph ports=rosmaster")
    done = hosts.python("core", str(HERE / "probe.py"), "diagnostics", *wanted, **uri)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_an_open_graph_is_reached_by_a_stranger_and_says_so(hosts: Hosts, open_graph: dict) -> None:
    assert reachable(hosts, "stranger", [11311]) == [11311]
    ports = open_graph["status"]["graph ports"]
    assert ports["level"] == WARN
    assert "eth0" in ports["message"]
    assert "closed-graph" in ports["message"]
    assert any("rosmaster" in name and ":11311" in name for name in ports["values"]), ports


def test_a_host_name_that_nobody_knows_is_named(open_graph: dict) -> None:
    links = open_graph["status"]["graph links"]
    state = {key.split(" ")[0]: value for key, value in links["values"].items()}
    assert state["/heard"] == "flows", links
    assert state["/unheard"] == "unresolved", links
    assert links["level"] == WARN
    assert "operating-room-7" in links["message"]
    assert "ROS_IP" in links["message"]


def test_the_clock_of_a_host_of_the_graph_may_be_off_by_less(hosts: Hosts, open_graph: dict) -> None:
    clock = open_graph["status"][f"clock of {hosts.address('arms')}"]
    assert clock["level"] == WARN, clock
    assert abs(float(clock["values"]["offset_s"]) - ARMS_AHEAD_S) < 0.05


def test_a_hung_master_is_shown_as_unknown_and_holds_nobody_up(hosts: Hosts, open_graph: dict) -> None:
    uri = {"ROS_MASTER_URI": f"http://{hosts.address('core')}:11311"}
    done = hosts.python("core", str(HERE / "probe.py"), "hung_master", **uri)
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout.splitlines()[-1])
    assert (result["shown"], result["recovered"], result["level"]) == (True, True, STALE), result
