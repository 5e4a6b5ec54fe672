"""Tools among forbidden regions: who is nearest to whom."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Union

import numpy as np
import numpy.typing as npt

from saras._core import collision as _core
from saras.collision.forbidden_regions import ForbiddenRegions

Tool = Union["_core.Capsule", tuple[npt.ArrayLike, npt.ArrayLike, float], None]
"""(a (3,), b (3,), radius) [m], a Capsule, or None: not known now."""


class Scene:
    """Any number of tools and regions. Broad phase and distances run in C++.

    tools: a Tool each. regions: ForbiddenRegions or (n, 8, 3) vertices [m] in their own frame.
    base_T_regions: (4, 4) from there to the frame of the tools. Raises ConfigError naming the region.
    """

    def __init__(
        self,
        tools: Sequence[Tool],
        regions: ForbiddenRegions | npt.ArrayLike = (),
        base_T_regions: npt.ArrayLike | None = None,
    ) -> None:
        vertices = regions.vertices if isinstance(regions, ForbiddenRegions) else regions
        self.region_names = regions.names if isinstance(regions, ForbiddenRegions) else None
        self._tools = list(tools)
        self._base_T_regions = np.eye(4) if base_T_regions is None else np.asarray(base_T_regions, dtype=float)
        self._scene = _core.Scene(len(self._tools), vertices)

    def distances(
        self,
        tools: Sequence[Tool] | None = None,
        base_T_regions: npt.ArrayLike | None = None,
        *,
        regions_known: bool = True,
    ) -> list[_core.ToolDistance]:
        """One ToolDistance a tool: to the nearest known thing, with witnesses, and what is not known.

        What is not given stays as it was. regions_known: False while base_T_regions is missing or too old.
        """
        if tools is not None:
            if len(tools) != len(self._tools):
                raise ValueError(f"tools: expected {len(self._tools)}, got {len(tools)}")
            self._tools = list(tools)
        if base_T_regions is not None:
            self._base_T_regions = np.asarray(base_T_regions, dtype=float)
        return list(self._scene.distances(self._tools, self._base_T_regions, regions_known))

    @property
    def regions(self) -> int:
        """How many regions there are."""
        return int(self._scene.regions)
