"""script/bench: ours in C++ beside peers, as a table and as JSON.

Before any time is believed, the peers must compute the same: numpy_laws within 1e-9 of ours over the whole scenario,
the C++ scenario equal to the Python one, struct_codec's bytes equal to ours.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))
import calibration
import capture
import csa
import exploration
import latency
import live_map
import model
import overlay
import peers
import pipeline
import recording
import registration
import scenario
import stereo_contact
import struct_codec

from saras import net

PYTHON_PEERS = {"teleop": ("numpy", peers.teleop), "codec": ("struct", peers.codec)}
GROUPS = [
    *PYTHON_PEERS,
    "collision",
    "calibration",
    "latency",
    "overlay",
    "stereo_contact",
    "recording",
    "capture",
    "model",
    "csa",
]
BENCH_PYTHON = Path(__file__).parents[1] / "bench-venv" / "bin" / "python"
TOLERANCE = 1e-9
COLLISION_PAIRS = 100_000
COAL_TOLERANCE = 1e-6


class NotTheSame(RuntimeError):
    """A peer computes something else: its time would say nothing."""


def check_teleop(cpp_numbers):
    difference = pipeline.worst_difference()
    if not difference <= TOLERANCE:
        raise NotTheSame(f"numpy_laws differs from saras.teleop by {difference:.1e}")
    ours = pipeline.Ours()
    for row in scenario.inputs():
        _, set_points, levels = ours.step(*row)
    expected = np.concatenate([levels, set_points[:, :3, 3].ravel()])
    worst = float(np.abs(expected - np.array(cpp_numbers)).max())
    if not worst <= TOLERANCE:
        raise NotTheSame(f"the C++ scenario differs from the Python one by {worst:.1e}")
    return max(difference, worst)


def check_codec():
    for packet, encode, cls in (
        (struct_codec.example_up(), struct_codec.encode_up, net.TouchballUp),
        (struct_codec.example_down(), struct_codec.encode_down, net.TouchballDown),
    ):
        data = encode(packet)
        if cls.decode(data).encode() != data:
            raise NotTheSame(f"struct_codec's {cls.__name__} has other bytes than ours")
    return 0.0


def run_collision(program):
    """Rows of the group collision: C++ peers, timed in a program of their own."""
    program = program.with_name("saras_collision_benchmark")
    if not program.exists():
        print("collision: left out, needs FCL 0.7: apt-get install libfcl-dev", file=sys.stderr)
        return []
    text = subprocess.run([str(program), str(COLLISION_PAIRS)], check=True, capture_output=True, text=True).stdout
    answer = json.loads(text)
    check = answer["check"]
    # Coal's iteration for boxes stops at 1e-6. FCL with libccd is off by centimetres on some pairs: timed as it comes.
    worst = max(check["coal_capsules_m"], check["coal_boxes_m"], check["coal_scenes_m"])
    if check["collisions_disagreed"] or not worst <= COAL_TOLERANCE:
        raise NotTheSame(f"collision: {check}")
    fcl = max(check["fcl_capsules_m"], check["fcl_boxes_m"])
    print(
        f"collision: coal computes the same (worst difference {worst:.0e} m, {check['pairs']} pairs, no collision "
        f"disagreed; fcl differs by up to {fcl:.0e} m)",
        file=sys.stderr,
    )
    rows = []
    for row in answer["rows"]:
        ratio = {peer: round(times["p50"] / row["p50"], 2) for peer, times in row["peers"].items()}
        ours = {"p50": row["p50"], "p99": row["p99"]}
        rows.append(
            {
                "group": "collision",
                "name": row["name"],
                "unit": "ns",
                "ours": ours,
                "peers": row["peers"],
                "ratio": ratio,
            }
        )
    return rows


def run(groups, program, soak_s=0.0, heavy=False):
    """Rows of the given groups in the format of the JSON file."""
    python_groups = [group for group in groups if group in PYTHON_PEERS]
    rows = run_python_peers(python_groups, program) if python_groups else []
    rows += run_collision(program) if "collision" in groups else []
    rows += calibration.run(BENCH_PYTHON) if "calibration" in groups else []
    if "csa" in groups:
        rows += csa.run(program.with_name("saras_csa_benchmark"), BENCH_PYTHON)
    if "latency" in groups:
        rows += latency.run(program.with_name("saras_latency_benchmark"), soak_s)
    rows += overlay.run() if "overlay" in groups else []
    rows += stereo_contact.run() if "stereo_contact" in groups else []
    rows += recording.run() if "recording" in groups else []
    rows += capture.run() if "capture" in groups else []
    if "model" in groups:
        rows += model.run(BENCH_PYTHON if heavy else None) + live_map.run(heavy)
        rows += registration.run(BENCH_PYTHON) + exploration.run()
    return rows


def run_python_peers(groups, program):
    """Rows whose peers are Python."""
    answer = json.loads(subprocess.run([str(program), *groups], check=True, capture_output=True, text=True).stdout)
    rows = []
    for group in groups:
        peer, measure = PYTHON_PEERS[group]
        difference = check_teleop(answer["check"]) if group == "teleop" else check_codec()
        print(f"{group}: {peer} computes the same (worst difference {difference:.0e})", file=sys.stderr)
        times = measure()
        for row in (row for row in answer["rows"] if row["group"] == group):
            ours = {"p50": row["p50"], "p99": row["p99"]}
            theirs = times[row["name"]]
            ratio = {peer: round(theirs["p50"] / ours["p50"], 2)}
            rows.append(
                {
                    "group": group,
                    "name": row["name"],
                    "unit": "ns",
                    "ours": ours,
                    "peers": {peer: theirs},
                    "ratio": ratio,
                }
            )
    return rows


def show(rows):
    from rich.console import Console
    from rich.table import Table

    table = Table(
        "group",
        "name",
        "unit",
        title="p50 / p99 of single calls (calibration: of errors; their mean : ours)",
        title_justify="left",
    )
    for heading in ("ours", "peer", "their p50 : ours"):
        table.add_column(heading, justify="right")
    for row in rows:
        digits = {"calibration": 3, "stereo_contact": 1, "recording": 1, "model": 1}.get(row["group"], 0)
        ours = " / ".join(f"{row['ours'][p]:,.{digits}f}" for p in ("p50", "p99"))
        if not row["peers"]:
            table.add_row(row["group"], row["name"], row["unit"], ours, "", "")
        for peer, times in row["peers"].items():
            theirs = f"{peer} {times['p50']:,.{digits}f} / {times['p99']:,.{digits}f}"
            table.add_row(row["group"], row["name"], row["unit"], ours, theirs, f"{row['ratio'][peer]:.1f}")
    Console(width=None if sys.stdout.isatty() else 120).print(table)


def main():
    parser = argparse.ArgumentParser(
        prog="script/bench", description=__doc__, formatter_class=argparse.RawTextHelpFormatter
    )
    parser.add_argument("groups", nargs="*", metavar="GROUP", help=f"of {', '.join(GROUPS)}; default: all")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows there too")
    parser.add_argument("--soak", type=float, default=0.0, metavar="S", help="of the group latency: also S seconds")
    parser.add_argument(
        "--heavy", action="store_true", help="of the group model: also GPyTorch, and ten minutes of the live map"
    )
    parser.add_argument("--program", type=Path, required=True, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    unknown = set(arguments.groups) - set(GROUPS)
    if unknown:
        parser.error(f"unknown group {', '.join(sorted(unknown))}; there are {', '.join(GROUPS)}")
    try:
        rows = run(arguments.groups or list(GROUPS), arguments.program, arguments.soak, arguments.heavy)
    except (
        NotTheSame,
        calibration.NoResult,
        overlay.NotTheSame,
        recording.NotTheSame,
        model.NotTheSame,
        capture.NoResult,
        csa.NotTheSame,
    ) as error:
        print(f"script/bench: {error}", file=sys.stderr)
        return 1
    show(rows)
    if arguments.json:
        arguments.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
