"""Both sides of the teleoperation in one step: the laws of the separate nodes in their order, as one value.

Pure: no clock, no thread, no topic. ``saras.runtime`` runs it at 1 kHz.
"""

from saras._core.pipeline import (
    ArmInput,
    DistancesConfig,
    HandleInput,
    NearnessInput,
    Pipeline,
    PipelineConfig,
    PipelineInput,
    PipelineOutput,
    PipelineSideOutput,
    PipelineState,
    SceneInput,
    SideInput,
    SupervisorWord,
    TankOutput,
)

__all__ = [
    "ArmInput",
    "DistancesConfig",
    "HandleInput",
    "NearnessInput",
    "Pipeline",
    "PipelineConfig",
    "PipelineInput",
    "PipelineOutput",
    "PipelineSideOutput",
    "PipelineState",
    "SceneInput",
    "SideInput",
    "SupervisorWord",
    "TankOutput",
]
