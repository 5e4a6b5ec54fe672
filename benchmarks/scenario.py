"""What the teleop benchmark steps through, the same numbers as benchmarks/scenario.hpp.

Two handles on smooth paths, two tips that follow at half scale and 33 ms later, one soft contact every 3.3 s.
"""

from __future__ import annotations

import numpy as np
from numpy_laws import exp

DT_S = 0.01
TICKS = 1000  #: a whole number of periods, so that the scenario repeats without a jump
OMEGA = 2 * np.pi * 0.3
SCALE = 0.5
LAG_S = 0.033
RCM = np.array([0.18, 0.0, -0.10])
DEPTH_M = 0.11


def pose(rotation, position):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = rotation, position
    return result


BASE_T_CONSOLE = pose(exp(np.array([0.0, 0.0, np.pi / 2])), [0.1, 0.2, 0.3])
TOUCH_T_CONSOLE = pose(exp(np.array([0.0, 0.3, 0.0])), [0.0, 0.0, 0.0])


def handle(t, side):
    """console_T_handle; side is +1 or -1."""
    a = OMEGA * t
    position = np.array([0.03 * np.sin(a), 0.03 * side * np.cos(a), 0.01 * np.sin(2 * a)])
    return pose(exp(np.array([0.3 * np.sin(a), 0.2 * np.cos(a), 0.4 * side * np.sin(a)])), position)


def tip(t, side):
    """base_T_tip of the slave, its shaft through the trocar."""
    moved = handle(t - LAG_S, side)[:3, 3] - handle(0.0, side)[:3, 3]
    arm = np.array([0.0, 0.0, -DEPTH_M]) + SCALE * BASE_T_CONSOLE[:3, :3] @ moved
    down, shaft = np.array([0.0, 0.0, -1.0]), arm / np.linalg.norm(arm)
    axis = np.cross(down, shaft)
    sine = np.linalg.norm(axis)
    turn = exp(axis / sine * np.arctan2(sine, down @ shaft)) if sine > 1e-12 else np.eye(3)
    return pose(turn @ np.diag([1.0, -1.0, -1.0]), RCM + arm)


def tissue_wrench(t):
    """(6,) that the tip exerts on the tissue."""
    force = 0.75 * (1.0 - np.cos(2 * OMEGA * t))
    return np.array([0.2 * force, 0.0, -force, 0.0, 0.0, 0.0])


def inputs():
    """A list over ticks of (handles (2, 4, 4), tips (2, 4, 4), wrenches (2, 6))."""
    rows = []
    for i in range(TICKS):
        t = i * DT_S
        handles = np.stack([handle(t, side) for side in (1, -1)])
        tips = np.stack([tip(t, side) for side in (1, -1)])
        rows.append((handles, tips, np.stack([tissue_wrench(t)] * 2)))
    return rows
