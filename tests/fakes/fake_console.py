"""A console of a few lines for tests: sends Touchball datagrams from a thread, keeps the newest answer.

console = FakeConsole(up_port, down_port); console.start()
console.position["left"] = np.array([0.01, 0, 0.22]); console.clutch["left"] = True
"""

from __future__ import annotations

import socket
import threading
import time

import numpy as np

from saras import ProtocolError
from saras.net import TouchballDown, TouchballUp

SIDES = ("left", "right")


class FakeConsole:
    def __init__(self, up_port: int = 48010, down_port: int = 48011, rate_hz: float = 100.0) -> None:
        self.platform, self.rate_hz = ("127.0.0.1", up_port), rate_hz
        self.position = {side: np.array([0.0, 0.0, -0.22]) for side in SIDES}
        self.clutch = dict.fromkeys(SIDES, False)
        self.present = dict.fromkeys(SIDES, True)
        self.session, self.seq = time.time_ns(), 0
        self.down: TouchballDown | None = None
        self.sending = True
        self.joints = None  # of a side: (yaw, pitch, roll, insertion)
        self.motion = None  # called with the time since start before each datagram
        self.running = threading.Event()
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", down_port))
        self.socket.settimeout(0.2)

    def start(self) -> None:
        self.running.set()
        threading.Thread(target=self._send, daemon=True).start()
        threading.Thread(target=self._receive, daemon=True).start()

    def stop(self) -> None:
        self.running.clear()

    def packet(self) -> TouchballUp:
        self.seq += 1
        packet = TouchballUp(session=self.session, seq=self.seq, sender_time_ns=time.monotonic_ns())
        for side in SIDES:
            up = getattr(packet, side)
            up.present, up.calibrated, up.clutch, up.grip = self.present[side], True, self.clutch[side], 0.5
            pose = np.eye(4)
            pose[:3, 3] = self.position[side]
            up.simball_T_handle = pose
            if self.joints is not None:
                joints = up.joints
                joints.yaw_rad, joints.pitch_rad, joints.roll_rad, joints.insertion_m = self.joints(side)
            up.ledger.session, up.ledger.seq, up.ledger.has_room = self.session, self.seq, True
        return packet

    def send_raw(self, data: bytes) -> None:
        self.socket.sendto(data, self.platform)

    def _send(self) -> None:
        begin = due = time.monotonic()
        while self.running.is_set():
            if self.motion is not None:
                self.motion(time.monotonic() - begin)
            if self.sending:
                self.send_raw(self.packet().encode())
            due += 1.0 / self.rate_hz
            time.sleep(max(0.0, due - time.monotonic()))

    def _receive(self) -> None:
        while self.running.is_set():
            try:
                self.down = TouchballDown.decode(self.socket.recv(2048))
            except (TimeoutError, ProtocolError):
                continue
