"""Forged datagrams at a rate: python flood.py PORT RATE_HZ SECONDS SEED. Prints how many were sent."""

from __future__ import annotations

import random
import socket
import sys
import time

from saras.net import TouchballUp, TouchballUpSide, seal


def forged(rng: random.Random, seq: int) -> bytes:
    """A datagram that is good in every byte but its tag, of a session that looks newer, with hands far away."""
    packet = TouchballUp(session=2**63, seq=seq, sender_time_ns=0, left=TouchballUpSide(present=True))
    packet.left.handle_position_m = [9.0, 9.0, 9.0]
    return bytes(seal(packet.encode(True), rng.randbytes(16)))


def main(port: int, rate_hz: float, seconds: float, seed: int) -> None:
    """Sends in lots of 10 ms, so that sleeping does not bound the rate."""
    rng = random.Random(seed)
    datagrams = [forged(rng, 2**40 + i) for i in range(500)]
    per_lot = max(1, round(rate_hz * 0.01))
    sent = 0
    begin = time.monotonic()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as forger:
        while time.monotonic() - begin < seconds:
            for _ in range(per_lot):
                forger.sendto(datagrams[sent % len(datagrams)], ("127.0.0.1", port))
                sent += 1
            time.sleep(max(0.0, begin + sent / rate_hz - time.monotonic()))
    print(sent)


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4]))
