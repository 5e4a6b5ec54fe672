"""Whether a recording is complete and its clocks plausible: ``saras bag check``."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError, Error
from saras.recording.clock_steps import agrees_with_node, steps_of_clock
from saras.recording.survey import Publisher, Survey

GOOD, WARNING, BAD, UNKNOWN = "good", "warning", "bad", "unknown"
_ENOUGH = 20  # messages that make a rate


@dataclass(frozen=True)
class Bounds:
    """What is taken as a fault."""

    gap_periods: float = 10.0  #: silence longer than this many nominal periods
    gap_s: float = 0.1  #: and longer than this
    age_s: float = 0.25  #: 99 % of the messages reach the recorder sooner
    future_s: float = 0.005  #: a stamp that is later than its reception by more than this
    step_s: float = 0.2  #: a jump of the age that stays
    rate: float = 0.98  #: mean rate as a share of the usual one

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not (math.isfinite(value) and value > 0):
                raise ConfigError(f"{name} = {value}: must be finite and > 0")


@dataclass(frozen=True)
class Finding:
    """One thing that was looked at."""

    grade: str  #: good, warning, bad, unknown
    topic: str  #: empty: the file; or a file beside it
    what: str  #: file, topics, lost, gap, rate, order, step, age, future, video, sound
    text: str
    value: float | None = None


def check(survey: Survey, expected: Iterable[str] | None = None, bounds: Bounds | None = None) -> list[Finding]:
    """All findings that are not good, worst first; empty: the recording is complete as far as it can be known."""
    bounds = bounds or Bounds()
    findings = [*_file(survey), *_topics(survey, expected)]
    uncounted = []
    for publisher in survey.publishers:
        findings += _lost(publisher, survey)
        findings += _rhythm(publisher, survey, bounds)
        findings += _order(publisher, survey, bounds)
        findings += _age(publisher, survey, bounds)
        if publisher.seq is None and period_s(publisher) is not None:
            uncounted.append(publisher.topic)
    if uncounted:
        names = sorted(set(uncounted))
        text = f"{len(names)} topics carry no sequence numbers: lost messages cannot be counted ({', '.join(names)})"
        findings.append(Finding(UNKNOWN, "", "lost", text))
    return worst_first(findings)


def worst_first(findings: Iterable[Finding]) -> list[Finding]:
    """By grade, kind and size."""
    order = {BAD: 0, WARNING: 1, UNKNOWN: 2}
    return sorted(findings, key=lambda finding: (order[finding.grade], finding.what, -abs(finding.value or 0.0)))


def lost_by_sequence(seq: NDArray[Any]) -> tuple[int, int]:
    """Messages missing between consecutive numbers (32 bits, which wrap), and how often the number fell back."""
    step = np.diff(np.asarray(seq, dtype=np.int64))
    step = np.where(step < -(2**31), step + 2**32, step)
    return int((step[step > 1] - 1).sum()), int((step < 0).sum())


def period_s(publisher: Publisher) -> float | None:
    """Nominal period: the median, when the messages are many and more or less regular."""
    if len(publisher) < _ENOUGH or publisher.latched:
        return None
    period = np.diff(publisher.received_ns) * 1e-9
    median = float(np.median(period))
    if median <= 0 or np.percentile(period, 80) > 4 * median:
        return None
    return median


def expected_topics(path: str | Path) -> list[str]:
    """Topics of a file like config/record_topics.yaml that every session has: without those under ``occasional``."""
    import yaml

    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        occasional = set(_expanded(content.get("occasional", [])))
        return [name for name in _expanded(content["topics"]) if name not in occasional]
    except (yaml.YAMLError, KeyError, AttributeError, TypeError, UnicodeDecodeError) as error:
        raise Error(f"{path}: no list of topics (a mapping with the key topics): {error}") from error


def _expanded(patterns: list[str]) -> list[str]:
    return list(dict.fromkeys(pattern.format(s=side) for pattern in patterns for side in ("left", "right")))


def _at(survey: Survey, time_ns: int) -> str:
    return f"at {(time_ns - survey.start_ns) * 1e-9:.3f} s"


def _file(survey: Survey) -> list[Finding]:
    findings = []
    if not survey.closed:
        findings.append(Finding(BAD, "", "file", "never closed: the recorder was killed or still writes"))
    elif survey.missing_bytes:
        text = f"cut: at least {survey.missing_bytes} bytes are missing"
        findings.append(Finding(BAD, "", "file", text, survey.missing_bytes))
    elif not survey.indexed:
        findings.append(Finding(BAD, "", "file", "its index is missing or damaged"))
    for gap in survey.gaps:
        where = _at(survey, gap.after_ns) if gap.after_ns is not None else "at the begin"
        findings.append(Finding(BAD, "", "file", f"{gap.bytes} bytes unreadable {where}", gap.bytes))
    if survey.orphans:
        findings.append(Finding(BAD, "", "file", f"{survey.orphans} messages of unknown topic", survey.orphans))
    return findings


def _topics(survey: Survey, expected: Iterable[str] | None) -> list[Finding]:
    if expected is None:
        return [Finding(UNKNOWN, "", "topics", "not compared with a list (--topics config/record_topics.yaml)")]
    recorded = {publisher.topic for publisher in survey.publishers}
    return [Finding(BAD, name, "topics", "never recorded") for name in expected if name not in recorded]


def _lost(publisher: Publisher, survey: Survey) -> list[Finding]:
    if publisher.seq is None:
        return []
    lost, restarts = lost_by_sequence(publisher.seq)
    findings = []
    if lost:
        step = np.diff(publisher.seq)
        first = int(np.argmax((step > 1) | (step < -(2**31))))
        where = _at(survey, int(publisher.received_ns[first]))
        text = f"{lost} of {lost + len(publisher)} messages lost, the first {where} (from {publisher.node or '?'})"
        findings.append(Finding(BAD, publisher.topic, "lost", text, lost))
    if restarts:
        text = f"{publisher.node or 'the publisher'} began to count anew {restarts} times: losses there are not known"
        findings.append(Finding(WARNING, publisher.topic, "lost", text, restarts))
    return findings


def _rhythm(publisher: Publisher, survey: Survey, bounds: Bounds) -> list[Finding]:
    nominal = period_s(publisher)
    if nominal is None:
        return []
    findings = []
    period = np.diff(publisher.received_ns) * 1e-9
    gaps = np.flatnonzero(period > max(bounds.gap_periods * nominal, bounds.gap_s))
    if len(gaps):
        worst = int(gaps[np.argmax(period[gaps])])
        text = (
            f"{len(gaps)} gaps longer than {bounds.gap_periods:g} periods of {nominal * 1e3:.1f} ms, the longest "
            f"{period[worst]:.3f} s {_at(survey, int(publisher.received_ns[worst]))}"
        )
        findings.append(Finding(WARNING, publisher.topic, "gap", text, float(period[worst])))
    mean_hz = float(1.0 / period.mean()) if period.mean() > 0 else math.inf
    if mean_hz < bounds.rate / nominal:
        text = f"{mean_hz:.1f} Hz on average, usually {1.0 / nominal:.1f} Hz"
        findings.append(Finding(WARNING, publisher.topic, "rate", text, mean_hz))
    return findings


def _order(publisher: Publisher, survey: Survey, bounds: Bounds) -> list[Finding]:
    findings = []
    for times, name in ((publisher.received_ns, "receptions"), (publisher.stamp_ns, "stamps")):
        if times is None:
            continue
        back = np.flatnonzero(np.diff(times) < 0)
        if len(back):
            step_s = float(np.diff(times)[back].min() * -1e-9)
            where = _at(survey, int(publisher.received_ns[back[0]]))
            text = f"{name} go back {len(back)} times, by up to {step_s:.6f} s, first {where}"
            # A set-point carries its input's stamp: a little back is another input.
            grade = WARNING if name == "stamps" and step_s <= bounds.step_s else BAD
            findings.append(Finding(grade, publisher.topic, "order", text, step_s))
    return findings


def _age(publisher: Publisher, survey: Survey, bounds: Bounds) -> list[Finding]:
    age = publisher.age_s
    if age is None or publisher.stamp_ns is None or publisher.latched or not len(age):
        return []
    findings = []
    stamped = publisher.stamp_ns != 0
    received = publisher.received_ns[stamped]
    for at, jump in steps_of_clock(received, publisher.stamp_ns[stamped], bounds.step_s):
        moment_ns = int(received[at])
        if agrees_with_node(publisher, survey.publishers, moment_ns, jump):
            text = f"the stamps step by {jump:+.3f} s {_at(survey, moment_ns)}"
            findings.append(Finding(BAD, publisher.topic, "step", text, jump))
        else:
            change = f"{abs(jump):.3f} s {'older' if jump < 0 else 'younger'}"
            text = f"what it tells becomes {change} {_at(survey, moment_ns)}, its node's clock goes on evenly"
            findings.append(Finding(WARNING, publisher.topic, "age", text, -jump))
    p99 = float(np.percentile(age, 99))
    if p99 > bounds.age_s:
        text = f"p99 of the age {p99 * 1e3:.1f} ms, the oldest {age.max() * 1e3:.1f} ms"
        findings.append(Finding(WARNING, publisher.topic, "age", text, p99))
    if age.min() < -bounds.future_s:
        text = f"{int((age < -bounds.future_s).sum())} stamps after their reception, by up to {-age.min() * 1e3:.1f} ms"
        findings.append(Finding(BAD, publisher.topic, "future", text, float(-age.min())))
    return findings
