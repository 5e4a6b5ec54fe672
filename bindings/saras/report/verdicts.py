"""The tiles at the top of a report: each says what was measured and whether it is as it must be.

A verdict that cannot be computed is ``unknown``; it never counts as good.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from saras.recording import Event, Session
from saras.recording.collision import COLLISION, UNKNOWN, WARNING
from saras.report import energy, timing, tracking
from saras.report.timing import Latency, Rate
from saras.report.tracking import Tracking

TRACKING_RMS_MM = 1.0
SET_POINT_RMS_MM = 0.2
REMOTE_CENTRE_MM = 0.1
RATE_HZ = 100.0
RATE_SHARE = 0.98  #: of the nominal rate that counts as held
LEDGER_RELATIVE = 1e-9
UNKNOWN_SHARE = 0.01  #: of the time; more unknown distances than that, and nothing is said of the rest
SIDES = ("left", "right")


@dataclass(frozen=True)
class Verdict:
    """One tile. ``grade``: good, warning, bad, unknown."""

    title: str
    value: str
    detail: str
    grade: str


@dataclass(frozen=True)
class Findings:
    """Everything that the report computes from a session, once."""

    start_s: float  #: session start as time of day [s since 1970]
    events: list[Event]
    ledger: energy.Ledger | None
    rates: list[tuple[str, str, Rate | None]]
    latencies: dict[str, list[tuple[str, Latency | None]]]
    tracking: dict[str, Tracking | None]
    set_point_tracking: dict[str, Tracking | None]
    states: dict[str, list[tuple[float, float, int]]]
    verdicts: list[Verdict] = field(default_factory=list)


def examine(session: Session) -> Findings:
    """Computes all findings and the verdicts over them."""
    grid = tracking.time_grid(session)
    slave, set_point = {}, {}
    for side in SIDES:
        free = tracking.free_motion(session, side, grid)
        master = session.console(side).tracked_pose
        slave[side] = tracking.track(master, session.arm(f"mesa_{side}").ee_pose, free, grid)
        set_point[side] = tracking.track(master, session.arm(f"mesa_{side}").set_point, free, grid)
    states = {side: state_bands(session, side) for side in SIDES}
    since = first_engagement(states)
    rates = []
    for node, name in timing.control_topics(session):
        topic = session.topic(name)
        rates.append((node, name, timing.rate(topic, since) if topic is not None else None))
    latencies = {
        side: [(name, timing.latency(session, name, source, result)) for name, source, result in timing.hops(side)]
        for side in SIDES
    }
    found = Findings(
        session.start.timestamp(), session.events, energy.ledger(session), rates, latencies, slave, set_point, states
    )
    found.verdicts.extend(
        [
            _engaged(found),
            _holds(found),
            _energy(found),
            _books(found),
            *(_tracking(side, found.tracking[side], found.set_point_tracking[side]) for side in SIDES),
            _rate(session, found),
            _remote_centre(session),
            _distance(session, since),
        ]
    )
    return found


def state_bands(session: Session, side: str) -> list[tuple[float, float, int]]:
    """(start, end, ChannelState) of each stretch of one state [s]."""
    topic = session.console(side).state
    if topic is None:
        return []
    state = topic["state"].astype(int)
    starts = np.flatnonzero(np.diff(state, prepend=state[0] - 1) != 0)
    ends = np.append(topic.t[starts[1:]], topic.t[-1])
    return [(float(topic.t[i]), float(end), int(state[i])) for i, end in zip(starts, ends)]


def first_engagement(states: dict[str, list[tuple[float, float, int]]]) -> float:
    """When both sides had been engaged [s]; 0 when one never was. Start-up before it says nothing about rates."""
    starts = [min((start for start, _, state in bands if state == 2), default=None) for bands in states.values()]
    known = [start for start in starts if start is not None]
    return max(known) if len(known) == len(SIDES) else 0.0


def _engaged(found: Findings) -> Verdict:
    if not any(found.states.values()):
        return Verdict("Engaged", "unknown", "channel states were not recorded", "unknown")
    seconds = {side: sum(b - a for a, b, state in found.states[side] if state == 2) for side in SIDES}
    detail = " · ".join(f"{side} {seconds[side]:.1f} s" for side in SIDES)
    return Verdict("Engaged", f"{min(seconds.values()):.1f} s", detail, "good" if min(seconds.values()) > 0 else "bad")


def _holds(found: Findings) -> Verdict:
    if not all(found.states.values()):
        return Verdict("HOLDs", "unknown", "a side's state was not recorded", "unknown")
    holds = [(side, b - a) for side in SIDES for a, b, state in found.states[side] if state == 3]
    detail = f"{sum(s for _, s in holds):.1f} s in all" if holds else "no side stopped"
    return Verdict("HOLDs", str(len(holds)), detail, "bad" if holds else "good")


def _energy(found: Findings) -> Verdict:
    if found.ledger is None:
        return Verdict("Lowest tank energy", "unknown", "no tank was recorded", "unknown")
    charged = [a for a in found.ledger.accounts if np.isfinite(a.lowest_J)]
    if not charged:
        return Verdict("Lowest tank energy", "unknown", "no tank was ever charged", "unknown")
    lowest = min(charged, key=lambda account: account.lowest_J)
    if lowest.lowest_J < 0:
        grade = "bad"
    elif found.ledger.missing:
        grade = "unknown"
    else:
        grade = "good" if lowest.lowest_J >= lowest.minimum_J else "warning"
    detail = f"{lowest.name}, floor {lowest.minimum_J:.2f} J"
    if found.ledger.missing:
        detail += f"; not recorded: {', '.join(found.ledger.missing)}"
    return Verdict("Lowest tank energy", f"{lowest.lowest_J:.3f} J", detail, grade)


def _books(found: Findings) -> Verdict:
    if found.ledger is None:
        return Verdict("Energy ledger", "unknown", "no tank was recorded", "unknown")
    residual, flight = found.ledger.residual_J, found.ledger.flight_J
    bound = LEDGER_RELATIVE * found.ledger.scale_J
    detail = f"worst residual, bound {bound:.0e} J; in flight " + ("unknown" if flight is None else f"{flight:.2g} J")
    good = residual <= bound and (flight is None or flight >= -bound)
    return Verdict("Energy ledger", f"{residual:.1e} J", detail, "good" if good else "bad")


def _tracking(side: str, measured: Tracking | None, set_point: Tracking | None) -> Verdict:
    title = f"Tracking {side}"
    if measured is None or set_point is None:
        return Verdict(title, "unknown", "not enough free motion with full tanks", "unknown")
    good = measured.rms_mm <= TRACKING_RMS_MM and set_point.rms_mm <= SET_POINT_RMS_MM
    detail = (
        f"RMS after lag {1e3 * measured.lag_s:.0f} ms, scale {measured.scale:.3f}, "
        f"{measured.seconds:.0f} s of free motion; "
        f"set-point {set_point.rms_mm:.2f} mm after {1e3 * set_point.lag_s:.0f} ms"
    )
    return Verdict(title, f"{measured.rms_mm:.2f} mm", detail, "good" if good else "bad")


def _rate(session: Session, found: Findings) -> Verdict:
    nominal = float(session.info.get("rate_hz", RATE_HZ))
    known = [(node, rate) for node, _, rate in found.rates if rate is not None]
    if not known:
        return Verdict("Node rate", "unknown", "no control topic was recorded", "unknown")
    slowest, rate = min(known, key=lambda row: row[1].mean_hz)
    missing = len(found.rates) - len(known)
    detail = f"slowest: {slowest}, p99 period {rate.period_p99_ms:.1f} ms, nominal {nominal:.0f} Hz"
    grade = "good" if rate.mean_hz >= RATE_SHARE * nominal else "bad"
    if missing and grade == "good":
        grade, detail = "unknown", f"{detail}; {missing} of {len(found.rates)} topics not recorded"
    return Verdict("Node rate", f"{rate.mean_hz:.1f} Hz", detail, grade)


def _distance(session: Session, since: float) -> Verdict:
    title = "Least distance"
    tools = [tool for tool in session.distances if (tool.t >= since).any()]
    known = [tool for tool in tools if np.isfinite(tool.distance_m[tool.t >= since]).any()]
    if not known:
        return Verdict(title, "unknown", "/collision/state was not recorded, or never known", "unknown")
    rows = []
    for tool in known:
        late = np.flatnonzero(tool.t >= since)
        i = int(late[np.nanargmin(tool.distance_m[late])])
        rows.append((float(tool.distance_m[i]), f"{tool.name} - {tool.partner[i]} at {tool.t[i]:.1f} s"))
    least, where = min(rows)
    states = np.concatenate([tool.state[tool.t >= since] for tool in tools])
    unknown = float(np.mean(states == UNKNOWN))
    if (states == COLLISION).any():
        grade = "bad"
    elif unknown > UNKNOWN_SHARE:
        grade = "unknown"
    else:
        grade = "warning" if (states == WARNING).any() else "good"
    return Verdict(title, f"{1e3 * least:.1f} mm", f"{where}; unknown {100.0 * unknown:.1f} % of the time", grade)


def _remote_centre(session: Session) -> Verdict:
    worst = []
    for side in SIDES:
        result = tracking.remote_centre_deviation(session, f"mesa_{side}")
        if result is None or not np.isfinite(result[1]).any():
            return Verdict("Remote centre", "unknown", f"{side}: neither truth nor trocar recorded", "unknown")
        worst.append((1e3 * float(np.nanmax(result[1])), side, result[2]))
    deviation, side, source = max(worst)
    good = deviation <= REMOTE_CENTRE_MM
    return Verdict("Remote centre", f"{deviation:.3f} mm", f"worst: {side}, from {source}", "good" if good else "bad")
