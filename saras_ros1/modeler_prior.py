"""The mesh that the modeler begins with: the system file's model, or a patch over its surface."""

from __future__ import annotations

from typing import Any

import numpy as np

from saras import ConfigError, ModelError
from saras.csa.setup import UP, Setup, rotation
from saras.model import Mesh, StiffMesh
from saras.model.live import refine

COARSE = 14  #: vertices along an edge of a patch


def prior_mesh(setup: Setup, half_width_m: float, vertices: int) -> Mesh:
    """In the slave's base frame, refined to at most so many vertices. Raises ConfigError."""
    model = setup.teleop.get("model", {})
    try:
        coarse = load(setup, model) if model.get("type") == "mesh" else patch(setup, half_width_m)
        return refine(coarse, vertices)
    except ModelError as error:
        raise ConfigError(f"{setup.path}: {setup.name}: model: {error}") from None


def load(setup: Setup, model: dict[str, Any]) -> Mesh:
    """An STL, OBJ or PLY file in metres (trimesh), laid as the system file says."""
    import trimesh

    path = setup.path.parent / model["file"]
    try:
        mesh: Any = trimesh.load(str(path), force="mesh", process=True)  # joins an STL's vertices
    except Exception as error:  # trimesh raises whatever its readers do
        raise ConfigError(f"{path}: no mesh: {error}") from error
    turn, shift = rotation(model.get("rpy_rad", [0.0, 0.0, 0.0])), np.asarray(model.get("xyz_m", [0.0, 0.0, 0.0]))
    return Mesh(np.asarray(mesh.vertices) @ turn.T + shift, np.asarray(mesh.faces, dtype=np.int32))


def patch(setup: Setup, half_width_m: float) -> Mesh:
    """A square of the surface that the proxy meets, around where the tip starts."""
    surface, start = setup.surface(), setup.start()
    n = surface.touch(start).normal
    if not np.linalg.norm(n) > 0.5:
        n = UP
    x = np.cross(np.eye(3)[np.abs(n).argmin()], n)
    x /= np.linalg.norm(x)
    side = np.linspace(-half_width_m, half_width_m, COARSE)
    points = [surface.touch(start + i * x + j * np.cross(n, x)).closest for i in side for j in side]
    return Mesh(np.array(points), square(COARSE))


def square(count: int) -> np.ndarray:
    """(m, 3) triangles of count x count vertices, counter-clockwise seen from x cross y."""
    i, j = (axis.reshape(-1) for axis in np.meshgrid(*[np.arange(count - 1)] * 2, indexing="ij"))
    a = i * count + j
    first, second = (a, a + count, a + count + 1), (a, a + count + 1, a + 1)
    return np.concatenate([np.column_stack(first), np.column_stack(second)]).astype(np.int32)


def refuse_elsewhere(kept: StiffMesh, prior: Mesh) -> None:
    """A kept map of another organ, in another frame or unit. Raises ModelError."""
    low, high = prior.vertices.min(0), prior.vertices.max(0)
    far = float(np.linalg.norm(np.clip(kept.vertices.mean(0), low, high) - kept.vertices.mean(0)))
    size = float(np.linalg.norm(high - low))
    if far > size:
        raise ModelError(
            f"its middle is {far:.3g} m from the model, which is {size:.3g} m in size: must be the same organ, "
            "in the slave's base frame"
        )
