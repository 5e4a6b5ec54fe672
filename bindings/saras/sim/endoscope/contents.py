"""All that is drawn: tissue with its dents, bones, board, wall, instruments. Needs VTK 9."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from saras.sim.endoscope import meshes, textures
from saras.sim.endoscope.room import Room
from saras.sim.endoscope.tools import ToolModel, ToolState, _put

Array = npt.NDArray[np.float64]

#: A dent is that of a flat punch of this radius on an elastic half space (Johnson, Contact Mechanics, 3.6), which
#: fades beyond FADE_M as the tissue is not infinitely deep [m].
PUNCH_M, FADE_M = 2.5e-3, 25e-3
#: Half axes and centre of the abdominal wall in world [m].
WALL_M, WALL_CENTER_M = (0.36, 0.24, 0.34), (0.02, 0.0, 0.02)
BOARD_HALF_M, BOARD_PIXEL_M = 0.125, 1.25e-4
LEAST_DENT_M = 2e-5  # a smaller change is not drawn anew


def dent(distance: Array, depth_m: float) -> Array:
    """(n,) how far the surface gives way at a distance [m] from where a tip presses it in by depth_m."""
    punch = (2.0 / np.pi) * np.arcsin(PUNCH_M / np.maximum(distance, PUNCH_M))
    return np.asarray(depth_m * punch * np.exp(-((distance / FADE_M) ** 2)))


class Contents:
    """Actors of the room and of the tools. tools: "mesa" or "psm" by name."""

    def __init__(self, room: Room, tools: Mapping[str, str], seed: int) -> None:
        rng = np.random.default_rng([seed, 0])
        self.room = room
        self.tools = {name: ToolModel(kind) for name, kind in tools.items()}
        self.actors: list[tuple[str, Any]] = []
        if room.world_T_board is None:
            self._add_tissue(rng)
        else:
            self._add("board", _board(room), room.world_T_board, lit=False)
        self._add(
            "bone", _textured(meshes.box(room.bones_size_m), textures.bone(rng)), room.world_T_bones, specular=0.2
        )
        wall = np.diag([*WALL_M, 1.0])
        wall[:3, 3] = WALL_CENTER_M
        self._add("background", _textured(meshes.dome(), textures.lining(rng)), wall, lit=False)
        for model in self.tools.values():
            self.actors += [("tool", actor) for actor in model.actors.values()]
            model.place(None)

    def place(self, tools: Mapping[str, ToolState]) -> None:
        """Puts the instruments where they are, and dents the tissue under them. What is not in tools is not there."""
        for name, model in self.tools.items():
            model.place(tools.get(name))
        if self.room.world_T_board is None:
            self._press([state.tip for name, state in tools.items() if name in self.tools])

    def _add(self, label: str, actor: Any, world_T: Array, *, specular: float = 0.0, lit: bool = True) -> None:
        look = actor.GetProperty()
        look.SetInterpolationToPhong()
        look.SetAmbient(0.16 if lit else 1.0)
        look.SetDiffuse(0.95 if lit else 0.0)
        look.SetSpecular(specular)
        look.SetSpecularPower(14.0)
        _put(actor, world_T)
        self.actors.append((label, actor))

    def _add_tissue(self, rng: np.random.Generator) -> None:
        self._sheet = meshes.Sheet(self.room.surface.size_m)
        # Ripples that only the light sees: the surface itself stays where the tissue law has it.
        self._ripples = np.stack([0.11 * textures.cloud(rng, self._sheet.shape, 18, 3, 0.8) for _ in range(2)], axis=-1)
        self._dents: Array | None = None
        actor = _textured(self._sheet.data, textures.tissue(rng))
        actor.GetMapper().ScalarVisibilityOn()  # its brightness
        self._add("tissue", actor, self.room.surface.world_T_surface, specular=0.55)
        self._press([])

    def light_from(self, point: Array, full_m: float) -> None:
        """A lamp at a point (3,) in world: full light at a distance of full_m, less beyond."""
        if self.room.world_T_board is not None:
            return
        frame = self.room.surface.world_T_surface
        lamp = (point - frame[:3, 3]) @ frame[:3, :3]
        away = ((np.column_stack([self._sheet.xy, self._flat]) - lamp) ** 2).sum(axis=1)
        self._sheet.brighten(1.0 / (0.25 + 0.75 * away / full_m**2))

    def _press(self, tips: list[Array]) -> None:
        surface = self.room.surface
        surface_T_world = np.linalg.inv(surface.world_T_surface)
        found = []
        for tip in tips:
            depth = surface.depth(tip)
            if depth > LEAST_DENT_M:
                on_surface = tip + depth * surface.normal(tip)
                found.append([*(surface_T_world @ [*on_surface, 1.0])[:2], depth])
        dents = np.array(found).reshape(-1, 3)
        before = self._dents
        if before is not None and dents.shape == before.shape and (np.abs(dents - before) < LEAST_DENT_M).all():
            return
        self._dents = dents
        xy = self._sheet.xy
        if self._sheet.choose(dents[:, :2]):
            xy = self._sheet.xy
            self._flat = surface.height(xy) - meshes.edge_drop(xy, surface.size_m)
            self._lean = self._sheet.of_lattice(self._ripples)
        z = self._flat
        for x, y, depth in dents:
            z = np.minimum(z, self._flat - dent(np.hypot(*(xy - [x, y]).T), depth))
        self._sheet.bend(z, self._lean)


def _textured(data: Any, image: npt.NDArray[np.uint8]) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkTexture

    rows, columns = image.shape[:2]
    picture = vtkImageData()
    picture.SetDimensions(columns, rows, 1)
    picture.GetPointData().SetScalars(numpy_to_vtk(image[::-1].reshape(-1, 3), deep=True))
    texture = vtkTexture()
    texture.SetInputData(picture)
    texture.InterpolateOn()
    texture.MipmapOn()
    texture.SetMaximumAnisotropicFiltering(1)  # VTK's default takes most of the time without a graphics card
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.SetTexture(texture)
    return actor


def _board(room: Room) -> Any:
    image = textures.board(room.board, BOARD_HALF_M, BOARD_PIXEL_M)
    return _textured(meshes.plane(BOARD_HALF_M, BOARD_HALF_M), image)
