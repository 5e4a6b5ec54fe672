"""Whether the arm goes where it is sent."""

from __future__ import annotations

from saras import ConfigError


class TrackingWatch:
    """Notices that the arm is further than limit_m [m] from what was sent, at every look for limit_s [s]."""

    def __init__(self, limit_m: float, limit_s: float) -> None:
        for name, value in (("limit_m", limit_m), ("limit_s", limit_s)):
            if not 0.0 < value < float("inf"):
                raise ConfigError(f"{name} = {value}: must be > 0 and finite")
        self._limit_m, self._limit_s = limit_m, limit_s
        self._since_s: float | None = None

    def reset(self) -> None:
        """Forgets what it saw."""
        self._since_s = None

    def step(self, error_m: float, now_s: float) -> str:
        """What is wrong, "" when nothing is. now_s: monotonic. An error that is not finite counts as one too large."""
        if error_m <= self._limit_m:
            self._since_s = None
            return ""
        if self._since_s is None:
            self._since_s = now_s
        if now_s - self._since_s < self._limit_s:
            return ""
        return (
            f"the arm is {1e3 * error_m:.1f} mm from where it was sent for {now_s - self._since_s:.1f} s "
            f"(limits {1e3 * self._limit_m:g} mm, {self._limit_s:g} s)"
        )
