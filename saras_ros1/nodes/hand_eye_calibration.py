"""hand_eye_calibration: where a camera sits on an arm, from views of the board. Eye in hand.

Services: take, undo, compute, save, status. Topic ~image_markers: the live image with the markers that are seen.
"""

from __future__ import annotations

from datetime import datetime, timezone

import numpy as np
import rospy
from std_srvs.srv import Trigger, TriggerResponse

import saras
from saras import CalibrationError, Error
from saras.calibration.board import Board
from saras.calibration.calibration_file import Calibration
from saras.calibration.hand_eye_session import HandEyeSession, describe
from saras_ros1 import calibration_services
from saras_ros1.arm_readings import ArmReadings
from saras_ros1.board_camera import BoardCamera
from saras_ros1.node import Node, run
from saras_ros1.srv import SaveCalibration, SaveCalibrationResponse

STILL_M, STILL_RAD = 0.0005, 0.005


class HandEyeCalibration(Node):
    """Holds one HandEyeSession. take blocks while the arm is read."""

    def __init__(self) -> None:
        super().__init__("hand_eye_calibration")
        self.arm = self.params.text("arm")
        board_file = self.params.text("board_file", empty=True)
        self.still_s = self.params.number("still_s", 0.05, 5.0)
        frame, pose_topic = self.params.text("frame"), self.params.text("pose_topic")
        image_topic, info_topic = self.params.text("image_topic"), self.params.text("camera_info_topic")
        show_hz = self.params.number("show_hz", 0.1, 30.0)
        self.params.finish()
        self.board = Board.load(board_file) if board_file else Board()
        self.session = HandEyeSession()
        self.reading = ArmReadings(self.arm, frame, pose_topic, "", [])
        self.camera = BoardCamera(image_topic, info_topic, self.board, rospy.resolve_name("~image_markers"))
        rospy.Service("~take", Trigger, self._on_take)
        rospy.Service("~undo", Trigger, lambda _: self._answer(lambda: "forgotten: " + self.session.undo()))
        rospy.Service("~compute", Trigger, lambda _: self._answer(lambda: describe(self.session.compute())))
        rospy.Service("~status", Trigger, lambda _: self._answer(self.session.status))
        rospy.Service("~save", SaveCalibration, self._on_save)
        self.every(1.0 / show_hz, lambda: self.camera.show(self._line()))

    def _line(self) -> str:
        with self.lock:
            return f"{len(self.session.pairs)} views taken"

    def _answer(self, act) -> TriggerResponse:
        with self.lock:
            return calibration_services.answer(act)

    def _on_take(self, _request) -> TriggerResponse:
        # Without the lock: the picture goes on while the arm is read.
        try:
            before = self.camera.look()
            poses = self.reading.over(self.still_s)
            seen = self.camera.look()
            self._check_still(poses)
        except Error as error:
            return TriggerResponse(False, str(error))
        moved_m = float(np.linalg.norm(before.camera_T_board[:3, 3] - seen.camera_T_board[:3, 3]))
        if moved_m > 10.0 * STILL_M:
            return TriggerResponse(False, f"the board moved by {1e3 * moved_m:.1f} mm in the image: hold still")
        return self._answer(lambda: self.session.take(poses[-1], seen))

    @staticmethod
    def _check_still(poses: np.ndarray) -> None:
        off = saras.displacement(poses[0], poses[-1])
        moved_m, turned_rad = float(np.linalg.norm(off[:3])), float(np.linalg.norm(off[3:]))
        if moved_m > STILL_M or turned_rad > STILL_RAD:
            raise CalibrationError(
                f"the arm moved by {1e3 * moved_m:.2f} mm, {np.rad2deg(turned_rad):.2f} deg: must be <= "
                f"{1e3 * STILL_M:.1f} mm, {np.rad2deg(STILL_RAD):.1f} deg; hold still"
            )

    def _on_save(self, request) -> SaveCalibrationResponse:
        try:
            with self.lock:
                found = self.session.result
                computed = None
                if found is not None:
                    now = datetime.now(timezone.utc)
                    computed = Calibration(self.board.hash, now, {}, {self.arm: found.gripper_T_camera})
                calibration_services.save(computed, request.path, request.force)
        except (Error, OSError) as error:
            return SaveCalibrationResponse(False, str(error))
        return SaveCalibrationResponse(True, f"{request.path}: hand_eye_file of global_frame_registration")

    def report(self) -> dict:
        """What was taken."""
        with self.lock:
            return {"views": len(self.session.pairs), "computed": self.session.result is not None}


def main() -> int:
    """Runs the node."""
    return run(HandEyeCalibration)
