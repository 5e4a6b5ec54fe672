"""Section about virtual fixtures: how near each side's tip was to each, how far beyond, how long a force was due."""

from __future__ import annotations

import numpy as np

from saras.recording import Session, Topic
from saras.report.parts import table
from saras.report.verdicts import SIDES, Findings

NOTE = (
    "<p class='note'>Of the measured tip, which lags behind the set-point that hard ones hold; negative: beyond the "
    "border. Shares are of all messages.</p>"
)


def recorded(session: Session) -> bool:
    """Whether the session had virtual fixtures."""
    return any(session.topic(f"/fixtures/{side}") is not None for side in SIDES)


def fixtures(session: Session, _: Findings) -> str:
    """One row a side and fixture."""
    rows: list[list[str | None]] = []
    for side in SIDES:
        topic = session.topic(f"/fixtures/{side}")
        if topic is not None:
            rows += _rows(side, topic)
    return NOTE + table(["side", "fixture", "least [mm]", "at [s]", "force due", "unknown"], rows, align_right_from=2)


def _rows(side: str, topic: Topic) -> list[list[str | None]]:
    names = [str(name) for name in topic["names"][0]]
    distances = np.full((len(topic), len(names)), np.nan)
    for row, told in zip(distances, topic["distance"]):
        if len(told) == len(names):  # a node that was started anew with another file tells others
            row[:] = told
    status = np.array([str(each) for each in topic["status"]])
    due, unknown = f"{np.mean(status == 'LIMITED'):.0%}", f"{np.mean(~np.isfinite(distances).all(axis=1)):.0%}"
    rows: list[list[str | None]] = []
    for name, column in zip(names, distances.T):
        if not np.isfinite(column).any():
            rows.append([side, name, None, None, due, unknown])
            continue
        i = int(np.nanargmin(column))
        rows.append([side, name, f"{round(1e3 * column[i], 3) + 0.0:.3f}", f"{topic.t[i]:.1f}", due, unknown])
    return rows
