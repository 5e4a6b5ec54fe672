"""Simulated arm, tissue, hand and network, and whole experiments without ROS."""

from saras._core.sim import (
    Channel,
    ChannelConfig,
    ChannelCounters,
    Operator,
    OperatorConfig,
    OperatorOutput,
    OperatorState,
    Tissue,
    TissueConfig,
    TissueOutput,
)
from saras.sim.link import Link

__all__ = [
    "Channel",
    "ChannelConfig",
    "ChannelCounters",
    "Link",
    "Operator",
    "OperatorConfig",
    "OperatorOutput",
    "OperatorState",
    "Tissue",
    "TissueConfig",
    "TissueOutput",
]
