"""Messages ↔ numpy, written for control loops: no tf.transformations, no per-element ROS objects kept.

``pose``, ``twist``, ``wrench``… read a message and raise ValueError when it must not be used (non-finite number,
quaternion whose norm is off by more than 1e-3, zero quaternion, wrong frame): `Node.input` counts such messages and
does not feed its watchdog with them. ``pose_msg``… write messages. Poses are (4, 4), twists and wrenches (6,), SI.
"""

from __future__ import annotations

import math
from typing import Callable

import numpy as np
import rospy
from geometry_msgs.msg import PointStamped, PoseStamped, TransformStamped, TwistStamped, WrenchStamped

from saras_ros1.stamped import NANOSECONDS, StampedPose, StampedTwist, StampedWrench

QUATERNION_NORM_TOLERANCE = 1e-3


def rotation(x: float, y: float, z: float, w: float) -> np.ndarray:
    """(3, 3) rotation of a quaternion whose norm is within 1e-3 of one; it is normalised."""
    norm = math.sqrt(x * x + y * y + z * z + w * w)
    if not abs(norm - 1.0) <= QUATERNION_NORM_TOLERANCE:  # a NaN norm fails here as well
        raise ValueError(f"quaternion norm {norm:g}, must be 1 within {QUATERNION_NORM_TOLERANCE:g}")
    x, y, z, w = x / norm, y / norm, z / norm, w / norm
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def quaternion(matrix: np.ndarray) -> tuple[float, float, float, float]:
    """(x, y, z, w), w ≥ 0, of the rotation in the upper left 3×3 of a matrix (Shepperd's choice of pivot)."""
    (a, b, c), (d, e, f), (g, h, i) = matrix[:3, :3].tolist()
    trace = a + e + i
    if trace > 0.0:
        s = 2.0 * math.sqrt(trace + 1.0)
        q = ((h - f) / s, (c - g) / s, (d - b) / s, 0.25 * s)
    elif a >= e and a >= i:
        s = 2.0 * math.sqrt(max(1e-30, 1.0 + a - e - i))
        q = (0.25 * s, (b + d) / s, (c + g) / s, (h - f) / s)
    elif e >= i:
        s = 2.0 * math.sqrt(max(1e-30, 1.0 + e - a - i))
        q = ((b + d) / s, 0.25 * s, (f + h) / s, (c - g) / s)
    else:
        s = 2.0 * math.sqrt(max(1e-30, 1.0 + i - a - e))
        q = ((c + g) / s, (f + h) / s, 0.25 * s, (d - b) / s)
    norm = math.copysign(math.sqrt(sum(v * v for v in q)), q[3] if q[3] != 0.0 else 1.0)
    return (q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm)


def _matrix(x: float, y: float, z: float, qx: float, qy: float, qz: float, qw: float) -> np.ndarray:
    if not math.isfinite(x + y + z):
        raise ValueError(f"position ({x}, {y}, {z}) is not finite")
    matrix = np.zeros((4, 4))
    matrix[:3, :3] = rotation(qx, qy, qz, qw)
    matrix[:, 3] = (x, y, z, 1.0)
    return matrix


def _six(values: tuple[float, ...], what: str) -> np.ndarray:
    if not math.isfinite(sum(values)):
        raise ValueError(f"{what} {values} is not finite")
    return np.array(values)


def pose(message: PoseStamped | StampedPose) -> np.ndarray:
    """(4, 4) frame_id_T_body."""
    if isinstance(message, StampedPose):
        return _matrix(*message.numbers)
    p, q = message.pose.position, message.pose.orientation
    return _matrix(p.x, p.y, p.z, q.x, q.y, q.z, q.w)


def transform(message: TransformStamped) -> np.ndarray:
    """(4, 4) frame_id_T_child."""
    p, q = message.transform.translation, message.transform.rotation
    return _matrix(p.x, p.y, p.z, q.x, q.y, q.z, q.w)


def twist(message: TwistStamped | StampedTwist) -> np.ndarray:
    """(6,) [m/s, rad/s] in frame_id."""
    if isinstance(message, StampedTwist):
        return _six(message.numbers, "twist")
    v, w = message.twist.linear, message.twist.angular
    return _six((v.x, v.y, v.z, w.x, w.y, w.z), "twist")


def wrench(message: WrenchStamped | StampedWrench) -> np.ndarray:
    """(6,) [N, N m] in frame_id."""
    if isinstance(message, StampedWrench):
        return _six(message.numbers, "wrench")
    f, t = message.wrench.force, message.wrench.torque
    return _six((f.x, f.y, f.z, t.x, t.y, t.z), "wrench")


def point(message: PointStamped) -> np.ndarray:
    """(3,) [m] in frame_id."""
    values = (message.point.x, message.point.y, message.point.z)
    if not math.isfinite(sum(values)):
        raise ValueError(f"point {values} is not finite")
    return np.array(values)


def positions(message) -> np.ndarray:
    """(n,) joint positions of a JointState, all finite."""
    values = np.array(message.position, dtype=float)
    if not np.isfinite(values).all():
        raise ValueError(f"joint positions {list(message.position)} are not all finite")
    return values


def in_frame(frame_id: str, read: Callable) -> Callable:
    """`read`, refusing messages whose header names another frame."""

    def check(message):
        if message.header.frame_id.lstrip("/") != frame_id:
            raise ValueError(f"frame_id '{message.header.frame_id}', must be '{frame_id}'")
        return read(message)

    return check


def pose_msg(matrix: np.ndarray, frame_id: str, stamp: rospy.Time | int) -> StampedPose:
    """A geometry_msgs/PoseStamped of a (4, 4) frame_id_T_body. stamp: ROS time, or nanoseconds since the epoch."""
    return StampedPose((*matrix[:3, 3].tolist(), *quaternion(matrix)), frame_id, _stamp_ns(stamp))


def transform_msg(matrix: np.ndarray, frame_id: str, child_frame_id: str, stamp: rospy.Time) -> TransformStamped:
    """TransformStamped of a (4, 4) frame_id_T_child."""
    message = TransformStamped()
    message.header.frame_id, message.header.stamp, message.child_frame_id = frame_id, stamp, child_frame_id
    p, q = message.transform.translation, message.transform.rotation
    p.x, p.y, p.z = matrix[:3, 3].tolist()
    q.x, q.y, q.z, q.w = quaternion(matrix)
    return message


def twist_msg(values: np.ndarray, frame_id: str, stamp: rospy.Time | int) -> StampedTwist:
    """A geometry_msgs/TwistStamped of a (6,) twist."""
    return StampedTwist(tuple(np.asarray(values, dtype=float).tolist()), frame_id, _stamp_ns(stamp))


def wrench_msg(values: np.ndarray, frame_id: str, stamp: rospy.Time | int) -> StampedWrench:
    """A geometry_msgs/WrenchStamped of a (6,) wrench."""
    return StampedWrench(tuple(np.asarray(values, dtype=float).tolist()), frame_id, _stamp_ns(stamp))


def _stamp_ns(stamp: rospy.Time | int) -> int:
    return stamp if isinstance(stamp, int) else stamp.secs * NANOSECONDS + stamp.nsecs
