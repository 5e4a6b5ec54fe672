"""ProximityMonitor's result as a message."""

from __future__ import annotations

from typing import Any

import numpy as np
from geometry_msgs.msg import Point, Vector3

from saras_ros1.msg import ToolCollision


def tool_message(name: str, result: Any, capsule: np.ndarray, partner: str, reason: str) -> ToolCollision:
    """result: saras.collision.ToolProximity; capsule: (7,) tip, trocar, radius [m], NaN when unknown."""
    known = result.known
    numbers = capsule.tolist()
    return ToolCollision(
        name,
        int(result.state.value),
        reason,
        result.distance_m,
        partner,
        known.distance,
        Point(*known.point_a),
        Point(*known.point_b),
        Vector3(*known.normal),
        Point(*numbers[:3]),
        Point(*numbers[3:6]),
        numbers[6],
        result.max_speed_scale,
        result.approach_speed_limit_m_s,
    )
