"""What touch tells of tissue: stiffness, surface, and how well both are known; where a prior mesh lies, how it is bent.

Positions are (n, 3) [m] in one base frame, forces (n, 3) [N] that the *tool exerts on the tissue* (pressing points into
it). NaN with an infinite deviation means: not known. Samples that nothing may be learned from raise ModelError.
"""

from saras._core.model import (
    CrossEntropy,
    EstimateStatus,
    GpHyperparameters,
    HashGrid,
    HashGridConfig,
    LocalGp,
    LocalModelConfig,
    SampleVerdict,
    StiffnessGp,
    StiffnessGpConfig,
    StiffnessGpOutput,
    StiffnessGpState,
    SurfaceEstimate,
    TouchBelief,
)
from saras.model.exploring import CostError, Plan, TrajectoryOptimizer
from saras.model.learning import GpLearning, learn_hyperparameters
from saras.model.lump import LumpSearch
from saras.model.octave import OctaveCost, OctaveError
from saras.model.registering import (
    Deformation,
    DeformationGrid,
    Mesh,
    Registered,
    Registration,
    register,
    register_rigid,
)
from saras.model.stiffness_map import StiffnessMap, SurfaceEstimates
from saras.model.storage import StiffMesh

__all__ = [
    "CostError",
    "CrossEntropy",
    "Deformation",
    "DeformationGrid",
    "EstimateStatus",
    "GpHyperparameters",
    "GpLearning",
    "HashGrid",
    "HashGridConfig",
    "LocalGp",
    "LocalModelConfig",
    "LumpSearch",
    "Mesh",
    "OctaveCost",
    "OctaveError",
    "Plan",
    "Registered",
    "Registration",
    "SampleVerdict",
    "StiffMesh",
    "StiffnessGp",
    "StiffnessGpConfig",
    "StiffnessGpOutput",
    "StiffnessGpState",
    "StiffnessMap",
    "SurfaceEstimate",
    "SurfaceEstimates",
    "TouchBelief",
    "TrajectoryOptimizer",
    "learn_hyperparameters",
    "register",
    "register_rigid",
]
