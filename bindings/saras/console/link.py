"""UDP end of the console: sends up datagrams, hands out the newest down datagram, keeps the counts.

Without keys both ends must be loopback addresses: anything else is refused.
"""

from __future__ import annotations

import ipaddress
import logging
import socket
import time
from dataclasses import dataclass, field
from typing import NamedTuple

from saras import ConfigError, ProtocolError
from saras.net import LinkAge, SequenceFilter, TouchballDown, TouchballHandshake, TouchballUp
from saras.net.keys import Keys
from saras.net.trust import COUNTS, ConsoleEnd, TrustError

log = logging.getLogger("saras.console")

HEARD_WITHIN_NS = 500_000_000  #: an echo that was held longer does not show that the platform hears this console
UNANSWERED_NS = 5_000_000_000  #: between two hints that no platform has ever answered
MOST_PER_POLL = 64  #: datagrams read at most in one poll, so that a flood cannot hold the control thread


class Address(NamedTuple):
    """Host and port of a UDP end."""

    host: str
    port: int

    @classmethod
    def parse(cls, text: str, name: str = "address") -> Address:
        """From 'HOST:PORT'. Raises ConfigError naming the argument."""
        host, _, port = text.rpartition(":")
        if not host or not port.isdigit() or int(port) > 65535:
            raise ConfigError(f"{name} = {text!r}: must be HOST:PORT, for example 127.0.0.1:48010")
        return cls(host.strip("[]"), int(port))

    def __str__(self) -> str:
        return f"{self.host}:{self.port}"


def resolve(address: Address, name: str, keyed: bool) -> tuple[socket.AddressFamily, tuple[str, int]]:
    """Family and numeric address. Raises ConfigError when it cannot be resolved, or needs keys and has none."""
    try:
        family, _, _, _, resolved = socket.getaddrinfo(address.host, address.port, type=socket.SOCK_DGRAM)[0]
    except socket.gaierror as error:
        raise ConfigError(f"{name} = {address}: {error.strerror}") from None
    if not keyed and not ipaddress.ip_address(resolved[0]).is_loopback:
        raise ConfigError(
            f"{name} = {address}: must be a loopback address, or give both ends a key file (--key FILE; saras keys "
            "make FILE): datagrams without authentication stay on this computer"
        )
    return family, (str(resolved[0]), int(resolved[1]))


@dataclass
class LinkCounts:
    """What went over the link since it was opened [datagrams]."""

    sent: int = 0
    send_failed: int = 0
    received: int = 0  #: all that arrived
    refused: int = 0  #: not decodable, not believed, or from elsewhere: changed nothing
    last_refusal: str = ""
    refused_by: dict[str, int] = field(default_factory=lambda: dict.fromkeys(("foreign", "malformed", *COUNTS[1:]), 0))


class TouchballLink:
    """A socket, a sequence filter and an age estimate; with keys an authenticated session. One thread only."""

    def __init__(
        self, listen: Address, platform: Address, session: int, timeout_s: float, keys: Keys | None = None
    ) -> None:
        family, bind_to = resolve(listen, "listen", keys is not None)
        platform_family, self._platform = resolve(platform, "platform", keys is not None)
        if platform_family != family:
            raise ConfigError(f"platform = {platform}: must be of the same IP version as listen = {listen}")
        if ipaddress.ip_address(bind_to[0]).is_loopback and not ipaddress.ip_address(self._platform[0]).is_loopback:
            raise ConfigError(
                f"listen = {listen}: a loopback address does not reach platform = {platform}; for example "
                f"--listen 0.0.0.0:{listen.port}"
            )
        self._trust = ConsoleEnd(keys) if keys is not None else None
        self._socket = socket.socket(family, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        try:
            self._socket.bind(bind_to)
        except OSError as error:
            self._socket.close()
            raise ConfigError(f"listen = {listen}: {error.strerror}; is another console running?") from None
        self.address = Address(*self._socket.getsockname()[:2])
        self.counts = LinkCounts()
        self.filter = SequenceFilter()
        self.round_trip_s: float | None = None
        self._age = LinkAge()
        self._session = session
        self._seq = 0
        self._timeout_s = timeout_s
        self._refusal_logged_ns = 0
        self._unanswered_log_ns: int | None = None

    def send(self, up: TouchballUp, now_ns: int) -> None:
        """Stamps and sends one datagram. Raises ProtocolError when a value may not go out.

        With keys, nothing goes out but the handshake until the platform has answered it.
        """
        self._seq += 1
        up.session, up.seq, up.sender_time_ns = self._session, self._seq, now_ns
        if self._trust is None:
            self._send(up.encode())
            return
        handshake = self._trust.handshake_due(now_ns)
        if handshake is not None:
            self._send(handshake)
        data = self._trust.seal(up)
        if data is not None:
            self._send(data)
        else:
            self._say_that_nobody_answers(now_ns)

    def _say_that_nobody_answers(self, now_ns: int) -> None:
        """A platform says nothing to whom it does not believe, so the user is told here what it may be."""
        if self._unanswered_log_ns is None:
            self._unanswered_log_ns = now_ns + UNANSWERED_NS
        elif now_ns >= self._unanswered_log_ns:
            self._unanswered_log_ns = now_ns + UNANSWERED_NS
            log.warning(
                "the platform at %s:%d answers no handshake: it is not running, has another key file or none, or hears "
                "another console; its /diagnostics tell which",
                *self._platform[:2],
            )

    def _send(self, data: bytes) -> None:
        try:
            self._socket.sendto(data, self._platform)
            self.counts.sent += 1
        except OSError:  # no route, full buffer: as good as lost, the watchdogs at both ends judge
            self.counts.send_failed += 1

    def poll(self, now_ns: int) -> TouchballDown | None:
        """Newest acceptable datagram since the last poll. Older ones in the queue are counted and dropped."""
        newest: TouchballDown | None = None
        for _ in range(MOST_PER_POLL):
            try:
                data, source = self._socket.recvfrom(2048)
            except BlockingIOError:
                break
            except ConnectionError:  # Windows reports an unreachable peer here
                continue
            self.counts.received += 1
            down = self._take(data, source, now_ns)
            newest = down or newest
        return newest

    def _take(self, data: bytes, source: tuple[str, int], now_ns: int) -> TouchballDown | None:
        if source[0] != self._platform[0]:
            self._refuse("foreign", f"datagram from {source[0]}: the platform is {self._platform[0]}", now_ns)
            return None
        try:
            down = self._decode(data, now_ns)
        except ProtocolError as error:
            self._refuse(error.count if isinstance(error, TrustError) else "malformed", str(error), now_ns)
            return None
        if down is None:
            return None
        if self._trust is not None and down.echo_session == self._session and down.echo_hold_ns < HEARD_WITHIN_NS:
            self._trust.hears_us(now_ns)  # also by a late one: another session would not make the link faster
        session = self.filter.session
        if not self.filter.accept(down.session, down.seq):
            return None
        if down.session != session:
            self._age.reset()
            self.round_trip_s = None
        if self._age.received(down.sender_time_ns, now_ns) > self._timeout_s:
            return None  # held up on the way: what it says is past
        if down.echo_session == self._session:
            self.round_trip_s = max(0, now_ns - down.echo_time_ns - down.echo_hold_ns) * 1e-9
        return down

    def _decode(self, data: bytes, now_ns: int) -> TouchballDown | None:
        """The datagram's packet; None after a message of the handshake. Raises ProtocolError."""
        if self._trust is None:
            return TouchballDown.decode(data)
        if len(data) != TouchballHandshake.SIZE:
            return self._trust.open(data, now_ns)
        begun = self._trust.session
        confirmation = self._trust.handshake(data, now_ns)
        if confirmation is not None:
            self._send(confirmation)
        if self._trust.session is not begun:
            log.info("authenticated session with the platform begun")
            self.filter.restart()
            self._age.reset()
            self.round_trip_s = None
        return None

    def _refuse(self, count: str, reason: str, now_ns: int) -> None:
        self.counts.refused += 1
        self.counts.refused_by[count] += 1
        self.counts.last_refusal = reason
        if now_ns - self._refusal_logged_ns > 1_000_000_000:
            self._refusal_logged_ns = now_ns
            log.warning("refused a datagram (%d so far): %s", self.counts.refused, reason)

    def age_s(self, now_ns: int) -> float:
        """Age of the newest information from the platform [s]; inf before the first datagram."""
        return float(self._age.age_s(now_ns))

    def is_fresh(self, now_ns: int) -> bool:
        """Whether the platform was heard within the timeout."""
        return self.age_s(now_ns) <= self._timeout_s

    def close(self) -> None:
        """Releases the port."""
        self._socket.close()


def new_session() -> int:
    """Larger for every start: wall-clock nanoseconds."""
    return time.time_ns()
