"""When which sample of a sound file was taken: the index beside it. Needs no GStreamer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import numpy.typing as npt

from saras import Error

INDEX_HEAD = "sample,stamp_ns\n"


class SoundError(Error):
    """Nothing can be heard, or the file cannot be written; the text says why."""


def index_path(sound: Path) -> Path:
    """Of the index beside a sound file: sample, stamp_ns."""
    return sound.with_suffix(".samples.csv")


def rate_hz(sound: Path) -> int:
    """Samples a second, as the FLAC file says (its STREAMINFO, 20 bits). Raises SoundError, OSError."""
    with sound.open("rb") as file:
        head = file.read(22)
    rate = int.from_bytes(head[18:21], "big") >> 4
    if len(head) < 22 or head[:4] != b"fLaC" or head[4] & 0x7F or not rate:
        raise SoundError(f"{sound}: no FLAC file")
    return rate


def read_index(sound: Path) -> npt.NDArray[np.int64]:
    """(n, 2) sample, stamp_ns of a sound's index, n >= 2; a last line that was cut is left out. Raises SoundError."""
    lines = index_path(sound).read_text(encoding="utf-8").split("\n")
    if lines[0] + "\n" != INDEX_HEAD or len(lines) < 4:
        raise SoundError(f"{index_path(sound)}: no index of samples")
    return np.array([[int(cell) for cell in line.split(",")] for line in lines[1:-1]], dtype=np.int64)


def times_ns(sound: Path, samples: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """When samples (by number in the file) were taken, nanoseconds since the epoch: between the index's entries."""
    table = read_index(sound)
    numbers, stamps = table[:, 0].astype(float), table[:, 1] - table[0, 1]
    asked = np.asarray(samples, dtype=float)
    found = np.interp(asked, numbers, stamps)
    rate = (stamps[-1] - stamps[0]) / (numbers[-1] - numbers[0])  # beyond the last chunk's begin: on at its pace
    found = np.where(asked > numbers[-1], stamps[-1] + rate * (asked - numbers[-1]), found)
    whole: npt.NDArray[np.int64] = np.round(found).astype(np.int64) + table[0, 1]
    return whole


__all__ = ["INDEX_HEAD", "SoundError", "index_path", "rate_hz", "read_index", "times_ns"]
