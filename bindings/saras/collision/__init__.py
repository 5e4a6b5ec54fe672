"""Distances between tools (capsules) and forbidden regions (parallelepipeds), and what follows from them.

Signed: negative is minus the least translation that separates. Normals are of unit length, first to second.
"""

from saras._core.collision import (
    Capsule,
    DistanceStatus,
    Parallelepiped,
    Partner,
    ProximityMonitor,
    ProximityMonitorConfig,
    ProximityMonitorOutput,
    ProximityMonitorState,
    ProximityState,
    RepulsiveForce,
    RepulsiveForceConfig,
    RepulsiveForceOutput,
    RepulsiveForceState,
    SignedDistance,
    ToolDistance,
    ToolProximity,
    capsule_capsule,
    capsule_parallelepiped,
)
from saras.collision.forbidden_regions import ForbiddenRegions
from saras.collision.scene import Scene

__all__ = [
    "Capsule",
    "DistanceStatus",
    "ForbiddenRegions",
    "Parallelepiped",
    "Partner",
    "ProximityMonitor",
    "ProximityMonitorConfig",
    "ProximityMonitorOutput",
    "ProximityMonitorState",
    "ProximityState",
    "RepulsiveForce",
    "RepulsiveForceConfig",
    "RepulsiveForceOutput",
    "RepulsiveForceState",
    "Scene",
    "SignedDistance",
    "ToolDistance",
    "ToolProximity",
    "capsule_capsule",
    "capsule_parallelepiped",
]
