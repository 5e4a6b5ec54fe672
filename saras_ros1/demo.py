"""script/demo: the whole platform against simulated consoles and arms, recorded, with a report at the end.

Everything runs on loopback with ports of its own, so that several demos and other ROS systems do not meet.
Exit code 0: both sides were engaged for the time asked but for short HOLDs that the demo answered (a busy machine),
no process died, bag and report are there.
"""

from __future__ import annotations

import argparse
import contextlib
import datetime
import importlib
import json
import os
import shutil
import signal
import subprocess
import sys
import time
import xml.etree.ElementTree
from pathlib import Path

from saras_ros1.processes import Child, free_ports

ROOT = Path(__file__).resolve().parents[1]
LAUNCH_FILE = ROOT / "launch" / "saras_mrs.launch"
START_TIMEOUT_S = 90.0
LARGEST_HELD_PART = 0.1  #: of the session on HOLD, above which the demo was no success
REQUIRED_ARGS = {"record", "operator", "bag"}
#: demos with a command line of their own
OTHERS = {"csa": "saras_ros1.csa_demo", "palpation": "saras_ros1.palpation_demo"}


class DemoError(RuntimeError):
    """The demo cannot go on; the text is for the user."""


def parse(argv: list[str] | None = None) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="script/demo", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "name", nargs="?", default="platform", choices=["platform", *OTHERS], help="which demo; each has its own --help"
    )
    parser.add_argument("--headless", action="store_true", help="no rviz, also when there is a display")
    parser.add_argument(
        "--duration", type=float, metavar="S", help="seconds of engaged operation; default: until Ctrl-C"
    )
    parser.add_argument("--out", type=Path, metavar="DIR", help="where bag, report and logs go; default out/<date>")
    parser.add_argument("--operator", choices=["weak", "normal", "firm"], default="normal", help="the simulated hand")
    parser.add_argument("--motion", help="what the hands do: a name that the console knows, or a recorded motion file")
    parser.add_argument(
        "--hosting",
        choices=["separate", "realtime"],
        default="separate",
        help="a process each law, or all laws in one real-time loop",
    )
    parser.add_argument(
        "--endoscope", action="store_true", help="with a simulated stereo endoscope, overlay and seen contact"
    )
    parser.add_argument(
        "--claps",
        action="store_true",
        help="--endoscope, and a flash, a beep and a jump of PSM1 at each full second, for saras bag align",
    )
    parser.add_argument("--seed", type=int, default=1, help="of everything random in the simulation")
    arguments = parser.parse_args(argv)
    if arguments.duration is not None and not 0 < arguments.duration <= 86400:
        parser.error(f"--duration {arguments.duration:g}: must be in (0, 86400] seconds")
    if arguments.motion and Path(arguments.motion).exists():
        arguments.motion = str(Path(arguments.motion).resolve())
    arguments.out = (arguments.out or ROOT / "out" / f"{datetime.datetime.now():%Y-%m-%d_%H-%M-%S}").resolve()
    return arguments


def launch_arguments(arguments: argparse.Namespace, out: Path) -> dict[str, str]:
    """What the launch file is given: of all that a demo would say, the arguments that the file declares."""
    (left, right), (up, down) = free_ports(tcp=2, udp=2)
    wanted = {
        "sim": "true",
        "rviz": str(not arguments.headless and bool(os.environ.get("DISPLAY"))).lower(),
        "record": "true",
        "bag": str(out / "session.bag"),
        "operator": arguments.operator,
        "hosting": arguments.hosting,
        "flight_records": str(out / "flight"),
        "seed": str(arguments.seed),
        "auto_engage": "false",
        "trace_laws": "true",
        "bind_port": str(up),
        "console_port": str(down),
        "arm_port_left": str(left),
        "arm_port_right": str(right),
    }
    if arguments.claps:
        wanted["claps"] = "true"
    if arguments.endoscope or arguments.claps:
        wanted.update(endoscope="sim", overlay="true", contact="true")
    if arguments.motion:
        wanted["motion"] = arguments.motion
    declared = declared_arguments()
    missing = (REQUIRED_ARGS | ({"motion"} if arguments.motion else set())) - declared.keys()
    if missing:
        raise DemoError(f"{LAUNCH_FILE.name} declares no argument {', '.join(sorted(missing))}")
    return {name: value for name, value in wanted.items() if name in declared}


def declared_arguments() -> dict[str, str | None]:
    """Names and defaults of the launch file's arguments."""
    root = xml.etree.ElementTree.parse(LAUNCH_FILE).getroot()
    return {str(arg.get("name")): arg.get("default") for arg in root.findall("arg") if arg.get("value") is None}


def environment(out: Path) -> dict[str, str]:
    """Own ROS master on loopback, logs under ``out``."""
    ((port,), _) = free_ports(tcp=1)
    env = dict(os.environ)
    env.update(
        ROS_MASTER_URI=f"http://127.0.0.1:{port}",
        ROS_IP="127.0.0.1",
        ROS_LOG_DIR=str(out / "log"),
        PYTHONUNBUFFERED="1",
    )
    env.pop("ROS_HOSTNAME", None)
    return env


def wait_for_master(core: Child, timeout_s: float = 20.0) -> None:
    """Returns when roscore answers."""
    import rosgraph

    end = time.monotonic() + timeout_s
    while not rosgraph.is_master_online():
        if core.exit_code is not None or time.monotonic() > end:
            raise DemoError(f"roscore did not come up:\n{core.tail()}")
        time.sleep(0.1)


def publish_session_facts(arguments: argparse.Namespace) -> object:
    """Latched /saras/session: what the report's header shows. Returns the publisher; keep it."""
    import rospy
    import yaml
    from std_msgs.msg import String

    import saras

    nominal = yaml.safe_load((ROOT / "config" / "teleop.yaml").read_text(encoding="utf-8"))
    git = subprocess.run(
        ["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True, check=False
    )
    facts = {
        "hosting": arguments.hosting,
        "operator": arguments.operator,
        "motion": arguments.motion or declared_arguments().get("motion"),
        "rate_hz": round(1.0 / nominal["transparency"]["period_s"], 3),
        "seed": arguments.seed,
        "sim": True,
        "saras": saras.__version__,
        "git": git.stdout.strip() or None,
    }
    publisher = rospy.Publisher("/saras/session", String, queue_size=1, latch=True)
    publisher.publish(json.dumps({key: value for key, value in facts.items() if value is not None}))
    return publisher


def operate(arguments: argparse.Namespace, platform: Child) -> float | None:
    """Engages, then shows the live table until the time is over or Ctrl-C; returns the time of day of engagement.

    DemoError when the platform ends by itself or never engages.
    """
    from rich.console import Console
    from rich.live import Live

    from saras_ros1.engagement import Engagement
    from saras_ros1.status import Status

    status, engagement, console = Status(), Engagement(), Console()
    live = Live(console=console, auto_refresh=False) if console.is_terminal else None
    started, said_at = time.monotonic(), 0.0
    if live is not None:
        live.start()
    try:
        while True:
            now = time.monotonic()
            if platform.exit_code is not None:
                raise DemoError(f"the platform ended by itself (code {platform.exit_code}):\n{platform.tail()}")
            if engagement.since is not None or status.recording:
                engagement.update(status.states(), now)
            if engagement.since is None:
                title = "starting"
                if now - started > START_TIMEOUT_S:
                    raise DemoError(f"not engaged within {START_TIMEOUT_S:.0f} s: {status.line()}")
            else:
                engaged_s = now - engagement.since
                title = f"engaged {engaged_s:.0f} s of {arguments.duration or '∞'}"
                if arguments.duration is not None and engaged_s >= arguments.duration:
                    break
            if live is not None:
                live.update(status.table(f"{title}   (Ctrl-C ends)"), refresh=True)
            elif now - said_at >= 5.0:
                said_at = now
                print(f"[demo] {title}: {status.line()}", flush=True)
            time.sleep(0.25)
    except KeyboardInterrupt:
        print("[demo] interrupted: stopping", flush=True)
    finally:
        if live is not None:
            live.stop()
    return engagement.wall_since


def close_bag(out: Path, patience_s: float = 15.0) -> None:
    """Ends the recorder before the rest: nodes that stop one by one would be recorded as faults."""
    import rospy
    from std_srvs.srv import Trigger

    with contextlib.suppress(rospy.ServiceException):
        rospy.ServiceProxy("/recorder/stop", Trigger)()
    end = time.monotonic() + patience_s
    while list(out.glob("*.bag.active")) and time.monotonic() < end:
        time.sleep(0.1)


def run_platform(arguments: argparse.Namespace, out: Path) -> None:
    """Roscore and the launch file, for as long as operate() says; all processes are gone afterwards."""
    env = environment(out)
    # rospy and rosgraph in this process read the same variables.
    os.environ.update({key: env[key] for key in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR")})
    os.environ.pop("ROS_HOSTNAME", None)
    master_port = env["ROS_MASTER_URI"].rsplit(":", 1)[1]
    with Child("roscore", ["roscore", "-p", master_port], out / "log" / "roscore.log", env) as core:
        wait_for_master(core)
        import rospy

        rospy.init_node("demo", disable_signals=True)
        facts = publish_session_facts(arguments)
        given = [f"{name}:={value}" for name, value in launch_arguments(arguments, out).items()]
        command = ["roslaunch", str(LAUNCH_FILE), *given]
        print(f"[demo] ROS_MASTER_URI={env['ROS_MASTER_URI']}  {' '.join(command)}", flush=True)
        with Child("roslaunch", command, out / "log" / "roslaunch.log", env) as platform:
            engaged_at = operate(arguments, platform)
            close_bag(out)
        del facts
        rospy.signal_shutdown("demo over")
    return engaged_at


def conclude(out: Path, engaged_at: float | None) -> list[str]:
    """Checks the bag and writes the report; returns what went wrong after ``engaged_at`` (time of day)."""
    from saras import Error
    from saras.report import write_report

    bags = sorted(out.glob("*.bag"))
    if not bags:
        active = ", ".join(str(path) for path in out.glob("*.bag.active"))
        return [f"no bag in {out}" + (f"; the recorder did not close {active}" if active else "")]
    report = out / "report.html"
    try:
        found = write_report(bags[0], report)
    except Error as error:
        return [str(error)]
    problems = []
    for verdict in found.verdicts:
        print(f"[demo] {verdict.grade:>8}  {verdict.title}: {verdict.value} ({verdict.detail})")
    for side, bands in found.states.items():
        if not any(state == 2 for _, _, state in bands):
            problems.append(f"{side} side was never engaged")
            continue
        since_s = 0.0 if engaged_at is None else engaged_at - found.start_s
        held_s = sum(max(0.0, end - max(start, since_s)) for start, end, state in bands if state == 3)
        part = held_s / max(1e-9, bands[-1][1] - since_s)
        if part > LARGEST_HELD_PART:
            problems.append(f"{side} side: on HOLD for {held_s:.1f} s, {100 * part:.0f} % of the session")
    log = (out / "log" / "roslaunch.log").read_text(encoding="utf-8", errors="replace")
    problems += [line.strip() for line in log.splitlines() if "process has died" in line]
    print(f"[demo] report {report}\n[demo] bag    {bags[0]}")
    return problems


def main(argv: list[str] | None = None) -> int:
    """Exit code: 0 all well, 1 something was not, 2 wrong arguments."""
    given = sys.argv[1:] if argv is None else argv
    if given and given[0] in OTHERS:
        return int(importlib.import_module(OTHERS[given[0]]).main(given[1:]))
    arguments = parse(argv)
    out: Path = arguments.out
    if shutil.which("roslaunch") is None:
        print("[demo] roslaunch is not on PATH: run script/bootstrap and source devel/setup.bash", file=sys.stderr)
        return 1
    if list(out.glob("*.bag*")):
        print(f"[demo] {out} holds a recording already: choose another --out", file=sys.stderr)
        return 2
    out.mkdir(parents=True, exist_ok=True)
    # SIGTERM ends it like Ctrl-C: children are stopped, the report is written.
    signal.signal(signal.SIGTERM, lambda *_: signal.raise_signal(signal.SIGINT))
    problems: list[str] = []
    engaged_at: float | None = None
    try:
        engaged_at = run_platform(arguments, out)
        if engaged_at is None:
            problems.append("ended before both sides were engaged")
    except KeyboardInterrupt:
        problems.append("interrupted while starting or stopping")
    except DemoError as error:
        problems.append(str(error))
    problems += conclude(out, engaged_at)
    for problem in problems:
        print(f"[demo] PROBLEM {problem}", file=sys.stderr)
    print(f"[demo] {'ended with problems' if problems else 'all well'}: {out}", flush=True)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
