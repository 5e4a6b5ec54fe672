"""One session as one table: a row a video frame, or rows of a fixed rate."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError, Error
from saras.dataset import resample
from saras.dataset.annotations import annotation_columns
from saras.dataset.sources import LINEAR, PREVIOUS, SLERP, Samples, Source, sources
from saras.dataset.speech import Speech, read_speech, speech_columns
from saras.recording import Session, Topic

Floats = NDArray[np.float64]

#: Whose stamps are rows when nothing else is asked for; the first that was recorded.
FRAME_TOPICS = (
    "/recorder/video/left",
    "/endoscope/left/image_raw",
    "/endoscope/left/image_raw/compressed",
    "/endoscope/left/camera_info",
)
VIDEO = "/recorder/video/"
USUAL_RATE_HZ = 25.0
MOST_ROWS = 50_000_000


@dataclass(frozen=True)
class Options:
    """What the rows are, and how far values reach."""

    rate_hz: float | None = None  #: fixed rate; None: frames where there are any, else 25 Hz
    frames: str | None = None  #: topic whose stamps are the rows
    frame_index: str | None = None  #: CSV of a video beside the bag, with a column stamp_ns or stamp_s (unix time)
    gap_periods: float = 5.0  #: no value further than this many median periods between two samples
    gap_least_s: float = 0.05
    age_max_s: float = 5.0  #: a stamp further from its reception is none

    def __post_init__(self) -> None:
        for name in ("rate_hz", "gap_periods", "gap_least_s", "age_max_s"):
            value = getattr(self, name)
            if value is not None and not (math.isfinite(value) and value > 0):
                raise ConfigError(f"{name} = {value}: must be finite and > 0")
        if sum(value is not None for value in (self.rate_hz, self.frames, self.frame_index)) > 1:
            raise ConfigError("rate_hz, frames, frame_index: only one of them can say what the rows are")


@dataclass(frozen=True)
class ColumnInfo:
    """What the card says of one column."""

    name: str
    unit: str
    frame: str
    topic: str
    method: str
    text: str


@dataclass(frozen=True)
class SourceInfo:
    """What the card says of one source."""

    name: str
    topic: str
    messages: int
    dropped: int  #: stamps that cannot be right
    gap_s: float  #: bound; of states: greatest age
    gaps: int  #: places between samples beyond it
    known_rows: int


@dataclass
class Table:
    """Columns of one length; floats are NaN and texts None where nothing is known."""

    rows: str  #: what a row is
    columns: dict[str, NDArray[Any]] = field(default_factory=dict)
    infos: list[ColumnInfo] = field(default_factory=list)
    sources: list[SourceInfo] = field(default_factory=list)
    absent: list[str] = field(default_factory=list)  #: sources that were not recorded
    notes: list[str] = field(default_factory=list)
    speech: Speech | None = None  #: None: no transcript beside the bag

    def __len__(self) -> int:
        return len(next(iter(self.columns.values()))) if self.columns else 0

    def add(self, info: ColumnInfo, values: NDArray[Any]) -> None:
        """One more column."""
        if info.name in self.columns:
            raise Error(f"two columns of the name {info.name}")
        self.columns[info.name] = values
        self.infos.append(info)


def make_table(session: Session, options: Options | None = None) -> Table:
    """The aligned table of a session. Raises saras.Error when its rows or a topic cannot be read."""
    options = options or Options()
    t, rows, extra = _rows(session, options)
    table = Table(rows)
    start_ns = session.start_ns
    table.add(ColumnInfo("t_s", "s", "", "", "", "time of the row since the first recorded message"), t)
    unix_ns = start_ns + np.round(t * 1e9).astype(np.int64)
    table.add(ColumnInfo("time_unix_ns", "ns", "", "", "", "the same on the recording host's clock"), unix_ns)
    for name, (values, text) in extra.items():
        table.add(ColumnInfo(name, "count", "", "", "", text), values)
    for source in sources():
        recorded = [name for name in source.topics if name in session.topics]
        topic = session.topic(recorded[0]) if recorded else None
        if topic is None:
            table.absent.append(source.name)
        else:
            _add(table, source, topic, t, options)
    table.speech = read_speech(Path(session.path), start_ns)
    if table.speech is None:
        table.absent.append("speech")
    else:
        said, heard = speech_columns(table.speech, t)
        name, outside = table.speech.file, int((~heard).sum())
        table.add(ColumnInfo("speech_text", "", "", name, "while it lasts", "what is being said; null: nothing"), said)
        table.add(ColumnInfo("speech_valid", "bool", "", name, "", "whether the sound was recorded here"), heard)
        if outside:
            table.notes.append(f"{name}: {outside} rows are before or after the sound")
    for info, values in annotation_columns(session.topic("/recorder/annotations"), t, start_ns, table.notes):
        table.add(ColumnInfo(info[0], "", "", "/recorder/annotations", info[1], info[2]), values)
    return table


def _rows(session: Session, options: Options) -> tuple[Floats, str, dict[str, tuple[NDArray[Any], str]]]:
    if options.frame_index is not None:
        stamps_ns, numbers = read_frame_index(options.frame_index)
        t = (stamps_ns - session.start_ns) * 1e-9
        where = f"a frame of {Path(options.frame_index).name}"
        return t, where, {"frame": (numbers, "number of the frame in the video, from 0")}
    wanted = [options.frames] if options.frames is not None else []
    if options.frames is None and options.rate_hz is None:
        wanted = [name for name in FRAME_TOPICS if name in session.topics][:1]
    if wanted:
        if wanted[0].startswith(VIDEO):
            return _video_rows(session, wanted[0], options)
        heads = session.heads(wanted[0])
        if heads is None:
            raise Error(f"{session.path}: {wanted[0]} was not recorded: no frames to make rows of (--rate-hz)")
        order, _ = resample.usable(heads[0], heads[1], options.age_max_s)
        if not len(order):
            raise Error(f"{session.path}: {wanted[0]}: no stamp is within {options.age_max_s} s of its reception")
        return heads[0][order], f"a message of {wanted[0]}", {"frame": (order, "place of the message in its topic")}
    rate_hz = options.rate_hz or USUAL_RATE_HZ
    count = math.floor(session.duration_s * rate_hz * (1 + 1e-12)) + 1
    if count > MOST_ROWS:
        raise Error(f"{session.path}: {count} rows at {rate_hz} Hz: must be <= {MOST_ROWS}")
    return np.arange(count) / rate_hz, f"every {1e3 / rate_hz:g} ms", {}


def _video_rows(session: Session, name: str, options: Options) -> tuple[Floats, str, dict[str, Any]]:
    """Frames of the video beside the bag, with the other eye's frame of the same instant."""
    topic = session.topic(name)
    if topic is None:
        raise Error(f"{session.path}: {name} was not recorded: no frames to make rows of (--rate-hz)")
    order, _ = resample.usable(topic.t, topic.t_received, options.age_max_s)
    t = topic.t[order]
    if not len(t):
        raise Error(f"{session.path}: {name}: no stamp is within {options.age_max_s} s of its reception")
    files = np.array([str(file) for file in topic["file"][order]], dtype=object)
    extra: dict[str, Any] = {
        "frame": (topic["frame"][order], "number of the frame in its video, from 0"),
        "video": (files, "file of the video"),
    }
    side = name.removeprefix(VIDEO)
    other = {"left": "right", "right": "left"}.get(side, "")
    second = session.topic(VIDEO + other)
    if second is not None:
        where, _ = resample.usable(second.t, second.t_received, options.age_max_s)
        extra[f"frame_{other}"] = (
            _nearest(second.t[where], second["frame"][where].astype(float), t),
            f"number of the {other} eye's nearest frame, within half a frame; NaN: none",
        )
    return t, f"a frame of the {side} video", extra


def _nearest(t: Floats, values: Floats, at: Floats) -> Floats:
    if not len(t):
        return np.full(len(at), np.nan)
    right = np.clip(np.searchsorted(t, at), 0, len(t) - 1)
    left = np.maximum(right - 1, 0)
    place = np.where(np.abs(t[left] - at) <= np.abs(t[right] - at), left, right)
    bound_s = 0.5 * float(np.median(np.diff(t))) if len(t) > 1 else 0.02
    return np.where(np.abs(t[place] - at) <= bound_s, values[place], np.nan)


def read_frame_index(path: str | Path) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Unix stamps [ns] and numbers of the frames of a video, in order of the stamps.

    A CSV with a head; ``stamp_ns`` (integers) or ``stamp_s``, and ``frame`` when a row is not the next frame.
    """
    try:
        with Path(path).open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        if rows and "stamp_ns" in rows[0]:
            stamps = np.array([int(row["stamp_ns"]) for row in rows], dtype=np.int64)
        else:
            # Digits are split by hand: a float64 holds unix time to a quarter of a microsecond only.
            parts = [row["stamp_s"].partition(".") for row in rows]
            stamps = np.array([int(a) * 10**9 + int((b + "0" * 9)[:9]) for a, _, b in parts], dtype=np.int64)
        numbers = np.array([int(row.get("frame") or place) for place, row in enumerate(rows)], dtype=np.int64)
    except (KeyError, ValueError, TypeError, UnicodeDecodeError, csv.Error) as error:
        raise Error(f"{path}: no index of frames (a CSV with stamp_ns or stamp_s, and frame): {error}") from error
    if not len(stamps):
        raise Error(f"{path}: the index of frames is empty")
    order = np.argsort(stamps, kind="stable")
    return stamps[order], numbers[order]


def _add(table: Table, source: Source, topic: Topic, at: Floats, options: Options) -> None:
    try:
        samples = source.read(topic)
    except (Error, ValueError, TypeError, AttributeError) as error:
        table.notes.append(f"{source.name}: left out: {error}")
        table.absent.append(source.name)
        return
    order, dropped = resample.usable(topic.t, topic.t_received, options.age_max_s)
    t = topic.t[order]
    gap_s = source.age_max_s or resample.default_gap_s(t, options.gap_periods, options.gap_least_s)
    if dropped:
        table.notes.append(f"{topic.name}: {dropped} of {len(topic)} stamps are no times of this session: left out")
    known = _interpolated(table, source, topic.name, samples, (t, order, at, gap_s))
    info = ColumnInfo(f"{source.name}_valid", "bool", "", topic.name, "", f"whether {source.name} is known here")
    table.add(info, known)
    gaps = int((np.diff(t) > gap_s).sum())
    table.sources.append(SourceInfo(source.name, topic.name, len(topic), dropped, gap_s, gaps, int(known.sum())))


def _interpolated(
    table: Table, source: Source, topic: str, samples: Samples, times: tuple[Floats, NDArray[np.int64], Floats, float]
) -> NDArray[np.bool_]:
    t, order, at, gap_s = times
    known = np.ones(len(at), dtype=bool)
    age_s: Floats | None = None
    for columns, values in samples.blocks:
        method = columns[0].method
        if method in (LINEAR, SLERP):
            change = resample.linear if method == LINEAR else resample.slerp
            result, valid = change(t, values[order].astype(float), at, gap_s)
            if method == SLERP:
                result = resample.continuous(result)
            # One unknown part makes the source unknown there, all-NaN columns (a joint that is not measured) do not.
            measured = ~np.isnan(values).all(axis=0) if len(values) else np.zeros(values.shape[1], dtype=bool)
            known &= valid & ~np.isnan(result[:, measured]).any(axis=1) & bool(measured.any())
        else:
            place, age_s, valid = resample.previous(t, at, gap_s)
            known &= valid
            unknown: Any = math.nan if method == PREVIOUS else None
            result = np.full((len(at), values.shape[1]), unknown, dtype=float if method == PREVIOUS else object)
            if len(t):
                result[valid] = values[order][place[valid]]
        for number, column in enumerate(columns):
            info = ColumnInfo(column.name, column.unit, samples.frame, topic, method, source.text)
            table.add(info, np.ascontiguousarray(result[:, number]))
    if age_s is not None:
        info = ColumnInfo(f"{source.name}_age_s", "s", "", topic, "", f"time since the last message of {source.name}")
        table.add(info, age_s)
    return known
