"""The camera's calibration from a bag and with a ChArUco board, as a user calls it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import yaml

from saras import Error, cli

cv2 = pytest.importorskip("cv2")
pytest.importorskip("rosbags")
from rosbags.rosbag1 import Writer
from rosbags.typesys import Stores, get_typestore
from test_stereo import BOARD, FACING, LEFT, RIGHT, RIGHT_T_LEFT, pairs

import saras
from saras.calibration import rendering
from saras.calibration.stereo import Charuco, stereo
from saras.calibration.stereo_pictures import from_bag

STORE = get_typestore(Stores.ROS1_NOETIC)
TOPICS = ("/endoscope/left/image_raw", "/endoscope/right/image_raw")


def image_message(pixels: np.ndarray, stamp_s: float, encoding: str):
    types = STORE.types
    data = pixels if encoding == "mono8" else np.repeat(pixels[:, :, np.newaxis], 3, axis=2)
    time = types["builtin_interfaces/msg/Time"](int(stamp_s), int(1e9 * (stamp_s % 1.0)))
    header = types["std_msgs/msg/Header"](0, time, "")
    height, width = pixels.shape
    step = width * (1 if encoding == "mono8" else 3)
    return types["sensor_msgs/msg/Image"](header, height, width, encoding, 0, step, np.ascontiguousarray(data).ravel())


def write_bag(path: Path, views: tuple, encoding: str = "bgr8", skew_s: float = 0.0) -> None:
    """Three frames a view at 10 Hz; the right eye skewed."""
    with Writer(path) as bag:
        eyes = [bag.add_connection(topic, "sensor_msgs/msg/Image", typestore=STORE) for topic in TOPICS]
        for k in range(3 * len(views[0])):
            for eye, connection in enumerate(eyes):
                stamp_s = 1000.0 + 0.1 * k + skew_s * eye
                message = image_message(views[eye][k // 3], stamp_s, encoding)
                raw = STORE.serialize_ros1(message, "sensor_msgs/msg/Image")
                bag.write(connection, int(1e9 * stamp_s) + 1000, raw)


@pytest.fixture(scope="module")
def views() -> tuple:
    return pairs(8, seed=5)


def test_a_bag_gives_the_same_calibration_as_the_pictures(views: tuple, tmp_path: Path, capsys) -> None:
    write_bag(tmp_path / "views.bag", views)
    size = ["--columns", str(BOARD.columns), "--rows", str(BOARD.rows), "--square-m", str(BOARD.square_m)]
    out = ["--every-s", "0.25", "--out", str(tmp_path / "camera")]
    assert cli.main(["calibrate", "camera", "--bag", str(tmp_path / "views.bag"), *size, *out]) == 0
    said = capsys.readouterr().out
    assert "views used 8" in said
    found = yaml.safe_load((tmp_path / "camera" / "left.yaml").read_text())
    truth = stereo(*views, BOARD)
    np.testing.assert_allclose(np.reshape(found["camera_matrix"]["data"], (3, 3)), truth.left.matrix, atol=0.05)


def test_pairs_are_of_one_moment(views: tuple, tmp_path: Path) -> None:
    write_bag(tmp_path / "skewed.bag", views, encoding="mono8", skew_s=0.03)
    assert from_bag(tmp_path / "skewed.bag", *TOPICS).left == []
    write_bag(tmp_path / "good.bag", views, encoding="mono8")
    found = from_bag(tmp_path / "good.bag", *TOPICS, every_s=0.25)
    assert len(found.left) == len(found.right) == len(found.names) == 8
    for seen, shown in zip(found.left, views[0]):
        np.testing.assert_array_equal(seen, shown)


def test_what_is_refused(views: tuple, tmp_path: Path) -> None:
    write_bag(tmp_path / "a.bag", ([views[0][0]], [views[1][0]]))
    with pytest.raises(Error, match="topic /other: not in the bag"):
        from_bag(tmp_path / "a.bag", "/other", TOPICS[1])
    (tmp_path / "no.bag").write_text("nothing")
    with pytest.raises(Error, match="cannot be read as a bag"):
        from_bag(tmp_path / "no.bag", *TOPICS)
    assert cli.main(["calibrate", "camera", "--columns", "9", "--rows", "6", "--square-m", "0.007"]) == 2


class CharucoPattern(rendering.Pattern):
    """OpenCV's own drawing of the board, 60 pixels a square."""

    def __init__(self, charuco: Charuco) -> None:
        self.charuco = charuco
        size = (60 * charuco.columns, 60 * charuco.rows)
        board = charuco.board()
        self.drawn = board.draw(size) if hasattr(board, "draw") else board.generateImage(size)

    def shade(self, xy: np.ndarray) -> np.ndarray:
        """From the drawing; white around it."""
        height, width = self.drawn.shape
        column = np.floor(60 * xy[:, 0] / self.charuco.square_m).astype(int)
        row = height - 1 - np.floor(60 * xy[:, 1] / self.charuco.square_m).astype(int)
        inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        white = np.ones(len(xy))
        white[inside] = self.drawn[row[inside], column[inside]] / 255.0
        return white


def test_charuco_finds_the_same_cameras() -> None:
    charuco, rng = Charuco(8, 6, 0.012, 0.009), np.random.default_rng(3)
    pattern, left, right = CharucoPattern(charuco), [], []
    middle = np.array([4 * 0.012, 3 * 0.012, 0.0])
    for _ in range(12):
        turn = np.concatenate([np.zeros(3), rng.uniform(-0.45, 0.45, 2), rng.uniform(-0.3, 0.3, 1)])
        pose = saras.add_delta(np.eye(4), turn, 1.0) @ FACING
        pose[:3, 3] = [*rng.uniform(-0.015, 0.015, 2), rng.uniform(0.1, 0.14)] - pose[:3, :3] @ middle
        left.append(rendering.render(pattern, pose, LEFT, rng, noise=1.5))
        right.append(rendering.render(pattern, RIGHT_T_LEFT @ pose, RIGHT, rng, noise=1.5))
    found = stereo(left, right, charuco)
    assert found.left.matrix[0, 0] == pytest.approx(LEFT.matrix[0, 0], rel=5e-3)
    assert found.baseline_m == pytest.approx(np.linalg.norm(RIGHT_T_LEFT[:3, 3]), abs=2e-4)
    assert found.epipolar_px < 0.25
