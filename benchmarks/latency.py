"""The group latency: the real-time host on loopback at 1 kHz, at rest, under load, with and without its recorder.

force_sent: from a datagram's arrival in the kernel to the sending of the force; set_point_handed: to the set-points in
their mailbox; round_trip: as the console sees it. No times of the separate graph here: they have other stations.
"""

import contextlib
import json
import os
import shutil
import subprocess
import sys

SECONDS = 10.0
RATE_HZ = 1000.0
RECORD_S = 60.0
SHOWN = ("force_sent", "set_point_handed", "round_trip", "lateness")


@contextlib.contextmanager
def load(wanted):
    """stress-ng on all processors."""
    if not wanted:
        yield
        return
    with subprocess.Popen(["stress-ng", "--quiet", "--cpu", str(os.cpu_count()), "--timer", "1"]) as stress:
        try:
            yield
        finally:
            stress.terminate()


def measure(program, seconds, pacing, record_s, loaded=False):
    command = [str(program), str(seconds), str(RATE_HZ), pacing, str(record_s)]
    with load(loaded):
        text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return json.loads(text)


def run(program, soak_s=0.0):
    """Rows in the format of the JSON file."""
    cases = [
        ("", SECONDS, "datagram", RECORD_S, False),
        ("_tick_paced", SECONDS, "tick", RECORD_S, False),
        ("_no_recorder", SECONDS, "datagram", 0.0, False),
    ]
    if shutil.which("stress-ng"):
        cases.append(("_under_load", SECONDS, "datagram", RECORD_S, True))
    else:
        print("latency: without load, for want of stress-ng: apt-get install stress-ng", file=sys.stderr)
    if soak_s:
        cases.append(("_soak", soak_s, "datagram", RECORD_S, False))
    rows, steps = [], None
    for suffix, seconds, pacing, record_s, loaded in cases:
        answer = measure(program, seconds, pacing, record_s, loaded)
        steps = steps or answer["pipeline_step"]
        print(
            f"latency{suffix or '_at_rest'}: {answer['steps']} steps, {answer['overruns']} overruns, "
            f"{answer['holds']} holds, memory grew {answer['resident_growth_bytes']} B; {answer['realtime']}",
            file=sys.stderr,
        )
        facts = {key: value for key, value in answer.items() if not isinstance(value, dict)}
        for name in SHOWN:
            rows.append(row(name + suffix, answer[name], facts))
    rows.insert(0, row("pipeline_step_4_tools_100_regions", steps, {}))
    return rows


def row(name, times, facts):
    ours = {key: times[key] for key in ("p50", "p99", "p99.9", "max")}
    return {"group": "latency", "name": name, "unit": "ns", "ours": ours, "peers": {}, "ratio": {}, **facts}
