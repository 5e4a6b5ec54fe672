"""The body of the report, one function a section; each returns HTML."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import Any

from saras.recording import Session
from saras.recording.session import CHANNEL_STATES
from saras.report.distances import distances
from saras.report.fixtures import fixtures
from saras.report.fixtures import recorded as had_fixtures
from saras.report.motion import forces, remote_centre, trajectories
from saras.report.overlay import overlay
from saras.report.parts import COLORS, both_sides, chart, clutch_bands, table
from saras.report.passivity import damping, ledger, tanks
from saras.report.svg import box, text_at
from saras.report.verdicts import SIDES, Findings
from saras.report.vision import vision

STATE_CSS = {0: "waiting", 1: "ready", 2: "engaged", 3: "hold"}


def sections(session: Session, found: Findings) -> list[tuple[str, str]]:
    """(title, HTML) of all sections."""
    parts: list[tuple[str, Callable[[Session, Findings], str]]] = [
        ("Timeline", timeline),
        ("Trajectories", trajectories),
        ("Forces", forces),
        ("Distances", distances),
        *([("Fixtures", fixtures)] if had_fixtures(session) else []),
        ("Overlay", overlay),
        ("Endoscope and contact seen", vision),
        ("Tank energy", tanks),
        ("Energy ledger", ledger),
        ("Damping and reduction", damping),
        ("Latency of each hop", latency),
        ("Rates", rates),
        ("Remote centre", remote_centre),
        ("Events", events),
        ("Recorded topics", topics),
    ]
    return [(title, part(session, found)) for title, part in parts]


def timeline(session: Session, found: Findings) -> str:
    """State of both sides over time, clutch, and marks for warnings and errors."""
    width, left, row = 1150, 60, 26
    scale = (width - left - 24) / max(session.duration_s, 1e-9)
    parts = [f'<svg class="lanes" viewBox="0 0 {width} {3 * row + 26}">']
    for lane, side in enumerate(SIDES):
        y = lane * row + 4
        parts.append(text_at("", left - 8, y + 14, side, "end"))
        if not found.states[side]:
            parts.append(text_at("unknown", left, y + 14, "unknown: state not recorded"))
        for start, end, state in found.states[side]:
            # The first state is older than the recording: it was latched.
            start = max(start, 0.0)
            name = CHANNEL_STATES.get(state, "?")
            title = f"{name} {start:.2f} – {end:.2f} s"
            css = STATE_CSS.get(state, "waiting")
            parts.append(box(css, left + start * scale, y, max((end - start) * scale, 1.5), 18, title))
        for start, end in clutch_bands(session.console(side).state):
            title = f"clutch {start:.2f} – {end:.2f} s"
            parts.append(box("clutch", left + start * scale, y + 12, max((end - start) * scale, 1.5), 6, title))
    y = 2 * row + 13
    parts.append(text_at("", left - 8, y + 4, "events", "end"))
    for event in [e for e in found.events if e.severity != "info"][:500]:
        parts.append(
            f'<circle class="{event.severity}" cx="{left + max(event.t, 0.0) * scale:.1f}" cy="{y}" r="4">'
            f"<title>{event.t:.2f} s {escape(event.source)}: {escape(event.text)}</title></circle>"
        )
    for index in range(11):
        t = session.duration_s * index / 10
        parts.append(text_at("tick", left + t * scale, 3 * row + 20, f"{t:.3g} s", "middle"))
    keys = "".join(
        f'<span><i class="{css}"></i>{name}</span>'
        for css, name in [*((STATE_CSS[k], v) for k, v in CHANNEL_STATES.items()), ("clutch", "clutch pressed")]
    )
    return f'{"".join(parts)}</svg><p class="keys">{keys}</p>'


def latency(session: Session, found: Findings) -> str:
    """Percentiles of every hop, and their course over time."""
    rows: list[list[Any]] = []
    for side in SIDES:
        for name, result in found.latencies[side]:
            if result is None:
                rows.append([f"{side}: {name}", None, None, None, None])
            else:
                values = [f"{result.p50_ms:.2f}", f"{result.p95_ms:.2f}", f"{result.p99_ms:.2f}", result.method]
                rows.append([f"{side}: {name}", *values])

    def one(side: str) -> list[str]:
        panel = chart(session, found, side, "latency [ms]", y_include=(0.0,))
        for (name, result), color in zip(found.latencies[side], COLORS):
            if result is not None:
                panel.line(result.t, result.latency_ms, name, color, width=1.0)
        return [panel.render()]

    note = (
        "<p class='note'>On the recorder's clock. “same stamp”: the output carries its input's stamp; "
        "“latest input”: from the newest input before the output.</p>"
    )
    return table(["hop", "p50 [ms]", "p95 [ms]", "p99 [ms]", "how"], rows) + note + both_sides(one)


def rates(session: Session, found: Findings) -> str:
    """Rate, period percentiles and losses of every node's topic, from the engagement of both sides on."""
    rows: list[list[Any]] = []
    for node, name, rate in found.rates:
        if rate is None:
            rows.append([node, name, *([None] * 9)])
            continue
        numbers = (rate.mean_hz, rate.median_hz, rate.period_p5_ms, rate.period_p99_ms, rate.longest_gap_ms)
        age = None if rate.age_p99_ms is None else f"{rate.age_p99_ms:.1f}"
        rows.append([node, name, rate.count, *(f"{value:.1f}" for value in numbers), age, rate.lost, rate.restarts])
    head = [
        "node",
        "topic",
        "messages",
        "mean [Hz]",
        "median [Hz]",
        "p5 period [ms]",
        "p99 period [ms]",
        "longest gap [ms]",
    ]
    head += ["p99 age [ms]", "lost", "restarts"]
    return table(head, rows, align_right_from=2)


def events(session: Session, found: Findings) -> str:
    """All events in a table."""
    rows = [[f"{e.t:.3f}", f'<b class="{e.severity}">{e.severity}</b>', e.source, e.text] for e in found.events[:400]]
    more = f'<p class="note">{len(found.events) - 400} more not shown</p>' if len(found.events) > 400 else ""
    return table(["time [s]", "", "source", "what"], list(rows), align_right_from=9) + more


def topics(session: Session, found: Findings) -> str:
    """What the bag holds."""
    counts = session.topics
    rows = [[name, count, f"{count / max(session.duration_s, 1e-9):.1f}"] for name, count in sorted(counts.items())]
    body = table(["topic", "messages", "mean [1/s]"], rows)
    return f"<details><summary>{len(counts)} topics</summary>{body}</details>"
