"""The instruments as the simulated endoscope draws them: where they were last, also when that is long ago."""

from __future__ import annotations

import numpy as np
from sensor_msgs.msg import JointState

from saras import KinematicsError
from saras.kinematics import dvrk
from saras.sim.endoscope import ToolState
from saras_ros1.arm_inputs import ArmInputs
from saras_ros1.channel import base_frame
from saras_ros1.collision_tools import WORLD
from saras_ros1.dvrk_inputs import DvrkArmInput
from saras_ros1.latest import Latest
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.node import Node

STALE_S = 1.0


class SeenMesa:
    """A SARAS arm's instrument."""

    def __init__(self, node: Node, side: str) -> None:
        self.frame = base_frame(side)
        self._arm = ArmInputs(node, side, STALE_S)
        self._tool = Latest(f"/mesa_{side}/tool", JointState)

    def state(self, frames: LiveFrames) -> ToolState | None:
        """None: nothing was heard of it yet."""
        if self._arm.pose.value is None or self._arm.rcm.value is None:
            return None
        world_T_base = frames.fresh(WORLD, self.frame)
        trocar = world_T_base[:3, :3] @ self._arm.rcm.value + world_T_base[:3, 3]
        tool = self._tool.value(np.inf)
        jaw = tool.position[1] if tool is not None and len(tool.position) > 1 else 0.0
        return ToolState(world_T_base @ self._arm.pose.value, trocar, float(np.clip(jaw, 0.0, 1.0)))


class SeenPsm:
    """A da Vinci's instrument."""

    def __init__(self, node: Node, name: str) -> None:
        self.name = name
        self._arm = DvrkArmInput(node, name, timeout_s=STALE_S)
        self._jaw = Latest(f"/{name}/jaw/measured_js", JointState)
        self._kinematics = dvrk.psm()
        self._q = np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])

    def state(self, frames: LiveFrames) -> ToolState | None:
        """None: nothing was heard of it yet."""
        try:
            world_T_tip = frames.fresh(WORLD, self._arm.frame_id) @ self._arm.pose
        except ValueError:
            return None
        world_T_base = frames.fresh(WORLD, self.name)
        wrist = None
        try:
            self._q = self._kinematics.inverse(np.linalg.inv(world_T_base) @ world_T_tip, self._q)
            wrist = (world_T_base @ [*self._kinematics.wrist_position(self._q), 1.0])[:3]
        except KinematicsError:
            pass  # another instrument than the usual one: drawn without its wrist
        jaw = self._jaw.value(np.inf)
        opening = jaw.position[0] if jaw is not None and jaw.position else 0.0
        return ToolState(world_T_tip, world_T_base[:3, 3], float(np.clip(opening, 0.0, 1.0)), wrist)


class SeenTools:
    """All four."""

    def __init__(self, node: Node, frames: LiveFrames) -> None:
        self._frames = frames
        self._tools = {
            "mesa_left": SeenMesa(node, "left"),
            "mesa_right": SeenMesa(node, "right"),
            "PSM1": SeenPsm(node, "PSM1"),
            "PSM2": SeenPsm(node, "PSM2"),
        }
        self._last: dict[str, ToolState] = {}

    def states(self) -> dict[str, ToolState]:
        """By name, those that were heard of."""
        for name, tool in self._tools.items():
            try:
                state = tool.state(self._frames)
            except UnknownFrameError:
                continue
            if state is not None:
                self._last[name] = state
        return dict(self._last)
