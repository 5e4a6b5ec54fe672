"""Reader of config/scene.yaml: where frames, trocars and the phantom are. Needs PyYAML."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ConfigError

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Frame:
    """A fixed frame: its parent's name and parent_T_frame (4, 4)."""

    parent: str
    parent_T_frame: Array


@dataclass(frozen=True)
class ArmPlace:
    """What the scene says of one arm."""

    rcm: Array
    """(3,) trocar in the arm's sbs_world [m]."""
    elbow: float
    """Sign of scara_2."""
    passive_joints: Array
    """(7,) positions of the positioning arm [rad]."""


@dataclass(frozen=True)
class Box:
    """Edges along the axes of its frame."""

    center: Array
    """(3,) [m]"""
    size: Array
    """(3,) full edge lengths [m]"""


@dataclass(frozen=True)
class Scene:
    """The operating room."""

    frames: dict[str, Frame]
    arms: dict[str, ArmPlace]
    phantom: Box
    """In world; the upper face is the tissue's undisturbed surface."""
    bones: Box
    """In bones_marker_frame."""

    def world_T(self, name: str) -> Array:
        """(4, 4) of a frame in world. Raises ConfigError for a name that the scene does not have."""
        pose = np.eye(4)
        seen = []
        while name != "world":
            if name not in self.frames or name in seen:
                raise ConfigError(f"frames: {name!r} does not lead to world (known: {', '.join(self.frames)})")
            seen.append(name)
            pose = self.frames[name].parent_T_frame @ pose
            name = self.frames[name].parent
        return pose


def pose_from_xyz_rpy(xyz: npt.ArrayLike, rpy: npt.ArrayLike) -> Array:
    """(4, 4) from xyz [m] and roll, pitch, yaw [rad], R = Rz(yaw) Ry(pitch) Rx(roll) as in URDF."""
    roll, pitch, yaw = np.asarray(rpy, dtype=float)
    cr, sr, cp, sp, cy, sy = (f(a) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    pose = np.eye(4)
    pose[:3, :3] = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    pose[:3, 3] = xyz
    return pose


def load(path: str | Path) -> Scene:
    """Reads the scene. Raises ConfigError naming the entry that is missing or no finite number."""
    try:
        import yaml
    except ImportError:
        raise ImportError("saras.kinematics.scene needs PyYAML: pip install pyyaml") from None

    document = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    frames = {}
    for name, entry in _get(document, "frames", "").items():
        where = f"frames.{name}"
        pose = pose_from_xyz_rpy(_numbers(entry, "xyz_m", 3, where), _numbers(entry, "rpy_rad", 3, where))
        frames[name] = Frame(str(_get(entry, "parent", where)), pose)
    arms = {
        name: ArmPlace(
            rcm=_numbers(entry, "rcm_m", 3, f"arms.{name}"),
            elbow=math.copysign(1.0, float(_get(entry, "elbow", f"arms.{name}"))),
            passive_joints=_numbers(entry, "passive_joints_rad", 7, f"arms.{name}"),
        )
        for name, entry in _get(document, "arms", "").items()
    }
    scene = Scene(frames, arms, _box(document, "phantom"), _box(document, "bones"))
    for name in frames:
        scene.world_T(name)
    return scene


def _get(mapping: Any, key: str, where: str) -> Any:
    if not isinstance(mapping, Mapping) or key not in mapping:
        raise ConfigError(f"scene: {where + '.' if where else ''}{key} is missing")
    return mapping[key]


def _numbers(mapping: Any, key: str, count: int, where: str) -> Array:
    value = _get(mapping, key, where)
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        array = np.array([math.nan])
    if array.shape != (count,) or not np.isfinite(array).all():
        raise ConfigError(f"scene: {where}.{key} = {value}: must be {count} finite numbers")
    return array


def _box(document: Any, key: str) -> Box:
    entry = _get(document, key, "")
    size = _numbers(entry, "size_m", 3, key)
    if (size <= 0.0).any():
        raise ConfigError(f"scene: {key}.size_m = {size.tolist()}: must be > 0")
    return Box(_numbers(entry, "center_m", 3, key), size)


__all__ = ["ArmPlace", "Box", "Frame", "Scene", "load", "pose_from_xyz_rpy"]
