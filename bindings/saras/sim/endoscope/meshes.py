"""Numpy shapes to VTK, and the shapes of the room. Needs VTK 9."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

#: The tissue's points lie on a lattice of this step; away from tips only every STRIDE-th line of it is drawn [m].
STEP_M, STRIDE = 1.5e-3, 4
#: So many lines on either side of a tip are all drawn.
FINE_LINES = 11
#: The tissue goes on so far beyond the phantom, the outer part of it bending down [m].
MARGIN_M, BEND_M = 0.06, 0.025


class Sheet:
    """A surface z(x, y) with texture coordinates and a brightness for each point, fine where something presses.

    A software renderer pays for each triangle: twenty thousand take longer than all pixels.
    """

    def __init__(self, size_m: tuple[float, float]) -> None:
        from vtkmodules.vtkCommonDataModel import vtkPolyData

        self._half = [int(np.ceil((0.5 * size + MARGIN_M) / STEP_M / STRIDE)) * STRIDE for size in size_m]
        self.shape = 2 * self._half[1] + 1, 2 * self._half[0] + 1
        self.data: Any = vtkPolyData()
        self._chosen: tuple[Array, Array] | None = None
        self.xy = np.zeros((0, 2))

    def choose(self, tips: Array) -> bool:
        """Lines for tips at (n, 2) in x and y. True: the points are others than before."""
        lines = []
        for axis, half in enumerate(self._half):
            chosen = [np.arange(-half, half + 1, STRIDE)]
            for tip in tips:
                # By steps, so that a moving tip seldom changes them.
                middle = STRIDE * round(tip[axis] / STEP_M / STRIDE)
                if abs(middle) <= half:
                    chosen.append(np.arange(max(middle - FINE_LINES, -half), min(middle + FINE_LINES, half) + 1))
            lines.append(np.unique(np.concatenate(chosen)))
        if self._chosen is not None and all(np.array_equal(a, b) for a, b in zip(lines, self._chosen)):
            return False
        self._chosen = lines[0], lines[1]
        self._build()
        return True

    def of_lattice(self, values: Array) -> Array:
        """(n, …) of the chosen points out of (rows, columns, …) for the whole lattice."""
        assert self._chosen is not None
        x, y = self._chosen
        picked = values[np.ix_(y + self._half[1], x + self._half[0])]
        return np.asarray(picked.reshape(len(self.xy), *values.shape[2:]))

    def _build(self) -> None:
        from vtkmodules.util.numpy_support import numpy_to_vtk
        from vtkmodules.vtkCommonCore import vtkPoints

        assert self._chosen is not None
        self._lines = tuple(STEP_M * line.astype(float) for line in self._chosen)
        gx, gy = np.meshgrid(*self._lines)
        self.xy = np.column_stack([gx.ravel(), gy.ravel()])
        count, shape = len(self.xy), gx.shape
        self._points = np.zeros((count, 3), np.float32)
        self._points[:, :2] = self.xy
        self._normals = np.zeros((count, 3), np.float32)
        self._bright = np.full((count, 3), 255, np.uint8)
        self._arrays = [numpy_to_vtk(values) for values in (self._points, self._normals, self._bright)]
        points = vtkPoints()
        points.SetData(self._arrays[0])
        self.data.SetPoints(points)
        attributes = self.data.GetPointData()
        attributes.SetNormals(self._arrays[1])
        attributes.SetScalars(self._arrays[2])
        span = 2.0 * STEP_M * max(self._half)
        attributes.SetTCoords(numpy_to_vtk((self.xy / span + 0.5).astype(np.float32), deep=True))
        i = np.arange(count).reshape(shape)
        low = np.stack([i[:-1, :-1], i[:-1, 1:], i[1:, 1:]], axis=-1).reshape(-1, 3)
        high = np.stack([i[:-1, :-1], i[1:, 1:], i[1:, :-1]], axis=-1).reshape(-1, 3)
        self.data.SetPolys(_cells(np.concatenate([low, high])))

    def bend(self, z: Array, lean: Array) -> None:
        """z: (n,) heights; lean: (n, 2) what is added to the slopes for shading only."""
        self._points[:, 2] = z
        x, y = self._lines
        dy, dx = np.gradient(z.reshape(len(y), len(x)), y, x)
        normals = np.column_stack([-dx.ravel() - lean[:, 0], -dy.ravel() - lean[:, 1], np.ones(len(z))])
        self._normals[:] = normals / np.linalg.norm(normals, axis=1, keepdims=True)
        self._arrays[0].Modified()
        self._arrays[1].Modified()
        self.data.GetPoints().Modified()
        self.data.Modified()

    def brighten(self, share: Array) -> None:
        """share: (n,) of full light that reaches each point."""
        self._bright[:] = np.clip(255.0 * share, 0.0, 255.0)[:, None]
        self._arrays[2].Modified()
        self.data.Modified()


def edge_drop(xy: Array, size_m: tuple[float, float]) -> Array:
    """(n,) how far the tissue bends down at its border [m]; 0 over the phantom."""
    beyond = np.maximum(np.abs(xy) - (0.5 * np.array(size_m) + MARGIN_M - BEND_M), 0.0)
    return np.asarray((beyond**2).sum(axis=1) / BEND_M)


def plane(half_x: float, half_y: float) -> Any:
    """A textured rectangle in z = 0, facing +z."""
    from vtkmodules.vtkFiltersSources import vtkPlaneSource

    source = vtkPlaneSource()
    source.SetOrigin(-half_x, -half_y, 0.0)
    source.SetPoint1(half_x, -half_y, 0.0)
    source.SetPoint2(-half_x, half_y, 0.0)
    source.Update()
    return source.GetOutput()


def box(size: Array) -> Any:
    """A textured box about the origin."""
    from vtkmodules.vtkFiltersSources import vtkCubeSource

    source = vtkCubeSource()
    source.SetXLength(size[0])
    source.SetYLength(size[1])
    source.SetZLength(size[2])
    source.Update()
    return source.GetOutput()


def dome() -> Any:
    """A textured sphere of radius 1 about the origin."""
    from vtkmodules.vtkFiltersSources import vtkTexturedSphereSource

    source = vtkTexturedSphereSource()
    source.SetRadius(1.0)
    source.SetThetaResolution(48)
    source.SetPhiResolution(32)
    source.Update()
    return source.GetOutput()


def turned(profile: list[tuple[float, float]], segments: int = 24, flat: float = 1.0) -> Any:
    """A body about z from its profile [(radius, z), …], counter-clockwise; flat: its y times this."""
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData
    from vtkmodules.vtkFiltersCore import vtkPolyDataNormals

    rings = np.array(profile, dtype=float)
    angle = np.linspace(0.0, 2.0 * np.pi, segments, endpoint=False)
    xyz = np.stack(
        [
            rings[:, :1] * np.cos(angle),
            flat * rings[:, :1] * np.sin(angle),
            np.repeat(rings[:, 1:], segments, axis=1),
        ],
        axis=-1,
    ).reshape(-1, 3)
    i = np.arange(len(xyz)).reshape(len(rings), segments)
    j = np.roll(i, -1, axis=1)
    quads = np.stack([i[:-1], j[:-1], j[1:], i[1:]], axis=-1).reshape(-1, 4)
    points, data = vtkPoints(), vtkPolyData()
    points.SetData(numpy_to_vtk(xyz, deep=True))
    data.SetPoints(points)
    data.SetPolys(_cells(quads))
    normals = vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(50.0)
    normals.Update()
    return normals.GetOutput()


def ball(radius: float) -> Any:
    """A sphere about the origin."""
    from vtkmodules.vtkFiltersSources import vtkSphereSource

    source = vtkSphereSource()
    source.SetRadius(radius)
    source.SetThetaResolution(24)
    source.SetPhiResolution(16)
    source.Update()
    return source.GetOutput()


def _cells(corners: npt.NDArray[np.int64]) -> Any:
    """Polygons of equally many corners (n, k)."""
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    count, k = corners.shape
    polys = vtkCellArray()
    polys.SetData(
        numpy_to_vtkIdTypeArray(np.arange(0, (count + 1) * k, k, dtype=np.int64), deep=True),
        numpy_to_vtkIdTypeArray(corners.ravel().astype(np.int64), deep=True),
    )
    return polys
