"""What ``/collision/state`` said over a session."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from saras.recording.bag import Floats, Topic

UNKNOWN, CLEAR, WARNING, COLLISION = range(4)


@dataclass(frozen=True)
class ToolDistances:
    """One tool over time; all arrays are (n,)."""

    name: str
    t: Floats  #: stamp [s]
    state: NDArray[np.int64]  #: UNKNOWN, CLEAR, WARNING, COLLISION
    distance_m: Floats  #: to what was known, negative when overlapping; NaN when nothing was
    partner: list[str]
    slowed: NDArray[np.bool_]  #: whether its speed was bounded below what it may do far from everything
    reason: list[str]

    def seconds_in(self, state: int) -> float:
        """Time spent in a state [s]; each message counts until the next."""
        if len(self.t) < 2:
            return 0.0
        return float(np.diff(self.t)[self.state[:-1] == state].sum())


def tool_distances(topic: Topic | None) -> list[ToolDistances]:
    """One entry a tool, in the order of the messages; empty when the topic was not recorded."""
    if topic is None:
        return []
    messages = topic["tools"]
    names = list(dict.fromkeys(tool.name for tools in messages for tool in tools))
    result = []
    for name in names:
        rows = [(t, tool) for t, tools in zip(topic.t, messages) for tool in tools if tool.name == name]
        tools = [tool for _, tool in rows]
        limit = np.array([tool.approach_speed_limit for tool in tools], dtype=float)
        scale = np.array([tool.max_speed_scale for tool in tools], dtype=float)
        finite = limit[np.isfinite(limit)]
        full = finite.max() if len(finite) else np.inf
        result.append(
            ToolDistances(
                name,
                np.array([t for t, _ in rows]),
                np.array([tool.state for tool in tools], dtype=np.int64),
                np.array([tool.known_distance for tool in tools], dtype=float),
                [tool.partner for tool in tools],
                np.asarray((limit < full) | (scale < 1.0)),
                [tool.reason for tool in tools],
            )
        )
    return result
