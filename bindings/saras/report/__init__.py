"""One recorded session as a self-contained HTML page: verdicts, charts, ledger, rates, events.

>>> findings = write_report("session.bag", "report.html")      # doctest: +SKIP
>>> [v.title for v in findings.verdicts if v.grade == "bad"]    # doctest: +SKIP
[]
"""

from __future__ import annotations

from pathlib import Path

from saras.recording import Session
from saras.report import awareness
from saras.report.page import page
from saras.report.sections import sections
from saras.report.verdicts import Findings, Verdict, examine

__all__ = ["Findings", "Verdict", "examine", "write_report"]


def write_report(bag: str | Path, out: str | Path) -> Findings:
    """Reads a bag and writes its report. Raises saras.Error when the bag cannot be read."""
    with Session.open(bag) as session:
        if awareness.is_awareness(session):
            found = awareness.examine(session)
            html = page(session, found, awareness.sections(session, found))
        else:
            found = examine(session)
            html = page(session, found, sections(session, found))
    path = Path(out)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(html, encoding="utf-8")
    return found
