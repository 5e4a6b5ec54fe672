"""What tank_master and tank_slave share: the law, the ledgers with each peer, messages."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
from std_msgs.msg import String

from saras.teleop import EnergyTank, EnergyTankConfig, LedgerReceiver, LedgerSender
from saras_ros1 import tank_messages
from saras_ros1.inputs import Input
from saras_ros1.msg import TankExchange, TankState
from saras_ros1.node import Node, Tick
from saras_ros1.quiet_faults import TankFaults


def new_session() -> int:
    """Larger for every restart, also over a reboot."""
    return time.time_ns()


def read_exchange(message: TankExchange) -> TankExchange:
    """Refuses totals that are no energy."""
    if not (np.isfinite(message.sent_J) and message.sent_J >= 0.0):
        raise ValueError(f"sent_J {message.sent_J}: must be finite and >= 0")
    return message


class Peer:
    """The ledgers with one other tank. A silent peer asks for nothing and has no room."""

    def __init__(self, node: Node, incoming: str, outgoing: str, session: int, timeout_s: float) -> None:
        self._sender, self._receiver = LedgerSender(session), LedgerReceiver()
        self._input = node.input(incoming, TankExchange, read_exchange, timeout_s=timeout_s)
        self._input.listeners.append(self._on_exchange)
        self._output = node.output(outgoing, TankExchange)
        self._credit_J = 0.0

    def _on_exchange(self, source: Input) -> None:
        message = source.message
        self._credit_J += self._receiver.credit(message.session, message.seq, message.sent_J)

    def take_credit(self) -> float:
        """Joules that came since the last call."""
        credit, self._credit_J = self._credit_J, 0.0
        return credit

    @property
    def requesting(self) -> bool:
        """Whether it asks for energy now."""
        return self._input.fresh and self._input.message.requesting

    @property
    def has_room(self) -> bool:
        """Whether it can take overflow now."""
        return self._input.fresh and self._input.message.has_room

    def send(self, energy_J: float) -> None:
        """Adds energy to what this peer was sent."""
        self._sender.send(energy_J)

    def publish(self, out: Any, stamp_ns: int) -> None:
        """Tells this peer the sum, and what this tank wishes."""
        session, seq, sent_J = self._sender.next()
        self._output.publish(tank_messages.exchange(session, seq, sent_J, wishes=out, stamp_ns=stamp_ns))


class Tank:
    """EnergyTank with its peers. It begins at the minimum; the starting charge comes with each new engagement."""

    def __init__(self, node: Node, name: str, config: EnergyTankConfig, channels: int) -> None:
        self.session = new_session()
        self.config = config
        self.law = node.law(name, EnergyTank, config, channels)
        self.law.reset()
        self.peers: list[Peer] = []
        self._state_out = node.output(f"/{name}/state", TankState)
        self._events, self._faults = node.output("/system/events", String), TankFaults(name)
        # Sums lose nothing when they are told less often.
        self._exchange_every = node.params.integer("exchange_every", 1, 10)
        self._state_every = node.params.integer("state_every", 1, 100)
        self._ticks = self._seq = 0

    def grant_charge(self) -> None:
        """Tops the tank up to initial_J; counted in granted_J."""
        self.law.grant(max(0.0, self.config.initial_J - self.law.state.energy_J))

    def step(self, tick: Tick, **inputs: Any) -> Any:
        """Steps the law with the peers' credits and wishes, sends its answers, publishes the state."""
        asking = [peer for peer in self.peers if peer.requesting]
        roomy = [peer for peer in self.peers if peer.has_room]
        received_J = sum(peer.take_credit() for peer in self.peers)
        wishes = {"peer_requests": len(asking), "peer_has_room": bool(roomy)}
        out = self.law.step(received_J=received_J, **wishes, dt=tick.dt, **inputs)
        answer_J = out.sent_J - out.sent_overflow_J
        for peer in self.peers:
            share_J = answer_J / len(asking) if peer in asking else 0.0
            share_J += out.sent_overflow_J / len(roomy) if peer in roomy else 0.0
            peer.send(share_J)
        if text := self._faults.update(out.reduction, out.energy_J):
            self._events.publish(String(text))
        self._ticks += 1
        if self._ticks % self._exchange_every == 0:
            for peer in self.peers:
                peer.publish(out, tick.stamp_ns)
        if self._ticks % self._state_every == 0:
            self._publish(out, tick.stamp_ns)
        return out

    def _publish(self, out: Any, stamp_ns: int) -> None:
        self._seq += 1
        message = tank_messages.state(
            self.session,
            self._seq,
            levels=self.config,
            out=out,
            sums=self.law.state,
            sent_J=self.law.state.sent_J,
            wishes=out,
            stamp_ns=stamp_ns,
        )
        self._state_out.publish(message)
