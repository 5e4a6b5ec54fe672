"""The laws of bilateral teleoperation. Each has a Config, ``step(…)``, ``state`` and ``reset``."""

from saras._core.teleop import (
    TwistEstimator,
    TwistEstimatorConfig,
    TwistEstimatorOutput,
    TwistEstimatorState,
)

__all__ = ["TwistEstimator", "TwistEstimatorConfig", "TwistEstimatorOutput", "TwistEstimatorState"]
