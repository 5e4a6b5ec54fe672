"""tank_master: the shared store of energy. It reduces what transparency wants to do to the hands.

It bills no port: UDP lies between here and the handles, so the port guards in the console bill them and exchange
joules with this tank by the ledgers. Their damping is local, this one's is zero.
"""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import TwistStamped, WrenchStamped

from saras.teleop import EnergyTankConfig
from saras_ros1 import convert
from saras_ros1.channel import SIDES, Channel, base_frame
from saras_ros1.node import Node, Tick, run
from saras_ros1.tank import Peer, Tank


class TankMaster(Node):
    """Channels in the order of SIDES; desired = wrench on the hand, conjugate = handle twist, both in arm base axes."""

    def __init__(self) -> None:
        super().__init__("tank_master")
        period_s = self.params.number("period_s", 0.001, 0.1)
        timeout_s = self.params.number("input_timeout_s", 0.005, 1.0)
        peer_timeout_s = self.params.number("peer_timeout_s", 0.005, 2.0)
        self.tank = Tank(self, "tank_master", self.params.build(EnergyTankConfig, "tank"), len(SIDES))
        self.params.finish()
        self.channels = [Channel(self, side) for side in SIDES]
        self.desired, self.twists, self.outputs = [], [], []
        for side in SIDES:
            wrench = convert.in_frame(base_frame(side), convert.wrench)
            twist = convert.in_frame(base_frame(side), convert.twist)
            desired = f"/transparency/{side}/desired_wrench"
            self.desired.append(self.input(desired, WrenchStamped, wrench, timeout_s=timeout_s))
            handle_twist = f"/tf_transformer_{side}/handle_twist"
            self.twists.append(self.input(handle_twist, TwistStamped, twist, timeout_s=timeout_s))
            self.outputs.append(self.output(f"/tank_master/{side}/wrench", WrenchStamped))
        session = self.tank.session
        self.tank.peers = [
            Peer(self, f"/port_guard_{side}/exchange", f"/tank_master/port_{side}/exchange", session, peer_timeout_s)
            for side in SIDES
        ]
        self.tank.peers.append(Peer(self, "/tank_slave/exchange", "/tank_master/exchange", session, peer_timeout_s))
        self.status = None
        self.loop(self.step, self.desired, period_s=period_s)

    def step(self, tick: Tick) -> None:
        """Both sides in one step; a side whose inputs are silent gets zero, and costs the other nothing."""
        if any([channel.newly_engaged() for channel in self.channels]):
            self.tank.grant_charge()
        n = len(SIDES)
        desired, twist = np.zeros((n, 6)), np.zeros((n, 6))
        live = [d.fresh and t.fresh for d, t in zip(self.desired, self.twists)]
        for i in range(n):
            if live[i]:
                desired[i], twist[i] = self.desired[i].value, self.twists[i].value
        stale = tick.stale or not any(live)
        out = self.tank.step(tick, desired=desired, conjugate=twist, work_J=0.0, stale=stale)
        self.status = out.status.name
        for i, side in enumerate(SIDES):
            self.outputs[i].publish(convert.wrench_msg(out.applied[i], base_frame(side), tick.stamp_ns))

    def report(self) -> dict:
        """Level and law status."""
        return {"status": self.status, "energy_J": round(self.tank.law.state.energy_J, 4)}


def main() -> int:
    """Runs the node."""
    return run(TankMaster)
