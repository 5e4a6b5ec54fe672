"""CRTK without ROS: the state machine, point-to-point motion and a simulated arm. Facts: docs/dvrk.md."""

from __future__ import annotations

from saras.crtk.arm import MotionLimits, SimulatedCrtkArm
from saras.crtk.motion import PointToPoint
from saras.crtk.states import COMMANDS, STATES, StateMachine
from saras.crtk.surgeon import MODES, Surgeon

__all__ = [
    "COMMANDS",
    "MODES",
    "STATES",
    "MotionLimits",
    "PointToPoint",
    "SimulatedCrtkArm",
    "StateMachine",
    "Surgeon",
]
