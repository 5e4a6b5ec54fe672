"""script/demo palpation: finds the stiff inclusion of the phantom by itself.

The modeler begins with a coarse mesh that is shifted and bent; it says where to touch next, the slave goes there and
keeps palpating. Exit code 0: the inclusion was found within 2 mm, nothing died, bag, map and report are there.
"""

from __future__ import annotations

import argparse
import datetime
import os
import time
from pathlib import Path
from typing import Any

import numpy as np

from saras_ros1.csa_demo import DOWN_M, publish_facts
from saras_ros1.demo import ROOT, START_TIMEOUT_S, DemoError, close_bag
from saras_ros1.demo_session import died, ros_session, run_demo
from saras_ros1.processes import Child

SYSTEM = ROOT / "config" / "csa" / "palpation.json"
LEAST_S, APPROACH_S, LOOK_S, SAY_S, SILENT_S = 30.0, 3.0, 1.0, 4.0, 15.0


def parse(argv: list[str]) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(
        prog="script/demo palpation", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--headless", action="store_true", help="no rviz, also when there is a display")
    parser.add_argument("--duration", type=float, default=150.0, metavar="S", help="of palpation (%(default)s)")
    parser.add_argument(
        "--out", type=Path, metavar="DIR", help="where bag, map, report and logs go; default out/<date>"
    )
    parser.add_argument("--seed", type=int, default=1, help="of the inclusion's place and the prior's shift and bend")
    parser.add_argument("--cost", default="lump", help="lump, upper_confidence, variance or an entry point")
    arguments = parser.parse_args(argv)
    if not LEAST_S <= arguments.duration <= 3600.0:
        parser.error(f"--duration {arguments.duration:g}: must be in [{LEAST_S:g}, 3600] seconds")
    if arguments.seed < 0:
        parser.error(f"--seed {arguments.seed}: must be at least 0")
    arguments.out = (arguments.out or ROOT / "out" / f"{datetime.datetime.now():%Y-%m-%d_%H-%M-%S}").resolve()
    return arguments


class Watched:
    """What the modeler says, beside the truth."""

    def __init__(self, truth: Any) -> None:
        from sensor_msgs.msg import PointCloud2

        from saras_ros1.latest import Latest
        from saras_ros1.msg import CsaModelerState

        self.truth = truth
        self.cloud = Latest("/csa/modeler/stiffness", PointCloud2)
        self.state = Latest("/csa/modeler/state", CsaModelerState)
        self.rows: Any = None
        self.begun_with: Any = None
        self.series: list[Any] = []
        self.paces_Hz: list[float] = []
        self.pace: dict[str, str] = {}
        self.silent = False

    @property
    def there(self) -> bool:
        """A map and a state came."""
        return self.cloud.value(3.0) is not None and self.state.value(3.0) is not None

    def look(self, t_s: float) -> None:
        """One row of errors, if there is news."""
        from saras_ros1.modeler_messages import read_cloud

        cloud, state = self.cloud.value(3.0), self.state.value(3.0)
        if cloud is None or state is None:
            return
        self.rows = read_cloud(cloud)
        if self.begun_with is None:
            self.begun_with = self.rows
        stiffest = np.array([state.stiffest.x, state.stiffest.y, state.stiffest.z])
        self.series.append(self.truth.errors(t_s, int(state.learned), self.rows, stiffest))
        self.paces_Hz.append(state.touched_hz)
        self.pace = {
            "vertices near the tip asked [1/s], median": f"{np.median(self.paces_Hz):.1f}",
            "a vertex out of date for [s], at the longest, 99 %": f"{state.oldest_s_p99:.2f}",
            "a sample learned in [ms], 99 %": f"{1e3 * state.learning_s_p99:.2f}",
            "samples dropped for want of time": str(state.waiting_dropped),
        }

    def line(self) -> str:
        """In a few words."""
        state = self.state.value(3.0)
        if state is None or not self.series:
            return "nothing from the modeler"
        last = self.series[-1]
        return (
            f"{state.status.split(':')[0]}, {last.samples} samples, {100 * last.known:.0f} % known, surface "
            f"{1e3 * last.surface_m:.2f} mm; stiffest {state.stiffest_N_m:.0f} ± {state.stiffest_std_N_m:.0f} N/m, "
            f"{1e3 * last.inclusion_m:.1f} mm from the inclusion"
        )


def palpate(arguments: argparse.Namespace, setup: Any, watched: Watched, system: Child, modeler: Child) -> None:
    """Goes down, lets the modeler lead, saves the map. Raises DemoError when something ends by itself."""
    import rospy
    from std_srvs.srv import SetBool

    from saras_ros1.csa_surgeon import Surgeon
    from saras_ros1.latest import Latest
    from saras_ros1.msg import CsaTeleopState
    from saras_ros1.srv import KeepModel

    told, surgeon = Latest("/csa/teleop/state", CsaTeleopState), Surgeon(setup)
    children = (system, modeler)
    end = time.monotonic() + START_TIMEOUT_S
    while told.value() is None or not watched.there:
        _alive(children)
        if time.monotonic() > end:
            raise DemoError(f"controllers or modeler did not come up:\n{system.tail()}\n{modeler.tail()}")
        time.sleep(0.1)
    try:
        surgeon.enable()
        watched.look(0.0)
        surgeon.go([0.0, 0.0, -DOWN_M], APPROACH_S)
        rospy.ServiceProxy("/csa/teleop/set_exploring", SetBool)(True)
        begin = time.monotonic()
        looked_s = said_s = begin
        while time.monotonic() - begin < arguments.duration:
            _alive(children)
            if time.monotonic() - looked_s >= LOOK_S:
                looked_s = time.monotonic()
                watched.look(looked_s - begin)
            if time.monotonic() - said_s >= SAY_S:
                said_s = time.monotonic()
                print(f"[demo] {said_s - begin:4.0f} s  {watched.line()}", flush=True)
            time.sleep(0.05)
        watched.silent = watched.cloud.value(SILENT_S) is None
        said = rospy.ServiceProxy("/csa/modeler/save", KeepModel)(str(arguments.out / "map.ply"), True)
        print(f"[demo] {said.message}", flush=True)
        rospy.ServiceProxy("/csa/teleop/set_exploring", SetBool)(False)
        surgeon.go([0.0, 0.0, 0.01], APPROACH_S)
    except KeyboardInterrupt:
        print("[demo] interrupted: stopping", flush=True)
    finally:
        surgeon.stop()


def _alive(children: tuple[Child, ...]) -> None:
    for child in children:
        if child.exit_code is not None:
            raise DemoError(f"a launch ended by itself (code {child.exit_code}):\n{child.tail()}")


def run_system(arguments: argparse.Namespace, system_file: Path, watching: list[Watched]) -> None:
    """csa.launch and modeler.launch, for as long as palpate() needs; what is seen goes to watching as soon as it is."""
    from saras.csa.system import load
    from saras_ros1.palpation_truth import Truth

    out = arguments.out
    setup = load(system_file).setup()
    with ros_session(out) as env:
        arguments.system = system_file
        facts = publish_facts(arguments)
        rviz = str(not arguments.headless and bool(os.environ.get("DISPLAY"))).lower()
        given = {"system": system_file, "record": "true", "bag": out / "session.bag"}
        command = ["roslaunch", str(ROOT / "launch" / "csa.launch"), *(f"{k}:={v}" for k, v in given.items())]
        beside = ["roslaunch", str(ROOT / "launch" / "modeler.launch")]
        beside += [f"{k}:={v}" for k, v in (("system", system_file), ("cost", arguments.cost), ("rviz", rviz))]
        print(
            f"[demo] ROS_MASTER_URI={env['ROS_MASTER_URI']}\n[demo] {' '.join(command)}\n[demo] {' '.join(beside)}",
            flush=True,
        )
        watched = Watched(Truth(setup))
        watching.append(watched)
        with Child("roslaunch", command, out / "log" / "roslaunch.log", env) as system:
            with Child("modeler", beside, out / "log" / "modeler.log", env) as modeler:
                palpate(arguments, setup, watched, system, modeler)
            close_bag(out)
        del facts


def conclude(arguments: argparse.Namespace, watched: Watched | None) -> list[str]:
    """Writes the report; returns what went wrong."""
    from saras_ros1.palpation_report import FOUND_M, report

    out: Path = arguments.out
    if watched is None or not watched.series:
        return ["no map came"]
    facts = {**watched.pace, "seed": arguments.seed, "cost": arguments.cost, "system file": out / "system.json"}
    html = report(watched.truth, watched.rows, watched.begun_with, watched.series, facts)
    (out / "report.html").write_text(html, encoding="utf-8")
    last, problems = watched.series[-1], []
    print(f"[demo] inclusion found {1e3 * last.inclusion_m:.1f} mm off; report {out / 'report.html'}", flush=True)
    if not last.inclusion_m <= FOUND_M:
        problems.append(f"the inclusion was not found: {1e3 * last.inclusion_m:.1f} mm off")
    if watched.silent:
        problems.append(f"no map in the last {SILENT_S:g} s: what is shown is old")
    for name in ("roslaunch.log", "modeler.log"):
        problems += died(out / "log" / name)
    if not list(out.glob("*.bag")):
        problems.append(f"no bag in {out}")
    return problems


def main(argv: list[str]) -> int:
    """Exit code: 0 all well, 1 something was not, 2 wrong arguments."""
    arguments = parse(argv)
    out: Path = arguments.out
    watched: list[Watched] = []

    def run() -> None:
        from saras_ros1.palpation_truth import draw

        run_system(arguments, draw(SYSTEM, out, arguments.seed), watched)

    return run_demo(out, run, lambda: conclude(arguments, watched[0] if watched else None))
