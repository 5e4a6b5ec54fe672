"""script/demo csa: the published experiment. A scripted surgeon moves sideways over the phantom; the system keeps the
contact force, palpates and, once a region is picked with the pedal, keeps the tip inside. Recorded, with a report.

Exit code 0: full contact was reached, the region was closed, nothing died, bag and report are there.
"""

from __future__ import annotations

import argparse
import datetime
import json
import math
import os
import subprocess
import threading
import time
from pathlib import Path

import numpy as np

from saras_ros1.demo import ROOT, START_TIMEOUT_S, DemoError, close_bag
from saras_ros1.demo_session import died, ros_session, run_demo
from saras_ros1.processes import Child

SYSTEM = ROOT / "config" / "csa" / "demo.json"
DOWN_M, CORNER_M, SWEEP_M = 0.014, 0.008, 0.014
APPROACH_S, SWEEP_S, LEAVE_S = 3.0, 12.0, 4.0
LEAST_S = 40.0


def parse(argv: list[str]) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="script/demo csa", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--headless", action="store_true", help="no rviz, also when there is a display")
    parser.add_argument("--duration", type=float, default=75.0, metavar="S", help="of teleoperation (%(default)s)")
    parser.add_argument("--out", type=Path, metavar="DIR", help="where bag, report and logs go; default out/<date>")
    parser.add_argument("--system", type=Path, default=SYSTEM, help="system file with simulated arms")
    arguments = parser.parse_args(argv)
    if not LEAST_S <= arguments.duration <= 3600.0:
        parser.error(f"--duration {arguments.duration:g}: must be in [{LEAST_S:g}, 3600] seconds")
    arguments.system = arguments.system.resolve()
    arguments.out = (arguments.out or ROOT / "out" / f"{datetime.datetime.now():%Y-%m-%d_%H-%M-%S}").resolve()
    return arguments


class Operator:
    """Plays the surgeon's part in a thread, and says what is going on."""

    def __init__(self, surgeon, duration_s: float) -> None:
        self.surgeon, self.duration_s = surgeon, duration_s
        self.doing = "starting"
        self.region = False
        self._thread = threading.Thread(target=self._play, daemon=True)
        self._thread.start()

    @property
    def done(self) -> bool:
        """Whether the experiment is over."""
        return not self._thread.is_alive()

    def _play(self) -> None:
        surgeon, begin = self.surgeon, time.monotonic()
        down = np.array([0.0, 0.0, -DOWN_M])
        self.doing = "down to the phantom"
        surgeon.go(down, APPROACH_S)
        self.doing = "sideways; the system keeps the force and palpates"
        surgeon.follow(lambda t: down + np.array([SWEEP_M * math.sin(2.0 * math.pi * t / SWEEP_S), 0.0, 0.0]), SWEEP_S)
        corners = [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]
        for i, (x, y) in enumerate(corners):
            self.doing = f"picking the region with the pedal, point {i + 1}"
            surgeon.go(down + CORNER_M * np.array([x, y, 0.0]), 1.6)
            time.sleep(0.4)
            surgeon.click("pick")
        self.doing = "over the region's border; the fixture holds the tip inside"
        left_s = self.duration_s - (time.monotonic() - begin) - LEAVE_S
        surgeon.go(down, 1.5)
        if left_s > 1.5:
            surgeon.follow(_wide, left_s - 1.5)
        self.doing = "up again"
        surgeon.go(np.array([0.0, 0.0, 0.012]), LEAVE_S)


def _wide(t: float) -> np.ndarray:
    """Over the border to all sides, from and to rest."""
    size = SWEEP_M * min(1.0, t / 2.0)
    return np.array([size * math.sin(0.9 * t), size * math.sin(0.55 * t), -DOWN_M])


def operate(arguments: argparse.Namespace, system: Child) -> None:
    """Plays the experiment. Raises DemoError when the graph ends by itself or never holds contact."""
    import rospy

    from saras.csa.system import load
    from saras_ros1.csa_surgeon import Surgeon
    from saras_ros1.latest import Latest
    from saras_ros1.msg import CsaAdmittance, CsaTeleopState

    told, did = Latest("/csa/teleop/state", CsaTeleopState), Latest("/csa/slave/admittance", CsaAdmittance)
    surgeon = Surgeon(load(arguments.system).setup())
    end = time.monotonic() + START_TIMEOUT_S
    while told.value() is None or did.value() is None:
        if system.exit_code is not None or time.monotonic() > end or rospy.is_shutdown():
            raise DemoError(f"the controllers did not come up:\n{system.tail()}")
        time.sleep(0.1)
    surgeon.enable()
    play, said_s = Operator(surgeon, arguments.duration), 0.0
    try:
        while not play.done:
            if system.exit_code is not None:
                raise DemoError(f"the system ended by itself (code {system.exit_code}):\n{system.tail()}")
            if time.monotonic() - said_s >= 2.5:
                said_s = time.monotonic()
                print(f"[demo] {play.doing}: {line(told.value(), did.value())}", flush=True)
            time.sleep(0.1)
    except KeyboardInterrupt:
        print("[demo] interrupted: stopping", flush=True)
    finally:
        surgeon.stop()


def line(told, did) -> str:
    """State and force in a few words."""
    if told is None:
        return "nothing is known"
    state = ("no contact", "proxy in contact", "slave in contact", "full contact")[told.state]
    if told.hold:
        return f"HOLD: {told.reason}"
    if did is not None and math.isfinite(did.desired_force_N):
        state += f", {did.normal_force_N:.2f} N of {did.desired_force_N:.2f} N"
    return state


def publish_facts(arguments: argparse.Namespace) -> object:
    """Latched /saras/session: the report's header. Returns the publisher; keep it."""
    import rospy
    from std_msgs.msg import String

    import saras
    from saras.csa.system import load

    setup = load(arguments.system).setup()
    command = ["git", "-C", str(ROOT), "describe", "--always", "--dirty"]
    git = subprocess.run(command, capture_output=True, text=True, check=False).stdout.strip()
    facts = {
        "hosting": "separate",
        "seed": setup.phantom().get("seed", 1),
        "operator": setup.master.get("grip", "firm"),
        "motion": f"{setup.master['name']} → {setup.slave['name']}",
        "rate_hz": round(1.0 / setup.period_s, 3),
        "sim": True,
        "saras": saras.__version__,
        "git": git or None,
    }
    publisher = rospy.Publisher("/saras/session", String, queue_size=1, latch=True)
    publisher.publish(json.dumps({key: value for key, value in facts.items() if value is not None}))
    return publisher


def run_system(arguments: argparse.Namespace, out: Path) -> None:
    """Roscore and csa.launch, for as long as operate() needs; all processes are gone afterwards."""
    with ros_session(out) as env:
        facts = publish_facts(arguments)
        rviz = not arguments.headless and bool(os.environ.get("DISPLAY"))
        given = {"system": arguments.system, "record": "true", "bag": out / "session.bag", "rviz": str(rviz).lower()}
        launch = ROOT / "launch" / "csa.launch"
        command = ["roslaunch", str(launch), *(f"{name}:={value}" for name, value in given.items())]
        print(f"[demo] ROS_MASTER_URI={env['ROS_MASTER_URI']}  {' '.join(command)}", flush=True)
        with Child("roslaunch", command, out / "log" / "roslaunch.log", env) as system:
            operate(arguments, system)
            close_bag(out)
        del facts


def conclude(out: Path) -> list[str]:
    """Writes the report; returns what went wrong."""
    from saras import Error
    from saras.report import write_report

    bags = sorted(out.glob("*.bag"))
    if not bags:
        return [f"no bag in {out}"]
    try:
        found = write_report(bags[0], out / "report.html")
    except Error as error:
        return [str(error)]
    problems = []
    for verdict in found.verdicts:
        print(f"[demo] {verdict.grade:>8}  {verdict.title}: {verdict.value} ({verdict.detail})")
    grades = {verdict.title: verdict for verdict in found.verdicts}
    if grades["Contact"].grade != "good":
        problems.append(f"no full contact: {grades['Contact'].detail}")
    if grades["Out of the region"].value == "none picked":
        problems.append("no region was closed")
    problems += died(out / "log" / "roslaunch.log")
    print(f"[demo] report {out / 'report.html'}\n[demo] bag    {bags[0]}")
    return problems


def main(argv: list[str]) -> int:
    """Exit code: 0 all well, 1 something was not, 2 wrong arguments."""
    arguments = parse(argv)
    out: Path = arguments.out
    return run_demo(out, lambda: run_system(arguments, out), lambda: conclude(out))
