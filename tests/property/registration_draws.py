"""Seeded draws of the published protocol (Billings, Boctor, Taylor 2015), on a closed mesh of our own."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from saras.sim.organ import organ

#: Noise of a point [m]: one axis in a random direction, then the two across it; share of gross errors; gate.
PROTOCOL = {
    "isotropic_1mm": (1e-3, 1e-3, 0.0, 1e9),
    "noise_2_0.5mm": (2e-3, 0.5e-3, 0.0, 7.81),
    "outliers_20": (2e-3, 0.5e-3, 0.2, 4.64),
}


@dataclass
class Draw:
    points: np.ndarray
    covariances: np.ndarray
    start: np.ndarray  # base_T_mesh to start from; the truth is the identity


def on_surface(vertices, triangles, rng, count):
    """(count, 3) uniform over the area."""
    corners = vertices[triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    chosen = rng.choice(len(triangles), count, p=area / area.sum())
    return (corners[chosen] * rng.dirichlet([1, 1, 1], count)[:, :, None]).sum(1)


def rigid(rng, degrees, metres):
    """(4, 4) about a random axis and along a random direction, sizes uniform in the given ranges."""
    turn, move = rng.normal(size=(2, 3))
    pose = np.eye(4)
    angle = np.deg2rad(rng.uniform(*degrees))
    pose[:3, :3] = Rotation.from_rotvec(angle * turn / np.linalg.norm(turn)).as_matrix()
    pose[:3, 3] = rng.uniform(*metres) * move / np.linalg.norm(move)
    return pose


def draw(vertices, triangles, seed, along_m, across_m, outliers, count=100):
    rng = np.random.default_rng(seed)
    axes = Rotation.random(count, random_state=seed).as_matrix()
    deviation = np.array([along_m, across_m, across_m])
    covariances = axes @ (np.eye(3) * deviation**2) @ axes.transpose(0, 2, 1)
    points = on_surface(vertices, triangles, rng, count)
    points += (axes @ (deviation * rng.normal(size=(count, 3)))[:, :, None])[:, :, 0]
    gross = rng.normal(size=(int(outliers * count), 3))
    points[: len(gross)] += (
        gross / np.linalg.norm(gross, axis=1, keepdims=True) * rng.uniform(0.01, 0.02, (len(gross), 1))
    )
    return Draw(points, covariances, rigid(rng, (15, 30), (0.015, 0.03)))


def target_error_m(vertices, base_T_mesh):
    """Mean distance of the mesh's vertices from where they truly are."""
    return float(np.linalg.norm(vertices @ base_T_mesh[:3, :3].T + base_T_mesh[:3, 3] - vertices, axis=1).mean())


def bent(vertices, seed, by_m):
    """Vertices bent like a banana, with a wave across."""
    rng = np.random.default_rng(seed)
    (along, towards), length = np.linalg.qr(rng.normal(size=(3, 2)))[0].T, np.ptp(vertices, axis=0).max()
    s = vertices @ along / length
    moved = vertices + 4 * by_m * np.outer(s**2, towards)
    return moved + 0.3 * by_m * np.outer(np.sin(2 * np.pi * s), np.cross(along, towards))


__all__ = ["PROTOCOL", "Draw", "bent", "draw", "on_surface", "organ", "rigid", "target_error_m"]
