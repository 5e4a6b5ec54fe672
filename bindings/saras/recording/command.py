"""Looks into a recorded bag, checks it, mends it. Needs no ROS.

saras bag info session.bag                                          what is in it
saras bag check session.bag --topics config/record_topics.yaml      exit code 1 when something is lost
saras bag repair session.bag.active                                 of a killed recorder, or a copy that was cut
saras bag report session.bag                                        as saras report
saras bag align session.bag                                         video, motion and sound at simulated claps
"""

from __future__ import annotations

import argparse
import itertools
import json
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np

from saras import Error
from saras.recording.beside import check_beside
from saras.recording.completeness import BAD, Bounds, check, expected_topics, lost_by_sequence, worst_first
from saras.recording.repair import repair
from saras.recording.survey import Survey, survey


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds info, check, repair, report, align."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    info = actions.add_parser("info", help="duration, size; a topic's type, number, rate and age")
    checking = actions.add_parser("check", help="completeness, gaps, rates, order and steps of stamps, ages")
    for action in (info, checking):
        action.add_argument("file", type=Path, nargs="+", metavar="FILE", help="bags, also unfinished or cut ones")
        action.add_argument("--json", action="store_true", help="as JSON")
    checking.add_argument("--topics", type=Path, metavar="YAML", help="topics that must be there")
    checking.add_argument("--strict", action="store_true", help="exit code 1 for warnings too")
    checking.add_argument("--quick", action="store_true", help="videos and sound beside the bag are not decoded")
    checking.add_argument("--all", action="store_true", help="every finding, not the worst three of a kind")
    usual = Bounds()
    for name, text in (
        ("gap_periods", "silence longer than this many usual periods is a gap"),
        ("age_s", "99 %% of the messages must reach the recorder sooner"),
        ("step_s", "a jump of the stamps against the recorder's clock"),
    ):
        flag = "--" + name.replace("_", "-")
        checking.add_argument(
            flag, type=float, default=getattr(usual, name), metavar="X", help=f"{text} (default %(default)s)"
        )
    mend = actions.add_parser("repair", help="write a whole bag from an unfinished or cut one, which stays as it is")
    mend.add_argument("file", type=Path, nargs="+", metavar="FILE", help=".bag.active, .bag")
    mend.add_argument("--out", type=Path, help="default: NAME.repaired.bag beside it")
    mend.add_argument("--force", action="store_true", help="overwrite that file")
    report = actions.add_parser("report", help="the HTML report of saras report")
    report.add_argument("file", type=Path, nargs="+", metavar="FILE")
    report.add_argument("--out", type=Path, help="the HTML file; default: beside the bag")
    aligned = actions.add_parser("align", help="how far apart video, motion and sound show the claps of claps:=true")
    aligned.add_argument("file", type=Path, nargs="+", metavar="FILE", help="bags with video and sound beside them")
    aligned.add_argument("--arm", default="PSM1", help="whose /ARM/measured_cp jumps (default %(default)s)")
    aligned.add_argument("--json", action="store_true", help="as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Exit code 1: ``check`` or ``align`` found something bad. Refused files are a saras.Error."""
    if len(arguments.file) > 1 and getattr(arguments, "out", None) is not None:
        raise Error("--out goes with one file only")
    if arguments.action == "info":
        return _info(arguments)
    if arguments.action == "check":
        return _check(arguments)
    if arguments.action == "repair":
        return _repair(arguments)
    if arguments.action == "align":
        return _align(arguments)
    from saras.report import command as report

    for file in arguments.file:
        report.run(argparse.Namespace(bag=file, out=arguments.out))
    return 0


def facts(found: Survey) -> dict[str, Any]:
    """What ``info`` shows, for JSON: times [s], ages [ms]."""
    return {
        "file": str(found.path),
        "bytes": found.size_bytes,
        "state": "whole" if found.whole else "unfinished" if not found.closed else "damaged",
        "start": datetime.fromtimestamp(found.start_ns * 1e-9, tz=timezone.utc).isoformat(),
        "duration_s": found.duration_s,
        "messages": found.messages,
        "topics": [_topic_facts(name, publishers) for name, publishers in found.topics().items()],
    }


def _topic_facts(name: str, publishers: list[Any]) -> dict[str, Any]:
    received = np.sort(np.concatenate([publisher.received_ns for publisher in publishers]))
    span_s = float(received[-1] - received[0]) * 1e-9
    ages = [publisher.age_s for publisher in publishers if publisher.age_s is not None and not publisher.latched]
    age = np.concatenate(ages) * 1e3 if ages else np.empty(0)
    counted = [publisher for publisher in publishers if publisher.seq is not None]
    return {
        "topic": name,
        "type": ", ".join(sorted({publisher.type for publisher in publishers})),
        "publishers": sorted({publisher.node for publisher in publishers}),
        "messages": len(received),
        "bytes": sum(publisher.bytes for publisher in publishers),
        "rate_hz": (len(received) - 1) / span_s if span_s > 0 else None,
        "lost": sum(lost_by_sequence(publisher.seq)[0] for publisher in counted) if counted else None,
        "age_ms": {
            "p50": float(np.percentile(age, 50)),
            "p99": float(np.percentile(age, 99)),
            "max": float(age.max()),
        }
        if len(age)
        else None,
    }


def _info(arguments: argparse.Namespace) -> int:
    with _progress(arguments.file) as track:
        every = [facts(survey(file, track(file))) for file in arguments.file]
    if arguments.json:
        print(json.dumps(every if len(every) > 1 else every[0], indent=1))
        return 0
    for one in every:
        size = one["bytes"] / 1e6
        rate = f" ({one['bytes'] / 1e3 / one['duration_s']:.0f} kB/s)" if one["duration_s"] > 0.0 else ""
        print(f"{one['file']}: {one['state']}, {one['duration_s']:.3f} s from {one['start']}, ", end="")
        print(f"{size:.1f} MB{rate}, ", end="")
        print(f"{one['messages']} messages")
        width = max(len(row["topic"]) for row in one["topics"])
        head = ("type", "messages", "Hz", "lost", "age p50", "p99", "max ms")
        print(f"{'topic':<{width}}  {head[0]:<32} {head[1]:>8} {head[2]:>7} {head[3]:>5} ", end="")
        print(" ".join(f"{name:>8}" for name in head[4:]))
        for row in one["topics"]:
            rate = f"{row['rate_hz']:.1f}" if row["rate_hz"] is not None else ""
            lost = str(row["lost"]) if row["lost"] is not None else "?"
            ages = [f"{row['age_ms'][name]:8.1f}" for name in ("p50", "p99", "max")] if row["age_ms"] else []
            line = (
                f"{row['topic']:<{width}}  {row['type']:<32} {row['messages']:>8} {rate:>7} {lost:>5} {' '.join(ages)}"
            )
            print(line.rstrip())
    return 0


def _check(arguments: argparse.Namespace) -> int:
    expected = None if arguments.topics is None else expected_topics(arguments.topics)
    bounds = Bounds(gap_periods=arguments.gap_periods, age_s=arguments.age_s, step_s=arguments.step_s)
    answers: list[dict[str, Any]] = []
    worst = 0
    with _progress(arguments.file) as track:
        for file in arguments.file:
            found = survey(file, track(file))
            beside = check_beside(file, decode=not arguments.quick)
            findings = worst_first([*check(found, expected, bounds), *beside.findings])
            counted = [publisher for publisher in found.publishers if publisher.seq is not None]
            numbers = {
                "messages": found.messages,
                "counted": sum(map(len, counted)),
                "lost": sum(lost_by_sequence(publisher.seq)[0] for publisher in counted if publisher.seq is not None),
            }
            grades = {finding.grade for finding in findings}
            good = BAD not in grades and not (arguments.strict and "warning" in grades)
            worst = max(worst, 0 if good else 1)
            answer: dict[str, Any] = {"file": str(file), "good": good, "numbers": numbers, "beside": beside.lines}
            answer["findings"] = [vars(finding) for finding in findings]
            answers.append(answer)
    if arguments.json:
        print(json.dumps(answers if len(answers) > 1 else answers[0], indent=1))
        return worst
    for answer in answers:
        numbers = answer["numbers"]
        _show(answer["findings"], arguments.all)
        print(f"{numbers['messages']} messages, {numbers['counted']} of them numbered, {numbers['lost']} lost")
        print("".join(f"{line}\n" for line in answer["beside"]), end="")
        print(f"{answer['file']}: {'complete' if answer['good'] else 'not complete'}")
    return worst


def _show(findings: list[dict[str, Any]], every: bool) -> None:
    """A line a finding; of many of one kind the worst three."""
    for (grade, _), group in itertools.groupby(findings, key=lambda row: (row["grade"], row["what"])):
        rows = list(group)
        shown = rows if every or len(rows) <= 5 else rows[:3]
        for row in shown:
            print(f"{grade:>8}  {row['topic']}{': ' if row['topic'] else ''}{row['text']}")
        if len(shown) < len(rows):
            print(f"{grade:>8}  … and {len(rows) - len(shown)} more like this (--all)")


def _repair(arguments: argparse.Namespace) -> int:
    with _progress(arguments.file) as track:
        for file in arguments.file:
            done = repair(file, arguments.out, arguments.force, track(file))
            if done.before.whole:
                print(f"{file}: was whole, nothing to mend")
            print("\n  ".join(done.lines()))
    return 0


def _align(arguments: argparse.Namespace) -> int:
    from saras.recording.alignment import measure

    found = {file: measure(file, arguments.arm) for file in arguments.file}
    if arguments.json:
        every = [{"file": str(file), **one.facts()} for file, one in found.items()]
        print(json.dumps(every if len(every) > 1 else every[0], indent=1))
    else:
        for file, one in found.items():
            *lines, verdict = one.lines()
            print("\n".join([*lines, f"{file}: {verdict}"]))
    return 0 if all(one.within_a_frame for one in found.values()) else 1


@contextmanager
def _progress(files: list[Path]) -> Iterator[Callable[[Path], Callable[[int, int], None] | None]]:
    """A bar a file on a terminal, when rich is there."""
    try:
        from rich.console import Console
        from rich.progress import Progress
    except ImportError:
        yield lambda file: None
        return
    if not sys.stderr.isatty():
        yield lambda file: None
        return
    with Progress(console=Console(stderr=True), transient=True) as bars:

        def track(file: Path) -> Callable[[int, int], None]:
            task = bars.add_task(file.name)
            return lambda done, total: bars.update(task, completed=done, total=total)

        yield track
