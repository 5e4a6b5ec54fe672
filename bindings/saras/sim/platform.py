"""The platform's graph in one process: the same laws as the nodes, stepped in their order."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras import displacement
from saras._core.csa import FixtureForce, FixtureIntegrator
from saras.sim.arm_side import ArmSide
from saras.sim.console import DownMessage, UpMessage
from saras.sim.exchange import ExchangeMessage, TankNode
from saras.sim.experiment import Experiment, Side
from saras.sim.link import Link
from saras.teleop import DisturbanceObserver, DisturbanceObserverConfig, FrameMapping, Transparency

Array = npt.NDArray[np.float64]

BRIDGED_TICKS = 2
"""Graph ticks without a pose over which the last command is kept; then it is zero."""


def servo_model(side: Side) -> DisturbanceObserverConfig:
    """Of the arm, where all joints are alike; else of its first joint."""
    return DisturbanceObserverConfig(
        natural_frequency_rad_s=float(side.arm.natural_frequency_rad_s[0]),
        damping_ratio=float(side.arm.damping_ratio[0]),
        mass_kg=side.arm.effective_mass_kg,
    )


class PlatformSide:
    """What the platform keeps for one side: frame mapping, transparency, velocity integrator."""

    def __init__(self, side: Side, experiment: Experiment, arm: ArmSide) -> None:
        """Start from the arm's measured pose."""
        self.arm = arm
        self.mapping = FrameMapping(experiment.mapping)
        self.transparency = Transparency(experiment.transparency)
        self.integrator = FixtureIntegrator(experiment.integrator, list(side.fixtures))
        self.fixtures = FixtureForce(experiment.fixture_force, list(side.fixtures))
        self._observer = None if side.slave_wrench == "truth" else DisturbanceObserver(servo_model(side))
        self.wrench_known = True
        self._timeout_s = experiment.console_timeout_s
        self._unseen = 0
        self._newest_up = -1
        self._heard_at = -np.inf
        self._message: UpMessage | None = None
        self._since_mapped_s = 0.0
        self._tip = arm.measured_base_T_tip
        self.tracked: Array = np.full((4, 4), np.nan)
        self.hand_wrench: Array = np.zeros(6)
        self.touch_wrench: Array = np.zeros(6)
        self.desired_wrench: Array = np.zeros(6)
        self.desired_twist: Array = np.zeros(6)
        self.slave_wrench: Array = np.zeros(6)
        self.slave_twist: Array = np.zeros(6)
        self._hand_ahead: Array = np.zeros(3)
        self.set_point: Array = arm.measured_base_T_tip

    def receive(self, message: UpMessage, now: float) -> None:
        """Newest wins."""
        if message.seq > self._newest_up:
            self._newest_up = message.seq
            self._heard_at = now
            self._message = message

    def measure(self, dt: float) -> float:
        """Read the arm; returns the work that its tip did on the tissue: mean wrench . measured displacement [J]."""
        moved = displacement(self._tip, self.arm.measured_base_T_tip)
        self._tip = self.arm.measured_base_T_tip
        self.slave_twist = moved / dt
        self.slave_wrench = self.arm.take_mean_wrench()
        if self._observer is not None:
            observed = self._observer.step(self.set_point[:3, 3], self._tip[:3, 3], dt)
            self.wrench_known = observed.has_wrench
            self.slave_wrench = observed.wrench
        return float(self.slave_wrench @ moved)

    def command(self, dt: float, now: float) -> None:
        """Frame mapping and transparency, on a new pose; without one the last command is bridged, then zero."""
        self._since_mapped_s += dt
        guidance = self.fixtures.step(self._tip, dt, hand_ahead=self._hand_ahead).wrench
        message, self._message = self._message, None
        stale = now - self._heard_at > self._timeout_s
        if message is None and not stale:
            self._unseen += 1
            if self._unseen > BRIDGED_TICKS:
                self.desired_twist = np.zeros(6)
            return
        self._unseen = 0
        interval, self._since_mapped_s = self._since_mapped_s, 0.0
        if message is None:
            self.mapping.step(np.eye(4), interval, stale=True)
            out = self.transparency.step(
                np.eye(4),
                np.zeros(6),
                self._tip,
                self.slave_twist,
                self.slave_wrench,
                self.arm.rcm,
                interval,
                stale=True,
                guidance_wrench=guidance,
            )
        else:
            mapped = self.mapping.step(
                message.simball_T_handle, interval, clutch=message.clutch, base_wrench=self.hand_wrench
            )
            if mapped.has_pose:
                self.tracked = mapped.tracked_pose
            self.touch_wrench = mapped.touch_wrench
            out = self.transparency.step(
                mapped.tracked_pose,
                mapped.tracked_twist,
                self._tip,
                self.slave_twist,
                self.slave_wrench,
                self.arm.rcm,
                interval,
                clutch=message.clutch,
                stale=not mapped.has_pose,
                master_twist_filtered=mapped.tracked_twist_filtered,
                guidance_wrench=guidance,
            )
        self.desired_wrench, self.desired_twist = out.desired_wrench, out.desired_twist
        self._hand_ahead = -out.error[:3]

    def move(self, twist: Array, dt: float) -> None:
        """Integrate the twist that passivity let through and send the set-point to the arm."""
        out = self.integrator.step(twist, self._tip, self.arm.rcm, dt)
        self.set_point = out.set_point
        self.arm.follow(out.set_point)


class Platform:
    """All sides, the two shared tanks and the link between them."""

    def __init__(
        self,
        experiment: Experiment,
        arms: list[ArmSide],
        exchange_links: tuple[Link[ExchangeMessage], Link[ExchangeMessage]],
    ) -> None:
        """exchange_links: tank_master to tank_slave, and back."""
        n = len(arms)
        self.sides = [PlatformSide(s, experiment, arm) for s, arm in zip(experiment.sides, arms)]
        # Peers of the store: the guard of each side, then tank_slave.
        self.master = TankNode(experiment.master_tank, n, n + 1, experiment.exchange_timeout_s)
        self.slave = TankNode(experiment.slave_tank, n, 1, experiment.exchange_timeout_s)
        self._to_slave, self._to_master = exchange_links
        self._use_tanks = experiment.tanks
        self._adversary = experiment.adversary
        self._random = np.random.default_rng(experiment.seed + 1)
        self._zeros = np.zeros((n, 6))
        self._force_limit = experiment.master_tank.applied_limit
        self._seq = 0

    def receive(self, side: int, message: UpMessage, now: float) -> None:
        """Read a datagram of a console."""
        self.master.peers[side].receive(message.exchange, now)
        self.sides[side].receive(message, now)

    def tick(self, dt: float, now: float) -> list[DownMessage]:
        """One graph tick; returns the datagrams for the consoles."""
        for message in self._to_slave.receive(now + 1e-9):
            self.slave.peers[0].receive(message, now)
        for message in self._to_master.receive(now + 1e-9):
            self.master.peers[-1].receive(message, now)

        work_J = sum(side.measure(dt) for side in self.sides)
        for side in self.sides:
            side.command(dt, now)
        wrenches = np.stack([side.desired_wrench for side in self.sides])
        twists = np.stack([self._provoked(side) for side in self.sides])
        if self._use_tanks:
            # The store bills no port: its conjugate is zero and no work leaves through it.
            wrenches = self.master.step(wrenches, self._zeros, dt, now, work_J=0.0).applied
            twists = self.slave.step(
                twists,
                np.stack([side.slave_wrench for side in self.sides]),
                dt,
                now,
                work_J=work_J,
                measured=np.stack([side.slave_twist for side in self.sides]),
                stale=not all(side.wrench_known for side in self.sides),
            ).applied
        for side, wrench, twist in zip(self.sides, wrenches, twists):
            side.hand_wrench = wrench
            side.move(twist, dt)

        to_consoles = self.master.messages()
        self._to_slave.send(to_consoles.pop(), now)
        self._to_master.send(self.slave.messages()[0], now)
        self._seq += 1
        return [DownMessage(self._seq, side.touch_wrench, m) for side, m in zip(self.sides, to_consoles)]

    def _provoked(self, side: PlatformSide) -> Array:
        if self._adversary is None:
            return side.desired_twist
        twist: Array = side.desired_twist + self._adversary.tip_gain_m_N_s * side.slave_wrench
        twist[:3] += self._adversary.noise_m_s * self._random.standard_normal(3)
        return twist
