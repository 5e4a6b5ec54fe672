"""A platform end of Touchball UDP, in a thread: what touchball_receiver and tank_master are to a console.

It answers on a real loopback socket with what the test sets (state, engagement, wrench) and keeps a ledger with each
port guard: requests are answered from ``store_J``, energy that guards send is credited to it.
"""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from saras import ProtocolError
from saras.net import ChannelState, PortLedger, TouchballDown, TouchballUp, TouchballUpSide
from saras.teleop import LedgerReceiver, LedgerSender

SIDES = ("left", "right")


@dataclass
class Side:
    """What the platform says to one handle, and its ledger with that handle's guard."""

    state: ChannelState = ChannelState.WAITING
    engagement: int = 0
    wrench: Callable[[TouchballUpSide], np.ndarray] = lambda up: np.zeros(6)
    store_J: float = 10.0
    credited_J: float = 0.0
    sender: LedgerSender = field(default_factory=lambda: LedgerSender(time.time_ns()))
    receiver: LedgerReceiver = field(default_factory=LedgerReceiver)

    def engage(self) -> None:
        self.engagement += 1
        self.state = ChannelState.ENGAGED


class FakePlatform:
    """Use as a context manager. ``address`` is where consoles send to; it answers where they come from."""

    def __init__(self, rate_hz: float = 100.0, exchange_W: float = 2.0) -> None:
        self.sides = {side: Side() for side in SIDES}
        self.ups: list[TouchballUp] = []
        self.refused = 0
        self.muted = False
        self.session = time.time_ns()
        self._period, self._exchange_J = 1.0 / rate_hz, exchange_W / rate_hz
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", 0))
        self._socket.settimeout(0.002)
        self.address = "{}:{}".format(*self._socket.getsockname())
        self._console: tuple[str, int] | None = None
        self._newest_ns = 0
        self._seq = 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self) -> FakePlatform:
        self._thread.start()
        return self

    def __exit__(self, *exception: object) -> None:
        self._stop.set()
        self._thread.join()
        self._socket.close()

    @property
    def newest(self) -> TouchballUp:
        return self.ups[-1]

    def engage(self) -> None:
        for side in self.sides.values():
            side.engage()

    def hold(self) -> None:
        for side in self.sides.values():
            side.state = ChannelState.HOLD

    def send_raw(self, data: bytes) -> None:
        assert self._console is not None
        self._socket.sendto(data, self._console)

    def wait_for(self, condition: Callable[[], bool], what: str, timeout_s: float = 20.0) -> None:
        end = time.monotonic() + timeout_s
        while not condition():
            assert time.monotonic() < end, f"waited {timeout_s} s for {what}"
            time.sleep(0.005)

    def down(self) -> TouchballDown:
        """The next datagram to send."""
        self._seq += 1
        now_ns = time.monotonic_ns()
        down = TouchballDown(session=self.session, seq=self._seq, sender_time_ns=now_ns)
        if self.ups:
            up = self.newest
            down.echo_session, down.echo_seq, down.echo_time_ns = up.session, up.seq, up.sender_time_ns
            down.echo_hold_ns = now_ns - self._newest_ns
        for name, side in self.sides.items():
            part = getattr(down, name)
            part.state, part.engagement = side.state, side.engagement
            if self.ups:
                guard = getattr(self.newest, name)
                part.touch_wrench = side.wrench(guard)
                self._exchange(side, guard)
            session, seq, sent_J = side.sender.next()
            part.ledger = PortLedger(session=session, seq=seq, sent_J=sent_J, requesting=False, has_room=True)
        return down

    def _exchange(self, side: Side, guard: TouchballUpSide) -> None:
        credit = side.receiver.credit(guard.ledger.session, guard.ledger.seq, guard.ledger.sent_J)
        side.credited_J += credit
        side.store_J += credit
        if guard.ledger.requesting and side.store_J > 0.0:
            gift = min(self._exchange_J, side.store_J)
            side.store_J -= gift
            side.sender.send(gift)

    def _run(self) -> None:
        next_send = time.monotonic()
        while not self._stop.is_set():
            try:
                data, self._console = self._socket.recvfrom(2048)
                self._newest_ns = time.monotonic_ns()
                self.ups.append(TouchballUp.decode(data))
            except TimeoutError:
                pass
            except ProtocolError:
                self.refused += 1
            if self._console is not None and not self.muted and time.monotonic() >= next_send:
                next_send = time.monotonic() + self._period
                self._socket.sendto(self.down().encode(), self._console)
