"""What several sections are made of: tables, charts with shaded states, two columns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from html import escape
from typing import Any

import numpy as np

from saras.recording import Session, Topic
from saras.report.svg import Chart
from saras.report.verdicts import SIDES, Findings

COLORS = ("master", "measured", "command", "extra", "truth", "more")  #: CSS variables of report.css


def table(head: Sequence[str], rows: Sequence[Sequence[Any]], align_right_from: int = 1) -> str:
    """An HTML table; None becomes "unknown"; strings that start with "<" are HTML."""

    def cell(index: int, value: Any) -> str:
        css = ' class="r"' if index >= align_right_from else ""
        if value is None:
            return f'<td{css}><span class="unknown">unknown</span></td>'
        text = str(value)
        return f"<td{css}>{text if text.startswith('<') else escape(text)}</td>"

    header = "".join(
        f"<th{' class=r' if index >= align_right_from else ''}>{escape(title)}</th>" for index, title in enumerate(head)
    )
    body = "".join("<tr>" + "".join(cell(i, value) for i, value in enumerate(row)) + "</tr>" for row in rows)
    return f"<div class='scroll'><table><thead><tr>{header}</tr></thead><tbody>{body}</tbody></table></div>"


def chart(session: Session, found: Findings, side: str | None, y_label: str, **options: Any) -> Chart:
    """A chart over the whole session, with HOLD and clutch of one side (or the HOLDs of both) shaded."""
    result = Chart(y_label, x_range=(0.0, session.duration_s), **options)
    for each in SIDES if side is None else (side,):
        result.bands += [(start, end, "hold") for start, end, state in found.states[each] if state == 3]
        if side is not None:
            result.bands += [(start, end, "clutch") for start, end in clutch_bands(session.console(each).state)]
    return result


def both_sides(one: Callable[[str], list[str]]) -> str:
    """Two columns, left and right."""
    columns = "".join(f'<div class="side"><h3>{side}</h3>{"".join(one(side))}</div>' for side in SIDES)
    return f'<div class="sides">{columns}</div>'


def clutch_bands(state: Topic | None) -> list[tuple[float, float]]:
    """(start, end) of each time the clutch was pressed [s]."""
    if state is None:
        return []
    edges = np.diff(state["clutch"].astype(int), prepend=0, append=0)
    ends = np.append(state.t, state.t[-1])
    pressed, released = np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)
    return [(float(state.t[a]), float(ends[b])) for a, b in zip(pressed, released)]
