"""Where each tool is: a capsule from tip to trocar in the world, or why that is not known."""

from __future__ import annotations

from typing import Any

import numpy as np

from saras_ros1.arm_inputs import ArmInputs
from saras_ros1.channel import base_frame
from saras_ros1.dvrk_inputs import DvrkArmInput
from saras_ros1.inputs import Input
from saras_ros1.live_frames import LiveFrames
from saras_ros1.node import Node

WORLD = "world"


class UnknownToolError(Exception):
    """The tool's place is not known now; the text says why."""


class MesaTool:
    """A SARAS arm's instrument: tip from ee_pose, trocar from rcm."""

    def __init__(self, node: Node, side: str, radius_m: float, timeout_s: float) -> None:
        self.name, self.radius_m, self.frame = f"mesa_{side}", radius_m, base_frame(side)
        self._arm = ArmInputs(node, side, timeout_s)

    @property
    def primary(self) -> Input:
        """What new positions come with."""
        return self._arm.pose

    def ends(self, frames: LiveFrames) -> tuple[np.ndarray, np.ndarray]:
        """(3,) tip and (3,) trocar in the world [m]. Raises UnknownToolError, UnknownFrameError."""
        if not self._arm.pose.fresh:
            raise UnknownToolError(f"no fresh pose on {self._arm.pose.topic}")
        if self._arm.rcm.value is None:
            raise UnknownToolError(f"no trocar on {self._arm.rcm.topic}")
        world_T_base = frames.fresh(WORLD, self.frame)
        tip = world_T_base[:3, :3] @ self._arm.pose.value[:3, 3] + world_T_base[:3, 3]
        return tip, world_T_base[:3, :3] @ self._arm.rcm.value + world_T_base[:3, 3]


class DvrkTool:
    """An instrument or the endoscope of a da Vinci: tip from measured_cp, trocar = origin of the arm's own frame."""

    def __init__(self, node: Node, name: str, radius_m: float, **options: Any) -> None:
        """options: of DvrkArmInput."""
        self.name, self.radius_m = name, radius_m
        self._arm = DvrkArmInput(node, name, **options)

    @property
    def primary(self) -> Input | None:
        """None: a da Vinci's naming, and so its topic, may be found later."""
        return None

    def ends(self, frames: LiveFrames) -> tuple[np.ndarray, np.ndarray]:
        """(3,) tip and (3,) trocar in the world [m]. Raises UnknownToolError, UnknownFrameError."""
        if not self._arm.fresh:
            raise UnknownToolError(self._arm.unknown_reason.removeprefix(f"{self.name}: "))
        world_T_reference = frames.fresh(WORLD, self._arm.frame_id)
        tip = world_T_reference[:3, :3] @ self._arm.pose[:3, 3] + world_T_reference[:3, 3]
        return tip, frames.fresh(WORLD, self.name)[:3, 3]
