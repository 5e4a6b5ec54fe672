"""colliding_regions: how near the tools are to each other and to the forbidden regions, and what that allows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rospy
from std_msgs.msg import Float64MultiArray, MultiArrayDimension
from visualization_msgs.msg import MarkerArray

from saras import ConfigError, Error
from saras.collision import ForbiddenRegions, Partner, ProximityMonitor, ProximityMonitorConfig
from saras_ros1 import collision_markers
from saras_ros1.channel import SIDES
from saras_ros1.collision_markers import NAMES
from saras_ros1.collision_messages import tool_message
from saras_ros1.collision_tools import WORLD, DvrkTool, MesaTool, UnknownToolError
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.msg import CollisionState
from saras_ros1.node import Node, Tick, run

NO_REGIONS = "none"  # to be said: a forgotten file must not look like a patient without bones
# The order of /collision/distances, from the source document.
FIRST_FOUR = ("mesa_left", "mesa_right", "PSM1", "PSM2")


class CollidingRegions(Node):
    """Steps on the tools' poses; when they are silent, on its own timer: what is lost must become unknown in time."""

    def __init__(self) -> None:
        super().__init__("colliding_regions")
        period_s = self.params.number("period_s", 0.001, 0.1)
        arm_timeout_s = self.params.number("arm_timeout_s", 0.005, 1.0)
        self.frames = LiveFrames(self.params.number("transform_timeout_s", 0.005, 1.0))
        self.state_every = self.params.integer("state_every", 1, 100)
        markers_hz = self.params.number("markers_hz", 1.0, 60.0)
        self.marker_frame = self.params.text("regions_frame")
        self.regions = self._load_regions()
        config = self.params.build(ProximityMonitorConfig, "law")
        self.tools = self._tools(arm_timeout_s)
        self.monitor = self.law("proximity_monitor", ProximityMonitor, config, len(self.tools), self.regions.vertices)

        self.distances = self.output("/collision/distances", Float64MultiArray)
        self.state_out = self.output("/collision/state", CollisionState)
        self.markers = self.output("/collision/markers", MarkerArray)
        self.last = CollisionState()
        self.shown: tuple[int, ...] = ()
        self.ticks = 0
        primaries = [tool.primary for tool in self.tools if tool.primary is not None]
        self.loop(self.step, primaries, period_s=period_s)
        self.every(1.0 / markers_hz, self._draw)

    def _load_regions(self) -> ForbiddenRegions:
        path = self.params.text("regions_file")
        scale = self.params.number("regions_scale", 1e-9, 1e9)
        rotation = self.params.vector("regions_rotation", 9, -1.0, 1.0).reshape(3, 3)
        offset_m = self.params.vector("regions_offset_m", 3)
        if path == NO_REGIONS:
            rospy.logwarn(f"regions_file = {NO_REGIONS}: no forbidden region is watched")
            return ForbiddenRegions((), np.zeros((0, 8, 3)))
        if not Path(path).is_absolute():  # roslaunch starts nodes in a directory of its own
            raise ConfigError(f"regions_file = {path!r}: must be an absolute path, or {NO_REGIONS}")
        try:
            return ForbiddenRegions.load(path, scale, rotation, offset_m)
        except OSError as error:
            raise Error(f"regions_file: {error}") from None

    def _tools(self, timeout_s: float) -> list[MesaTool | DvrkTool]:
        mesa, dvrk = self.params.section("mesa"), self.params.section("dvrk")
        radius_m = mesa.number("radius_m", 0.0, 0.1)
        tools: list[MesaTool | DvrkTool] = [MesaTool(self, side, radius_m, timeout_s) for side in SIDES]
        radius_m, endoscope_radius_m = dvrk.number("radius_m", 0.0, 0.1), dvrk.number("endoscope_radius_m", 0.0, 0.1)
        options = {
            "timeout_s": timeout_s,
            "frame_override": dvrk.text("frame_override", empty=True),
            "require_state": dvrk.flag("require_state"),
        }
        for name in dvrk.texts("arms"):
            radius = endoscope_radius_m if name.startswith("ECM") else radius_m
            tools.append(DvrkTool(self, name, radius, **options))
        return tools

    def step(self, tick: Tick) -> None:
        """One look at everything."""
        capsules, reasons = np.full((len(self.tools), 7), np.nan), [""] * len(self.tools)
        for i, tool in enumerate(self.tools):
            try:
                tip, trocar = tool.ends(self.frames)
            except (UnknownToolError, UnknownFrameError) as error:
                reasons[i] = f"{tool.name}: {error}"
            else:
                capsules[i, :3], capsules[i, 3:6], capsules[i, 6] = tip, trocar, tool.radius_m
        world_T_regions, regions_reason = np.eye(4), ""
        if len(self.regions):
            try:
                world_T_regions = self.frames.fresh(WORLD, self.marker_frame)
            except UnknownFrameError as error:
                regions_reason = f"regions: {error}"
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
            self.markers.publish(collision_markers.of(state, self.regions.vertices, self.marker_frame))

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
