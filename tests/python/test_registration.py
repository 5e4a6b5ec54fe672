"""Registration in the simulated room: near the truth, and what it refuses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import saras
from saras import CalibrationError
from saras.calibration.registration import Registration
from saras.kinematics import scene

pytest.importorskip("cv2")
from saras.calibration.simulated import ENDOSCOPE, MESA_ARMS, PSM_ARMS, SimulatedRoom

SCENE = scene.load(Path(__file__).resolve().parents[2] / "config" / "scene.yaml")


def registered(room: SimulatedRoom, rounds: int = 4) -> Registration:
    arms = {name: arm for name, arm in room.arms.items() if name != ENDOSCOPE}
    registration = Registration(room.board, room.world_T_board, arms)
    for arm in arms:
        for dot in room.reachable_dots(arm) * rounds:
            registration.take_touch(arm, dot, room.touch(arm, dot), room.joints_rad(arm) or None)
    return registration


def test_bases_are_found_and_their_deviation_is_honest(many: int) -> None:
    off, squares = [], []
    for seed in range(10 * many):
        room = SimulatedRoom(SCENE, seed=seed)
        for name, frame in registered(room).compute().frames.items():
            arm = name.split("/")[0]
            error = saras.displacement(frame.parent_T_frame, room.truth(arm))
            off.append((np.linalg.norm(error[:3]), np.linalg.norm(error[3:])))
            squares.append(np.linalg.norm(error[:3]) ** 2 / frame.std_m**2)
    mean = np.mean(off, axis=0)
    assert mean[0] < 0.8e-3 and np.rad2deg(mean[1]) < 0.25, mean
    assert 0.3 < np.mean(squares) < 4.0  # std_m is that of the worst of three axes


@pytest.fixture(scope="module")
def room() -> SimulatedRoom:
    return SimulatedRoom(SCENE)


def test_every_arm_reaches_three_dots_and_more(room: SimulatedRoom) -> None:
    for arm in (*MESA_ARMS, *PSM_ARMS):
        assert len(room.reachable_dots(arm)) >= 4, arm


def test_left_for_right_is_refused(room: SimulatedRoom) -> None:
    for one, other in (MESA_ARMS, PSM_ARMS):
        registration = Registration(room.board, room.world_T_board, room.arms)
        for dot in room.reachable_dots(other):
            registration.take_touch(one, dot, room.touch(other, dot))
        with pytest.raises(CalibrationError, match="left for right"):
            registration.base_frame(one)


def test_a_board_elsewhere_is_refused(room: SimulatedRoom) -> None:
    world_T_board = room.world_T_board.copy()
    world_T_board[0, 3] += 0.8
    registration = Registration(room.board, world_T_board, {"PSM1": room.arms["PSM1"]})
    for dot in room.reachable_dots("PSM1"):
        registration.take_touch("PSM1", dot, room.touch("PSM1", dot))
    with pytest.raises(CalibrationError, match="world_T_board"):
        registration.base_frame("PSM1")


def test_bad_touches_are_refused_and_change_nothing(room: SimulatedRoom) -> None:
    registration = Registration(room.board, room.world_T_board, room.arms)
    arm = "mesa_left"
    good = {dot: room.touch(arm, dot) for dot in room.reachable_dots(arm)}
    first, second = list(good)[:2]
    registration.take_touch(arm, first, good[first], room.joints_rad(arm))
    moving = good[second] + np.linspace(0.0, 0.01, len(good[second]))[:, None]
    joints = dict(room.joints_rad(arm))
    joints["mesa_left/passive_3"] += 0.01
    for why, act in (
        ("moved by", lambda: registration.take_touch(arm, second, moving)),
        ("the wrong dot", lambda: registration.take_touch(arm, second, good[first])),
        ("has something moved", lambda: registration.take_touch(arm, first, good[second])),
        ("dot = 7", lambda: registration.take_touch(arm, 7, good[first])),
        ("passive_3 moved", lambda: registration.take_touch(arm, second, good[second], joints)),
        ("must be one of", lambda: registration.take_touch("mesa_middle", first, good[first])),
        ("finite", lambda: registration.take_touch(arm, second, good[second] * np.nan)),
    ):
        with pytest.raises(CalibrationError, match=why):
            act()
        assert len(registration.touches[arm]) == 1
    assert registration.undo() == f"touch of dot {first} by mesa_left"
    with pytest.raises(CalibrationError, match="nothing"):
        registration.undo()
    registration.take_touch(arm, first, good[first], joints)  # undone: the joints may be others now


def test_views_need_a_hand_eye_calibration(room: SimulatedRoom) -> None:
    registration = Registration(room.board, room.world_T_board, room.arms)
    gripper, seen = room.see(0)
    from saras.calibration.registration import View

    view = View(gripper, seen.camera_T_board, seen.rms_px)
    with pytest.raises(CalibrationError, match="hand-eye"):
        registration.take_view(ENDOSCOPE, view)
    registration.gripper_T_camera[ENDOSCOPE] = room.gripper_T_camera
    registration.take_view(ENDOSCOPE, view)
    with pytest.raises(CalibrationError, match="same pose"):
        registration.take_view(ENDOSCOPE, view)
    with pytest.raises(CalibrationError, match="views = 1"):
        registration.base_frame(ENDOSCOPE)
