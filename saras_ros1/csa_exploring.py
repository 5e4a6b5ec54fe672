"""The tip goes to where the modeler wants to touch next: an offset across the surface, beside what the hand does."""

from __future__ import annotations

import numpy as np


class Exploring:
    """Moves an offset at a bounded speed towards the spot, and back to nothing when it is off."""

    def __init__(self, speed_m_s: float) -> None:
        self.speed_m_s = speed_m_s
        self.offset = np.zeros(3)

    def step(self, desired: np.ndarray, target: np.ndarray | None, normal: np.ndarray, dt: float) -> np.ndarray:
        """(3,) offset for a hand's desired tip (3,); target (3,) or None: back; normal (3,) zero: stays."""
        if np.linalg.norm(normal) < 0.5:
            return self.offset
        wanted = np.zeros(3) if target is None else target - desired
        wanted = wanted - normal * (normal @ wanted)
        step = wanted - self.offset
        length = float(np.linalg.norm(step))
        self.offset = self.offset + step * min(1.0, self.speed_m_s * dt / max(length, 1e-12))
        return self.offset
