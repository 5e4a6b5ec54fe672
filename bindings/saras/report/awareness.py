"""The report of a session of complementary situational awareness: force, contact states, region, holds."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError
from saras.recording import Session, Topic
from saras.recording.series import pose_series, wrench_series
from saras.report import timing
from saras.report.parts import table
from saras.report.sections import events, topics
from saras.report.svg import Chart, box, text_at
from saras.report.verdicts import Findings, Verdict

Floats = NDArray[np.float64]

BORDER_TOPIC = "/csa/master/border"
STATE_TOPIC = "/csa/teleop/state"
STATES = ("NO_CONTACT", "PROXY_CONTACT", "SLAVE_CONTACT", "FULL_CONTACT")
CSS = ("waiting", "ready", "clutch", "engaged")
FULL, HOLD = 3, 4
SETTLE_S = 1.0  #: of full contact, and of a new region, that is left out before they are judged
FORCE_SHARE = 0.05  #: RMS error of the mean desired force that is good; twice that is a warning
REGION_M = 0.0002  #: what the measured tip may be outside the region: the arm lags its set-point
RATES = (
    "/csa/master/measured_cp",
    STATE_TOPIC,
    "/csa/slave/admittance",
    "/csa/proxy/measured_cp",
    "/csa/slave/measured_cf",
)


def is_awareness(session: Session) -> bool:
    """Whether this is such a session."""
    return STATE_TOPIC in session.topics


def examine(session: Session) -> Findings:
    """The verdicts; all else that Findings holds belongs to other sessions."""
    found = Findings(session.start.timestamp(), session.events, None, [], {}, {}, {}, {})
    told, did = session.topic(STATE_TOPIC), session.topic("/csa/slave/admittance")
    found.verdicts.extend(
        [_states(told), _force(told, did), _region(session, did), _hand(session), _speed(did), _holds(told, did)]
    )
    return found


def sections(session: Session, found: Findings) -> list[tuple[str, str]]:
    """(title, HTML) of all sections."""
    return [
        ("Timeline", timeline(session, found)),
        ("Force", force(session)),
        ("Where the tip went", across(session)),
        ("Hand, proxy and slave", mismatch(session)),
        ("Holds", holds(session)),
        ("Rates", rates(session)),
        ("Events", events(session, found)),
        ("Recorded topics", topics(session, found)),
    ]


# ---- what is found


def bands(told: Topic | None) -> list[tuple[float, float, int, str]]:
    """(start, end, contact state or HOLD, reason) of each stretch [s]; not those before anybody was enabled."""
    if told is None or not len(told):
        return []
    state = np.where(told["hold"].astype(bool), HOLD, told["state"].astype(int))
    state = np.where(told["enabled"].astype(bool), state, -1)
    starts = np.flatnonzero(np.diff(state, prepend=-2) != 0)
    ends = np.append(told.t[starts[1:]], told.t[-1])
    rows = [(float(told.t[i]), float(end), int(state[i]), str(told["reason"][i])) for i, end in zip(starts, ends)]
    return [row for row in rows if row[2] >= 0]


def settled(told: Topic, t: Floats) -> NDArray[np.bool_]:
    """Whether there has been full contact for SETTLE_S at times t."""
    at = np.zeros(len(t), dtype=bool)
    for start, end, state, _ in bands(told):
        if state == FULL:
            at |= (t > start + SETTLE_S) & (t < end)
    return at


def region(session: Session) -> tuple[float, Floats] | None:
    """When the last region of interest was closed [s], and its corners (n, 3) [m]; None: none was."""
    topic = session.topic("/csa/modeler/roi")
    if topic is None or "polygon.points" not in topic.columns:
        return None
    for i in range(len(topic) - 1, -1, -1):
        points = topic["polygon.points"][i]
        if points is not None and len(points) >= 3:
            return float(topic.t[i]), np.array([[p.x, p.y, p.z] for p in points], dtype=float)
    return None


def outside(session: Session) -> tuple[Floats, Floats] | None:
    """(t, how far the measured tip is outside the picked region [m]; inside < 0) from SETTLE_S after its closing."""
    from saras.csa.hulls import region_of_interest

    picked, tip = region(session), pose_series(session.topic("/csa/slave/measured_cp"))
    if picked is None or tip is None:
        return None
    since, corners = picked
    try:
        faces = region_of_interest(corners, [0.0, 0.0, 1.0])
    except ConfigError:
        return None
    late = tip.t > since + SETTLE_S  # it may be closed with the tip just outside
    return tip.t[late], (tip.position[late] @ faces[:, :3].T - faces[:, 3]).max(axis=1)


def _states(told: Topic | None) -> Verdict:
    found = bands(told)
    if not found:
        return Verdict("Contact", "unknown", "nobody was enabled, or it was not recorded", "unknown")
    seconds = sum(end - start for start, end, state, _ in found if state == FULL)
    kinds = {STATES[state] for _, _, state, _ in found if state < HOLD}
    detail = f"of full contact; {len(found) - 1} changes among {', '.join(s for s in STATES if s in kinds)}"
    return Verdict("Contact", f"{seconds:.1f} s", detail, "good" if seconds > 0.0 else "warning")


def _force(told: Topic | None, did: Topic | None) -> Verdict:
    title = "Force error"
    if told is None or did is None:
        return Verdict(title, "unknown", "the slave's controller was not recorded", "unknown")
    at = settled(told, did.t) & np.isfinite(did["desired_force_N"]) & ~did["hold"].astype(bool)
    if at.sum() < 100:
        return Verdict(title, "unknown", "force was controlled for too short a time", "unknown")
    error = np.where(at, did["normal_force_N"] - did["desired_force_N"], np.nan)
    slow = _without_palpation(told, did.t, error)
    mean = float(np.mean(did["desired_force_N"][at]))
    rms, with_palpation = (float(np.sqrt(np.nanmean(e**2))) for e in (slow, error))
    share = rms / mean
    grade = "good" if share < FORCE_SHARE else "warning" if share < 2.0 * FORCE_SHARE else "bad"
    detail = f"RMS of the mean over a palpation, {100 * share:.1f} % of {mean:.2f} N; palpation included "
    detail += f"{with_palpation:.3f} N, {100 * with_palpation / mean:.1f} %; {at.sum()} ticks"
    return Verdict(title, f"{rms:.3f} N", detail, grade)


def _without_palpation(told: Topic, t: Floats, error: Floats) -> Floats:
    """The error's mean over one period of the last palpation; NaN where it is not known all that time."""
    kinds, frequency = told["primitive.kind"].astype(str), told["primitive.frequency_hz"].astype(float)
    period_s = 1.0 / frequency[-1] if kinds[-1] == "force" and frequency[-1] > 0.0 else 0.0
    count = round(period_s / max(float(np.median(np.diff(t))), 1e-6))
    if count < 2 or count >= len(error):
        return error
    return np.asarray(np.lib.stride_tricks.sliding_window_view(error, count).mean(axis=1))


def _region(session: Session, did: Topic | None) -> Verdict:
    title = "Out of the region"
    found = outside(session)
    if found is None or not len(found[0]):
        return Verdict(title, "none picked", "no region of interest was closed", "good")
    worst = max(0.0, float(found[1].max()))
    detail = "measured tip, since the region was closed"
    if did is not None:
        distance = did["fixture_distance_m"][(did.t > found[0][0]) & np.isfinite(did["fixture_distance_m"])]
        if len(distance):
            detail += f"; set-point {1e6 * max(0.0, -float(distance.min())):.0f} um"
    return Verdict(title, f"{1e3 * worst:.2f} mm", detail, "good" if worst < REGION_M else "bad")


def _hand(session: Session) -> Verdict:
    wrench = wrench_series(session.topic("/csa/master/servo_cf"))
    if wrench is None:
        return Verdict("Force on the hand", "unknown", "/csa/master/servo_cf was not recorded", "unknown")
    force = np.linalg.norm(wrench.value[:, :3], axis=1)
    step, dt = np.linalg.norm(np.diff(wrench.value[:, :3], axis=0), axis=1), np.diff(wrench.t)
    rate = float((step[dt > 0.0] / dt[dt > 0.0]).max()) if (dt > 0.0).any() else 0.0
    detail = f"at most; it changes by up to {rate:.0f} N/s"
    border = wrench_series(session.topic(BORDER_TOPIC))
    if border is not None and len(border.t):
        detail += f"; fixtures asked for up to {np.linalg.norm(border.value[:, :3], axis=1).max():.2f} N"
    return Verdict("Force on the hand", f"{force.max():.2f} N", detail, "good" if force.max() > 0.0 else "warning")


def _speed(did: Topic | None) -> Verdict:
    if did is None:
        return Verdict("Joint speeds", "unknown", "the slave's controller was not recorded", "unknown")
    share = float(did["joint_speed_share"].max())
    return Verdict(
        "Joint speeds", f"{100 * share:.0f} %", "of their limits, at most", "good" if share <= 1.0 + 1e-9 else "bad"
    )


def _holds(told: Topic | None, did: Topic | None) -> Verdict:
    if told is None:
        return Verdict("Holds", "unknown", "not recorded", "unknown")
    found = [(end - start, reason) for start, end, state, reason in bands(told) if state == HOLD]
    own = 0 if did is None else int((np.diff(did["hold"].astype(int)) == 1).sum())
    detail = f"{sum(s for s, _ in found):.1f} s in all; the slave by itself {own} times"
    return Verdict("Holds", str(len(found)), detail, "good" if not found else "warning")


# ---- what is drawn


def _chart(session: Session, y_label: str, **options: Any) -> Chart:
    made = Chart(y_label, x_range=(0.0, session.duration_s), **{"width": 1150, **options})
    made.bands = [(a, b, "hold") for a, b, state, _ in bands(session.topic(STATE_TOPIC)) if state == HOLD]
    return made


def timeline(session: Session, found: Findings) -> str:
    """Contact states and holds over time."""
    width, left = 1150, 60
    scale = (width - left - 24) / max(session.duration_s, 1e-9)
    parts = [f'<svg class="lanes" viewBox="0 0 {width} 52">', text_at("", left - 8, 18, "state", "end")]
    for start, end, state, reason in bands(session.topic(STATE_TOPIC)):
        name = f"HOLD {reason}" if state == HOLD else STATES[state]
        css = "hold" if state == HOLD else CSS[state]
        at, wide = left + max(start, 0.0) * scale, max((end - max(start, 0.0)) * scale, 1.5)
        parts.append(box(css, at, 4, wide, 18, f"{name} {start:.2f} – {end:.2f} s"))
    for index in range(11):
        t = session.duration_s * index / 10
        parts.append(text_at("tick", left + t * scale, 42, f"{t:.3g} s", "middle"))
    keys = "".join(f'<span><i class="{css}"></i>{name}</span>' for css, name in zip((*CSS, "hold"), (*STATES, "HOLD")))
    return f'{"".join(parts)}</svg><p class="keys">{keys}</p>'


def force(session: Session) -> str:
    """On the tissue, wanted, on the hand; what K_g was."""
    did, hand = session.topic("/csa/slave/admittance"), wrench_series(session.topic("/csa/master/servo_cf"))
    tissue = wrench_series(session.topic("/csa/slave/measured_cf"))
    panel = _chart(session, "force [N]", height=240, y_include=(0.0,))
    if tissue is not None:
        panel.line(tissue.t, np.linalg.norm(tissue.value[:, :3], axis=1), "measured on the tissue", "truth", width=1.0)
    if did is not None:
        panel.line(did.t, did["normal_force_N"], "along the normal, filtered", "measured")
        panel.line(did.t, did["desired_force_N"], "wanted, with palpation", "command", True)
    if hand is not None:
        panel.line(hand.t, np.linalg.norm(hand.value[:, :3], axis=1), "on the hand", "master")
    border = wrench_series(session.topic(BORDER_TOPIC))
    if border is not None:
        panel.line(border.t, np.linalg.norm(border.value[:, :3], axis=1), "wanted by the fixtures", "extra", True)
    gain = _chart(session, "admittance K_g [mm/(N s)]", height=110, y_include=(0.0,))
    if did is not None:
        gain.line(did.t, 1e3 * did["admittance_m_Ns"], "used", "extra")
    return panel.render() + gain.render()


def across(session: Session) -> str:
    """Tip and proxy seen from above, the region, and how far the tip was out of it."""
    tip, proxy = (pose_series(session.topic(f"/csa/{name}/measured_cp")) for name in ("slave", "proxy"))
    origin = next((p.position[0] for p in (tip, proxy) if p is not None and len(p.t)), np.zeros(3))
    plane = Chart("y [mm]", "x [mm]", width=560, height=420, equal_axes=True)
    for series, label, color in ((proxy, "proxy", "master"), (tip, "tip", "measured")):
        if series is not None:
            at = 1e3 * (series.position - origin)
            plane.line(at[:, 0], at[:, 1], label, color)
    picked = region(session)
    if picked is not None:
        ring = 1e3 * (_ring(picked[1]) - origin[:2])
        plane.line(ring[:, 0], ring[:, 1], "region of interest", "command", True, 2.0)
    side = _chart(session, "sideways, x [mm]", width=560, height=190)
    for series, label, color in ((proxy, "proxy", "master"), (tip, "tip", "measured")):
        if series is not None:
            side.line(series.t, 1e3 * (series.position[:, 0] - origin[0]), label, color)
    out = _chart(session, "out of the region [mm]", width=560, height=170).level(0.0, "border")
    found = outside(session)
    if found is not None:
        out.line(found[0], 1e3 * found[1], "measured tip", "measured")
    columns = (plane.render(), side.render() + out.render())
    return f'<div class="sides">{"".join(f"<div class=side>{column}</div>" for column in columns)}</div>'


def _ring(points: Floats) -> Floats:
    """(n + 1, 2) corners of the convex hull seen from above, closed."""
    from scipy.spatial import ConvexHull

    corners = points[ConvexHull(points[:, :2]).vertices, :2]
    return np.vstack([corners, corners[:1]])


def mismatch(session: Session) -> str:
    """Slave against proxy, and how deep the proxy is in the model."""
    told, contact = session.topic(STATE_TOPIC), session.topic("/csa/proxy/contact")
    panel = _chart(session, "slave to proxy [mm]", height=130, y_include=(0.0,))
    if told is not None:
        panel.line(told.t, 1e3 * told["mismatch_m"], "mismatch", "extra")
    depth = _chart(session, "proxy in the model [mm]", height=130).level(0.0, "surface")
    if contact is not None:
        depth.line(contact.t, 1e3 * contact["depth"], "depth", "master")
    return panel.render() + depth.render()


def holds(session: Session) -> str:
    """Each hold with its reason; what kept the slave from doing all that was asked."""
    rows = [
        [f"{a:.2f}", f"{b - a:.2f}", reason]
        for a, b, state, reason in bands(session.topic(STATE_TOPIC))
        if state == HOLD
    ]
    body = table(["at [s]", "for [s]", "reason"], rows[:200], 9) if rows else "<p class='note'>No hold.</p>"
    did = session.topic("/csa/slave/admittance")
    if did is None:
        return body
    names, counts = np.unique(did["reason"].astype(str), return_counts=True)
    share = [[name, count, f"{100.0 * count / len(did):.1f}"] for name, count in zip(names, counts)]
    return body + table(["the slave's controller", "ticks", "%"], share)


def rates(session: Session) -> str:
    """Of the controllers' topics."""
    rows: list[list[Any]] = []
    for name in RATES:
        topic = session.topic(name)
        found = timing.rate(topic) if topic is not None else None
        if found is None:
            rows.append([name, None, None, None, None])
        else:
            numbers = (found.mean_hz, found.period_p99_ms, found.longest_gap_ms)
            rows.append([name, found.count, *(f"{value:.1f}" for value in numbers)])
    return table(["topic", "messages", "mean [Hz]", "p99 period [ms]", "longest gap [ms]"], rows)
