"""script/bench recording: the data set of recorded sessions, beside a straightforward loop over rosbag and pandas.

Both read the same topics of the same bags (a minute each, 2400 messages a second) and write one Parquet table a bag
with 25 rows a second. The peer takes the newest message before each row (pandas.merge_asof): it interpolates nothing,
turns nothing by slerp, and writes no card. It is slow, and gets fewer bags; the start of processes is in both times.
Before any time is believed, the columns that both read must be equal.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "python"))

EXPORT = Path(__file__).with_name("recording_export.py")
DURATION_S = 60.0
BAGS = {"ours": 16, "rosbag": 2}
RUNS = 3
PEER = "rosbag + pandas"


class NotTheSame(RuntimeError):
    """The peer reads something else: its time would say nothing."""


def check(bag):
    """Largest difference between what both read of three topics; raises NotTheSame."""
    import recording_export

    from saras.recording import Session

    frames, _ = recording_export.frames_by_rosbag(bag)
    worst = 0.0
    with Session.open(bag) as session:
        for name, fields in (
            ("/mesa_left/ee_pose", ("pose.position.x", "pose.orientation.w")),
            ("/tank_master/state", ("energy_J", "reduction")),
            ("/mesa_right/measured_cf", ("wrench.force.z",)),
        ):
            topic, frame = session.topic(name), frames[name]
            if len(topic) != len(frame):
                raise NotTheSame(f"recording: {name}: {len(topic)} messages here, {len(frame)} there")
            for field in fields:
                worst = max(worst, float(np.abs(topic[field] - frame[field].to_numpy()).max()))
    if worst != 0.0:
        raise NotTheSame(f"recording: what both read differs by {worst:.1e}")
    return worst


def seconds(who, workers, bags, folder):
    """Of one export in a process of its own, on as many processors as it has workers."""
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    processors = sorted(os.sched_getaffinity(0))[:workers]
    threads = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        [sys.executable, EXPORT, who, str(workers), out, *bags],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, **threads},
        preexec_fn=lambda: os.sched_setaffinity(0, processors),
    )
    return float(done.stdout.split()[-1])


def run(duration_s=DURATION_S, bags=BAGS, runs=RUNS):
    """Rows of the group; ``bags`` of ``duration_s`` each for ours, and for the peer."""
    import recording_cpu
    import synthetic_session

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = [synthetic_session.write_session(folder / "0.bag", duration_s)]
        files += [Path(shutil.copy(files[0], folder / f"{number}.bag")) for number in range(1, max(bags.values()))]
        check(files[0])
        print(f"recording: both read the same; bags of {duration_s:.0f} s: {bags}", file=sys.stderr)
        rows = []
        for cores in (1, 2):
            if cores > len(os.sched_getaffinity(0)):
                break
            # Milliseconds of work a second of recording: 1000 is real time.
            spent = {
                who: percentiles([seconds(who, cores, files[:n], folder) / (n * duration_s) * 1e3 for _ in range(runs)])
                for who, n in bags.items()
            }
            times = {who: round(1e3 / each["p50"], 1) for who, each in spent.items()}
            print(f"recording: on {cores} processors, as multiples of real time: {times}", file=sys.stderr)
            rows.append(
                {
                    "group": "recording",
                    "name": f"export_{cores}_core" + "s" * (cores > 1),
                    "unit": "ms / recorded s",
                    "ours": spent["ours"],
                    "peers": {PEER: spent["rosbag"]},
                    "ratio": {PEER: round(spent["rosbag"]["p50"] / spent["ours"]["p50"], 2)},
                    "times_real_time": {"ours": times["ours"], PEER: times["rosbag"]},
                }
            )
        return rows + recording_cpu.run(files[0], 0.5 * duration_s)


def percentiles(values):
    return {"p50": float(np.percentile(values, 50)), "p99": float(np.percentile(values, 99))}
