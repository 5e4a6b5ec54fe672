"""The last check on a set-point before it goes to the arm: reach, speed, acceleration."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from saras import ConfigError, add_delta, displacement

Array = npt.NDArray[np.float64]


class SetPointLimiter:
    """Steps towards the set-point within speed and acceleration; refuses one that is too far away to be a motion.

    speed_m_s, speed_rad_s, acceleration_m_s2, acceleration_rad_s2: largest of what is sent; reach_m, reach_rad: a
    set-point further than this from the last one sent is refused. A set-point that moves within these is sent as it
    is; one that was lost is caught up with so that what is sent brakes in time (the discrete stopping speed). Poses are
    (4, 4) in one frame, translation and rotation are bounded each by itself.
    """

    def __init__(
        self,
        speed_m_s: float,
        speed_rad_s: float,
        acceleration_m_s2: float,
        acceleration_rad_s2: float,
        reach_m: float,
        reach_rad: float,
        dt_max_s: float,
    ) -> None:
        limits = {
            "speed_m_s": speed_m_s,
            "speed_rad_s": speed_rad_s,
            "acceleration_m_s2": acceleration_m_s2,
            "acceleration_rad_s2": acceleration_rad_s2,
            "reach_m": reach_m,
            "reach_rad": reach_rad,
            "dt_max_s": dt_max_s,
        }
        for name, value in limits.items():
            if not 0.0 < value < np.inf:
                raise ConfigError(f"{name} = {value}: must be > 0 and finite")
        self._bounds = ((speed_m_s, acceleration_m_s2), (speed_rad_s, acceleration_rad_s2))
        self._reach = (reach_m, reach_rad)
        self._dt_max_s = dt_max_s
        self._velocity = (np.zeros(3), np.zeros(3))
        self.last: Array | None = None
        self._asked: Array | None = None
        self.limited = 0

    def start(self, measured: Array) -> None:
        """The next step goes from the measured pose, from rest."""
        self.last = self._asked = measured
        self._velocity = (np.zeros(3), np.zeros(3))

    def step(self, set_point: Array, dt: float) -> Array:
        """What to send; ValueError when the set-point is not finite or out of reach.

        dt [s] since the last step, monotonic; one beyond dt_max_s counts as that, none or less moves nothing.
        """
        if not np.isfinite(set_point).all():
            raise ValueError("set-point is not finite")
        assert self.last is not None and self._asked is not None, "start() comes first"
        delta = displacement(self.last, set_point)
        sizes = (float(np.linalg.norm(delta[:3])), float(np.linalg.norm(delta[3:])))
        if sizes[0] > self._reach[0] or sizes[1] > self._reach[1]:
            raise ValueError(
                f"set-point {1e3 * sizes[0]:.1f} mm and {sizes[1]:.3f} rad from the last one sent, "
                f"limits {1e3 * self._reach[0]:g} mm and {self._reach[1]:g} rad"
            )
        dt = min(dt, self._dt_max_s)
        if not dt > 0.0:
            return self.last
        asked_velocity = displacement(self._asked, set_point) / dt
        self._asked = set_point
        linear, angular = self._bounds
        self._velocity = (
            _towards(delta[:3], asked_velocity[:3], self._velocity[0], *linear, dt),
            _towards(delta[3:], asked_velocity[3:], self._velocity[1], *angular, dt),
        )
        sent = np.concatenate(self._velocity)
        if np.linalg.norm(sent * dt - delta) <= 1e-12:
            self.last = set_point
        else:
            self.limited += 1
            self.last = add_delta(self.last, sent, dt)
        return self.last


def _towards(delta: Array, target: Array, before: Array, speed: float, acceleration: float, dt: float) -> Array:
    """Velocity of this step; |velocity| <= speed and |velocity - before| <= acceleration dt, in every case.

    delta: way to the set-point; target: its own velocity; before: velocity of the last step.
    """
    change_limit = acceleration * dt
    if np.linalg.norm(target) > speed:  # a jump and no motion
        target = np.zeros(3)
    behind = delta / dt - target
    size = float(np.linalg.norm(behind))
    if size > 0.0:
        # The largest speed from which steps of falling speed end where they should: in units of a dt^2 the steps
        # v, v - 1, ... add up to (n + 1) (v - n / 2) with n = floor(v).
        way = size / change_limit
        n = math.floor(math.sqrt(0.25 + 2.0 * way) - 0.5)
        behind = behind * (change_limit * (way / (n + 1) + 0.5 * n) / size)
    wanted = _within(target + behind, speed)
    return before + _within(wanted - before, change_limit)


def _within(vector: Array, limit: float) -> Array:
    size = float(np.linalg.norm(vector))
    return vector if size <= limit else vector * (limit / size)
