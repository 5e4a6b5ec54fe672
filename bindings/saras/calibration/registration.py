"""global_frame_registration: from touches and views of one board to the base frames of all arms in world.

Holds what was taken; takes, undoes, computes. Nodes and the guided procedure are coats over it.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime, timezone

import numpy as np
import numpy.typing as npt

import saras
from saras import CalibrationError
from saras._core.calibration import FrameFromPoints, frame_from_points
from saras.calibration.board import Board
from saras.calibration.calibration_file import BaseFrame, Calibration

Array = npt.NDArray[np.float64]

#: The tip trembles by no more than this while a touch is taken [m].
STILL_M = 1e-3
#: Touches of one dot further apart than this contradict each other [m].
SAME_DOT_M = 5e-3
#: Arms whose bases are exchanged for one another most easily.
LOOK_ALIKES = (("mesa_left", "mesa_right"), ("PSM1", "PSM2"))


@dataclass(frozen=True)
class Arm:
    """An arm to be registered."""

    name: str
    frame: str
    """Name of its base frame."""
    trocar: Array
    """(3,) in its base frame [m]: lies on the printed side of the board."""
    expected_world_T_base: Array
    """(4, 4) rough, from the scene file: finds left for right."""
    max_off_m: float = 0.5
    """Refused when the base is further from where it is expected [m]."""


@dataclass(frozen=True)
class View:
    """The board as the endoscope sees it."""

    base_T_gripper: Array
    camera_T_board: Array
    rms_px: float


@dataclass
class Registration:
    """What was taken so far. Methods raise CalibrationError with the reason, and then nothing has changed."""

    board: Board
    world_T_board: Array
    """(4, 4) where the board lies: this is what defines world."""
    arms: Mapping[str, Arm]
    gripper_T_camera: dict[str, Array] = field(default_factory=dict)
    camera_covariance: dict[str, Array] = field(default_factory=dict)
    """(6, 6) of gripper_T_camera, as hand_eye gives it; all views share that error."""
    touches: dict[str, list[tuple[int, Array]]] = field(default_factory=dict)
    """By arm: (dot from 1, tip (3,) in the arm's base frame)."""
    views: dict[str, list[View]] = field(default_factory=dict)
    joints: dict[str, dict[str, float]] = field(default_factory=dict)
    _log: list[tuple[str, str]] = field(default_factory=list)

    def take_touch(
        self, arm: str, dot: int, tips: npt.ArrayLike, joints_rad: Mapping[str, float] | None = None
    ) -> None:
        """Dot `dot` (from 1) touched. tips: (n, 3) readings of the tip while it rests on the dot, in the arm's base."""
        self._known(arm)
        readings = np.atleast_2d(np.asarray(tips, dtype=float))
        if not 1 <= dot <= len(self.board.dots):
            raise CalibrationError(f"dot = {dot}: must be in [1, {len(self.board.dots)}]")
        if readings.ndim != 2 or readings.shape[1] != 3 or not np.isfinite(readings).all():
            raise CalibrationError(f"{arm}: tip readings must be finite, (n, 3)")
        tip = readings.mean(axis=0)
        tremble = float(np.linalg.norm(readings - tip, axis=1).max())
        if tremble > STILL_M:
            raise CalibrationError(f"{arm}: the tip moved by {1e3 * tremble:.2g} mm: must be <= {1e3 * STILL_M:g} mm")
        for other, before in self.touches.get(arm, []):
            apart = float(np.linalg.norm(tip - before))
            if other == dot and apart > SAME_DOT_M:
                raise CalibrationError(
                    f"{arm}: dot {dot} is {1e3 * apart:.1f} mm from where it was touched before: "
                    f"must be <= {1e3 * SAME_DOT_M:g} mm; has something moved?"
                )
            least = float(np.linalg.norm(self.board.dots[dot - 1] - self.board.dots[other - 1]))
            if other != dot and apart < 0.5 * least:
                raise CalibrationError(
                    f"{arm}: dots {dot} and {other} are {1e3 * apart:.1f} mm apart, {1e3 * least:.1f} mm on the board: "
                    "the wrong dot?"
                )
        self._same_joints(arm, joints_rad)
        self.touches.setdefault(arm, []).append((dot, tip))
        self._log.append(("touch", arm))

    def take_view(self, arm: str, view: View, joints_rad: Mapping[str, float] | None = None) -> None:
        """The endoscope `arm` sees the board's markers. Needs its hand-eye calibration."""
        self._known(arm)
        if arm not in self.gripper_T_camera:
            raise CalibrationError(f"{arm}: no hand-eye calibration: make it first")
        for number, before in enumerate(self.views.get(arm, []), start=1):
            apart = saras.displacement(before.base_T_gripper, view.base_T_gripper)
            if np.linalg.norm(apart[:3]) < 5e-3 and np.linalg.norm(apart[3:]) < 0.02:
                raise CalibrationError(f"{arm}: the same pose as view {number}: move the endoscope")
        self._same_joints(arm, joints_rad)
        self.views.setdefault(arm, []).append(view)
        self._log.append(("view", arm))

    def undo(self) -> str:
        """Forgets the last touch or view; says which."""
        if not self._log:
            raise CalibrationError("nothing was taken yet")
        kind, arm = self._log.pop()
        if kind == "view":
            self.views[arm].pop()
        else:
            dot, _ = self.touches[arm].pop()
            kind = f"touch of dot {dot}"
        if not self.touches.get(arm) and not self.views.get(arm):
            self.joints.pop(arm, None)
        return f"{kind} of {arm}" if kind == "view" else f"{kind} by {arm}"

    def clear(self, arm: str) -> None:
        """Forgets all of one arm."""
        self.touches.pop(arm, None)
        self.views.pop(arm, None)
        self.joints.pop(arm, None)
        self._log = [entry for entry in self._log if entry[1] != arm]

    def fit(self, arm: str) -> FrameFromPoints:
        """The board in the arm's base frame from its touches."""
        taken = self.touches.get(arm, [])
        tips = np.array([tip for _, tip in taken]).reshape(-1, 3)
        dots = self.board.dots[[dot - 1 for dot, _ in taken]].reshape(-1, 3)
        try:
            return frame_from_points(tips, dots, above=self._known(arm).trocar)
        except CalibrationError as error:
            raise CalibrationError(f"{arm}: {error}") from None

    def base_frame(self, arm: str) -> BaseFrame:
        """world_T_base of one arm, checked against where it is expected."""
        known = self._known(arm)
        if self.views.get(arm):
            base_T_board, covariance, rms_m, count = self._from_views(arm)
            method = "markers"
        else:
            found = self.fit(arm)
            base_T_board, covariance, rms_m = found.base_T_board, found.covariance, found.rms_m
            count, method = len(self.touches[arm]), "dots"
        world_T_base = self.world_T_board @ np.linalg.inv(base_T_board)
        self._expected(known, world_T_base)
        # At the base's own origin: an error of rotation moves it by its distance from the board.
        to_base = np.eye(6)
        to_base[:3, 3:] = _cross(base_T_board[:3, 3])
        covariance = to_base @ covariance @ to_base.T
        std = np.sqrt(np.maximum(0.0, [np.linalg.eigvalsh(covariance[i : i + 3, i : i + 3])[-1] for i in (0, 3)]))
        return BaseFrame(
            parent="world",
            parent_T_frame=world_T_base,
            std_m=float(std[0]),
            std_rad=float(std[1]),
            rms_m=rms_m,
            measurements=count,
            method=method,
            joints_rad=dict(self.joints.get(arm, {})),
        )

    def compute(self, stamp: datetime | None = None) -> Calibration:
        """All arms. stamp: default the clock."""
        frames = {arm.frame: self.base_frame(name) for name, arm in self.arms.items()}
        return Calibration(self.board.hash, stamp or datetime.now(timezone.utc), frames, dict(self.gripper_T_camera))

    def status(self) -> dict[str, str]:
        """One line an arm: what was taken, and what a fit says."""
        return {name: self._status(name) for name in self.arms}

    def _status(self, arm: str) -> str:
        views, touches = len(self.views.get(arm, [])), [dot for dot, _ in self.touches.get(arm, [])]
        if not views and not touches:
            return "nothing taken"
        what = f"{views} views" if views else "dots " + " ".join(map(str, touches))
        try:
            frame = self.base_frame(arm)
        except CalibrationError as error:
            return f"{what}: {error}"
        return f"{what}: residual {1e3 * frame.rms_m:.2f} mm, known to {1e3 * frame.std_m:.2f} mm"

    def _known(self, arm: str) -> Arm:
        if arm not in self.arms:
            raise CalibrationError(f"arm = {arm!r}: must be one of {', '.join(self.arms)}")
        return self.arms[arm]

    def _same_joints(self, arm: str, joints_rad: Mapping[str, float] | None) -> None:
        if joints_rad is None:
            return
        before = self.joints.get(arm)
        for name, value in (before or {}).items():
            moved = abs(joints_rad.get(name, np.nan) - value)
            if not moved <= JOINT_TOLERANCE_RAD:
                raise CalibrationError(
                    f"{arm}: {name} moved by {np.rad2deg(moved):.2f} deg since the first measurement: "
                    f"must be <= {np.rad2deg(JOINT_TOLERANCE_RAD):.2f} deg; begin this arm anew"
                )
        if before is None:
            self.joints[arm] = {name: float(value) for name, value in joints_rad.items()}

    def _from_views(self, arm: str) -> tuple[Array, Array, float, int]:
        """Mean over the views: the translation's mean, the rotation's by its logarithm about the first view's."""
        views = self.views[arm]
        if len(views) < 3:
            raise CalibrationError(f"{arm}: views = {len(views)}: must be >= 3")
        camera = self.gripper_T_camera[arm]
        said = [view.base_T_gripper @ camera @ view.camera_T_board for view in views]
        mean = said[len(said) // 2]
        for _ in range(5):
            mean = saras.add_delta(mean, np.mean([saras.displacement(mean, one) for one in said], axis=0), 1.0)
        off = np.array([saras.displacement(mean, one) for one in said])
        rms_m = float(np.sqrt((off[:, :3] ** 2).sum(axis=1).mean()))
        worst = int(np.argmax(np.linalg.norm(off[:, :3], axis=1)))
        if rms_m > MAX_VIEW_RMS_M:
            raise CalibrationError(
                f"{arm}: the views disagree about the board by {1e3 * rms_m:.1f} mm rms: must be <= "
                f"{1e3 * MAX_VIEW_RMS_M:g} mm; worst is view {worst + 1}: hand-eye wrong, or the board moved"
            )
        height = -(np.linalg.inv(mean)[:3, :3] @ (mean[:3, 3] - self.arms[arm].trocar))[2]
        if height <= 0.0:
            raise CalibrationError(
                f"{arm}: board seen from behind: its remote centre is {1e3 * height:.0f} mm above it"
            )
        covariance = off.T @ off / (len(views) - 1) / len(views)
        if arm in self.camera_covariance:
            shared = np.mean([_of_camera(view, camera) for view in views], axis=0)
            covariance += shared @ self.camera_covariance[arm] @ shared.T
        return mean, covariance, rms_m, len(views)

    def _expected(self, arm: Arm, world_T_base: Array) -> None:
        off = float(np.linalg.norm((world_T_base - arm.expected_world_T_base)[:3, 3]))
        for pair in LOOK_ALIKES:
            other = self.arms.get(pair[1 - pair.index(arm.name)]) if arm.name in pair else None
            if other is None:
                continue
            other_off = float(np.linalg.norm((world_T_base - other.expected_world_T_base)[:3, 3]))
            if other_off < 0.5 * off:
                raise CalibrationError(
                    f"{arm.name}: its base is {1e3 * off:.0f} mm from where it is expected and "
                    f"{1e3 * other_off:.0f} mm from {other.name}'s place: left for right?"
                )
        if off > arm.max_off_m:
            raise CalibrationError(
                f"{arm.name}: its base is {1e3 * off:.0f} mm from where the scene expects it: "
                f"must be <= {1e3 * arm.max_off_m:.0f} mm; is the board where world_T_board says, turned that way?"
            )


def _cross(vector: Array) -> Array:
    x, y, z = vector
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def _of_camera(view: View, gripper_T_camera: Array) -> Array:
    """(6, 6): how an error of gripper_T_camera, in the gripper's axes, moves base_T_board, in the base's axes."""
    turn = view.base_T_gripper[:3, :3]
    lever = (gripper_T_camera @ view.camera_T_board)[:3, 3] - gripper_T_camera[:3, 3]
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = matrix[3:, 3:] = turn
    matrix[:3, 3:] = -turn @ _cross(lever)
    return matrix


#: A positioning or set-up joint that moved by more makes its arm's base frame unknown [rad].
JOINT_TOLERANCE_RAD = 2e-3
#: Views of the board that disagree by more are refused [m].
MAX_VIEW_RMS_M = 5e-3

__all__ = ["JOINT_TOLERANCE_RAD", "Arm", "Registration", "View"]
