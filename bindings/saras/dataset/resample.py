"""Values of a recorded series at other times; never across a gap.

All functions take ``t`` (n,) [s], ascending, and ``at`` (m,) [s]; ``gap_s`` bounds the time between the two samples
around an instant (or, for ``previous``, the age of the sample before it). Beyond it the result is NaN and not valid.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]
Indices = NDArray[np.int64]


def usable(t: Floats, t_received: Floats, age_max_s: float) -> tuple[Indices, int]:
    """Order of the samples by stamp, without those whose stamp cannot be right, and how many these are.

    Left out: a stamp further than ``age_max_s`` from its reception (a clock that stepped), and all but the last sample
    of one stamp (these are no error and not counted).
    """
    age = t_received - t
    plausible = np.flatnonzero(np.isfinite(age) & (np.abs(age) <= age_max_s))
    order = plausible[np.argsort(t[plausible], kind="stable")]
    last = np.append(np.diff(t[order]) > 0, True) if len(order) else np.zeros(0, dtype=bool)
    return order[last], len(t) - len(plausible)


def default_gap_s(t: Floats, periods: float = 5.0, least_s: float = 0.05) -> float:
    """A bound for a series of one rate: a few of its median periods."""
    return max(least_s, periods * float(np.median(np.diff(t)))) if len(t) > 1 else least_s


def brackets(t: Floats, at: Floats, gap_s: float) -> tuple[Indices, Floats, Flags]:
    """Index of the sample before each instant, share of the way to the next in [0, 1], whether that is valid."""
    if len(t) == 0:
        return np.zeros(len(at), dtype=np.int64), np.zeros(len(at)), np.zeros(len(at), dtype=bool)
    before = np.searchsorted(t, at, side="right") - 1
    inside = np.clip(before, 0, max(len(t) - 2, 0))
    after = np.minimum(inside + 1, len(t) - 1)
    width = t[after] - t[inside]
    share = np.clip((at - t[inside]) / np.where(width > 0, width, 1.0), 0.0, 1.0)
    exact = (at == t[np.clip(before, 0, len(t) - 1)]) & (before >= 0)
    valid = exact | ((before >= 0) & (before < len(t) - 1) & (width <= gap_s))
    return inside, share, valid


def linear(t: Floats, values: Floats, at: Floats, gap_s: float) -> tuple[Floats, Flags]:
    """(m, k) of (n, k): on the straight line between the samples around."""
    result = np.full((len(at), values.shape[1]), np.nan)
    low, share, valid = brackets(t, at, gap_s)
    if len(t):
        a, b = values[low], values[np.minimum(low + 1, len(t) - 1)]
        share = share[:, None]
        # The end of a bracket may be NaN (unknown) without the exact sample being so.
        mixed = np.where(share == 0.0, a, np.where(share == 1.0, b, a + share * (b - a)))
        result[valid] = mixed[valid]
    return result, valid


def slerp(t: Floats, quaternions: Floats, at: Floats, gap_s: float) -> tuple[Floats, Flags]:
    """(m, 4) unit quaternions x y z w of (n, 4): at constant angular velocity along the shorter arc (Shoemake 1985).

    Samples off the unit sphere by more than 1e-3 count as unknown. Signs are those of w >= 0.
    """
    result = np.full((len(at), 4), np.nan)
    low, share, valid = brackets(t, at, gap_s)
    if len(t) == 0:
        return result, valid
    norm = np.linalg.norm(quaternions, axis=1, keepdims=True)
    unit = np.where(np.abs(norm - 1.0) < 1e-3, quaternions / np.where(norm > 0, norm, 1.0), np.nan)
    a, b = unit[low], unit[np.minimum(low + 1, len(t) - 1)]
    cosine = np.sum(a * b, axis=1, keepdims=True)
    b = np.where(cosine < 0, -b, b)
    # From the half angle's sine and cosine: acos alone is blind near zero.
    angle = 2.0 * np.arctan2(np.linalg.norm(b - a, axis=1, keepdims=True), np.linalg.norm(a + b, axis=1, keepdims=True))
    share = share[:, None]
    sine = np.sin(angle)
    small = sine < 1e-12
    sine = np.where(small, 1.0, sine)
    wa = np.where(small, 1.0 - share, np.sin((1.0 - share) * angle) / sine)
    wb = np.where(small, share, np.sin(share * angle) / sine)
    mixed = np.where(share == 0.0, a, np.where(share == 1.0, b, wa * a + wb * b))
    mixed = mixed / np.linalg.norm(mixed, axis=1, keepdims=True)
    mixed = np.where(mixed[:, 3:] < 0, -mixed, mixed)
    result[valid] = mixed[valid]
    return result, valid


def continuous(quaternions: Floats) -> Floats:
    """(m, 4) with each sign nearest to the known one before it: q and -q are one rotation, yet far apart as numbers."""
    known = np.flatnonzero(np.isfinite(quaternions).all(axis=1))
    result = quaternions.copy()
    if len(known) > 1:
        towards = np.sum(quaternions[known[1:]] * quaternions[known[:-1]], axis=1)
        result[known[1:]] *= np.cumprod(np.where(towards < 0, -1.0, 1.0))[:, None]
    return result


def previous(t: Floats, at: Floats, age_max_s: float) -> tuple[Indices, Floats, Flags]:
    """Index of the newest sample at or before each instant, its age [s] (NaN: none yet), whether it is valid."""
    index = np.searchsorted(t, at, side="right") - 1
    known = index >= 0
    place = np.clip(index, 0, max(len(t) - 1, 0))
    age = np.where(known, at - t[place], np.nan) if len(t) else np.full(len(at), np.nan)
    return place, age, known & (np.nan_to_num(age, nan=np.inf) <= age_max_s)
