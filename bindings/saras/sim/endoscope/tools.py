"""The instruments as the endoscope sees them: SARAS arms' and da Vinci's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from saras.kinematics import dvrk, mesa
from saras.sim.endoscope import meshes

Array = npt.NDArray[np.float64]

JAW_M = 0.018
"""Length of a SARAS instrument's jaws."""
PSM_JAW_M = 0.010
OPENING_RAD = 0.5
"""Of each half of a SARAS instrument's jaw at jaw = 1."""
SHAFT_M = 0.30
STEEL, GRAPHITE = (0.72, 0.73, 0.75), (0.13, 0.13, 0.15)


@dataclass(frozen=True)
class ToolState:
    """Where an instrument is."""

    world_T_tip: Array
    """(4, 4), z out of the tip"""
    trocar: Array
    """(3,) in world: the shaft comes from there"""
    jaw: float = 0.0
    """0 closed, 1 open"""
    wrist: Array | None = None
    """(3,) end of the straight shaft in world; None: no wrist, the shaft ends at the jaws"""

    @classmethod
    def straight(cls, tip: Array, trocar: Array, jaw: float = 0.0) -> ToolState:
        """An instrument without a wrist, from its ends (3,) in world."""
        z = (tip - trocar) / np.linalg.norm(tip - trocar)
        x = np.cross([0.31, 0.95, 0.0], z)
        x /= np.linalg.norm(x)
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = np.column_stack([x, np.cross(z, x), z]), tip
        return cls(pose, trocar, jaw)

    @property
    def tip(self) -> Array:
        """(3,) in world."""
        return self.world_T_tip[:3, 3]


class ToolModel:
    """The actors of one instrument. kind: "mesa" or "psm"."""

    def __init__(self, kind: str) -> None:
        self.kind = kind
        if kind == "mesa":
            r = mesa.SHAFT_RADIUS_M
            shaft = meshes.turned([(0.0, -SHAFT_M), (r, -SHAFT_M), (r, -0.004), (0.8 * r, 0.0), (0.0, 0.0)])
            jaw = meshes.turned(
                [(0.0, 0.0), (0.0019, 0.0), (0.0021, 0.006), (0.0016, 0.015), (0.0007, JAW_M), (0.0, JAW_M)], 16, 0.8
            )
            self._parts = [("shaft", shaft, STEEL), ("jaw+", jaw, STEEL), ("jaw-", jaw, STEEL)]
        else:
            r = dvrk.SHAFT_RADIUS_M
            shaft = meshes.turned([(0.0, -SHAFT_M), (r, -SHAFT_M), (r, -0.002), (0.0, 0.0)])
            link = meshes.turned([(0.0, -0.5), (0.0032, -0.5), (0.0032, 0.5), (0.0, 0.5)])
            jaw = meshes.turned(
                [(0.0, 0.0), (0.0026, 0.001), (0.0026, 0.004), (0.0012, PSM_JAW_M), (0.0, PSM_JAW_M)], 16, 0.7
            )
            self._parts = [
                ("shaft", shaft, GRAPHITE),
                ("joint", meshes.ball(0.0036), STEEL),
                ("link", link, STEEL),
                ("jaw+", jaw, STEEL),
                ("jaw-", jaw, STEEL),
            ]
        self.actors: dict[str, Any] = {name: _actor(data, colour) for name, data, colour in self._parts}

    def place(self, state: ToolState | None) -> None:
        """Moves the actors; None: the tool is not there."""
        for actor in self.actors.values():
            actor.SetVisibility(state is not None)
        if state is None:
            return
        tip = state.world_T_tip
        if self.kind == "mesa":
            end = tip @ _shift(-JAW_M)
            _put(self.actors["shaft"], _along(end[:3, 3], end[:3, 3] - state.trocar))
            for name, sign in (("jaw+", 1.0), ("jaw-", -1.0)):
                _put(self.actors[name], end @ _turn_y(sign * OPENING_RAD * state.jaw))
            return
        hinge = tip[:3, 3] - PSM_JAW_M * tip[:3, 2]
        wrist = hinge - 0.009 * tip[:3, 2] if state.wrist is None else state.wrist
        _put(self.actors["shaft"], _along(wrist, wrist - state.trocar))
        at = np.eye(4)
        at[:3, 3] = wrist
        _put(self.actors["joint"], at)
        span = _along(0.5 * (wrist + hinge), hinge - wrist)
        span[:3, 2] *= max(float(np.linalg.norm(hinge - wrist)), 1e-4)
        _put(self.actors["link"], span)
        base = tip @ _shift(-PSM_JAW_M)
        for name, sign in (("jaw+", 1.0), ("jaw-", -1.0)):
            _put(self.actors[name], base @ _turn_y(sign * OPENING_RAD * state.jaw))


def _actor(data: Any, colour: tuple[float, float, float]) -> Any:
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*colour)
    look.SetAmbient(0.12)
    look.SetDiffuse(0.75)
    look.SetSpecular(0.7)
    look.SetSpecularPower(28.0)
    look.SetInterpolationToPhong()
    return actor


def _put(actor: Any, matrix: Array) -> None:
    from vtkmodules.vtkCommonMath import vtkMatrix4x4

    user = actor.GetUserMatrix() or vtkMatrix4x4()
    user.DeepCopy(matrix.ravel().tolist())
    actor.SetUserMatrix(user)
    user.Modified()


def _along(at: Array, direction: Array) -> Array:
    """(4, 4) with its origin at a point and z along a direction."""
    z = direction / max(float(np.linalg.norm(direction)), 1e-12)
    x = np.cross(z, np.eye(3)[int(np.argmin(np.abs(z)))])
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    pose[:3, 3] = at
    return pose


def _shift(z: float) -> Array:
    pose = np.eye(4)
    pose[2, 3] = z
    return pose


def _turn_y(angle: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    pose = np.eye(4)
    pose[0, 0], pose[0, 2], pose[2, 0], pose[2, 2] = c, s, -s, c
    return pose


__all__ = ["ToolModel", "ToolState"]
