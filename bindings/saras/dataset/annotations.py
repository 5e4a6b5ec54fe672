"""Annotations of a session (``/recorder/annotations``, JSON a message) as columns."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras.recording import Topic

Floats = NDArray[np.float64]
END = "end"  #: label of an action that ends the one before
Column = tuple[tuple[str, str, str], NDArray[Any]]  # (name, method, text), values


@dataclass(frozen=True)
class Annotation:
    """One mark."""

    t: float  #: [s since session start], when it was made
    kind: str
    label: str
    text: str


def read_annotations(topic: Topic | None, start_ns: int, notes: list[str]) -> list[Annotation]:
    """In order of time; what is no such JSON is counted in ``notes``."""
    rows: list[Annotation] = []
    refused = 0
    for t, data in zip(topic.t_received, topic["data"]) if topic is not None else ():
        try:
            mark = json.loads(str(data))
            made = (int(mark["stamp_ns"]) - start_ns) * 1e-9 if "stamp_ns" in mark else float(t)
            rows.append(Annotation(made, *(str(mark.get(name, "")) for name in ("kind", "label", "text"))))
        except (ValueError, TypeError, AttributeError):
            refused += 1
    if refused:
        notes.append(f"/recorder/annotations: {refused} messages are no JSON objects: left out")
    return sorted(rows, key=lambda row: row.t)


def annotation_columns(topic: Topic | None, at: Floats, start_ns: int, notes: list[str]) -> list[Column]:
    """An action holds until the next one (the label ``end``, or none, ends it); all marks but actions without text are
    noted at the first row at or after them.
    """
    action = np.full(len(at), None, dtype=object)
    note = np.full(len(at), None, dtype=object)
    misunderstanding = np.zeros(len(at), dtype=bool)
    order = np.argsort(at, kind="stable")
    for mark in read_annotations(topic, start_ns, notes):
        first = int(np.searchsorted(at[order], mark.t, side="left"))
        if mark.kind == "action":
            action[order[first:]] = None if mark.label in ("", END) else mark.label
        if first == len(at) or (mark.kind == "action" and not mark.text):
            continue
        row = order[first]
        misunderstanding[row] |= mark.kind == "misunderstanding"
        said = ": ".join(part for part in (mark.label, mark.text) if part)
        note[row] = said if note[row] is None else f"{note[row]}; {said}"
    columns: list[Column] = [
        (("annotation_action", "until the next", "what is being done, as annotated"), action),
        (("annotation_note", "event", "annotations since the row before"), note),
        (
            ("annotation_misunderstanding", "event", "a misunderstanding was marked since the row before"),
            misunderstanding,
        ),
    ]
    return columns
