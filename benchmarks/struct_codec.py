"""The Touchball datagrams with Python's struct and zlib, after docs/protocols.md: the peer of the codec benchmark.

Packets are flat lists of numbers in the order of the layout. Checks size, checksum, magic, version and finiteness.
"""

from __future__ import annotations

import math
import struct
import zlib

HEADER = struct.Struct("<4sHHQQq")
UP_SIDE = struct.Struct("<II3d4d4ddQQd17d")
DOWN_ECHO = struct.Struct("<QQqq")
DOWN_SIDE = struct.Struct("<IIQ6dQQd")
TAIL = struct.Struct("<16sI")
UP_SIZE = HEADER.size + 2 * UP_SIDE.size + TAIL.size
DOWN_SIZE = HEADER.size + DOWN_ECHO.size + 2 * DOWN_SIDE.size + TAIL.size


def seal(body):
    body += bytes(16)
    return body + struct.pack("<I", zlib.crc32(body))


def opened(data, size, magic):
    if len(data) != size or zlib.crc32(data[:-4]) != struct.unpack_from("<I", data, size - 4)[0]:
        raise ValueError("size or checksum")
    header = HEADER.unpack_from(data)
    if header[0] != magic or header[1] != 1 or header[2] != 0:
        raise ValueError("magic, version or flags")
    return header[3:]


def finite(values):
    if not all(map(math.isfinite, values)):
        raise ValueError("not finite")
    return values


def encode_up(packet):
    """packet: (session, seq, sender_time_ns), left, right."""
    stream, left, right = packet
    finite(left), finite(right)
    return seal(HEADER.pack(b"STBU", 1, 0, *stream) + UP_SIDE.pack(*left) + UP_SIDE.pack(*right))


def decode_up(data):
    stream = opened(data, UP_SIZE, b"STBU")
    left = finite(UP_SIDE.unpack_from(data, HEADER.size))
    return stream, left, finite(UP_SIDE.unpack_from(data, HEADER.size + UP_SIDE.size))


def encode_down(packet):
    """packet: (session, seq, sender_time_ns), echo, left, right."""
    stream, echo, left, right = packet
    finite(left), finite(right)
    sides = DOWN_SIDE.pack(*left) + DOWN_SIDE.pack(*right)
    return seal(HEADER.pack(b"STBD", 1, 0, *stream) + DOWN_ECHO.pack(*echo) + sides)


def decode_down(data):
    stream = opened(data, DOWN_SIZE, b"STBD")
    at = HEADER.size + DOWN_ECHO.size
    left = finite(DOWN_SIDE.unpack_from(data, at))
    return (
        stream,
        DOWN_ECHO.unpack_from(data, HEADER.size),
        left,
        finite(DOWN_SIDE.unpack_from(data, at + DOWN_SIDE.size)),
    )


def example_up():
    side = (3, 2, 0.01, 0.02, 0.03, 0.0, 0.0, 0.0, 1.0, 0.1, 0.2, 0.3, 0.04, 0.5, 1, 9, 0.25, 0.4, *[0.0] * 16)
    return (7, 11, 123456789), side, side


def example_down():
    side = (1, 2, 1, 0.5, -0.2, 1.0, 0.0, 0.0, 0.0, 1, 9, 0.25)
    return (7, 11, 123456789), (7, 10, 123456000, 500), side, side
