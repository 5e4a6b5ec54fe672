"""How well picture, motion and sound of a recording are aligned, measured at claps whose true time is known.

The claps of a simulation begin at each full second of the recording host's clock (saras.sim.clap): both eyes of the
endoscope flash, an arm jumps, the microphone beeps. A source shows an event between two of its samples, the last one
without and the first one with it; how far the true time lies outside of that is the error of the source's times.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import Error
from saras.recording.bag import Bag
from saras.recording.beside import beside
from saras.sim.clap import SECOND_NS

Times = npt.NDArray[np.int64]
Floats = npt.NDArray[np.float64]

QUIET_NS = 300_000_000
#: Least difference between with and without: grey levels, m, of 32767.
LEAST = {"picture": 20.0, "motion": 1e-3, "sound": 1000.0}
#: A source that ends or begins is not asked about claps so near to it.
MARGIN_NS = 500_000_000


@dataclass(frozen=True)
class Onsets:
    """One source: when it shows a clap. (n,) nanoseconds since the epoch."""

    name: str
    before_ns: Times
    """last sample without it"""
    at_ns: Times
    """first sample with it"""
    span_ns: tuple[int, int]
    """first and last sample of the source"""


@dataclass(frozen=True)
class Alignment:
    """Of all claps within every source's span. Arrays are (claps, sources); NaN: the source does not show this one."""

    names: list[str]
    late_s: Floats
    """first sample with the clap, minus the true time: sampling is in it"""
    error_s: Floats
    """how far the true time lies outside of the two samples between which the source shows the clap"""
    frame_s: float
    """usual time between two pictures"""

    @property
    def apart_s(self) -> Floats:
        """(claps,) between the first and the last source that shows a clap; NaN: not all show it."""
        return np.asarray(self.late_s.max(axis=1) - self.late_s.min(axis=1))

    @property
    def known(self) -> bool:
        """Whether at least half of the claps are seen by all sources: with less there is no answer."""
        seen = np.isfinite(self.late_s).all(axis=1)
        return bool(len(seen) and seen.mean() >= 0.5)

    @property
    def within_a_frame(self) -> bool:
        """Whether that is known, and no source is wrong by more than a picture."""
        return self.known and bool(np.nanmax(self.error_s) <= self.frame_s)

    def facts(self) -> dict[str, Any]:
        """For JSON: milliseconds; by source: claps seen, mean and largest of late_s, largest of error_s."""
        sources = {}
        for column, name in enumerate(self.names):
            late, error = self.late_s[:, column], self.error_s[:, column]
            known = np.isfinite(late)
            late_ms, error_ms = 1e3 * late[known], 1e3 * error[known]
            sources[name] = {
                "seen": int(known.sum()),
                "late_mean_ms": float(late_ms.mean()) if len(late_ms) else None,
                "late_worst_ms": float(late_ms[np.argmax(np.abs(late_ms))]) if len(late_ms) else None,
                "error_worst_ms": float(error_ms.max()) if len(error_ms) else None,
            }
        apart = self.apart_s[np.isfinite(self.apart_s)]
        return {
            "claps": len(self.late_s),
            "seen_by_all": len(apart),
            "frame_ms": 1e3 * self.frame_s,
            "apart_median_ms": 1e3 * float(np.median(apart)) if len(apart) else None,
            "apart_worst_ms": 1e3 * float(apart.max()) if len(apart) else None,
            "within_a_frame": self.within_a_frame if self.known else None,
            "sources": sources,
        }

    def lines(self) -> list[str]:
        """For a person."""
        facts = self.facts()
        head = f"{'':<10} {'seen':>5} {'late: mean':>11} {'worst':>8} {'wrong by':>9}  [ms]"
        rows = [f"{facts['claps']} claps, a picture every {facts['frame_ms']:.1f} ms", head]
        for name, one in facts["sources"].items():
            numbers = [one[key] for key in ("late_mean_ms", "late_worst_ms", "error_worst_ms")]
            mean, worst, error = ("?" if number is None else f"{number:.2f}" for number in numbers)
            rows.append(f"{name:<10} {one['seen']:>5} {mean:>11} {worst:>8} {error:>9}")
        if facts["seen_by_all"]:
            text = f"median {facts['apart_median_ms']:.1f} ms, at most {facts['apart_worst_ms']:.1f} ms"
            rows.append(f"first to last source, sampling included: {text} ({facts['seen_by_all']} claps seen by all)")
        if not self.known:
            rows.append("unknown: fewer than half of the claps are seen by all")
        else:
            rows.append(f"{'aligned' if self.within_a_frame else 'not aligned'} within one picture")
        return rows


def onsets(name: str, kind: str, times_ns: npt.ArrayLike, levels: npt.ArrayLike) -> Onsets:
    """Where levels (n,) rise above the middle, after having been below for QUIET_NS. kind: a key of LEAST.

    Raises Error: there is no such rise.
    """
    times, values = np.asarray(times_ns, dtype=np.int64), np.asarray(levels, dtype=float)
    low, high = np.percentile(values, [5.0, 99.0]) if len(values) else (0.0, 0.0)
    if not high - low >= LEAST[kind]:
        raise Error(f"{name}: no clap in it: was the session recorded with claps:=true?")
    with_it = np.flatnonzero(values > 0.5 * (low + high))
    quiet = np.diff(times[with_it], prepend=times[0] - QUIET_NS) >= QUIET_NS
    first = with_it[quiet]
    first = first[first > 0]
    return Onsets(name, times[first - 1], times[first], (int(times[0]), int(times[-1])))


def align(sources: list[Onsets], frame_s: float) -> Alignment:
    """At each full second that all sources have."""
    begin = max(source.span_ns[0] for source in sources) + MARGIN_NS
    end = min(source.span_ns[1] for source in sources) - MARGIN_NS
    truth = np.arange(-(-begin // SECOND_NS) * SECOND_NS, end, SECOND_NS, dtype=np.int64)
    late = np.full((len(truth), len(sources)), np.nan)
    error = late.copy()
    for column, source in enumerate(sources):
        for row, true_ns in enumerate(truth):
            near = np.flatnonzero(np.abs(source.at_ns - true_ns) < SECOND_NS // 2)
            if len(near):
                i = near[0]
                late[row, column] = 1e-9 * (source.at_ns[i] - true_ns)
                error[row, column] = 1e-9 * max(0, true_ns - source.at_ns[i], source.before_ns[i] - true_ns)
    return Alignment([source.name for source in sources], late, error, frame_s)


def measure(bag: Path, arm: str = "PSM1") -> Alignment:
    """Of a bag with videos and sound beside it. Raises Error naming what is missing."""
    from saras.capture.sound import read_sound
    from saras.capture.sound_index import times_ns
    from saras.capture.video_file import read_index

    sources, frame_s = [], float("nan")
    for side in ("left", "right"):
        video = _there(beside(bag, f"{side}.mkv"))
        stamps = read_index(video)[:, 1]
        shown = brightness(video)
        if len(shown) > len(stamps):
            raise Error(f"{video}: {len(shown)} frames, {len(stamps)} in its index")
        frame_s = 1e-9 * float(np.median(np.diff(stamps))) if side == "left" else frame_s
        sources.append(onsets(f"{side} eye", "picture", stamps[: len(shown)], shown))
    sources.append(_motion(bag, arm))
    sound = _there(beside(bag, "audio.flac"))
    loud = np.abs(read_sound(sound)[:, 0].astype(float))
    sources.append(onsets("sound", "sound", times_ns(sound, np.arange(len(loud))), loud))
    return align(sources, frame_s)


def brightness(video: Path) -> Floats:
    """(n,) mean grey of each frame."""
    try:
        import cv2
    except ImportError:
        raise Error("decoding a video needs OpenCV: apt-get install python3-opencv") from None
    film, found = cv2.VideoCapture(str(video)), list[float]()
    while True:
        good, pixels = film.read()
        if not good:
            return np.array(found)
        found.append(float(pixels[::4, ::4].mean()))


def _motion(path: Path, arm: str) -> Onsets:
    bag = Bag(path)
    try:
        topic = bag.topic(f"/{arm}/measured_cp")
        if topic is None:
            raise Error(f"{path}: nothing of /{arm}/measured_cp")
        stamps = np.round(1e9 * topic.t).astype(np.int64) + bag.start_ns
        points = np.column_stack([topic[f"pose.position.{axis}"] for axis in "xyz"])
    finally:
        bag.close()
    return onsets(arm, "motion", stamps, np.linalg.norm(points - np.median(points, axis=0), axis=1))


def _there(path: Path) -> Path:
    if not path.exists():
        raise Error(f"{path}: missing; a session with claps:=true has videos and sound beside its bag")
    return path


__all__ = ["Alignment", "Onsets", "align", "brightness", "measure", "onsets"]
