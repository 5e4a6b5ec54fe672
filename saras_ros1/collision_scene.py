"""Everything that tools can meet, as the parameters of colliding_regions name it: regions, tools, and their places."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rospy

from saras import ConfigError, Error
from saras.collision import ForbiddenRegions, ProximityMonitorConfig
from saras_ros1.collision_tools import WORLD, DvrkTool, MesaTool, UnknownToolError
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.node import Node
from saras_ros1.params import Params

NO_REGIONS = "none"  # to be said: a forgotten file must not look like a patient without bones


class CollisionScene:
    """Reads /colliding_regions' parameters but for those of its own topics, and then follows frames and arms.

    sides: of the SARAS arms whose places are looked up too; they come first among the tools.
    """

    def __init__(self, node: Node, params: Params, sides: tuple[str, ...]) -> None:
        self.arm_timeout_s = params.number("arm_timeout_s", 0.005, 1.0)
        self.frames = LiveFrames(params.number("transform_timeout_s", 0.005, 1.0))
        self.regions_frame = params.text("regions_frame")
        self.regions = _load_regions(params)
        self.config: ProximityMonitorConfig = params.build(ProximityMonitorConfig, "law")
        self.mesa_radius_m = params.section("mesa").number("radius_m", 0.0, 0.1)
        self.tools: list[MesaTool | DvrkTool] = [
            MesaTool(node, side, self.mesa_radius_m, self.arm_timeout_s) for side in sides
        ]
        self.tools += _dvrk_tools(node, params.section("dvrk"), self.arm_timeout_s)

    def capsules(self) -> tuple[np.ndarray, list[str]]:
        """(n, 7) tip, trocar, radius of each tool in the world [m], NaN where unknown; and why, "" where known."""
        capsules, reasons = np.full((len(self.tools), 7), np.nan), [""] * len(self.tools)
        for i, tool in enumerate(self.tools):
            try:
                tip, trocar = tool.ends(self.frames)
            except (UnknownToolError, UnknownFrameError) as error:
                reasons[i] = f"{tool.name}: {error}"
            else:
                capsules[i, :3], capsules[i, 3:6], capsules[i, 6] = tip, trocar, tool.radius_m
        return capsules, reasons

    def world_T_regions(self) -> tuple[np.ndarray, str]:
        """(4, 4), and why it is unknown: "" when it is known, or when there are no regions."""
        return self.world_T(self.regions_frame) if len(self.regions) else (np.eye(4), "")

    def world_T(self, frame: str) -> tuple[np.ndarray, str]:
        """(4, 4), and why it is unknown: "" when it is known."""
        try:
            return self.frames.fresh(WORLD, frame), ""
        except UnknownFrameError as error:
            return np.eye(4), str(error)


def _load_regions(params: Params) -> ForbiddenRegions:
    path = params.text("regions_file")
    scale = params.number("regions_scale", 1e-9, 1e9)
    rotation = params.vector("regions_rotation", 9, -1.0, 1.0).reshape(3, 3)
    offset_m = params.vector("regions_offset_m", 3)
    if path == NO_REGIONS:
        rospy.logwarn(f"regions_file = {NO_REGIONS}: no forbidden region is watched")
        return ForbiddenRegions((), np.zeros((0, 8, 3)))
    if not Path(path).is_absolute():  # roslaunch starts nodes in a directory of its own
        raise ConfigError(f"regions_file = {path!r}: must be an absolute path, or {NO_REGIONS}")
    try:
        return ForbiddenRegions.load(path, scale, rotation, offset_m)
    except OSError as error:
        raise Error(f"regions_file: {error}") from None


def _dvrk_tools(node: Node, params: Params, timeout_s: float) -> list[DvrkTool]:
    radius_m, endoscope_radius_m = params.number("radius_m", 0.0, 0.1), params.number("endoscope_radius_m", 0.0, 0.1)
    options = {
        "timeout_s": timeout_s,
        "frame_override": params.text("frame_override", empty=True),
        "require_state": params.flag("require_state"),
    }
    return [
        DvrkTool(node, name, endoscope_radius_m if name.startswith("ECM") else radius_m, **options)
        for name in params.texts("arms")
    ]
