"""The group latency: the real-time host on loopback at 1 kHz, at rest, under load, with and without its recorder.

force_sent: from a datagram's arrival in the kernel to the sending of the force; set_point_handed: to the set-points in
their mailbox; round_trip: as the console sees it. Then the same among processes, beside peers: latency_graph.py.
"""

import contextlib
import json
import os
import shutil
import subprocess
import sys

import latency_graph

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
    if program.with_name("saras_ros_meter").exists():
        rows += among_processes(program.parent)
    else:
        print("latency: no peers, they need roscpp: script/bootstrap installs it", file=sys.stderr)
    return rows


def among_processes(programs):
    """Rows of the realtime host as launched, each beside the separate graph and the chain of roscpp nodes."""
    found = latency_graph.measure_all(programs)
    rows = []
    for phase in latency_graph.PHASES:
        ours = found["realtime"].get(phase)
        if ours is None:
            continue
        separate = found["separate"].get(phase, {})
        chain = found["chain"].get(phase, {})
        beside = {
            # Of the separate graph without the way back to the console: in its favour.
            "round_trip": {"separate_force": separate.get("force"), "roscpp_chain": chain.get("round_trip")},
            "set_point": {"separate": separate.get("set_point")},
        }
        for station, peers in beside.items():
            rows.append(row_beside(f"launched_{station}_{phase}", ours[station], peers))
    return rows


def row_beside(name, times, peers):
    """A row with the peers' times and ratios; a peer without a message has none."""
    row_ = row(name, times, {})
    row_["peers"] = {peer: row("", theirs, {})["ours"] for peer, theirs in peers.items() if theirs and theirs["count"]}
    row_["ratio"] = {peer: round(theirs["p50"] / times["p50"], 2) for peer, theirs in row_["peers"].items()}
    return row_


def row(name, times, facts):
    ours = {key: times[key] for key in ("p50", "p99", "p99.9", "max")}
    return {"group": "latency", "name": name, "unit": "ns", "ours": ours, "peers": {}, "ratio": {}, **facts}
