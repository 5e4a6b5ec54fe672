"""Kinematics: serial chains, the SARAS arm (``mesa``), the da Vinci (``dvrk``), the hand piece (``simball``)."""

from saras._core.kinematics import (
    Chain,
    Joint,
    JointType,
    RcmArm,
    RcmArmConfig,
    SimballHandle,
    SimballHandleConfig,
)

__all__ = ["Chain", "Joint", "JointType", "RcmArm", "RcmArmConfig", "SimballHandle", "SimballHandleConfig"]
