"""The last check on a set-point before it goes to the arm."""

from __future__ import annotations

import numpy as np

from saras import ConfigError, add_delta, displacement


class SetPointLimiter:
    """Steps at most speed · dt towards the set-point; refuses one that is too far away to be a motion.

    speed_m_s, speed_rad_s: largest speed of what is sent; reach_m, reach_rad: a set-point further than this from the
    last one sent is refused. Poses are (4, 4) in one frame.
    """

    def __init__(self, speed_m_s: float, speed_rad_s: float, reach_m: float, reach_rad: float, dt_max_s: float) -> None:
        limits = {
            "speed_m_s": speed_m_s,
            "speed_rad_s": speed_rad_s,
            "reach_m": reach_m,
            "reach_rad": reach_rad,
            "dt_max_s": dt_max_s,
        }
        for name, value in limits.items():
            if not 0.0 < value < np.inf:
                raise ConfigError(f"{name} = {value}: must be > 0 and finite")
        self._speed = (speed_m_s, speed_rad_s)
        self._reach = (reach_m, reach_rad)
        self._dt_max_s = dt_max_s
        self.last: np.ndarray | None = None
        self.limited = 0

    def start(self, measured: np.ndarray) -> None:
        """The next step goes from the measured pose."""
        self.last = measured

    def step(self, set_point: np.ndarray, dt: float) -> np.ndarray:
        """What to send; ValueError when the set-point is out of reach. dt [s] since the last step, monotonic."""
        delta = displacement(self.last, set_point)
        sizes = (float(np.linalg.norm(delta[:3])), float(np.linalg.norm(delta[3:])))
        if sizes[0] > self._reach[0] or sizes[1] > self._reach[1]:
            raise ValueError(
                f"set-point {1e3 * sizes[0]:.1f} mm and {sizes[1]:.3f} rad from the last one sent, "
                f"limits {1e3 * self._reach[0]:g} mm and {self._reach[1]:g} rad"
            )
        dt = min(max(dt, 0.0), self._dt_max_s)
        part = min([1.0] + [speed * dt / size for speed, size in zip(self._speed, sizes) if size > 0.0])
        if part < 1.0:
            self.limited += 1
            set_point = add_delta(self.last, delta, part)
        self.last = set_point
        return set_point
