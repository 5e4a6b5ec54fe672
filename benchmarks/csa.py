"""script/bench csa: quadratic programmes at 7 joints, the slave controller's tick, closest points on 10^6 triangles.

Ours in C++; the peers on the same programmes, by their own clocks (csa_peers.py). Before any time is believed, our
answers must be quadprog's within 1e-6.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path

#: Programmes of each size.
DRAWS = 1000
TOLERANCE = 1e-6
#: Of the closest points of the published system, at 989,376 triangles.
PUBLISHED_HZ = 180.0


class NotTheSame(RuntimeError):
    """Ours is not the peers' answer: its time would say nothing."""


def run(program: Path, python: Path) -> list[dict]:
    """Rows of the group."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "programmes"
        ours = json.loads(
            subprocess.run([str(program), str(DRAWS), str(path)], check=True, capture_output=True, text=True).stdout
        )
        peers = Path(__file__).with_name("csa_peers.py")
        text = subprocess.run([str(python), str(peers), str(path)], check=True, capture_output=True, text=True).stdout
    theirs = json.loads(text.splitlines()[-1])
    if ours["failed"]:
        raise NotTheSame(f"csa: {ours['failed']} programmes were not solved")
    rows = []
    for row in ours["rows"]:
        name = row["name"]
        if name in theirs["times"]:
            worst, missed = theirs["worst"][name], theirs["missed"][name]
            if not worst["ours"] <= TOLERANCE:
                raise NotTheSame(f"csa: {name}: ours differs from quadprog by {worst['ours']:.1e}")
            print(
                f"csa: {name}: ours is quadprog's answer within {worst['ours']:.0e}; further off than {TOLERANCE:.0e}: "
                + ", ".join(f"{peer} {count} of {DRAWS}" for peer, count in missed.items() if peer != "quadprog"),
                file=sys.stderr,
            )
        times = theirs["times"].get(name, {})
        if name.startswith("mesh"):
            times = {"published": {"p50": 1e9 / PUBLISHED_HZ, "p99": 1e9 / PUBLISHED_HZ}}
        ratio = {peer: round(their["p50"] / row["p50"], 2) for peer, their in times.items()}
        measured = {"p50": row["p50"], "p99": row["p99"]}
        rows.append({"group": "csa", "name": name, "unit": "ns", "ours": measured, "peers": times, "ratio": ratio})
    print(
        f"csa: {ours['triangles']} triangles, largest penetration {1e6 * ours['penetration_m']:.2f} um", file=sys.stderr
    )
    return rows
