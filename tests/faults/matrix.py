"""docs/fault_matrix.md from the results of the fault tests: python matrix.py RESULTS_DIR PAGE."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from support.catalogue import ROWS

#: rows that no test injects yet, and why
MISSING: dict[int, str] = {}
#: rows that a hosting cannot have, and why
NOT_IN = {"realtime": {44: "the real-time host serves one console"}}
#: rows whose injection is at the level where the number lives
LEVELS = {38: "law level, accelerated", 48: "every parameter in the nodes' own code"}

HEAD = """# Fault matrix

Made by `script/fault-matrix` from the results of the fault injections; don't edit it by hand. Each row of our fault
catalogue is injected into real processes: `saras_mrs.launch` with a ROS master of its own, the simulated arms' servers
over Socket.IO, and the console program behind `saras udp-proxy`. What is measured and not asserted (times, rates) is of
the machine of this run.

In every injection is checked, too: no command to an arm lies further from the one before than v_max · dt ({step} mm),
what the arm's servo follows is never faster than its own bound, no number that leaves for an arm or a hand is not
finite, and for a HOLD: an event on `/system/events`, the state that the console shows, zero twist and zero force.

**Recovery**, for every row that ends in HOLD: mend what the reason names (restart the node or the console, close the
link), look at the arm, then `rosservice call /system/SIDE/engage`. A node is restarted as the launch file starts it,
for example `rosrun saras_ros1 tank_slave __name:=tank_slave`; `tf_transformer` and `velocity_integrator` come back by
themselves, but no side engages by itself. After a death of the ROS master the graph is restarted as a whole.

{runs}

| row | fault: required | injected | seen | result | test |
|---|---|---|---|---|---|
"""


def line(cells: list[str]) -> str:
    """One row of the table."""
    return "| " + " | ".join(cell.replace("|", "\\|").replace("\n", " ") for cell in cells) + " |"


def reasons(results: list[dict]) -> dict[int, str]:
    """Why which row may be missing among these results."""
    hostings = {r["hosting"] for r in results if r["hosting"]}
    return {**MISSING, **(NOT_IN.get(hostings.pop(), {}) if len(hostings) == 1 else {})}


def page(results: list[dict], missing: dict[int, str]) -> str:
    """The whole page; rows without a result are marked."""
    by_row: dict[int, list[dict]] = {}
    for result in results:
        by_row.setdefault(result["number"], []).append(result)
    lines, passed, parts = [], 0, 0
    for number, (fault, required) in ROWS.items():
        what = f"**{fault}**: {required}"
        if number not in by_row:
            why = missing.get(number, "no result in this run")
            lines.append(line([str(number), what, "", why, "NOT RUN", ""]))
            continue
        for result in sorted(by_row[number], key=lambda r: r["part"]):
            parts += 1
            passed += result["result"] == "passed"
            shown = "passed" if result["result"] == "passed" else "**FAILED**"
            seen = result["seen"] + (f" ({LEVELS[number]})" if number in LEVELS else "")
            lines.append(line([str(number), what, result["injected"], seen, shown, f"`{result['test']}`"]))
            what = "″"
    settings = sorted({(r["hosting"], r["limits"]) for r in results if r["hosting"]})
    runs = (
        f"This run: {passed} of {parts} injections passed, {len(by_row)} of {len(ROWS)} rows; "
        + "; ".join(f"hosting {hosting}, supervisor's limits {limits}" for hosting, limits in settings)
        + ". *Wide* limits (tests/faults/support/options.py) let the supervisor latch HOLD later, for busy machines; "
        "the receivers' watchdogs are the shipped ones always."
    )
    return HEAD.format(step="3.6", runs=runs) + "\n".join(lines) + "\n"


def main(directory: Path, target: Path) -> int:
    """0 when every row has passed results only."""
    results = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(directory.glob("row_*.json"))]
    excused = reasons(results)
    target.write_text(page(results, excused), encoding="utf-8")
    bad = [r for r in results if r["result"] != "passed"]
    missing = set(ROWS) - {r["number"] for r in results}
    print(f"{target}: {len(results)} injections, {len(bad)} failed, rows without a result: {sorted(missing) or 'none'}")
    return 1 if bad or missing - set(excused) else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]), Path(sys.argv[2])))
