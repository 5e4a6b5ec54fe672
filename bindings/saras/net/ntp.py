"""The one question of the Network Time Protocol that asks for the time: datagrams, no socket, no clock (RFC 5905 §7.3).

A request carries 64 random bits where its sending time would stand; the answer must repeat them. So an answer cannot be
one to another question, and nobody learns our clock from the question.
"""

from __future__ import annotations

import struct
from typing import NamedTuple

from saras import ProtocolError

PORT = 123
SIZE = 48
COOKIE_BYTES = 8
_LAYOUT = struct.Struct(">BBbbIIIQ8sQQ")  # the 8s is the origin timestamp, here our cookie
_TRANSMIT_AT = 40
_VERSION, _CLIENT, _SERVER = 4, 3, 4
_UNIX_IN_NTP_S = 2_208_988_800  # 1970 in seconds since 1900
_ERA = 1 << 64
_SECOND_NS = 1_000_000_000
_UNSYNCHRONISED_LEAP, _UNSYNCHRONISED_STRATUM = 3, 16


class Answer(NamedTuple):
    """What a host's clock said [ns since 1970]; synchronised: whether the host itself claims to follow a source."""

    heard_ns: int
    answered_ns: int
    synchronised: bool
    stratum: int


def to_ntp(unix_ns: int) -> int:
    """64-bit NTP timestamp: 32 bits of seconds since 1900, 32 bits of fraction, modulo the era of 136 years."""
    seconds, rest = divmod(unix_ns, _SECOND_NS)
    return ((seconds + _UNIX_IN_NTP_S) << 32 | (rest << 32) // _SECOND_NS) % _ERA


def from_ntp(stamp: int, near_ns: int) -> int:
    """Nanoseconds since 1970, in the era that brings it nearest to near_ns; within a nanosecond."""
    since_1900_ns = (stamp * _SECOND_NS + (1 << 31)) >> 32
    era_ns = _SECOND_NS << 32
    unix_ns = since_1900_ns - _UNIX_IN_NTP_S * _SECOND_NS
    return unix_ns + era_ns * round((near_ns - unix_ns) / era_ns)


def request(cookie: bytes) -> bytes:
    """A client's datagram; cookie: COOKIE_BYTES random bytes, new for each."""
    if len(cookie) != COOKIE_BYTES:
        raise ProtocolError(f"cookie of {len(cookie)} bytes: must be {COOKIE_BYTES}")
    return bytes([_VERSION << 3 | _CLIENT]) + bytes(_TRANSMIT_AT - 1) + cookie


def read_answer(data: bytes, cookie: bytes, near_ns: int) -> Answer:
    """The answer to request(cookie); near_ns: our own time, for the era only. Raises ProtocolError."""
    if len(data) < SIZE:
        raise ProtocolError(f"NTP answer of {len(data)} bytes: must be at least {SIZE}")
    first, stratum, _, _, _, _, _, _, origin, heard, answered = _LAYOUT.unpack_from(data)
    leap, mode = first >> 6, first & 7
    if mode != _SERVER:
        raise ProtocolError(f"NTP mode {mode}: must be {_SERVER}, a server's answer")
    if origin != cookie:
        raise ProtocolError("NTP answer to another question")
    if stratum == 0:
        code = data[12:16].decode("ascii", errors="replace").rstrip("\0")
        raise ProtocolError(f"NTP server will not tell the time: {code or 'no reason given'}")
    if heard == 0 or answered == 0:
        raise ProtocolError("NTP answer without times")
    synchronised = leap != _UNSYNCHRONISED_LEAP and stratum < _UNSYNCHRONISED_STRATUM
    return Answer(from_ntp(heard, near_ns), from_ntp(answered, near_ns), synchronised, stratum)


def answer(question: bytes, heard_ns: int, answered_ns: int, stratum: int = 10) -> bytes:
    """A server's datagram to a client's question, for simulated hosts. Raises ProtocolError when it is no question."""
    if len(question) < SIZE or question[0] & 7 != _CLIENT:
        raise ProtocolError("no question of an NTP client")
    cookie, heard, answered = question[_TRANSMIT_AT:SIZE], to_ntp(heard_ns), to_ntp(answered_ns)
    leap = _UNSYNCHRONISED_LEAP if stratum >= _UNSYNCHRONISED_STRATUM else 0
    first = leap << 6 | (question[0] & 0x38) | _SERVER
    return _LAYOUT.pack(first, stratum, 4, -20, 0, 0, 0x7F7F0101, heard, cookie, heard, answered)
