"""Simulated arms of a system file, as their low-level controllers behave: a master in a hand, a slave's joints."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import sim
from saras.csa.setup import Setup
from saras.csa.simulation import SimulatedJoints

Array = NDArray[np.float64]

IK_DAMPING = 1e-4
WATCHDOG_S = 0.1
"""Torques and forces that are older than this are none."""


class SimulatedMaster:
    """A handle in a simulated hand, with the joints of its arm where it has some. Positions in the arm's base axes."""

    def __init__(self, setup: Setup) -> None:
        self.model = setup.master_model
        self._hand = sim.Operator(getattr(sim.OperatorConfig, setup.master.get("grip", "firm"))())
        self.intended: Array = np.zeros(3)
        """(3,) where the hand wants the handle, from its start [m]"""
        self.force: Array = np.zeros(3)
        """(3,) on the hand [N]"""
        self.q = None if self.model is None else self.model.home.copy()
        self.start = np.eye(4) if self.model is None else np.array(self.model.forward(self.model.home))
        self.pose: Array = self.start.copy()
        self.velocity: Array = np.zeros(3)
        self._told_s, self._time_s = -np.inf, 0.0

    def obey_force(self, force: Array) -> None:
        """(3,) [N]."""
        self.force, self._told_s = np.array(force, dtype=float), self._time_s

    def obey_torques(self, torque: Array) -> None:
        """(n,) joint torques [N m]; what bears the links' weight does not reach the hand."""
        assert self.model is not None and self.q is not None
        free = np.asarray(torque, dtype=float)
        if self.model.gravity is not None:
            free = free - self.model.gravity.torque(self.q)
        jacobian = self.model.jacobian(self.q)
        wrench = np.linalg.solve(jacobian @ jacobian.T + 1e-9 * np.eye(6), jacobian @ free)
        self.obey_force(wrench[:3])

    def step(self, dt: float) -> None:
        """Moves on by dt [s]."""
        self._time_s += dt
        if self._time_s - self._told_s > WATCHDOG_S:
            self.force = np.zeros(3)
        moved = self._hand.step(self.force, self.intended, dt)
        self.pose = self.start.copy()
        self.pose[:3, 3] += moved.position
        self.velocity = np.array(moved.velocity)
        if self.model is not None:
            self._follow()

    def _follow(self) -> None:
        """The joints go with the handle, its orientation kept; two Newton steps from the last ones."""
        assert self.model is not None and self.q is not None
        for _ in range(2):
            at = self.model.forward(self.q)
            error = np.concatenate([self.pose[:3, 3] - at[:3, 3], rotation_between(at, self.pose)])
            jacobian = self.model.jacobian(self.q)
            self.q = self.q + jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + IK_DAMPING**2 * np.eye(6), error)


def rotation_between(a: Array, b: Array) -> Array:
    """(3,) small rotation vector from pose a to b, base axes."""
    turned = b[:3, :3] @ a[:3, :3].T
    axis = np.array([turned[2, 1] - turned[1, 2], turned[0, 2] - turned[2, 0], turned[1, 0] - turned[0, 1]])
    return np.asarray(0.5 * axis)


class SimulatedSlave:
    """Joints that follow their set-points; those beyond their limits are refused."""

    def __init__(self, setup: Setup) -> None:
        self.model = setup.slave_model
        self.set_point: Array = self.model.home.copy()
        self.joints = SimulatedJoints(self.set_point, setup.slave.get("frequency_rad_s", 150.0))

    def obey(self, q: Any) -> str:
        """(n,) set-point; why it is refused, or nothing."""
        wanted = np.array(q, dtype=float)
        if wanted.shape != self.set_point.shape or not np.isfinite(wanted).all():
            return f"{wanted.size} values: must be {len(self.set_point)} finite numbers"
        lower, upper = self.model.limits.T
        for name, value, low, high in zip(self.model.joint_names, wanted, lower, upper):
            if not low - 1e-9 <= value <= high + 1e-9:
                return f"{name} = {value:g}: must be in [{low:g}, {high:g}]"
        self.set_point = wanted
        return ""

    def step(self, dt: float) -> None:
        """Moves on by dt [s]."""
        self.joints.advance(self.set_point, dt)

    @property
    def pose(self) -> Array:
        """(4, 4) of the measured joints."""
        return self.model.forward(self.joints.measured)

    @property
    def twist(self) -> Array:
        """(6,) of the tip, base axes."""
        return np.asarray(self.model.jacobian(self.joints.measured) @ self.joints.rate)
