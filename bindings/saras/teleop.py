"""The laws of bilateral teleoperation. Each has a Config, ``step(…)``, ``state`` and ``reset``."""

from saras._core.teleop import (
    EnergyTank,
    EnergyTankConfig,
    EnergyTankOutput,
    EnergyTankState,
    LedgerReceiver,
    LedgerReceiverState,
    LedgerSender,
    TwistEstimator,
    TwistEstimatorConfig,
    TwistEstimatorOutput,
    TwistEstimatorState,
)

__all__ = [
    "EnergyTank",
    "EnergyTankConfig",
    "EnergyTankOutput",
    "EnergyTankState",
    "LedgerReceiver",
    "LedgerReceiverState",
    "LedgerSender",
    "TwistEstimator",
    "TwistEstimatorConfig",
    "TwistEstimatorOutput",
    "TwistEstimatorState",
]
