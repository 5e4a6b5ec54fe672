import math

import numpy as np
import pytest

rospy = pytest.importorskip("rospy")
import io

from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped
from scipy.spatial.transform import Rotation

from saras_ros1 import convert
from saras_ros1.stamped import lean_class

STANDARD = {lean_class(standard): standard for standard in (PoseStamped, TwistStamped, WrenchStamped)}

STAMP = rospy.Time(12, 34)


def standard(message):
    """What another ROS program receives of it."""
    buffer = io.BytesIO()
    message.serialize(buffer)
    return STANDARD[type(message)]().deserialize(buffer.getvalue())


def random_pose(rng):
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.random(random_state=rng).as_matrix()
    matrix[:3, 3] = rng.normal(size=3)
    return matrix


def test_a_pose_survives_the_round_trip(many):
    rng = np.random.RandomState(1)
    for _ in range(500 * many):
        matrix = random_pose(rng)
        message = convert.pose_msg(matrix, "base", STAMP)
        assert (message.header.frame_id, message.header.stamp) == ("base", STAMP)
        np.testing.assert_allclose(convert.pose(message), matrix, atol=1e-14)
        np.testing.assert_array_equal(convert.pose(standard(message)), convert.pose(message))


def test_half_turns_have_unit_quaternions():
    for axis in np.vstack([np.eye(3), [[1, 1, 0], [0, 1, -1], [1, -2, 3]]]):
        matrix = np.eye(4)
        matrix[:3, :3] = Rotation.from_rotvec(math.pi * axis / np.linalg.norm(axis)).as_matrix()
        np.testing.assert_allclose(convert.pose(convert.pose_msg(matrix, "base", STAMP)), matrix, atol=1e-14)


@pytest.mark.parametrize("scale", [0.0, 0.99, 1.01, math.nan, math.inf])
def test_a_quaternion_off_the_unit_sphere_is_refused(scale):
    message = standard(convert.pose_msg(np.eye(4), "base", STAMP))
    message.pose.orientation.w *= scale
    with pytest.raises(ValueError, match="quaternion norm"):
        convert.pose(message)


def test_a_quaternion_nearly_on_the_unit_sphere_is_normalised():
    message = standard(convert.pose_msg(random_pose(np.random.RandomState(2)), "base", STAMP))
    for name in "xyzw":
        setattr(message.pose.orientation, name, getattr(message.pose.orientation, name) * 1.0009)
    r = convert.pose(message)[:3, :3]
    np.testing.assert_allclose(r @ r.T, np.eye(3), atol=1e-14)


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_numbers_that_are_not_finite_are_refused(bad):
    matrix = np.eye(4)
    matrix[1, 3] = bad
    pose = convert.pose_msg(matrix, "base", STAMP)
    twist = convert.twist_msg(np.array([0, 0, 0, 0, bad, 0]), "base", STAMP)
    wrench = convert.wrench_msg(np.array([bad, 0, 0, 0, 0, 0]), "base", STAMP)
    for read, message in ((convert.pose, pose), (convert.twist, twist), (convert.wrench, wrench)):
        with pytest.raises(ValueError, match="not finite"):
            read(message)
        with pytest.raises(ValueError, match="not finite"):
            read(standard(message))


def test_twist_and_wrench_are_linear_first():
    values = np.arange(1.0, 7.0)
    np.testing.assert_array_equal(convert.twist(convert.twist_msg(values, "base", STAMP)), values)
    np.testing.assert_array_equal(convert.wrench(convert.wrench_msg(values, "base", STAMP)), values)
    assert standard(convert.twist_msg(values, "base", STAMP)).twist.linear.x == 1.0
    assert standard(convert.wrench_msg(values, "base", STAMP)).wrench.torque.z == 6.0


def test_another_frame_is_refused():
    read = convert.in_frame("base", convert.pose)
    read(convert.pose_msg(np.eye(4), "base", STAMP))
    with pytest.raises(ValueError, match="'tip', must be 'base'"):
        read(convert.pose_msg(np.eye(4), "tip", STAMP))
