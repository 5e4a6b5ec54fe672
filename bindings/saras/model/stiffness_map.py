"""Stiffness and surface as an estimator over arrays, in the manner of scikit-learn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ModelError
from saras._core import model as _core
from saras.model.learning import learn_hyperparameters

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class SurfaceEstimates:
    """What is known at n points. NaN with an infinite deviation: not known there."""

    surface_point: Array
    """(n, 3) on the line through each point along its normal, base frame [m]"""
    surface_std_m: Array
    """(n,) along the normal [m]"""
    stiffness_N_m: Array
    """(n,) at the surface [N/m]"""
    stiffness_std_N_m: Array
    """(n,) [N/m]"""
    force_N: Array
    """(n,) normal force at the points themselves [N]"""
    force_std_N: Array
    """(n,) without the noise of a sample [N]"""
    normal: Array
    """(n, 3) outward, base frame"""
    samples: npt.NDArray[np.int32]
    """(n,) places that the estimate is made of"""
    status: npt.NDArray[np.uint8]
    """(n,) numbers of EstimateStatus"""

    @property
    def known(self) -> npt.NDArray[np.bool_]:
        """(n,) stiffness and surface are known."""
        known: npt.NDArray[np.bool_] = self.status == int(_core.EstimateStatus.OK)
        return known


class StiffnessMap:
    """Learns from touch samples, tells stiffness, surface and force anywhere near them.

    config: StiffnessGpConfig; its gates hold here too, all but speed_limit_m_s, as samples may come in any order.
    Memory is bounded by config.grid, the cost of a sample and of a point by config.local, whatever was learned before.
    """

    def __init__(self, config: _core.StiffnessGpConfig | None = None) -> None:
        self.config = _core.StiffnessGpConfig() if config is None else config
        law = self.config.__copy__()
        law.speed_limit_m_s = 1e9
        self._law = _core.StiffnessGp(law)
        self._refused: dict[str, int] = {}

    def fit(
        self,
        positions: npt.ArrayLike,
        forces: npt.ArrayLike,
        velocities: npt.ArrayLike | None = None,
        *,
        learn: bool = True,
    ) -> StiffnessMap:
        """Forgets everything, learns the samples and, with learn (needs Ceres), the hyper-parameters from them.

        positions (n, 3) [m], forces (n, 3) [N] that the tool exerts, velocities (n, 3) [m/s] of the tip: without them
        the tissue's damping is taken for stiffness. Raises ModelError naming what is wrong: shapes,
        numbers, units, no contact at all.
        """
        self._law.reset()
        self._refused = {}
        self.partial_fit(positions, forces, velocities)
        if learn:
            self.learn_hyperparameters()
        return self

    def partial_fit(
        self, positions: npt.ArrayLike, forces: npt.ArrayLike, velocities: npt.ArrayLike | None = None
    ) -> StiffnessMap:
        """Learns further samples, (n, 3) [m], (n, 3) [N] and (n, 3) [m/s]. What was refused is counted in `refused`.

        Raises ModelError when shapes differ, or when more than half of the samples are refused as not finite, in
        another unit or outliers: then something is wrong with the recording, and the map is as it was.
        """
        x, f = _rows(positions, "positions"), _rows(forces, "forces")
        v = None if velocities is None else _rows(velocities, "velocities")
        for name, rows in (("forces", f), ("velocities", v)):
            if rows is not None and rows.shape != x.shape:
                raise ModelError(f"{name}: shape {rows.shape}: must be that of positions, {x.shape}")
        before = self._law.state
        verdicts, _ = self._law.steps(x, f, self.config.dt_max_s, v)
        counts = np.bincount(verdicts, minlength=len(_core.SampleVerdict.__members__))
        said = {name: int(counts[int(verdict)]) for name, verdict in _core.SampleVerdict.__members__.items()}
        wrong = {name: n for name, n in said.items() if n and name not in ("LEARNED", "RELEARNED", "NOT_TOUCHING")}
        if sum(wrong.values()) > 0.5 * max(1, len(x)):
            self._law.reset(before)
            worst = max(wrong, key=lambda name: wrong[name])
            raise ModelError(f"{wrong[worst]} of {len(x)} samples are {worst}: {self._explain(worst, x, f)}")
        for name, n in {**wrong, "NOT_TOUCHING": said["NOT_TOUCHING"]}.items():
            if n:
                self._refused[name] = self._refused.get(name, 0) + n
        return self

    def predict(
        self, points: npt.ArrayLike, return_std: bool = False, *, normals: npt.ArrayLike | None = None
    ) -> Array | tuple[Array, Array]:
        """Stiffness (n,) [N/m] at (n, 3) points [m], and with return_std its standard deviation (n,).

        NaN and infinite where nothing is known. normals: (n, 3) outward; None: the mean reaction of the samples there.
        """
        found = self.estimate(points, normals=normals)
        return (found.stiffness_N_m, found.stiffness_std_N_m) if return_std else found.stiffness_N_m

    def predict_force(
        self, points: npt.ArrayLike, return_std: bool = False, *, normals: npt.ArrayLike | None = None
    ) -> Array | tuple[Array, Array]:
        """Normal force (n,) [N] that a tip at (n, 3) points [m] meets, and its standard deviation without noise."""
        found = self.estimate(points, normals=normals)
        return (found.force_N, found.force_std_N) if return_std else found.force_N

    def estimate(self, points: npt.ArrayLike, *, normals: npt.ArrayLike | None = None) -> SurfaceEstimates:
        """All that is known at (n, 3) points [m]. Runs without the GIL."""
        at = _rows(points, "points")
        outward = None if normals is None else _rows(normals, "normals")
        return SurfaceEstimates(**_core.estimate_surfaces(self._law.grid, self._law.config.local, at, outward))

    def learn_hyperparameters(self, **options: Any) -> _core.GpLearning:
        """Finds the hyper-parameters from what was learned, and takes them over. Tenths of a second; needs Ceres.

        options: as of saras.model.learn_hyperparameters. Raises ModelError when there are too few samples.
        """
        # From the configured ones again: what was learned last time is no prior for the same samples.
        learned = learn_hyperparameters(self._law.grid, self.config.local, **options)
        self._law.adopt(learned.hyperparameters)
        return learned

    @property
    def hyperparameters(self) -> _core.GpHyperparameters:
        """Those in use."""
        return self._law.config.local.hyperparameters

    @property
    def grid(self) -> _core.HashGrid:
        """The live samples."""
        return self._law.grid

    @property
    def refused(self) -> dict[str, int]:
        """Samples that were not learned, by the name of their SampleVerdict."""
        return dict(self._refused)

    def _explain(self, verdict: str, x: Array, f: Array) -> str:
        greatest = float(np.nanmax(np.abs(x), initial=0.0))
        strongest = float(np.nanmax(np.linalg.norm(f, axis=1), initial=0.0))
        return {
            "IMPLAUSIBLE_POSITION": f"positions up to {greatest:.3g}: must be within workspace_m = "
            f"{self.config.workspace_m:g} m (millimetres for metres?)",
            "IMPLAUSIBLE_FORCE": f"forces up to {strongest:.3g}: must be within force_limit_N = "
            f"{self.config.force_limit_N:g} N (another unit, a broken sensor?)",
            "INVALID": "must be finite",
            "OUTLIER": f"further than outlier_sigma = {self.config.outlier_sigma:g} from what their neighbours predict",
        }.get(verdict, "must be touch samples")


def _rows(values: npt.ArrayLike, name: str) -> Array:
    try:
        rows = np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise ModelError(f"{name}: must be numbers of shape (n, 3)") from None
    if rows.ndim != 2 or rows.shape[1] != 3:
        raise ModelError(f"{name}: shape {rows.shape}: must be (n, 3)")
    return rows


__all__ = ["StiffnessMap", "SurfaceEstimates"]
