"""One teleoperation of a system file, as its controllers are built from it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from saras import ConfigError, csa, sim
from saras.csa import arms
from saras.csa.surface import MeshSurface, PlaneSurface, Surface, load_mesh, rotation
from saras.csa.system_fixtures import UP, fixture
from saras.csa.udp import UdpSettings, udp_settings

Array = NDArray[np.float64]
Json = dict[str, Any]

TELEOP_FIELDS = (
    "scale",
    "desired_force_N",
    "force_cap_N",
    "force_limit_N",
    "debounce_s",
    "stiffness_N_m",
    "mismatch_tolerance_m",
)
SLAVE_FIELDS = (
    "admittance_m_Ns",
    "scheduled",
    "stiffness_max_N_m",
    "stability_margin",
    "speed_limit_m_s",
    "approach_speed_m_s",
    "force_cap_N",
)
PHANTOM_HEIGHT_M = 0.008
DAMPING_MARGIN = 0.85


@dataclass(frozen=True)
class Setup:
    """Arms, gains, model and fixtures of one teleoperation. Everything in the slave's base axes."""

    path: Path
    name: str
    teleop: Json
    """as it stands in the file"""
    master: Json
    slave: Json
    period_s: float
    timeout_s: float
    latency_s: float
    start_timeout_s: float
    master_model: arms.MasterModel | None
    slave_model: arms.ArmModel

    @property
    def frame(self) -> str:
        """The slave's base."""
        return arms.base_frame(self.slave)

    @property
    def slave_R_master(self) -> Array:
        """(3, 3) turns the master's axes into the slave's."""
        return rotation(self.teleop.get("master_rpy_rad", [0.0, 0.0, 0.0]))

    def udp(self) -> UdpSettings | None:
        """The link to a slave of type udp; None: it is none. Raises ConfigError."""
        if self.slave["type"] != "udp":
            return None
        return udp_settings(self.slave, len(self.slave_model.joint_names), self.path.parent)

    def teleop_config(self, **changes: Any) -> csa.CsaTeleopConfig:
        """Raises ConfigError."""
        given = {name: self.teleop[name] for name in TELEOP_FIELDS if name in self.teleop}
        return csa.CsaTeleopConfig(**{**given, **changes})

    def slave_config(self, period_s: float | None = None, **changes: Any) -> csa.SlaveMlcConfig:
        """With the stability bound of K_g at this period, by default the file's. Raises ConfigError."""
        given: Json = {name: self.teleop[name] for name in SLAVE_FIELDS if name in self.teleop}
        given.setdefault("admittance_m_Ns", 0.05)
        self._check_damping({**given, **changes}["admittance_m_Ns"])
        return csa.SlaveMlcConfig(
            motion=self.slave_model.motion(),
            period_s=self.period_s if period_s is None else period_s,
            arm_lag_s=2.0 / self.slave.get("frequency_rad_s", 150.0),
            sensor_lag_s=self.latency_s,
            **{**given, **changes},
        )

    def _check_damping(self, admittance_m_Ns: float) -> None:
        """Small gain: tissue with a damper b turns speed into force, and K_g force into speed, whatever the delay."""
        damping = self.teleop.get("damping_max_N_s_m", 0.0)
        if admittance_m_Ns * damping > DAMPING_MARGIN:
            raise ConfigError(
                f"admittance_m_Ns = {admittance_m_Ns:g}: times damping_max_N_s_m = {damping:g} must be at most "
                f"{DAMPING_MARGIN}: admittance_m_Ns at most {DAMPING_MARGIN / damping:.3g}"
            )

    def compliance_config(self, **changes: float) -> csa.ComplianceConfig:
        """A wall along z of the model's surface. changes: stiffness_N_m, damping_N_s_m. Raises ConfigError."""
        stiffness = changes.get("stiffness_N_m", self.teleop_config().stiffness_N_m)
        damping = changes.get("damping_N_s_m", self.teleop.get("damping_N_s_m", 1.0))
        wall = csa.ComplianceGains(stiffness_N_m=[0.0, 0.0, stiffness], damping_N_s_m=[0.0, 0.0, damping])
        return csa.ComplianceConfig(negative=wall)

    def border_config(self, **changes: float) -> csa.BorderWrenchConfig:
        """Fixtures are felt as hard as the model. changes: stiffness_N_m, damping_N_s_m. Raises ConfigError."""
        config = self.teleop_config()
        stiffness = changes.get("stiffness_N_m", config.stiffness_N_m)
        damping = changes.get("damping_N_s_m", self.teleop.get("damping_N_s_m", 1.0))
        return csa.BorderWrenchConfig(
            stiffness_N_m=stiffness, damping_N_s_m=damping, force_limit_N=config.force_limit_N
        )

    def palpation(self) -> csa.Palpation:
        """What is superimposed at the start."""
        given = self.teleop.get("palpation", {"kind": "none"})
        return csa.Palpation(
            kind=getattr(csa.PalpationKind, given["kind"].upper()),
            amplitude=given.get("amplitude", 0.0),
            frequency_hz=given.get("frequency_hz", 1.0),
        )

    def start(self) -> Array:
        """(3,) where the tip of a simulated slave starts [m]."""
        return np.array(self.slave_model.forward(self.slave_model.home)[:3, 3])

    def fixtures(self, region: ArrayLike | None = None) -> list[csa.Fixture]:
        """Those of the file and of the arm, and a picked region (n, 3) [m]. Raises ConfigError."""
        made = list(self.slave_model.fixtures)
        for index, given in enumerate(self.teleop.get("fixtures", [])):
            try:
                made.append(fixture(given, self.start(), self.path.parent))
            except ConfigError as error:
                raise ConfigError(f"fixtures[{index}]: {error}") from error
        if region is not None:
            points = np.asarray(region, dtype=float)
            normal = self.surface().touch(points.mean(axis=0)).normal
            faces = csa.region_of_interest(points, normal if np.linalg.norm(normal) > 0.5 else None)
            made.append(csa.Fixture.hull("region_of_interest", faces))
        return made

    def phantom(self) -> Json:
        """As it stands in the file; empty when there is none."""
        found: Json = self.teleop.get("phantom", {})
        return found

    def tissue_config(self) -> sim.TissueConfig:
        """The simulated phantom, its surface under the slave's start. Raises ConfigError."""
        phantom = self.phantom()
        names = ("stiffness_N_m", "inclusion_stiffness_N_m", "force_noise_N", "seed")
        tissue = {name: phantom[name] for name in names if name in phantom}
        if "inclusion_m" in phantom:
            tissue["inclusion_x_m"], tissue["inclusion_y_m"] = phantom["inclusion_m"]
        surface = np.eye(4)
        surface[:3, 3] = self.start() - phantom.get("height_m", PHANTOM_HEIGHT_M) * UP
        return sim.TissueConfig(base_T_surface=surface, **tissue)

    def surface(self) -> Surface:
        """What the proxy meets. Raises ConfigError."""
        model = self.teleop.get("model")
        if model is None:
            phantom = self.phantom()
            height = phantom.get("height_m", PHANTOM_HEIGHT_M) - phantom.get("model_error_m", 0.0)
            return PlaneSurface(self.start() - height * UP, UP)
        if model["type"] == "plane":
            return PlaneSurface(model["point_m"], model["normal"])
        return MeshSurface(*load_mesh(self.path.parent / model["file"], model.get("xyz_m"), model.get("rpy_rad")))

    def check(self) -> None:
        """Builds everything once. Raises ConfigError for what only the controllers know."""
        csa.CsaTeleop(self.teleop_config())
        csa.SlaveMlc(self.slave_config())
        csa.ComplianceWrench(self.compliance_config())
        csa.FixtureSet(self.fixtures())
        self.palpation(), self.surface()
        if "phantom" in self.teleop:
            self.tissue_config()
        elif "model" not in self.teleop:
            raise ConfigError("model: is needed where there is no phantom")
