"""What stereo_contact takes its pictures and tips from: pairs of one moment, frozen cameras, tips between two poses."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

rospy = pytest.importorskip("rospy")
from sensor_msgs.msg import Image

from saras.sim.endoscope.camera import stereo_camera
from saras_ros1 import picture_pairs
from saras_ros1.camera_images import camera_info_msg, colours, image_msg
from saras_ros1.collision_tools import UnknownToolError
from saras_ros1.picture_pairs import PicturePairs, UnknownPairError
from saras_ros1.tip_history import TipHistory

CAMERA = stereo_camera(64, 64)


class Clock:
    now = 100.0

    def monotonic(self) -> float:
        return self.now


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(picture_pairs, "time", clock)
    monkeypatch.setattr(picture_pairs.rospy, "Subscriber", lambda *_, **__: None)
    return clock


def picture(stamp_s: float, level: int, size: int = 64) -> Image:
    return image_msg(np.full((size, size, 3), level, np.uint8), "bgr8", "", rospy.Time.from_sec(stamp_s))


def filled() -> PicturePairs:
    pairs = PicturePairs(timeout_s=0.3, skew_s=0.005, frozen_s=0.2)
    for side, eye in (("left", CAMERA.left), ("right", CAMERA.right)):
        pairs._on_info(camera_info_msg(eye, eye.size, "", rospy.Time(1)), side)
    return pairs


def refusal(pairs: PicturePairs) -> str:
    with pytest.raises(UnknownPairError) as refused:
        pairs.newest()
    return str(refused.value)


def test_only_pictures_of_one_moment_are_a_pair(clock: Clock) -> None:
    pairs = filled()
    assert "left and the right eye" in refusal(pairs)
    pairs._on_image(picture(10.0, 1), "left")
    assert "no picture of the right eye" in refusal(pairs)
    pairs._on_image(picture(10.02, 2), "right")
    assert "never within 5 ms" in refusal(pairs)
    pairs._on_image(picture(10.021, 3), "left")
    pair = pairs.newest()
    assert (colours(pair.left)[0, 0, 0], colours(pair.right)[0, 0, 0]) == (3, 2)
    assert pair.stamp == rospy.Time.from_sec(10.021)
    assert np.allclose(pair.eyes[1].P, CAMERA.right.P)
    assert pairs.newest().eyes is pair.eyes  # the estimator is kept as long as the calibration is the same
    clock.now += 0.31
    assert "0.3 s old" in refusal(pairs)


def test_a_camera_that_repeats_itself_is_frozen(clock: Clock) -> None:
    pairs = filled()
    for i in range(8):
        for side in ("left", "right"):
            pairs._on_image(picture(20.0 + 0.05 * i, 7), side)
        if i < 4:
            pairs.newest()
        clock.now += 0.05
    assert "frozen" in refusal(pairs)
    pairs._on_image(picture(21.0, 8), "left")
    pairs._on_image(picture(21.0, 7), "right")
    pairs.newest()


def test_pictures_must_fit_their_calibration(clock: Clock) -> None:
    pairs = filled()
    for side in ("left", "right"):
        pairs._on_image(picture(30.0, 5, 32), side)
    assert "left picture is 32x32: camera_info is for 64x64" in refusal(pairs)
    pairs = filled()
    pairs._on_info(camera_info_msg(None, (64, 64), "", rospy.Time(1)), "right")
    for side in ("left", "right"):
        pairs._on_image(picture(30.0, 5), side)
    assert "not calibrated" in refusal(pairs)


def history(stamps_s: list[float]) -> TipHistory:
    made = TipHistory.__new__(TipHistory)
    made.timeout_s, made._past = 0.1, []
    made._arm = SimpleNamespace(pose=SimpleNamespace(topic="/mesa_left/ee_pose"))
    for stamp in stamps_s:
        pose = np.eye(4)
        pose[:3, 3] = (2.0 * stamp, 0.0, 1.0)
        TipHistory._on_pose(made, SimpleNamespace(stamp_ns=round(1e9 * stamp), value=pose))
    return made


def test_a_tip_is_where_it_was_when_the_picture_was_taken() -> None:
    tips = history([1.0, 1.01, 1.03, 1.04])
    for at in (1.0, 1.004, 1.02, 1.037, 1.04):
        assert np.allclose(tips.base_tip(round(1e9 * at)), (2.0 * at, 0.0, 1.0))
    assert np.allclose(tips.base_tip(round(1.1e9)), (2.08, 0.0, 1.0))  # the newest, while it is young enough
    assert np.allclose(tips.base_tip(round(0.95e9)), (2.0, 0.0, 1.0))
    for at in (0.85, 1.2):
        with pytest.raises(UnknownToolError, match=r"within 0\.1 s"):
            tips.base_tip(round(1e9 * at))
    with pytest.raises(UnknownToolError, match="no pose on /mesa_left/ee_pose"):
        history([]).base_tip(0)
    with pytest.raises(UnknownToolError):
        history([1.0, 1.5]).base_tip(round(1.25e9))  # nothing is guessed across a gap
