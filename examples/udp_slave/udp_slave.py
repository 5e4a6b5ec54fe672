"""A slave arm at the far end of CSA UDP, in Python: the same simulated PSM as udp_slave.c, with saras (no ROS).

    python udp_slave.py --listen 127.0.0.1:48031 --platform 127.0.0.1:48030 [--key FILE]

To drive your own robot, replace Arm.
"""

from __future__ import annotations

import argparse
import signal
import sys
import time
from pathlib import Path

import numpy as np

from saras import Error
from saras.console.link import Address
from saras.csa.udp import GateConfig, SlaveGate, SlaveLink
from saras.kinematics import dvrk
from saras.net import CsaDown, CsaMode, CsaSlaveState, CsaUp
from saras.net.keys import load

START = np.array([0.1, -0.1, 0.15, 0.2, 0.1, -0.1])
SPEED = np.array([3.0, 3.0, 0.3, 3.0, 3.0, 3.0])
REACH = (0.35, 0.35, 0.02, 0.35, 0.35, 0.35)
LAG_S = 0.02


class Arm:
    """Follows its goal with a lag. tissue: height [m] below which it is elastic, stiffness [N/m]; 0: no sensor."""

    def __init__(self, tissue: tuple[float, float]) -> None:
        self.psm, self.tissue = dvrk.psm(), tissue
        self.lower, self.upper = np.asarray(self.psm.limits, dtype=float).T
        self.q, self.goal, self.v = START.copy(), START.copy(), np.zeros(6)

    @property
    def pose(self) -> np.ndarray:
        """(4, 4) base_T_tip."""
        return np.asarray(self.psm.forward(self.q))

    def follow(self, down: CsaDown) -> None:
        """A set-point that the gate has let through."""
        goal = down.position if down.mode == CsaMode.JOINTS else self.psm.inverse(down.base_T_tip, self.q)
        self.goal = np.clip(goal, self.lower, self.upper)

    def stand(self) -> None:
        """Stays where it is."""
        self.goal = self.q.copy()

    def step(self, dt: float) -> None:
        """Moves on by dt [s]."""
        step = (1.0 - np.exp(-dt / LAG_S)) * (self.goal - self.q)
        step = np.clip(step, -SPEED * dt, SPEED * dt)
        self.q, self.v = self.q + step, step / dt

    def state(self, gate: SlaveGate) -> CsaUp:
        """What goes up."""
        pose = self.pose
        up = CsaUp(homed=True, state=CsaSlaveState.ENABLED, hold=gate.hold, engagement=gate.engagement)
        up.position, up.velocity, up.base_T_tip = self.q, self.v, pose
        up.tip_twist = np.asarray(self.psm.jacobian(self.q)) @ self.v
        height, stiffness = self.tissue
        up.has_force = stiffness > 0.0
        up.tip_wrench = np.array([0.0, 0.0, -stiffness * max(0.0, height - pose[2, 3]), 0.0, 0.0, 0.0])  # on the tissue
        return up


def main() -> int:
    """Runs until Ctrl-C."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--listen", default="127.0.0.1:48031")
    parser.add_argument("--platform", default="127.0.0.1:48030")
    parser.add_argument("--key", type=Path)
    parser.add_argument("--rate-hz", type=float, default=100.0)
    parser.add_argument("--timeout-s", type=float, default=0.1, help="silence after which it holds")
    parser.add_argument("--tissue-height-m", type=float, default=0.0)
    parser.add_argument("--tissue-stiffness-N-m", dest="stiffness", type=float, default=0.0)
    wanted = parser.parse_args()
    try:
        keys = load(wanted.key) if wanted.key else None
        gate = SlaveGate(GateConfig(joint_reach=REACH, timeout_s=wanted.timeout_s))
        link = SlaveLink(Address.parse(wanted.listen, "listen"), Address.parse(wanted.platform, "platform"), keys=keys)
    except Error as error:
        print(f"udp_slave: {error}", file=sys.stderr)
        return 2
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    arm = Arm((wanted.tissue_height_m, wanted.stiffness))
    print(f"6 joints, listens on {link.address}", flush=True)
    dt, due_s, told = 1.0 / wanted.rate_hz, time.monotonic(), gate.hold
    try:
        while True:
            down = link.poll(time.monotonic_ns())
            if down is not None and gate.take(down, arm.q, arm.pose, time.monotonic_ns()):
                try:
                    arm.follow(down)
                except Error as error:  # out of reach of this arm: it stands, and says so
                    gate.refuse(str(error))
            if not gate.check(time.monotonic_ns()):
                arm.stand()
            if gate.hold != told:
                told = gate.hold
                print(f"{told.name} {gate.reason}".rstrip(), flush=True)
            arm.step(dt)
            link.send(arm.state(gate), time.monotonic_ns())
            due_s = max(due_s + dt, time.monotonic())  # late: no burst to catch up
            time.sleep(max(0.0, due_s - time.monotonic()))
    except KeyboardInterrupt:
        return 0
    finally:
        link.close()


if __name__ == "__main__":
    sys.exit(main())
