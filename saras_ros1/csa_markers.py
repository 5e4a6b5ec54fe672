"""Markers of situational awareness: model, proxy, closest point, force, region, tip and why nobody moves. Pure."""

from __future__ import annotations

import math
import textwrap
from typing import Any

import numpy as np
from geometry_msgs.msg import Point
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from saras_ros1.markers import GREY, RED, WHITE, new_marker, remove

METRES_PER_N = 0.006
SMALLEST_N = 0.02
WALL_M = 0.006
PLATE_M, THICKNESS_M = 0.08, 0.02
GREEN = ColorRGBA(0.2, 0.9, 0.3, 1.0)
SILICONE = ColorRGBA(1.0, 0.8, 0.7, 0.32)
LUMP = ColorRGBA(0.6, 0.15, 0.15, 0.5)
MODEL = ColorRGBA(0.4, 0.7, 1.0, 0.08)
REGION = ColorRGBA(1.0, 0.8, 0.1, 1.0)
TRAIL = ColorRGBA(0.35, 0.55, 0.95, 1.0)
NEXT = ColorRGBA(0.9, 0.3, 0.9, 1.0)
STATES = ("NO CONTACT", "PROXY CONTACT", "SLAVE CONTACT", "FULL CONTACT")


def block(namespace: str, frame: str, top: np.ndarray, height_m: float, colour: ColorRGBA) -> Marker:
    """A plate whose upper face's middle is at (3,)."""
    marker = new_marker(namespace, Marker.CUBE, frame, colour, (PLATE_M, PLATE_M, height_m))
    marker.pose.position = Point(top[0], top[1], top[2] - 0.5 * height_m)
    return marker


def lump(frame: str, at: np.ndarray, radius_m: float) -> Marker:
    """Where the phantom is stiff, as the simulator alone knows: a disc under its surface."""
    marker = new_marker("stiff lump", Marker.CYLINDER, frame, LUMP, (2 * radius_m, 2 * radius_m, 0.0004))
    marker.pose.position = Point(*at.tolist())
    return marker


def shaft(namespace: str, frame: str, tip: Point | None, colour: ColorRGBA, width_m: float) -> Marker:
    """From the trocar, the frame's origin, to a tip."""
    if tip is None:
        return remove(namespace)
    marker = new_marker(namespace, Marker.LINE_LIST, frame, colour, (width_m, 0.0, 0.0))
    marker.points = [Point(0.0, 0.0, 0.0), tip]
    return marker


def force(frame: str, at: Point | None, wrench: Any | None) -> Marker:
    """The wrench on the hand, from the model's closest point; its length is its magnitude."""
    if at is None or wrench is None:
        return remove("force on the hand")
    f = wrench.wrench.force
    if not math.hypot(f.x, f.y, f.z) >= SMALLEST_N:
        return remove("force on the hand")
    marker = new_marker("force on the hand", Marker.ARROW, frame, RED, (0.0012, 0.003, 0.003))
    k = METRES_PER_N
    marker.points = [at, Point(at.x + k * f.x, at.y + k * f.y, at.z + k * f.z)]
    return marker


def region(frame: str, points: list[Any], closed: bool) -> list[Marker]:
    """Picked points; the walls of a closed region."""
    if not points:
        return [remove("picked"), remove("region"), remove("border")]
    dots = new_marker("picked", Marker.SPHERE_LIST, frame, REGION, (0.0016, 0.0016, 0.0016))
    dots.points = [Point(p.x, p.y, p.z) for p in points]
    if not closed or len(points) < 3:
        return [dots, remove("region"), remove("border")]
    walls = new_marker("region", Marker.TRIANGLE_LIST, frame, REGION, (1.0, 1.0, 1.0))
    walls.color = ColorRGBA(REGION.r, REGION.g, REGION.b, 0.25)
    ring = hull(dots.points)
    for a, b in zip(ring, [*ring[1:], ring[0]]):
        above_a, above_b = _above(a, b)
        walls.points += [a, b, above_b, a, above_b, above_a, a, above_b, b, a, above_a, above_b]
    border = new_marker("border", Marker.LINE_LIST, frame, REGION, (0.0004, 0.0, 0.0))
    border.points = [p for a, b in zip(ring, [*ring[1:], ring[0]]) for p in (a, b, *_above(a, b), a, *_above(a))]
    return [dots, walls, border]


def _above(*points: Point) -> list[Point]:
    return [Point(p.x, p.y, p.z + WALL_M) for p in points]


def hull(points: list[Point]) -> list[Point]:
    """The corners of the convex hull seen from above, in order."""
    ordered = sorted(points, key=lambda p: (p.x, p.y))

    def half(line: list[Point]) -> list[Point]:
        chain: list[Point] = []
        for p in line:
            while len(chain) > 1:
                a, b = chain[-2], chain[-1]
                if (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) > 0.0:
                    break
                chain.pop()
            chain.append(p)
        return chain[:-1]

    return half(ordered) + half(ordered[::-1])


def trail(frame: str, points: list[Point]) -> Marker:
    """Where the tip touched."""
    if not points:
        return remove("touched")
    marker = new_marker("touched", Marker.POINTS, frame, TRAIL, (0.0005, 0.0005, 0.0))
    marker.points = points
    return marker


def label(frame: str, at: np.ndarray, told: Any | None, did: Any | None) -> Marker:
    """Contact state and force; a hold with its reason."""
    marker = new_marker("state", Marker.TEXT_VIEW_FACING, frame, WHITE, (0.0, 0.0, 0.0032))
    marker.pose.position = Point(*at.tolist())
    if told is None:
        marker.text, marker.color = "?", GREY
        return marker
    state = STATES[told.state] if told.state < len(STATES) else "?"
    lines = [state]
    reason = told.reason if told.hold else did.reason if did is not None and did.hold else ""
    if reason:
        marker.color = RED
        lines = [f"HOLD in {state}", *textwrap.wrap(reason, 40)]
    elif did is not None and math.isfinite(did.desired_force_N):
        lines = [f"{state}    {did.normal_force_N:.1f} N of {did.desired_force_N:.1f} N"]
    marker.text = "\n".join(lines)
    return marker
