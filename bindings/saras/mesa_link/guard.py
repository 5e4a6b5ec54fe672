"""Is what the arm reports worth believing? Silence is seen by its age; this looks at the content."""

from __future__ import annotations

import math
from dataclasses import dataclass

from saras import ConfigError
from saras.mesa_link.driver import Received
from saras.mesa_link.protocol import State


@dataclass(frozen=True)
class StateGuardConfig:
    """Limits of :class:`StateGuard`."""

    lag_limit_s: float = 0.10  # a state that comes later than this is backlog
    frozen_after_s: float = 0.10  # unchanged while a target is followed
    idle_frozen_after_s: float = 0.50  # unchanged while the arm holds: heartbeats are slower than targets
    frozen_target_m: float = 0.002  # the target moved this far and the joints did not change
    jump_limit_m: float = 0.05  # between two states
    settle_s: float = 1.0  # after a jump the new place must stand this long before it is believed

    def __post_init__(self) -> None:
        for name in self.__dict__:
            value = getattr(self, name)
            if not 0.0 < value <= 10.0:
                raise ConfigError(f"StateGuardConfig.{name}: {value} is not in (0, 10]")


class StateGuard:
    """``check`` passes a state or raises ValueError saying what is wrong with it.

    Two ways to be frozen. Nothing changes, not even the count of commands taken, though someone is in control: that
    count rises with every target and heartbeat, so a living arm cannot look like this. Or the target moves and
    the joints do not change by one bit.
    """

    def __init__(self, config: StateGuardConfig) -> None:
        self._config = config
        self._last: State | None = None
        self._changed_s = 0.0  # arm time of the last change of anything
        self._still_since: tuple[float, tuple[float, ...]] = (
            0.0,
            (0.0, 0.0, 0.0),
        )  # arm time and target when the joints last changed
        self._jumped_s: float | None = None
        self._jump_m = 0.0

    def check(self, received: Received) -> State:
        """The state, or ValueError."""
        state, last = received.state, self._last
        if last is not None and state.tick == last.tick:
            raise ValueError(f"frozen: tick {state.tick} again")
        if received.lag_s > self._config.lag_limit_s:
            raise ValueError(f"the state comes {1e3 * received.lag_s:.0f} ms late (backlog)")
        restarted = last is None or state.tick < last.tick
        if restarted or last is None or _content(state) != _content(last) or state.session == 0:
            self._changed_s = state.time_s
        if restarted or last is None or state.joints != last.joints:
            self._still_since = (state.time_s, state.target.position)
        self._notice_jump(state, None if restarted else last)
        self._last = state
        if state.fault:
            raise ValueError(f"the arm reports a fault: {state.fault}")
        self._check_frozen(state)
        if self._jumped_s is not None:
            raise ValueError(f"the tip jumped {1e3 * self._jump_m:.0f} mm between two states")
        return state

    def _check_frozen(self, state: State) -> None:
        config = self._config
        unchanged_s = state.time_s - self._changed_s
        if unchanged_s > (config.frozen_after_s if state.following else config.idle_frozen_after_s):
            raise ValueError(f"frozen: nothing changed for {1e3 * unchanged_s:.0f} ms while the arm is in use")
        still_s = state.time_s - self._still_since[0]
        moved_m = math.dist(state.target.position, self._still_since[1])
        if state.following and still_s > config.frozen_after_s and moved_m > config.frozen_target_m:
            raise ValueError(f"frozen: joints unchanged for {1e3 * still_s:.0f} ms, their target moved")

    def _notice_jump(self, state: State, last: State | None) -> None:
        moved_m = 0.0 if last is None else math.dist(state.position, last.position)
        if moved_m > self._config.jump_limit_m:
            self._jumped_s, self._jump_m = state.time_s, moved_m
        elif self._jumped_s is not None and not 0.0 <= state.time_s - self._jumped_s < self._config.settle_s:
            self._jumped_s = None


def _content(state: State) -> tuple[object, ...]:
    return state.joints, state.joint_velocities, state.position, state.quaternion, state.wrench, state.last_seq
