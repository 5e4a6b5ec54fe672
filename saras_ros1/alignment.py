"""Whether the hand is ready for an engagement, so that it begins without the arm doing anything.

Places and rotations need no alignment: they are referenced anew at each engagement, and the jaw waits for the clip to
come by (tool_command). But a hand that moves would take the arm along at once.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from saras.kinematics import simball

#: Two poses of the hand that are further apart than this [s] say nothing about its speed.
GAP_LIMIT_S = 0.5


class HandSpeed:
    """Speed [m/s] of the handle from the joints of its Simball; NaN: not known."""

    def __init__(self) -> None:
        self._handle = simball.handle()
        self._position: npt.NDArray[np.float64] | None = None
        self._at_ns = 0
        self.m_s = math.nan

    def update(self, joints: npt.ArrayLike, stamp_ns: int) -> None:
        """joints: (4,) of one message, stamp_ns: when they were."""
        position = self._handle.forward(np.asarray(joints, dtype=float))[:3, 3]
        dt = 1e-9 * (stamp_ns - self._at_ns)
        if self._position is not None and 0.0 < dt < GAP_LIMIT_S:
            self.m_s = float(np.linalg.norm(position - self._position)) / dt
        else:
            self.m_s = math.nan
        self._position, self._at_ns = position, stamp_ns


def misalignment(hand_m_s: float, limit_m_s: float) -> str:
    """What to do before an engagement; "" when all is well. hand_m_s: speed of the handle, NaN when not known."""
    if not math.isfinite(hand_m_s):
        return "the speed of the hand is not known: check the console"
    if hand_m_s > limit_m_s:
        return f"hold the hand still: it moves at {1e3 * hand_m_s:.0f} mm/s (limit {1e3 * limit_m_s:.0f})"
    return ""
