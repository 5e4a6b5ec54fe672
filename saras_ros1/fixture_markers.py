"""Markers of virtual fixtures: borders in their frames as in the file, the nearest point, the wanted force. Pure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from saras.csa.fixtures_file import FixtureEntry
from saras_ros1.markers import GREY, ORANGE, RED, WHITE, new_marker, remove

PATCH_M = 0.06  #: half the edge of a plane's patch; half a line's length
WALL_M = 0.03  #: half the height of a region's walls
LINE_WIDTH_M = 0.0008
ARROW_M_PER_N = 0.02
MOST_DRAWN = 3000  #: triangles of a mesh
HARD, SOFT = ColorRGBA(0.95, 0.35, 0.85, 0.9), ColorRGBA(0.3, 0.85, 0.9, 0.9)


def shape(entry: FixtureEntry, side: str, unknown: bool) -> Marker:
    """The border of one fixture; grey while it is not known where it is."""
    given, kind = entry.geometry, entry.kind
    colour = GREY if unknown else SOFT if entry.soft else HARD
    name, frame = f"{side} fixture {entry.name}", entry.frame_of(side)
    if kind == "path":
        marker = new_marker(
            name, Marker.LINE_STRIP, frame, colour, (max(LINE_WIDTH_M, given.get("radius_m", 0.0)), 0, 0)
        )
        marker.points = _points(given["points_m"])
        return marker
    marker = new_marker(name, Marker.LINE_LIST, frame, colour, (LINE_WIDTH_M, 0.0, 0.0))
    if kind == "plane":
        marker.points = _points(
            _patch(given["point_m"] + given.get("margin_m", 0.0) * given["normal"], given["normal"])
        )
    elif kind == "line":
        marker.points = _points([given["point_m"] + s * PATCH_M * given["direction"] for s in (-1, 1)])
    elif kind == "mesh":
        if len(given["triangles"]) > MOST_DRAWN:
            return remove(name)
        marker.points = _points(given["vertices"][given["triangles"]][:, [0, 1, 1, 2, 2, 0]].reshape(-1, 3))
    else:
        marker.points = _points(_hull(given["points_m"]) if kind == "hull" else _walls(given))
    return marker


def state(side: str, message: Any | None) -> list[Marker]:
    """The nearest border's closest point (red: passed), and the force wanted on the hand there."""
    dot, arrow = f"{side} fixture nearest", f"{side} fixture force"
    if message is None or message.nearest < 0:
        return [remove(dot), remove(arrow)]
    frame, at = message.header.frame_id, message.closest
    ball = new_marker(dot, Marker.SPHERE, frame, RED if message.violation > 0.0 else WHITE, (0.003,) * 3)
    ball.pose.position = at
    f = message.force
    if not math.hypot(f.x, f.y, f.z) >= 0.02:
        return [ball, remove(arrow)]
    force = new_marker(arrow, Marker.ARROW, frame, ORANGE, (0.002, 0.005, 0.006))
    k = ARROW_M_PER_N
    force.points = [at, Point(at.x + k * f.x, at.y + k * f.y, at.z + k * f.z)]
    return [ball, force]


def _points(rows: Any) -> list[Point]:
    return [Point(*row) for row in np.asarray(rows, dtype=float).tolist()]


def _patch(centre: np.ndarray, normal: np.ndarray) -> list[np.ndarray]:
    """A square with its cross, and a stroke towards the allowed side."""
    x = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
    x *= PATCH_M / np.linalg.norm(x)
    y = np.cross(normal, x)
    ring = [centre + x + y, centre - x + y, centre - x - y, centre + x - y]
    return [*_ring(ring), centre - x, centre + x, centre - y, centre + y, centre, centre + 0.2 * PATCH_M * normal]


def _ring(corners: list[np.ndarray]) -> list[np.ndarray]:
    return [corner for pair in zip(corners, [*corners[1:], corners[0]]) for corner in pair]


def _hull(points: np.ndarray) -> np.ndarray:
    """Edges between faces that are not in one plane."""
    from scipy.spatial import ConvexHull

    hull = ConvexHull(points)
    normals: dict[tuple[int, int], list[np.ndarray]] = {}
    for simplex, equation in zip(hull.simplices, hull.equations):
        for a, b in ((0, 1), (1, 2), (2, 0)):
            edge = (min(simplex[a], simplex[b]), max(simplex[a], simplex[b]))
            normals.setdefault(edge, []).append(equation[:3])
    edges = [edge for edge, beside in normals.items() if np.dot(beside[0], beside[-1]) < 1.0 - 1e-9]
    return points[np.array(edges).ravel()]


def _walls(given: dict[str, Any]) -> list[np.ndarray]:
    """Rings above and below, and the posts between: of the points' hull along the normal."""
    from scipy.spatial import ConvexHull

    points = given["points_m"]
    centre = points.mean(axis=0)
    z = given.get("normal")
    if z is None:
        z = np.linalg.svd(points - centre)[2][2]
    x = np.cross(z, np.eye(3)[np.abs(z).argmin()])
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    flat = np.c_[(points - centre) @ x, (points - centre) @ y]
    corners = [centre + u * x + v * y for u, v in flat[ConvexHull(flat).vertices]]
    up, down = [c + WALL_M * z for c in corners], [c - WALL_M * z for c in corners]
    return [*_ring(up), *_ring(corners), *_ring(down), *[end for pair in zip(up, down) for end in pair]]
