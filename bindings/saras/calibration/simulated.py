"""A simulated operating room to calibrate: arms that touch the board with noise, an endoscope that sees its markers.

Truth comes from the scene file. Touches go through the arms' own kinematics (joint readings with noise, plus the hand's
error), views through rendered images and the same detector that real images take.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

import saras
from saras import CalibrationError, KinematicsError
from saras.calibration.board import Board
from saras.calibration.camera import BoardView, Intrinsics, locate_board
from saras.calibration.registration import Arm
from saras.calibration.rendering import BoardPattern, render
from saras.kinematics import dvrk, mesa
from saras.kinematics.scene import Scene, pose_from_xyz_rpy

Array = npt.NDArray[np.float64]

MESA_ARMS = ("mesa_left", "mesa_right")
PSM_ARMS = ("PSM1", "PSM2")
ENDOSCOPE = "ECM"
#: A dot is asked for when the arm could reach so much beyond it [m].
REACH_MARGIN_M = 4e-3


@dataclass(frozen=True)
class Noise:
    """Standard deviations."""

    touch_m: float = 0.5e-3
    """Of a touch, per axis: the hand and the tip's thickness."""
    reading_m: float = 0.05e-3
    """Of one reading of the tip while it rests."""
    encoder_rad: float = 2e-4
    grey: float = 2.0
    """Of the images, of 255."""


def intrinsics() -> Intrinsics:
    """A stereo endoscope's eye, about 70 degrees wide."""
    return Intrinsics(
        np.array([[560.0, 0.0, 322.0], [0.0, 558.0, 243.0], [0.0, 0.0, 1.0]]),
        np.array([-0.22, 0.08, 5e-4, -4e-4, 0.0]),
        640,
        480,
    )


def world_T_board() -> Array:
    """Where the board lies in the simulated room: on a block between the trocars, where each arm reaches four dots."""
    return pose_from_xyz_rpy([-0.01, -0.01, 0.09], [0.0, 0.0, 0.0])


@dataclass
class SimulatedRoom:
    """Everything that a calibration asks the real room, with the truth beside it."""

    scene: Scene
    board: Board = field(default_factory=Board)
    seed: int = 0
    noise: Noise = field(default_factory=Noise)

    def __post_init__(self) -> None:
        self.trocars: dict[str, Array] = {}
        self.rng = np.random.default_rng(self.seed)
        self.world_T_board = world_T_board()
        self.intrinsics = intrinsics()
        # How the camera really sits on the endoscope: a little off the tip, and turned in its holder.
        self.gripper_T_camera = pose_from_xyz_rpy([0.0021, -0.0013, 0.0042], [0.015, -0.022, 0.31])
        self._mesa, self._psm, self._ecm = mesa.arm(), dvrk.psm(), dvrk.ecm()
        self.trocars = {name: self._calibration_trocar(name) for name in MESA_ARMS}
        self._view_joints = self._plan_views()

    @property
    def arms(self) -> dict[str, Arm]:
        """All five, expected 20 mm and 2 degrees from where they are: nobody places a positioning arm exactly."""
        rng = np.random.default_rng(self.seed + 1)
        arms = {}
        for name in (*MESA_ARMS, *PSM_ARMS, ENDOSCOPE):
            trocar = self.trocars[name] if name in MESA_ARMS else np.zeros(3)
            off = np.concatenate([rng.normal(0.0, 0.012, 3), rng.normal(0.0, 0.02, 3)])
            arms[name] = Arm(name, self.frame(name), trocar, saras.add_delta(self.truth(name), off, 1.0))
        return arms

    def frame(self, arm: str) -> str:
        """Name of an arm's base frame."""
        return f"{arm}/sbs_world" if arm in MESA_ARMS else arm

    def truth(self, arm: str) -> Array:
        """(4, 4) world_T_base."""
        return self.scene.world_T(self.frame(arm))

    def joints_rad(self, arm: str) -> dict[str, float]:
        """Of the positioning arm; the simulated da Vinci has no set-up joints."""
        if arm not in MESA_ARMS:
            return {}
        names = (f"{arm}/{joint}" for joint in mesa.PASSIVE_JOINT_NAMES)  # as ROS publishes them
        return dict(zip(names, map(float, self.scene.arms[arm].passive_joints)))

    def reachable_dots(self, arm: str) -> list[int]:
        """Numbers of the dots that the arm's tip can touch from where it stands, from 1."""
        dots = []
        for dot in range(1, len(self.board.dots) + 1):
            tip = self._dot_in_base(arm, dot)
            outwards = tip - self.trocars.get(arm, np.zeros(3))
            further = tip + REACH_MARGIN_M * outwards / np.linalg.norm(outwards)
            if self._joints_at(arm, further) is not None:
                dots.append(dot)
        return dots

    def touch(self, arm: str, dot: int, readings: int = 50) -> Array:
        """(n, 3) readings of the tip in the arm's base frame while the hand holds it on a dot."""
        target = self._dot_in_base(arm, dot) + self.rng.normal(0.0, self.noise.touch_m, 3)
        q = self._joints_at(arm, target)
        if q is None:
            raise CalibrationError(f"{arm}: dot {dot} is out of its reach")
        kinematics = self._mesa if arm in MESA_ARMS else self._psm
        tip = kinematics.forward(q)[:3, 3]
        return np.asarray(tip + self.rng.normal(0.0, self.noise.reading_m, (readings, 3)))

    @property
    def views(self) -> int:
        """How many poses the endoscope can take before the board."""
        return len(self._view_joints)

    def image(self, view: int) -> npt.NDArray[np.uint8]:
        """The endoscope's left image at its pose `view`."""
        return render(
            BoardPattern(self.board), self._camera_T_board(view), self.intrinsics, self.rng, noise=self.noise.grey
        )

    def see(self, view: int) -> tuple[Array, BoardView]:
        """base_T_gripper as the endoscope's encoders say, and the board found in the image."""
        q = self._view_joints[view] + self.rng.normal(0.0, self.noise.encoder_rad, 4) * [1.0, 1.0, 0.1, 1.0]
        return self._ecm.forward(q), locate_board(self.image(view), self.board, self.intrinsics)

    def _camera_T_board(self, view: int) -> Array:
        world_T_camera = self.truth(ENDOSCOPE) @ self._ecm.forward(self._view_joints[view]) @ self.gripper_T_camera
        return np.asarray(np.linalg.inv(world_T_camera) @ self.world_T_board)

    def _dot_in_base(self, arm: str, dot: int) -> Array:
        base_T_board = np.linalg.inv(self.truth(arm)) @ self.world_T_board
        return np.asarray((base_T_board @ [*self.board.dots[dot - 1], 1.0])[:3])

    def _joints_at(self, arm: str, tip: Array) -> Array | None:
        """Joints with the tip there and the shaft through the trocar; None: out of reach."""
        try:
            if arm in MESA_ARMS:
                trocar, elbow = self.trocars[arm], self.scene.arms[arm].elbow
                q = self._mesa.inverse_pivot(tip, 0.0, trocar, mesa.home(trocar, elbow=elbow))
                return None if self._mesa.unreachable(tip, trocar) else np.asarray(q)
            # A straight wrist: the tip lies on the shaft's line through the remote centre.
            depth, down = float(np.linalg.norm(tip)), tip / np.linalg.norm(tip)
            straight = self._psm.forward(np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0]))
            pose = straight.copy()
            pose[:3, :3] = _shortest_turn(straight[:3, 3] / np.linalg.norm(straight[:3, 3]), down) @ straight[:3, :3]
            pose[:3, 3] = depth * down
            return np.asarray(self._psm.inverse(pose, np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])))
        except KinematicsError:
            return None

    def _calibration_trocar(self, arm: str) -> Array:
        """(3,) in the arm's base: where its remote centre is set for the calibration, so that it reaches most dots.

        No patient lies there yet, so it is moved from the operation's trocar towards the middle of the board.
        """
        base_T_board = np.linalg.inv(self.truth(arm)) @ self.world_T_board
        usual = self.scene.arms[arm].rcm
        best, most = usual, -1
        for height in (0.13, 0.16, 0.19):
            above = (base_T_board @ [0.0, 0.0, height, 1.0])[:3]
            for share in np.linspace(0.0, 1.0, 11):
                self.trocars = {arm: usual + share * (above - usual)}
                reached = len(self.reachable_dots(arm))
                if reached > most:
                    best, most = self.trocars[arm], reached
        return best

    def _plan_views(self) -> list[Array]:
        """Poses of the endoscope from which all markers are well in the image, far apart in rotation."""
        low, high = np.asarray(self._ecm.limits).T
        rng = np.random.default_rng(self.seed + 2)
        corners = np.concatenate(list(self.board.markers.values()))
        chosen: list[Array] = []
        for _ in range(20000):
            q = rng.uniform(np.maximum(low, [-0.8, -0.7, 0.0, -1.4]), np.minimum(high, [0.8, 0.9, 0.06, 1.4]))
            world_T_camera = self.truth(ENDOSCOPE) @ self._ecm.forward(q) @ self.gripper_T_camera
            camera_T_board = np.linalg.inv(world_T_camera) @ self.world_T_board
            seen = corners @ camera_T_board[:3, :3].T + camera_T_board[:3, 3]
            if (seen[:, 2] < 0.02).any() or -camera_T_board[:3, 2] @ camera_T_board[:3, 3] < 0.06:
                continue
            pixel = seen[:, :2] / seen[:, 2:] * np.diag(self.intrinsics.matrix)[:2] + self.intrinsics.matrix[:2, 2]
            size = [self.intrinsics.width, self.intrinsics.height]
            if (pixel < 30.0).any() or (pixel > np.array(size) - 30.0).any():
                continue
            forward = self._ecm.forward(q)
            apart = [np.linalg.norm(saras.displacement(self._ecm.forward(p), forward)[3:]) for p in chosen]
            if not apart or min(apart) > 0.18:
                chosen.append(q)
            if len(chosen) >= 24:
                break
        return chosen


def _shortest_turn(a: Array, b: Array) -> Array:
    """(3, 3) rotation that takes the unit vector a to b."""
    axis = np.cross(a, b)
    angle = np.arctan2(np.linalg.norm(axis), a @ b)
    vector = axis / max(float(np.linalg.norm(axis)), 1e-12) * angle
    return np.asarray(saras.add_delta(np.eye(4), np.concatenate([np.zeros(3), vector]), 1.0)[:3, :3])


__all__ = ["ENDOSCOPE", "MESA_ARMS", "PSM_ARMS", "Noise", "SimulatedRoom", "intrinsics", "world_T_board"]
