"""Both eyes of the endoscope at once: one window, two pinholes, one distortion map each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.sim.endoscope.camera import StereoCamera, WideView, wide_views
from saras.sim.endoscope.contents import Contents
from saras.sim.endoscope.room import Room
from saras.sim.endoscope.tools import ToolState
from saras.sim.endoscope.window import Pixels, offscreen_window

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

NEAR_M, FAR_M = 0.004, 0.9
#: How far apart depths of neighbouring pixels may be to be one surface [m].
EDGE_M = 2e-3
LAMP = 1.2
#: The tools of the operating room and what they are.
TOOLS = {"mesa_left": "mesa", "mesa_right": "mesa", "PSM1": "psm", "PSM2": "psm"}


class Label(IntEnum):
    """What a pixel shows."""

    BACKGROUND = 0
    TISSUE = 1
    BONE = 2
    BOARD = 3
    TOOL = 4


@dataclass(frozen=True)
class StereoPair:
    """Two pictures of one moment, (height, width, 3) BGR."""

    left: Image
    right: Image


@dataclass(frozen=True)
class Truth:
    """Of both eyes' pixels: distance along the optical axis [m], NaN beyond FAR_M, and Label."""

    left_depth: npt.NDArray[np.float32]
    right_depth: npt.NDArray[np.float32]
    left_labels: Image
    right_labels: Image


class StereoRenderer:
    """Draws what both eyes see. To be made and used in one thread.

    tools: kind ("mesa" or "psm") of each instrument by name. noise: of the pictures, standard deviation in grey levels,
    0 … 32. render_scale: pixels of the pinhole for one of the distorted picture, 0.5 … 4; more is sharper, and slower.
    The same seed and the same calls give the same pictures. Raises ConfigError, NoWindowError.
    """

    def __init__(
        self,
        room: Room,
        camera: StereoCamera,
        *,
        tools: Mapping[str, str] = TOOLS,
        seed: int = 1,
        noise: float = 2.0,
        render_scale: float = 1.0,
    ) -> None:
        import cv2
        from vtkmodules.vtkRenderingCore import vtkLight, vtkRenderer

        for name, value, low, high in (("noise", noise, 0.0, 32.0), ("render_scale", render_scale, 0.5, 4.0)):
            if not low <= value <= high:
                raise ConfigError(f"{name} = {value}: must be in [{low:g}, {high:g}]")
        self.camera, self.room = camera, room
        views, places = wide_views([camera.left.intrinsics, camera.right.intrinsics], render_scale)
        width, height = views[0].width, views[0].height
        self._window = offscreen_window(2 * width, height)
        self.contents = Contents(room, tools, seed)
        # One lamp beside the lens, without fall-off: the only light that VTK shades at a bearable price.
        lamp = vtkLight()
        lamp.SetLightTypeToHeadlight()
        lamp.SetIntensity(LAMP)
        self._eyes = []
        for i, view in enumerate(views):
            renderer = vtkRenderer()
            renderer.SetViewport(0.5 * i, 0.0, 0.5 * (i + 1), 1.0)
            renderer.AutomaticLightCreationOff()
            renderer.AddLight(lamp)
            for _, actor in self.contents.actors:
                renderer.AddActor(actor)
            self._window.AddRenderer(renderer)
            self._eyes.append((renderer, _camera_of(view)))
            renderer.SetActiveCamera(self._eyes[i][1])
        self._places = [place + np.array([i * width, 0.0]) for i, place in enumerate(places)]
        for place in self._places:
            place[..., 1] = height - 1.0 - place[..., 1]  # VTK's rows begin at the bottom
        self._maps = [cv2.convertMaps(p.astype(np.float32), None, cv2.CV_16SC2) for p in self._places]
        self._pixels = Pixels(self._window)
        self._flat_looks: dict[str, Any] = {}
        self._seed, self._frame = seed, 0
        self._grain = _grain(camera.size, noise, np.random.default_rng([seed, 1])) if noise else None

    def render(self, world_T_left: Array, tools: Mapping[str, ToolState]) -> StereoPair:
        """The pictures from world_T_left (4, 4), the left eye's raw optical frame. tools: those that are there."""
        import cv2

        self.contents.place(tools)
        self._look_from(np.asarray(world_T_left, dtype=float))
        self._window.Render()
        drawn = self._pixels.colours()
        pair = []
        rng = np.random.default_rng([self._seed, 2, self._frame])
        self._frame += 1
        for maps in self._maps:
            picture = cv2.remap(drawn, *maps, cv2.INTER_LINEAR)
            picture = cv2.cvtColor(picture, cv2.COLOR_RGB2BGR)
            if self._grain is not None:
                self._grain.add(picture, rng)
            pair.append(picture)
        return StereoPair(*pair)

    def truth(self) -> Truth:
        """Depth and labels of what `render` drew last."""
        import cv2

        depths = [self._depth(self._pixels.depths(), place) for place in self._places]
        before = []
        for label, actor in self.contents.actors:
            before.append((actor, actor.GetProperty(), actor.GetTexture(), actor.GetMapper().GetScalarVisibility()))
            actor.GetMapper().ScalarVisibilityOff()
            actor.SetProperty(self._flat_look(label))
            actor.SetTexture(None)
        self._window.Render()
        colours = self._pixels.colours()[..., 0]
        labels = [cv2.remap(colours, np.round(p).astype(np.float32), None, cv2.INTER_NEAREST) for p in self._places]
        for actor, look, texture, coloured in before:
            actor.GetMapper().SetScalarVisibility(coloured)
            actor.SetProperty(look)
            actor.SetTexture(texture)
        left, right = (np.asarray(np.round(image / 40.0), dtype=np.uint8) for image in labels)
        return Truth(depths[0], depths[1], left, right)

    def _look_from(self, world_T_left: Array) -> None:
        left_T_right = np.linalg.inv(self.camera.right_T_left)
        for (_, camera), pose in zip(self._eyes, (world_T_left, world_T_left @ left_T_right)):
            at, forward = pose[:3, 3], pose[:3, 2]
            camera.SetPosition(*at)
            camera.SetFocalPoint(*(at + forward))
            camera.SetViewUp(*-pose[:3, 1])
        self.contents.light_from(world_T_left[:3, 3], self._exposed_distance(world_T_left))

    def _exposed_distance(self, world_T_left: Array) -> float:
        """What the automatic exposure takes for the middle of the picture: along the optical axis to the tissue."""
        frame = self.room.surface.world_T_surface if self.room.world_T_board is None else self.room.world_T_board
        down = float(frame[:3, 2] @ world_T_left[:3, 2])
        over = float(frame[:3, 2] @ (world_T_left[:3, 3] - frame[:3, 3]))
        return float(np.clip(-over / down if down < -1e-3 else 0.25, 0.03, 0.25))

    def _depth(self, buffer: npt.NDArray[np.float32], place: Array) -> npt.NDArray[np.float32]:
        import cv2

        at = place.astype(np.float32)
        # The buffer is affine in 1 / depth, which is linear over the picture of a plane; but not across an edge.
        smooth = _metres(cv2.remap(buffer, at, None, cv2.INTER_LINEAR))
        nearest = _metres(cv2.remap(buffer, np.round(at), None, cv2.INTER_NEAREST))
        depth = np.where(np.abs(smooth - nearest) < EDGE_M, smooth, nearest).astype(np.float32)
        depth[nearest > 0.999 * FAR_M] = np.nan
        return depth

    def _flat_look(self, label: str) -> Any:
        if label not in self._flat_looks:
            from vtkmodules.vtkRenderingCore import vtkProperty

            look = vtkProperty()
            look.LightingOff()
            grey = 40.0 * Label[label.upper()] / 255.0
            look.SetColor(grey, grey, grey)
            self._flat_looks[label] = look
        return self._flat_looks[label]


class _Grain:
    """Noise of the sensor, from a bank: drawing a million normal numbers a frame would take longer than the frame."""

    SPARE = 64

    def __init__(self, size: tuple[int, int], noise: float, rng: np.random.Generator) -> None:
        width, height = size
        values = np.round(rng.normal(0.0, noise, (height + self.SPARE, width + self.SPARE, 3)))
        self._more = np.clip(values, 0, 255).astype(np.uint8)
        self._less = np.clip(-values, 0, 255).astype(np.uint8)

    def add(self, picture: Image, rng: np.random.Generator) -> None:
        """To a picture, in place."""
        import cv2

        height, width = picture.shape[:2]
        row, column = rng.integers(0, self.SPARE, 2)
        part = np.s_[row : row + height, column : column + width]
        cv2.add(picture, self._more[part], dst=picture)
        cv2.subtract(picture, self._less[part], dst=picture)


def _grain(size: tuple[int, int], noise: float, rng: np.random.Generator) -> _Grain:
    return _Grain(size, noise, rng)


def _camera_of(view: WideView) -> Any:
    from vtkmodules.vtkCommonMath import vtkMatrix4x4
    from vtkmodules.vtkRenderingCore import vtkCamera

    left, right, bottom, top = view.frustum()
    n, f = NEAR_M, FAR_M
    matrix = vtkMatrix4x4()
    matrix.DeepCopy(
        [
            *(2.0 / (right - left), 0.0, (right + left) / (right - left), 0.0),
            *(0.0, 2.0 / (top - bottom), (top + bottom) / (top - bottom), 0.0),
            *(0.0, 0.0, -(f + n) / (f - n), -2.0 * f * n / (f - n)),
            *(0.0, 0.0, -1.0, 0.0),
        ]
    )
    camera = vtkCamera()
    camera.SetClippingRange(n, f)
    camera.SetExplicitProjectionTransformMatrix(matrix)
    camera.UseExplicitProjectionTransformMatrixOn()
    return camera


def _metres(buffer: npt.NDArray[np.float32]) -> npt.NDArray[np.float32]:
    return np.asarray(FAR_M * NEAR_M / (FAR_M - buffer.astype(float) * (FAR_M - NEAR_M)), dtype=np.float32)


__all__ = ["FAR_M", "NEAR_M", "TOOLS", "Label", "StereoPair", "StereoRenderer", "Truth"]
