"""A hand-eye calibration while it is made: views of the board taken one by one, and what they say so far."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

import saras
from saras import CalibrationError
from saras.calibration.camera import BoardView
from saras.calibration.hand_eye import HandEye, hand_eye, rotation_spread

Array = npt.NDArray[np.float64]

#: Fewer views give a calibration that the next step would have to believe.
LEAST_VIEWS = 8
#: From so many on each view is answered with what is known by now.
TELLING_VIEWS = 5
LEAST_TURN_RAD = 0.02


class HandEyeSession:
    """Pairs of the gripper's pose in the arm's base and the board's pose before the camera."""

    def __init__(self) -> None:
        self.pairs: list[tuple[Array, BoardView]] = []
        self.result: HandEye | None = None

    def take(self, base_T_gripper: Array, seen: BoardView) -> str:
        """Adds a view; says how it fits. Raises CalibrationError when the arm has hardly turned since another view."""
        for number, (before, _) in enumerate(self.pairs, start=1):
            turn = float(np.linalg.norm(saras.displacement(before, base_T_gripper)[3:]))
            if turn < LEAST_TURN_RAD:
                raise CalibrationError(
                    f"turned by {np.rad2deg(turn):.1f} deg only since view {number}: must be >= "
                    f"{np.rad2deg(LEAST_TURN_RAD):.1f} deg"
                )
        self.pairs.append((base_T_gripper, seen))
        self.result = None
        return f"markers {' '.join(map(str, seen.marker_ids))}, corners fit to {seen.rms_px:.2f} px; {self.status()}"

    def undo(self) -> str:
        """Forgets the last view. Raises CalibrationError when there is none."""
        if not self.pairs:
            raise CalibrationError("views = 0: nothing to undo")
        self.pairs.pop()
        self.result = None
        return f"view {len(self.pairs) + 1}"

    def clear(self) -> None:
        """Forgets all views."""
        self.pairs.clear()
        self.result = None

    def status(self) -> str:
        """One line: views, how far they are turned apart, and from a few on how well the camera is known."""
        if not self.pairs:
            return "nothing taken"
        spread = np.rad2deg(rotation_spread([gripper for gripper, _ in self.pairs]))
        line = f"{len(self.pairs)} views, rotation spread {spread[0]:.0f}, {spread[1]:.0f} deg"
        if len(self.pairs) < TELLING_VIEWS:
            return line
        try:
            found = self._solved()
        except CalibrationError as error:
            return f"{line}; not yet: {error}"
        return f"{line}; {describe(found)}"

    def compute(self) -> HandEye:
        """Solves and keeps it as `result`. Raises CalibrationError when the views are too few or too much alike."""
        if len(self.pairs) < LEAST_VIEWS:
            raise CalibrationError(f"views = {len(self.pairs)}: must be >= {LEAST_VIEWS}")
        self.result = self._solved()
        return self.result

    def _solved(self) -> HandEye:
        grippers = np.array([gripper for gripper, _ in self.pairs])
        return hand_eye(grippers, np.array([seen.camera_T_board for _, seen in self.pairs]))


def describe(found: HandEye) -> str:
    """One line: how well the camera's place is known, the residual, and which views were left out."""
    std = np.sqrt(np.diag(found.covariance))
    left_out = [str(i) for i, used in enumerate(found.used, start=1) if not used]
    return (
        f"camera known to {1e3 * np.linalg.norm(std[:3]):.2f} mm, {np.rad2deg(np.linalg.norm(std[3:])):.3f} deg, "
        f"residual {1e3 * found.rms_m:.2f} mm" + (f", views left out: {', '.join(left_out)}" if left_out else "")
    )


__all__ = ["LEAST_VIEWS", "HandEyeSession", "describe"]
