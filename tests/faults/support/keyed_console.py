"""A console of the tests with the key file: it may say anything, with a good tag.

console.position["left"] = …; console.clutch["left"] = True; console.send_sealed(any bytes)
"""

from __future__ import annotations

import math
import random
import socket
import struct
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np

from saras import ProtocolError
from saras.net import TouchballDown, TouchballHandshake, TouchballUp, seal
from saras.net.keys import Keys
from saras.net.trust import ConsoleEnd, tag

from .platform import SIDES, Platform

HOME_M = (0.0, 0.0, -0.22)


class KeyedConsole:
    """Sends at 100 Hz from a thread, keeps the newest answer. ``motion(t, console)`` is called before each datagram."""

    def __init__(self, platform: Platform, keys: Keys) -> None:
        self._platform = ("127.0.0.1", platform.proxy_port)
        self.position = {side: np.array(HOME_M) for side in SIDES}
        self.clutch = dict.fromkeys(SIDES, False)
        self.motion: Callable[[float, KeyedConsole], None] = lambda t, console: None
        self.edit: Callable[[TouchballUp], None] = lambda packet: None
        self.down: TouchballDown | None = None
        self.refused = 0
        self.sending = True
        self.sent = 0
        self.session, self.seq = time.time_ns(), 0
        self._end = ConsoleEnd(keys)
        self._lock = threading.Lock()
        self._running = True
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.bind(("127.0.0.1", platform.console_own_port))
        self._socket.settimeout(0.2)
        for loop in (self._send, self._receive):
            threading.Thread(target=loop, daemon=True).start()

    def stop(self) -> None:
        """Ends the threads."""
        self._running = False

    def packet(self) -> TouchballUp:
        """The next datagram's content."""
        self.seq += 1
        packet = TouchballUp(session=self.session, seq=self.seq, sender_time_ns=time.monotonic_ns())
        for side in SIDES:
            up = getattr(packet, side)
            up.present, up.calibrated, up.clutch, up.grip = True, True, self.clutch[side], 0.5
            pose = np.eye(4)
            pose[:3, 3] = self.position[side]
            up.simball_T_handle = pose
            up.ledger.session, up.ledger.seq, up.ledger.has_room = self.session, self.seq, True
        self.edit(packet)
        return packet

    def good(self) -> bytes:
        """The next datagram, unsealed."""
        with self._lock:
            return self.packet().encode(True)

    def send_sealed(self, data: bytes) -> bool:
        """Any bytes under a good tag; False while there is no session."""
        with self._lock:
            session = self._end.session
            if session is None:
                return False
            self._socket.sendto(seal(data, tag(session.up_key, data)), self._platform)
            return True

    def _send(self) -> None:
        begin = due = time.monotonic()
        while self._running:
            self.motion(time.monotonic() - begin, self)
            if self.sending:
                with self._lock:
                    handshake = self._end.handshake_due(time.monotonic_ns())
                    if handshake is not None:
                        self._socket.sendto(handshake, self._platform)
                    data = self._end.seal(self.packet())
                if data is not None:
                    self._socket.sendto(data, self._platform)
                    self.sent += 1
            due = max(due + 0.01, time.monotonic() - 0.05)
            time.sleep(max(0.0, due - time.monotonic()))

    def _receive(self) -> None:
        while self._running:
            try:
                data = self._socket.recv(2048)
                now_ns = time.monotonic_ns()
                with self._lock:
                    if len(data) == TouchballHandshake.SIZE:
                        confirmation = self._end.handshake(data, now_ns)
                        if confirmation is not None:
                            self._socket.sendto(confirmation, self._platform)
                        continue
                    down = self._end.open(data, now_ns)
                    if down.echo_session == self.session and down.echo_hold_ns < 500_000_000:
                        self._end.hears_us(now_ns)
                self.down = down
            except TimeoutError:
                continue
            except (ProtocolError, ConnectionError):
                self.refused += 1


#: where the floats of one handle are, and where the handles begin: docs/protocols.md
FLOATS = (*range(8, 104, 8), 120, *range(128, 264, 8))
HANDLES = (32, 32 + 264)


def bad_floats(console: KeyedConsole) -> Iterator[tuple[int, float, bytes]]:
    """Datagrams that are good but for one float, each float of the datagram in turn: (its offset, what it is, data)."""
    for begin in HANDLES:
        for offset in FLOATS:
            bad = random.Random(begin + offset).choice((math.nan, math.inf, -math.inf))
            data = bytearray(console.good())
            struct.pack_into("<d", data, begin + offset, bad)
            yield begin + offset, bad, bytes(data)
