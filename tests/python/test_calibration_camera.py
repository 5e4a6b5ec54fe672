"""The board in rendered images: found where it is, refused with the reason where it cannot be believed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import saras
from saras import CalibrationError, cli

cv2 = pytest.importorskip("cv2")
from saras.calibration import board
from saras.calibration.calibration_file import Calibration
from saras.calibration.camera import Intrinsics, locate_board
from saras.calibration.rendering import BoardPattern, render
from saras.calibration.simulated import intrinsics

ROOT = Path(__file__).resolve().parents[2]
CAMERA = intrinsics()
FACING = np.diag([1.0, -1.0, -1.0, 1.0])  # the camera looks down on the print


def camera_T_board(tilt: tuple[float, float, float] = (0.3, -0.2, 0.4), distance_m: float = 0.2) -> np.ndarray:
    turned = saras.add_delta(np.eye(4), np.array([0.0, 0.0, 0.0, *tilt]), 1.0) @ FACING
    turned[:3, 3] = [0.004, -0.006, distance_m]
    return turned


@pytest.fixture(scope="module")
def image() -> np.ndarray:
    return render(BoardPattern(board()), camera_T_board(), CAMERA, np.random.default_rng(0))


def test_it_is_found_where_it_is(image: np.ndarray) -> None:
    view = locate_board(image, board(), CAMERA)
    off = saras.displacement(view.camera_T_board, camera_T_board())
    assert view.marker_ids == (0, 1, 2, 3) and view.rms_px < 0.5
    assert np.linalg.norm(off[:3]) < 0.5e-3 and np.rad2deg(np.linalg.norm(off[3:])) < 0.5


def test_what_cannot_be_believed_is_refused(image: np.ndarray) -> None:
    covered = image.copy()
    covered[:, : CAMERA.width // 2] = 255
    other = Intrinsics(CAMERA.matrix, CAMERA.distortion, 1280, 720)
    for why, act in (
        ("blurred", lambda: locate_board(cv2.GaussianBlur(image, (0, 0), 9.0), board(), CAMERA)),
        ("missing", lambda: locate_board(covered, board(), CAMERA)),
        ("another board", lambda: locate_board(image, board(marker_ids=(4, 5, 6, 7)), CAMERA)),
        ("1280x720", lambda: locate_board(image, board(), other)),
        ("px rms", lambda: locate_board(image, board(marker_ids=(1, 0, 2, 3)), CAMERA)),
        ("missing", lambda: locate_board(np.ascontiguousarray(image[:, ::-1]), board(), CAMERA)),
    ):
        with pytest.raises(CalibrationError, match=why):
            act()


def test_the_whole_procedure_in_the_simulated_room(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """End to end: all five frames within 1 mm and 0.5 degrees; the file comes back."""
    out = tmp_path / "calibration.yaml"
    arguments = ["calibrate", "simulation", "--yes", "--scene", str(ROOT / "config" / "scene.yaml"), "--out", str(out)]
    code = cli.main(arguments)
    said = capsys.readouterr().out
    assert code == 0, said
    assert len(Calibration.load(out).frames) == 5
    assert cli.main(arguments) == 2  # the file exists
    assert cli.main(["calibrate", "check", str(out)]) == 0
