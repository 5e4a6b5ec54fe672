"""The guided procedure in a terminal: hand-eye of the endoscope, dots of each arm, views of the board, the file.

The room is asked through `Room`, so the same steps run against the simulation and against real arms.
"""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Protocol

import numpy as np
import numpy.typing as npt
from rich.console import Console
from rich.panel import Panel
from rich.table import Table

import saras
from saras import CalibrationError, ConfigError
from saras.calibration.board import Board
from saras.calibration.calibration_file import Calibration
from saras.calibration.camera import BoardView
from saras.calibration.hand_eye_session import HandEyeSession, describe
from saras.calibration.registration import Arm, Registration, View

Array = npt.NDArray[np.float64]


#: Of a base's origin, along its worst axis: one standard deviation. With it four arms in a row are within 1 mm
#: (script/bench calibration: guided session).
KNOWN_TO_M = 0.3e-3
#: of each dot; more of them would not make a bad touch better
MOST_ROUNDS = 12


class Room(Protocol):
    """What the procedure asks of the room. Each raises CalibrationError with the reason when it cannot answer."""

    board: Board
    world_T_board: Array

    @property
    def arms(self) -> dict[str, Arm]:
        """Arms to register."""

    @property
    def views(self) -> int:
        """How many poses the endoscope is asked to take."""

    def reachable_dots(self, arm: str) -> list[int]:
        """Dots worth asking for, from 1."""

    def touch(self, arm: str, dot: int) -> Array:
        """(n, 3) readings of the tip while it rests on the dot."""

    def see(self, view: int) -> tuple[Array, BoardView]:
        """base_T_gripper and the board in the image, now."""

    def joints_rad(self, arm: str) -> dict[str, float]:
        """Of the positioning arm or set-up joints; empty: not read."""


class QuitError(Exception):
    """The user has had enough; nothing is saved."""


class Guide:
    """Leads through the steps. automatic: presses Enter by itself (simulation).

    rounds: least touches of each dot; more are asked for until the base's origin is known to known_to_m (one standard
    deviation along its worst axis).
    """

    def __init__(
        self,
        room: Room,
        endoscope: str,
        console: Console,
        *,
        automatic: bool = False,
        rounds: int = 4,
        known_to_m: float = KNOWN_TO_M,
    ) -> None:
        self.rounds, self.known_to_m = rounds, known_to_m
        self.room, self.endoscope, self.console, self.automatic = room, endoscope, console, automatic
        self.registration = Registration(room.board, room.world_T_board, room.arms)
        self.hand_eye = HandEyeSession()

    def run(self) -> Calibration:
        """All steps. Raises QuitError; CalibrationError when the user gives up on a step that cannot succeed."""
        touching = [arm for arm in self.room.arms if arm != self.endoscope]
        self.console.print(
            Panel(
                f"[bold]Calibration[/] with board {self.room.board.hash}: the endoscope's camera, then the bases of "
                f"{', '.join(touching)} and {self.endoscope}.\n"
                "Enter takes, [bold]u[/] undoes, [bold]s[/] skips, [bold]q[/] ends without saving.\n"
                "Nothing in the room may move but what you are asked to move.",
                border_style="cyan",
            )
        )
        if self.endoscope in self.room.arms:
            self._step(1, "Hand-eye: where the camera sits on the endoscope")
            self._hand_eye()
        for number, arm in enumerate(touching, start=2):
            self._step(number, f"Dots: where the base of {arm} is")
            self._dots(arm)
        if self.endoscope in self.room.arms:
            self._step(2 + len(touching), f"Markers: where the base of {self.endoscope} is")
            self._views()
        calibration = self.registration.compute()
        self.console.print(summary(calibration))
        return calibration

    def _step(self, number: int, title: str) -> None:
        steps = len(self.room.arms) + (1 if self.endoscope in self.room.arms else 0)
        self.console.rule(f"[bold]{number} of {steps}[/]  {title}", align="left")

    def _ask(self, prompt: str) -> str:
        if self.automatic:
            self.console.print(f"  {prompt}")
            return ""
        answer = self.console.input(f"  {prompt} [dim](Enter, u, s, q)[/] ").strip().lower()
        if answer == "q":
            raise QuitError
        return answer

    # ---- hand-eye

    def _hand_eye(self) -> None:
        view = 0
        while True:
            wanted = self.room.views
            if view < wanted:
                answer = self._ask(
                    f"View {view + 1} of {wanted}: all markers in the image, turned away from the last views"
                )
                if answer == "u" and self.hand_eye.pairs:
                    self.hand_eye.undo()
                    view = max(0, view - 1)
                    self.console.print("  [yellow]the last view is forgotten[/]")
                    continue
                if answer != "s":
                    try:
                        self.console.print(f"  [green]taken[/] {self.hand_eye.take(*self.room.see(view))}")
                    except CalibrationError as error:
                        self._refused(error)
                        if not self.automatic:
                            continue
                view += 1
                continue
            try:
                self._solve_hand_eye()
                return
            except CalibrationError as error:
                self._refused(error)
                if self.automatic or self._ask("Enter: take more views; q: give up") == "q":
                    raise
                self.hand_eye.clear()
                view = 0

    def _solve_hand_eye(self) -> None:
        found = self.hand_eye.compute()
        self.registration.gripper_T_camera[self.endoscope] = found.gripper_T_camera
        self.registration.camera_covariance[self.endoscope] = found.covariance
        self.console.print(f"  camera on the endoscope: {describe(found)}")

    # ---- dots and views

    def _dots(self, arm: str) -> None:
        while True:
            self._touch_rounds(arm, self.room.reachable_dots(arm))
            try:
                self.registration.base_frame(arm)
                return
            except CalibrationError as error:
                self._refused(error)
                if self.automatic:
                    raise
                self._ask("Enter: touch this arm's dots anew")
                self.registration.clear(arm)

    def _touch_rounds(self, arm: str, dots: list[int]) -> None:
        """Every dot again and again: less error, and a wrong dot shows."""
        taken: list[bool] = []  # of each prompt that was answered; a skipped one is False
        while not self._enough(arm, len(taken), len(dots)):
            dot = dots[len(taken) % len(dots)]
            answer = self._ask(f"{arm}: tip on dot [bold]{dot}[/], from above, hold still")
            if answer == "d":
                return
            if answer == "u":
                if taken and taken.pop():
                    self._undo()
                continue
            if answer != "s":
                try:
                    tips = self.room.touch(arm, dot)
                    self.registration.take_touch(arm, dot, tips, self.room.joints_rad(arm) or None)
                except CalibrationError as error:
                    self._refused(error)
                    if not self.automatic:
                        continue
                    answer = "s"
                else:
                    self.console.print(f"  [green]taken[/] {self.registration.status()[arm]}")
            taken.append(answer != "s")

    def _enough(self, arm: str, prompts: int, dots: int) -> bool:
        """At the end of a round: whether the base is known as well as wanted."""
        if prompts % dots or prompts < self.rounds * dots:
            return False
        try:
            std_m = self.registration.base_frame(arm).std_m
        except CalibrationError:
            return True  # who asked says why
        if std_m <= self.known_to_m:
            return True
        if prompts >= MOST_ROUNDS * dots:
            self.console.print(f"  [yellow]known to {1e3 * std_m:.2f} mm only; the touches differ too much[/]")
            return True
        wanted = f"wanted {1e3 * self.known_to_m:.2f} mm"
        self.console.print(f"  known to {1e3 * std_m:.2f} mm, {wanted}: another round [dim](d: it is enough)[/]")
        return False

    def _views(self) -> None:
        arm = self.endoscope
        joints = self.room.joints_rad(arm) or None
        # The hand-eye views show the same board, unmoved: they say where the base is as well.
        for gripper, seen in self.hand_eye.pairs:
            try:
                self.registration.take_view(arm, View(gripper, seen.camera_T_board, seen.rms_px), joints)
            except CalibrationError as error:
                self._refused(error)
        self.registration.base_frame(arm)
        self.console.print(f"  [green]from the same views[/] {self.registration.status()[arm]}")

    def _undo(self) -> None:
        try:
            self.console.print(f"  [yellow]forgotten: {self.registration.undo()}[/]")
        except CalibrationError as error:
            self._refused(error)

    def _refused(self, error: CalibrationError) -> None:
        self.console.print(f"  [red]refused[/] {error}")


def summary(calibration: Calibration) -> Table:
    """The frames as a table."""
    table = Table(title="World → base frames", title_justify="left")
    table.add_column("frame")
    for heading in ("x, y, z [mm]", "from", "residual", "known to"):
        table.add_column(heading, justify="right")
    for name, frame in calibration.frames.items():
        place = " ".join(f"{1e3 * value:+.1f}" for value in frame.parent_T_frame[:3, 3])
        known = f"{1e3 * frame.std_m:.2f} mm {np.rad2deg(frame.std_rad):.2f}°"
        table.add_row(name, place, f"{frame.measurements} {frame.method}", f"{1e3 * frame.rms_m:.2f} mm", known)
    return table


def errors(calibration: Calibration, truth: dict[str, Array]) -> dict[str, tuple[float, float]]:
    """By frame: distance of the origins [m] and angle [rad] to the truth (4, 4)."""
    found = {}
    for name, frame in calibration.frames.items():
        off = saras.displacement(frame.parent_T_frame, truth[name])
        found[name] = float(np.linalg.norm(off[:3])), float(np.linalg.norm(off[3:]))
    return found


def save(calibration: Calibration, path: Path, force: bool, console: Console, frames: Iterable[str]) -> None:
    """Writes the file and reads it back as the platform will."""
    calibration.save(path, force)
    again = Calibration.load(path, board_hash=calibration.board_hash, frames=frames)
    for name, frame in again.frames.items():
        if not np.allclose(frame.parent_T_frame, calibration.frames[name].parent_T_frame, atol=1e-8):
            raise ConfigError(f"{path}: {name} did not come back as it was written")
    console.print(f"[green]saved[/] {path}; the platform takes it with [bold]calibration:={path.resolve()}[/]")


__all__ = ["KNOWN_TO_M", "Guide", "QuitError", "Room", "errors", "save", "summary"]
