"""A simulated arm out of the scene file: trocar, positioning arm, and the phantom under the instrument."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from saras import ConfigError
from saras.kinematics import mesa, scene
from saras.mesa_link.simulated_arm import SimulatedArm
from saras.sim import ServoArmConfig, Tissue, TissueConfig

# Encoders of a real arm never rest to the last bit; this is far below anything that matters.
_ENCODER_NOISE = (1e-6, 1e-6, 1e-6, 1e-6, 1e-7, 1e-6)
_SENSOR_NOISE_N = 0.02


def tissue_config(place: scene.Scene, arm: str, seed: int) -> TissueConfig:
    """The phantom's upper face as tissue, in the arm's base frame."""
    world_T_surface = np.eye(4)
    world_T_surface[:3, 3] = place.phantom.center + 0.5 * place.phantom.size * (0.0, 0.0, 1.0)
    base_T_surface = np.linalg.inv(place.world_T(f"{arm}/sbs_world")) @ world_T_surface
    return TissueConfig(base_T_surface=base_T_surface, force_noise_N=_SENSOR_NOISE_N, seed=seed)


def simulated_arm(
    path: str | Path, arm: str, *, seed: int = 1, tissue: bool = True, sensor: bool = False
) -> SimulatedArm:
    """``arm`` (mesa_left, mesa_right) of the scene at ``path``. ConfigError names what is missing."""
    place = scene.load(path)
    if arm not in place.arms:
        raise ConfigError(f"{path}: arms.{arm}: no such arm; there are: {', '.join(sorted(place.arms))}")
    its = place.arms[arm]
    return SimulatedArm(
        its.rcm.tolist(),
        tissue=Tissue(tissue_config(place, arm, seed)) if tissue else None,
        sensor=sensor,
        servo=ServoArmConfig(joint_noise=np.array(_ENCODER_NOISE), seed=seed),
        q=mesa.home(its.rcm, elbow=its.elbow).tolist(),
        passive=its.passive_joints.tolist(),
    )
