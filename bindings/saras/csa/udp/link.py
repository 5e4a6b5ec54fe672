"""Both ends of a CSA UDP link: a socket, what comes in, what is refused and why.

Without keys both ends must be loopback addresses: anything else is refused. With keys only authenticated datagrams
are believed, on loopback too.
"""

from __future__ import annotations

import contextlib
import ipaddress
import select
import socket
import time
from typing import Generic, TypeVar, Union

from saras import ConfigError, ProtocolError
from saras.console.link import Address, resolve
from saras.net import CsaDown, CsaHandshake, CsaUp, LinkAge, SequenceFilter
from saras.net.keys import Keys
from saras.net.trust import COUNTS, CsaPlatformEnd, CsaSlaveEnd, TrustError

RECEIVE_BYTES = 2048  #: larger than any datagram of the protocol: an oversized one is seen as such
MOST_PER_POLL = 64  #: datagrams read at most in one poll, so that a flood cannot hold who polls
HEARD_WITHIN_NS = 500_000_000  #: an echo that was held longer does not show that the other end hears this one

Outgoing = TypeVar("Outgoing", CsaUp, CsaDown)
Incoming = TypeVar("Incoming", CsaUp, CsaDown)
End = Union[CsaSlaveEnd, CsaPlatformEnd]


class _Link(Generic[Outgoing, Incoming]):
    """What both ends do alike. One thread only; times are those of time.monotonic_ns().

    listen: own address; peer: where datagrams go, and the only host that is heard. age_limit_s: what was held up on the
    way for longer is past, and dropped.
    """

    _incoming: type[Incoming]

    def __init__(
        self, listen: Address, peer: Address, age_limit_s: float, trust: End | None, session: int | None = None
    ) -> None:
        keyed = trust is not None
        family, bind_to = resolve(listen, "listen", keyed)
        peer_family, self._peer = resolve(peer, "peer", keyed)
        if family != peer_family:
            raise ConfigError(f"peer = {peer}: must be of the same IP version as listen = {listen}")
        if ipaddress.ip_address(bind_to[0]).is_loopback and not ipaddress.ip_address(self._peer[0]).is_loopback:
            raise ConfigError(
                f"listen = {listen}: a loopback address does not reach peer = {peer}; for example 0.0.0.0"
            )
        if not 0.0 < age_limit_s < float("inf"):
            raise ConfigError(f"age_limit_s = {age_limit_s}: must be > 0 and finite")
        self._trust = trust
        self._age_limit_s = age_limit_s
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.bind(bind_to)
        except OSError as error:
            self._socket.close()
            raise ConfigError(f"listen = {listen}: {error.strerror}; does another program listen there?") from None
        self.address = Address(*self._socket.getsockname()[:2])
        self.session = time.time_ns() if session is None else session
        self.filter, self._age = SequenceFilter(), LinkAge()
        self.round_trip_s: float | None = None
        self.newest: Incoming | None = None
        self.last_refusal = ""
        self._newest_at_ns = 0
        self._seq = 0
        self._counts = dict.fromkeys(("sent", "send_failed", "accepted", "overdue", "malformed", "foreign"), 0)

    def send(self, packet: Outgoing, now_ns: int) -> None:
        """Completes session, sequence, time and echo, and sends. Raises ProtocolError when a value may not go out.

        A peer that is not there is no error. With keys nothing but the handshake goes out before there is a session.
        """
        self._seq += 1
        packet.session, packet.seq, packet.sender_time_ns = self.session, self._seq, now_ns
        if self.newest is not None:
            packet.echo_session, packet.echo_seq = self.newest.session, self.newest.seq
            packet.echo_time_ns, packet.echo_hold_ns = self.newest.sender_time_ns, now_ns - self._newest_at_ns
        if self._trust is None:
            self._send(packet.encode())
            return
        if isinstance(self._trust, CsaSlaveEnd):
            question = self._trust.handshake_due(now_ns)
            if question is not None:
                self._send(question)
        data = self._trust.seal(packet)  # type: ignore[arg-type]
        if data is not None:
            self._send(data)

    def _send(self, data: bytes) -> None:
        try:
            self._socket.sendto(data, self._peer)
            self._counts["sent"] += 1
        except OSError:  # no route, full buffer: as good as lost, the watchdogs at both ends judge
            self._counts["send_failed"] += 1

    def wait(self, timeout_s: float) -> bool:
        """Whether a datagram waits, at latest after timeout_s."""
        with contextlib.suppress(OSError, ValueError):  # closed meanwhile
            return bool(select.select([self._socket], [], [], timeout_s)[0])
        return False

    def poll(self, now_ns: int) -> Incoming | None:
        """Newest acceptable datagram since the last poll. Older ones in the queue are counted and dropped."""
        newest: Incoming | None = None
        for _ in range(MOST_PER_POLL):
            try:
                data, source = self._socket.recvfrom(RECEIVE_BYTES)
            except BlockingIOError:
                break
            except ConnectionError:  # the peer's port is closed
                continue
            newest = self._take(data, source[0], now_ns) or newest
        return newest

    def _take(self, data: bytes, host: str, now_ns: int) -> Incoming | None:
        if host != self._peer[0]:
            self._refuse("foreign", f"from {host}, not from {self._peer[0]}")
            return None
        try:
            packet = self._decode(data, now_ns)
        except TrustError as error:  # counted by name already
            self.last_refusal = str(error)
            return None
        except ProtocolError as error:
            self._refuse("malformed", str(error))
            return None
        if packet is None:
            return None
        hears_us = packet.echo_session == self.session and packet.echo_hold_ns < HEARD_WITHIN_NS
        if hears_us and isinstance(self._trust, CsaSlaveEnd):
            self._trust.hears_us(now_ns)
        before = self.filter.session
        if not self.filter.accept(packet.session, packet.seq):
            return None
        if packet.session != before:
            self._forget_clock()
        age_s = self._age.received(packet.sender_time_ns, now_ns)
        if age_s > self._age_limit_s:
            self._refuse("overdue", f"seq {packet.seq} came {age_s * 1e3:.0f} ms late")
            return None
        if packet.echo_session == self.session:
            self.round_trip_s = max(0, now_ns - packet.echo_time_ns - packet.echo_hold_ns) * 1e-9
        self._counts["accepted"] += 1
        self.newest, self._newest_at_ns = packet, now_ns
        return packet

    def _decode(self, data: bytes, now_ns: int) -> Incoming | None:
        """The datagram's packet; None after a message of the handshake. Raises ProtocolError."""
        if self._trust is None:
            return self._incoming.decode(data)
        if len(data) != CsaHandshake.SIZE:
            return self._trust.open(data, now_ns)  # type: ignore[return-value]
        begun = self._trust.session
        answer = self._trust.handshake(data, now_ns)
        if answer is not None:
            self._send(answer)
        if self._trust.session is not begun:
            # A restarted peer, or the same one after a silence: its clock and its numbers begin anew.
            self.filter.restart()
            self._forget_clock()
        return None

    def _forget_clock(self) -> None:
        self._age.reset()
        self.round_trip_s = None

    def _refuse(self, count: str, reason: str) -> None:
        self._counts[count] += 1
        self.last_refusal = reason

    def age_s(self, now_ns: int) -> float:
        """Age of the newest information from the other end [s]; inf before the first."""
        return float(self._age.age_s(now_ns))

    def counts(self) -> dict[str, int]:
        """What went and came, and what was refused by name, since the start [datagrams]."""
        seen = self.filter.counts
        stream = {
            name: getattr(seen, name) for name in ("gaps", "duplicate", "out_of_order", "old_session", "sessions")
        }
        trust = self._trust.counts if self._trust is not None else dict.fromkeys(COUNTS, 0)
        return {**self._counts, **stream, **trust}

    def close(self) -> None:
        """Releases the port."""
        self._socket.close()


class SlaveLink(_Link[CsaUp, CsaDown]):
    """The slave's end: sends its state, receives set-points, and asks for the session when there are keys."""

    _incoming = CsaDown

    def __init__(
        self,
        listen: Address,
        platform: Address,
        age_limit_s: float = 0.1,
        keys: Keys | None = None,
        session: int | None = None,
    ) -> None:
        super().__init__(listen, platform, age_limit_s, CsaSlaveEnd(keys) if keys is not None else None, session)


class PlatformLink(_Link[CsaDown, CsaUp]):
    """The platform's end: sends set-points, receives the slave's state."""

    _incoming = CsaUp

    def __init__(
        self,
        listen: Address,
        slave: Address,
        age_limit_s: float = 0.1,
        keys: Keys | None = None,
        session: int | None = None,
    ) -> None:
        super().__init__(listen, slave, age_limit_s, CsaPlatformEnd(keys) if keys is not None else None, session)
