"""Row 38 of the fault catalogue at the level of the laws: an hour of a biased twist, accelerated.

The arm is the servo of the simulation (second order, ω_n 60 rad/s, ζ 1) with encoder noise. The integrator is open loop
towards the arm, so what could run away is set-point less measured.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from saras.teleop import VelocityIntegrator, VelocityIntegratorConfig

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "faults"))
from support.results import Row, recorded

DT = 0.01
RCM = np.zeros(3)
OMEGA = 60.0
STALL_LIMIT_M = VelocityIntegratorConfig().lead_limit_m


class Arm:
    """Follows the set-point's position; exact solution of the critically damped servo over one period."""

    def __init__(self, start: np.ndarray) -> None:
        self.position, self.velocity = start.copy(), np.zeros(3)
        self.stuck = False

    def step(self, goal: np.ndarray) -> None:
        if self.stuck:
            self.velocity[:] = 0.0
            return
        error = self.position - goal
        slope = self.velocity + OMEGA * error
        decay = np.exp(-OMEGA * DT)
        self.position = goal + (error + slope * DT) * decay
        self.velocity = (slope - OMEGA * (error + slope * DT)) * decay


def hour_of(bias_m_s: np.ndarray, stuck: bool, ticks: int) -> tuple[float, float, float]:
    """(worst distance at rest, worst in motion, worst step) of set-point and measured [m]."""
    rng = np.random.default_rng(38)
    law = VelocityIntegrator()
    measured = np.eye(4)
    measured[:3, :3] = np.diag([1.0, -1.0, -1.0])
    measured[:3, 3] = (0.0, 0.0, -0.1)
    arm = Arm(measured[:3, 3])
    arm.stuck = stuck
    at_rest = in_motion = worst_step = 0.0
    previous = measured[:3, 3].copy()
    still = 0
    for tick in range(ticks):
        t = tick * DT
        moving = t % 20.0 < 15.0
        twist = np.zeros(6)
        if moving:  # 10 mm circles of 3 s, then a rest of 5 s
            twist[:2] = 0.021 * np.array([np.cos(2.1 * t), np.sin(2.1 * t)])
            still = 0
        else:
            still += 1
        twist[:3] += bias_m_s
        measured[:3, 3] = arm.position + rng.normal(0.0, 2e-6, 3)
        out = law.step(twist, measured, RCM, DT)
        set_point = out.set_point[:3, 3]
        lead = float(np.linalg.norm(set_point - arm.position))
        in_motion = max(in_motion, lead)
        if still > 50:
            at_rest = max(at_rest, lead)
        worst_step = max(worst_step, float(np.linalg.norm(set_point - previous)))
        previous = set_point.copy()
        arm.step(set_point)
    return at_rest, in_motion, worst_step


@pytest.mark.parametrize("bias_mm_s", [0.0, 0.1, 1.0])
def test_an_hour_of_bias_leaves_the_set_point_at_the_arm(bias_mm_s: float) -> None:
    direction = np.array([0.6, -0.8, 0.0])
    ticks = 360_000 if bias_mm_s == 1.0 else 36_000
    row = Row(
        38,
        f"twist with a bias of {bias_mm_s:g} mm/s, {ticks * DT:.0f} s of circles and rests at 100 Hz",
        "tests/property/test_fault_drift.py::test_an_hour_of_bias_leaves_the_set_point_at_the_arm",
        f"bias {bias_mm_s:g}",
    )
    with recorded(row):
        at_rest, in_motion, step = hour_of(1e-3 * bias_mm_s * direction, False, ticks)
        assert at_rest < 1e-3
        assert step <= VelocityIntegratorConfig().speed_limit_m_s * DT + 1e-9
        row.saw(f"within {1e3 * at_rest:.3f} mm of the arm at rest, {1e3 * in_motion:.2f} mm in motion: its lag")


def test_an_arm_that_does_not_follow_is_not_left_behind() -> None:
    row = Row(
        38,
        "the same bias of 1 mm/s and an arm that is stuck, 60 s",
        "tests/property/test_fault_drift.py::test_an_arm_that_does_not_follow_is_not_left_behind",
        "stuck arm",
    )
    with recorded(row):
        _, lead, _ = hour_of(np.array([1e-3, 0.0, 0.0]), True, 6_000)
        assert lead <= STALL_LIMIT_M + 2e-5  # of the noisy reading
        row.saw(
            f"the set-point leads by at most {1e3 * lead:.2f} mm (limit {1e3 * STALL_LIMIT_M:g}); "
            "a frozen arm's HOLD is row 17's"
        )
