"""Arms of system files by their type: kinematics, limits, what they can do."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from saras import csa
from saras.kinematics import dvrk, mesa, mtm

Array = NDArray[np.float64]
Json = dict[str, Any]

#: What each type can do when the file does not list it (CRTK names).
CAPABILITIES = {
    "simulated_hand": ["measured_cp", "servo_cf"],
    "simulated_mtm": ["measured_js", "measured_cp", "servo_jf"],
    "dvrk_mtm": ["measured_js", "measured_cp", "servo_jf"],
    "simulated_psm": ["measured_js", "measured_cp", "measured_cf", "servo_jp"],
    "simulated_saras": ["measured_js", "measured_cp", "measured_cf", "servo_jp"],
    "dvrk_psm": ["measured_js", "measured_cp", "measured_cf", "servo_jp"],
    "saras_arm": ["measured_js", "measured_cf", "servo_cp"],
    "udp": ["measured_js", "measured_cp", "measured_cf", "servo_jp", "servo_cp"],
}
ROLES = {
    "master": ("simulated_hand", "simulated_mtm", "dvrk_mtm"),
    "slave": ("simulated_psm", "simulated_saras", "dvrk_psm", "saras_arm", "udp"),
}
SIMULATED = ("simulated_hand", "simulated_mtm", "simulated_psm", "simulated_saras")

PSM_HOME: Array = np.array([0.1, -0.1, 0.15, 0.2, 0.1, -0.1])
"""(6,) joints of a simulated PSM at the start."""
TROCAR_M = 0.0005
"""A SARAS arm's shaft passes its trocar within this."""


@dataclass(frozen=True)
class ArmModel:
    """What a controller must know of an arm."""

    joint_names: tuple[str, ...]
    home: Array
    """(n,) where a simulated one starts"""
    limits: Array
    """(n, 2) lower, upper [rad, m]"""
    speed: Array
    """(n,) [rad/s, m/s]"""
    lead: Array
    """(n,) largest |set-point - measured|"""
    forward: Callable[[Array], Array]
    """(n,) -> (4, 4) base_T_tip"""
    jacobian: Callable[[Array], Array]
    """(n,) -> (6, n) base axes"""
    shaft: Callable[[Array], Array]
    """(n,) -> (3,) unit vector from trocar to tip"""
    within_reach: Callable[[Array], Array]
    """(4, 4) -> (4, 4): the pose nearest to it that the mechanism allows"""
    fixtures: tuple[csa.Fixture, ...] = ()
    """What the mechanism itself asks for: a trocar that nothing but the controller keeps."""

    def motion(self) -> csa.ConstrainedMotionConfig:
        """Limits for the controllers."""
        return csa.ConstrainedMotionConfig(
            lower=self.limits[:, 0], upper=self.limits[:, 1], speed=self.speed, lead=self.lead
        )


def capabilities(arm: Json) -> list[str]:
    """CRTK names of what an arm of a system file takes and gives."""
    return list(arm.get("capabilities", CAPABILITIES[arm["type"]]))


def topic(arm: Json, name: str) -> str:
    """Where a CRTK name of an arm is; the SARAS platform has names of its own."""
    if arm["type"] != "saras_arm":
        return f"/{arm['name']}/{name}"
    own = {"measured_js": "joint_states", "servo_cp": "set_point"}
    return f"/mesa_{arm['side']}/{own.get(name, name)}"


def base_frame(arm: Json) -> str:
    """Of a slave: where all of its teleoperation is."""
    return f"mesa_{arm['side']}/sbs_world" if arm["type"] == "saras_arm" else str(arm["name"])


def slave_model(arm: Json) -> ArmModel:
    """Kinematics of a slave of a system file. Raises ConfigError for an unknown instrument."""
    if arm["type"] == "udp":
        return slave_model(arm["kinematics"])
    if arm["type"] in ("simulated_saras", "saras_arm"):
        return _saras(np.array(arm.get("trocar_m", mesa.NOMINAL_RCM), dtype=float))
    psm = dvrk.psm(arm.get("tool", "400006"), arm.get("body", "classic"))
    return ArmModel(
        joint_names=tuple(dvrk.PSM_JOINT_NAMES),
        home=PSM_HOME.copy(),
        limits=np.asarray(psm.limits),
        speed=np.array([1.0, 1.0, 0.2, 3.0, 3.0, 3.0]),
        lead=np.array([0.1, 0.1, 0.02, 0.5, 0.5, 0.5]),
        forward=psm.forward,
        jacobian=psm.jacobian,
        shaft=psm.shaft,
        within_reach=lambda pose: pose,
    )


def _saras(trocar: Array) -> ArmModel:
    arm = mesa.arm()

    def within_reach(pose: Array) -> Array:
        turned = arm.pivot_pose(pose, trocar)
        return pose if turned is None else turned

    return ArmModel(
        joint_names=mesa.JOINT_NAMES,
        home=mesa.home(trocar),
        limits=np.asarray(arm.limits),
        speed=np.asarray(arm.config.speed),
        lead=np.array([0.1, 0.1, 0.1, 0.1, 0.02, 0.5]),
        forward=arm.forward,
        jacobian=arm.jacobian,
        shaft=lambda q: np.asarray(arm.forward(q)[:3, 2]),
        within_reach=within_reach,
        fixtures=(csa.Fixture.remote_centre("trocar", trocar, TROCAR_M, soft=True),),
    )


@dataclass(frozen=True)
class MasterModel:
    """A master that takes joint torques."""

    joint_names: tuple[str, ...]
    home: Array
    forward: Callable[[Array], Array]
    jacobian: Callable[[Array], Array]
    gravity: csa.GravityModel | None
    torque_limit: Array
    """(n,) [N m]"""


def master_model(arm: Json) -> MasterModel | None:
    """Kinematics of a master of a system file; None for one that takes forces. Raises ConfigError."""
    if arm["type"] == "simulated_hand":
        return None
    chain, links = mtm.chain(), arm.get("links")
    gravity = None
    if links is not None:
        up = arm.get("up", [0.0, 0.0, 1.0])
        masses, centres = [link["mass_kg"] for link in links], [np.array(link["centre_m"]) for link in links]
        gravity = csa.GravityModel(mtm.joints(), masses, centres, -9.81 * np.array(up) / np.linalg.norm(up))
    return MasterModel(
        joint_names=mtm.JOINT_NAMES,
        home=mtm.HOME.copy(),
        forward=chain.forward,
        jacobian=chain.jacobian,
        gravity=gravity,
        torque_limit=np.array(arm.get("torque_limit_Nm", [1.8, 1.8, 1.8, 0.6, 0.2, 0.2, 0.05])),
    )


__all__ = [
    "CAPABILITIES",
    "PSM_HOME",
    "ROLES",
    "SIMULATED",
    "ArmModel",
    "MasterModel",
    "base_frame",
    "capabilities",
    "master_model",
    "slave_model",
    "topic",
]
