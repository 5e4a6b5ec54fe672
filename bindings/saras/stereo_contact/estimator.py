"""Depth of tips under the undisturbed tissue, from one stereo pair after the other."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from saras.calibration.camera_info import Eye
from saras.stereo_contact.memory import SurfaceMemory, cells_of
from saras.stereo_contact.points import StereoPoints
from saras.stereo_contact.settings import StereoContactConfig
from saras.stereo_contact.surface import SECTORS, Fit, across, fit, sectors

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

#: Of this neighbourhood a plane is taken first, to know what is across.
ROUGH_M = 0.06
SECTOR_POINTS = 4
#: Cells that count as one: their errors are those of the same blocks.
TOGETHER = 4.0
DENT_REACH_M = 0.025
HALF_CONFIDENCE_M = 5e-4


@dataclass(frozen=True)
class Tool:
    """An instrument where its arm says it is, in world."""

    tip: Array
    """(3,) [m]"""
    trocar: Array
    """(3,) [m]"""
    radius_m: float


@dataclass(frozen=True)
class ContactEstimate:
    """Of one tip. Where `known` is false, depth and normal are NaN and `reason` says why."""

    known: bool
    depth_m: float = math.nan
    """Under the undisturbed surface; negative: above it"""
    normal: Array = field(default_factory=lambda: np.full(3, np.nan))
    """(3,) outward, in world"""
    std_m: float = math.nan
    """Of the depth, as far as the picture goes; errors of the calibration come on top"""
    confidence: float = 0.0
    """0 … 1; 0.5 where std_m is 0.5 mm"""
    points: int = 0
    """Of the surface around the tip"""
    reason: str = ""


class StereoContact:
    """Estimates for each tool in each frame; keeps what undisturbed tissue looked like."""

    def __init__(self, config: StereoContactConfig, left: Eye, right: Eye) -> None:
        self.config = config
        self.stereo = StereoPoints(config, left, right)
        self.memory = SurfaceMemory(config.memory_s)
        self._remembered_s = -math.inf

    def estimate(
        self,
        left: Image,
        right: Image,
        world_T_left: Array,
        tools: Mapping[str, Tool],
        now_s: float,
        watched: tuple[str, ...] | None = None,
    ) -> dict[str, ContactEstimate]:
        """One estimate for each watched tool (default: all).

        left, right: raw pictures of one moment, (height, width, 3) BGR or grey; world_T_left: (4, 4) of the left eye's
        raw optical frame then; tools: all that may be in view, they are masked; now_s: of a clock that is never set.
        """
        world_T_rectified = np.array(world_T_left, dtype=float)
        world_T_rectified[:3, :3] = world_T_rectified[:3, :3] @ self.stereo.left.R.T
        turn, origin = world_T_rectified[:3, :3], world_T_rectified[:3, 3]
        capsules = [((t.tip - origin) @ turn, (t.trocar - origin) @ turn, t.radius_m) for t in tools.values()]
        points = self.stereo.points(left, right, capsules) @ turn.T + origin
        names = tuple(tools) if watched is None else watched
        found = {}
        for name in names:
            if name not in tools:
                found[name] = ContactEstimate(False, reason=f"{name}: its place is not known")
                continue
            tip = tools[name].tip
            reason = self._out_of_view((tip - origin) @ turn)
            found[name] = (
                ContactEstimate(False, reason=f"{name}: {reason}")
                if reason
                else self._judge(name, points, tip, -turn[:, 2], now_s)
            )
        self._remember(points, tools, found, -turn[:, 2], now_s)
        return found

    def _out_of_view(self, tip: Array) -> str:
        pixel = self.stereo.pixel(tip)
        if pixel is None:
            return "tip is behind the camera"
        width, height = self.stereo.size
        if not (0 <= pixel[0] < width and 0 <= pixel[1] < height):
            return f"tip is out of view, at ({2 * pixel[0]:.0f}, {2 * pixel[1]:.0f}) px"
        return ""

    def _judge(self, name: str, points: Array, tip: Array, toward_camera: Array, now_s: float) -> ContactEstimate:
        config = self.config
        seen = points[(np.abs(points - tip) < ROUGH_M).all(axis=1)]
        if len(seen):
            seen, _, _ = cells_of(seen)
        memory = self.memory.near(tip, ROUGH_M, now_s)
        rough = self._rough(np.concatenate([seen, memory]), tip, toward_camera)
        if rough is None:
            return ContactEstimate(False, reason=f"{name}: no tissue seen around the tip ({len(seen)} points)")
        normal = rough.normal
        aside = across(seen, tip, normal)
        inner = config.inner_m if -rough.height_m < -config.dented_m else 0.0
        ring = seen[(aside > inner) & (aside < config.outer_m)]
        known = memory[across(memory, tip, normal) < config.outer_m]
        known = self._trusted(known, ring, tip, normal)
        if inner and len(known) >= config.least_points:  # what is seen now is sunk in, by a tenth of the depth at 1 cm
            ring = ring[across(ring, tip, normal) > DENT_REACH_M]
        surface = np.concatenate([ring, known])
        if len(surface) < config.least_points:
            return ContactEstimate(
                False,
                points=len(surface),
                reason=f"{name}: points around the tip = {len(surface)}: must be >= {config.least_points}",
            )
        around = sectors(surface, tip, normal, SECTOR_POINTS)
        if around < config.least_sectors:
            return ContactEstimate(
                False,
                points=len(surface),
                reason=f"{name}: tissue seen in {around} of {SECTORS} directions: must be >= {config.least_sectors}",
            )
        best = fit(surface, tip, normal, curved=True, together=TOGETHER)
        if best is None or best.rms_m > config.worst_rms_m or best.std_m > config.worst_std_m:
            why = "no surface" if best is None else f"rms {1e3 * best.rms_m:.1f} mm, depth +- {1e3 * best.std_m:.1f} mm"
            return ContactEstimate(False, points=len(surface), reason=f"{name}: the points fit badly: {why}")
        depth = best.height_m * float(best.normal @ normal)
        confidence = 1.0 / (1.0 + (best.std_m / HALF_CONFIDENCE_M) ** 2)
        return ContactEstimate(True, depth, best.normal, best.std_m, confidence, len(surface))

    def _rough(self, points: Array, tip: Array, toward_camera: Array) -> Fit | None:
        """A plane, found twice: first across the line of sight, then across itself."""
        if len(points) < self.config.least_points:
            return None
        first = fit(points, tip, toward_camera, curved=False)
        return None if first is None else fit(points, tip, first.normal, curved=False)

    def _trusted(self, memory: Array, ring: Array, tip: Array, normal: Array) -> Array:
        """The remembered points, unless the tissue around the dent is no longer where it was."""
        if len(memory) < 20 or len(ring) < self.config.least_points:
            return memory
        now, then = (fit(part, tip, normal, curved=False) for part in (ring, memory))
        if now is None or then is None or abs(now.height_m - then.height_m) <= self.config.forget_m + 2.0 * now.std_m:
            return memory
        self.memory.clear()
        return memory[:0]

    def _remember(
        self,
        points: Array,
        tools: Mapping[str, Tool],
        found: Mapping[str, ContactEstimate],
        toward_camera: Array,
        now_s: float,
    ) -> None:
        if now_s - self._remembered_s < self.config.memory_every_s:
            return
        self._remembered_s = now_s
        keep = np.ones(len(points), dtype=bool)
        for name, tool in tools.items():
            estimate = found.get(name)
            if estimate is not None and estimate.known and estimate.depth_m < self.config.dented_m:
                continue  # it hangs above: nothing is dented there
            normal = estimate.normal if estimate is not None and estimate.known else toward_camera
            keep &= across(points, tool.tip, normal) > DENT_REACH_M
        self.memory.add(points[keep], now_s)


__all__ = ["ContactEstimate", "StereoContact", "Tool"]
