"""The simulated console of one side: hand, handle, port guard at device rate."""

from __future__ import annotations

import copy
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from saras._core.sim import Operator, OperatorState
from saras.kinematics import SimballHandle
from saras.sim.exchange import ExchangeMessage, TankNode
from saras.sim.experiment import Experiment, Side

Array = npt.NDArray[np.float64]

FORCE_RAMP_S = 0.1
"""In this time the force returns after an outage."""


class UpMessage(NamedTuple):
    """Console to platform."""

    seq: int
    simball_T_handle: Array
    clutch: bool
    exchange: ExchangeMessage


class DownMessage(NamedTuple):
    """Platform to console."""

    seq: int
    touch_wrench: Array
    exchange: ExchangeMessage


class Console:
    """A hand around its intended motion, the handle it holds, and the guard that owns the handle's motors."""

    def __init__(self, side: Side, experiment: Experiment, t: Array, dt: Array) -> None:
        """Take the device's ticks t (n,) and dt (n,) [s], for which the intended motion is sampled."""
        self._start = np.array(side.handle_start_m)
        displacement, self._roll = side.motion.sample(t)
        self.intended: Array = displacement + self._start
        self._intended_velocity = np.gradient(self.intended, t, axis=0)
        config = copy.copy(side.operator)
        config.workspace_centre_m = self._start
        self.operator = Operator(config)
        self.operator.reset(OperatorState(position=self._start, roll=float(self._roll[0])))
        self.guard = TankNode(experiment.guard_tank, 1, 1, experiment.exchange_timeout_s)
        self._use_guard = experiment.tanks
        self._timeout_s = experiment.console_timeout_s
        self._handle = SimballHandle()
        self._touch_R_console = experiment.mapping.touch_T_console[:3, :3]
        adversary = experiment.adversary
        self._adversary = adversary if adversary and (adversary.handle_gain_N_s_m or adversary.noise_N) else None
        self._random = np.random.default_rng(experiment.seed)
        self._limit = experiment.guard_tank.applied_limit
        self._seq = 0
        self._newest_down = -1
        self._wrench = np.zeros(6)
        self._heard_at = -np.inf
        self._ramp = 0.0
        self._conjugate = np.zeros((1, 6))
        self._desired = np.zeros((1, 6))
        self.applied: Array = np.zeros(6)
        self.position: Array = self._start.copy()
        self.roll = 0.0
        self.delivered_J = 0.0
        self._pose: Array = np.eye(4)

    def receive(self, message: DownMessage, now: float) -> None:
        """Read a datagram: newest wins, the ledger sees them all."""
        self.guard.peers[0].receive(message.exchange, now)
        if message.seq > self._newest_down:
            self._newest_down = message.seq
            self._wrench = message.touch_wrench
            self._heard_at = now

    def tick(self, k: int, now: float, dt: float) -> None:
        """One device tick: the hand moved under the force of the last one; the guard bills that and gives the next."""
        force = self.applied[:3] @ self._touch_R_console  # touch axes to console axes
        hand = self.operator.step(force, self.intended[k], dt, self._intended_velocity[k], 0.0, self._roll[k])
        moved = hand.position - self.position
        self.position = hand.position
        self.roll = hand.roll
        self._conjugate[0, :3] = self._touch_R_console @ moved / dt
        self.delivered_J += float(force @ moved)

        if now - self._heard_at > self._timeout_s:
            self._ramp = 0.0
        else:
            self._ramp = min(1.0, self._ramp + dt / FORCE_RAMP_S)
        self._desired[0] = self._ramp * self._wrench
        if self._adversary is not None:
            self._desired[0] += self._adversary.handle_gain_N_s_m * self._conjugate[0]
            self._desired[0, :3] += self._adversary.noise_N * self._random.standard_normal(3)
        if self._use_guard:
            self.applied = self.guard.step(self._desired, self._conjugate, dt, now).applied[0]
        else:
            self.applied = np.clip(self._desired[0], -self._limit, self._limit)

    def restart(self) -> None:
        """Kill the console's process and start it again: its device zeroes the motors, a new session begins."""
        self.guard.restart()
        self.applied = np.zeros(6)
        self._wrench = np.zeros(6)
        self._heard_at = -np.inf
        self._ramp = 0.0

    @property
    def desired(self) -> Array:
        """(6,) what the guard was asked for in the last tick."""
        desired: Array = self._desired[0]
        return desired

    def pose(self) -> Array:
        """simball_T_handle (4, 4); the last one while the hand is not above the pivot."""
        joints = self._handle.inverse_position(self.position, self.roll)
        if joints is not None:
            self._pose = self._handle.forward(joints)
        return self._pose

    def message(self, clutch: bool) -> UpMessage:
        """Give the next datagram."""
        self._seq += 1
        return UpMessage(self._seq, self.pose(), clutch, self.guard.messages()[0])
