"""A da Vinci's motion out of a bag: joints or poses, either naming, either type."""

from __future__ import annotations

import numpy as np
import pytest

rosbag = pytest.importorskip("rosbag")
rospy = pytest.importorskip("rospy")
from geometry_msgs.msg import Pose, PoseStamped, TransformStamped
from sensor_msgs.msg import JointState

import saras
from saras.crtk.playback import Playback
from saras.kinematics import dvrk
from saras.recording.bag import Bag
from saras_ros1 import convert

TIMES = np.arange(0.0, 2.0, 0.05)


def path_of(arm):
    lower, upper = arm.limits.T
    middle, reach = (lower + upper) / 2, (upper - lower) / 8
    return middle + reach * np.sin(TIMES)[:, None]


def write(path, topic, messages):
    with rosbag.Bag(str(path), "w") as bag:
        for t, message in zip(TIMES, messages):
            message.header.stamp = rospy.Time.from_sec(100.0 + t)
            bag.write(topic, message, message.header.stamp)


def pose_message(kind, matrix):
    x, y, z, w = convert.quaternion(matrix)
    message = kind()
    body = message.pose if kind is PoseStamped else message.transform
    point = body.position if kind is PoseStamped else body.translation
    turn = body.orientation if isinstance(body, Pose) else body.rotation
    point.x, point.y, point.z = matrix[:3, 3]
    turn.x, turn.y, turn.z, turn.w = x, y, z, w
    return message


@pytest.mark.parametrize(
    ("name", "arm", "topic", "kind"),
    [
        ("PSM1", dvrk.psm(), "/PSM1/measured_js", JointState),
        ("PSM2", dvrk.psm(), "/dvrk/PSM2/state_joint_current", JointState),
        ("PSM1", dvrk.psm(), "/PSM1/measured_cp", TransformStamped),
        ("PSM1", dvrk.psm("420006", "si"), "/dvrk/PSM1/position_cartesian_current", PoseStamped),
        ("ECM", dvrk.ecm("up"), "/ECM/local/measured_cp", PoseStamped),
    ],
)
def test_the_motion_comes_back(tmp_path, name, arm, topic, kind):
    path = path_of(arm)
    if kind is JointState:
        messages = [JointState(position=[*q, 0.3]) for q in path]  # the jaw behind the joints, as it once was
    else:
        messages = [pose_message(kind, arm.forward(q)) for q in path]
    write(tmp_path / "surgeon.bag", topic, messages)
    playback = Playback(Bag(tmp_path / "surgeon.bag"), name, arm)
    assert playback.topic == topic
    for t, q in zip(TIMES[:-1], path):
        np.testing.assert_allclose(arm.forward(playback.joints(t)), arm.forward(q), atol=1e-6)
    np.testing.assert_allclose(playback.joints(0.025), (path[0] + path[1]) / 2, atol=1e-6)
    np.testing.assert_allclose(playback.joints(TIMES[-1] + 0.1), playback.joints(0.1), atol=1e-9)  # begins anew


def test_what_a_bag_lacks_is_named(tmp_path):
    write(tmp_path / "other.bag", "/PSM1/measured_js", [JointState(position=[0.0] * 6) for _ in TIMES])
    with pytest.raises(saras.Error, match="no motion of PSM2"):
        Playback(Bag(tmp_path / "other.bag"), "PSM2", dvrk.psm())
    far = np.eye(4)
    far[0, 3] = 5.0
    write(tmp_path / "far.bag", "/PSM1/measured_cp", [pose_message(PoseStamped, far) for _ in TIMES])
    with pytest.raises(saras.Error, match="none of 40 poses is in reach"):
        Playback(Bag(tmp_path / "far.bag"), "PSM1", dvrk.psm())
