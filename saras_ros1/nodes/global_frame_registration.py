"""global_frame_registration: touches and views of the board become base frames.

Services: take, undo, compute, save, status.

It publishes no transform itself: the node `frames` is asked to load what was saved.
"""

from __future__ import annotations

import numpy as np
import rospy
from std_srvs.srv import Trigger, TriggerResponse

from saras import CalibrationError, Error
from saras.calibration.board import Board
from saras.calibration.calibration_file import Calibration
from saras.calibration.registration import Arm, Registration, View
from saras.kinematics import scene as scenes
from saras_ros1 import calibration_services
from saras_ros1.arm_readings import ArmReadings
from saras_ros1.board_camera import BoardCamera
from saras_ros1.node import Node, run
from saras_ros1.srv import (
    LoadCalibration,
    SaveCalibration,
    SaveCalibrationResponse,
    TakeMeasurement,
    TakeMeasurementResponse,
)

ALL_ARMS = {"mesa_left", "mesa_right", "PSM1", "PSM2", "ECM"}


class GlobalFrameRegistration(Node):
    """Holds one Registration. Services block while a measurement lasts."""

    def __init__(self) -> None:
        super().__init__("global_frame_registration")
        scene_file = self.params.text("scene_file")
        board_file = self.params.text("board_file", empty=True)
        self.touch_s = self.params.number("touch_s", 0.05, 5.0)
        place = self.params.section("world_T_board")
        world_T_board = scenes.pose_from_xyz_rpy(
            place.vector("xyz_m", 3, -10.0, 10.0), place.vector("rpy_rad", 3, -2.0 * np.pi, 2.0 * np.pi)
        )
        endoscope = self.params.section("endoscope")
        self.endoscope = endoscope.text("arm", empty=True)
        image_topic, info_topic = endoscope.text("image_topic"), endoscope.text("camera_info_topic")
        hand_eye_file = endoscope.text("hand_eye_file", empty=True)
        scene = scenes.load(scene_file)
        self.readings: dict[str, ArmReadings] = {}
        arms = {}
        section = self.params.section("arms")
        for name in self.params.texts("register"):
            entry = section.section(name)
            frame = entry.text("frame")
            trocar = entry.vector("trocar_m", 3, -1.0, 1.0)
            arms[name] = Arm(name, frame, trocar, scene.world_T(frame), entry.number("max_off_m", 0.0, 10.0))
            topics = entry.text("pose_topic"), entry.text("joints_topic", empty=True)
            self.readings[name] = ArmReadings(name, frame, *topics, entry.texts("joints"))
        for name in ALL_ARMS - set(arms):
            if section.has(name):
                section.skip(name)
        board = Board.load(board_file) if board_file else Board()
        self.registration = Registration(board, world_T_board, arms)
        if hand_eye_file:
            self.registration.gripper_T_camera.update(Calibration.load(hand_eye_file).gripper_T_camera)
        self.camera = BoardCamera(image_topic, info_topic, board)
        self.computed: Calibration | None = None
        rospy.Service("~take", TakeMeasurement, self._on_take)
        rospy.Service("~undo", Trigger, self._on_undo)
        rospy.Service("~compute", Trigger, self._on_compute)
        rospy.Service("~save", SaveCalibration, self._on_save)
        rospy.Service("~status", Trigger, self._on_status)

    def _on_take(self, request) -> TakeMeasurementResponse:
        try:
            if request.arm not in self.readings:
                raise CalibrationError(f"arm = {request.arm!r}: must be one of {', '.join(self.readings)}")
            reading = self.readings[request.arm]
            poses, joints = reading.over(self.touch_s), reading.under_base()
            with self.lock:
                self.computed = None
                if request.dot:
                    self.registration.take_touch(request.arm, request.dot, poses[:, :3, 3], joints)
                else:
                    seen = self.camera.look()
                    view = View(poses[-1], seen.camera_T_board, seen.rms_px)
                    self.registration.take_view(request.arm, view, joints)
                return TakeMeasurementResponse(True, self.registration.status()[request.arm])
        except Error as error:
            return TakeMeasurementResponse(False, str(error))

    def _on_undo(self, _request) -> TriggerResponse:
        return self._answer(lambda: "forgotten: " + self.registration.undo())

    def _on_compute(self, _request) -> TriggerResponse:
        def compute() -> str:
            self.computed = self.registration.compute()
            return "\n".join(f"{name}: {text}" for name, text in self.registration.status().items())

        return self._answer(compute)

    def _on_status(self, _request) -> TriggerResponse:
        return self._answer(lambda: "\n".join(f"{a}: {text}" for a, text in self.registration.status().items()))

    def _answer(self, act) -> TriggerResponse:
        with self.lock:
            return calibration_services.answer(act)

    def _on_save(self, request) -> SaveCalibrationResponse:
        try:
            calibration_services.save(self.computed, request.path, request.force)
        except (Error, OSError) as error:
            return SaveCalibrationResponse(False, str(error))
        try:  # the platform may not run yet: then the launch argument takes the file
            answer = rospy.ServiceProxy("/frames/load_calibration", LoadCalibration)(request.path)
        except rospy.ServiceException:
            return SaveCalibrationResponse(True, f"{request.path}; the node frames does not run: load it at the start")
        return SaveCalibrationResponse(answer.success, f"{request.path}; frames: {answer.message}")

    def report(self) -> dict:
        """One line an arm."""
        with self.lock:
            return self.registration.status()


def main() -> int:
    """Runs the node."""
    return run(GlobalFrameRegistration)
