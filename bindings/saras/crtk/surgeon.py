"""The main surgeon, scripted: where the da Vinci's tips want to be. Seeded; the same times give the same points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from saras.console.motion import minimum_jerk
from saras.sim import clap

Array = npt.NDArray[np.float64]

MODES = ("rest", "circle", "reach", "meet", "clap")

CIRCLE_M, CIRCLE_HZ = 0.02, 0.1
REACH_M, REACH_S = 0.03, 5.0
# meet: towards it, there, back, and away, in seconds; PSM1 goes to the tools when PSM2 goes to the bones.
MEET_S = (6.0, 2.0, 6.0, 2.0)


class Surgeon:
    """Tip positions in world.

    mode: one of MODES; homes: where each arm's tip rests (3,) [m]; closest_m: how near `meet` brings the tips.
    """

    def __init__(self, mode: str, seed: int, homes: Mapping[str, npt.ArrayLike], closest_m: float = 0.008) -> None:
        if mode not in MODES:
            raise ValueError(f"mode = '{mode}': must be one of {', '.join(MODES)}")
        self.mode, self.closest_m = mode, closest_m
        self.homes = {name: np.array(home, dtype=float) for name, home in homes.items()}
        random = np.random.default_rng(seed)
        self._phase = {name: random.uniform(0.0, 2.0 * math.pi) for name in homes}
        self._targets = {name: random.uniform(-REACH_M, REACH_M, (16, 3)) for name in homes}

    def tip(self, name: str, t: float, tool: Array | None = None, bone: Array | None = None) -> Array:
        """(3,) where the arm's tip should be at t [s]. tool, bone: what `meet` goes to, (3,) in world, if known.

        clap: t is the time of day; PSM1 jumps up for a moment at each full second (saras.sim.clap).
        """
        home = self.homes[name]
        if self.mode == "clap":
            lifted = name == "PSM1" and clap.is_on(round(1e9 * t))
            return home + np.array([0.0, 0.0, clap.LIFT_M]) if lifted else home
        if self.mode == "rest" or (self.mode == "meet" and name.startswith("ECM")):
            return home
        if self.mode == "circle":
            angle = 2.0 * math.pi * CIRCLE_HZ * t + self._phase[name]
            fade = min(1.0, t)
            return np.asarray(home + fade * CIRCLE_M * np.array([math.cos(angle), math.sin(angle), 0.0]))
        if self.mode == "reach":
            k, share = divmod(t / REACH_S, 1.0)
            points = self._targets[name]
            begin = points[int(k - 1) % len(points)] if k >= 1.0 else np.zeros(3)
            return np.asarray(home + begin + minimum_jerk(share)[0] * (points[int(k) % len(points)] - begin))
        k, share = divmod(t, sum(MEET_S))
        towards, there, back, _ = MEET_S
        to_tool = (int(k) + (1 if name.endswith("2") else 0)) % 2 == 0
        target = tool if to_tool else bone
        if target is None:
            return home
        way = target - home
        length = float(np.linalg.norm(way))
        if length <= self.closest_m:
            return home
        if share < towards:
            part = minimum_jerk(share / towards)[0]
        elif share < towards + there:
            part = 1.0
        else:
            part = 1.0 - minimum_jerk(min(1.0, (share - towards - there) / back))[0]
        return np.asarray(home + part * (1.0 - self.closest_m / length) * way)


def joints_for_tip(kinematics: Any, base_T_world: Array, tip: Array, roll: float = 0.0) -> Array:
    """(n,) joints that put the tip at a point of world with a straight wrist; limits are not applied.

    A tip in the remote centre has no direction: ValueError.
    """
    x, y, z = base_T_world[:3, :3] @ tip + base_T_world[:3, 3]
    depth = math.sqrt(x * x + y * y + z * z)
    if not depth > 1e-6:
        raise ValueError("tip: must be away from the remote centre")
    q = np.zeros(len(kinematics.limits))
    q[0], q[1], q[3] = math.atan2(x, -z), math.asin(max(-1.0, min(1.0, -y / depth))), roll
    q[2] = depth - float(kinematics.forward(q)[:3, 3] @ kinematics.shaft(q))
    return q


__all__ = ["MODES", "Surgeon", "joints_for_tip"]
