"""Stereo calibration of rendered checkerboards whose cameras are known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import saras
from saras import CalibrationError

cv2 = pytest.importorskip("cv2")
from saras.calibration import rendering
from saras.calibration.camera import Intrinsics
from saras.calibration.stereo import Checkerboard, stereo

LEFT = Intrinsics(
    np.array([[560.0, 0, 322.0], [0, 558.0, 243.0], [0, 0, 1.0]]), np.array([-0.22, 0.08, 5e-4, -4e-4, 0.0]), 640, 480
)
RIGHT = Intrinsics(
    np.array([[562.0, 0, 316.0], [0, 561.0, 239.0], [0, 0, 1.0]]), np.array([-0.21, 0.07, -3e-4, 2e-4, 0.0]), 640, 480
)
RIGHT_T_LEFT = saras.add_delta(np.eye(4), np.array([-0.0052, 0.0001, -0.0002, 0.004, -0.012, 0.003]), 1.0)
BOARD = Checkerboard(9, 6, 0.007)
FACING = np.diag([1.0, -1.0, -1.0, 1.0])


def pairs(count: int, seed: int = 0) -> tuple[list[np.ndarray], list[np.ndarray]]:
    rng = np.random.default_rng(seed)
    pattern = rendering.Checkerboard(BOARD.columns, BOARD.rows, BOARD.square_m)
    left, right = [], []
    while len(left) < count:
        turn = np.concatenate([np.zeros(3), rng.uniform(-0.5, 0.5, 2), rng.uniform(-0.4, 0.4, 1)])
        pose = saras.add_delta(np.eye(4), turn, 1.0) @ FACING
        center = np.array([0.5 * (BOARD.columns - 1) * BOARD.square_m, 0.5 * (BOARD.rows - 1) * BOARD.square_m, 0.0])
        pose[:3, 3] = [*rng.uniform(-0.03, 0.03, 2), rng.uniform(0.09, 0.15)] - pose[:3, :3] @ center
        corners = BOARD.points @ pose[:3, :3].T + pose[:3, 3]
        inside = True
        for camera, at in ((LEFT, corners), (RIGHT, corners @ RIGHT_T_LEFT[:3, :3].T + RIGHT_T_LEFT[:3, 3])):
            pixel, _ = cv2.projectPoints(at, np.zeros(3), np.zeros(3), camera.matrix, camera.distortion)
            inside = inside and (pixel > 25).all() and (pixel.reshape(-1, 2) < [615, 455]).all()
        if inside:
            left.append(rendering.render(pattern, pose, LEFT, rng, noise=1.5))
            right.append(rendering.render(pattern, RIGHT_T_LEFT @ pose, RIGHT, rng, noise=1.5))
    return left, right


@pytest.fixture(scope="module")
def images() -> tuple[list[np.ndarray], list[np.ndarray]]:
    return pairs(16)


def test_focal_length_baseline_and_epipolar_lines(images: tuple) -> None:
    found = stereo(*images, BOARD)
    for eye, truth in ((found.left, LEFT), (found.right, RIGHT)):
        for axis in (0, 1):
            assert eye.matrix[axis, axis] == pytest.approx(truth.matrix[axis, axis], rel=1e-3)
    assert found.baseline_m == pytest.approx(np.linalg.norm(RIGHT_T_LEFT[:3, 3]), abs=1e-4)
    assert found.epipolar_px < 0.25 and (found.view_epipolar_px < 0.25).all()
    assert min(found.coverage) > 0.5
    assert sorted(found.worst) == sorted(found.used) and len(found.used) == 16


def test_bad_views_are_left_out_with_their_reason(images: tuple) -> None:
    left, right = [list(side[:9]) for side in images]
    left[1] = cv2.GaussianBlur(left[1], (0, 0), 8.0)
    right[4] = np.full_like(right[4], 200)
    found = stereo(left, right, BOARD)
    assert found.refused["view 2"].startswith("blurred")
    assert "must be >= 8 (right image)" in found.refused["view 5"] or "blurred" in found.refused["view 5"]
    with pytest.raises(CalibrationError, match="good views = 2"):
        stereo(left[:3], right[:3], BOARD)
    with pytest.raises(CalibrationError, match="as many"):
        stereo(left, right[:-1], BOARD)


def test_files_are_what_ros_reads(images: tuple, tmp_path: Path) -> None:
    found = stereo(images[0][:8], images[1][:8], BOARD)
    found.save(tmp_path)
    with pytest.raises(CalibrationError, match="exists"):
        found.save(tmp_path)
    import yaml

    right = yaml.safe_load((tmp_path / "right.yaml").read_text())
    assert right["projection_matrix"]["rows"] == 3 and right["projection_matrix"]["cols"] == 4
    # ROS: the right P holds -fx * baseline.
    p = np.reshape(right["projection_matrix"]["data"], (3, 4))
    assert p[0, 3] == pytest.approx(-p[0, 0] * found.baseline_m, rel=1e-6)
    assert len(right["distortion_coefficients"]["data"]) == 5
