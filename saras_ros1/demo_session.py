"""What the demos of situational awareness share: a ROS master of their own, and how they begin and end."""

from __future__ import annotations

import os
import shutil
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from saras_ros1.demo import DemoError, environment, wait_for_master
from saras_ros1.processes import Child


@contextmanager
def ros_session(out: Path) -> Iterator[dict[str, str]]:
    """A roscore, and this process as the node /demo of it. Gives the environment of further children."""
    env = environment(out)
    os.environ.update({key: env[key] for key in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR")})
    os.environ.pop("ROS_HOSTNAME", None)
    master_port = env["ROS_MASTER_URI"].rsplit(":", 1)[1]
    with Child("roscore", ["roscore", "-p", master_port], out / "log" / "roscore.log", env) as core:
        wait_for_master(core)
        import rospy

        from saras_ros1 import direct_publishing

        direct_publishing.install()
        rospy.init_node("demo", disable_signals=True)
        yield env
        rospy.signal_shutdown("demo over")


def died(log: Path) -> list[str]:
    """Lines of a roslaunch's log that tell of processes that died."""
    text = log.read_text(encoding="utf-8", errors="replace") if log.exists() else ""
    return [line.strip() for line in text.splitlines() if "process has died" in line]


def run_demo(out: Path, run: Callable[[], None], conclude: Callable[[], list[str]]) -> int:
    """Exit code: 0 all well, 1 something was not, 2 the directory is taken. conclude says what was not, after run."""
    if shutil.which("roslaunch") is None:
        print("[demo] roslaunch is not on PATH: run script/bootstrap and source devel/setup.bash", file=sys.stderr)
        return 1
    if list(out.glob("*.bag*")):
        print(f"[demo] {out} holds a recording already: choose another --out", file=sys.stderr)
        return 2
    out.mkdir(parents=True, exist_ok=True)
    signal.signal(signal.SIGTERM, lambda *_: signal.raise_signal(signal.SIGINT))
    problems: list[str] = []
    try:
        run()
    except KeyboardInterrupt:
        problems.append("interrupted while starting or stopping")
    except DemoError as error:
        problems.append(str(error))
    problems += conclude()
    for problem in problems:
        print(f"[demo] PROBLEM {problem}", file=sys.stderr)
    print(f"[demo] {'ended with problems' if problems else 'all well'}: {out}", flush=True)
    return 1 if problems else 0
