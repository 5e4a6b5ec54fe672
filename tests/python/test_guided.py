"""The guided procedure: how long it asks for touches, and its prompts."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

import saras
from saras.calibration.calibration_file import Calibration
from saras.kinematics import scene

pytest.importorskip("cv2")
from saras.calibration.guided import Guide, QuitError
from saras.calibration.simulated import ENDOSCOPE, SimulatedRoom

SCENE = scene.load(Path(__file__).resolve().parents[2] / "config" / "scene.yaml")


class Answers(Console):
    """A terminal at which somebody answers prompts from a list, and Enter when it is over."""

    def __init__(self, *answers: str) -> None:
        super().__init__(file=io.StringIO(), width=200)
        self.answers = list(answers)

    def input(self, prompt: str = "", **_: object) -> str:  # type: ignore[override]
        self.print(prompt)
        return self.answers.pop(0) if self.answers else ""

    @property
    def said(self) -> str:
        return self.file.getvalue()  # type: ignore[attr-defined]


class TouchingRoom(SimulatedRoom):
    """The arms that touch; the endoscope is another test's."""

    @property
    def arms(self):
        return {name: arm for name, arm in super().arms.items() if name != ENDOSCOPE}


def worst_m(room: SimulatedRoom, calibration: Calibration) -> float:
    frames = {room.frame(arm): room.truth(arm) for arm in room.arms}
    return max(
        float(np.linalg.norm(saras.displacement(calibration.frames[name].parent_T_frame, truth)[:3]))
        for name, truth in frames.items()
    )


def test_it_asks_until_all_four_arms_are_within_a_millimetre(many: int) -> None:
    sessions = 10 * many
    good = 0
    for seed in range(sessions):
        room = TouchingRoom(SCENE, seed=seed)
        good += worst_m(room, Guide(room, ENDOSCOPE, Answers(), automatic=True).run()) < 1e-3
    assert good >= 0.8 * sessions, (good, sessions)


def test_who_is_content_with_less_touches_less() -> None:
    counts = []
    for known_to_m in (5e-3, 0.4e-3):
        room = TouchingRoom(SCENE)
        found = Guide(room, ENDOSCOPE, Answers(), automatic=True, rounds=2, known_to_m=known_to_m).run()
        counts.append(sum(frame.measurements for frame in found.frames.values()))
    assert 2 * counts[0] < counts[1]


def test_undo_takes_back_a_touch_and_a_skip_takes_back_nothing() -> None:
    room, console = TouchingRoom(SCENE), Answers("", "u", "s", "u", "", "")
    Guide(room, ENDOSCOPE, console, rounds=2, known_to_m=1.0).run()
    assert console.said.count("forgotten: touch") == 1
    assert console.said.count("tip on dot 1") > console.said.count("tip on dot 6")


def test_enough_is_enough_and_quit_saves_nothing() -> None:
    console = Answers(*[""] * 12, "d")
    guide = Guide(TouchingRoom(SCENE), ENDOSCOPE, console, rounds=2, known_to_m=1e-6)
    with pytest.raises(QuitError):
        console.answers += ["q"]
        guide.run()
    assert "another round" in console.said
    assert "mesa_right: tip on dot" in console.said.splitlines()[-1]
