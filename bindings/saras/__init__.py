"""Bilateral teleoperation for surgical robotics: laws, kinematics, simulation, console, reports.

Conventions everywhere: SI units; poses are (4, 4) float64 named ``a_T_b``; twists and wrenches are (6,),
linear/force first; a wrench is what the robot exerts on its surroundings.
"""

from saras._core import (
    CalibrationError,
    ConfigError,
    Error,
    KinematicsError,
    ModelError,
    ProtocolError,
    Status,
    add_delta,
    displacement,
)

__version__ = "0.1.0"
__all__ = [
    "CalibrationError",
    "ConfigError",
    "Error",
    "KinematicsError",
    "ModelError",
    "ProtocolError",
    "Status",
    "add_delta",
    "displacement",
]
