"""Numbers that say how well an experiment tracked and whether its energy balance held."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from saras.sim.result import Result

Array = npt.NDArray[np.float64]

SETTLE_S = 1.0
"""Left out of the tracking numbers: references are taken and forces ramp in."""

LAG_MAX_S = 1.5


@dataclass(frozen=True)
class Metrics:
    """Of one side (tracking) and of all sides together (energy)."""

    lag_s: float
    """constant lag of the tip behind the hand that fits best [s]"""
    tracking_rms_m: float
    """tip - scale * hand(t - lag_s), RMS of the distance, constant offset removed [m]"""
    tracking_max_m: float
    """the same, largest [m]"""
    set_point_error_m: float
    """set-point - scale * handle as the platform sees it (already delayed by the network), largest distance [m]"""
    drift_m: float
    """the same at the end [m]"""
    rcm_deviation_m: float
    """largest distance of the shaft from the trocar [m]"""
    energy_min_J: float
    """lowest level of any tank"""
    granted_J: float
    """charged from outside, all tanks"""
    delivered_J: float
    """work that left through the ports, all tanks; negative: the surroundings put energy in"""
    delivered_max_J: float
    """the largest that delivered_J was at any time"""
    in_flight_J: float
    """under way between the tanks"""
    in_flight_min_J: float
    """the least it ever was: negative would be energy created by the network"""
    vented_J: float
    """discarded by full tanks, or held by a tank that was killed"""
    ledger_residual_J: float
    """largest |sum of levels + flight + delivered + vented - granted| at any time"""


def best_lag(t: Array, master: Array, slave: Array) -> tuple[float, Array]:
    """Constant lag [s] of slave behind master, both (n, 3), and the residual (n, 3) without its mean."""

    def residual(lag: float) -> Array:
        delayed = np.stack([np.interp(t - lag, t, master[:, axis]) for axis in range(3)], axis=1)
        error: Array = (slave - delayed)[t >= t[0] + SETTLE_S + lag]
        return np.asarray(error - error.mean(axis=0))

    # Coarse to fine: three grids, each ten times finer, around the best of the last.
    best, width = 0.5 * min(LAG_MAX_S, 0.5 * (t[-1] - t[0] - SETTLE_S)), 0.0
    width = best
    for _ in range(4):
        grid = np.linspace(max(0.0, best - width), best + width, 21)
        costs = [float(np.mean(residual(lag) ** 2)) for lag in grid]
        best, width = float(grid[int(np.argmin(costs))]), width / 8.0
    return best, residual(best)


def compute(result: Result, side: int) -> Metrics:
    """See Metrics."""
    experiment = result.experiment
    scale = experiment.transparency.scale
    base_R_console = experiment.mapping.base_T_console[:3, :3]
    step = max(1, int(experiment.guard_rate_hz / 500.0))
    hand = scale * result.hand[::step, side] @ base_R_console.T
    lag, residual = best_lag(result.t[::step], hand, result.tip[::step, side])
    distance = np.linalg.norm(residual, axis=1)

    g = result.graph_ticks[np.isfinite(result.tracked[result.graph_ticks, side, 0])]
    set_point_error = result.set_point[g, side] - scale * result.tracked[g, side]
    set_point_distance = np.linalg.norm(set_point_error - set_point_error[0], axis=1)

    total = {name: book.sum(axis=1) for name, book in result.books.items()}
    flight = total["sent_J"] - total["received_J"]
    gone = total["vented_J"] + total["lost_J"]
    residual_J = total["energy_J"] + flight + total["work_out_J"] + gone - total["granted_J"]
    return Metrics(
        lag_s=lag,
        tracking_rms_m=float(np.sqrt(np.mean(distance**2))),
        tracking_max_m=float(distance.max()),
        set_point_error_m=float(set_point_distance.max()),
        drift_m=float(set_point_distance[-1]),
        rcm_deviation_m=float(result.rcm_deviation[:, side].max()),
        energy_min_J=float(result.energy.min()),
        granted_J=float(total["granted_J"][-1]),
        delivered_J=float(total["work_out_J"][-1]),
        delivered_max_J=float(total["work_out_J"].max()),
        in_flight_J=float(flight[-1]),
        in_flight_min_J=float(flight.min()),
        vented_J=float(gone[-1]),
        ledger_residual_J=float(np.abs(residual_J).max()),
    )
