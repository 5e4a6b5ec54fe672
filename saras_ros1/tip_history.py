"""Where a SARAS arm's tip was when a picture was taken."""

from __future__ import annotations

from collections import deque

import numpy as np

from saras_ros1.arm_inputs import ArmInputs
from saras_ros1.channel import base_frame
from saras_ros1.collision_tools import WORLD, UnknownToolError
from saras_ros1.inputs import NANOSECONDS, Input
from saras_ros1.live_frames import LiveFrames
from saras_ros1.node import Node

KEPT = 300


class TipHistory:
    """Tip and trocar of one side at a time in the last seconds."""

    def __init__(self, node: Node, side: str, timeout_s: float) -> None:
        self.name, self.frame, self.timeout_s = f"mesa_{side}", base_frame(side), timeout_s
        self._arm = ArmInputs(node, side, timeout_s)
        self._past: deque[tuple[int, np.ndarray]] = deque(maxlen=KEPT)
        self._arm.pose.listeners.append(self._on_pose)

    def _on_pose(self, source: Input) -> None:
        self._past.append((source.stamp_ns, source.value[:3, 3]))

    def base_tip(self, stamp_ns: int) -> np.ndarray:
        """(3,) in the arm's base [m], between the poses before and after. Raises UnknownToolError."""
        past = list(self._past)
        if not past:
            raise UnknownToolError(f"no pose on {self._arm.pose.topic}")
        after = next((entry for entry in past if entry[0] >= stamp_ns), None)
        before = next((entry for entry in reversed(past) if entry[0] <= stamp_ns), None)
        limit = self.timeout_s * NANOSECONDS
        before = before if before is not None and stamp_ns - before[0] <= limit else None
        after = after if after is not None and after[0] - stamp_ns <= limit else None
        if before is None and after is None:
            raise UnknownToolError(f"no pose on {self._arm.pose.topic} within {self.timeout_s:g} s of the picture")
        if before is None or after is None:
            return (before or after)[1]
        span = after[0] - before[0]
        share = (stamp_ns - before[0]) / span if span else 0.0
        return before[1] + share * (after[1] - before[1])

    def ends(self, frames: LiveFrames, stamp_ns: int) -> tuple[np.ndarray, np.ndarray]:
        """(3,) tip then and (3,) trocar in world [m]. Raises UnknownToolError, UnknownFrameError."""
        tip = self.base_tip(stamp_ns)
        if self._arm.rcm.value is None:
            raise UnknownToolError(f"no trocar on {self._arm.rcm.topic}")
        world_T_base = frames.fresh(WORLD, self.frame)
        turn, at = world_T_base[:3, :3], world_T_base[:3, 3]
        return turn @ tip + at, turn @ self._arm.rcm.value + at
