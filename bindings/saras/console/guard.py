"""A port guard and what it hears and says: the law (``saras._core.console.PortGuard``) with its two ledgers.

The guard trades joules with tank_master over the ledgers of both datagrams. Wrenches and twists are in the touch frame
at the handle's origin, poses in simball_base.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from saras import ConfigError, Status
from saras._core.console import PortGuard, PortGuardConfig
from saras.console.arrays import Array
from saras.net import ChannelState, GuardState, PortLedger, TouchballDownSide
from saras.teleop import LedgerReceiver, LedgerSender


@dataclass
class GuardConfig:
    """Parameters of one guarded port."""

    law: PortGuardConfig = field(default_factory=PortGuardConfig)
    link_timeout_s: float = 0.060  #: a down-link whose newest datagram is older gives no force [s]

    def __post_init__(self) -> None:
        if not math.isfinite(self.link_timeout_s) or self.link_timeout_s <= 0.0:
            raise ConfigError(f"link_timeout_s = {self.link_timeout_s}: must be finite and > 0")


class GuardedPort:
    """One handle's guard. ``receive`` for each new datagram, ``tick`` at device rate, ``ledger`` for each sent one.

    A restarted guard begins at the minimum level. The starting charge is granted once for each engagement number that
    appears while this guard watches: an engagement that was running before the guard (or the platform's sender)
    started is not new.
    """

    def __init__(self, config: GuardConfig, session: int) -> None:
        self.config = config
        self.law = PortGuard(config.law)
        self.state = ChannelState.WAITING
        self.engagement: int | None = None
        self._sender = LedgerSender(session)
        self._receiver = LedgerReceiver()
        self._credit_J = 0.0
        self._engaged = self._peer_requests = self._peer_has_room = False
        self._down_session: int | None = None
        self._wrench = np.zeros(6)
        self._output = self.law.step(None, 0.0, self._wrench, 1e-3, False)
        self._tank = self._output.tank
        self._applied: Array = self._output.applied

    def receive(self, down: TouchballDownSide, down_session: int) -> None:
        """Takes over one side of a newer datagram."""
        ledger = down.ledger
        self._credit_J += self._receiver.credit(ledger.session, ledger.seq, ledger.sent_J)
        self._peer_requests, self._peer_has_room = ledger.requesting, ledger.has_room
        self._wrench = down.touch_wrench
        self.state = down.state
        self._engaged = down.state == ChannelState.ENGAGED
        if self._down_session != down_session:
            self._down_session, self.engagement = down_session, down.engagement
        elif self.engagement is None or down.engagement > self.engagement:
            self.engagement = down.engagement
            self.law.grant()

    def tick(self, simball_T_handle: Array | None, work_J: float, dt: float, link_fresh: bool) -> Array:
        """One device tick; returns the (6,) wrench to apply, touch frame.

        simball_T_handle: (4, 4) calibrated pose, None when there is no valid reading; work_J: the device's cumulative
        work on the hand [J]; dt: monotonic time since the last tick [s]; link_fresh: the down-link is younger than
        link_timeout_s.
        """
        credit, self._credit_J = self._credit_J, 0.0
        output = self._output = self.law.step(
            simball_T_handle,
            work_J,
            self._wrench,
            dt,
            link_fresh and self._engaged,
            credit,
            link_fresh and self._peer_requests,
            link_fresh and self._peer_has_room,
        )
        tank = self._tank = output.tank
        sent_J = tank.sent_J
        if sent_J > 0.0:
            self._sender.send(sent_J)
        self._applied = output.applied
        return self._applied

    @property
    def force_N(self) -> float:
        """Size of the force that is applied [N]."""
        return math.hypot(*self._applied[:3])

    @property
    def ramp(self) -> float:
        """Share of the platform's wrench that passes to the tank, 0 to 1."""
        return float(self.law.state.ramp)

    @property
    def status(self) -> Status:
        """Status of the last tick."""
        return self._output.status

    @property
    def energy_J(self) -> float:
        """Level of the tank [J]."""
        return float(self._tank.energy_J)

    @property
    def reduction(self) -> float:
        """K_E in [0, 1]."""
        return float(self._tank.reduction)

    def ledger(self) -> PortLedger:
        """The next ledger message for tank_master."""
        session, seq, sent_J = self._sender.next()
        tank = self._tank
        return PortLedger(session=session, seq=seq, sent_J=sent_J, requesting=tank.requesting, has_room=tank.has_room)

    def snapshot(self) -> GuardState:
        """The tank as displayed and recorded by the platform."""
        tank, state, levels = self._tank, self.law.state.tank, self.config.law.tank
        return GuardState(
            energy_J=tank.energy_J,
            minimum_J=levels.minimum_J,
            request_J=levels.request_J,
            available_J=levels.available_J,
            maximum_J=levels.maximum_J,
            reduction=tank.reduction,
            scale=tank.scale,
            damping=tank.damping,
            work_out_J=state.work_out_J,
            received_J=state.received_J,
            vented_J=state.vented_J,
            granted_J=state.granted_J,
            status=tank.status,
        )
