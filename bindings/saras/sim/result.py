"""What an experiment gives: arrays with one row a device tick, and the numbers that say whether it held."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from saras.sim.exchange import EnergyBook
from saras.sim.metrics import Metrics, compute

if TYPE_CHECKING:
    from saras.sim.arm_side import ArmSide
    from saras.sim.console import Console
    from saras.sim.experiment import Experiment
    from saras.sim.pipeline_platform import PipelinePlatform, PipelineSide
    from saras.sim.platform import Platform, PlatformSide

Array = npt.NDArray[np.float64]

BOOK_FIELDS = tuple(f.name for f in fields(EnergyBook))


@dataclass
class Result:
    """Arrays over n device ticks and s sides. Hand: console frame, tip: the arm's base.

    Energies: guards, tank_master, tank_slave, in this order (``tanks``).
    """

    experiment: Experiment
    t: Array
    """(n,) [s]"""
    hand: Array
    """(n, s, 3) handle [m]"""
    intended: Array
    """(n, s, 3) where the operator wants the handle [m]"""
    hand_force: Array
    """(n, s, 3) that the handle exerts on the hand, touch axes [N]"""
    desired_force: Array
    """(n, s, 3) that the guard was asked for, touch axes [N]"""
    tracked: Array
    """(n, s, 3) handle as the platform sees it, base frame [m]; NaN before the first datagram"""
    set_point: Array
    """(n, s, 3) [m]"""
    tip: Array
    """(n, s, 3) [m]"""
    tissue_force: Array
    """(n, s, 3) that the tool exerts on the tissue [N]"""
    depth: Array
    """(n, s) indentation [m]; NaN in free space"""
    rcm_deviation: Array
    """(n, s) distance of the shaft from the trocar [m]"""
    energy: Array
    """(n, s + 2) levels of the tanks [J]"""
    graph_ticks: npt.NDArray[np.intp]
    """(g,) rows at which the platform stepped"""
    books: dict[str, Array]
    """cumulative joules at the graph ticks: each (g, s + 2)"""
    final_books: list[EnergyBook]
    """books of all tanks at the end"""
    delivered_hand_J: Array
    """(s,) work that really left through each handle, from the hand's own motion"""
    delivered_tip_J: Array
    """(s,) work that each tip really did on its tissue, summed at device rate"""
    wall_s: float
    """time that the simulation took"""

    @property
    def tanks(self) -> list[str]:
        """Names of the tanks, in the order of the energies."""
        return [f"guard_{i}" for i in range(self.hand.shape[1])] + ["tank_master", "tank_slave"]

    @property
    def faster_than_real_time(self) -> float:
        """Simulated over elapsed time."""
        return float(self.t[-1] / self.wall_s)

    def metrics(self, side: int = 0) -> Metrics:
        """Tracking of one side and the energy balance of all."""
        return compute(self, side)

    def save(self, path: str) -> None:
        """Write all arrays into a compressed numpy file."""
        arrays: dict[str, Any] = {
            f.name: getattr(self, f.name) for f in fields(self) if isinstance(getattr(self, f.name), np.ndarray)
        }
        np.savez_compressed(path, **arrays, **{f"book_{name}": book for name, book in self.books.items()})


class Recorder:
    """Fills the arrays of a Result while an experiment runs."""

    def __init__(self, experiment: Experiment, t: Array) -> None:
        """Take memory for all ticks."""
        n, s = len(t), len(experiment.sides)
        self._experiment, self._t = experiment, t
        names = ("hand", "intended", "hand_force", "desired_force", "tracked", "set_point", "tip", "tissue_force")
        self._vectors: dict[str, Array] = {name: np.full((n, s, 3), np.nan) for name in names}
        self._depth: Array = np.full((n, s), np.nan)
        self._rcm_deviation: Array = np.zeros((n, s))
        self._energy: Array = np.zeros((n, s + 2))
        self._graph_ticks: list[int] = []
        self._books: list[list[EnergyBook]] = []

    def record(
        self, k: int, consoles: list[Console], arms: list[ArmSide], platform: Platform | PipelinePlatform
    ) -> None:
        """One device tick."""
        v = self._vectors
        sides: Sequence[PlatformSide | PipelineSide] = platform.sides
        for i, (console, arm, side) in enumerate(zip(consoles, arms, sides)):
            v["hand"][k, i] = console.position
            v["intended"][k, i] = console.intended[k]
            v["hand_force"][k, i] = console.applied[:3]
            v["desired_force"][k, i] = console.desired[:3]
            v["tracked"][k, i] = side.tracked[:3, 3]
            v["set_point"][k, i] = side.set_point[:3, 3]
            v["tip"][k, i] = arm.base_T_tip[:3, 3]
            v["tissue_force"][k, i] = arm.force
            self._rcm_deviation[k, i] = arm.rcm_deviation_m
            if arm.contact is not None:
                self._depth[k, i] = arm.contact.depth
            self._energy[k, i] = console.guard.energy_J
        self._energy[k, -2] = platform.master.energy_J
        self._energy[k, -1] = platform.slave.energy_J

    def record_books(self, k: int, books: list[EnergyBook]) -> None:
        """One graph tick."""
        self._graph_ticks.append(k)
        self._books.append(books)

    def finish(self, books: list[EnergyBook], wall_s: float, consoles: list[Console], arms: list[ArmSide]) -> Result:
        """All rows are in."""
        return Result(
            experiment=self._experiment,
            t=self._t,
            **self._vectors,
            depth=self._depth,
            rcm_deviation=self._rcm_deviation,
            energy=self._energy,
            graph_ticks=np.array(self._graph_ticks, dtype=np.intp),
            books={name: np.array([[getattr(b, name) for b in row] for row in self._books]) for name in BOOK_FIELDS},
            final_books=books,
            delivered_hand_J=np.array([c.delivered_J for c in consoles]),
            delivered_tip_J=np.array([a.delivered_J for a in arms]),
            wall_s=wall_s,
        )
