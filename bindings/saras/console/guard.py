"""Port guard: the passivity layer where the handle is.

Between tank_master and the handle lies a network, so energy is billed here, against the encoders, at device rate.
The guard trades joules with tank_master over the ledgers of both datagrams. See SPEC of the platform, energy tank.

Frames: wrenches and twists are in the touch frame at the handle's origin; poses are in simball_base.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

import saras
from saras import ConfigError, Status
from saras.console.arrays import Array
from saras.console.simball import TOUCH_R_SIMBALL
from saras.net import ChannelState, GuardState, PortLedger, TouchballDownSide
from saras.teleop import EnergyTank, EnergyTankConfig, LedgerReceiver, LedgerSender


def default_tank() -> EnergyTankConfig:
    """Levels for one handle; rotation has no motor, so its rate is not part of any budget."""
    return EnergyTankConfig(conjugate_rate=[20.0, 20.0, 20.0, 1e4, 1e4, 1e4])


@dataclass
class GuardConfig:
    """Parameters of one port guard."""

    tank: EnergyTankConfig = field(default_factory=default_tank)
    link_timeout_s: float = 0.060  #: a down-link whose newest datagram is older gives no force [s]
    force_ramp_s: float = 0.100  #: from full force to none (and back) [s]
    touch_R_simball: Array = field(default_factory=TOUCH_R_SIMBALL.copy)  #: (3, 3)

    def __post_init__(self) -> None:
        for name in ("link_timeout_s", "force_ramp_s"):
            value = getattr(self, name)
            if not math.isfinite(value) or value <= 0.0:
                raise ConfigError(f"{name} = {value}: must be finite and > 0")
        rotation = np.asarray(self.touch_R_simball, dtype=float)
        if rotation.shape != (3, 3) or not np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6):
            raise ConfigError(f"touch_R_simball = {rotation.tolist()}: must be a (3, 3) rotation")
        self.touch_R_simball = rotation


class PortGuard:
    """One handle's guard. ``receive`` for each new datagram, ``tick`` at device rate, ``ledger`` for each sent one.

    A restarted guard begins at the minimum level. The starting charge is granted once for each engagement number that
    appears while this guard watches: an engagement that was running before the guard (or the platform's sender)
    started is not new.
    """

    def __init__(self, config: GuardConfig, session: int) -> None:
        self.config = config
        self.tank = EnergyTank(config.tank, 1)
        self.tank.reset()
        self.state = ChannelState.WAITING
        self.engagement: int | None = None
        self.ramp = 0.0
        self._sender = LedgerSender(session)
        self._receiver = LedgerReceiver()
        self._credit_J = 0.0
        self._peer_requests = False
        self._peer_has_room = False
        self._down_session: int | None = None
        self._wrench = np.zeros(6)
        self._desired = np.zeros((1, 6))
        self._conjugate = np.zeros((1, 6))
        self._rotate = np.kron(np.eye(2), config.touch_R_simball)  # (6, 6): linear and angular part
        self._previous: Array | None = None
        self._billed_J = 0.0
        self._output = self.tank.step(self._desired, self._conjugate, 1e-3, stale=True)

    def receive(self, down: TouchballDownSide, down_session: int) -> None:
        """Takes over one side of a newer datagram."""
        ledger = down.ledger
        self._credit_J += self._receiver.credit(ledger.session, ledger.seq, ledger.sent_J)
        self._peer_requests, self._peer_has_room = ledger.requesting, ledger.has_room
        self._wrench = down.touch_wrench
        self.state = down.state
        if self._down_session != down_session:
            self._down_session, self.engagement = down_session, down.engagement
        elif self.engagement is None or down.engagement > self.engagement:
            self.engagement = down.engagement
            self.tank.grant(max(0.0, self.config.tank.initial_J - self.tank.state.energy_J))

    def tick(self, simball_T_handle: Array | None, work_J: float, dt: float, link_fresh: bool) -> Array:
        """One device tick.

        simball_T_handle: (4, 4) calibrated pose, None when there is no valid reading; work_J: the device's cumulative
        work on the hand [J]; dt: monotonic time since the last tick [s]; link_fresh: the down-link is younger than
        link_timeout_s. Returns the (6,) wrench to apply, touch frame.
        """
        towards = 1.0 if link_fresh and self.state == ChannelState.ENGAGED else 0.0
        step = dt / self.config.force_ramp_s
        self.ramp = min(self.ramp + step, towards) if towards > self.ramp else max(self.ramp - step, towards)
        np.multiply(self._wrench, self.ramp, out=self._desired[0])
        self._measure_twist(simball_T_handle, dt)
        credit, self._credit_J = self._credit_J, 0.0
        billed, self._billed_J = work_J - self._billed_J, work_J
        output = self.tank.step(
            self._desired,
            self._conjugate,
            dt,
            received_J=credit,
            peer_requests=self._peer_requests and link_fresh,
            peer_has_room=self._peer_has_room and link_fresh,
            work_J=billed,
            stale=simball_T_handle is None,
        )
        self._sender.send(output.sent_J)
        self._output = output
        applied: Array = output.applied[0]
        return applied

    def _measure_twist(self, pose: Array | None, dt: float) -> None:
        if pose is None or self._previous is None or dt <= 0.0:
            self._conjugate[0] = 0.0
        else:
            np.matmul(self._rotate, saras.displacement(self._previous, pose) / dt, out=self._conjugate[0])
        self._previous = pose

    @property
    def force_N(self) -> float:
        """Size of the force that is applied [N]."""
        return math.hypot(*self._output.applied[0, :3])

    @property
    def status(self) -> Status:
        """Status of the last tick."""
        return self._output.status

    @property
    def energy_J(self) -> float:
        """Level of the tank [J]."""
        return self._output.energy_J

    @property
    def reduction(self) -> float:
        """K_E in [0, 1]."""
        return self._output.reduction

    def ledger(self) -> PortLedger:
        """The next ledger message for tank_master."""
        session, seq, sent_J = self._sender.next()
        output = self._output
        return PortLedger(
            session=session, seq=seq, sent_J=sent_J, requesting=output.requesting, has_room=output.has_room
        )

    def snapshot(self) -> GuardState:
        """The tank as displayed and recorded by the platform."""
        output, state, levels = self._output, self.tank.state, self.config.tank
        return GuardState(
            energy_J=output.energy_J,
            minimum_J=levels.minimum_J,
            request_J=levels.request_J,
            available_J=levels.available_J,
            maximum_J=levels.maximum_J,
            reduction=output.reduction,
            scale=output.scale,
            damping=output.damping,
            work_out_J=state.work_out_J,
            received_J=state.received_J,
            vented_J=state.vented_J,
            granted_J=state.granted_J,
            status=output.status,
        )
