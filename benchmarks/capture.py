"""Rows of the group capture: processor time of capture and overlay in one nodelet manager, beside a process each.

Each pair of pictures is taken from GStreamer's test source, drawn on (the list of tools; no arm is there), and read by
one subscriber; processor time is that of the processes that capture and draw, over the pairs that came, in windows of a
second. The age of what is shown is from the picture's taking to its coming to that subscriber, with the overlay.
"""

from __future__ import annotations

import json
import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from xmlrpc.client import ServerProxy

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

WIDTH, HEIGHT, RATE_HZ = 1280, 720, 25
WINDOWS, SETTLE_S = 20, 5.0
NODELETS = ("/endoscope_capture", "/visual_feedback")
MANAGER = "/endoscope_manager"
STAMP = struct.Struct("<III")  # Header: seq, secs, nsecs


class NoResult(RuntimeError):
    """The nodes did not come up; the text is for the user."""


def cpu_s(pid: int) -> float:
    """Processor time of a process and its threads [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text(encoding="utf-8").rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def percentiles(values: np.ndarray) -> dict[str, float]:
    """Of a row."""
    return {key: float(np.percentile(values, share)) for key, share in (("p50", 50), ("p99", 99))}


class Run:
    """The launched nodes of one hosting; manager: empty for a process each."""

    def __init__(self, bench, manager: str) -> None:
        import rospy

        from saras.sim.endoscope import stereo_camera

        self.manager, self.pairs, self.ages_ms = manager, 0, []
        camera = stereo_camera(WIDTH, HEIGHT)
        eyes = {"left": bench.directory / "left.yaml", "right": bench.directory / "right.yaml"}
        camera.left.save(eyes["left"])
        camera.right.save(eyes["right"])
        given = {"width": 2 * WIDTH, "height": HEIGHT, "rate_hz": RATE_HZ, **eyes}
        if manager:
            given["manager"] = manager
        command = ["roslaunch", str(ROOT / "benchmarks" / "capture.launch"), *(f"{k}:={v}" for k, v in given.items())]
        self.child = bench.child("managed" if manager else "processes", command)
        self._readers = [
            rospy.Subscriber("/endoscope/left/image_overlay", rospy.AnyMsg, self._on_left, queue_size=2),
            rospy.Subscriber("/endoscope/right/image_overlay", rospy.AnyMsg, lambda _: None, queue_size=2),
        ]

    def _on_left(self, message) -> None:
        self.pairs += 1
        _, secs, nsecs = STAMP.unpack_from(message._buff)
        self.ages_ms.append(1e3 * (time.time() - secs - 1e-9 * nsecs))

    def pids(self) -> list[int]:
        """Of the processes that capture and draw."""
        import rosgraph

        master = rosgraph.Master("/bench")
        names = [self.manager] if self.manager else NODELETS
        return [ServerProxy(master.lookupNode(name)).getPid("/bench")[2] for name in names]

    def measure(self) -> tuple[np.ndarray, np.ndarray]:
        """Processor time of a pair in each window [ms], and the age of each picture that was shown [ms]."""
        end = time.monotonic() + 60.0
        while self.pairs < RATE_HZ:
            if time.monotonic() > end or self.child.exit_code is not None:
                raise NoResult(f"capture: no pictures:\n{self.child.tail()}")
            time.sleep(0.1)
        time.sleep(SETTLE_S)
        pids, windows = self.pids(), []
        self.ages_ms.clear()
        for _ in range(WINDOWS):
            pairs, spent = self.pairs, sum(map(cpu_s, pids))
            time.sleep(1.0)
            if self.pairs > pairs:
                windows.append(1e3 * (sum(map(cpu_s, pids)) - spent) / (self.pairs - pairs))
        return np.array(windows), np.array(self.ages_ms)

    def __enter__(self) -> Run:
        return self

    def __exit__(self, *_: object) -> None:
        for reader in self._readers:
            reader.unregister()
        self.child.stop()


def measure() -> dict[str, dict[str, dict[str, float]]]:
    """Hosting → pair_cpu, overlay_age → p50, p99 [ms]."""
    import rospy
    from latency_graph import Bench

    found = {}
    with tempfile.TemporaryDirectory() as directory:
        bench = Bench(Path(), Path(directory), 0.0)
        os.environ.update({k: bench.env[k] for k in ("ROS_MASTER_URI", "ROS_IP", "ROS_LOG_DIR", "ROS_HOME")})
        with bench.master():
            rospy.init_node("bench", disable_signals=True, disable_rosout=True)
            for hosting, manager in (("manager", MANAGER), ("processes", "")):
                with Run(bench, manager) as run_:
                    windows, ages = run_.measure()
                found[hosting] = {"pair_cpu": percentiles(windows), "overlay_age": percentiles(ages)}
                print(f"capture: {hosting}: {len(ages) / WINDOWS:.1f} of {RATE_HZ} Hz", file=sys.stderr)
    return found


def run() -> list[dict]:
    """Rows in the format of the JSON file. In a process of its own: rospy begins once in each."""
    done = subprocess.run([sys.executable, __file__], check=False, stdout=subprocess.PIPE, text=True)
    if done.returncode:
        raise NoResult("capture: no result, see above")
    found = json.loads(done.stdout)
    rows = []
    for name in ("pair_cpu", "overlay_age"):
        ours, theirs = found["manager"][name], found["processes"][name]
        rows.append(
            {
                "group": "capture",
                "name": f"{name}_{WIDTH}x{HEIGHT}",
                "unit": "ms",
                "ours": ours,
                "peers": {"processes": theirs},
                "ratio": {"processes": round(theirs["p50"] / ours["p50"], 2)},
            }
        )
    return rows


if __name__ == "__main__":
    try:
        print(json.dumps(measure()))
    except NoResult as error:
        sys.exit(str(error))
