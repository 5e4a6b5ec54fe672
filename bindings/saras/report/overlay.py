"""The overlay as the surgeons saw it: a strip of stills, one for each state."""

from __future__ import annotations

import base64
from html import escape

from saras.recording import Session
from saras.report.verdicts import Findings

TOPIC = "/endoscope/{}/overlay_still"
MOST = 8


def overlay(session: Session, _found: Findings) -> str:
    """Both eyes, in order of time; what was not recorded is said."""
    rows = []
    for side in ("left", "right"):
        stills = session.topic(TOPIC.format(side))
        if stills is None:
            continue
        figures = []
        for t, form, data in list(zip(stills.t, stills["format"], stills["data"]))[:MOST]:
            name = str(form).partition(";")[2].strip() or "?"
            source = "data:image/jpeg;base64," + base64.b64encode(bytes(bytearray(data))).decode()
            caption = f"{escape(name)}, {t:.1f} s"
            figures.append(f'<figure><img src="{source}" alt="{caption}"><figcaption>{caption}</figcaption></figure>')
        rows.append(f'<h4>{side} eye</h4><div class="strip">{"".join(figures)}</div>')
    return "".join(rows) or "<p class='note'>No stills of the overlay were recorded.</p>"
