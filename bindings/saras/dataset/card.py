"""The data card: README.md for a person, card.json for a program."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any


def write_card(directory: Path, card: dict[str, Any]) -> None:
    """Both files, from the same facts."""
    (directory / "card.json").write_text(json.dumps(_plain(card), indent=1, allow_nan=False) + "\n", encoding="utf-8")
    (directory / "README.md").write_text("\n".join(_lines(card)) + "\n", encoding="utf-8")


def _plain(value: Any) -> Any:
    """For JSON, which knows no NaN."""
    if isinstance(value, dict):
        return {key: _plain(inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(inner) for inner in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _lines(card: dict[str, Any]) -> list[str]:
    sessions = card["sessions"]
    software = ", ".join(f"{name} {version}" for name, version in card["software"].items())
    seconds = sum(session["duration_s"] for session in sessions)
    lines = [
        "# Data set of teleoperation sessions",
        "",
        f"Made {card['made']} by {software}.",
        f"{len(sessions)} sessions, {seconds:.1f} s, {sum(session['rows'] for session in sessions)} rows.",
        "",
        f"Licence: {card['licence']}.",
        "",
        "```python",
        "import pandas",
        f"table = pandas.read_parquet({sessions[0]['file']!r})",
        "table.plot(x='t_s', y='mesa_left_tip_x_m')",
        "```",
        "",
        "A number that is not known is NaN, a text is null; `<source>_valid` says where a source is known.",
        "Positions are interpolated linearly, rotations (x y z w, signs without jumps) by slerp, states hold for a",
        "bounded time (`_age_s`); never across a gap. Each column's unit, frame, topic and method are in the metadata",
        "of its Parquet field and in card.json.",
        "A wrench is what the robot exerts on its surroundings.",
        "",
        "| session | start | duration [s] | rows | a row is | not recorded |",
        "|---|---|---|---|---|---|",
    ]
    for session in sessions:
        absent = ", ".join(session["absent"]) or "—"
        lines.append(
            f"| {session['name']} | {session['start']} | {session['duration_s']:.2f} | {session['rows']} "
            f"| {session['row']} | {absent} |"
        )
    for session in sessions:
        lines += ["", f"## {session['name']}", ""]
        lines += [f"- {note}" for note in session["notes"]] + [""] * bool(session["notes"])
        lines += [
            "| source | topic | messages | left out | bound [s] | gaps | rows known |",
            "|---|---|---|---|---|---|---|",
        ]
        for source in session["sources"]:
            share = 100.0 * source["known_rows"] / session["rows"] if session["rows"] else math.nan
            lines.append(
                f"| {source['name']} | {source['topic']} | {source['messages']} | {source['dropped']} "
                f"| {source['gap_s']:.3f} | {source['gaps']} | {share:.1f} % |"
            )
        lines += ["", *_validation(session["validation"])]
    lines += ["## Columns", "", "| column | unit | frame | method | is |", "|---|---|---|---|---|"]
    seen: dict[str, dict[str, Any]] = {}
    for session in sessions:
        for column in session["columns"]:
            seen.setdefault(column["name"], column)
    lines += [
        f"| {column['name']} | {column['unit']} | {column['frame']} | {column['method']} | {column['text']} |"
        for column in seen.values()
    ]
    if any("speech" in session for session in sessions):
        lines += ["", "## Speech (speech_by_action.parquet)", ""]
        lines += [
            "A row a pair of action and word: `count` of the word in utterances that begin in the action, its rate"
        ]
        lines += ["`per_minute`, and `lift`, that rate over the word's rate at all times (1: it goes with no action)."]
        lines += [
            f"{session['name']}: {session['speech']['utterances']} utterances of {session['speech']['transcript']}."
            for session in sessions
            if "speech" in session
        ]
    if card["nominal"]:
        lines += ["", "## Nominal trajectories (nominal.parquet)", "", f"Phase by {card['phase']}."]
        lines += ["", "| tool | action | executions | mean duration [s] |", "|---|---|---|---|"]
        lines += [
            f"| {row['tool']} | {row['action'] or '(whole engaged stretch)'} | {row['executions']} "
            f"| {row['mean_duration_s']:.2f} |"
            for row in card["nominal"]
        ]
    return lines


def _validation(arms: dict[str, dict[str, Any]]) -> list[str]:
    lines = [
        "| arm | workspace [mm] | path [m] | speed p50 / p99 [mm/s] | set-point − measured, rms / p99 [mm] | rms [°] |",
        "|---|---|---|---|---|---|",
    ]
    for name, arm in arms.items():
        size = " × ".join(f"{1e3 * side:.0f}" for side in arm["workspace_m"]["size"]) if arm["workspace_m"] else "?"
        path = f"{arm['path_m']:.2f}" if arm["path_m"] is not None else "?"
        speed = arm["speed_m_per_s"]
        speeds = f"{1e3 * speed['p50']:.1f} / {1e3 * speed['p99']:.1f}" if speed else "?"
        error, turn = arm.get("accuracy_m"), arm.get("accuracy_rad")
        errors = f"{1e3 * error['rms']:.2f} / {1e3 * error['p99']:.2f}" if error else "?"
        turned = f"{math.degrees(turn['rms']):.2f}" if turn else "?"
        lines.append(f"| {name} | {size} | {path} | {speeds} | {errors} | {turned} |")
    return [*lines, ""]
