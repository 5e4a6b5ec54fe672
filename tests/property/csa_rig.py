"""Simulated PSM on springs, for the tests of saras.csa: its joints follow as second-order systems."""

from __future__ import annotations

import numpy as np

from saras import csa
from saras.kinematics import dvrk

Q0 = np.array([0.1, -0.1, 0.15, 0.2, 0.1, -0.1])
OMEGA = 150.0
DT = 0.001


def motion_config(**changes) -> csa.ConstrainedMotionConfig:
    limits = np.asarray(dvrk.psm().limits)
    fields = {
        "lower": limits[:, 0],
        "upper": limits[:, 1],
        "speed": np.array([1.0, 1.0, 0.2, 3.0, 3.0, 3.0]),
        "lead": np.array([0.1, 0.1, 0.02, 0.5, 0.5, 0.5]),
    }
    return csa.ConstrainedMotionConfig(**{**fields, **changes})


def slave_config(**changes) -> csa.SlaveMlcConfig:
    fields = {"motion": motion_config(), "period_s": DT, "arm_lag_s": 2.0 / OMEGA, "sensor_lag_s": 0.002}
    return csa.SlaveMlcConfig(**{**fields, **changes})


class Arm:
    """Set-point q, measured joints behind it, and a plane of tissue z = height under the tip (outward +z)."""

    def __init__(self, stiffness_N_m: float, q: np.ndarray = Q0) -> None:
        self.psm = dvrk.psm()
        self.q = np.array(q)
        self.measured, self.speed = np.array(q), np.zeros(6)
        self.stiffness_N_m = stiffness_N_m
        self.height = self.tip()[2]

    def tip(self) -> np.ndarray:
        return self.psm.forward(self.measured)[:3, 3]

    def pose(self) -> np.ndarray:
        return self.psm.forward(self.q)

    def jacobian(self) -> np.ndarray:
        return self.psm.jacobian(self.q)

    def depth(self) -> float:
        return self.height - self.tip()[2]

    def wrench(self) -> np.ndarray:
        """Exerted on the tissue."""
        return np.array([0.0, 0.0, -self.stiffness_N_m * max(0.0, self.depth()), 0.0, 0.0, 0.0])

    def advance(self, q: np.ndarray, dt: float = DT) -> None:
        """Exact for a critically damped second-order system with the set-point held."""
        self.q = np.array(q)
        error, decay = self.measured - self.q, np.exp(-OMEGA * dt)
        rate = self.speed + OMEGA * error
        self.measured = self.q + (error + rate * dt) * decay
        self.speed = (rate - OMEGA * (error + rate * dt)) * decay


def regulate(law: csa.SlaveMlc, arm: Arm, desired_force_N: float, seconds: float, *, surface=None, **inputs):
    """Hybrid control at DT with the tip's desired pose moving sideways at 10 mm/s. Forces, joint rates, reasons."""
    desired = arm.pose().copy()
    start, forces, rates, reasons = arm.height, [], [], []
    for i in range(int(seconds / DT)):
        desired[0, 3] += 0.010 * DT
        if surface is not None:
            arm.height = start + surface(i * DT)
        output = law.step(
            arm.q, arm.jacobian(), arm.pose(), desired, DT, tissue_wrench=arm.wrench(), mode=csa.SlaveMode.HYBRID,
            desired_force_N=desired_force_N, normal=[0.0, 0.0, 1.0], q_measured=arm.measured, **inputs,
        )  # fmt: skip
        arm.advance(output.motion.q)
        forces.append(-arm.wrench()[2])
        rates.append(output.motion.rates)
        reasons.append(output.motion.reason)
    return np.array(forces), np.array(rates), reasons
