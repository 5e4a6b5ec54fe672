"""tank_slave: bounds what the arms may do to the tissue by the energy at hand.

Port: the tool tips. Billed is the mean wrench exerted on the tissue times the measured displacement of the tip.
"""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import TwistStamped

from saras import displacement
from saras.teleop import EnergyTankConfig
from saras_ros1 import convert
from saras_ros1.arm_inputs import ArmInputs
from saras_ros1.channel import SIDES, Channel, base_frame
from saras_ros1.node import Node, Tick, run
from saras_ros1.tank import Peer, Tank


class Port:
    """One tip: mean wrench, displacement and work since the last tick."""

    def __init__(self, node: Node, side: str, timeout_s: float) -> None:
        self.arm = ArmInputs(node, side, timeout_s, wrench=True)
        self._last: tuple[np.ndarray, np.ndarray] | None = None
        self.wrench, self.twist, self.work_J = np.zeros(6), np.zeros(6), 0.0

    def update(self, dt: float) -> bool:
        """False when pose or wrench are unknown: nothing can be billed, so nothing may be commanded."""
        wrench = self.arm.exerted_wrench
        known = self.arm.pose.fresh and np.isfinite(wrench).all()
        now = (self.arm.pose.value, wrench) if known else None
        last, self._last = self._last, now
        self.wrench, self.twist, self.work_J = np.zeros(6), np.zeros(6), 0.0
        if last is None or now is None:
            return False
        moved = displacement(last[0], now[0])
        self.wrench = 0.5 * (last[1] + now[1])
        self.work_J = float(self.wrench @ moved)
        self.twist = moved / dt
        return True


class TankSlave(Node):
    """Channels in the order of SIDES; desired = twist of the tip, conjugate = wrench exerted on the tissue."""

    def __init__(self) -> None:
        super().__init__("tank_slave")
        period_s = self.params.number("period_s", 0.001, 0.1)
        timeout_s = self.params.number("input_timeout_s", 0.005, 1.0)
        arm_timeout_s = self.params.number("arm_timeout_s", 0.005, 1.0)
        peer_timeout_s = self.params.number("peer_timeout_s", 0.005, 2.0)
        self.tank = Tank(self, "tank_slave", self.params.build(EnergyTankConfig, "tank"), len(SIDES))
        self.params.finish()
        self.channels = [Channel(self, side) for side in SIDES]
        self.ports = [Port(self, side, arm_timeout_s) for side in SIDES]
        self.desired, self.outputs = [], []
        for side in SIDES:
            twist = convert.in_frame(base_frame(side), convert.twist)
            desired = f"/transparency/{side}/desired_twist"
            self.desired.append(self.input(desired, TwistStamped, twist, timeout_s=timeout_s))
            self.outputs.append(self.output(f"/tank_slave/{side}/twist", TwistStamped))
        peer = Peer(self, "/tank_master/exchange", "/tank_slave/exchange", self.tank.session, peer_timeout_s)
        self.tank.peers = [peer]
        self.status = None
        self.loop(self.step, self.desired, period_s=period_s)

    def step(self, tick: Tick) -> None:
        """Both sides in one step; a side that is not engaged or not known stands still. All work seen is billed."""
        if any([channel.newly_engaged() for channel in self.channels]):
            self.tank.grant_charge()
        n = len(SIDES)
        desired, wrench, twist = np.zeros((n, 6)), np.zeros((n, 6)), np.zeros((n, 6))
        live = [False] * n
        for i, (source, port, channel) in enumerate(zip(self.desired, self.ports, self.channels)):
            known = port.update(tick.dt)
            live[i] = known and source.fresh and channel.engaged
            if live[i]:
                desired[i], wrench[i], twist[i] = source.value, port.wrench, port.twist
        out = self.tank.step(
            tick,
            desired=desired,
            conjugate=wrench,
            measured=twist,
            work_J=sum(port.work_J for port in self.ports),
            stale=tick.stale or not any(live),
        )
        self.status = out.status.name
        for i, side in enumerate(SIDES):
            applied = out.applied[i] if live[i] else np.zeros(6)
            self.outputs[i].publish(convert.twist_msg(applied, base_frame(side), tick.stamp_ns))

    def report(self) -> dict:
        """Level and law status."""
        return {"status": self.status, "energy_J": round(self.tank.law.state.energy_J, 4)}


def main() -> int:
    """Runs the node."""
    return run(TankSlave)
