"""Annotations of a session (``/recorder/annotations``, JSON a message) as columns."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras.recording import Topic

Floats = NDArray[np.float64]
Column = tuple[tuple[str, str, str], NDArray[Any]]  # (name, method, text), values


def read_annotations(topic: Topic | None, notes: list[str]) -> list[tuple[float, str, str]]:
    """(t [s], kind, label) in order of time; what is no such JSON is counted in ``notes``."""
    rows: list[tuple[float, str, str]] = []
    refused = 0
    for t, data in zip(topic.t_received, topic["data"]) if topic is not None else ():
        try:
            content = json.loads(str(data))
            rows.append((float(t), str(content.get("kind", "note")), str(content.get("label", ""))))
        except (json.JSONDecodeError, AttributeError):
            refused += 1
    if refused:
        notes.append(f"/recorder/annotations: {refused} messages are no JSON objects: left out")
    return sorted(rows, key=lambda row: row[0])


def annotation_columns(topic: Topic | None, at: Floats, notes: list[str]) -> list[Column]:
    """An action holds until the next one (an empty label ends it); other kinds mark the first row at or after them."""
    rows = read_annotations(topic, notes)
    action = np.full(len(at), None, dtype=object)
    note = np.full(len(at), None, dtype=object)
    misunderstanding = np.zeros(len(at), dtype=bool)
    order = np.argsort(at, kind="stable")
    for t, kind, label in rows:
        first = int(np.searchsorted(at[order], t, side="left"))
        if kind == "action":
            action[order[first:]] = label or None
        elif first < len(at):
            row = order[first]
            misunderstanding[row] |= kind == "misunderstanding"
            text = label if kind in ("note", "misunderstanding") else f"{kind}: {label}"
            note[row] = text if note[row] is None else f"{note[row]}; {text}"
    columns: list[Column] = [
        (("annotation_action", "until the next", "what is being done, as annotated"), action),
        (("annotation_note", "event", "annotations since the row before"), note),
        (
            ("annotation_misunderstanding", "event", "a misunderstanding was marked since the row before"),
            misunderstanding,
        ),
    ]
    return columns
