"""Primitives for script/make_meshes. A mesh is (n, 3, 3): triangles, counter-clockwise seen from outside [m]."""

from __future__ import annotations

import math

import numpy as np

SEGMENTS = 32


def lathe(profile, closed=False, segments=SEGMENTS):
    """Turns a profile [(radius, z), …] about z. closed: the profile is a ring that stays off the axis."""
    points = np.array(profile, dtype=float)
    if closed:
        points = np.vstack([points, points[:1]])
    # The walls face outwards when the profile runs counter-clockwise in the (radius, z) plane.
    area = np.sum(points[:-1, 0] * points[1:, 1] - points[1:, 0] * points[:-1, 1])
    if not closed:
        area += points[-1, 0] * points[0, 1] - points[0, 0] * points[-1, 1]
    if area < 0:
        points = points[::-1]
    if not closed:  # an open end off the axis is closed by a disc
        ends = [[0.0, points[0, 1]]] if points[0, 0] > 0 else []
        points = np.vstack([*ends, points] + ([[[0.0, points[-1, 1]]]] if points[-1, 0] > 0 else []))
    angles = np.linspace(0.0, 2.0 * math.pi, segments, endpoint=False)
    rings = [np.column_stack([r * np.cos(angles), r * np.sin(angles), np.full(segments, z)]) for r, z in points]
    return _strip(rings)


def cylinder(radius, height):
    """On z = 0, along +z."""
    return lathe([(0, 0), (radius, 0), (radius, height), (0, height)])


def sphere(radius):
    """About the origin."""
    angles = np.linspace(-math.pi / 2, math.pi / 2, SEGMENTS // 2 + 1)
    return lathe(np.column_stack([np.maximum(radius * np.cos(angles), 0.0), radius * np.sin(angles)]))


def torus(radius, tube):
    """About z in the plane z = 0."""
    angles = np.linspace(0.0, 2.0 * math.pi, 16, endpoint=False)
    return lathe(np.column_stack([radius + tube * np.cos(angles), tube * np.sin(angles)]), closed=True)


def slot(length, first_radius, last_radius):
    """(n, 2) outline around two circles, at the origin and at (length, 0)."""
    lean = math.asin((first_radius - last_radius) / length)
    steps = SEGMENTS // 2
    last = np.linspace(-math.pi / 2 + lean, math.pi / 2 - lean, steps)
    first = np.linspace(math.pi / 2 - lean, 3 * math.pi / 2 + lean, steps)
    return np.vstack(
        [
            np.column_stack([length + last_radius * np.cos(last), last_radius * np.sin(last)]),
            np.column_stack([first_radius * np.cos(first), first_radius * np.sin(first)]),
        ]
    )


def superellipse(a, b, exponent, segments=SEGMENTS):
    """(n, 2) outline |x/a|^e + |y/b|^e = 1."""
    angles = np.linspace(0.0, 2.0 * math.pi, segments, endpoint=False)
    c, s = np.cos(angles), np.sin(angles)
    return np.column_stack(
        [a * np.sign(c) * np.abs(c) ** (2.0 / exponent), b * np.sign(s) * np.abs(s) ** (2.0 / exponent)]
    )


def extrude(outline, height, bevel):
    """A convex outline from z = 0 to height, its edges rounded by bevel."""
    outline = np.asarray(outline)
    layers = []
    for k in range(4):
        angle = k / 3 * math.pi / 2
        layers.append((bevel * (1 - math.sin(angle)), bevel * (1 - math.cos(angle))))
    layers += [(inset, height - z) for inset, z in reversed(layers)]
    rings = []
    for inset, z in layers:
        ring = _inset(outline, inset)
        rings.append(np.column_stack([ring, np.full(len(ring), z)]))
    return loft(rings)


def box(size, bevel):
    """A rounded box about the origin with full edge lengths size."""
    x, y, z = size
    angles = np.linspace(0.0, math.pi / 2, 5)
    radius = 1.01 * bevel  # so that the inset leaves an outline
    corners = [((x / 2, y / 2), 0.0), ((-x / 2, y / 2), 0.5), ((-x / 2, -y / 2), 1.0), ((x / 2, -y / 2), 1.5)]
    outline = []
    for (cx, cy), quarter in corners:
        centre = np.array([cx - math.copysign(radius, cx), cy - math.copysign(radius, cy)])
        a = angles + quarter * math.pi
        outline.append(centre + radius * np.column_stack([np.cos(a), np.sin(a)]))
    return move(extrude(np.vstack(outline), z, bevel), (0, 0, -z / 2))


def dome(radius, height):
    """Profile of a flat dome on z = 0."""
    return [(radius, 0), (radius, 0.5 * height), (0.8 * radius, 0.85 * height), (0.45 * radius, height), (0, height)]


def spokes(count, first=0.0):
    """(angle, cosine, sine) evenly around z."""
    for i in range(count):
        angle = first + 2 * math.pi * i / count
        yield angle, math.cos(angle), math.sin(angle)


def loft(rings):
    """Skin over rings (n, 3) of equal length with flat caps; rings run counter-clockwise about their direction."""
    first, last = rings[0], rings[-1]
    start, end = np.repeat(first.mean(axis=0)[None], len(first), 0), np.repeat(last.mean(axis=0)[None], len(last), 0)
    return _strip([start, *rings, end])


def move(mesh, offset, yaw=0.0, flip=False):
    """Turned about z by yaw [rad] (flip: first about x by pi), then shifted."""
    mesh = np.array(mesh)
    if flip:
        mesh = mesh * [1.0, -1.0, -1.0]
    c, s = math.cos(yaw), math.sin(yaw)
    return mesh @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + offset


def turn(mesh, axis):
    """A quarter turn about x (z to -y) or y (z to x)."""
    matrix = {"x": [[1, 0, 0], [0, 0, 1], [0, -1, 0]], "y": [[0, 0, -1], [0, 1, 0], [1, 0, 0]]}[axis]
    return np.array(mesh) @ np.array(matrix, dtype=float)


def save_stl(path, mesh):
    """Writes binary STL, degenerate triangles left out; returns its size in bytes."""
    normals = np.cross(mesh[:, 1] - mesh[:, 0], mesh[:, 2] - mesh[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    mesh, normals = mesh[areas > 1e-14], normals[areas > 1e-14] / areas[areas > 1e-14, None]
    record = np.dtype([("normal", "<f4", 3), ("vertices", "<f4", (3, 3)), ("attribute", "<u2")])
    triangles = np.zeros(len(mesh), dtype=record)
    triangles["normal"], triangles["vertices"] = normals, mesh
    path.write_bytes(b"saras".ljust(80) + np.uint32(len(mesh)).tobytes() + triangles.tobytes())
    return 84 + triangles.nbytes


def _strip(rings):
    triangles = []
    for low, high in zip(rings[:-1], rings[1:]):
        low_next, high_next = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
        triangles += [np.stack([low, low_next, high_next], axis=1), np.stack([low, high_next, high], axis=1)]
    return np.concatenate(triangles)


def _inset(outline, distance):
    """A convex counter-clockwise outline moved inwards along its vertex normals."""
    edge = np.roll(outline, -1, axis=0) - outline
    length = np.linalg.norm(edge, axis=1, keepdims=True)
    edge = np.where(length > 1e-12, edge / np.maximum(length, 1e-12), 0.0)
    inward = np.column_stack([-edge[:, 1], edge[:, 0]])
    normal = inward + np.roll(inward, 1, axis=0)
    scale = np.maximum(np.sum(normal * normal, axis=1, keepdims=True) / 2.0, 1e-9)
    return outline + distance * normal / scale
