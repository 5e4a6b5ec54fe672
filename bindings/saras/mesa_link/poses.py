"""Position and quaternion on the wire, (4, 4) poses in Python."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from saras.mesa_link.protocol import Target


def to_matrix(position: tuple[float, ...], quaternion: tuple[float, ...]) -> NDArray[np.float64]:
    """(4, 4) pose from position [m] and unit quaternion x, y, z, w."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), position[0]],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), position[1]],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), position[2]],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )


def to_target(pose: NDArray[np.float64]) -> Target:
    """Position and quaternion (w >= 0) of a (4, 4) pose. ValueError when it is not finite or not a rotation."""
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise ValueError(f"pose: expected a finite (4, 4) array, got shape {pose.shape}: {pose.tolist()}")
    rotation = pose[:3, :3]
    if np.abs(rotation @ rotation.T - np.eye(3)).max() > 1e-6 or np.linalg.det(rotation) < 0.0:
        raise ValueError(f"pose: not a rotation: {rotation.tolist()}")
    return matrix_to_target(pose)


def matrix_to_target(pose: NDArray[np.float64]) -> Target:
    """The same for a pose that is known to be one."""
    # Shepperd's method: divide by the largest of the four components.
    (a, b, c, px), (d, e, f, py), (g, h, i, pz), _ = pose.tolist()
    squares = (1 + a - e - i, 1 - a + e - i, 1 - a - e + i, 1 + a + e + i)
    largest = max(range(4), key=squares.__getitem__)
    s = 2.0 * math.sqrt(squares[largest])
    x, y, z, w = (
        (s / 4, (b + d) / s, (c + g) / s, (h - f) / s),
        ((b + d) / s, s / 4, (f + h) / s, (c - g) / s),
        ((c + g) / s, (f + h) / s, s / 4, (d - b) / s),
        ((h - f) / s, (c - g) / s, (d - b) / s, s / 4),
    )[largest]
    sign = -1.0 if w < 0.0 else 1.0
    return Target((px, py, pz), (sign * x, sign * y, sign * z, sign * w))


def angle_between(a: tuple[float, ...], b: tuple[float, ...]) -> float:
    """Angle [rad] of the rotation between two unit quaternions."""
    dot = abs(sum(p * q for p, q in zip(a, b)))
    return 2.0 * math.acos(min(1.0, dot))
