"""The platform's end of the Touchball UDP link, without ROS: one socket, what comes in, what is refused and why."""

from __future__ import annotations

import contextlib
import ipaddress
import socket
import time
from typing import NamedTuple

from saras import ConfigError, ProtocolError
from saras.net import LinkAge, SequenceFilter, TouchballDown, TouchballHandshake, TouchballUp
from saras.net.keys import Keys
from saras.net.trust import COUNTS, PlatformEnd, TrustError

# Larger than any datagram of the protocol, so that an oversized one is seen as such and not as a good prefix.
RECEIVE_BYTES = 2048
FUTURE_TOLERANCE_NS = 1_000_000
CLOCK_STEP_NS = 1_000_000_000


class Received(NamedTuple):
    """A good datagram; stamp_ns: ROS time at which it was sent, with the exact spacing of the sender's clock."""

    packet: TouchballUp
    stamp_ns: int


class ConsoleLink:
    """Receives, filters and counts; sends down datagrams to the console.

    Without keys anything but loopback is refused (ConfigError): on a network anybody could move the arms. With keys
    only authenticated datagrams are believed, on loopback too.
    """

    def __init__(
        self, bind: tuple[str, int], console: tuple[str, int], age_limit_s: float, keys: Keys | None = None
    ) -> None:
        check_addresses(bind[0], console[0], keys is not None)
        self._trust = PlatformEnd(keys) if keys is not None else None
        self.console = console
        self.age_limit_s = age_limit_s
        self.accepted = self.overdue = self.malformed = self.foreign = 0
        self.sequence, self.age = SequenceFilter(), LinkAge()
        self.newest: TouchballUp | None = None
        self._newest_at_ns = 0
        self._anchor_ns: int | None = None
        self._session, self._seq = time.time_ns(), 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.settimeout(0.2)
        try:
            self._socket.bind(bind)
        except OSError as error:
            raise ConfigError(f"bind address {bind[0]}:{bind[1]}: {error.strerror}") from None

    @property
    def port(self) -> int:
        """The bound UDP port."""
        return self._socket.getsockname()[1]

    def receive(self) -> Received | str | None:
        """A good datagram, the reason why one was refused, or None: nothing in 0.2 s, or a handshake's message."""
        try:
            data, sender = self._socket.recvfrom(RECEIVE_BYTES)
        except TimeoutError:
            return None
        now_ns = time.monotonic_ns()
        if sender[0] != self.console[0]:
            self.foreign += 1
            return f"from {sender[0]}, not from the console at {self.console[0]}"
        try:
            packet = self._decode(data, now_ns)
        except TrustError as error:  # counted by name already
            return str(error)
        except ProtocolError as error:
            self.malformed += 1
            return str(error)
        if packet is None:
            return None
        previous = self.sequence.session
        if not self.sequence.accept(packet.session, packet.seq):
            return f"session {packet.session} seq {packet.seq}: not newer than {previous} {self.sequence.seq}"
        if packet.session != previous:
            self.age.reset()
            self._anchor_ns = None
        age_s = self.age.received(packet.sender_time_ns, now_ns)
        if age_s > self.age_limit_s:
            self.overdue += 1
            return f"seq {packet.seq} came {age_s * 1e3:.0f} ms late"
        self.accepted += 1
        self.newest, self._newest_at_ns = packet, now_ns
        return Received(packet, self._stamp_ns(packet.sender_time_ns))

    def _decode(self, data: bytes, now_ns: int) -> TouchballUp | None:
        """The datagram's packet; None after a message of the handshake. Raises ProtocolError."""
        if self._trust is None:
            return TouchballUp.decode(data)
        if len(data) != TouchballHandshake.SIZE:
            return self._trust.open(data, now_ns)
        begun = self._trust.session
        answer = self._trust.handshake(data, now_ns)
        if answer is not None:
            self._send(answer)
        if self._trust.session is not begun:
            # A restarted console, or the same one after a silence: its clock and its numbers begin anew.
            self.sequence.restart()
            self.age.reset()
            self._anchor_ns = None
        return None

    def _stamp_ns(self, sender_time_ns: int) -> int:
        """Sender's time on the ROS clock. A stamp never lies in the future; a stepped clock anchors anew."""
        now_ns = time.time_ns()
        if self._anchor_ns is not None:
            behind_ns = now_ns - (sender_time_ns + self._anchor_ns)
            if -FUTURE_TOLERANCE_NS <= behind_ns <= CLOCK_STEP_NS:
                return sender_time_ns + self._anchor_ns
        self._anchor_ns = now_ns - sender_time_ns
        return now_ns

    def age_s(self) -> float:
        """Age of the newest information; infinite before the first datagram."""
        return self.age.age_s(time.monotonic_ns())

    def send(self, packet: TouchballDown) -> None:
        """Completes session, sequence, time and echo, and sends. A console that is not there is no error.

        With keys nothing goes out before a console has begun a session.
        """
        self._seq += 1
        packet.session, packet.seq = self._session, self._seq
        now_ns = time.monotonic_ns()
        packet.sender_time_ns = now_ns
        if self.newest is not None:
            packet.echo_session, packet.echo_seq = self.newest.session, self.newest.seq
            packet.echo_time_ns, packet.echo_hold_ns = self.newest.sender_time_ns, now_ns - self._newest_at_ns
        data = packet.encode() if self._trust is None else self._trust.seal(packet)
        if data is not None:
            self._send(data)

    def _send(self, data: bytes) -> None:
        # A loopback port that nobody has opened yet refuses; the console's age tells.
        with contextlib.suppress(OSError):
            self._socket.sendto(data, self.console)

    def close(self) -> None:
        """Closes the socket; receive() then ends."""
        self._socket.close()

    def counts(self) -> dict[str, int]:
        """What came and what was refused since the start."""
        sequence = self.sequence.counts
        return {
            "accepted": self.accepted,
            "gaps": sequence.gaps,
            "duplicate": sequence.duplicate,
            "out_of_order": sequence.out_of_order,
            "old_session": sequence.old_session,
            "sessions": sequence.sessions,
            "overdue": self.overdue,
            "malformed": self.malformed,
            "foreign": self.foreign,
            **(self._trust.counts if self._trust is not None else dict.fromkeys(COUNTS, 0)),
        }


def check_addresses(bind_host: str, console_host: str, keyed: bool) -> None:
    """Raises ConfigError for what needs keys and has none, or cannot reach the console."""
    hosts = {"bind_host": _address("bind_host", bind_host), "console_host": _address("console_host", console_host)}
    for name, host in hosts.items():
        if not keyed and not host.is_loopback:
            raise ConfigError(
                f"{name} = {host}: must be a loopback address, or name a key file in key_file (saras keys make FILE): "
                "the link is not authenticated without one"
            )
    if hosts["bind_host"].is_loopback and not hosts["console_host"].is_loopback:
        raise ConfigError(
            f"bind_host = {bind_host}: a loopback address does not reach console_host = {console_host}; "
            "for example 0.0.0.0"
        )


def _address(name: str, host: str) -> ipaddress.IPv4Address:
    try:
        return ipaddress.IPv4Address(host)
    except ValueError:
        raise ConfigError(f"{name} = {host!r}: must be a numeric IPv4 address, for example 127.0.0.1") from None
