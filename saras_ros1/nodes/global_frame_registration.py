"""global_frame_registration: touches and views of the board become base frames.

Services: take, undo, compute, save, status.

It publishes no transform itself: the node `frames` is asked to load what was saved.
"""

from __future__ import annotations

import rospy
from std_srvs.srv import Trigger, TriggerResponse

from saras import Error
from saras.calibration.calibration_file import Calibration
from saras.calibration.registration import Registration, View
from saras_ros1 import calibration_services
from saras_ros1.calibration_room import CalibrationRoom
from saras_ros1.node import Node, run
from saras_ros1.srv import (
    LoadCalibration,
    SaveCalibration,
    SaveCalibrationResponse,
    TakeMeasurement,
    TakeMeasurementResponse,
)


class GlobalFrameRegistration(Node):
    """Holds one Registration. Services block while a measurement lasts."""

    def __init__(self) -> None:
        super().__init__("global_frame_registration")
        self.room = CalibrationRoom(self.params, self.params.text("scene_file"))
        self.params.finish()
        self.registration = Registration(self.room.board, self.room.world_T_board, self.room.arms)
        self.registration.gripper_T_camera.update(self.room.gripper_T_camera)
        self.computed: Calibration | None = None
        rospy.Service("~take", TakeMeasurement, self._on_take)
        rospy.Service("~undo", Trigger, self._on_undo)
        rospy.Service("~compute", Trigger, self._on_compute)
        rospy.Service("~save", SaveCalibration, self._on_save)
        rospy.Service("~status", Trigger, self._on_status)

    def _on_take(self, request) -> TakeMeasurementResponse:
        try:
            poses = self.room.poses(request.arm)
            joints = self.room.joints_rad(request.arm) or None
            with self.lock:
                self.computed = None
                if request.dot:
                    self.registration.take_touch(request.arm, request.dot, poses[:, :3, 3], joints)
                else:
                    seen = self.room.camera.look()
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
