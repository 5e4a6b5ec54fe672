"""The HTML around the sections: header, verdict tiles, style and the pointer script. Nothing is loaded from outside."""

from __future__ import annotations

import platform
from html import escape
from importlib import resources
from typing import Any

import saras
from saras.recording import Session
from saras.report.verdicts import Findings

_FACTS = (
    ("hosting", "hosting"),
    ("operator", "operator"),
    ("motion", "motion"),
    ("seed", "seed"),
    ("rate_hz", "nominal rate [Hz]"),
    ("sim", "simulated"),
    ("saras", "saras recorded with"),
    ("git", "commit"),
)


def page(session: Session, found: Findings, sections: list[tuple[str, str]]) -> str:
    """The whole document."""
    data = resources.files("saras") / "data"
    style = (data / "report.css").read_text(encoding="utf-8")
    script = (data / "report.js").read_text(encoding="utf-8")
    anchors = "".join(f'<a href="#s{index}">{escape(title)}</a>' for index, (title, _) in enumerate(sections))
    body = "".join(
        f'<section id="s{index}"><h2>{escape(title)}</h2>{html}</section>'
        for index, (title, html) in enumerate(sections)
    )
    title = f"Session {session.start:%Y-%m-%d %H:%M:%S} UTC"
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width">'
        f"<title>{escape(title)}</title><style>{style}</style></head><body><header>"
        f"<p class='brand'>SARAS session report</p><h1>{escape(title)}</h1>{_summary(found)}{_facts(session)}</header>"
        f"<nav>{anchors}</nav><main><div class='tiles'>{_tiles(found)}</div>{body}</main>"
        f"<footer>saras {saras.__version__} · Python {platform.python_version()} · {escape(session.path.name)}</footer>"
        f"<script>{script}</script></body></html>"
    )


def _summary(found: Findings) -> str:
    grades = [verdict.grade for verdict in found.verdicts]
    bad, warning, unknown = (grades.count(grade) for grade in ("bad", "warning", "unknown"))
    if bad:
        grade, text = "bad", f"{bad} of {len(grades)} checks failed"
    elif unknown:
        grade, text = "unknown", f"{unknown} of {len(grades)} checks could not be made"
    elif warning:
        grade, text = "warning", f"{warning} of {len(grades)} checks with a warning"
    else:
        grade, text = "good", f"all {len(grades)} checks passed"
    if bad and unknown:
        text += f", {unknown} unknown"
    return f'<p class="summary {grade}">{text}</p>'


def _facts(session: Session) -> str:
    info = session.info
    facts: list[tuple[str, Any]] = [("duration", f"{session.duration_s:.1f} s")]
    facts += [("messages", f"{sum(session.topics.values()):,}")]
    facts += [(label, info.get(key)) for key, label in _FACTS]
    cells = "".join(
        f"<div><dt>{escape(label)}</dt><dd>{escape(str(value)) if value is not None else _UNKNOWN}</dd></div>"
        for label, value in facts
    )
    return f"<dl>{cells}</dl>"


_UNKNOWN = '<span class="unknown">unknown</span>'


def _tiles(found: Findings) -> str:
    return "".join(
        f'<div class="tile {verdict.grade}"><h4>{escape(verdict.title)}</h4><p>{escape(verdict.value)}</p>'
        f"<small>{escape(verdict.detail)}</small></div>"
        for verdict in found.verdicts
    )
