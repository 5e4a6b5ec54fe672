"""The topics of situational awareness as arrays, for `saras csa shell`."""

from __future__ import annotations

from typing import Any, Callable

import numpy as np
import rosgraph
import rospy
from geometry_msgs.msg import PointStamped, PoseStamped, TwistStamped, WrenchStamped
from sensor_msgs.msg import PointCloud2, PointField
from visualization_msgs.msg import Marker

from saras import ConfigError
from saras.csa.live_arrays import LiveArrays
from saras_ros1.msg import CsaTeleopState

STATES = {
    CsaTeleopState.NO_CONTACT: "NO_CONTACT",
    CsaTeleopState.PROXY_CONTACT: "PROXY_CONTACT",
    CsaTeleopState.SLAVE_CONTACT: "SLAVE_CONTACT",
    CsaTeleopState.FULL_CONTACT: "FULL_CONTACT",
}


def follow(live: LiveArrays, namespace: str = "/csa") -> None:
    """Makes this process an anonymous node that binds what comes. Raises ConfigError: no ROS master."""
    if not rosgraph.is_master_online():
        raise ConfigError(f"no ROS master at {rosgraph.get_master_uri()}: start roscore or csa.launch first")
    if not rospy.core.is_initialized():
        rospy.init_node("csa_shell", anonymous=True, disable_signals=True)

    def sample(part: str, read: Callable[[Any], Any]) -> Callable[[Any], None]:
        return lambda message: live.sample(message.header.stamp.to_nsec(), part, vector(read(message)))

    def teleop(message: CsaTeleopState) -> None:
        state = STATES.get(message.state, f"unknown state {message.state}")
        live.came("state", f"{state}, {message.reason or 'held'}" if message.hold else state)
        live.came("desired", vector(message.desired.position))
        live.came("mismatch", np.array(message.mismatch_m))

    def cloud(message: PointCloud2) -> None:
        rows = read_map(message)
        for name, value in zip(("vertices", "stiffness", "std"), (rows[:, :3], rows[:, 3], rows[:, 4])):
            live.came(name, value)

    def mesh(message: Marker) -> None:
        if message.type == Marker.TRIANGLE_LIST:
            live.came("mesh", np.array([(p.x, p.y, p.z) for p in message.points]).reshape(-1, 3, 3))

    for topic, kind, receive in (
        ("slave/measured_cp", PoseStamped, sample("tip", lambda message: message.pose.position)),
        ("slave/measured_cf", WrenchStamped, sample("force", lambda message: message.wrench.force)),
        ("slave/measured_cv", TwistStamped, sample("velocity", lambda message: message.twist.linear)),
        ("proxy/measured_cp", PoseStamped, lambda message: live.came("proxy", vector(message.pose.position))),
        ("teleop/state", CsaTeleopState, teleop),
        ("modeler/next_location", PointStamped, lambda message: live.came("next_location", vector(message.point))),
        ("modeler/stiffness", PointCloud2, cloud),
        ("modeler/mesh", Marker, mesh),
    ):
        # The map is large and only the newest counts; of samples each one does.
        queue = 1 if kind in (PointCloud2, Marker) else 1000
        rospy.Subscriber(f"{namespace}/{topic}", kind, receive, queue_size=queue, buff_size=1 << 24)


def vector(message: Any) -> np.ndarray:
    """(3,) of a Point or Vector3."""
    return np.array([message.x, message.y, message.z])


def read_map(message: PointCloud2) -> np.ndarray:
    """(n, 5): x, y, z [m], stiffness, std [N/m]. Raises ValueError: not those fields as float32, or another size."""
    offsets = {field.name: field.offset for field in message.fields if field.datatype == PointField.FLOAT32}
    names = ("x", "y", "z", "stiffness", "std")
    if message.is_bigendian or not set(names) <= set(offsets):
        raise ValueError(
            f"a stiffness map has fields {', '.join(names)} as little-endian float32, not {sorted(offsets)}"
        )
    layout = {
        "names": names,
        "formats": ["<f4"] * len(names),
        "offsets": [offsets[name] for name in names],
        "itemsize": message.point_step,
    }
    rows = np.frombuffer(message.data, dtype=np.dtype(layout), count=message.width * message.height)
    return np.stack([rows[name] for name in names], axis=1).astype(float)
