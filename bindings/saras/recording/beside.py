"""Whether videos and sound beside a bag are whole: every picture of the camera one frame, every sample heard."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from saras import Error
from saras.capture.sound_index import read_index as read_sound_index
from saras.capture.video_file import index_path, read_index
from saras.recording.bag import Bag
from saras.recording.completeness import BAD, UNKNOWN, Finding, lost_by_sequence
from saras.recording.survey import Integers

SIDES = ("left", "right")
GAP_S = 0.1


def beside(bag: Path, ending: str) -> Path:
    """The file NAME_ending that was recorded beside NAME.bag; also of NAME.bag.active and NAME.repaired.bag."""
    stem = bag.name.removesuffix(".active").removesuffix(".bag").removesuffix(".repaired")
    return bag.with_name(f"{stem}_{ending}")


@dataclass
class Beside:
    """What was found."""

    lines: list[str] = field(default_factory=list)
    """one a file, for a person"""
    findings: list[Finding] = field(default_factory=list)
    """all that is not good"""

    def add(self, grade: str, name: str, what: str, text: str, value: float | None = None) -> None:
        """One finding about the file `name`."""
        self.findings.append(Finding(grade, name, what, text, value))


def check_beside(bag: Path, decode: bool = True) -> Beside:
    """decode: also every frame and sample; else their indices alone. Files that are not there and not in the bag are
    no finding.
    """
    found = Beside()
    videos = {side: beside(bag, f"{side}.mkv") for side in SIDES}
    try:
        announced = _announced(bag)
    except Error:
        announced = {}
        if any(video.exists() for video in videos.values()):
            found.add(UNKNOWN, "", "video", "not compared with the bag, which was not closed: saras bag repair")
    for side, video in videos.items():
        frames = announced.get(side)
        if video.exists() or index_path(video).exists():
            _video(video, frames, decode, found)
        elif frames is not None:
            found.add(BAD, video.name, "video", f"missing; the bag names {len(frames)} frames of it", len(frames))
    sound = beside(bag, "audio.flac")
    if sound.exists():
        _sound(sound, decode, found)
    return found


def _announced(path: Path) -> dict[str, Integers]:
    """Of each side (n, 2): frame and stamp_ns, as the bag has them. Raises Error: the bag was not closed."""
    bag, rows = Bag(path), {}
    try:
        for side in SIDES:
            topic = bag.topic(f"/recorder/video/{side}")
            if topic is not None:
                sec, nanosec = (topic[f"header.stamp.{part}"].astype(np.int64) for part in ("sec", "nanosec"))
                rows[side] = np.column_stack([topic["frame"].astype(np.int64), sec * 1_000_000_000 + nanosec])
    finally:
        bag.close()
    return rows


def _video(video: Path, announced: Integers | None, decode: bool, found: Beside) -> None:
    try:
        index = read_index(video)
    except (Error, OSError, ValueError) as error:
        found.add(BAD, video.name, "video", f"its index cannot be read: {error}")
        return
    lost, restarts = lost_by_sequence(index[:, 2])
    text = f"{video.name}: {len(index)} pictures of the camera, {lost} lost on the way"
    if lost:
        found.add(BAD, video.name, "lost", f"{lost} of {lost + len(index)} pictures lost before the video", lost)
    if restarts:
        found.add(UNKNOWN, video.name, "lost", f"the camera began to count anew {restarts} times")
    if announced is not None:
        inside = announced[announced[:, 0] < len(index)]
        wrong = int((index[inside[:, 0], 1] != inside[:, 1]).sum()) + len(announced) - len(inside)
        if wrong:
            found.add(BAD, video.name, "video", f"{wrong} frames have another stamp in the bag", wrong)
        named = np.unique(inside[:, 0])
        # The bag's recorder subscribes a little after the video began, and ends with it.
        missing = int(named[-1] - named[0] + 1 - len(named)) if len(named) else 0
        if missing:
            found.add(BAD, video.name, "video", f"{missing} frames in between are not named in the bag", missing)
        text += f", {len(named)} named in the bag"
    if decode:
        shown = _frames(video)
        if shown is None:
            found.add(UNKNOWN, video.name, "video", "not decoded: needs OpenCV (python3-opencv)")
        else:
            text += f", {shown} frames decode"
            if shown != len(index):
                grade_text = f"{shown} frames decode, {len(index)} in its index"
                found.add(BAD, video.name, "video", grade_text, abs(shown - len(index)))
    found.lines.append(text)


def _frames(video: Path) -> int | None:
    try:
        import cv2
    except ImportError:
        return None
    film, count = cv2.VideoCapture(str(video)), 0
    while film.read()[0]:
        count += 1
    return count


def _sound(sound: Path, decode: bool, found: Beside) -> None:
    try:
        index = read_sound_index(sound)
    except (Error, OSError, ValueError) as error:
        found.add(BAD, sound.name, "sound", f"its index cannot be read: {error}")
        return
    samples, stamps = np.diff(index[:, 0]), 1e-9 * np.diff(index[:, 1])
    usual = float(np.median(stamps / np.maximum(samples, 1))) if len(samples) else 0.0
    gaps = stamps - samples * usual
    silent = gaps > GAP_S
    text = f"{sound.name}: {1e-9 * (index[-1, 1] - index[0, 1]):.1f} s of sound, {int(silent.sum())} gaps"
    if silent.any():
        longest = float(gaps.max())
        found.add(BAD, sound.name, "lost", f"{int(silent.sum())} gaps, the longest {longest:.2f} s", longest)
    if decode:
        from saras.capture.pulled_pipeline import NoGStreamerError
        from saras.capture.sound import read_sound

        try:
            count = len(read_sound(sound))
        except NoGStreamerError as error:
            found.add(UNKNOWN, sound.name, "sound", f"not decoded: {error}")
        except Error as error:
            found.add(BAD, sound.name, "sound", str(error))
        else:
            last = int(index[-1, 0] + (np.median(samples) if len(samples) else 0))
            text += f", {count} samples decode"
            if count < index[-1, 0]:
                found.add(BAD, sound.name, "sound", f"{count} samples decode, {last} in its index", last - count)
    found.lines.append(text)


__all__ = ["Beside", "beside", "check_beside"]
