"""What the endoscope looks at, in world, from the scene file."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.calibration.board import Board
from saras.kinematics import scene as scenes

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Surface:
    """The tissue that tips press on, as saras.sim.Tissue has it: a plane, or a sphere where curvature is not 0."""

    world_T_surface: Array
    """(4, 4): origin on the surface, z outward"""
    size_m: tuple[float, float]
    """Of the phantom under it, along x and y; the tissue goes on beyond."""
    curvature_1_m: float = 0.0
    """1 / radius; > 0 bulges outward [1/m]"""

    def height(self, xy: Array) -> Array:
        """(n,) z of the undisturbed surface over the points (n, 2), surface frame [m]."""
        square = (np.asarray(xy) ** 2).sum(axis=-1)
        c = self.curvature_1_m
        return np.asarray(-c * square / (1.0 + np.sqrt(np.maximum(1.0 - c * c * square, 0.0))))

    def depth(self, point: Array) -> float:
        """How far a point (3,) in world is under the undisturbed surface, along its normal there [m]."""
        local = (np.linalg.inv(self.world_T_surface) @ [*point, 1.0])[:3]
        if self.curvature_1_m == 0.0:
            return float(-local[2])
        radius = 1.0 / self.curvature_1_m
        away = float(np.linalg.norm(local - [0.0, 0.0, -radius]))
        return radius - away if radius > 0.0 else away + radius

    def normal(self, point: Array) -> Array:
        """(3,) outward normal of the undisturbed surface under a point (3,), in world."""
        rotation = self.world_T_surface[:3, :3]
        if self.curvature_1_m == 0.0:
            return np.asarray(rotation[:, 2])
        local = (np.linalg.inv(self.world_T_surface) @ [*point, 1.0])[:3]
        away = (local - [0.0, 0.0, -1.0 / self.curvature_1_m]) * np.sign(self.curvature_1_m)
        return np.asarray(rotation @ (away / np.linalg.norm(away)))


@dataclass(frozen=True)
class Room:
    """Tissue, bones and, where it lies there, the calibration board."""

    surface: Surface
    world_T_bones: Array
    """(4, 4) of the bones' box: origin in its middle"""
    bones_size_m: Array
    """(3,)"""
    world_T_board: Array | None = None
    """(4, 4); None: no board. With it there is no tissue: one calibrates before the patient lies there."""
    board: Board = field(default_factory=Board)

    @staticmethod
    def load(path: str | Path, world_T_board: Array | None = None) -> Room:
        """The room of a scene file. Raises ConfigError naming what is missing; OSError."""
        try:
            scene = scenes.load(path)
        except ConfigError as error:
            raise ConfigError(f"{path}: {error}") from None
        world_T_surface = np.eye(4)
        world_T_surface[:3, 3] = scene.phantom.center + 0.5 * scene.phantom.size * (0.0, 0.0, 1.0)
        world_T_bones = scene.world_T("bones_marker_frame").copy()
        world_T_bones[:3, 3] += world_T_bones[:3, :3] @ scene.bones.center
        size = float(scene.phantom.size[0]), float(scene.phantom.size[1])
        return Room(Surface(world_T_surface, size), world_T_bones, scene.bones.size, world_T_board)


__all__ = ["Room", "Surface"]
