"""A machine for tests of the arm's link: the tip goes straight to its target at a bounded speed."""

from __future__ import annotations

import math

from saras.mesa_link.fields import MessageError
from saras.mesa_link.plant import ArmSample
from saras.mesa_link.protocol import MaxVelocity, Reason, Target, Tool, Truth

HOME = Target((0.18, 0.0, -0.18), (1.0, 0.0, 0.0, 0.0))
REACH_M = 0.10  # from HOME


class FakePlant:
    def __init__(self) -> None:
        self.position, self.target, self.speed = HOME.position, HOME, 0.1
        self.tool: Tool | None = None
        self.rcm, self.mode, self.brakes = (0.18, 0.0, -0.10), "pivot", True
        self.followed: list[Target] = []
        self.holds = 0
        self.time_s = 0.0

    def follow(self, target: Target) -> None:
        if not self.brakes:
            raise MessageError(Reason.BRAKES_OPEN, "set_target: lock the positioning arm first")
        if math.dist(target.position, HOME.position) > REACH_M:
            raise MessageError(Reason.UNREACHABLE, "set_target.position: too far")
        self.target = target
        self.followed.append(target)

    def hold(self) -> None:
        self.holds += 1
        self.target = Target(self.position, self.target.quaternion)

    def move_tool(self, tool: Tool) -> None:
        self.tool = tool

    def set_max_velocity(self, bounds: MaxVelocity) -> None:
        self.speed = bounds.linear_m_s

    def set_rcm(self, position: tuple[float, ...]) -> None:
        self.rcm = position

    def set_mode(self, mode: str) -> None:
        self.mode = mode

    def brake(self, on: bool) -> None:
        self.brakes = on

    def step(self, duration_s: float) -> None:
        self.time_s += duration_s
        distance = math.dist(self.position, self.target.position)
        part = 1.0 if distance <= self.speed * duration_s else self.speed * duration_s / distance
        self.position = tuple(p + part * (t - p) for p, t in zip(self.position, self.target.position))

    def sample(self) -> ArmSample:
        return ArmSample(
            joints=(0.0,) * 6,
            joint_velocities=(0.0,) * 6,
            jaw=0.0 if self.tool is None else self.tool.jaw,
            passive=(0.0,) * 7,
            position=self.position,
            quaternion=self.target.quaternion,
            rcm=self.rcm,
            mode=self.mode,
            brakes=self.brakes,
            target=self.target,
        )

    def truth(self, tick: int) -> Truth:
        return Truth(tick, 0.0, (0.0, 0.0, 0.0), 0.0)
