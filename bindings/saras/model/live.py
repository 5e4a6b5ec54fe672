"""A map that is learned, looked at and laid anew by several threads at once: learning waits for nobody for long.

The threads that learn and that ask what is known are C++ (saras.runtime.ModelHost); bending, hyper-parameters and plans
are computed without the GIL in whatever thread calls for them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from saras._core import model as _core
from saras.model.learning import learn_hyperparameters
from saras.model.region import Region
from saras.model.registering import DeformationGrid, Mesh, register_rigid
from saras.model.stiffness_map import SurfaceEstimates
from saras.model.storage import StiffMesh
from saras.runtime import ModelHost, ModelHostConfig

if TYPE_CHECKING:
    from saras.runtime import ModelHostStatistics

Array = npt.NDArray[np.float64]


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
    """How the prior mesh is laid to what was touched: first as a whole, then bent."""

    shift_m: float = 0.005
    """standard deviation of how far off the prior lies as a whole, each axis; 0: it is bent only"""
    turn_rad: float = 0.1
    """the same of its orientation"""
    bent_m: float = 2e-3
    """standard deviation of how far it is bent, alike for places nearer than spacing_m"""
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


@dataclass(frozen=True)
class Touched:
    """Vertices near the tip, as they are known now."""

    indices: npt.NDArray[np.int32]
    vertices: Array
    """(k, 3) base frame [m]"""
    stiffness_N_m: Array
    stiffness_std_N_m: Array


@dataclass(frozen=True)
class _Lying:
    """Where the prior lies as a whole, and how it is bent from there."""

    prior: Mesh
    grid: DeformationGrid
    base_T_prior: Array
    displacements: Array | None


class LiveMap:
    """prior: the coarse mesh in the base frame. config: law, rates and room; refused numbers raise ConfigError.

    Until start() nothing runs by itself: learn() and refresh() work in the caller's thread.
    """

    def __init__(self, prior: Mesh, config: ModelHostConfig | None = None, bending: Bending | None = None) -> None:
        self.config = ModelHostConfig() if config is None else config
        self.bending = Bending() if bending is None else bending
        self._host = ModelHost(prior, self.config)
        self._begin(prior, None)

    def _begin(self, prior: Mesh, known: StiffMesh | None) -> None:
        base = None if known is None else (known.stiffness_N_m, known.stiffness_std_N_m)
        self._base = (self._host.view()[2], base)
        self._lying = _Lying(prior, DeformationGrid(prior, self.bending.spacing_m), np.eye(4), None)

    def start(self) -> None:
        """Starts the C++ threads. Raises Error when they run."""
        self._host.start()

    def stop(self) -> None:
        """After what the threads are at; safe to repeat."""
        self._host.stop()

    # ---- learning

    def push(self, stamps: Array, positions: Array, forces: Array, velocities: Array) -> int:
        """Samples for the learning thread: (n,) [s], (n, 3) [m], [N], [m/s]. How many waiting ones were dropped."""
        return self._host.push(stamps, positions, forces, velocities)

    def learn(self, stamps: Array, positions: Array, forces: Array, velocities: Array) -> dict[str, int]:
        """Learns samples, as of push(), in this thread. How many met which SampleVerdict."""
        before = self.statistics().verdicts
        room = self.config.room
        for begin in range(0, len(stamps), room):
            part = slice(begin, begin + room)
            self._host.push(stamps[part], positions[part], forces[part], velocities[part])
            self._host.learn_waiting()
        after = self.statistics().verdicts
        return {name: n - before[name] for name, n in after.items() if n > before[name]}

    def statistics(self) -> ModelHostStatistics:
        """Counters, the sensor's offset, and how long things took."""
        return self._host.statistics()

    @property
    def failure(self) -> str:
        """Why a thread ended by itself; empty: none did."""
        return self._host.failure

    def learn_hyperparameters(self) -> _core.GpLearning:
        """From what was learned; takes them over. Raises ModelError when there is too little."""
        snapshot = self.snapshot()
        learned = learn_hyperparameters(snapshot.grid, self.config.law.local)
        self._host.adopt(learned.hyperparameters, snapshot.generation)
        return learned

    def snapshot(self) -> Snapshot:
        """A copy; learning waits as long as it takes."""
        return Snapshot(*self._host.snapshot())

    # ---- looking

    @property
    def laid(self) -> Laid:
        """The mesh now, and what is known at its vertices."""
        generation_of_base, base = self._base
        mesh, (stiffness, std), generation = self._host.view()
        if base is not None and generation_of_base == generation:
            unknown = np.isnan(stiffness)
            stiffness, std = np.where(unknown, base[0], stiffness), np.where(unknown, base[1], std)
        return Laid(mesh, mesh.vertices, mesh.vertex_normals, stiffness, std, generation)

    def refresh(self) -> Laid:
        """Asks all that is out of date, in this thread."""
        self._host.refresh()
        return self.laid

    def wait_touched(self, timeout_s: float) -> Touched | None:
        """The vertices near the tip that were asked since the last call; None: there were none in timeout_s."""
        if not self._host.wait_touched(timeout_s):
            return None
        mesh, indices, (stiffness, std) = self._host.take_touched()
        return Touched(indices, mesh.vertices[indices], stiffness, std)

    # ---- where the mesh lies

    def touched_surface(self, snapshot: Snapshot) -> tuple[Array, Array]:
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
        points, covariances = self.touched_surface(snapshot)
        if len(points) < self.bending.min_points:
            return None
        lying = self._lying
        mesh, _, generation = self._host.view()
        if snapshot.generation != generation:
            return None
        # What the points' noise does not explain is how far the mesh is off: it must not fail the gate.
        wide = covariances + np.eye(3) * float(np.median(mesh.closest(points)[3]))
        b, base_T_prior = self.bending, lying.base_T_prior
        if b.shift_m > 0.0:
            # What is bent is no noise: places near each other are off alike, and count as one.
            alone = len(np.unique(np.floor(points / b.spacing_m), axis=0))
            bent_as_noise = np.eye(3) * b.bent_m**2 * len(points) / alone
            rigid = register_rigid(
                lying.prior,
                points,
                wide + bent_as_noise,
                base_T_prior,
                prior_shift_m=b.shift_m,
                prior_turn_rad=b.turn_rad,
            )
            base_T_prior = np.asarray(rigid.base_T_mesh)
            if not rigid.converged or not self._believable(base_T_prior, points):
                base_T_prior = lying.base_T_prior
        bent = lying.grid.deform(
            points, wide, base_T_prior, strain=b.strain, travel_m=b.travel_m, start=lying.displacements
        )
        vertices = bent.vertices @ base_T_prior[:3, :3].T + base_T_prior[:3, 3]
        if not self._host.lay(Mesh(vertices, lying.prior.triangles), generation):
            return None  # all of it was forgotten meanwhile
        if self._lying is lying:
            self._lying = replace(lying, base_T_prior=base_T_prior, displacements=bent.displacements)
        return float(bent.rms_m)

    def _believable(self, base_T_prior: Array, points: Array) -> bool:
        """Not further off than four deviations of what is believed, where it was touched."""
        middle = points.mean(0)
        off = base_T_prior[:3, :3] @ middle + base_T_prior[:3, 3] - middle
        cosine = 0.5 * (np.trace(base_T_prior[:3, :3]) - 1.0)
        turn = float(np.arccos(np.clip(cosine, -1.0, 1.0)))
        return bool(np.linalg.norm(off) < 4.0 * self.bending.shift_m and turn < 4.0 * self.bending.turn_rad)

    @property
    def base_T_prior(self) -> Array:
        """(4, 4): where the prior lies as a whole, before it is bent."""
        return self._lying.base_T_prior

    # ---- kept

    def reset(self) -> None:
        """Forgets what was touched and what was loaded; the mesh lies as at the start."""
        prior = self._lying.prior
        self._host.reset(prior)
        self._begin(prior, None)

    def stiff_mesh(self) -> StiffMesh:
        """To be kept in a file."""
        laid = self.laid
        return StiffMesh(laid.vertices, laid.mesh.triangles, laid.stiffness_N_m, laid.stiffness_std_N_m)

    def take(self, kept: StiffMesh) -> None:
        """The kept map is the prior from now on: shown where nothing is touched. What was touched is forgotten."""
        prior = Mesh(kept.vertices, kept.triangles)
        self._host.reset(prior)
        self._begin(prior, kept)


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


__all__ = ["Bending", "Laid", "LiveMap", "Snapshot", "Touched", "refine"]
