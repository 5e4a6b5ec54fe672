"""The published experiment, simulated: a hand moves a PSM sideways over a phantom while the system palpates it.

Master hand, contact states, slave controller, proxy slave, compliance wrench and fixtures are those of saras.csa; hand
and tissue are those of saras.sim. Everything in the PSM's base frame, one controller's tick a sample.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from saras import csa, sim
from saras.kinematics import dvrk

Array = NDArray[np.float64]

UP = np.array([0.0, 0.0, 1.0])
HOME = np.array([0.1, -0.1, 0.15, 0.2, 0.1, -0.1])
"""(6,) joints of the PSM at the start."""


@dataclass
class CsaExperiment:
    """What is simulated. Lengths at the slave unless said otherwise."""

    duration_s: float = 12.0
    dt_s: float = 0.001
    arm_frequency_rad_s: float = 150.0
    """Of the simulated arm, critically damped."""
    height_m: float = 0.008
    """Tip above the phantom at the start."""
    press_m: float = 0.006
    """How far below the surface of the model the hand takes the proxy."""
    sweep_m: float = 0.015
    """Sideways to both sides."""
    sweep_s: float = 6.0
    """Of one sweep to both sides and back."""
    model_error_m: float = 0.001
    """The model's surface lies this much above the phantom's."""
    tissue: sim.TissueConfig = field(default_factory=sim.TissueConfig)
    """Its surface is put height_m below the tip, with its own axes."""
    hand: sim.OperatorConfig = field(default_factory=sim.OperatorConfig.firm)
    teleop: csa.CsaTeleopConfig = field(default_factory=csa.CsaTeleopConfig)
    palpation: csa.Palpation = field(
        default_factory=lambda: csa.Palpation(kind=csa.PalpationKind.FORCE, amplitude=0.5, frequency_hz=1.0)
    )
    admittance_m_Ns: float = 0.05
    stiffness_known: bool = True
    """The controller has the tissue's stiffness, as from a model; else it takes the largest."""
    region_m: float | None = 0.010
    """Half width of the square in which a hull fixture keeps the tip; None: no fixture."""


@dataclass
class CsaResult:
    """Arrays over time, one row a tick."""

    t: Array
    state: NDArray[np.int64]
    """ContactState."""
    reason: NDArray[np.int64]
    """MotionReason."""
    normal_force_N: Array
    """Of the tip on the tissue, true."""
    desired_force_N: Array
    """With palpation; NaN where force is not controlled."""
    hand_force_N: Array
    """(n, 3) on the hand."""
    tip: Array
    """(n, 3) from the start [m]."""
    proxy: Array
    """(n, 3) from the start [m]."""
    mismatch_m: Array
    fixture_m: Array
    """Distance to the border of the region; negative: violated; NaN: no fixture."""
    stiffness_N_m: Array
    """Of the tissue under the tip."""
    joint_speed_share: Array
    """Largest |rate| / limit of the joints' set-points."""

    def tracked(self) -> NDArray[np.bool_]:
        """Where the force is controlled and has had half a second to settle."""
        full = self.state == int(csa.ContactState.FULL_CONTACT)
        since = np.zeros(len(full))
        dt = self.t[1] - self.t[0]
        for i in range(1, len(full)):
            since[i] = since[i - 1] + dt if full[i] else 0.0
        return since > 0.5

    def force_rms_N(self) -> float:
        """Of the error against the mean desired force, palpation included in both. NaN: never in contact."""
        at = self.tracked()
        if not at.any():
            return float("nan")
        return float(np.sqrt(np.mean((self.normal_force_N[at] - self.desired_force_N[at]) ** 2)))


def _slave_config(experiment: CsaExperiment, limits: Array) -> csa.SlaveMlcConfig:
    motion = csa.ConstrainedMotionConfig(
        lower=limits[:, 0],
        upper=limits[:, 1],
        speed=[1.0, 1.0, 0.2, 3.0, 3.0, 3.0],
        lead=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5],
    )
    return csa.SlaveMlcConfig(
        motion=motion,
        period_s=experiment.dt_s,
        arm_lag_s=2.0 / experiment.arm_frequency_rad_s,
        sensor_lag_s=0.002,
        admittance_m_Ns=experiment.admittance_m_Ns,
    )


def _intended(experiment: CsaExperiment, t: float) -> Array:
    """(3,) where the hand wants the slave's tip, from the start [m]: down, sideways, up at the end."""
    down = experiment.height_m + experiment.press_m
    ease = 0.5 - 0.5 * np.cos(np.pi * np.clip(t / 2.0, 0.0, 1.0))
    leave = 0.5 - 0.5 * np.cos(np.pi * np.clip((t - experiment.duration_s + 1.5) / 1.5, 0.0, 1.0))
    side = experiment.sweep_m * np.sin(2.0 * np.pi * max(0.0, t - 3.0) / experiment.sweep_s)
    return np.array([side, 0.0, -down * ease * (1.0 - leave)])


class SimulatedJoints:
    """Joints that follow their set-points as critically damped second-order systems, exact for a held set-point."""

    def __init__(self, q: Array, frequency_rad_s: float) -> None:
        self.measured, self.rate, self.frequency = np.array(q), np.zeros(len(q)), frequency_rad_s

    def advance(self, q: Array, dt: float) -> None:
        """Follows q (n,) for dt [s]."""
        error, decay = self.measured - q, np.exp(-self.frequency * dt)
        slope = self.rate + self.frequency * error
        self.measured = q + (error + slope * dt) * decay
        self.rate = (slope - self.frequency * (error + slope * dt)) * decay


def simulate(experiment: CsaExperiment | None = None) -> CsaResult:
    """Runs the experiment. Raises ConfigError for what the controllers refuse."""
    e = experiment or CsaExperiment()
    psm = dvrk.psm()
    config = _slave_config(e, np.asarray(psm.limits))
    q, q_proxy = np.array(HOME), np.array(HOME)
    arm = SimulatedJoints(q, e.arm_frequency_rad_s)
    start = psm.forward(q)[:3, 3].copy()
    surface = np.eye(4)
    surface[:3, 3] = start - e.height_m * UP
    tissue_config = e.tissue.__copy__()
    tissue_config.base_T_surface = surface
    tissue = sim.Tissue(tissue_config)
    model_height = surface[2, 3] + e.model_error_m
    teleop, slave = csa.CsaTeleop(e.teleop), csa.SlaveMlc(config)
    proxy = csa.ProxySlave(config.motion)
    wall = csa.ComplianceGains(stiffness_N_m=[0.0, 0.0, e.teleop.stiffness_N_m], damping_N_s_m=[0.0, 0.0, 1.0])
    compliance = csa.ComplianceWrench(csa.ComplianceConfig(negative=wall))
    border = csa.BorderWrench(csa.BorderWrenchConfig(stiffness_N_m=e.teleop.stiffness_N_m))
    fixtures = felt_fixtures = None
    if e.region_m is not None:
        corners = [start + e.region_m * np.array([x, y, 0.0]) for x in (-1, 1) for y in (-1, 1)]
        region = csa.Fixture.hull("region", csa.region_of_interest(corners, UP))
        fixtures, felt_fixtures = csa.FixtureSet([region]), csa.FixtureSet([region])
    hand = sim.Operator(e.hand)
    handle, hand_force = np.eye(4), np.zeros(3)
    last_tip, last_proxy = start.copy(), start.copy()
    rows: list[tuple[object, ...]] = []
    for i in range(round(e.duration_s / e.dt_s)):
        t = i * e.dt_s
        handle[:3, 3] = hand.step(hand_force, _intended(e, t) / e.teleop.scale, e.dt_s).position
        tip = psm.forward(arm.measured)[:3, 3]
        felt = tissue.step(tip, (tip - last_tip) / e.dt_s, e.dt_s)
        pose, proxy_pose = psm.forward(q), psm.forward(q_proxy)
        frame = np.eye(4)
        frame[:3, 3] = [proxy_pose[0, 3], proxy_pose[1, 3], model_height]
        velocity = np.r_[(proxy_pose[:3, 3] - last_proxy) / e.dt_s, 0.0, 0.0, 0.0]
        wrench = compliance.step(proxy_pose, velocity, frame, e.dt_s).wrench
        proxy_found = felt_fixtures.step(proxy_pose, e.dt_s) if felt_fixtures else None
        told = teleop.step(
            handle,
            pose,
            proxy_pose,
            e.dt_s,
            float(np.linalg.norm(felt.measured_wrench[:3])),
            model_height - proxy_pose[2, 3],
            UP,
            wrench,
            fixture_wrench=border.step(proxy_found, velocity[:3], e.dt_s).wrench,
        )
        last_tip, last_proxy = tip, proxy_pose[:3, 3].copy()
        if told.synchronise:
            q_proxy = q.copy()
            last_proxy = psm.forward(q)[:3, 3].copy()
        found = fixtures.step(pose, e.dt_s, shaft=psm.shaft(q)) if fixtures else None
        moved = slave.step(
            q,
            psm.jacobian(q),
            pose,
            told.desired,
            e.dt_s,
            tissue_wrench=felt.measured_wrench,
            mode=told.mode,
            desired_force_N=told.desired_force_N,
            normal=told.normal,
            stiffness_N_m=felt.stiffness if e.stiffness_known else float("nan"),
            palpation=e.palpation if told.state == csa.ContactState.FULL_CONTACT else csa.Palpation(),
            q_measured=arm.measured,
            fixtures=found,
        )
        if told.hold:
            moved.motion.q = q
        q = np.array(moved.motion.q)
        q_proxy = np.array(proxy.step(q_proxy, psm.jacobian(q_proxy), psm.forward(q_proxy), told.desired, e.dt_s).q)
        arm.advance(q, e.dt_s)
        hand_force = np.array(told.wrench[:3])
        full = told.state == csa.ContactState.FULL_CONTACT
        rows.append(
            (
                t,
                int(told.state),
                int(moved.motion.reason),
                float(-felt.wrench[2]),
                moved.desired_force_N if full else np.nan,
                hand_force,
                tip - start,
                proxy_pose[:3, 3] - start,
                told.mismatch_m,
                found.distance_m[0] if found else np.nan,
                felt.stiffness,
                float((np.abs(moved.motion.rates) / config.motion.speed).max()),
            )
        )
    columns = [np.array(column) for column in zip(*rows)]
    return CsaResult(*columns)
