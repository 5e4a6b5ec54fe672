"""Nominal trajectory of each tool: mean and spread of many executions on one phase from 0 to 1.

Executions are the stretches of one annotated action, else the whole engaged part of a session. Phases are aligned
simply, without dynamic time warping: ``time`` divides an execution evenly in time; ``path`` by the share of the path
travelled, so that pauses and speed do not matter, yet what was done while standing still is squeezed into one phase.
Neither moves features of one execution onto those of another: where executions differ, the spread says so.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError
from saras.dataset import resample

Floats = NDArray[np.float64]
TOOLS = ("mesa_left", "mesa_right", "PSM1", "PSM2", "ECM")
PHASES = 101
_FEWEST = 10  # rows that make an execution
_LEAST_PATH_M = 1e-3


@dataclass(frozen=True)
class Execution:
    """One stretch of one tool; arrays over its rows."""

    tool: str
    label: str  #: of the annotated action; empty: the whole session
    t: Floats  #: (n,) [s]
    position: Floats  #: (n, 3) [m]
    quaternion: Floats  #: (n, 4) x y z w


@dataclass(frozen=True)
class Nominal:
    """Mean and spread of the executions of one tool and action; arrays over the phase."""

    tool: str
    label: str
    executions: int
    known: NDArray[np.int64]  #: (p,) executions without a gap there
    phase: Floats  #: (p,) 0 to 1
    position: Floats  #: (p, 3) mean [m]
    position_std: Floats  #: (p, 3) standard deviation [m]; NaN of a single execution
    quaternion: Floats  #: (p, 4) mean rotation
    rotation_std: Floats  #: (p,) root mean square angle from the mean [rad]; NaN of a single execution
    duration_s: float  #: mean


def executions(columns: Mapping[str, NDArray[Any]]) -> list[Execution]:
    """Stretches of one session's table; rows without a known pose are left out of them."""
    found = []
    t = np.asarray(columns["t_s"], dtype=float)
    action = columns.get("annotation_action", np.full(len(t), None, dtype=object))
    annotated = any(label is not None for label in action)
    for tool in TOOLS:
        names = [f"{tool}_tip_{part}" for part in ("x_m", "y_m", "z_m", "qx", "qy", "qz", "qw")]
        if any(name not in columns for name in names):
            continue
        pose = np.stack([np.asarray(columns[name], dtype=float) for name in names], axis=1)
        known = np.isfinite(pose).all(axis=1)
        state = columns.get(f"{tool}_state")
        engaged = np.array([word == "ENGAGED" for word in state]) if state is not None else np.ones(len(t), dtype=bool)
        labels = [(label or None) if annotated else "" for label in action]
        for start, stop in _stretches(engaged, labels):
            rows = start + np.flatnonzero(known[start:stop])
            if len(rows) >= _FEWEST:
                found.append(Execution(tool, str(labels[start]), t[rows], pose[rows, :3], pose[rows, 3:]))
    return found


def _stretches(wanted: NDArray[np.bool_], labels: list[str | None]) -> Iterable[tuple[int, int]]:
    start: int | None = None
    for row in range(len(wanted) + 1):
        inside = row < len(wanted) and bool(wanted[row]) and labels[row] is not None
        if start is not None and (not inside or labels[row] != labels[start]):
            yield start, row
            start = None
        if inside and start is None:
            start = row


def phase_of(execution: Execution, by: str) -> Floats | None:
    """(n,) phase of each row, 0 to 1; None when the tool did not move enough for a phase by path."""
    if by == "time":
        return np.asarray((execution.t - execution.t[0]) / (execution.t[-1] - execution.t[0]))
    if by == "path":
        path = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(execution.position, axis=0), axis=1)))
        return path / path[-1] if path[-1] > _LEAST_PATH_M else None
    raise ConfigError(f"phase = {by!r}: must be time or path")


def nominal(found: Iterable[Execution], by: str = "time", phases: int = PHASES) -> list[Nominal]:
    """One a tool and action, in order of tool and label."""
    groups: dict[tuple[str, str], list[tuple[Execution, Floats, Floats]]] = {}
    grid = np.linspace(0.0, 1.0, phases)
    for execution in found:
        phase = phase_of(execution, by)
        if phase is None:
            continue
        keep = np.append(np.diff(phase) > 0, True)
        position, _ = resample.linear(phase[keep], execution.position[keep], grid, np.inf)
        rotation, _ = resample.slerp(phase[keep], execution.quaternion[keep], grid, np.inf)
        # Nor here across a gap.
        when = np.interp(grid, phase[keep], execution.t[keep])
        gap = ~resample.brackets(execution.t, when, resample.default_gap_s(execution.t))[2]
        position[gap], rotation[gap] = np.nan, np.nan
        groups.setdefault((execution.tool, execution.label), []).append((execution, position, rotation))
    return [_nominal(key, rows, grid) for key, rows in sorted(groups.items())]


def _nominal(key: tuple[str, str], rows: list[tuple[Execution, Floats, Floats]], grid: Floats) -> Nominal:
    position = np.stack([row[1] for row in rows])
    rotation = np.stack([row[2] for row in rows])
    known = np.isfinite(position).all(axis=2).sum(axis=0)
    mean = resample.continuous(mean_rotation(rotation))
    cosine = np.clip(np.abs(np.sum(rotation * mean, axis=2)), 0.0, 1.0)
    angle = np.nansum((2.0 * np.arccos(cosine)) ** 2, axis=0)
    # Where one execution or none is known, the divisions give the NaN that is due.
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = np.nansum(position, axis=0) / known[:, None]
        centre[known == 0] = np.nan
        spread = np.nansum((position - centre) ** 2, axis=0)
        fewer = np.where(known > 1, known - 1, np.nan)
        position_std, rotation_std = np.sqrt(spread / fewer[:, None]), np.sqrt(angle / fewer)
    durations = [row[0].t[-1] - row[0].t[0] for row in rows]
    return Nominal(
        key[0],
        key[1],
        len(rows),
        known,
        grid,
        centre,
        position_std,
        mean,
        rotation_std,
        float(np.mean(durations)),
    )


def mean_rotation(quaternions: Floats) -> Floats:
    """(p, 4) of (m, p, 4), NaN left out: the largest eigenvector of the mean of q qᵀ (Markley et al. 2007)."""
    known = np.isfinite(quaternions).all(axis=2)
    present = np.where(known[:, :, None], quaternions, 0.0)
    mean = np.linalg.eigh(np.einsum("mpi,mpj->pij", present, present))[1][:, :, -1]
    mean = np.where(mean[:, 3:] < 0, -mean, mean)
    mean[~known.any(axis=0)] = np.nan
    return np.asarray(mean)
