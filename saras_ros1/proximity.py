"""What the teleoperation of one arm reads of /collision/state."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import tf2_ros

from saras_ros1.channel import base_frame
from saras_ros1.msg import CollisionState
from saras_ros1.node import Node
from saras_ros1.static_frames import StaticFrames

NOWHERE = np.zeros(3)


class Nearness(NamedTuple):
    """Of one tool, in its arm's base frame."""

    max_speed_scale: float
    approach_direction: np.ndarray
    approach_speed_limit_m_s: float
    distance_m: float
    """To what is known; NaN: unknown."""


class Proximity:
    """The newest /collision/state for some sides. A silent, missing or unusable one is unknown, and slow.

    unknown_speed_scale: 0..1 of the speed limits while the state is unknown.
    """

    def __init__(self, node: Node, sides: tuple[str, ...], timeout_s: float, unknown_speed_scale: float) -> None:
        self._names = {f"mesa_{side}": side for side in sides}
        self._frames = StaticFrames()
        self._unknown = Nearness(unknown_speed_scale, NOWHERE, math.inf, math.nan)
        self.input = node.input("/collision/state", CollisionState, self._read, timeout_s=timeout_s)

    def of(self, side: str) -> Nearness:
        """The bounds that hold for this side now."""
        known = self.input.fresh_value
        return self._unknown if known is None else known.get(side, self._unknown)

    def _read(self, message: CollisionState) -> dict[str, Nearness]:
        sides = {}
        for tool in message.tools:
            side = self._names.get(tool.name)
            if side is not None:
                sides[side] = self._nearness(tool, side, message.header.frame_id)
        return sides

    def _nearness(self, tool: Any, side: str, frame: str) -> Nearness:
        scale, limit = tool.max_speed_scale, tool.approach_speed_limit
        if not (0.0 <= scale <= 1.0 and limit >= 0.0):  # a NaN fails here as well
            raise ValueError(f"{tool.name}: speed scale {scale} must be in 0..1, approach limit {limit} not negative")
        normal = np.array([tool.normal.x, tool.normal.y, tool.normal.z])
        if not np.isfinite(normal).all():
            return Nearness(scale, NOWHERE, math.inf, math.nan)
        try:
            direction = self._frames.lookup(base_frame(side), frame)[:3, :3] @ normal
        except tf2_ros.TransformException as error:
            raise ValueError(f"no transform to {base_frame(side)}: {error}") from None
        return Nearness(scale, direction, limit, tool.known_distance)
