"""The simulated SARAS arm as a plant: servoed joints (saras.sim.ServoArm) whose tip presses on tissue."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError, KinematicsError
from saras.kinematics import mesa
from saras.mesa_link.fields import MessageError
from saras.mesa_link.plant import ArmSample
from saras.mesa_link.poses import matrix_to_target, to_matrix
from saras.mesa_link.protocol import PASSIVE_JOINTS, MaxVelocity, Reason, Target, Tool, Truth
from saras.sim import ArmMode, ServoArm, ServoArmConfig, Tissue, TissueOutput

PHYSICS_RATE_HZ = 500.0
RCM_SPEED_M_S = 0.02  # a new trocar is approached this fast: the shaft tilts, it does not jump
RCM_DISTANCE_M = 0.03  # a new trocar lies this near to the shaft
_MODES = {"pivot": ArmMode.PIVOT, "parallel": ArmMode.PARALLEL}
_NO_FORCE = np.zeros(3)


class SimulatedArm:
    """An ArmPlant. ``rcm`` (3,) [m, base frame]; ``q`` (6,) start, by default the home position under the trocar;
    ``tissue`` in the base frame, None for free space; ``sensor``: the arm reports the wrench that it exerts.
    """

    def __init__(
        self,
        rcm: Sequence[float],
        *,
        tissue: Tissue | None = None,
        sensor: bool = False,
        servo: ServoArmConfig | None = None,
        q: Sequence[float] | None = None,
        passive: Sequence[float] = (0.0,) * PASSIVE_JOINTS,
        bounds: MaxVelocity | None = None,
    ) -> None:
        if len(passive) != PASSIVE_JOINTS:
            raise ConfigError(f"passive: {PASSIVE_JOINTS} joint values expected, got {len(passive)}")
        self._kinematics = mesa.arm()
        self._servo = ServoArm(servo or ServoArmConfig())
        self._tissue, self._sensor = tissue, sensor
        self._passive = tuple(float(angle) for angle in passive)
        self._rcm = self._rcm_goal = np.array(rcm, dtype=np.float64)
        self._mode = "pivot"
        self._brakes = True
        self._bounds = bounds or MaxVelocity(0.15, 2.0)
        start = mesa.home(self._rcm) if q is None else np.array(q, dtype=np.float64)
        self._servo.reset(start)
        tip = self._kinematics.forward(start)
        self._goal: NDArray[np.float64] = tip[:3, 3].copy()
        self._reference = self._goal.copy()  # what the servo follows: the goal under the speed bound
        self._roll = float(start[5])
        self._roll_override: float | None = None
        self._roll_speed = self._bounds.angular_rad_s
        self._jaw, self._jaw_speed = 0.0, 2.0
        self._reaction: NDArray[np.float64] = _NO_FORCE
        self._contact: TissueOutput | None = None
        self.step(1.0 / PHYSICS_RATE_HZ)

    def follow(self, target: Target) -> None:
        """See ArmPlant. Pivoting, the pose is turned the least so that its shaft passes the trocar."""
        if not self._brakes:
            raise MessageError(Reason.BRAKES_OPEN, "set_target: lock the positioning arm first")
        position = np.array(target.position)
        near = self._servo.state.q_target
        try:
            if self._mode == "parallel":
                self._kinematics.inverse_parallel(position, self._roll, near)
                roll = self._roll
            else:
                pivoted = self._kinematics.pivot_pose(to_matrix(target.position, target.quaternion), self._rcm)
                if pivoted is None:
                    raise MessageError(Reason.UNREACHABLE, "set_target: the tip is too near to the trocar")
                roll = float(self._kinematics.inverse(pivoted, near)[5])
        except KinematicsError as error:
            raise MessageError(Reason.UNREACHABLE, f"set_target: {error}") from error
        self._goal = position
        self._roll = roll if self._roll_override is None else self._roll_override

    def hold(self) -> None:
        """See ArmPlant."""
        self._goal = self._out.base_T_tip[:3, 3].copy()
        self._reference = self._goal.copy()
        self._roll = float(self._out.q[5])

    def move_tool(self, tool: Tool) -> None:
        """See ArmPlant. Speeds of 0 stop the joint."""
        self._jaw, self._jaw_speed = tool.jaw, max(tool.jaw_velocity_1_s, 1e-6)
        self._roll_override = tool.roll_rad
        if tool.roll_rad is not None:
            self._roll = tool.roll_rad
            self._roll_speed = max(tool.roll_velocity_rad_s, 1e-6)
        else:
            self._roll_speed = max(self._bounds.angular_rad_s, 1e-6)

    def set_max_velocity(self, bounds: MaxVelocity) -> None:
        """See ArmPlant."""
        self._bounds = bounds
        self._roll_speed = max(bounds.angular_rad_s, 1e-6)

    def set_rcm(self, position: tuple[float, ...]) -> None:
        """See ArmPlant. UNREACHABLE when it is far from the shaft or the tip cannot stay where it is."""
        trocar = np.array(position)
        distance = self._kinematics.rcm_deviation(self._out.q, trocar)
        if distance > RCM_DISTANCE_M:
            raise MessageError(
                Reason.UNREACHABLE,
                f"set_rcm.position: the shaft passes {1e3 * distance:.1f} mm from it, at most {1e3 * RCM_DISTANCE_M:g}",
            )
        obstacle = self._kinematics.unreachable(self._out.base_T_tip[:3, 3], trocar)
        if obstacle:
            raise MessageError(Reason.UNREACHABLE, f"set_rcm.position: {obstacle}")
        self._rcm_goal = trocar

    def set_mode(self, mode: str) -> None:
        """See ArmPlant."""
        self._mode = mode

    def brake(self, on: bool) -> None:
        """See ArmPlant."""
        self._brakes = on

    def step(self, duration_s: float) -> None:
        """See ArmPlant. The servo's reference is held over ``duration_s``, as the reported target says."""
        self._reference = _toward(self._reference, self._goal, self._bounds.linear_m_s * duration_s)
        self._rcm = _toward(self._rcm, self._rcm_goal, RCM_SPEED_M_S * duration_s)
        substeps = max(1, math.ceil(duration_s * PHYSICS_RATE_HZ - 1e-9))
        dt = duration_s / substeps
        for _ in range(substeps):
            self._out = self._servo.step(
                self._reference,
                self._roll,
                self._rcm,
                self._reaction,
                dt,
                self._jaw,
                self._roll_speed,
                self._jaw_speed,
                _MODES[self._mode],
            )
            if self._tissue is not None:
                self._contact = self._tissue.step(
                    self._out.base_T_tip[:3, 3], self._out.tip_velocity, dt, self._out.trocar_deviation
                )
                self._reaction = -self._contact.wrench[:3]

    def sample(self) -> ArmSample:
        """See ArmPlant."""
        out = self._out
        measured = matrix_to_target(out.measured_base_T_tip)
        wrench = None
        if self._sensor:
            wrench = (0.0,) * 6 if self._contact is None else tuple(self._contact.measured_wrench.tolist())
        return ArmSample(
            joints=tuple(out.measured_q.tolist()),
            joint_velocities=tuple(out.q_rate.tolist()),
            jaw=min(1.0, max(0.0, out.jaw)),
            passive=self._passive,
            position=measured.position,
            quaternion=measured.quaternion,
            rcm=tuple(self._rcm.tolist()),
            mode=self._mode,
            brakes=self._brakes,
            target=matrix_to_target(self._kinematics.forward(self._servo.state.q_target)),
            wrench=wrench,
        )

    def truth(self, tick: int) -> Truth:
        """See ArmPlant. Without tissue the depth is 0 and so is the force."""
        contact = self._contact
        if contact is None:
            return Truth(tick, 0.0, (0.0, 0.0, 0.0), self._out.rcm_deviation_m)
        return Truth(tick, contact.depth, tuple(contact.wrench[:3].tolist()), self._out.rcm_deviation_m)


def _toward(start: NDArray[np.float64], goal: NDArray[np.float64], step_m: float) -> NDArray[np.float64]:
    """From start at most step_m towards goal."""
    way = goal - start
    distance = math.sqrt(float(way @ way))
    return goal if distance <= step_m else start + way * (step_m / distance)
