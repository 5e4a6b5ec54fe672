"""UDP end of the console: sends up datagrams, hands out the newest down datagram, keeps the counts.

Datagrams are not authenticated yet, so both ends must be loopback addresses: anything else is refused.
"""

from __future__ import annotations

import ipaddress
import logging
import socket
import time
from dataclasses import dataclass
from typing import NamedTuple

from saras import ConfigError, ProtocolError
from saras.net import LinkAge, SequenceFilter, TouchballDown, TouchballUp

log = logging.getLogger("saras.console")

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


def loopback(address: Address, name: str) -> tuple[socket.AddressFamily, tuple[str, int]]:
    """Family and numeric address. Raises ConfigError when it is not on this computer or cannot be resolved."""
    try:
        family, _, _, _, resolved = socket.getaddrinfo(address.host, address.port, type=socket.SOCK_DGRAM)[0]
    except socket.gaierror as error:
        raise ConfigError(f"{name} = {address}: {error.strerror}") from None
    if not ipaddress.ip_address(resolved[0]).is_loopback:
        raise ConfigError(
            f"{name} = {address}: must be a loopback address; datagrams without authentication stay on this computer"
        )
    return family, (str(resolved[0]), int(resolved[1]))


@dataclass
class LinkCounts:
    """What went over the link since it was opened [datagrams]."""

    sent: int = 0
    send_failed: int = 0
    received: int = 0  #: all that arrived
    refused: int = 0  #: not decodable, or from elsewhere: changed nothing
    last_refusal: str = ""


class TouchballLink:
    """A socket, a sequence filter and an age estimate. One thread only."""

    def __init__(self, listen: Address, platform: Address, session: int, timeout_s: float) -> None:
        family, bind_to = loopback(listen, "listen")
        platform_family, self._platform = loopback(platform, "platform")
        if platform_family != family:
            raise ConfigError(f"platform = {platform}: must be of the same IP version as listen = {listen}")
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

    def send(self, up: TouchballUp, now_ns: int) -> None:
        """Stamps and sends one datagram. Raises ProtocolError when a value may not go out."""
        self._seq += 1
        up.session, up.seq, up.sender_time_ns = self._session, self._seq, now_ns
        data = up.encode()
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
            self._refuse(f"datagram from {source[0]}: the platform is {self._platform[0]}", now_ns)
            return None
        try:
            down = TouchballDown.decode(data)
        except ProtocolError as error:
            self._refuse(str(error), now_ns)
            return None
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

    def _refuse(self, reason: str, now_ns: int) -> None:
        self.counts.refused += 1
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
