"""A tank with its peers: the law, a ledger to each peer, and who asked for energy."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from saras.teleop import (
    EnergyTank,
    EnergyTankConfig,
    EnergyTankOutput,
    EnergyTankState,
    LedgerReceiver,
    LedgerSender,
)

Array = npt.NDArray[np.float64]


class ExchangeMessage(NamedTuple):
    """What a tank tells a peer: cumulative joules sent to it in this session, and what it wants."""

    session: int
    seq: int
    sent_J: float
    requesting: bool
    has_room: bool


class Peer:
    """One tank's end of the exchange with one peer. A peer that is silent for timeout_s wants nothing."""

    def __init__(self, session: int, timeout_s: float) -> None:
        """Begin a session: larger than all before."""
        self._sender = LedgerSender(session)
        self._receiver = LedgerReceiver()
        self._timeout_s = timeout_s
        self._credit_J = 0.0
        self._newest = (-1, -1)
        self._heard_at = -np.inf
        self._requesting = False
        self._has_room = False

    def send(self, energy_J: float) -> None:
        """Put joules that left the tank on the ledger."""
        self._sender.send(energy_J)

    def message(self, requesting: bool, has_room: bool) -> ExchangeMessage:
        """Give the next message for the wire."""
        return ExchangeMessage(*self._sender.next(), requesting, has_room)

    def receive(self, message: ExchangeMessage, now: float) -> None:
        """Read a message from the wire; late and doubled ones change nothing."""
        self._credit_J += self._receiver.credit(message.session, message.seq, message.sent_J)
        if (message.session, message.seq) > self._newest:
            self._newest = (message.session, message.seq)
            self._heard_at = now
            self._requesting, self._has_room = message.requesting, message.has_room

    def take_credit(self) -> float:
        """Joules credited since the last call."""
        credit, self._credit_J = self._credit_J, 0.0
        return credit

    def requests(self, now: float) -> bool:
        """Whether the peer asks for energy."""
        return self._requesting and now - self._heard_at <= self._timeout_s

    def has_room(self, now: float) -> bool:
        """Whether the peer can take overflow."""
        return self._has_room and now - self._heard_at <= self._timeout_s


@dataclass
class EnergyBook:
    """Cumulative joules of one tank over all its restarts.

    Energy that a killed tank held is ``lost_J``; it is gone, as if vented.
    """

    energy_J: float = 0.0
    granted_J: float = 0.0
    work_out_J: float = 0.0
    received_J: float = 0.0
    sent_J: float = 0.0
    vented_J: float = 0.0
    lost_J: float = 0.0

    def with_session(self, state: EnergyTankState) -> EnergyBook:
        """These books of past sessions, and that of a tank as it is now."""
        return EnergyBook(
            state.energy_J,
            self.granted_J + state.granted_J,
            self.work_out_J + state.work_out_J,
            self.received_J + state.received_J,
            self.sent_J + state.sent_J,
            self.vented_J + state.vented_J,
            self.lost_J,
        )


class TankNode:
    """An EnergyTank as a process that can die: law, ledgers and the books over all restarts."""

    def __init__(self, config: EnergyTankConfig, channels: int, peers: int, timeout_s: float) -> None:
        """Begin the first session with the configured charge."""
        self._timeout_s = timeout_s
        self._session = 1
        self._past = EnergyBook()
        self.tank = EnergyTank(config, channels)
        self.peers = [Peer(self._session, timeout_s) for _ in range(peers)]
        self.energy_J = config.initial_J
        self.requesting = False
        self.has_room = True

    def restart(self) -> None:
        """Kill the process and start it again: minimum charge, a new session, nothing remembered."""
        book = self.book()
        self._past = EnergyBook(
            0.0,
            book.granted_J,
            book.work_out_J,
            book.received_J,
            book.sent_J,
            book.vented_J,
            book.lost_J + book.energy_J,
        )
        # Joules credited by the ledger that the tank had not taken yet die with it: they left flight, so they are lost.
        unclaimed = sum(peer.take_credit() for peer in self.peers)
        self._past.received_J += unclaimed
        self._past.lost_J += unclaimed
        self._session += 1
        self.tank.reset()
        self.peers = [Peer(self._session, self._timeout_s) for _ in self.peers]
        self.energy_J = self.tank.config.minimum_J
        self.requesting, self.has_room = True, True

    def step(
        self,
        desired: Array,
        conjugate: Array,
        dt: float,
        now: float,
        work_J: float | None = None,
        measured: Array | None = None,
        stale: bool = False,
    ) -> EnergyTankOutput:
        """One tick of the law with what the peers said; see EnergyTank.step."""
        received = 0.0
        requesting = []
        roomy = []
        for peer in self.peers:
            received += peer.take_credit()
            if peer.requests(now):
                requesting.append(peer)
            if peer.has_room(now):
                roomy.append(peer)
        out = self.tank.step(
            desired,
            conjugate,
            dt,
            received_J=received,
            peer_requests=len(requesting),
            peer_has_room=bool(roomy),
            work_J=work_J,
            measured=measured,
            stale=stale,
        )
        sent, overflow = out.sent_J, out.sent_overflow_J
        if sent > 0.0:
            for peer in requesting:
                peer.send((sent - overflow) / len(requesting))
            for peer in roomy:
                peer.send(overflow / len(roomy))
        self.energy_J = out.energy_J
        self.requesting, self.has_room = out.requesting, out.has_room
        return out

    def messages(self) -> list[ExchangeMessage]:
        """One message for each peer."""
        return [peer.message(self.requesting, self.has_room) for peer in self.peers]

    def book(self) -> EnergyBook:
        """All joules so far."""
        return self._past.with_session(self.tank.state)
