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
from saras.sim.exchange import EnergyBook
from saras.sim.experiment import Adversary, Experiment, Restart, Side, guard_tank, master_tank, slave_tank, transparency
from saras.sim.link import Link
from saras.sim.loop import run
from saras.sim.metrics import Metrics
from saras.sim.motion import Motion, Palpate, PressAndHold, Recorded, Still, SumOfSines
from saras.sim.result import Result

__all__ = [
    "Adversary",
    "ArmMode",
    "Channel",
    "ChannelConfig",
    "ChannelCounters",
    "EnergyBook",
    "Experiment",
    "Link",
    "Metrics",
    "Motion",
    "Operator",
    "OperatorConfig",
    "OperatorOutput",
    "OperatorState",
    "Palpate",
    "PressAndHold",
    "Recorded",
    "Restart",
    "Result",
    "ServoArm",
    "ServoArmConfig",
    "ServoArmOutput",
    "ServoArmState",
    "Side",
    "Still",
    "SumOfSines",
    "Tissue",
    "TissueConfig",
    "TissueOutput",
    "guard_tank",
    "master_tank",
    "run",
    "slave_tank",
    "transparency",
]
