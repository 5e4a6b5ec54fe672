"""A stiffness map as messages. Their bytes come from arrays: an object a vertex would keep the interpreter for tenths
of a second.
"""

from __future__ import annotations

import io
import struct
from typing import Any

import numpy as np
import rospy
from sensor_msgs.msg import PointCloud2, PointField
from visualization_msgs.msg import Marker

from saras.model.storage import MIDDLE, SOFT, STIFF, UNKNOWN

#: Behind points and colours of a Marker: text, mesh_resource, mesh_use_embedded_materials.
TAIL = 9
EMPTY_LISTS = 8


class MeshMarker(Marker):
    """TRIANGLE_LIST of arrays: points (3 m, 3) and colours (3 m, 4), red green blue alpha in [0, 1]."""

    _type, _md5sum, _full_text = Marker._type, Marker._md5sum, Marker._full_text
    corner_points: np.ndarray
    corner_colours: np.ndarray

    def serialize(self, buff: Any) -> None:
        """Writes the standard message's bytes."""
        plain = io.BytesIO()
        super().serialize(plain)
        data = plain.getvalue()
        count = struct.pack("<I", len(self.corner_points))
        buff.write(data[: -(TAIL + EMPTY_LISTS)])
        buff.write(count + self.corner_points.astype("<f8").tobytes())
        buff.write(count + self.corner_colours.astype("<f4").tobytes())
        buff.write(data[-TAIL:])


def colours(
    stiffness: np.ndarray, std: np.ndarray, low_N_m: float, high_N_m: float, faded_std_N_m: float
) -> np.ndarray:
    """(n, 4) from dark (soft) over green to yellow (stiff); the less is known the greyer; grey: nothing is."""
    known = np.isfinite(stiffness) & np.isfinite(std)
    share = np.clip((np.where(known, stiffness, low_N_m) - low_N_m) / (high_N_m - low_N_m), 0.0, 1.0)
    ramp = np.array([SOFT, MIDDLE, STIFF], dtype=float) / 255.0
    painted = np.column_stack([np.interp(share, [0.0, 0.5, 1.0], ramp[:, k]) for k in range(3)])
    certain = np.where(known, np.clip(1.0 - np.where(known, std, 0.0) / faded_std_N_m, 0.0, 1.0), 0.0)[:, None]
    grey = np.array(UNKNOWN, dtype=float) / 255.0
    return np.column_stack([certain * painted + (1.0 - certain) * grey, np.ones(len(share))])


def mesh_marker(
    frame: str, stamp: rospy.Time, vertices: np.ndarray, triangles: np.ndarray, painted: np.ndarray
) -> MeshMarker:
    """Vertices (n, 3) [m], triangles (m, 3), painted (n, 4)."""
    marker = MeshMarker(ns="stiffness", type=Marker.TRIANGLE_LIST, action=Marker.ADD)
    marker.header.frame_id, marker.header.stamp = frame, stamp
    marker.pose.orientation.w = 1.0
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0
    marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1.0
    marker.frame_locked = True
    corners = triangles.reshape(-1)
    marker.corner_points, marker.corner_colours = vertices[corners], painted[corners]
    return marker


def cloud(
    frame: str,
    stamp: rospy.Time,
    vertices: np.ndarray,
    stiffness: np.ndarray,
    std: np.ndarray,
    indices: np.ndarray | None = None,
) -> PointCloud2:
    """Fields x, y, z [m], stiffness, std [N/m], and with indices (n,) the vertex. Unknown: NaN and infinite."""
    names = ["x", "y", "z", "stiffness", "std"]
    fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate(names)]
    kind = [(name, "<f4") for name in names]
    if indices is not None:
        fields.append(PointField("vertex", 4 * len(names), PointField.UINT32, 1))
        kind.append(("vertex", "<u4"))
    rows = np.empty(len(vertices), dtype=kind)
    for i, name in enumerate("xyz"):
        rows[name] = vertices[:, i]
    rows["stiffness"], rows["std"] = stiffness, std
    if indices is not None:
        rows["vertex"] = indices
    size = rows.dtype.itemsize
    message = PointCloud2(
        height=1, width=len(rows), fields=fields, point_step=size, row_step=size * len(rows), is_dense=False
    )
    message.header.frame_id, message.header.stamp = frame, stamp
    message.data = rows.tobytes()
    return message


def read_cloud(message: PointCloud2) -> np.ndarray:
    """The structured rows of what cloud() made."""
    kinds = {PointField.FLOAT32: "<f4", PointField.UINT32: "<u4"}
    layout = {
        "names": [f.name for f in message.fields],
        "formats": [kinds[f.datatype] for f in message.fields],
        "offsets": [f.offset for f in message.fields],
        "itemsize": message.point_step,
    }
    return np.frombuffer(message.data, dtype=np.dtype(layout))
