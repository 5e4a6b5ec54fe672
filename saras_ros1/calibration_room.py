"""The real room of a calibration: board, arms and endoscope as config/calibration.yaml names them, read over topics."""

from __future__ import annotations

import numpy as np

from saras import CalibrationError
from saras.calibration.board import Board
from saras.calibration.calibration_file import Calibration
from saras.calibration.camera import BoardView
from saras.calibration.registration import Arm
from saras.kinematics import scene as scenes
from saras_ros1.arm_readings import ArmReadings
from saras_ros1.board_camera import BoardCamera
from saras_ros1.params import Params

ALL_ARMS = {"mesa_left", "mesa_right", "PSM1", "PSM2", "ECM"}
#: poses that the guided procedure asks of the endoscope
VIEWS = 12


class CalibrationRoom:
    """What the procedures ask of the room (saras.calibration.guided.Room). A measurement lasts `touch_s`."""

    def __init__(self, params: Params, scene_file: str) -> None:
        """params: of global_frame_registration; scene_file: where the bases are expected, roughly."""
        board_file = params.text("board_file", empty=True)
        self.board = Board.load(board_file) if board_file else Board()
        self.touch_s = params.number("touch_s", 0.05, 5.0)
        place = params.section("world_T_board")
        self.world_T_board = scenes.pose_from_xyz_rpy(
            place.vector("xyz_m", 3, -10.0, 10.0), place.vector("rpy_rad", 3, -2.0 * np.pi, 2.0 * np.pi)
        )
        endoscope = params.section("endoscope")
        self.endoscope = endoscope.text("arm", empty=True)
        self.camera = BoardCamera(endoscope.text("image_topic"), endoscope.text("camera_info_topic"), self.board)
        hand_eye_file = endoscope.text("hand_eye_file", empty=True)
        self.gripper_T_camera = Calibration.load(hand_eye_file).gripper_T_camera if hand_eye_file else {}
        self.arms: dict[str, Arm] = {}
        self.readings: dict[str, ArmReadings] = {}
        self._read_arms(params, scenes.load(scene_file))

    def _read_arms(self, params: Params, scene: scenes.Scene) -> None:
        section = params.section("arms")
        for name in params.texts("register"):
            entry = section.section(name)
            frame = entry.text("frame")
            trocar = entry.vector("trocar_m", 3, -1.0, 1.0)
            self.arms[name] = Arm(name, frame, trocar, scene.world_T(frame), entry.number("max_off_m", 0.0, 10.0))
            topics = entry.text("pose_topic"), entry.text("joints_topic", empty=True)
            self.readings[name] = ArmReadings(name, frame, *topics, entry.texts("joints"))
        for name in ALL_ARMS - set(self.arms):
            if section.has(name):
                section.skip(name)

    @property
    def views(self) -> int:
        """How many poses the endoscope is asked to take."""
        return VIEWS

    def reachable_dots(self, _arm: str) -> list[int]:
        """All: who stands beside the arm knows better, and skips."""
        return list(range(1, len(self.board.dots) + 1))

    def poses(self, arm: str) -> np.ndarray:
        """(n, 4, 4) base_T_tip of the next moment. Raises CalibrationError."""
        if arm not in self.readings:
            raise CalibrationError(f"arm = {arm!r}: must be one of {', '.join(self.readings)}")
        return self.readings[arm].over(self.touch_s)

    def touch(self, arm: str, _dot: int) -> np.ndarray:
        """(n, 3) readings of the tip while it rests on the dot."""
        return self.poses(arm)[:, :3, 3]

    def see(self, _view: int) -> tuple[np.ndarray, BoardView]:
        """base_T_gripper of the endoscope and the board in its image, now."""
        return self.poses(self.endoscope)[-1], self.camera.look()

    def joints_rad(self, arm: str) -> dict[str, float]:
        """Joints under the base; empty: this arm has none that are read."""
        return self.readings[arm].under_base() or {}
