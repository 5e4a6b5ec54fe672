"""A simulated arm that obeys CRTK's commands: measured equals set-point, as in the dVRK's own simulation.

Servo commands act at once, interpolate commands within one command period, move commands along a path bounded in speed
and acceleration, with is_busy while it lasts. What is refused or clipped is told in `take_events`. Positions are
`reference_T_tip`: `reference_T_base` times forward kinematics.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
import numpy.typing as npt

from saras import Error
from saras.crtk.motion import PointToPoint
from saras.crtk.states import StateMachine

Array = npt.NDArray[np.float64]

VELOCITY_HOLD_S = 0.1
"""A velocity command that is not repeated ends after this."""
INTERPOLATE_S = (0.005, 0.1)
"""Bounds of the period that is taken for an interpolated command: the time since the one before."""


@dataclass(frozen=True)
class MotionLimits:
    """(n,) bounds of move commands [rad/s, m/s] and [rad/s², m/s²]."""

    speed: Array
    acceleration: Array


class SimulatedCrtkArm:
    """Kinematics (saras.kinematics.dvrk), a state machine and a path generator.

    q: (n,) where it stands. jaw: (lower, upper) [rad], or None. name: for events.
    """

    def __init__(
        self,
        name: str,
        kinematics: Any,
        q: npt.ArrayLike,
        limits: MotionLimits,
        *,
        jaw: tuple[float, float] | None = None,
        machine: StateMachine | None = None,
    ) -> None:
        self.name, self.kinematics = name, kinematics
        self.machine = machine or StateMachine()
        self.reference_T_base: Array = np.eye(4)
        self.joints = PointToPoint(q, limits.speed, limits.acceleration)
        self.ratios = (1.0, 1.0)
        """Shares of the bounds of speed and acceleration that moves keep."""
        self.effort: Array = np.zeros(len(self.joints.q))
        self.wrench: Array = np.zeros(6)
        self.jaw_limits = jaw
        self.jaw = PointToPoint([0.0], [3.0], [15.0]) if jaw else None
        self.commanded_s = -np.inf
        """When the last motion command was obeyed, on the clock of step()."""
        self.time_s = 0.0
        self._lower, self._upper = np.asarray(kinematics.limits, dtype=float).T
        self._rates: Array | None = None
        self._rates_until_s = 0.0
        self._interpolated_s = -np.inf
        self._interpolating = 0.0
        self._events: list[tuple[str, str]] = []
        self._states = [self._state()]
        self._ends: list[bool] = []
        self._clipped = ""
        self._moves = self._jaw_moves = False

    # ---- what it reports

    def forward(self, q: npt.ArrayLike) -> Array:
        """(4, 4) reference_T_tip."""
        return np.asarray(self.reference_T_base @ self.kinematics.forward(q))

    def take_events(self) -> list[tuple[str, str]]:
        """(level, text) since the last call; level: error, warning, status."""
        events, self._events = self._events, []
        return events

    def take_states(self) -> list[tuple[str, bool, bool]]:
        """(state, is_homed, is_busy) since the last call, in order: each change, and busy anew for each move."""
        states, self._states = self._states, []
        return states

    def take_ends(self) -> list[bool]:
        """Moves that ended since the last call: whether the goal was reached."""
        ends, self._ends = self._ends, []
        return ends

    # ---- what it obeys

    def state_command(self, text: str) -> bool:
        """enable, disable, pause, resume, home, unhome; False when the table refuses it."""
        was_busy = self.machine.is_busy
        try:
            self.machine.command(text)
        except ValueError as error:
            return self.refuse(str(error))
        if was_busy and not self.machine.is_busy:
            self._ends.append(False)
        if not self.machine.ready:
            self.stop()
        self._changed()
        return True

    def command(self, name: str, value: Any = None) -> bool:
        """A motion command by its CRTK name, value (n,) for joints, (4, 4) for poses, (6,) for twists and wrenches.

        False when it is refused; the reason is an event, and nothing has changed.
        """
        try:
            obey = self._obey(name)
            if not self.machine.ready:
                homed = "" if self.machine.is_homed else ", not homed"
                raise ValueError(f"arm is {self.machine.state}{homed}")
            obey(value)
        except (ValueError, Error) as error:
            return self.refuse(f"{name} refused: {error}")
        self.commanded_s = self.time_s
        return True

    def jaw_command(self, name: str, value: npt.ArrayLike) -> bool:
        """servo_jp, move_jp or servo_jf of the jaw, value (1,)."""
        if self.jaw is None or self.jaw_limits is None:
            return self.refuse(f"jaw/{name} refused: {self.name} has no jaw")
        try:
            if not self.machine.ready:
                raise ValueError(f"arm is {self.machine.state}")
            angle = _vector(value, 1)
            lower, upper = self.jaw_limits
            if name == "servo_jp":
                self._tell_clipped("" if lower <= angle[0] <= upper else f"jaw [rad] = {angle[0]:g}")
                self.jaw.put(np.clip(angle, lower, upper))
                self._busy(jaw=False)
            elif name == "move_jp":
                if not lower <= angle[0] <= upper:
                    raise ValueError(f"jaw [rad] = {angle[0]:g}: must be in [{lower:g}, {upper:g}]")
                self.jaw.go(angle)
                self._busy(jaw=True)
            elif name != "servo_jf":
                raise ValueError("no such command")
        except ValueError as error:
            return self.refuse(f"jaw/{name} refused: {error}")
        return True

    def set_ratio(self, value: float, *, speed: bool = True, acceleration: bool = True) -> bool:
        """Share of the bounds, (0, 1], that moves keep which begin from now on; of one of them or of both."""
        if not 0.0 < value <= 1.0:
            return self.refuse(f"trajectory ratio = {value:g} refused: must be in (0, 1]")
        self.ratios = (value if speed else self.ratios[0], value if acceleration else self.ratios[1])
        for motion in (self.joints, self.jaw):
            if motion is not None:
                motion.set_ratios(*self.ratios)
        return True

    def follow(self, q: npt.ArrayLike) -> None:
        """Towards a goal that moves on: what the scripted surgeon does. Clipped to the limits, never busy."""
        if self.machine.ready:
            self.joints.follow(np.clip(np.asarray(q, dtype=float), self._lower, self._upper))

    def stop(self) -> None:
        """Stands where it is."""
        self._rates, self._interpolating = None, 0.0
        self.joints.stop()
        if self.jaw is not None:
            self.jaw.stop()
        self._busy(arm=False, jaw=False)

    def step(self, dt: float) -> None:
        """Moves on by dt [s]."""
        self.time_s += dt
        if not self.machine.ready:
            return
        if self.jaw is not None:
            self.jaw.step(dt)
            if self._jaw_moves and self.jaw.arrived:
                self._busy(jaw=False, reached=True)
        if self._rates is not None:
            if self.time_s > self._rates_until_s:
                self.stop()
            else:
                self._servo_to(self.joints.q + self._rates * dt)
            return
        if self._interpolating > 0.0:
            share = min(1.0, dt / self._interpolating)
            self._interpolating -= dt
            goal = self.joints.goal
            self.joints.q = goal.copy() if share >= 1.0 else self.joints.q + share * (goal - self.joints.q)
            return
        self.joints.step(dt)
        if self._moves and self.joints.arrived:
            self._busy(arm=False, reached=True)

    # ---- commands by name

    def _obey(self, name: str) -> Callable[[Any], None]:
        plain: dict[str, Callable[[Any], None]] = {
            "hold": lambda _: self.stop(),
            "free": lambda _: self.stop(),
            "servo_jv": self._servo_jv,
            "servo_cv": self._servo_cv,
            "servo_jf": self._servo_jf,
            "servo_cf": self._servo_cf,
        }
        if name in plain:
            return plain[name]
        verb, _, what = name.partition("_")
        how = {"servo": self._servo, "interpolate": self._interpolate, "move": self._move}.get(verb)
        if how is None or what not in ("jp", "jr", "cp", "cr"):
            raise ValueError("no such command")
        return lambda value: how(self._joint_goal(what, value, verb), what)

    def _joint_goal(self, what: str, value: Any, verb: str) -> Array:
        """The joints that a command asks for. Relative ones start at the goal of a move, else at the set-point."""
        start = self.joints.goal if verb == "move" else self.joints.q
        if what == "jp":
            return _vector(value, len(start))
        if what == "jr":
            return np.asarray(start + _vector(value, len(start)))
        pose = _pose(value)
        if what == "cr":  # both parts in the axes of the reference frame, about the tip
            now = self.forward(start)
            pose = np.block(
                [[pose[:3, :3] @ now[:3, :3], (now[:3, 3] + pose[:3, 3])[:, None]], [np.zeros((1, 3)), np.ones((1, 1))]]
            )
        base_T_tip = np.linalg.inv(self.reference_T_base) @ pose
        if len(start) == 4:  # an endoscope reaches a point and its roll
            return np.asarray(self.kinematics.inverse(base_T_tip, self.joints.q, np.pi))
        return np.asarray(self.kinematics.inverse(base_T_tip, self.joints.q))

    def _servo(self, q: Array, what: str) -> None:
        self._end_others()
        self._servo_to(q)

    def _servo_to(self, q: Array) -> None:
        self.joints.put(self._clip(q))

    def _clip(self, q: Array) -> Array:
        self._tell_clipped(self.kinematics.limit_violation(q))
        return np.clip(q, self._lower, self._upper)

    def _interpolate(self, q: Array, what: str) -> None:
        since = min(max(self.time_s - self._interpolated_s, INTERPOLATE_S[0]), INTERPOLATE_S[1])
        self._end_others()
        self.joints.goal = self._clip(q)
        self._interpolated_s, self._interpolating = self.time_s, since

    def _move(self, q: Array, what: str) -> None:
        violation = self.kinematics.limit_violation(q)
        if violation:
            raise ValueError(violation)
        self._rates, self._interpolating = None, 0.0
        self.joints.go(np.clip(q, self._lower, self._upper))
        self._busy(arm=True)

    def _servo_jv(self, value: Any) -> None:
        rates = _vector(value, len(self.joints.q))
        self._end_others()
        self._rates, self._rates_until_s = rates, self.time_s + VELOCITY_HOLD_S

    def _servo_cv(self, value: Any) -> None:
        twist = _vector(value, 6)
        rotation = self.reference_T_base[:3, :3].T
        base_twist = np.concatenate([rotation @ twist[:3], rotation @ twist[3:]])
        jacobian = self.kinematics.jacobian(self.joints.q)
        # Damped: near a singularity the joints stay slow instead of following.
        self._servo_jv(jacobian.T @ np.linalg.solve(jacobian @ jacobian.T + 1e-6 * np.eye(6), base_twist))

    def _servo_jf(self, value: Any) -> None:
        self.effort = _vector(value, len(self.joints.q))
        self._end_others()

    def _servo_cf(self, value: Any) -> None:
        self.wrench = _vector(value, 6)
        self._end_others()

    def _end_others(self) -> None:
        self._rates, self._interpolating = None, 0.0
        self.joints.stop()
        self._busy(arm=False)

    # ---- states and events

    def _state(self) -> tuple[str, bool, bool]:
        return self.machine.state, self.machine.is_homed, self.machine.is_busy

    def _busy(self, *, arm: bool | None = None, jaw: bool | None = None, reached: bool = False) -> None:
        """What moves by a move command now; the arm is busy while its joints or its jaw do.

        As in the dVRK each move that begins says busy anew: a client waits for a busy state younger than its command.
        """
        self._moves = self._moves if arm is None else arm
        self._jaw_moves = self._jaw_moves if jaw is None else jaw
        busy = self._moves or self._jaw_moves
        if self.machine.is_busy and not busy:
            self._ends.append(reached)
        if self.machine.is_busy != busy or arm or jaw:
            self.machine.is_busy = busy
            self._changed()

    def _changed(self) -> None:
        self._states.append(self._state())

    def refuse(self, text: str) -> bool:
        """Reports a command that is not obeyed; False."""
        self._events.append(("error", f"{self.name}: {text}"))
        return False

    def _tell_clipped(self, violation: str) -> None:
        """A stream against a limit says so once, until it is free again."""
        joint = violation.split(" = ")[0]
        if joint and joint != self._clipped:
            self._events.append(("warning", f"{self.name}: command clipped to the limits: {violation}"))
        self._clipped = joint


def _vector(value: Any, length: int) -> Array:
    array = np.asarray(value, dtype=float)
    if array.shape != (length,):
        raise ValueError(f"{array.size} values: must be {length}")
    if not np.isfinite(array).all():
        raise ValueError(f"{array.tolist()}: must be finite")
    return array


def _pose(value: Any) -> Array:
    pose = np.asarray(value, dtype=float)
    if pose.shape != (4, 4) or not np.isfinite(pose).all():
        raise ValueError("pose: must be a finite (4, 4) matrix")
    return pose


__all__ = ["MotionLimits", "SimulatedCrtkArm"]
