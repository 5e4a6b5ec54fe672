"""What was said, from a transcript beside the sound of a session, as columns; and which words go with which action."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import Error
from saras.capture import sound_index
from saras.dataset.annotations import END, Annotation
from saras.recording import transcript
from saras.recording.beside import beside
from saras.recording.transcript import Utterance

Floats = NDArray[np.float64]
ENDINGS = ("srt", "vtt", "csv")
_WORD = re.compile(r"[^\W\d_]+(?:['’][^\W\d_]+)*")


@dataclass
class Spoken:
    """Of one session, for the table of all: seconds of each action, and how often each word began in it."""

    seconds: dict[str | None, float] = field(default_factory=dict)
    words: dict[str | None, Counter[str]] = field(default_factory=dict)


@dataclass
class Speech:
    """What was said in a session. All times: seconds since its start."""

    file: str
    utterances: list[Utterance]
    begin_s: float
    """of the sound: before it nobody knows what was said"""
    end_s: float


def find(bag: Path) -> tuple[Path, Path] | None:
    """Transcript and sound beside a bag: NAME_audio.srt, .vtt or .csv, and NAME_audio.flac. None: no transcript."""
    for ending in ENDINGS:
        path = beside(bag, f"audio.{ending}")
        if path.is_file():
            return path, beside(bag, "audio.flac")
    return None


def read_speech(bag: Path, session_start_ns: int) -> Speech | None:
    """On the session's time by the times of the sound's samples. None: no transcript. Raises Error naming a file that
    cannot be read.
    """
    files = find(bag)
    if files is None:
        return None
    text, sound = files
    try:
        rate_hz = sound_index.rate_hz(sound)
        index = sound_index.read_index(sound)
    except (OSError, ValueError) as error:
        raise Error(f"{text}: needs the sound that it is of, and its index: {error}") from None
    said = transcript.aligned(transcript.read(text), sound, rate_hz, session_start_ns)
    begin_s, end_s = (float((stamp - session_start_ns) * 1e-9) for stamp in (index[0, 1], index[-1, 1]))
    return Speech(text.name, said, begin_s, end_s)


def speech_columns(speech: Speech, at: Floats) -> tuple[NDArray[Any], NDArray[np.bool_]]:
    """(n,) what is being said at each row, null: nothing; (n,) whether that is known: within the sound."""
    text = np.full(len(at), None, dtype=object)
    for one in speech.utterances:
        for row in np.flatnonzero((at >= one.start_s) & (at < one.end_s)):
            text[row] = one.text if text[row] is None else f"{text[row]}; {one.text}"
    return text, (at >= speech.begin_s) & (at <= speech.end_s)


def spoken(speech: Speech, annotations: Sequence[Annotation], duration_s: float) -> Spoken:
    """A word counts for the action in which its utterance begins; time and words outside of the sound do not count.

    annotations: in order of time; duration_s: of the session.
    """
    found = Spoken()
    begin_s, end_s = max(speech.begin_s, 0.0), min(speech.end_s, duration_s)
    marks = [(mark.t, None if mark.label in ("", END) else mark.label) for mark in annotations if mark.kind == "action"]
    begins = [(-math.inf, None), *marks]
    for (since_s, label), (until_s, _) in zip(begins, [*begins[1:], (math.inf, None)]):
        first_s, last_s = max(since_s, begin_s), min(until_s, end_s)
        if last_s <= first_s:
            continue
        found.seconds[label] = found.seconds.get(label, 0.0) + last_s - first_s
        for one in speech.utterances:
            if first_s <= one.start_s < last_s:
                found.words.setdefault(label, Counter()).update(map(str.casefold, _WORD.findall(one.text)))
    return found


def by_action(every: Iterable[Spoken]) -> dict[str, list[Any]]:
    """Of all sessions, a row a pair of action and word: action (null: none), seconds of it, word, count, per_minute,
    lift. Lift: the word's rate in this action over its rate at all times; 1: it goes with no action.
    """
    seconds: defaultdict[str | None, float] = defaultdict(float)
    words: defaultdict[str | None, Counter[str]] = defaultdict(Counter)
    for one in every:
        for label, value in one.seconds.items():
            seconds[label] += value
        for label, counted in one.words.items():
            words[label].update(counted)
    total_s, total = sum(seconds.values()), Counter[str]()
    for counted in words.values():
        total.update(counted)
    rows: dict[str, list[Any]] = {name: [] for name in ("action", "seconds", "word", "count", "per_minute", "lift")}
    for label in sorted(words, key=lambda label: (label is None, label or "")):
        for word, count in sorted(words[label].items(), key=lambda pair: (-pair[1], pair[0])):
            share = seconds[label] / total_s if total_s else 0.0
            rate = 60.0 * count / seconds[label] if seconds[label] else np.nan
            lift = count / total[word] / share if share else np.nan
            for column, cell in zip(rows.values(), (label, seconds[label], word, count, rate, lift)):
                column.append(cell)
    return rows


__all__ = ["Speech", "Spoken", "by_action", "find", "read_speech", "speech_columns", "spoken"]
