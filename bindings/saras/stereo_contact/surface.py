"""A smooth surface through scattered points around a place, robustly, with its uncertainty."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ROUNDS = 6
CUT = 4.0  # deviations at which a point no longer counts (Tukey's biweight)
LEAST_SCALE_M = 1e-4
SECTORS = 8


@dataclass(frozen=True)
class Fit:
    """z = c0 + c1 x + c2 y + … over a plane through the place."""

    height_m: float
    """Of the surface over the place, along the normal that was given"""
    normal: Array
    """(3,) of the surface there, on the side of the normal that was given"""
    rms_m: float
    """Of the points that count"""
    std_m: float
    """Of height_m; neighbouring points are not independent: `together` of them count as one"""


def frame_of(normal: Array) -> Array:
    """(3, 3) columns x, y, normal."""
    x = np.cross(normal, np.eye(3)[int(np.argmin(np.abs(normal)))])
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(normal, x), normal])


def fit(points: Array, place: Array, normal: Array, *, curved: bool, together: float = 1.0) -> Fit | None:
    """The surface through points (n, 3) over a place (3,), about along a unit normal (3,). None: they define none.

    curved: a paraboloid, else a plane. Iteratively reweighted least squares with Tukey's biweight; the scale is the
    median absolute deviation.
    """
    axes = frame_of(normal)
    local = (points - place) @ axes
    x, y, z = local.T
    columns = [np.ones_like(x), x, y]
    if curved:
        columns += [x * x, x * y, y * y]
    # Powers of lengths in metres are of very different size: scaled, the normal equations are well conditioned.
    scale = np.array([1.0, 1e2, 1e2, 1e4, 1e4, 1e4][: len(columns)])
    a = np.column_stack(columns) * scale
    weight = np.ones(len(z))
    if len(z) < 2 * len(scale):
        return None
    # A tool's edge or a wrong match is far off: begin with what is near the median.
    weight[np.abs(z - np.median(z)) > 0.015] = 0.0
    solution, spread = np.zeros(len(scale)), LEAST_SCALE_M
    inverse = np.zeros((len(scale), len(scale)))
    for _ in range(ROUNDS):
        weighted = a * weight[:, None]
        normal_matrix = weighted.T @ a
        if np.linalg.cond(normal_matrix) > 1e10:
            return None
        inverse = np.linalg.inv(normal_matrix)
        solution = inverse @ (weighted.T @ z)
        residual = z - a @ solution
        counted = weight > 0.0
        spread = max(1.4826 * float(np.median(np.abs(residual[counted]))), LEAST_SCALE_M)
        ratio = np.minimum(np.abs(residual) / (CUT * spread), 1.0)
        weight = (1.0 - ratio**2) ** 2
        if weight.sum() < 2 * len(scale):
            return None
    coefficients = solution * scale
    slope = np.array([-coefficients[1], -coefficients[2], 1.0])
    residual = z - a @ solution
    rms = float(np.sqrt((weight * residual**2).sum() / weight.sum()))
    std = float(spread * np.sqrt(max(inverse[0, 0], 0.0) * together))
    return Fit(float(coefficients[0]), axes @ (slope / np.linalg.norm(slope)), rms, std)


def sectors(points: Array, place: Array, normal: Array, least: int) -> int:
    """In how many of eight directions around a place (3,), across the normal, there are at least so many points."""
    local = (points - place) @ frame_of(normal)[:, :2]
    index = np.floor((np.arctan2(local[:, 1], local[:, 0]) + np.pi) / (2.0 * np.pi) * SECTORS).astype(int) % SECTORS
    return int((np.bincount(index, minlength=SECTORS) >= least).sum())


def across(points: Array, place: Array, normal: Array) -> Array:
    """(n,) distances from the line through a place along the normal."""
    away = points - place
    return np.asarray(np.linalg.norm(away - np.outer(away @ normal, normal), axis=1))


__all__ = ["SECTORS", "Fit", "across", "fit", "frame_of", "sectors"]
