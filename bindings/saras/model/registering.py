"""Where a prior model lies and how it is bent, from points measured on its surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from saras._core.model import Deformation, DeformationGrid, Mesh, Registration, register_rigid

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Registered:
    """A mesh laid and bent to points."""

    base_T_mesh: Array
    """(4, 4)"""
    vertices: Array
    """(n, 3) of the bent mesh in the base frame [m]"""
    rigid: Registration
    deformation: Deformation | None
    """None: laid only"""


def register(
    mesh: Mesh,
    points: npt.ArrayLike,
    covariances: npt.ArrayLike | None = None,
    base_T_mesh: npt.ArrayLike | None = None,
    *,
    gate: float = 7.81,
    grid: DeformationGrid | None = None,
    **bending: Any,
) -> Registered:
    """Lays a mesh to measured points; with a grid, bends it too.

    points (n, 3) [m] on the surface, base frame; covariances (n, 3, 3) of their errors [m^2], None: 1 mm; base_T_mesh
    (4, 4) to start from, None: the identity. gate: squared deviation above which a point is left out; a mesh that is
    bent by more than the points' noise needs a greater one for the first step. bending: as of DeformationGrid.deform.
    Raises ModelError.
    """
    start = np.eye(4) if base_T_mesh is None else np.asarray(base_T_mesh, dtype=float)
    rigid = register_rigid(mesh, points, covariances, start, gate=gate)
    laid = np.asarray(rigid.base_T_mesh)
    if grid is None:
        return Registered(laid, mesh.vertices @ laid[:3, :3].T + laid[:3, 3], rigid, None)
    deformation = grid.deform(points, covariances, laid, **bending)
    return Registered(laid, deformation.vertices @ laid[:3, :3].T + laid[:3, 3], rigid, deformation)


__all__ = ["Deformation", "DeformationGrid", "Mesh", "Registered", "Registration", "register", "register_rigid"]
