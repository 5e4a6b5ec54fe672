"""Section about the distances between tools and to forbidden regions, and its tile."""

from __future__ import annotations

import numpy as np

from saras.recording import Session
from saras.recording.collision import CLEAR, COLLISION, UNKNOWN, WARNING, ToolDistances
from saras.report.parts import COLORS, chart, table
from saras.report.verdicts import Findings

SHOWN_MM = 60.0  #: farther is not interesting
LEVELS_MM = ((15.0, "slow-down 15 mm"), (10.0, "warning 10 mm"), (2.0, "collision 2 mm"))
NAMES = {UNKNOWN: "unknown", CLEAR: "clear", WARNING: "warning", COLLISION: "collision"}


def distances(session: Session, found: Findings) -> str:
    """Each tool's distance over time with the default thresholds; least distance and time in each state."""
    tools = session.distances
    panel = chart(session, found, None, "distance [mm]", height=220, width=1150, y_include=(0.0,))
    for tool, color in zip(tools, COLORS):
        millimetres = 1e3 * tool.distance_m
        panel.line(tool.t, np.where(millimetres <= SHOWN_MM, millimetres, np.nan), tool.name, color)
    for level, label in LEVELS_MM:
        panel.level(level, label)
    note = (
        f"<p class='note'>To what was known at the time, up to {SHOWN_MM:.0f} mm; a gap is farther, or unknown. "
        "Thresholds as shipped in config/collision.yaml.</p>"
    )
    head = [
        "tool",
        "nearest to",
        "least [mm]",
        "at [s]",
        *(f"{NAMES[state]} [s]" for state in NAMES),
        "unknown because",
    ]
    return panel.render() + note + table(head, [_row(tool) for tool in tools], align_right_from=2)


def _row(tool: ToolDistances) -> list[str | None]:
    seconds = [f"{tool.seconds_in(state):.1f}" for state in NAMES]
    reasons = list(dict.fromkeys(reason for state, reason in zip(tool.state, tool.reason) if state == UNKNOWN))
    why = reasons[0][:120] + (f" (and {len(reasons) - 1} more)" if len(reasons) > 1 else "") if reasons else ""
    if not np.isfinite(tool.distance_m).any():
        return [tool.name, None, None, None, *seconds, why]
    i = int(np.nanargmin(tool.distance_m))
    return [tool.name, tool.partner[i], f"{1e3 * tool.distance_m[i]:.2f}", f"{tool.t[i]:.1f}", *seconds, why]
