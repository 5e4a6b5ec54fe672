"""What was said: a transcript of the sound beside a bag, put on the session's time.

Subtitles (SRT, WebVTT) or CSV (start_s, end_s, text), with times since the beginning of the sound file.
"""

from __future__ import annotations

import csv
import re
from pathlib import Path
from typing import NamedTuple

from saras import Error
from saras.capture.sound_index import times_ns

_STAMP = r"(?:(\d+):)?(\d{1,2}):(\d{2})[.,](\d{1,3})"
_CUE = re.compile(rf"^\s*{_STAMP}\s*-->\s*{_STAMP}")


class Utterance(NamedTuple):
    """Something said. In a transcript: seconds since the beginning of the sound; on a session: since its start."""

    start_s: float
    end_s: float
    text: str


def read(path: Path) -> list[Utterance]:
    """All utterances in order of their start. Raises Error naming the line that is wrong."""
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise Error(f"{path}: {error}") from None
    found = _read_csv(path, text) if path.suffix.lower() == ".csv" else _read_cues(path, text)
    if not found:
        raise Error(f"{path}: no utterance in it: must be SRT, WebVTT, or CSV with start_s, end_s, text")
    return sorted(found)


def _read_cues(path: Path, text: str) -> list[Utterance]:
    found: list[Utterance] = []
    lines = text.splitlines()
    for number, line in enumerate(lines, start=1):
        cue = _CUE.match(line)
        if cue is None:
            continue
        start_s, end_s = _seconds(cue.groups()[:4]), _seconds(cue.groups()[4:])
        words = []
        for said in lines[number:]:
            if not said.strip():
                break
            words.append(re.sub(r"<[^>]*>", "", said).strip())
        found.append(_checked(path, number, start_s, end_s, " ".join(words)))
    return found


def _seconds(groups: tuple[str | None, ...]) -> float:
    hours, minutes, seconds, fraction = groups
    whole = 3600 * int(hours or 0) + 60 * int(minutes or 0) + int(seconds or 0)
    return whole + int((fraction or "0").ljust(3, "0")) / 1000.0


def _read_csv(path: Path, text: str) -> list[Utterance]:
    found = []
    for number, row in enumerate(csv.DictReader(text.splitlines()), start=2):
        try:
            start_s, end_s, said = float(row["start_s"]), float(row["end_s"]), str(row["text"] or "")
        except (KeyError, TypeError, ValueError) as error:
            raise Error(f"{path}:{number}: must have numbers start_s, end_s and a text: {error}") from None
        found.append(_checked(path, number, start_s, end_s, said))
    return found


def _checked(path: Path, number: int, start_s: float, end_s: float, text: str) -> Utterance:
    if not 0.0 <= start_s <= end_s < float("inf"):
        raise Error(f"{path}:{number}: from {start_s:g} to {end_s:g} s: must be 0 <= start <= end")
    return Utterance(start_s, end_s, text)


def aligned(transcript: list[Utterance], sound: Path, rate_hz: int, session_start_ns: int) -> list[Utterance]:
    """The same on the session's time: by the times of the sound's own samples, not by its length."""
    samples = [[u.start_s * rate_hz, u.end_s * rate_hz] for u in transcript]
    times = (times_ns(sound, samples) - session_start_ns) * 1e-9
    return [Utterance(float(a), float(b), u.text) for (a, b), u in zip(times, transcript)]


__all__ = ["Utterance", "aligned", "read"]
