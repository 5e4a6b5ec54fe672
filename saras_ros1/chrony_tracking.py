"""What chrony says of this computer's own clock: `chronyc -c tracking`."""

from __future__ import annotations

import math
import subprocess
from collections.abc import Sequence
from typing import NamedTuple

ANSWER_S = 3.0
_FIELDS = 14
_NORMAL = ("Normal", "Insert second", "Delete second")


class Tracking(NamedTuple):
    """Of this computer's clock. offset_s NaN: unknown, and why."""

    offset_s: float
    """of the clock before its source, as chrony estimates it now; positive: it is ahead"""
    rms_s: float = math.nan
    """of the offsets at the last measurements"""
    error_s: float = math.nan
    """bound of the error against the primary source: root dispersion and half of the root delay"""
    source: str = ""
    stratum: int = 0
    why: str = ""


def unknown(why: str) -> Tracking:
    """Nothing is known of the clock."""
    return Tracking(math.nan, why=why)


def parse(text: str) -> Tracking:
    """One line as `chronyc -c tracking` prints it (chrony 4): 14 values, times in seconds, the system's offset positive
    when it is slow.
    """
    cells = text.strip().split(",")
    if len(cells) != _FIELDS:
        return unknown(f"chronyc said {text.strip()[:60]!r}")
    try:
        stratum = int(cells[2])
        system_s, rms_s, delay_s, dispersion_s = (float(cells[i]) for i in (4, 6, 10, 11))
    except ValueError:
        return unknown(f"chronyc said {text.strip()[:60]!r}")
    name = cells[1] or cells[0]
    if cells[13] not in _NORMAL or not all(map(math.isfinite, (system_s, rms_s, delay_s, dispersion_s))):
        return unknown(f"chrony follows no time source: {cells[13]}")
    return Tracking(-system_s, rms_s, dispersion_s + 0.5 * delay_s, name, stratum)


def ask(chronyc: Sequence[str] = ("chronyc",)) -> Tracking | None:
    """Asks chronyd on this computer. chronyc: the program and its options. None: there is no chrony here."""
    command = [*chronyc, "-c", "tracking"]
    try:
        said = subprocess.run(command, text=True, capture_output=True, check=False, timeout=ANSWER_S)
    except (FileNotFoundError, PermissionError):
        return None
    except (OSError, subprocess.SubprocessError) as error:
        return unknown(f"chronyc does not answer ({type(error).__name__})")
    if said.returncode != 0:
        return unknown((said.stdout + said.stderr).strip() or f"chronyc ended with code {said.returncode}")
    return parse(said.stdout)


def beyond(tracking: Tracking, limit_s: float) -> bool:
    """Whether the clock is, or was at the last measurements, further off than limit_s; unknown: False."""
    return abs(tracking.offset_s) > limit_s or tracking.rms_s > limit_s


def words(tracking: Tracking) -> str:
    """One line for a person."""
    if math.isnan(tracking.offset_s):
        return f"unknown: {tracking.why}"
    offset_ms, rms_ms = 1e3 * tracking.offset_s, 1e3 * tracking.rms_s
    return f"{offset_ms:+.3f} ms against {tracking.source} (rms {rms_ms:.3f} ms)"
