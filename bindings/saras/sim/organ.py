"""Seeded closed meshes of the size of an organ: what registration is tried on."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Triangles = npt.NDArray[np.int32]


def icosphere(subdivisions: int) -> tuple[Array, Triangles]:
    """Unit sphere: vertices (n, 3), triangles (m, 3) counter-clockwise from outside, n = 10 * 4^subdivisions + 2."""
    golden = (1.0 + 5.0**0.5) / 2.0
    corners = [(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0)]
    vertices = np.array([np.roll(corner, shift) for shift in range(3) for corner in corners])
    vertices /= np.linalg.norm(vertices, axis=1, keepdims=True)
    # Faces of the icosahedron: triples of vertices that are all neighbours, turned outward.
    edge = np.min([np.linalg.norm(vertices[0] - v) for v in vertices[1:]])
    near = np.abs(np.linalg.norm(vertices[:, None] - vertices[None], axis=2) - edge) < 1e-9
    triples = [
        (i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i, j] and near[j, k] and near[i, k]
    ]
    faces = np.array([t if np.linalg.det(vertices[list(t)]) > 0 else t[::-1] for t in triples])
    for _ in range(subdivisions):
        pairs = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
        unique, inverse = np.unique(pairs, axis=0, return_inverse=True)
        middle = vertices[unique].mean(1)
        middle /= np.linalg.norm(middle, axis=1, keepdims=True)
        ab, bc, ca = (len(vertices) + inverse.reshape(-1, 3)).T
        a, b, c = faces.T
        faces = np.concatenate([np.column_stack(t) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
        vertices = np.concatenate([vertices, middle])
    return vertices, faces.astype(np.int32)


def organ(seed: int = 1, subdivisions: int = 4, size_m: float = 0.12) -> tuple[Array, Triangles]:
    """A bumpy ellipsoid without symmetry, about size_m long.

    vertices (n, 3) [m] about their middle, triangles (m, 3).
    """
    rng = np.random.default_rng(seed)
    vertices, triangles = icosphere(subdivisions)
    height = np.ones(len(vertices))
    for wave in range(2, 6):
        for _ in range(3):
            direction = rng.normal(size=3)
            phase = wave * vertices @ (direction / np.linalg.norm(direction)) + rng.uniform(0, 2 * np.pi)
            height += 0.12 / wave * rng.normal() * np.sin(phase)
    shaped = vertices * height[:, None] * [0.5, 0.36, 0.28] * size_m
    return shaped - shaped.mean(0), triangles


__all__ = ["icosphere", "organ"]
