"""Where a stiff lump may be, and which way over the surface tells most about it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.model.stiffness_map import SurfaceEstimates

Array = npt.NDArray[np.float64]

#: By how much the lump's middle is stiffer than the tissue around it, in shares of that tissue's stiffness.
HEIGHTS = np.array([0.5, 1.0, 2.0, 4.0])
#: Tissue without a lump is as uneven as this, one standard deviation: share of the stiffness.
UNEVEN = 0.08
#: What is nearer to each other than this is uneven together [m].
TOGETHER_M = 5e-3
#: Going over the summit is worth as much as telling apart two lumps this far from each other [m].
SUMMIT_M = 8e-3
#: Nearer to the summit than this is over it [m].
OVER_M = 1.5e-3
#: What a path costs beside its own length: what is shorter than a stroke of the tip teaches nothing [m].
STROKE_M = 8e-3


class LumpSearch:
    """A cost of paths that looks for one lump: survey() takes what the map knows, judge() weighs paths over a chart.

    Believed is a stiffness b (1 + a exp(-|s - c|^2 / 2 w^2)) over the chart s. The summit c may be anywhere, the width
    w is about one of radii_m, the height a about one of HEIGHTS, the tissue's own stiffness b anything. survey() draws
    such lumps as they are likely after the map's estimates (importance resampling; b is left out in closed form).

    A path is worth the distance between two such lumps times how surely it would tell them apart (1 - Bhattacharyya's
    coefficient), in the mean over all pairs, and SUMMIT_M times the chance that it goes over the summit for the first
    time; this a metre. So, as a lump is felt from two radii away, first come wide sweeps where nothing is known, then
    its flank tells where the middle is, and then the middle is touched. That is optimal search in the sense of Koopman
    (1956), with what entropy search (Hennig and Schuler 2012) asks of a sample, but in metres.

    radii_m: standard deviations of the lumps looked for [m]. located_m: it is found when its summit is touched and
    known this well, one standard deviation [m]. Raises ConfigError.
    """

    def __init__(
        self,
        radii_m: npt.ArrayLike = (4e-3, 5.7e-3, 8e-3, 11.3e-3),
        *,
        located_m: float = 1e-3,
        draws: int = 96,
        seed: int = 1,
    ) -> None:
        self._radii = np.asarray(radii_m, dtype=float).reshape(-1)
        if not len(self._radii) or not (np.isfinite(self._radii) & (self._radii > 0.0)).all():
            raise ConfigError(f"radii_m = {self._radii.tolist()}: must be finite and > 0, at least one")
        if not (np.isfinite(located_m) and located_m > 0.0):
            raise ConfigError(f"located_m = {located_m}: must be finite and > 0")
        if draws < 2:
            raise ConfigError(f"draws = {draws}: must be at least 2")
        self._located_m, self._draws, self._rng = located_m, draws, np.random.default_rng(seed)
        self.summit = np.full(2, np.nan)
        """(2,) mean of where the summit may be, in the chart [m]"""
        self.summit_std_m = np.inf
        """of its distance from there [m]"""
        self.found = False
        """The summit was touched, and is known to located_m."""

    def survey(self, places: Array, spacing_m: float, estimates: SurfaceEstimates) -> None:
        """What the map knows at places (n, 2) of the chart, evenly all over it, spacing_m from their neighbours [m]."""
        with np.errstate(invalid="ignore"):
            usable = estimates.known & (estimates.stiffness_std_N_m < 0.5 * estimates.stiffness_N_m)
        tissue = float(np.quantile(estimates.stiffness_N_m[usable], 0.25)) if usable.any() else 1.0
        self._places, self._touched = places, places[usable]
        self._stiffness = estimates.stiffness_N_m[usable] / tissue
        std = np.hypot(estimates.stiffness_std_N_m[usable] / tissue, UNEVEN * self._stiffness)
        self._precision = min(1.0, (spacing_m / TOGETHER_M) ** 2) / std**2
        # What touching can bring: as good as the best known places. Where it is as good already, no news.
        share = std / self._stiffness
        self._noise = max(2.0 * UNEVEN, 1.25 * float(np.quantile(share, 0.1))) if usable.any() else 2.0 * UNEVEN
        self._news = np.ones(len(places))
        self._news[usable] = 1.0 - np.minimum(1.0, (self._noise / share) ** 2)
        self._draw(spacing_m)

    def judge(self, paths: Array) -> Array:
        """(c,) costs of paths (c, n, 2) over the chart [m], without their common start; the least is best."""
        gaps = np.linalg.norm(np.diff(paths, axis=1), axis=2)
        length_m = gaps.sum(1) + gaps[:, 0]
        squared = ((paths[:, None] - self._summits[None, :, None]) ** 2).sum(3)
        felt = self._heights[:, None] * np.exp(-0.5 * squared / self._widths[:, None] ** 2)
        nearest = ((paths[:, :, None] - self._places) ** 2).sum(3).argmin(2)
        news = self._news[nearest]
        share = news * np.minimum(1.0, length_m[:, None] / paths.shape[1] / TOGETHER_M)
        # The noise is a share of the stiffness, so that logarithms differ by multiples of it.
        told = np.sqrt(share)[:, None] * np.log1p(felt) / self._noise
        products = told @ told.transpose(0, 2, 1)
        own = np.diagonal(products, axis1=1, axis2=2)
        apart = -np.expm1(-0.125 * np.maximum(0.0, own[:, :, None] + own[:, None] - 2.0 * products))
        worth = (apart * self._distances).mean((1, 2))
        over = (news[:, None] * np.exp(-0.5 * squared / OVER_M**2)).max(2).mean(1)
        cost: Array = -(worth + SUMMIT_M * over) / (length_m + STROKE_M)
        return cost

    def _log_likelihood(self, summits: Array, widths: Array, heights: Array) -> Array:
        """(m, h) of m lumps at (m, h) heights, less that of none; b is left out under a flat prior."""
        if not len(self._touched):
            return np.zeros(heights.shape)
        shape = np.exp(-0.5 * ((summits[:, None] - self._touched) ** 2).sum(2) / widths[:, None] ** 2)
        total = self._precision.sum()
        mean = self._precision @ self._stiffness / total
        first = shape @ (self._precision * (self._stiffness - mean))
        second = shape**2 @ self._precision - (shape @ self._precision) ** 2 / total
        likelihood: Array = heights * first[:, None] - 0.5 * heights**2 * second[:, None]
        return likelihood

    def _draw(self, spacing_m: float) -> None:
        """Lumps as likely as what the map says: first at the places, then anywhere about them."""
        at, width = (index.reshape(-1) for index in np.indices((len(self._places), len(self._radii))))
        heights = np.broadcast_to(HEIGHTS, (len(at), len(HEIGHTS)))
        coarse = self._log_likelihood(self._places[at], self._radii[width], heights).reshape(-1)
        some = self._resampled(coarse, 8 * self._draws)
        lump, height = np.divmod(some, len(HEIGHTS))
        about = self._rng.uniform(-0.5, 0.5, (len(some), 4))
        summits = self._places[at[lump]] + spacing_m * about[:, :2]
        widths = self._radii[width[lump]] * 2.0 ** (0.5 * about[:, 2])
        heights = HEIGHTS[height] * 2.0 ** about[:, 3]
        fine = self._log_likelihood(summits, widths, heights[:, None])[:, 0]
        kept = self._resampled(fine - coarse[some], self._draws)
        self._summits, self._widths, self._heights = summits[kept], widths[kept], heights[kept]
        self._distances = np.linalg.norm(self._summits[:, None] - self._summits, axis=2)
        self.summit = self._summits.mean(0)
        self.summit_std_m = float(np.sqrt(((self._summits - self.summit) ** 2).sum(1).mean()))
        away_m = np.linalg.norm(self._touched - self.summit, axis=1).min(initial=np.inf)
        self.found = bool(away_m < spacing_m and self.summit_std_m < self._located_m)

    def _resampled(self, logarithms: Array, count: int) -> npt.NDArray[np.intp]:
        """(count,) numbers, each as often as its weight says (systematic resampling)."""
        weights = np.cumsum(np.exp(logarithms - logarithms.max()))
        at = (np.arange(count) + self._rng.uniform()) / count * weights[-1]
        numbers: npt.NDArray[np.intp] = np.minimum(np.searchsorted(weights, at), len(weights) - 1)
        return numbers


__all__ = ["LumpSearch"]
