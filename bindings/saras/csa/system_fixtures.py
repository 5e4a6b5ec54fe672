"""Virtual fixtures of a system file, by their type. All in the slave's base."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import csa
from saras.csa.surface import load_mesh

Array = NDArray[np.float64]
Json = dict[str, Any]
UP: Array = np.array([0.0, 0.0, 1.0])


def fixture(given: Json, start: Array, folder: Path) -> csa.Fixture:
    """One of a system file. start: (3,) where the tip starts; folder: what mesh files are relative to. ConfigError."""
    kind, name = given["type"], given.get("name", "region")
    soft, margin = given.get("soft", False), given.get("margin_m", 0.0)
    if kind == "region":
        x, y = given["half_width_m"] * np.eye(3)[:2]
        corners = [start + i * x + j * y for i in (-1, 1) for j in (-1, 1)]
        return csa.Fixture.hull(name, csa.region_of_interest(corners, UP))
    if kind == "plane":
        return csa.Fixture.plane(name, np.array(given["point_m"]), _unit(given["normal"]), margin, soft)
    if kind == "line":
        direction = _unit(given["direction"])
        return csa.Fixture.line(name, np.array(given["point_m"]), direction, given.get("radius_m", 0.0), soft)
    if kind == "path":
        points = [np.array(point) for point in given["points_m"]]
        return csa.Fixture.path(name, points, given.get("radius_m", 0.001), soft)
    if kind == "remote_centre":
        return csa.Fixture.remote_centre(name, np.array(given["centre_m"]), given.get("tolerance_m", 0.0), soft)
    if kind == "hull":
        faces = csa.convex_hull(given["points_m"])
        return csa.Fixture.hull(name, faces, given.get("keep_in", True), margin, soft)
    mesh = csa.TriangleMesh(*load_mesh(folder / given["file"], given.get("xyz_m"), given.get("rpy_rad")))
    return csa.Fixture.mesh(name, mesh, given.get("keep_in", False), margin, given.get("reach_m", 0.005), soft)


def _unit(vector: list[float]) -> Array:
    array = np.array(vector, dtype=float)
    length = float(np.linalg.norm(array))
    return array / length if length > 0.0 else array  # the fixture itself refuses zero
