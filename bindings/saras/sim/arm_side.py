"""The simulated arm of one side on its tissue, with the mean wrench over each graph interval."""

from __future__ import annotations

import contextlib
import copy

import numpy as np
import numpy.typing as npt

from saras import KinematicsError
from saras._core.sim import ServoArm, Tissue, TissueConfig, TissueOutput
from saras.kinematics import RcmArm, mesa
from saras.sim.experiment import Side

Array = npt.NDArray[np.float64]


class ArmSide:
    """A ServoArm that follows a set-point at the device rate and presses on its tissue."""

    def __init__(self, side: Side) -> None:
        """At rest, the shaft vertical through the trocar."""
        self.rcm = np.array(side.rcm_m)
        self._arm = ServoArm(side.arm)
        self._kinematics = RcmArm()
        self._q = mesa.home(self.rcm, 0.1)
        self._arm.reset(self._q)
        self.base_T_tip: Array = self._kinematics.forward(self._q)
        self.measured_base_T_tip = self.base_T_tip
        self._velocity = np.zeros(3)
        self._target = self.base_T_tip[:3, 3].copy()
        self._roll = 0.0
        self._tissue = None if side.tissue is None else Tissue(self._placed(side.tissue, side.surface_below_m))
        self.contact: TissueOutput | None = None
        self.force: Array = np.zeros(3)
        self._impulse = np.zeros(3)
        self._elapsed_s = 0.0
        self.rcm_deviation_m = 0.0
        self.delivered_J = 0.0

    def _placed(self, config: TissueConfig, below_m: float) -> TissueConfig:
        if np.array_equal(config.base_T_surface, np.eye(4)):
            config = copy.copy(config)
            base_T_surface = np.eye(4)
            base_T_surface[:3, 3] = self.base_T_tip[:3, 3] - [0.0, 0.0, below_m]
            config.base_T_surface = base_T_surface
        return config

    def follow(self, base_T_set_point: Array) -> None:
        """Take the next set-point (4, 4): its point, and the roll joint that its pose needs."""
        self._target = base_T_set_point[:3, 3]
        pose = self._kinematics.pivot_pose(base_T_set_point, self.rcm)
        if pose is None:
            return  # in the trocar: the roll joint keeps its last target
        # Without an answer the roll joint keeps its last target, as the arm keeps its last tip in reach.
        with contextlib.suppress(KinematicsError):
            self._roll = float(self._kinematics.inverse(pose, self._q)[5])

    def tick(self, dt: float) -> None:
        """One device tick."""
        before = self.base_T_tip[:3, 3]
        if self._tissue is not None:
            self.contact = self._tissue.step(before, self._velocity, dt)
            self.force = self.contact.wrench[:3]
            self._impulse += self.contact.measured_wrench[:3] * dt
        out = self._arm.step(self._target, self._roll, self.rcm, -self.force, dt)
        self._q = out.q
        self.base_T_tip, self.measured_base_T_tip = out.base_T_tip, out.measured_base_T_tip
        self._velocity = out.tip_velocity
        self.rcm_deviation_m = out.rcm_deviation_m
        self.delivered_J += float(self.force @ (self.base_T_tip[:3, 3] - before))
        self._elapsed_s += dt

    def take_mean_wrench(self) -> Array:
        """Mean wrench (6,) that the tool exerted since the last call."""
        wrench = np.zeros(6)
        if self._elapsed_s > 0.0:
            wrench[:3] = self._impulse / self._elapsed_s
        self._impulse = np.zeros(3)
        self._elapsed_s = 0.0
        return wrench
