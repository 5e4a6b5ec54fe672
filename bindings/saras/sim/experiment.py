"""Everything that defines a simulated experiment. Defaults are those of the platform (config/)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from saras._core.csa import FixtureForceConfig, TeleopFixture
from saras._core.sim import ChannelConfig, OperatorConfig, ServoArmConfig, TissueConfig
from saras.kinematics import mesa
from saras.sim.motion import Motion, SumOfSines
from saras.teleop import EnergyTankConfig, FrameMappingConfig, TransparencyConfig, VelocityIntegratorConfig


def guard_tank() -> EnergyTankConfig:
    """Port guard at a handle: 1 kHz, a command is kept for 2 ms at most."""
    return EnergyTankConfig()


def master_tank() -> EnergyTankConfig:
    """tank_master as shared store: it reduces by its level, the guards bill the ports and damp."""
    return EnergyTankConfig(damping_min=np.zeros(6), damping_max=np.zeros(6), conjugate_rate=np.zeros(6), dt_max_s=0.05)


def slave_tank() -> EnergyTankConfig:
    """tank_slave: desired is a twist, the damping a yielding compliance [m/(N s)]. Rotation carries no power here."""
    translation = np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    return EnergyTankConfig(
        damping_min=1e-3 * translation,
        damping_max=3e-3 * translation,
        conjugate_rate=400.0 * translation,
        applied_limit=np.array([0.1, 0.1, 0.1, 1.0, 1.0, 1.0]),
        hold_s=0.02,
        dt_max_s=0.05,
    )


def integrator() -> VelocityIntegratorConfig:
    """Set-point bounds; the shaft goes through the trocar."""
    return VelocityIntegratorConfig(shaft_through_rcm=True)


def transparency() -> TransparencyConfig:
    """Position-position; slave_lag_s is that of the simulated arm (2 zeta / omega_n) and one graph period."""
    return TransparencyConfig(slave_lag_s=2.0 / 60.0 + 0.01)


@dataclass(frozen=True)
class Side:
    """One hand, one handle, one arm.

    tissue: None is free space; ``surface_below_m`` puts the tissue's origin that far below the tip's start when its
    ``base_T_surface`` is left at the identity. clutch: intervals [s] in which the pedal is pressed.
    slave_wrench: ``truth`` (a sensor at the tip) or ``observer`` (estimated from the arm's servo model).
    fixtures: virtual walls and guides, in the arm's base.
    """

    operator: OperatorConfig = field(default_factory=OperatorConfig.normal)
    motion: Motion = field(default_factory=SumOfSines)
    tissue: TissueConfig | None = None
    surface_below_m: float = 0.01
    arm: ServoArmConfig = field(default_factory=ServoArmConfig)
    rcm_m: tuple[float, float, float] = (
        float(mesa.NOMINAL_RCM[0]),
        float(mesa.NOMINAL_RCM[1]),
        float(mesa.NOMINAL_RCM[2]),
    )
    handle_start_m: tuple[float, float, float] = (0.0, 0.0, 0.2)
    clutch: tuple[tuple[float, float], ...] = ()
    slave_wrench: str = "truth"
    fixtures: tuple[TeleopFixture, ...] = ()


@dataclass(frozen=True)
class Restart:
    """Kill and restart one tank: ``tank_master``, ``tank_slave`` or ``guard`` (of ``side``) at ``time_s``."""

    time_s: float
    tank: str
    side: int = 0


@dataclass(frozen=True)
class Adversary:
    """Commands that try to pump energy out of the tanks. It replaces nothing: it is added to what transparency wants.

    handle_gain_N_s_m: force along the handle's velocity (negative damping), added at the guard.
    tip_gain_m_N_s: twist along the force on the tissue, added at tank_slave. noise_N, noise_m_s: white noise.
    """

    handle_gain_N_s_m: float = 0.0
    tip_gain_m_N_s: float = 0.0
    noise_N: float = 0.0
    noise_m_s: float = 0.0


@dataclass(frozen=True)
class Experiment:
    """A whole experiment: consoles, network, platform, arms, tissue. See saras.sim.run.

    up, down: the console's link, one way each (each side draws from its own seed). exchange: the link between
    tank_master and tank_slave, each way. guard_jitter: relative jitter of the device's period (0.3 = +-30 %).
    graph_jitter: probability that a graph tick comes one device period late.
    controller: ``laws`` (the separate graph's, one by one) or ``pipeline`` (the real-time host's; ``exchange`` does not
    apply, a restart ends both tanks, all sides take their wrench from the source of the first).
    """

    sides: tuple[Side, ...] = field(default_factory=lambda: (Side(),))
    duration_s: float = 10.0
    seed: int = 1
    guard_rate_hz: float = 1000.0
    graph_rate_hz: float = 100.0
    guard_jitter: float = 0.0
    graph_jitter: float = 0.0
    up: ChannelConfig = field(default_factory=ChannelConfig)
    down: ChannelConfig = field(default_factory=ChannelConfig)
    exchange: ChannelConfig = field(default_factory=ChannelConfig)
    console_timeout_s: float = 0.06
    exchange_timeout_s: float = 0.2
    tanks: bool = True
    guard_tank: EnergyTankConfig = field(default_factory=guard_tank)
    master_tank: EnergyTankConfig = field(default_factory=master_tank)
    slave_tank: EnergyTankConfig = field(default_factory=slave_tank)
    mapping: FrameMappingConfig = field(default_factory=FrameMappingConfig)
    transparency: TransparencyConfig = field(default_factory=transparency)
    integrator: VelocityIntegratorConfig = field(default_factory=integrator)
    fixture_force: FixtureForceConfig = field(default_factory=FixtureForceConfig)
    restarts: tuple[Restart, ...] = ()
    adversary: Adversary | None = None
    controller: str = "laws"

    def __post_init__(self) -> None:
        """Refuse what makes no experiment; the laws' own configurations are validated by the laws."""
        if not 1 <= len(self.sides) <= 8:
            raise ValueError(f"sides = {len(self.sides)}: must be 1 to 8")
        for name in ("duration_s", "guard_rate_hz", "graph_rate_hz", "console_timeout_s", "exchange_timeout_s"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} = {value}: must be positive")
        if self.guard_rate_hz < self.graph_rate_hz:
            raise ValueError(
                f"guard_rate_hz = {self.guard_rate_hz}: must not be below graph_rate_hz = {self.graph_rate_hz}"
            )
        if self.controller not in ("laws", "pipeline"):
            raise ValueError(f"controller = {self.controller!r}: must be laws or pipeline")
        if self.controller == "pipeline":
            self._check_pipeline()
        if not 0.0 <= self.guard_jitter < 1.0:
            raise ValueError(f"guard_jitter = {self.guard_jitter}: must be in [0, 1)")
        for side in self.sides:
            if side.slave_wrench not in ("truth", "observer"):
                raise ValueError(f"slave_wrench = {side.slave_wrench!r}: must be truth or observer")
        for restart in self.restarts:
            if restart.tank not in ("guard", "tank_master", "tank_slave") or not 0 <= restart.side < len(self.sides):
                raise ValueError(
                    f"restart = {restart}: tank must be guard, tank_master or tank_slave, side one of the sides"
                )

    def _check_pipeline(self) -> None:
        if len(self.sides) > 2 or not self.tanks:
            raise ValueError(f"controller = pipeline: has tanks and at most 2 sides, not {len(self.sides)}")
        if self.adversary is not None and (self.adversary.tip_gain_m_N_s or self.adversary.noise_m_s):
            raise ValueError("controller = pipeline: an adversary at the tip has no place in it: must be 0")
