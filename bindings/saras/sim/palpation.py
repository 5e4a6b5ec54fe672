"""Recorded palpations of the simulated phantom, with its truth: what a modeler learns from and is judged by.

The closed form of saras.sim.Tissue over whole arrays (a test holds the two together), and a tip that follows a
sinusoidal force reference while it moves sideways, as a slave under force control does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras._core.sim import TissueConfig

Array = npt.NDArray[np.float64]


class Phantom:
    """Tissue of TissueConfig, asked at many points at once. Points are (n, 3) in the base frame [m]."""

    def __init__(self, tissue: TissueConfig | None = None) -> None:
        self.tissue = TissueConfig() if tissue is None else tissue

    def depth(self, points: npt.ArrayLike) -> Array:
        """(n,) indentation of a tip there [m]; negative: distance to the surface."""
        at = self._in_surface(points)
        c = self.tissue.curvature_1_m
        length = np.linalg.norm(c * at + [0.0, 0.0, 1.0], axis=1)
        depth: Array = -(c * (at**2).sum(1) + 2.0 * at[:, 2]) / (length + 1.0)
        return depth

    def normal(self, points: npt.ArrayLike) -> Array:
        """(n, 3) outward, base frame."""
        outward = self.tissue.curvature_1_m * self._in_surface(points) + [0.0, 0.0, 1.0]
        outward /= np.linalg.norm(outward, axis=1, keepdims=True)
        return self._rotated(outward)

    def stiffness(self, points: npt.ArrayLike) -> Array:
        """(n,) K at the points [N/m^exponent]."""
        return self._stiffness(self._in_surface(points))[0]

    def surface(self, across: npt.ArrayLike) -> Array:
        """(n, 3) points of the surface, base frame [m], at (n, 2) coordinates x, y of the surface frame [m]."""
        xy = np.asarray(across, dtype=float).reshape(-1, 2)
        c = self.tissue.curvature_1_m
        squared = (xy**2).sum(1)
        if (c * c * squared >= 1.0).any():
            raise ConfigError(
                f"across: {np.sqrt(squared.max()):.3g} m: must be less than the radius {1.0 / abs(c):.3g} m"
            )
        height = -c * squared / (1.0 + np.sqrt(1.0 - c * c * squared))
        return self._in_base(np.column_stack([xy, height]))

    @property
    def inclusion(self) -> Array:
        """(3,) the point of the surface above the inclusion's centre, base frame [m]."""
        point: Array = self.surface([[self.tissue.inclusion_x_m, self.tissue.inclusion_y_m]])[0]
        return point

    def forces(self, points: npt.ArrayLike, velocities: npt.ArrayLike | None = None) -> Array:
        """(n, 3) forces [N] that a tip there, moving at (n, 3) [m/s], exerts on the tissue; as Tissue.step."""
        tissue = self.tissue
        at = self._in_surface(points)
        base_R_surface = np.asarray(tissue.base_T_surface)[:3, :3]
        velocity = np.zeros_like(at) if velocities is None else np.asarray(velocities, dtype=float) @ base_R_surface
        depth = np.maximum(self.depth(points), 0.0)[:, None]
        normal = self.normal(points) @ base_R_surface
        stiffness, gradient = self._stiffness(at)
        stiffness = stiffness[:, None]
        power = depth**tissue.exponent
        energy_gradient = power * depth / (tissue.exponent + 1.0) * gradient - stiffness * power * normal
        touching = depth > 0.0
        closing = (energy_gradient * velocity).sum(1, keepdims=True) / np.where(touching, stiffness * power, 1.0)
        reaction = -energy_gradient * np.maximum(0.0, 1.0 + tissue.damping_N_s_m2 / tissue.stiffness_N_m * closing)
        sliding = velocity - (velocity * normal).sum(1, keepdims=True) * normal
        pressing = np.maximum(0.0, (reaction * normal).sum(1, keepdims=True))
        slowness = np.hypot(np.linalg.norm(sliding, axis=1, keepdims=True), tissue.friction_speed_m_s)
        reaction -= tissue.friction * pressing * sliding / slowness
        return -self._rotated(np.where(touching, reaction, 0.0))

    def _stiffness(self, at: Array) -> tuple[Array, Array]:
        tissue = self.tissue
        offset = at - [tissue.inclusion_x_m, tissue.inclusion_y_m, 0.0]
        offset[:, 2] = 0.0
        variance = tissue.inclusion_radius_m**2
        extra = (tissue.inclusion_stiffness_N_m - tissue.stiffness_N_m) * np.exp(-0.5 * (offset**2).sum(1) / variance)
        return tissue.stiffness_N_m + extra, -(extra / variance)[:, None] * offset

    def _in_surface(self, points: npt.ArrayLike) -> Array:
        base_T_surface = np.asarray(self.tissue.base_T_surface)
        at: Array = (np.asarray(points, dtype=float).reshape(-1, 3) - base_T_surface[:3, 3]) @ base_T_surface[:3, :3]
        return at

    def _in_base(self, points: Array) -> Array:
        base_T_surface = np.asarray(self.tissue.base_T_surface)
        return self._rotated(points) + base_T_surface[:3, 3]

    def _rotated(self, vectors: Array) -> Array:
        rotated: Array = vectors @ np.asarray(self.tissue.base_T_surface)[:3, :3].T
        return rotated


@dataclass(frozen=True)
class Palpation:
    """What was felt, sample by sample."""

    t: Array
    """(n,) [s]"""
    positions: Array
    """(n, 3) measured, of the tip, base frame [m]"""
    forces: Array
    """(n, 3) measured, that the tool exerts on the tissue, base frame [N]"""
    velocities: Array
    """(n, 3) of the tip, base frame [m/s]"""

    def __len__(self) -> int:
        return len(self.t)


def raster_path(size_m: float, spacing_m: float, speed_m_s: float, dt: float) -> Array:
    """(n, 2) x, y in the surface frame [m]: lines to and fro over a square of size_m about the origin."""
    rows = np.arange(-0.5 * size_m, 0.5 * size_m + 1e-9, spacing_m)
    corners = np.array([(x, y) for i, y in enumerate(rows) for x in (-0.5 * size_m, 0.5 * size_m)[:: 1 - 2 * (i % 2)]])
    return along_path(corners, speed_m_s, dt)


def along_path(corners: npt.ArrayLike, speed_m_s: float, dt: float) -> Array:
    """(n, 2) points every dt at one speed along the lines between the corners (m, 2) [m]."""
    points = np.asarray(corners, dtype=float)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    at = np.arange(0.0, length[-1], speed_m_s * dt)
    return np.column_stack([np.interp(at, length, points[:, k]) for k in range(2)])


def palpate(
    phantom: Phantom,
    path: npt.ArrayLike,
    dt: float,
    *,
    force_N: float = 1.0,
    amplitude_N: float = 0.6,
    frequency_Hz: float = 1.0,
    force_noise_N: float = 0.02,
    position_noise_m: float = 0.0,
    seed: int = 1,
) -> Palpation:
    """A tip moves over the path (n, 2) [m] while its force on the tissue is force_N + amplitude_N sin(2 pi f t).

    The tip is where the tissue at rest would give that force; what is felt has damping, friction and noise too. dt [s]
    between points. Raises ConfigError unless 0 <= amplitude_N < force_N.
    """
    if not 0.0 <= amplitude_N < force_N:
        raise ConfigError(f"amplitude_N = {amplitude_N}: must be at least 0 and less than force_N = {force_N}")
    rng = np.random.default_rng(seed)
    surface = phantom.surface(path)
    t = dt * np.arange(len(surface))
    wanted = force_N + amplitude_N * np.sin(2.0 * np.pi * frequency_Hz * t)
    depth = (wanted / phantom.stiffness(surface)) ** (1.0 / phantom.tissue.exponent)
    positions = surface - depth[:, None] * phantom.normal(surface)
    velocities = np.gradient(positions, dt, axis=0) if len(t) > 1 else np.zeros_like(positions)
    forces = phantom.forces(positions, velocities) + force_noise_N * rng.normal(size=positions.shape)
    return Palpation(t, positions + position_noise_m * rng.normal(size=positions.shape), forces, velocities)


__all__ = ["Palpation", "Phantom", "along_path", "palpate", "raster_path"]
