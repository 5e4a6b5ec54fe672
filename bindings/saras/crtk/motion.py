"""Point-to-point motion of several joints, bounded in speed and acceleration."""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


class PointToPoint:
    """Joints that go to a goal, from any position and speed, and all arrive together when they begin at rest.

    speed, acceleration: (n,) bounds [rad/s, m/s and their rates]. q (n,) where it begins.
    """

    def __init__(self, q: npt.ArrayLike, speed: npt.ArrayLike, acceleration: npt.ArrayLike) -> None:
        self.q: Array = np.array(q, dtype=float)
        self.v: Array = np.zeros_like(self.q)
        self.goal: Array = self.q.copy()
        self._full_speed: Array = np.array(speed, dtype=float)
        self._full_acceleration: Array = np.array(acceleration, dtype=float)
        self._speed_bound, self._acceleration_bound = self._full_speed, self._full_acceleration
        self._speed, self._acceleration = self._speed_bound, self._acceleration_bound

    @property
    def arrived(self) -> bool:
        """Whether it stands at the goal."""
        return bool((self.q == self.goal).all()) and not self.v.any()

    def go(self, goal: npt.ArrayLike) -> None:
        """A new goal (n,). From rest all joints share the profile of the slowest: a straight line in joint space."""
        self.goal = np.array(goal, dtype=float)
        self._speed, self._acceleration = self._speed_bound, self._acceleration_bound
        distance = np.abs(self.goal - self.q)
        moving = distance > 0.0
        if moving.any() and not self.v.any():  # already moving: each as its own bounds let it
            self._speed = distance * float((self._speed_bound[moving] / distance[moving]).min())
            self._acceleration = distance * float((self._acceleration_bound[moving] / distance[moving]).min())

    def set_ratios(self, speed: float, acceleration: float) -> None:
        """Shares of the bounds, (0, 1], that goals of go() keep from now on."""
        self._speed_bound, self._acceleration_bound = speed * self._full_speed, acceleration * self._full_acceleration

    def follow(self, goal: npt.ArrayLike) -> None:
        """The same for a goal that moves on with each step: full bounds for all joints, whatever the ratios."""
        self.goal = np.array(goal, dtype=float)
        self._speed, self._acceleration = self._full_speed, self._full_acceleration

    def put(self, q: npt.ArrayLike) -> None:
        """Stands at q (n,) at once."""
        self.q = np.array(q, dtype=float)
        self.goal, self.v = self.q.copy(), np.zeros_like(self.q)

    def step(self, dt: float) -> None:
        """Moves on by dt [s]: to the goal as fast as the bounds let it come to rest there."""
        if dt <= 0.0 or self.arrived:
            return
        # Plain numbers: for six joints numpy's calls cost three times as much.
        q, v = self.q.tolist(), self.v.tolist()
        bounds = zip(self.goal.tolist(), self._speed.tolist(), self._acceleration.tolist())
        for i, (goal, speed, acceleration) in enumerate(bounds):
            way, a_dt = goal - q[i], acceleration * dt
            length = abs(way)
            if length <= a_dt * dt and abs(v[i]) <= a_dt:
                q[i], v[i] = goal, 0.0
                continue
            # The largest speed s with s·dt + s²/(2a) ≤ |way|: it can still brake from there.
            most = min(math.sqrt(a_dt * a_dt + 2.0 * acceleration * length) - a_dt, speed, length / dt)
            v[i] += min(max(math.copysign(most, way) - v[i], -a_dt), a_dt)
            q[i] += v[i] * dt
        self.q, self.v = np.array(q), np.array(v)

    def stop(self) -> None:
        """Stands where it is."""
        self.put(self.q)


__all__ = ["PointToPoint"]
