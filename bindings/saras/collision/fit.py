"""Oriented boxes around a bone's mesh: forbidden regions that cover its whole surface.

Triangles are split in halves again and again, each going whole to one side, and each group gets a small box. A box is
convex and holds all corners of its triangles, so it holds the triangles: the union covers the surface by construction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.collision.forbidden_regions import box_vertices

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

#: More boxes than this are not tried to reach a tolerance.
MAX_BOXES = 2000
_SAMPLES = 20_000
_SEED = 1


@dataclass(frozen=True)
class Box:
    """An oriented box around some triangles: p = center + axes @ u, |u_i| <= half_i."""

    triangles: Indices
    axes: Array
    center: Array
    half: Array

    @property
    def volume(self) -> float:
        """In m³."""
        return float(8.0 * self.half.prod())

    @property
    def vertices(self) -> Array:
        """(8, 3) in the order of vertices.txt [m]."""
        return box_vertices(self.center, 2.0 * self.half, self.axes)


@dataclass(frozen=True)
class Fit:
    """What fit_boxes found."""

    boxes: list[Box]
    overhang_m: float
    """How far a box stands out of the bone at most [m], sampled."""
    union_volume_m3: float
    """Sampled."""
    mesh_volume_m3: float
    """NaN for a mesh that is not closed."""

    @property
    def vertices(self) -> Array:
        """(n, 8, 3) [m], as files and scenes take them."""
        return np.array([box.vertices for box in self.boxes])

    @property
    def excess(self) -> float:
        """Volume of the union beyond that of the mesh, relative to the mesh; NaN for a mesh that is not closed."""
        return self.union_volume_m3 / self.mesh_volume_m3 - 1.0


def fit_boxes(
    points: npt.ArrayLike,
    faces: npt.ArrayLike,
    count: int | None = None,
    tolerance_m: float | None = None,
    margin_m: float = 1e-4,
) -> Fit:
    """Boxes around the triangles ``points[faces]``, points (n, 3) [m], faces (k, 3).

    Either ``count`` boxes, or as many as it takes until none stands out of the bone by more than ``tolerance_m``
    (sampled; with the margin in it). Each box is ``margin_m`` larger on every side. Raises ConfigError naming the value
    and the bound; also when MAX_BOXES do not reach the tolerance.
    """
    triangles = _triangles(points, faces)
    if (count is None) == (tolerance_m is None):
        raise ConfigError("count, tolerance_m: must be given one of them")
    if count is not None and not 1 <= count <= MAX_BOXES:
        raise ConfigError(f"count = {count}: must be in [1, {MAX_BOXES}]")
    if not (np.isfinite(margin_m) and margin_m >= 1e-6):
        raise ConfigError(f"margin_m = {margin_m}: must be at least 1e-06")
    if tolerance_m is not None and not tolerance_m > 2.0 * margin_m:
        raise ConfigError(f"tolerance_m = {tolerance_m}: must be > {2.0 * margin_m} (twice the margin)")
    surface = _Surface(triangles)
    boxes = [_box(triangles, np.arange(len(triangles)), margin_m)]
    halves: dict[int, tuple[Box, Box] | None] = {}

    def split(box: Box) -> tuple[Box, Box] | None:
        if id(box) not in halves:
            halves[id(box)] = _split(triangles, box, margin_m)
        return halves[id(box)]

    def gain(box: Box) -> float:
        parts = split(box)
        return -np.inf if parts is None else box.volume - parts[0].volume - parts[1].volume

    overhang = {id(boxes[0]): surface.overhang(boxes[0])}
    kept = [boxes[0]]  # ids stay unique as long as their boxes live
    while True:
        if count is not None:
            worst = max(boxes, key=gain)
            done = len(boxes) >= count
        else:
            worst = max(boxes, key=lambda box: overhang[id(box)])
            done = overhang[id(worst)] <= float(tolerance_m or 0.0)
        parts = None if done else split(worst)
        if parts is None:
            break
        if len(boxes) >= MAX_BOXES:
            raise ConfigError(
                f"tolerance_m = {tolerance_m}: {MAX_BOXES} boxes still stand out by {overhang[id(worst)]:.4g} m"
            )
        boxes = [box for box in boxes if box is not worst] + list(parts)
        kept += parts
        overhang.update((id(box), surface.overhang(box)) for box in parts)
    largest = max(overhang[id(box)] for box in boxes)
    if tolerance_m is not None and largest > tolerance_m:
        raise ConfigError(f"tolerance_m = {tolerance_m}: a single triangle's box stands out by {largest:.4g} m")
    return Fit(boxes, largest, _union_volume(boxes), _volume(triangles))


def covered(points: npt.ArrayLike, boxes: list[Box], slack_m: float = 0.0) -> npt.NDArray[np.bool_]:
    """(n,) whether each point (n, 3) lies in some box."""
    points = np.asarray(points, dtype=float)
    inside = np.zeros(len(points), dtype=bool)
    for box in boxes:
        inside |= (np.abs((points - box.center) @ box.axes) <= box.half + slack_m).all(axis=1)
    return inside


def _triangles(points: npt.ArrayLike, faces: npt.ArrayLike) -> Array:
    points, faces = np.asarray(points, dtype=float), np.asarray(faces)
    if points.ndim != 2 or points.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3 or len(faces) == 0:
        raise ConfigError(f"mesh: points {points.shape}, faces {faces.shape}: must be (n, 3) and (k, 3), k >= 1")
    if not np.isfinite(points).all():
        raise ConfigError(f"mesh: point {int(np.flatnonzero(~np.isfinite(points).all(axis=1))[0])} is not finite")
    if not (np.issubdtype(faces.dtype, np.integer) and faces.min() >= 0 and faces.max() < len(points)):
        raise ConfigError(f"mesh: faces must be whole numbers in [0, {len(points) - 1}]")
    triangles: Array = points[faces]
    return triangles


def _frames(points: Array) -> list[Array]:
    """Candidate axes (3, 3), columns: principal axes, and those turned to the least rectangle across each of them."""
    from scipy.spatial import ConvexHull, QhullError

    principal = np.linalg.svd(points - points.mean(axis=0), full_matrices=True)[2].T if len(points) > 1 else np.eye(3)
    principal = np.column_stack([principal[:, 0], principal[:, 1], np.cross(principal[:, 0], principal[:, 1])])
    frames = [np.eye(3), principal]
    for i in range(3):
        across = principal[:, [(i + 1) % 3, (i + 2) % 3]]
        flat = points @ across
        try:
            hull = flat[ConvexHull(flat).vertices]
        except (QhullError, ValueError):
            continue  # all on a line
        edges = np.diff(np.vstack([hull, hull[:1]]), axis=0)
        angles = np.arctan2(edges[:, 1], edges[:, 0])
        x = np.column_stack([np.cos(angles), np.sin(angles)])
        y = np.column_stack([-np.sin(angles), np.cos(angles)])
        best = int(np.argmin(np.ptp(hull @ x.T, axis=0) * np.ptp(hull @ y.T, axis=0)))
        frames.append(np.column_stack([across @ x[best], across @ y[best], principal[:, i]]))
    return frames


def _box(triangles: Array, members: Indices, margin_m: float) -> Box:
    points = triangles[members].reshape(-1, 3)
    best: Box | None = None
    for axes in _frames(points):
        u = points @ axes
        low, high = u.min(axis=0), u.max(axis=0)
        box = Box(members, axes, axes @ (0.5 * (low + high)), 0.5 * (high - low) + margin_m)
        if best is None or box.volume < best.volume:
            best = box
    assert best is not None
    return best


def _split(triangles: Array, box: Box, margin_m: float) -> tuple[Box, Box] | None:
    """The two halves of least volume, across one of the box's axes; None for a single triangle."""
    if len(box.triangles) < 2:
        return None
    along = triangles[box.triangles].mean(axis=1) @ box.axes
    best: tuple[Box, Box] | None = None
    for axis in range(3):
        u = along[:, axis]
        for cut in {float(np.median(u)), 0.5 * float(u.min() + u.max())}:
            first = u <= cut if cut < u.max() else u < cut
            if not first.any() or first.all():
                continue
            parts = (
                _box(triangles, box.triangles[first], margin_m),
                _box(triangles, box.triangles[~first], margin_m),
            )
            if best is None or sum(part.volume for part in parts) < sum(part.volume for part in best):
                best = parts
    if best is None:  # all centroids coincide
        half = len(box.triangles) // 2
        best = (
            _box(triangles, box.triangles[:half], margin_m),
            _box(triangles, box.triangles[half:], margin_m),
        )
    return best


class _Surface:
    """Dense samples of the surface with outward normals: how far a point stands out of the bone."""

    def __init__(self, triangles: Array) -> None:
        from scipy.spatial import cKDTree

        rng = np.random.default_rng(_SEED)
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        areas = np.linalg.norm(normals, axis=1)
        share = areas / areas.sum() if areas.sum() > 0 else np.full(len(areas), 1.0 / len(areas))
        chosen = rng.choice(len(triangles), size=_SAMPLES, p=share)
        a, b = rng.random((2, _SAMPLES, 1))
        a, b = np.where(a + b > 1, 1 - a, a), np.where(a + b > 1, 1 - b, b)
        t = triangles[chosen]
        # Corners too: a box often touches the bone there, and a sample of a big triangle may be far.
        samples = np.concatenate(
            [t[:, 0] + a * (t[:, 1] - t[:, 0]) + b * (t[:, 2] - t[:, 0]), triangles.reshape(-1, 3)]
        )
        self._normals = np.concatenate([normals[chosen], np.repeat(normals, 3, axis=0)])
        self._samples = samples
        self._tree = cKDTree(samples)

    def overhang(self, box: Box) -> float:
        """Greatest distance from the bone of points on the box's surface that are outside of the bone [m]."""
        grid = np.linspace(-1, 1, 7)
        u, v = (m.ravel() for m in np.meshgrid(grid, grid))
        one = np.ones_like(u)
        sides = [np.roll(np.column_stack([s * one, u, v]), k, axis=1) for s in (-1.0, 1.0) for k in range(3)]
        points = box.center + (np.concatenate(sides) * box.half) @ box.axes.T
        distance, nearest = self._tree.query(points)
        outside = ((points - self._samples[nearest]) * self._normals[nearest]).sum(axis=1) > 0.0
        return float(distance[outside].max(initial=0.0))


def _union_volume(boxes: list[Box], samples: int = 200_000) -> float:
    corners = np.concatenate([box.vertices for box in boxes])
    low, high = corners.min(axis=0), corners.max(axis=0)
    points = np.random.default_rng(_SEED).uniform(low, high, (samples, 3))
    return float(covered(points, boxes).mean() * (high - low).prod())


def _volume(triangles: Array) -> float:
    """By the divergence theorem; NaN unless each edge is met once in each direction."""
    keys = {tuple(point) for point in triangles.reshape(-1, 3)}
    number = {key: i for i, key in enumerate(keys)}
    faces = np.array([[number[tuple(point)] for point in triangle] for triangle in triangles])
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there, back = ({*map(tuple, e)} for e in (edges, edges[:, ::-1]))
    if there != back or len(there) != len(edges):
        return float("nan")
    return float(abs(np.einsum("ni,ni->n", triangles[:, 0], np.cross(triangles[:, 1], triangles[:, 2])).sum()) / 6.0)


__all__ = ["MAX_BOXES", "Box", "Fit", "covered", "fit_boxes"]
