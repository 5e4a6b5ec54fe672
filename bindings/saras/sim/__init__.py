"""Simulated arm, tissue, hand and network, and whole experiments without ROS."""

from saras._core.sim import (
    ArmMode,
    Channel,
    ChannelConfig,
    ChannelCounters,
    Operator,
    OperatorConfig,
    OperatorOutput,
    OperatorState,
    ServoArm,
    ServoArmConfig,
    ServoArmOutput,
    ServoArmState,
    Tissue,
    TissueConfig,
    TissueOutput,
)
from saras.sim.link import Link

__all__ = [
    "ArmMode",
    "Channel",
    "ChannelConfig",
    "ChannelCounters",
    "Link",
    "Operator",
    "OperatorConfig",
    "OperatorOutput",
    "OperatorState",
    "ServoArm",
    "ServoArmConfig",
    "ServoArmOutput",
    "ServoArmState",
    "Tissue",
    "TissueConfig",
    "TissueOutput",
]
