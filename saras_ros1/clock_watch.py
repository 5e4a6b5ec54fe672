"""Asks other hosts for the time (NTP, UDP) and keeps an estimate of each one's clock."""

from __future__ import annotations

import ipaddress
import os
import socket
import threading
import time
from typing import NamedTuple

from saras import ConfigError, ProtocolError
from saras.net import ntp
from saras.net.clock_offset import ClockOffset, Exchange, Offset

Address = tuple[str, int]
ANSWER_S = 0.5
_BYTES = 512


class Said(NamedTuple):
    """What is known of a host's clock. offset None: unknown, and why."""

    offset: Offset | None
    why: str = ""
    synchronised: bool = False
    stratum: int = 0
    steps: int = 0


def parse_hosts(text: str, name: str) -> dict[str, Address]:
    """From "console=192.168.5.2 arms=192.168.6.2:1123". Raises ConfigError naming the parameter."""
    hosts = {}
    for word in text.split():
        label, _, where = word.partition("=")
        host, _, port = where.partition(":")
        try:
            number = int(port) if port else ntp.PORT
            if not label or not 1 <= number <= 65535:
                raise ValueError
            hosts[label] = (str(ipaddress.ip_address(host)), number)
        except ValueError:
            raise ConfigError(f"{name}: {word!r} must be NAME=ADDRESS or NAME=ADDRESS:PORT, address numeric") from None
    return hosts


def ask(where: Address, timeout_s: float = ANSWER_S) -> tuple[Exchange, ntp.Answer]:
    """One exchange. Raises OSError without an answer, ProtocolError for one that is none."""
    cookie = os.urandom(ntp.COOKIE_BYTES)
    family = socket.AF_INET6 if ":" in where[0] else socket.AF_INET
    # Connected: only this host is heard, and no port waits for strangers.
    with socket.socket(family, socket.SOCK_DGRAM) as one:
        one.settimeout(timeout_s)
        one.connect(where)
        sent_ns = time.time_ns()
        one.send(ntp.request(cookie))
        data = one.recv(_BYTES)
        received_ns = time.time_ns()
    said = ntp.read_answer(data, cookie, received_ns)
    return Exchange(sent_ns, said.heard_ns, said.answered_ns, received_ns), said


class ClockWatch:
    """Estimates for some hosts. look() asks; said() is for any thread."""

    def __init__(self, stale_s: float) -> None:
        self._stale_s = stale_s
        self._lock = threading.Lock()
        self._clocks: dict[Address, ClockOffset] = {}
        self._last: dict[Address, ntp.Answer] = {}
        self._why: dict[Address, str] = {}

    def look(self, where: Address, times: int = 1) -> None:
        """Asks up to `times` times, until one is not answered."""
        for _ in range(times):
            try:
                exchange, said = ask(where)
            except (OSError, ProtocolError) as error:
                with self._lock:
                    self._why[where] = f"no answer of {where[0]} on UDP port {where[1]} ({error})"
                return
            with self._lock:
                self._clocks.setdefault(where, ClockOffset(stale_s=self._stale_s)).add(exchange, time.monotonic())
                self._last[where] = said

    def said(self, where: Address) -> Said:
        """What is known now."""
        with self._lock:
            clock, last = self._clocks.get(where), self._last.get(where)
            offset = clock.estimate(time.monotonic()) if clock is not None else None
            if clock is None or last is None or offset is None:
                return Said(None, self._why.get(where, "not asked yet"))
            return Said(offset, "", last.synchronised, last.stratum, clock.steps)


def words(said: Said) -> str:
    """One line for a person."""
    if said.offset is None:
        return f"unknown: {said.why}"
    error_ms = 1e3 * said.offset.error_s
    unsure = "" if said.synchronised else "; it follows no time source itself"
    return f"{said.offset.offset_s:+.3f} s ± {error_ms:.1f} ms against this computer{unsure}"
