"""tool_command: rotation of the hand piece and its clip become rotation and opening of the instruments."""

from __future__ import annotations

import math

import numpy as np
from sensor_msgs.msg import JointState, Joy

from saras_ros1.channel import SIDES, Channel
from saras_ros1.node import Node, Tick, run
from saras_ros1.nodes.tf_transformer import CLUTCH

CLIP = 1  # index in Joy.buttons
ROLL = 2  # index in the Simball joints


def read_roll(message: JointState) -> float:
    """Roll [rad] of the hand piece."""
    if len(message.position) <= ROLL or not math.isfinite(message.position[ROLL]):
        raise ValueError(f"joints {list(message.position)}: no finite roll")
    return message.position[ROLL]


def read_tool(message: JointState) -> tuple[float, float]:
    """Roll [rad] and opening (0 … 1) of the instrument, from arm_state."""
    if len(message.position) < 2 or not all(map(math.isfinite, message.position)):
        raise ValueError(f"tool {list(message.position)}: must be a finite roll and jaw")
    return message.position[0], min(1.0, max(0.0, message.position[1]))


def read_grip(message: JointState) -> float:
    """Opening 0 … 1."""
    if not message.position or not 0.0 <= message.position[0] <= 1.0:
        raise ValueError(f"grip {list(message.position)}: must be in [0, 1]")
    return message.position[0]


class JawPickup:
    """The jaw stays as it is after an engagement until the clip comes by: tissue that is held is not let go."""

    REACHED = 0.02  #: a clip so near to the jaw has come by

    def __init__(self, jaw: float) -> None:
        self._jaw, self._clip = jaw, math.nan
        self._taken = False

    def step(self, clip: float) -> float:
        """Opening to command; clip: opening asked for, 0 … 1."""
        if not self._taken:
            passed = (self._clip - self._jaw) * (clip - self._jaw) <= 0.0  # not with the first one: NaN
            self._taken = passed or abs(clip - self._jaw) <= self.REACHED
            self._clip = clip
        return clip if self._taken else self._jaw


class Side:
    """One instrument. Roll follows the hand's roll relative to a reference; clutch and engagement take a new one."""

    def __init__(self, node: ToolCommand, side: str) -> None:
        self.node = node
        self.channel = Channel(node, side)
        timeout_s = node.timeout_s
        self.joints = node.input(f"/touchball_{side}/joint_states", JointState, read_roll, timeout_s=timeout_s)
        self.grip = node.input(f"/touchball_{side}/grip", JointState, read_grip, timeout_s=timeout_s)
        self.buttons = node.input(f"/touchball_{side}/buttons", Joy, timeout_s=timeout_s)
        self.tool = node.input(f"/mesa_{side}/tool", JointState, read_tool, timeout_s=node.tool_timeout_s)
        self.names = [f"mesa_{side}/roll", f"mesa_{side}/jaw"]
        self.out = node.output(f"/mesa_{side}/tool_command", JointState)
        self.roll: float | None = None
        self.previous: float | None = None
        self.jaw: JawPickup | None = None
        node.loop(self.step, [self.joints], period_s=node.period_s, name=side)

    def step(self, tick: Tick) -> None:
        """Nothing is commanded unless engaged: the instrument keeps what it has."""
        if self.channel.newly_engaged():
            self.roll = self.previous = self.jaw = None
        if self.jaw is None and self.tool.fresh:
            self.roll, jaw = self.tool.value
            self.jaw = JawPickup(jaw)
        if tick.stale or not self.channel.engaged or not self.grip.fresh or self.roll is None:
            self.previous = None
            return
        hand = self.joints.value
        pressed = self.buttons.fresh_value.buttons if self.buttons.fresh else (0, 0)
        if self.previous is not None and not pressed[CLUTCH]:
            # The shorter way round, so that ±π of the encoder is no step.
            self.roll += math.remainder(hand - self.previous, 2.0 * math.pi)
            self.roll = float(np.clip(self.roll, -self.node.roll_limit, self.node.roll_limit))
        self.previous = hand
        clip = 0.0 if len(pressed) > CLIP and pressed[CLIP] else self.grip.value
        message = JointState(
            name=self.names, position=[self.roll, self.jaw.step(clip)], velocity=self.node.speed_limits
        )
        message.header.stamp = tick.stamp
        self.out.publish(message)


class ToolCommand(Node):
    """Both instruments."""

    def __init__(self) -> None:
        super().__init__("tool_command")
        self.period_s = self.params.number("period_s", 0.001, 0.1)
        self.timeout_s = self.params.number("console_timeout_s", 0.005, 1.0)
        self.tool_timeout_s = self.params.number("tool_timeout_s", 0.005, 10.0)
        self.roll_limit = self.params.number("roll_limit_rad", 0.1, 20.0)
        self.speed_limits = [
            self.params.number("roll_speed_rad_s", 0.01, 20.0),
            self.params.number("jaw_speed_1_s", 0.01, 20.0),
        ]
        self.params.finish()
        self.sides = [Side(self, side) for side in SIDES]


def main() -> int:
    """Runs the node."""
    return run(ToolCommand)
