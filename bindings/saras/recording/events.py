"""Events of a session: channel states, diagnostics that change level, log lines from WARN up."""

from __future__ import annotations

from saras.recording.session import CHANNEL_STATES, Event, Session

_LOG_SEVERITY = {4: "warning", 8: "error", 16: "error"}  # rosgraph_msgs/Log levels
_DIAGNOSTIC_SEVERITY = {0: "info", 1: "warning", 2: "error", 3: "warning"}  # OK, WARN, ERROR, STALE
_DIAGNOSTIC_NAME = {0: "OK", 1: "WARN", 2: "ERROR", 3: "STALE"}


def collect(session: Session) -> list[Event]:
    """All events of the session, in order of time."""
    events = [*_channel_events(session), *_diagnostic_events(session), *_log_events(session)]
    return sorted(events, key=lambda event: event.t)


def _channel_events(session: Session) -> list[Event]:
    events: list[Event] = []
    for side in ("left", "right"):
        topic = session.console(side).state
        if topic is None:
            continue
        before: tuple[int, bool] | None = None
        for t, state, clutch, reason in zip(topic.t, topic["state"], topic["clutch"], topic["reason"]):
            now = (int(state), bool(clutch))
            if before is None or now[0] != before[0]:
                name = CHANNEL_STATES.get(now[0], f"unknown state {now[0]}")
                text = f"{name}: {reason}" if reason else name
                events.append(Event(float(t), f"{side} side", "error" if now[0] == 3 else "info", text))
            if before is not None and now[1] != before[1]:
                events.append(
                    Event(float(t), f"{side} side", "info", "clutch " + ("pressed" if now[1] else "released"))
                )
            before = now
    return events


def _diagnostic_events(session: Session) -> list[Event]:
    topic = session.topic("/diagnostics")
    events: list[Event] = []
    levels: dict[str, int] = {}
    for t, statuses in zip(topic.t, topic["status"]) if topic is not None else ():
        for status in statuses:
            level = int(status.level)
            # A start at OK is no event; a start at anything else is.
            if levels.get(status.name, 0) != level:
                severity = _DIAGNOSTIC_SEVERITY.get(level, "warning")
                text = f"{_DIAGNOSTIC_NAME.get(level, level)}: {status.message}"
                events.append(Event(float(t), status.name, severity, text))
            levels[status.name] = level
    return events


def _log_events(session: Session) -> list[Event]:
    topic = session.topic("/rosout_agg") or session.topic("/rosout")
    if topic is None:
        return []
    rows = zip(topic.t, topic["level"], topic["name"], topic["msg"])
    return [
        Event(float(t), str(name), _LOG_SEVERITY[int(level)], str(text))
        for t, level, name, text in rows
        if int(level) in _LOG_SEVERITY
    ]
