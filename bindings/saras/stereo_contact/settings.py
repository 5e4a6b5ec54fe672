"""Parameters of the estimator."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from saras import ConfigError


@dataclass(frozen=True)
class StereoContactConfig:
    """Raises ConfigError naming field, value and bound."""

    nearest_m: float = 0.035
    """Tissue is looked for from this distance of the camera on, 0.01 … 1 [m]"""
    furthest_m: float = 0.30
    """to this one, > nearest_m [m]"""
    block_px: int = 7
    """Odd side of the compared blocks at half size, 3 … 15"""
    mask_margin_m: float = 0.003
    """Beyond a tool's radius nothing is believed, 0 … 0.02 [m]"""
    inner_m: float = 0.010
    """So near to a pressing tip the tissue is dented, 0 … 0.05 [m]"""
    outer_m: float = 0.032
    """So far around the tip the surface is taken for a paraboloid, > inner_m [m]"""
    dented_m: float = -0.002
    """A tip with more depth than this dents the tissue, -0.02 … 0 [m]"""
    least_points: int = 80
    """Cells of 2 mm that must be seen around a tip, 20 … 10000"""
    least_sectors: int = 5
    """Of eight around the tip that must be seen: beyond the border nothing is guessed, 1 … 8"""
    worst_rms_m: float = 0.0025
    """Of the points about the surface, 1e-4 … 0.02 [m]"""
    worst_std_m: float = 0.001
    """Of the depth, 1e-5 … 0.02 [m]"""
    memory_s: float = 30.0
    """How long an undisturbed surface is remembered, 0 … 600 [s]; 0: not at all"""
    memory_every_s: float = 0.2
    """How often it is looked at for that, 0.05 … 60 [s]"""
    forget_m: float = 0.002
    """Tissue that has moved by more is forgotten, 1e-4 … 0.05 [m]"""

    def __post_init__(self) -> None:
        bounds = {
            "nearest_m": (0.01, 1.0),
            "furthest_m": (self.nearest_m, 2.0),
            "block_px": (3, 15),
            "mask_margin_m": (0.0, 0.02),
            "inner_m": (0.0, 0.05),
            "outer_m": (self.inner_m, 0.2),
            "dented_m": (-0.02, 0.0),
            "least_points": (20, 10000),
            "least_sectors": (1, 8),
            "worst_rms_m": (1e-4, 0.02),
            "worst_std_m": (1e-5, 0.02),
            "memory_s": (0.0, 600.0),
            "memory_every_s": (0.05, 60.0),
            "forget_m": (1e-4, 0.05),
        }
        for field in fields(self):
            value = getattr(self, field.name)
            low, high = bounds[field.name]
            if not (math.isfinite(value) and low <= value <= high):
                raise ConfigError(f"{field.name} = {value}: must be in [{low:g}, {high:g}]")
        if self.block_px % 2 == 0:
            raise ConfigError(f"block_px = {self.block_px}: must be odd")
        for low_name, high_name in (("nearest_m", "furthest_m"), ("inner_m", "outer_m")):
            low, high = getattr(self, low_name), getattr(self, high_name)
            if not low < high:
                raise ConfigError(f"{high_name} = {high}: must be > {low_name} = {low}")


__all__ = ["StereoContactConfig"]
