"""Capsules, forbidden regions and witness lines for rviz, coloured by state. Pure: a CollisionState in, markers out."""

from __future__ import annotations

import math

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker, MarkerArray

from saras_ros1.markers import new_marker, remove
from saras_ros1.msg import CollisionState, ToolCollision

NAMES = {0: "UNKNOWN", 1: "CLEAR", 2: "WARNING", 3: "COLLISION"}
# Unknown is grey, never green.
COLOURS = {
    ToolCollision.UNKNOWN: (0.6, 0.6, 0.6),
    ToolCollision.CLEAR: (0.2, 0.85, 0.35),
    ToolCollision.WARNING: (1.0, 0.75, 0.1),
    ToolCollision.COLLISION: (1.0, 0.15, 0.1),
}
BONE = ColorRGBA(0.93, 0.9, 0.8, 0.55)
# Two triangles a face, corners in the order of saras.collision (0-1-2-3 and 4-5-6-7 are opposite faces).
_FACES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (3, 2, 6, 7), (0, 3, 7, 4), (1, 5, 6, 2))
LABEL_ABOVE_M = 0.02
LINE_M = 0.0015


def of(state: CollisionState, regions: np.ndarray, regions_frame: str) -> MarkerArray:
    """All markers. regions: (n, 8, 3) in regions_frame [m]."""
    markers = [_regions(regions, regions_frame)] if len(regions) else []
    for tool in state.tools:
        markers += _tool(tool, state.header.frame_id)
    return MarkerArray(markers)


def _regions(regions: np.ndarray, frame: str) -> Marker:
    """All boxes in one marker: a thousand of them must not be a thousand messages."""
    marker = new_marker("forbidden regions", Marker.TRIANGLE_LIST, frame, BONE, (1.0, 1.0, 1.0))
    for corners in regions:
        points = [Point(*corner) for corner in corners.tolist()]
        for a, b, c, d in _FACES:
            marker.points += [points[a], points[b], points[c], points[a], points[c], points[d]]
    return marker


def _tool(tool: ToolCollision, frame: str) -> list[Marker]:
    names = [f"{tool.name} {part}" for part in ("shaft", "ends", "witness", "distance")]
    if not _finite(tool.tip, tool.trocar):
        # Where it is cannot be drawn; that it is unknown is said by the line of text in /diagnostics and the table.
        return [remove(name) for name in names]
    colour = ColorRGBA(*COLOURS[tool.state], 0.65)
    shaft = new_marker(names[0], Marker.CYLINDER, frame, colour, (2.0 * tool.radius, 2.0 * tool.radius, 0.0))
    tip, trocar = (np.array([p.x, p.y, p.z]) for p in (tool.tip, tool.trocar))
    _along(shaft, tip, trocar)
    ends = new_marker(names[1], Marker.SPHERE_LIST, frame, colour, (2.0 * tool.radius,) * 3)
    ends.points = [tool.tip, tool.trocar]
    return [shaft, ends, *_witness(tool, frame, names[2], names[3])]


def _witness(tool: ToolCollision, frame: str, line_name: str, label_name: str) -> list[Marker]:
    if not _finite(tool.on_tool, tool.on_partner):
        return [remove(line_name), remove(label_name)]
    colour = ColorRGBA(*COLOURS[tool.state], 1.0)
    line = new_marker(line_name, Marker.LINE_LIST, frame, colour, (LINE_M, 0.0, 0.0))
    line.points = [tool.on_tool, tool.on_partner]
    label = new_marker(label_name, Marker.TEXT_VIEW_FACING, frame, colour, (0.0, 0.0, 0.012))
    a, b = tool.on_tool, tool.on_partner
    label.pose.position = Point(0.5 * (a.x + b.x), 0.5 * (a.y + b.y), 0.5 * (a.z + b.z) + LABEL_ABOVE_M)
    label.text = f"{1e3 * tool.known_distance:.1f} mm" + (" ?" if tool.state == ToolCollision.UNKNOWN else "")
    return [line, label]


def _along(marker: Marker, begin: np.ndarray, end: np.ndarray) -> None:
    """A cylinder's z axis from begin to end."""
    middle, axis = 0.5 * (begin + end), end - begin
    length = float(np.linalg.norm(axis))
    marker.scale.z = max(length, 1e-6)
    marker.pose.position = Point(*middle.tolist())
    x, y, z = (axis / length).tolist() if length > 0.0 else (0.0, 0.0, 1.0)
    # Half-way rotation from z; antiparallel: half a turn about x.
    w = math.sqrt(0.5 * (1.0 + z)) if z > -1.0 + 1e-12 else 0.0
    q = marker.pose.orientation
    q.x, q.y, q.z, q.w = (-y / (2.0 * w), x / (2.0 * w), 0.0, w) if w > 0.0 else (1.0, 0.0, 0.0, 0.0)


def _finite(*points: Point) -> bool:
    return all(math.isfinite(value) for point in points for value in (point.x, point.y, point.z))
