"""Handshakes of the authenticated console link, beside the real-time loop.

The loop checks each datagram's tag itself; the few messages that begin a session are handed to this thread, which
answers them by saras.net.trust and gives the loop the session's keys.
"""

from __future__ import annotations

import threading
import time

import rospy

from saras import ProtocolError
from saras.net.keys import Keys
from saras.net.trust import COUNTS, PlatformEnd
from saras.runtime import TeleopHost

POLL_S = 0.02


class Handshakes:
    """Runs until shutdown."""

    def __init__(self, host: TeleopHost, keys: Keys) -> None:
        self._host, self._trust = host, PlatformEnd(keys)
        threading.Thread(target=self._serve, daemon=True).start()

    def _serve(self) -> None:
        while not rospy.is_shutdown():
            data = self._host.take_handshake()
            if data is None:
                time.sleep(POLL_S)
            else:
                self._take(data)

    def _take(self, data: bytes) -> None:
        begun = self._trust.session
        if begun is not None and self._host.heard_ns():
            begun.heard_ns, begun.is_heard = self._host.heard_ns(), True
        try:
            answer = self._trust.handshake(data, time.monotonic_ns())
        except ProtocolError as error:
            rospy.logwarn_throttle(1.0, f"console datagram refused: {error}")
            return
        if answer is not None:
            self._host.send(answer)
        session = self._trust.session
        if session is not None and session is not begun:
            self._host.set_session(session.up_key, session.down_key)

    def counts(self) -> dict[str, int]:
        """Sessions begun and handshakes refused, by name."""
        return dict(self._trust.counts)


def merged(loop: dict[str, int], handshakes: Handshakes | None) -> dict[str, int]:
    """The counts of the loop with those of the handshakes, names as the separate node's."""
    counts = {**loop, **{name: loop.get(name, 0) for name in COUNTS}}
    for name, count in (handshakes.counts() if handshakes is not None else {}).items():
        counts[name] += count
    return counts
