"""colliding_regions: how near the tools are to each other and to the forbidden regions, and what that allows."""

from __future__ import annotations

import numpy as np
import rospy
from std_msgs.msg import Float64MultiArray, MultiArrayDimension
from visualization_msgs.msg import MarkerArray

from saras.collision import Partner, ProximityMonitor
from saras_ros1 import collision_markers
from saras_ros1.channel import SIDES
from saras_ros1.collision_markers import NAMES
from saras_ros1.collision_messages import tool_message
from saras_ros1.collision_scene import CollisionScene
from saras_ros1.collision_tools import WORLD
from saras_ros1.msg import CollisionState
from saras_ros1.node import Node, Tick, run

# The order of /collision/distances, from the source document.
FIRST_FOUR = ("mesa_left", "mesa_right", "PSM1", "PSM2")


class CollidingRegions(Node):
    """Steps on the tools' poses; when they are silent, on its own timer: what is lost must become unknown in time."""

    def __init__(self) -> None:
        super().__init__("colliding_regions")
        period_s = self.params.number("period_s", 0.001, 0.1)
        self.state_every = self.params.integer("state_every", 1, 100)
        markers_hz = self.params.number("markers_hz", 1.0, 60.0)
        self.scene = CollisionScene(self, self.params, SIDES)
        self.tools, self.regions = self.scene.tools, self.scene.regions
        arguments = (self.scene.config, len(self.tools), self.regions.vertices)
        self.monitor = self.law("proximity_monitor", ProximityMonitor, *arguments)

        self.distances = self.output("/collision/distances", Float64MultiArray)
        self.state_out = self.output("/collision/state", CollisionState)
        self.markers = self.output("/collision/markers", MarkerArray)
        self.last = CollisionState()
        self.shown: tuple[int, ...] = ()
        self.ticks = 0
        primaries = [tool.primary for tool in self.tools if tool.primary is not None]
        self.loop(self.step, primaries, period_s=period_s)
        self.every(1.0 / markers_hz, self._draw)

    def step(self, tick: Tick) -> None:
        """One look at everything."""
        capsules, reasons = self.scene.capsules()
        world_T_regions, regions_reason = self.scene.world_T_regions()
        if regions_reason:
            regions_reason = f"regions: {regions_reason}"
        out = self.monitor.step(
            tools=capsules, dt=tick.dt, base_T_regions=world_T_regions, regions_known=not regions_reason
        )
        self._publish(out.tools, capsules, reasons, regions_reason)

    def _publish(self, results: list, capsules: np.ndarray, reasons: list[str], regions_reason: str) -> None:
        names = [tool.name for tool in self.tools]
        known = {name: result.distance_m for name, result in zip(names, results)}
        order = [*FIRST_FOUR, *(name for name in names if name not in FIRST_FOUR)]
        message = Float64MultiArray(data=[known.get(name, float("nan")) for name in order])
        message.layout.dim = [MultiArrayDimension(",".join(order), len(order), len(order))]
        self.distances.publish(message)

        self.ticks += 1
        states = tuple(int(result.state.value) for result in results)
        if self.ticks % self.state_every and states == self.shown:
            return
        self.shown = states
        state = CollisionState()
        state.header.stamp, state.header.frame_id = rospy.Time.now(), WORLD
        for i, result in enumerate(results):
            others = [reasons[j] for j in range(len(reasons)) if j != i and reasons[j]]
            why = [text for text in (reasons[i], *others, regions_reason) if text]
            state.tools.append(tool_message(names[i], result, capsules[i], self._partner(result), "; ".join(why)))
        self.state_out.publish(state)
        self.last = state

    def _partner(self, result) -> str:
        if result.partner == Partner.TOOL:
            return self.tools[result.partner_index].name
        return self.regions.names[result.partner_index] if result.partner == Partner.REGION else ""

    def _draw(self) -> None:
        if self.markers.get_num_connections():
            with self.lock:
                state = self.last
            self.markers.publish(collision_markers.of(state, self.regions.vertices, self.scene.regions_frame))

    def report(self) -> dict:
        """State, distance and reason a tool."""
        with self.lock:
            tools = self.last.tools
        return {
            tool.name: f"{NAMES[tool.state]} {1e3 * tool.distance:.1f} mm {tool.partner} {tool.reason}"
            for tool in tools
        }


def main() -> int:
    """Runs the node."""
    return run(CollidingRegions)
