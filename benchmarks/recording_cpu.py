"""What rosbag's recorder costs as the platform runs it, while a session is played back at its own speed."""

from __future__ import annotations

import contextlib
import os
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from saras.recording.bag import Bag
from saras.recording.completeness import lost_by_sequence
from saras.recording.survey import survey

TICKS = os.sysconf("SC_CLK_TCK")
START_S = 3.0  #: subscribing to all topics is not what is measured
PATIENCE_S = 30.0


class NoRos(RuntimeError):
    """roscore or rosbag did not come up."""


def run(session: Path, duration_s: float) -> list[dict]:
    """Rows of a session that is longer than duration_s."""
    bag = Bag(session)
    topics = list(bag.counts)
    bag.close()
    with tempfile.TemporaryDirectory() as folder, _core() as env:
        out = Path(folder) / "out.bag"
        shares = _record(session, topics, out, env, duration_s)
        found = survey(out)
    lost = sum(lost_by_sequence(publisher.seq)[0] for publisher in found.publishers if publisher.seq is not None)
    rates = {
        "messages_per_s": found.messages / found.duration_s,
        "kB_per_s": 1e-3 * found.size_bytes / found.duration_s,
    }
    ours = {"p50": float(np.percentile(shares, 50)), "p99": float(np.percentile(shares, 99))}
    row = {"group": "recording", "name": "recorder, share of one processor", "unit": "%", "ours": ours}
    print(
        f"recording: the recorder takes {ours['p50']:.1f} % of a processor at {rates['messages_per_s']:.0f} messages "
        f"and {rates['kB_per_s']:.0f} kB a second; {lost} lost",
        file=sys.stderr,
    )
    return [{**row, "peers": {}, "ratio": {}, "lost": lost, **{name: round(value, 1) for name, value in rates.items()}}]


def _record(session: Path, topics: list[str], out: Path, env: dict[str, str], duration_s: float) -> list[float]:
    """Shares of a processor [%], a second each."""
    from saras_ros1.bag_process import BagProcess

    quiet = {"stdin": subprocess.DEVNULL, "stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    log = out.with_name("rosconsole.conf")
    log.write_text("log4j.logger.ros=WARN\n")
    before = dict(os.environ)
    os.environ.update(env, ROSCONSOLE_CONFIG_FILE=str(log))
    try:
        recorder = BagProcess(out, topics, chunk_kB=16)  # as config/recording.yaml has it
        player = subprocess.Popen(["rosbag", "play", "--quiet", "--delay=2", str(session)], **quiet)
    finally:
        os.environ.clear()
        os.environ.update(before)
    try:
        end = time.monotonic() + PATIENCE_S
        while recorder.newest_ns() is None:
            if time.monotonic() > end or recorder.exit_code is not None:
                raise NoRos("nothing was recorded")
            time.sleep(0.1)
        pid = _recorder_under(recorder.pid)
        time.sleep(START_S)
        shares, (used, at) = [], (_used_s(pid), time.monotonic())
        until = at + duration_s
        while time.monotonic() < until and player.poll() is None:
            time.sleep(1.0)
            last, (used, now) = used, (_used_s(pid), time.monotonic())
            shares.append(100.0 * (used - last) / (now - at))
            at = now
        return shares
    finally:
        player.terminate()
        player.wait(PATIENCE_S)
        recorder.stop()


def _recorder_under(shell: int) -> int:
    """The process in the shell's session whose program is rosbag's recorder."""
    for entry in Path("/proc").iterdir():
        with contextlib.suppress(OSError, ValueError):
            if os.getsid(int(entry.name)) == shell and (entry / "comm").read_text().strip() == "record":
                return int(entry.name)
    raise NoRos("rosbag's recorder is not there")


def _used_s(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / TICKS  # user and system


@contextlib.contextmanager
def _core() -> Iterator[dict[str, str]]:
    """A roscore of its own on loopback."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    env = {"ROS_MASTER_URI": f"http://127.0.0.1:{port}", "ROS_IP": "127.0.0.1"}
    core = subprocess.Popen(
        ["roscore", "-p", str(port)],
        env={**os.environ, **env},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        end = time.monotonic() + PATIENCE_S
        while True:
            with contextlib.suppress(OSError), socket.create_connection(("127.0.0.1", port), 1.0):
                break
            if time.monotonic() > end or core.poll() is not None:
                raise NoRos("roscore did not come up")
            time.sleep(0.2)
        yield env
    finally:
        core.terminate()
        core.wait(PATIENCE_S)
