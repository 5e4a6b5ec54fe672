"""How well the slave follows the master: scale, constant lag, residual; and the remote centre."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from saras.recording import PoseSeries, Session

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

FREE_FORCE_N = 0.2  #: below this the tool counts as free
SETTLE_S = 1.0  #: time to leave out after contact, clutch, reduction or HOLD
LAG_MAX_S = 0.5
_GRID_S = 0.005


@dataclass(frozen=True)
class Tracking:
    """follower(t) ≈ offset + scale · leader(t − lag); one offset for each stretch of free motion."""

    scale: float
    lag_s: float
    rms_mm: float  #: of the distance that remains
    worst_mm: float
    seconds: float  #: how much motion this is measured on
    t: Floats
    error_mm: Floats


def engaged(session: Session, side: str, t: Floats) -> Flags:
    """Whether the side is engaged with the clutch released, at times t. All False when its state was not recorded."""
    state = session.console(side).state
    if state is None:
        return np.zeros(len(t), dtype=bool)
    index = np.searchsorted(state.t, t, side="right") - 1
    moving = (state["state"] == 2) & ~state["clutch"].astype(bool)
    return np.asarray((index >= 0) & moving[np.maximum(index, 0)], dtype=bool)


def free_motion(session: Session, side: str, t: Floats) -> Flags:
    """Engaged, no clutch, contact, reduction or slow-down near things, and none of these within the last SETTLE_S."""
    good = engaged(session, side, t)
    wrench = session.arm(f"mesa_{side}").measured_cf
    if wrench is not None:
        force = np.linalg.norm(wrench.value[:, :3], axis=1)
        good &= np.interp(t, wrench.t, force, left=0.0, right=0.0) < FREE_FORCE_N
    for name in ("tank_master", "tank_slave"):
        tank = session.tank(name)
        if tank is not None:
            good &= np.interp(t, tank.t, tank["reduction"], left=0.0) <= 0.0
    for tool in session.distances:
        if tool.name == f"mesa_{side}":  # near something it may not go where the hand wants it
            good &= np.interp(t, tool.t, tool.slowed.astype(float), left=0.0, right=0.0) <= 0.0
    last_bad = np.maximum.accumulate(np.where(good, -np.inf, t))
    return np.asarray(good & (t - last_bad > SETTLE_S), dtype=bool)


def track(leader: PoseSeries | None, follower: PoseSeries | None, free: Flags, grid: Floats) -> Tracking | None:
    """Fits scale, lag and offsets over the free stretches of ``grid``; None when there is too little motion.

    Lag by search over 1 ms steps, scale and offsets by least squares at each; both on interpolated positions.
    """
    if leader is None or follower is None or len(leader.t) < 10 or len(follower.t) < 10:
        return None
    inside = (grid > max(leader.t[0] + LAG_MAX_S, follower.t[0])) & (grid < min(leader.t[-1], follower.t[-1]))
    use = free & inside
    if use.sum() < 2.0 / _GRID_S:
        return None
    stretch = np.cumsum(np.diff(use.astype(int), prepend=0) == 1)[use]
    t = grid[use]
    behind = _centred(_at(follower, t), stretch)
    if np.sqrt((behind**2).sum(axis=1).mean()) < 1e-4:
        return None

    def fit(lag: float) -> tuple[float, float, Floats]:
        ahead = _centred(_at(leader, t - lag), stretch)
        scale = float((ahead * behind).sum() / max((ahead**2).sum(), 1e-18))
        error = np.linalg.norm(behind - scale * ahead, axis=1)
        return float((error**2).mean()), scale, error

    coarse = min(np.arange(0.0, LAG_MAX_S, 0.01), key=lambda lag: fit(lag)[0])
    fine = np.arange(max(0.0, coarse - 0.01), coarse + 0.0101, 0.001)
    lag = float(min(fine, key=lambda value: fit(value)[0]))
    mean_square, scale, error = fit(lag)
    return Tracking(scale, lag, 1e3 * mean_square**0.5, 1e3 * float(error.max()), len(t) * _GRID_S, t, 1e3 * error)


def time_grid(session: Session) -> Floats:
    """Common times for comparing topics [s]."""
    return np.arange(0.0, session.duration_s, _GRID_S)


def remote_centre_deviation(session: Session, arm: str) -> tuple[Floats, Floats, str] | None:
    """(t, distance of the shaft line from the trocar [m], source); None when it cannot be known.

    From the simulator's truth where recorded, else ‖(I − zzᵀ)(p_rcm − p_tip)‖ with z the shaft of the measured pose.
    """
    truth = session.arm(arm).truth
    if truth is not None and "rcm_deviation" in truth.columns:
        return truth.t, np.abs(truth["rcm_deviation"].astype(float)), "simulator's truth"
    tip, trocar = session.arm(arm).ee_pose, session.topic(f"/{arm}/rcm")
    if tip is None or trocar is None:
        return None
    prefix = next((p for p in ("pose.position", "point", "position") if f"{p}.x" in trocar.columns), None)
    if prefix is None:
        return None
    centre = np.stack([np.interp(tip.t, trocar.t, trocar[f"{prefix}.{axis}"]) for axis in "xyz"], axis=1)
    shaft = tip.pose[:, :3, 2]
    offset = centre - tip.position
    across = offset - (offset * shaft).sum(axis=1, keepdims=True) * shaft
    return tip.t, np.linalg.norm(across, axis=1), "measured pose"


def _at(series: PoseSeries, t: Floats) -> Floats:
    position = series.position
    return np.stack([np.interp(t, series.t, position[:, axis]) for axis in range(3)], axis=1)


def _centred(position: Floats, stretch: NDArray[np.int64]) -> Floats:
    """Positions less the mean of their own stretch."""
    centred = position.copy()
    for label in np.unique(stretch):
        part = stretch == label
        centred[part] -= centred[part].mean(axis=0)
    return centred
