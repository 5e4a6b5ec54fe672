"""Figures of simulated experiments with matplotlib (``pip install saras[plot]``).

Each function draws into axes that are given or made, and returns the figure.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

try:
    import matplotlib.pyplot as plt
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
except ImportError as error:  # pragma: no cover
    raise ImportError("saras.plot needs matplotlib: pip install 'saras[plot]'") from error

if TYPE_CHECKING:
    from saras.sim import Result

Array = npt.NDArray[np.float64]

MM = 1e3


def _axes(count: int, axes: Any, title: str | None) -> tuple[Figure, list[Axes]]:
    if axes is None:
        figure, made = plt.subplots(count, 1, sharex=True, figsize=(9.0, 1.2 + 1.9 * count), layout="constrained")
        axes = [made] if count == 1 else list(made)
        if title:
            figure.suptitle(title)
    else:
        axes = list(np.atleast_1d(axes))
    for ax in axes:
        ax.grid(alpha=0.3)
    return axes[0].figure, axes


def tracking(result: Result, side: int = 0, axes: Any = None) -> Figure:
    """Slave tip, set-point and scaled handle over time, x, y and z, relative to the start [mm]."""
    figure, axes = _axes(3, axes, "Tracking: tip, set-point, scaled handle")
    scale = result.experiment.transparency.scale
    base_R_console = result.experiment.mapping.base_T_console[:3, :3]
    hand = scale * (result.hand[:, side] - result.hand[0, side]) @ base_R_console.T
    for axis, ax in enumerate(axes):
        ax.plot(result.t, MM * hand[:, axis], color="tab:gray", label="scale · handle")
        for name, values in (("set-point", result.set_point), ("tip", result.tip)):
            ax.plot(result.t, MM * (values[:, side, axis] - values[0, side, axis]), label=name)
        ax.set_ylabel(f"{'xyz'[axis]} [mm]")
    axes[0].legend(loc="upper right")
    axes[-1].set_xlabel("t [s]")
    return figure


def forces(result: Result, side: int = 0, axes: Any = None) -> Figure:
    """Force on the hand (asked for and applied), force on the tissue, and depth."""
    figure, axes = _axes(3, axes, "Forces")
    axes[0].plot(result.t, np.linalg.norm(result.desired_force[:, side], axis=1), label="desired", color="tab:gray")
    axes[0].plot(result.t, np.linalg.norm(result.hand_force[:, side], axis=1), label="applied to the hand")
    axes[0].set_ylabel("|F| hand [N]")
    axes[0].legend(loc="upper right")
    axes[1].plot(result.t, np.linalg.norm(result.tissue_force[:, side], axis=1), color="tab:red")
    axes[1].set_ylabel("|F| tissue [N]")
    axes[2].plot(result.t, MM * np.maximum(result.depth[:, side], 0.0), color="tab:brown")
    axes[2].set_ylabel("depth [mm]")
    axes[2].set_xlabel("t [s]")
    return figure


def energy(result: Result, axes: Any = None) -> Figure:
    """Levels of all tanks, and the balance: granted = levels + in flight + delivered + vented."""
    figure, axes = _axes(2, axes, "Energy")
    for name, level in zip(result.tanks, result.energy.T):
        axes[0].plot(result.t, level, label=name)
    axes[0].axhline(result.experiment.guard_tank.minimum_J, color="k", lw=0.8, ls=":", label="minimum")
    axes[0].set_ylabel("level [J]")
    axes[0].legend(loc="upper right", ncols=2)
    t = result.t[result.graph_ticks]
    total = {name: book.sum(axis=1) for name, book in result.books.items()}
    axes[1].plot(t, total["granted_J"], "k", label="granted")
    axes[1].plot(t, total["energy_J"], label="levels")
    axes[1].plot(t, total["sent_J"] - total["received_J"], label="in flight")
    axes[1].plot(t, total["work_out_J"], label="delivered")
    axes[1].plot(t, total["vented_J"] + total["lost_J"], label="vented")
    axes[1].set_ylabel("[J]")
    axes[1].legend(loc="upper right", ncols=2)
    axes[1].set_xlabel("t [s]")
    return figure


def comparison(results: dict[str, Result], side: int = 0, axis: int = 2, title: str | None = None) -> Figure:
    """Handle, force on the hand and lowest tank of several experiments, one below the other."""
    figure, axes = _axes(3, None, title)
    for name, result in results.items():
        axes[0].plot(result.t, MM * (result.hand[:, side, axis] - result.hand[0, side, axis]), label=name)
        axes[1].plot(result.t, result.hand_force[:, side, axis], label=name)
        axes[2].plot(result.t, result.energy.min(axis=1) if result.experiment.tanks else np.nan * result.t, label=name)
    axes[0].set_ylabel(f"handle {'xyz'[axis]} [mm]")
    axes[0].legend(loc="upper right")
    axes[1].set_ylabel("force on the hand [N]")
    axes[2].set_ylabel("lowest tank [J]")
    axes[2].set_xlabel("t [s]")
    return figure


def remote_centre(result: Result, side: int = 0, axes: Any = None) -> Figure:
    """Distance of the shaft from the trocar over time [mm]."""
    figure, axes = _axes(1, axes, "Remote centre")
    axes[0].plot(result.t, MM * result.rcm_deviation[:, side])
    axes[0].set_ylabel("deviation [mm]")
    axes[0].set_xlabel("t [s]")
    return figure


def session(result: Result, side: int = 0) -> Figure:
    """Tracking, forces and energies of one side on one page."""
    figure, axes = _axes(8, None, "Session")
    tracking(result, side, axes[:3])
    forces(result, side, axes[3:6])
    energy(result, axes[6:])
    return figure


__all__ = ["comparison", "energy", "forces", "remote_centre", "session", "tracking"]
