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
    phase: Floats  #: (p,) 0 to 1
    position: Floats  #: (p, 3) mean [m]
    position_std: Floats  #: (p, 3) standard deviation [m]; NaN of a single execution
    quaternion: Floats  #: (p, 4) mean rotation
    rotation_std: Floats  #: (p,) root mean square angle from the mean [rad]; NaN of a single execution
    duration_s: float  #: mean


def executions(columns: Mapping[str, NDArray[Any]]) -> list[Execution]:
    """Stretches of one session's table without an unknown row."""
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
        if state is not None:
            known &= np.array([word == "ENGAGED" for word in state], dtype=bool)
        labels = [(label or None) if annotated else "" for label in action]
        for start, stop in _stretches(known, labels):
            if stop - start >= _FEWEST:
                rows = slice(start, stop)
                found.append(Execution(tool, str(labels[start]), t[rows], pose[rows, :3], pose[rows, 3:]))
    return found


def _stretches(known: NDArray[np.bool_], labels: list[str | None]) -> Iterable[tuple[int, int]]:
    start: int | None = None
    for row in range(len(known) + 1):
        inside = row < len(known) and bool(known[row]) and labels[row] is not None
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
        # The first row may have been dropped for one of the same phase.
        groups.setdefault((execution.tool, execution.label), []).append((execution, position, rotation))
    return [_nominal(key, rows, grid) for key, rows in sorted(groups.items())]


def _nominal(key: tuple[str, str], rows: list[tuple[Execution, Floats, Floats]], grid: Floats) -> Nominal:
    position = np.stack([row[1] for row in rows])
    rotation = np.stack([row[2] for row in rows])
    mean = mean_rotation(rotation)
    several = len(rows) > 1
    cosine = np.clip(np.abs(np.sum(rotation * mean, axis=2)), 0.0, 1.0)
    angle = 2.0 * np.arccos(cosine)
    spread = np.sqrt(np.sum(angle**2, axis=0) / (len(rows) - 1)) if several else np.full(len(grid), np.nan)
    return Nominal(
        key[0],
        key[1],
        len(rows),
        grid,
        position.mean(axis=0),
        position.std(axis=0, ddof=1) if several else np.full((len(grid), 3), np.nan),
        mean,
        spread,
        float(np.mean([row[0].t[-1] - row[0].t[0] for row in rows])),
    )


def mean_rotation(quaternions: Floats) -> Floats:
    """(p, 4) of (m, p, 4): the eigenvector of largest eigenvalue of the mean of q qᵀ (Markley et al. 2007)."""
    outer = np.einsum("mpi,mpj->pij", quaternions, quaternions) / len(quaternions)
    mean = np.linalg.eigh(outer)[1][:, :, -1]
    return np.where(mean[:, 3:] < 0, -mean, mean)
