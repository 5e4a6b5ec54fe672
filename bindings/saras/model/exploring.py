"""Where to touch next: paths over the surface of least cost, by the cross-entropy method."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import entry_points

import numpy as np
import numpy.typing as npt

from saras import ConfigError, ModelError
from saras._core.model import CrossEntropy
from saras.model.lump import LumpSearch
from saras.model.octave import OctaveCost
from saras.model.stiffness_map import StiffnessMap, SurfaceEstimates

Array = npt.NDArray[np.float64]
Cost = Callable[[SurfaceEstimates, Array], npt.ArrayLike]
"""(estimates at c * n points, the points (c, n, 3) [m]) -> (c,) costs, one a path; the least is best."""

ENTRY_POINTS = "saras.exploration_costs"
LATTICE = 700  #: places of the chart that a lump's summit may be at


class CostError(ModelError):
    """A cost of somebody else's raised, was too slow, or gave no numbers."""


@dataclass(frozen=True)
class Plan:
    """Where to go next."""

    corners: Array
    """(k, 2) in the chart of the surface [m]; the first one is where the tip is"""
    points: Array
    """(n, 3) along the path, on the surface, base frame [m]"""
    cost: float
    error: CostError | None
    """Why the asked cost was not used; `variance` was used instead. None: it was used."""


def variance(estimates: SurfaceEstimates, points: Array, unknown_std_N_m: float = 500.0) -> Array:
    """Explore: minus the mean deviation of stiffness along each path; what is unknown counts as unknown_std_N_m."""
    std = np.minimum(estimates.stiffness_std_N_m, unknown_std_N_m).reshape(points.shape[:2])
    cost: Array = -std.mean(1)
    return cost


def upper_confidence(
    estimates: SurfaceEstimates, points: Array, beta: float = 2.0, unknown_std_N_m: float = 500.0
) -> Array:
    """Find the stiff lump: minus the greatest stiffness + beta deviations on each path, and a share of its mean.

    What is unknown is as stiff as the median of what is known, give or take unknown_std_N_m.
    """
    known = estimates.known
    middle = float(np.median(estimates.stiffness_N_m[known])) if known.any() else 0.0
    stiffness = np.where(known, estimates.stiffness_N_m, middle)
    std = np.where(known, np.minimum(estimates.stiffness_std_N_m, unknown_std_N_m), unknown_std_N_m)
    bound = (stiffness + beta * std).reshape(points.shape[:2])
    cost: Array = -(bound.max(1) + 0.2 * bound.mean(1))
    return cost


COSTS: dict[str, Cost] = {"variance": variance, "upper_confidence": upper_confidence}
LUMP = "lump"


def find_cost(cost: str | Cost | LumpSearch) -> Cost | LumpSearch:
    """One of COSTS, `lump`, NAME.m for Octave, an entry point of saras.exploration_costs, or the callable itself.

    Raises ConfigError, and ModelError for a .m file that does not start.
    """
    if not isinstance(cost, str):
        return cost
    if cost in COSTS:
        return COSTS[cost]
    if cost == LUMP:
        return LumpSearch()
    if cost.endswith(".m"):
        return OctaveCost(cost)
    installed = {point.name: point for point in entry_points(group=ENTRY_POINTS)}
    if cost not in installed:
        raise ConfigError(f"cost = {cost!r}: must be one of {sorted([*COSTS, LUMP, *installed])}, NAME.m or a callable")
    loaded: Cost = installed[cost].load()
    return loaded


class TrajectoryOptimizer:
    """Plans a path of a few corners from where the tip is, over what the map knows.

    model: StiffnessMap. surface: (n, 2) coordinates of a chart [m] -> (n, 3) points on the surface, base frame [m] (the
    plane of a region of interest projected to a mesh, a phantom's). low, high: (2,) bounds of the chart. cost: `lump`
    (LumpSearch; where that is found, `upper_confidence` goes on), of COSTS, an entry point, a .m file, or a callable.
    inside: (n, 2) of the chart moved to where the tip may go; None: anywhere within the bounds. corners: of a path,
    without its start. step_m: expected length between two corners; paths are at most 1.5 times it, and at least half
    of it unless the cost charges for the way, as `lump` does. spacing_m: between the points that are asked for.
    time_limit_s: for one call of the cost. Raises ConfigError.

    Whoever goes to the first corner only and asks again uses what was felt on the way.
    """

    def __init__(
        self,
        model: StiffnessMap,
        surface: Callable[[Array], Array],
        low: npt.ArrayLike,
        high: npt.ArrayLike,
        *,
        cost: str | Cost | LumpSearch = LUMP,
        inside: Callable[[Array], Array] | None = None,
        corners: int = 2,
        step_m: float = 0.012,
        spacing_m: float = 3e-3,
        rounds: int = 6,
        candidates: int = 32,
        time_limit_s: float = 1.0,
        seed: int = 1,
    ) -> None:
        for name, value in (("step_m", step_m), ("spacing_m", spacing_m), ("time_limit_s", time_limit_s)):
            if not (np.isfinite(value) and value > 0.0):
                raise ConfigError(f"{name} = {value}: must be finite and > 0")
        if corners < 1 or rounds < 1:
            raise ConfigError(f"corners = {corners}, rounds = {rounds}: must be at least 1")
        self._model, self._surface = model, surface
        self._low, self._high = (np.asarray(bound, dtype=float).reshape(2) for bound in (low, high))
        self._cost, self._name = find_cost(cost), cost if isinstance(cost, str) else getattr(cost, "__name__", "cost")
        self._corners, self._step_m, self._rounds, self._candidates = corners, step_m, rounds, candidates
        self._points = corners * max(2, round(step_m / spacing_m))
        self._time_limit_s, self._seed = time_limit_s, seed
        self._hanging: threading.Thread | None = None
        self._inside = (lambda across: across) if inside is None else inside

    def next(self, start: npt.ArrayLike) -> Plan:
        """The best path from start (2,) in the chart [m]. A cost that fails is named in the plan, never raised."""
        at = np.asarray(start, dtype=float).reshape(2)
        self._seed += 1
        error: CostError | None = None
        try:
            best, cost = self._search(at, self._lump() or self._guarded)
        except CostError as raised:
            error = raised
            best, cost = self._search(at, variance)
        corners = np.concatenate([at[None], best])
        return Plan(corners, self._surface(self._along(corners[None])[0]), cost, error)

    def _lump(self) -> LumpSearch | None:
        """The search with what is known now; None: another cost is asked for, or the lump is found."""
        if not isinstance(self._cost, LumpSearch):
            return None
        extent_m = self._high - self._low
        spacing_m = float(max(np.sqrt(extent_m.prod() / LATTICE), 1e-4))
        x, y = (np.arange(low + 0.5 * spacing_m, high, spacing_m) for low, high in zip(self._low, self._high))
        lattice = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
        lattice = lattice[(np.abs(self._inside(lattice) - lattice) < 1e-9).all(1)]
        if not len(lattice):
            return None
        self._cost.survey(lattice, spacing_m, self._model.estimate(self._surface(lattice)))
        return None if self._cost.found else self._cost

    def _search(self, start: Array, cost: Cost | LumpSearch) -> tuple[Array, float]:
        middle = np.clip(
            np.tile(start, self._corners), np.tile(self._low, self._corners), np.tile(self._high, self._corners)
        )
        deviation = np.repeat(self._step_m * np.sqrt(1.0 + np.arange(self._corners)), 2)
        search = CrossEntropy(
            middle,
            deviation,
            np.tile(self._low, self._corners),
            np.tile(self._high, self._corners),
            candidates=self._candidates,
            elites=max(2, self._candidates // 5),
            seed=self._seed,
        )
        for _ in range(self._rounds):
            asked = search.ask()
            corners = self._inside(asked.reshape(-1, 2)).reshape(len(asked), -1, 2)
            paths = np.concatenate([np.tile(start, (len(asked), 1, 1)), corners], axis=1)
            across = self._along(paths)
            if isinstance(cost, LumpSearch):
                costs, shortest = cost.judge(across), 0.05  # it pays for the way itself
            else:
                points = self._surface(across.reshape(-1, 2)).reshape(*across.shape[:2], 3)
                costs = np.asarray(cost(self._model.estimate(points.reshape(-1, 3)), points), dtype=float)
                shortest = 0.5
            # Where all is unknown, staying would cost no more than going, and going far no more than going near.
            length = np.linalg.norm(np.diff(paths, axis=1), axis=2).sum(1) / (self._step_m * self._corners)
            search.tell(np.where((length < shortest) | (length > 1.5), np.inf, costs))
        best: Array = self._inside(search.best.reshape(-1, 2))
        return best, float(search.best_cost)

    def _along(self, paths: Array) -> Array:
        """(c, n, 2) points at equal shares along (c, k, 2) corners."""
        share = np.linspace(0.0, paths.shape[1] - 1.0, self._points + 1)[1:]
        before = np.minimum(share.astype(int), paths.shape[1] - 2)
        part = (share - before)[None, :, None]
        points: Array = (1.0 - part) * paths[:, before] + part * paths[:, before + 1]
        return points

    def _guarded(self, estimates: SurfaceEstimates, points: Array) -> Array:
        """The user's cost in a thread of its own: it may raise, hang, or answer nonsense."""
        cost = upper_confidence if isinstance(self._cost, LumpSearch) else self._cost  # the lump is found: others?
        if cost in COSTS.values():
            return np.asarray(cost(estimates, points), dtype=float)
        if self._hanging is not None and self._hanging.is_alive():
            raise CostError(f"cost {self._name}: is still busy with an earlier call")
        answer: list[object] = []

        def call() -> None:
            try:
                answer.append(np.asarray(cost(estimates, points), dtype=float))
            except BaseException as raised:  # whatever it is: it is named, and the loop goes on
                answer.append(raised)

        self._hanging = threading.Thread(target=call, name=f"cost {self._name}", daemon=True)
        self._hanging.start()
        self._hanging.join(self._time_limit_s)
        if not answer:
            raise CostError(f"cost {self._name}: gave no answer within time_limit_s = {self._time_limit_s:g} s")
        costs = answer[0]
        if isinstance(costs, BaseException):
            raise CostError(f"cost {self._name}: raised {type(costs).__name__}: {costs}") from costs
        assert isinstance(costs, np.ndarray)
        if costs.shape != (len(points),) or not np.isfinite(costs).any():
            raise CostError(
                f"cost {self._name}: gave shape {costs.shape}, {np.isfinite(costs).sum()} of them finite: "
                f"must be ({len(points)},), at least one finite"
            )
        return costs


__all__ = ["COSTS", "Cost", "CostError", "Plan", "TrajectoryOptimizer", "find_cost", "upper_confidence", "variance"]
