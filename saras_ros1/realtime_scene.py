"""What the real-time loop needs to take the distances itself: regions, other tools and the arms' bases.

The loop knows its own arms' tips first; colliding_regions, beside it, is for the displays and the record.
"""

from __future__ import annotations

import numpy as np

from saras import ConfigError
from saras.pipeline import DistancesConfig, SceneInput
from saras.runtime import TeleopHost
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.collision_scene import CollisionScene
from saras_ros1.node import Node
from saras_ros1.params import Params

SECTION = "/colliding_regions"
MAX_OTHER_TOOLS = 6


class RealtimeScene:
    """Its configuration at the start, then its newest state into the loop's mailbox, as often as update() is called."""

    def __init__(self, node: Node, params: Params) -> None:
        """params: of colliding_regions. Raises ConfigError naming key, value and bound."""
        self.period_s = params.number("period_s", 0.001, 0.1)
        params.skip("state_every")
        params.skip("markers_hz")
        self._scene = CollisionScene(node, params, ())
        params.finish()
        if len(self._scene.tools) > MAX_OTHER_TOOLS:
            names = [tool.name for tool in self._scene.tools]
            raise ConfigError(f"{SECTION}/dvrk/arms = {names}: must be at most {MAX_OTHER_TOOLS} in hosting realtime")
        self.reasons: list[str] = []

    def config(self) -> DistancesConfig:
        """For PipelineConfig.distances."""
        scene = self._scene
        return DistancesConfig(
            enabled=True,
            monitor=scene.config,
            radius_m=scene.mesa_radius_m,
            other_tools=len(scene.tools),
            regions=scene.regions.vertices,
            scene_timeout_s=scene.arm_timeout_s,
        )

    def update(self, host: TeleopHost) -> None:
        """One look. What is unknown stays so in the loop: it slows the tools down."""
        capsules, reasons = self._scene.capsules()
        world_T_regions, unknown_regions = self._scene.world_T_regions()
        reasons.append(f"regions: {unknown_regions}" if unknown_regions else "")
        known: dict[str, np.ndarray | bool] = {}
        for side in SIDES:
            known[f"{side}_world_T_base"], why = self._scene.world_T(base_frame(side))
            known[f"{side}_base_known"] = not why
            reasons.append(f"mesa_{side}: {why}" if why else "")
        self.reasons = [reason for reason in reasons if reason]
        host.set_scene(
            SceneInput(
                others=list(capsules), regions_known=not unknown_regions, world_T_regions=world_T_regions, **known
            )
        )
