"""Random and degenerate pairs for the collision room, and what decides independently whether a distance is right.

Apart, a distance is proved by its own witnesses: they lie on the two shapes, and two planes across the normal through
them have the shapes on their outer sides. No formula of ours enters. Near zero gap, where a normal has no digits left,
and inside, scipy decides: bounded least squares, and the facets of the hull of the Minkowski difference.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import lsq_linear
from scipy.spatial import ConvexHull, QhullError

SEPARATED_TOLERANCE_M = 1e-9
DEPTH_TOLERANCE_M = 1e-7
SIGNS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)


def rotation(rng):
    q = rng.normal(size=4)
    w, x, y, z = q / np.linalg.norm(q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


def unit(rng):
    v = rng.normal(size=3)
    return v / np.linalg.norm(v)


def radius(rng):
    return float(rng.choice([0.0, 0.0025, 0.0042, rng.uniform(0, 0.1)]))


# --- capsule - capsule ---------------------------------------------------------------------------------------------


def _random(rng, a0, a1, ra, rb):
    return a0, a1, ra, rng.uniform(-0.5, 0.5, 3), rng.uniform(-0.5, 0.5, 3), rb


def _parallel(rng, a0, a1, ra, rb):
    b0 = a0 + rng.uniform(-0.5, 0.5, 3)
    return a0, a1, ra, b0, b0 + rng.uniform(-2, 2) * (a1 - a0), rb


def _nearly_parallel(rng, a0, a1, ra, rb):
    b0 = a0 + rng.uniform(-0.1, 0.1) * unit(rng) * rng.choice([0, 1e-9, 1])
    return a0, a1, ra, b0, b0 + rng.uniform(-2, 2) * (a1 - a0) + 10.0 ** rng.uniform(-16, -2) * unit(rng), rb


def _crossing(rng, a0, a1, ra, rb):
    middle = a0 + rng.choice([0.0, 0.5, 1.0, rng.uniform()]) * (a1 - a0)
    b = rng.uniform(-0.5, 0.5, 3)
    return a0, a1, ra, middle - b, middle + rng.uniform(0, 1) * b, rb


def _collinear(rng, a0, a1, ra, rb):
    s = rng.choice([0.0, 1.0, -0.5, 0.3, 1.5, rng.uniform(-2, 2)], size=2)
    return a0, a1, ra, a0 + s[0] * (a1 - a0), a0 + s[1] * (a1 - a0), rb


def _coincident(rng, a0, a1, ra, rb):
    return (a0, a1, ra, a0, a1, rb) if rng.random() < 0.5 else (a0, a1, ra, a1, a0, rb)


def _points(rng, a0, a1, ra, rb):
    b0 = rng.choice([0.0, 1.0]) * rng.uniform(-0.1, 0.1, 3) + a0
    which = rng.integers(3)
    return a0, (a0 if which else a1), ra, b0, (b0 if which != 1 else b0 + 0.1 * unit(rng)), rb


def _touching(rng, a0, a1, ra, rb):
    a1 = a0 + 0.3 * unit(rng)
    n = np.cross(a1 - a0, unit(rng))
    n /= np.linalg.norm(n)
    b0 = a0 + rng.uniform() * (a1 - a0) + (ra + rb) * n
    along = np.cross(n, unit(rng))
    return a0, a1, ra, b0 - rng.uniform() * along, b0 + rng.uniform() * along, rb


CAPSULE_KINDS = [_random, _parallel, _nearly_parallel, _crossing, _collinear, _coincident, _points, _touching]


def capsule_pair(rng, kind):
    a0 = rng.uniform(-0.5, 0.5, 3) * rng.choice([1.0, 1.0, 0.01])
    return CAPSULE_KINDS[kind % len(CAPSULE_KINDS)](rng, a0, a0 + rng.uniform(-0.5, 0.5, 3), radius(rng), radius(rng))


# --- capsule - parallelepiped --------------------------------------------------------------------------------------


@dataclass
class Region:
    """center + edges @ u, |u_i| <= 1/2; edges as columns."""

    center: np.ndarray
    edges: np.ndarray

    @property
    def vertices(self):
        v0 = self.center - 0.5 * self.edges.sum(axis=1)
        x, y, z = self.edges.T
        return np.array([v0, v0 + x, v0 + x + z, v0 + z, v0 + y, v0 + y + x, v0 + y + x + z, v0 + y + z])


def region(rng, skewed):
    size = 10.0 ** rng.uniform(-2, 0, 3)
    edges = np.eye(3) if rng.random() < 0.2 else rotation(rng)
    if skewed:
        shear = np.eye(3) + np.triu(rng.uniform(-1.5, 1.5, (3, 3)), 1)
        edges = edges @ shear
    return Region(rng.uniform(-0.5, 0.5, 3) * rng.choice([0.0, 1.0]), edges * size)


def at(box, u):
    """A point by its coordinates along the half edges."""
    return box.center + 0.5 * box.edges @ np.asarray(u, dtype=float)


def _box_random(rng, box):
    return rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3)


def _box_contained(rng, box):
    return at(box, rng.uniform(-1, 1, 3)), at(box, rng.uniform(-1, 1, 3))


def _box_one_inside(rng, box):
    return at(box, rng.uniform(-1, 1, 3)), rng.uniform(-1, 1, 3)


def _box_piercing(rng, box):
    u = rng.uniform(-0.99, 0.99, 3)
    axis = rng.integers(3)
    u[axis] = -rng.uniform(1, 3)
    v = rng.uniform(-0.99, 0.99, 3)
    v[axis] = rng.uniform(1, 3)
    return at(box, u), at(box, v)


def _box_along_an_edge(rng, box):
    a = rng.uniform(-1, 1, 3) if rng.random() < 0.5 else at(box, rng.choice([-1, -0.5, 0, 1, 1.5], size=3))
    along = box.edges[:, rng.integers(3)] * rng.uniform(-2, 2)
    return a, a + along + rng.choice([0.0, 10.0 ** rng.uniform(-16, -3)]) * unit(rng)


def _box_along_a_face(rng, box):
    i = rng.integers(3)
    u = rng.uniform(-1.5, 1.5, 3)
    v = rng.uniform(-1.5, 1.5, 3)
    u[i] = v[i] = rng.choice([-1.0, 1.0, 1.2, 0.3])
    return at(box, u), at(box, v)


def _box_at_a_corner(rng, box):
    corner = at(box, rng.choice([-1.0, 1.0], size=3))
    away = unit(rng) * rng.choice([0.0, 0.1])
    return corner + away * rng.choice([0.0, -0.5, 1.0]), corner + away


def _box_point(rng, box):
    a = at(box, rng.choice([0.0, 0.3, 1.0, 1.3], size=3) * rng.choice([-1, 1], size=3))
    return a, a


def _box_through_the_centre(rng, box):
    d = unit(rng) * rng.uniform(0, 2)
    return box.center - d, box.center + d


BOX_KINDS = [
    _box_random,
    _box_contained,
    _box_one_inside,
    _box_piercing,
    _box_along_an_edge,
    _box_along_a_face,
    _box_at_a_corner,
    _box_point,
    _box_through_the_centre,
]


def box_pair(rng, kind):
    """a0, a1, r, Region: rectangular ones and skewed ones in turn."""
    box = region(rng, skewed=bool(kind % 2))
    a0, a1 = BOX_KINDS[(kind // 2) % len(BOX_KINDS)](rng, box)
    return a0, a1, radius(rng), box


# --- oracles -------------------------------------------------------------------------------------------------------


def least_squares_gap(a0, a1, origin, edges):
    """Distance of a segment from {origin + edges @ x, 0 <= x <= 1} by bounded least squares."""
    matrix = np.column_stack([a1 - a0, -edges])
    keep = np.linalg.norm(matrix, axis=0) > 0
    if not keep.any():
        return float(np.linalg.norm(a0 - origin))
    best = np.inf
    for method in ("bvls", "trf"):
        try:
            x = np.clip(
                lsq_linear(
                    matrix[:, keep], origin - a0, (0, 1), method=method, tol=1e-15, lsmr_tol=None, max_iter=200
                ).x,
                0,
                1,
            )
        except (ValueError, np.linalg.LinAlgError):
            continue
        best = min(best, float(np.linalg.norm(matrix[:, keep] @ x - (origin - a0))))
    return best


def hull_depth(a0, a1, box):
    """Depth of the origin in the Minkowski difference of box and segment; negative when outside. By its facets."""
    points = np.concatenate([box.vertices - a0, box.vertices - a1])
    try:
        hull = ConvexHull(points)
    except QhullError:
        hull = ConvexHull(points, qhull_options="QJ")
    return float(-hull.equations[:, 3].max())


def segment_support(n, a0, a1):
    return np.maximum((n * a0).sum(1), (n * a1).sum(1))


def distance_to_segment(p, a0, a1):
    d = a1 - a0
    dd = (d * d).sum(1)
    t = np.clip(((p - a0) * d).sum(1) / np.where(dd > 0, dd, 1.0), 0, 1)
    return np.linalg.norm(p - a0 - t[:, None] * d, axis=1)


def stack(results, name):
    return np.array([getattr(result, name) for result in results])
