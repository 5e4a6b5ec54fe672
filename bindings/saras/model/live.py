"""A map that is learned, looked at and laid anew by several threads at once: learning waits for nobody for long."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from saras._core import model as _core
from saras.model.learning import learn_hyperparameters
from saras.model.region import Region
from saras.model.registering import DeformationGrid, Mesh
from saras.model.stiffness_map import SurfaceEstimates
from saras.model.storage import StiffMesh

Array = npt.NDArray[np.float64]
VERDICTS = {int(value): name for name, value in _core.SampleVerdict.__members__.items()}


@dataclass(frozen=True)
class Snapshot:
    """What was known at one moment; nobody changes it."""

    grid: _core.HashGrid
    config: _core.LocalModelConfig
    generation: int
    """counts how often everything was forgotten"""

    def estimate(self, points: npt.ArrayLike, *, normals: npt.ArrayLike | None = None) -> SurfaceEstimates:
        """All that is known at (n, 3) points [m]. Runs without the GIL."""
        at = np.asarray(points, dtype=float).reshape(-1, 3)
        return SurfaceEstimates(**_core.estimate_surfaces(self.grid, self.config, at, normals))


@dataclass(frozen=True)
class Bending:
    """How the prior mesh is laid to what was touched."""

    spacing_m: float = 0.02
    """between the corners that carry displacements"""
    strain: float = 0.1
    """standard deviation of neighbouring corners' difference per spacing"""
    travel_m: float = 0.02
    """standard deviation of a corner's way"""
    slide_m: float = 2e-3
    """standard deviation of a touched point along the surface"""
    points: int = 200
    """at most so many touched places are used"""
    min_points: int = 12
    """with fewer nothing is bent"""
    surface_std_m: float = 1e-3
    """places whose surface is known worse are not used"""


@dataclass
class Laid:
    """The mesh as it lies now, and what is known at each vertex."""

    mesh: Mesh
    vertices: Array
    """(n, 3) base frame [m]"""
    normals: Array
    """(n, 3) outward"""
    stiffness_N_m: Array
    """(n,) NaN: not known"""
    stiffness_std_N_m: Array
    """(n,) infinite: not known"""
    generation: int

    def stiffest(self, region: Region | None = None, margin_m: float = 1e-3) -> int | None:
        """The vertex, in the region, whose stiffness less a deviation is greatest; None: nothing is known there."""
        surely = np.where(np.isfinite(self.stiffness_N_m), self.stiffness_N_m - self.stiffness_std_N_m, -np.inf)
        if region is not None:
            surely = np.where(region.contains(self.vertices, margin_m), surely, -np.inf)
        best = int(surely.argmax())
        return best if np.isfinite(surely[best]) else None


class LiveMap:
    """prior: the coarse mesh in the base frame. One thread may learn, others refresh, bend, plan and look.

    free_m: the tip is believed to touch nothing when it is so far outside the mesh; the sensor's offset is taken then.
    """

    def __init__(
        self,
        prior: Mesh,
        config: _core.StiffnessGpConfig | None = None,
        bending: Bending | None = None,
        *,
        free_m: float = 5e-3,
    ) -> None:
        self.config = _core.StiffnessGpConfig() if config is None else config
        self.bending = Bending() if bending is None else bending
        self._law = _core.StiffnessGp(self.config)
        self._learning, self._showing = threading.Lock(), threading.Lock()
        self._free_m = free_m
        self._generation = 0
        self._take(prior, None)

    def _take(self, prior: Mesh, known: StiffMesh | None) -> None:
        vertices = prior.vertices
        count = len(vertices)
        self._generation += 1
        self._base = (
            (np.full(count, np.nan), np.full(count, np.inf))
            if known is None
            else (known.stiffness_N_m, known.stiffness_std_N_m)
        )
        self._grid = DeformationGrid(prior, self.bending.spacing_m)
        self._displacements: Array | None = None
        self._laid = Laid(
            prior, vertices, prior.vertex_normals, self._base[0].copy(), self._base[1].copy(), self._generation
        )
        self._prior = prior

    # ---- learning

    def learn(self, positions: Array, forces: Array, velocities: Array, dt: float) -> dict[str, int]:
        """Samples in their order, dt [s] apart: (n, 3) [m], [N], [m/s]. How many met which SampleVerdict."""
        free = self._is_free(positions)
        said: dict[str, int] = {}
        with self._learning:
            for begin, end in _runs(free):
                part = slice(begin, end)
                if free[begin]:
                    belief = _core.TouchBelief.FREE
                    samples = zip(positions[part], forces[part], velocities[part])
                    verdicts = [int(self._law.step(x, f, dt, v, belief).verdict) for x, f, v in samples]
                else:
                    verdicts = self._law.steps(positions[part], forces[part], dt, velocities[part])[0].tolist()
                for verdict in verdicts:
                    said[VERDICTS[verdict]] = said.get(VERDICTS[verdict], 0) + 1
        return said

    def _is_free(self, positions: Array) -> npt.NDArray[np.bool_]:
        laid = self._laid
        finite = np.isfinite(positions).all(1)
        at = np.where(finite[:, None], positions, 0.0)
        closest, triangles = laid.mesh.closest(at)[:2]
        corners = laid.vertices[laid.mesh.triangles[np.asarray(triangles)]]
        normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        free: npt.NDArray[np.bool_] = finite & (((at - closest) * normal).sum(1) > self._free_m)
        return free

    def learn_hyperparameters(self) -> _core.GpLearning:
        """From what was learned; takes them over. Raises ModelError when there is too little."""
        learned = learn_hyperparameters(self.snapshot().grid, self.config.local)
        with self._learning:
            self._law.adopt(learned.hyperparameters)
        return learned

    def snapshot(self) -> Snapshot:
        """A copy; learning waits as long as it takes."""
        with self._learning:
            return Snapshot(self._law.state.grid, self._law.config.local, self._generation)

    @property
    def places(self) -> int:
        """Of samples that are remembered."""
        return len(self._law.grid)

    def sensor(self) -> tuple[Array, float]:
        """The force sensor's offset (3,) [N], the samples' mean deviation from the map [sigma]. Copies the map."""
        with self._learning:
            state = self._law.state
        return np.array(state.bias_N), float(state.disagreement)

    # ---- looking

    @property
    def laid(self) -> Laid:
        """The mesh now; its arrays are replaced, never written to."""
        return self._laid

    def refresh(self, snapshot: Snapshot, indices: npt.NDArray[np.intp] | None = None) -> Laid:
        """Asks the snapshot at the vertices of indices; None: at all of them."""
        before = self._laid
        if snapshot.generation != before.generation:
            return before
        at = slice(None) if indices is None else indices
        found = snapshot.estimate(before.vertices[at], normals=before.normals[at])
        known = found.known
        with self._showing:
            laid = self._laid
            if before.generation != laid.generation:
                return laid  # all of it was forgotten meanwhile
            stiffness, std = laid.stiffness_N_m.copy(), laid.stiffness_std_N_m.copy()
            stiffness[at] = np.where(known, found.stiffness_N_m, self._base[0][at])
            std[at] = np.where(known, found.stiffness_std_N_m, self._base[1][at])
            self._laid = Laid(laid.mesh, laid.vertices, laid.normals, stiffness, std, laid.generation)
            return self._laid

    def refresh_near(self, positions: Array, radius_m: float) -> npt.NDArray[np.intp]:
        """Asks what is learned at this moment, at the vertices within radius_m of (n, 3) positions; their indices."""
        with self._learning:  # the grid must not change meanwhile
            indices = self.near(positions, radius_m)
            if len(indices):
                self.refresh(Snapshot(self._law.grid, self._law.config.local, self._generation), indices)
        return indices

    def near(self, positions: Array, radius_m: float) -> npt.NDArray[np.intp]:
        """Indices of the vertices within radius_m of any of (n, 3) positions."""
        vertices, near = self._laid.vertices, np.zeros(len(self._laid.vertices), dtype=bool)
        for position in positions:
            near |= ((vertices - position) ** 2).sum(1) < radius_m**2
        return np.flatnonzero(near)

    # ---- where the mesh lies

    def touched(self, snapshot: Snapshot) -> tuple[Array, Array]:
        """(n, 3) points of the undisturbed surface under what was touched [m], and (n, 3, 3) covariances [m^2]."""
        b = self.bending
        places = snapshot.grid.samples[0]
        if len(places) > b.points:
            places = places[np.linspace(0, len(places) - 1, b.points).astype(int)]
        found = snapshot.estimate(places)
        use = found.known & (found.surface_std_m < b.surface_std_m)
        points, normals, std = found.surface_point[use], found.normal[use], found.surface_std_m[use]
        across = np.eye(3) * b.slide_m**2
        along = (std**2 - b.slide_m**2)[:, None, None] * normals[:, :, None] * normals[:, None, :]
        return points, across + along

    def bend(self, snapshot: Snapshot) -> float | None:
        """Lays the prior mesh to what was touched. RMS distance that is left [m]; None: too little was touched.

        Raises ModelError when what was touched cannot be met; the mesh then lies as before.
        """
        points, covariances = self.touched(snapshot)
        if len(points) < self.bending.min_points:
            return None
        with self._showing:
            laid, grid, start = self._laid, self._grid, self._displacements
        if snapshot.generation != laid.generation:
            return None
        # What the points' noise does not explain is how far the mesh is off: it must not fail the gate.
        off = float(np.median(laid.mesh.closest(points)[3]))
        bent = grid.deform(
            points,
            covariances + np.eye(3) * off,
            strain=self.bending.strain,
            travel_m=self.bending.travel_m,
            start=start,
        )
        mesh = Mesh(bent.vertices, laid.mesh.triangles)
        with self._showing:
            now = self._laid
            if laid.generation != now.generation:
                return None  # all of it was forgotten meanwhile
            self._displacements = bent.displacements
            known = now.stiffness_N_m, now.stiffness_std_N_m
            self._laid = Laid(mesh, mesh.vertices, mesh.vertex_normals, *known, now.generation)
        return float(bent.rms_m)

    # ---- kept

    def reset(self) -> None:
        """Forgets what was touched and what was loaded; the mesh lies as at the start."""
        with self._learning, self._showing:
            self._law.reset()
            self._take(self._prior, None)

    def stiff_mesh(self) -> StiffMesh:
        """To be kept in a file."""
        laid = self._laid
        return StiffMesh(laid.vertices, laid.mesh.triangles, laid.stiffness_N_m, laid.stiffness_std_N_m)

    def take(self, kept: StiffMesh) -> None:
        """The kept map is the prior from now on: shown where nothing is touched. What was touched is forgotten."""
        prior = Mesh(kept.vertices, kept.triangles)
        with self._learning, self._showing:
            self._law.reset()
            self._take(prior, kept)


def _runs(flags: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """(begin, end) of the stretches of equal flags."""
    edges = np.flatnonzero(np.diff(flags)) + 1
    bounds = [0, *edges.tolist(), len(flags)]
    return [(a, b) for a, b in zip(bounds, bounds[1:]) if b > a]


def refine(mesh: Mesh, vertices: int) -> Mesh:
    """Each triangle in four, as long as there are at most so many vertices."""
    points, triangles = mesh.vertices, mesh.triangles
    while True:
        edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        unique, which = np.unique(edges, axis=0, return_inverse=True)
        if len(points) + len(unique) > vertices:
            return Mesh(points, triangles)
        ab, bc, ca = (which.reshape(-1, 3) + len(points)).T
        a, b, c = triangles.T
        points = np.concatenate([points, points[unique].mean(1)])
        parts = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = np.concatenate([np.column_stack(part) for part in parts]).astype(np.int32)


__all__ = ["VERDICTS", "Bending", "Laid", "LiveMap", "Snapshot", "refine"]
