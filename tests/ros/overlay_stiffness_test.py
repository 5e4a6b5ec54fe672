#!/usr/bin/env python3
"""The stiffness map over the wire: in its place in both eyes; gone, and said, when it is old or its frame unknown."""

from __future__ import annotations

import sys
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point
from overlay_peers import EYES, FOCAL, HEIGHT, WIDTH, Peers, in_world
from sensor_msgs.msg import Image, PointCloud2, PointField
from support import Newest, wait_until
from visualization_msgs.msg import Marker

#: In the camera's frame: two triangles side by side between the tools' shafts, the right one not known.
CORNERS = [(-0.03, 0.004, 0.1), (-0.01, 0.004, 0.1), (-0.02, 0.0095, 0.1), (-0.005, 0.0095, 0.1), (0.01, 0.004, 0.1)]
TRIANGLES = [(0, 1, 2), (1, 3, 4)]
STIFFNESS, STD = [1200.0, 1200.0, 1200.0, np.nan, 1200.0], [0.0, 0.0, 0.0, np.inf, 0.0]


class Modeler:
    """The map, 5 times a second while `speaks`."""

    def __init__(self) -> None:
        self.speaks, self.frame = True, "world"
        self._cloud = rospy.Publisher("/csa/modeler/stiffness", PointCloud2, queue_size=1)
        self._mesh = rospy.Publisher("/csa/modeler/mesh", Marker, queue_size=1)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        points = [in_world(corner) for corner in CORNERS]
        names = ["x", "y", "z", "stiffness", "std"]
        rows = np.array([(p.x, p.y, p.z, k, s) for p, k, s in zip(points, STIFFNESS, STD)], dtype="<f4")
        fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate(names)]
        cloud = PointCloud2(height=1, width=5, fields=fields, point_step=20, row_step=100, data=rows.tobytes())
        mesh = Marker(
            type=Marker.TRIANGLE_LIST,
            points=[Point(p.x, p.y, p.z) for t in TRIANGLES for p in map(points.__getitem__, t)],
        )
        mesh.pose.orientation.w = 1.0
        while not rospy.is_shutdown():
            time.sleep(0.2)
            if self.speaks:
                cloud.header.stamp = mesh.header.stamp = rospy.Time.now()
                cloud.header.frame_id = mesh.header.frame_id = self.frame
                self._cloud.publish(cloud)
                self._mesh.publish(mesh)


def color(message: Image, eye: str, triangle: int) -> np.ndarray:
    """Blue, green, red in the middle of a triangle, the mean of some pixels: the ground is noise."""
    x, y, z = np.mean([CORNERS[i] for i in TRIANGLES[triangle]], axis=0)
    x -= 0.005 if eye == "right" else 0.0
    column, row = round(WIDTH / 2 + FOCAL * x / z), round(HEIGHT / 2 + FOCAL * y / z)
    image = np.frombuffer(message.data, np.uint8).reshape(HEIGHT, WIDTH, 3).astype(float)
    return image[row - 1 : row + 2, column - 1 : column + 2].mean(axis=(0, 1))


class OverlayStiffness(unittest.TestCase):
    def test_it_is_where_it_belongs_and_gone_when_it_is_not_known(self) -> None:
        rospy.init_node("overlay_stiffness_test")
        Peers()
        images = {eye: Newest(f"/endoscope/{eye}/image_overlay", Image) for eye in EYES}
        reports = Newest("/diagnostics", DiagnosticArray)

        def shown() -> bool:
            """Yellow on the left, faint grey on the right triangle, in both eyes."""
            for eye, image in images.items():
                blue, green, red = color(image.message, eye, 0)
                grey = color(image.message, eye, 1)
                if not (red > 120 and green > 110 and blue < 60 and np.ptp(grey) < 6 and 31 < grey.mean() < 60):
                    return False
            return True

        def ground() -> bool:
            return all(color(i.message, e, t).max() < 31 for e, i in images.items() for t in range(2))

        def said() -> str:
            values = [
                pair.value
                for report in reports.all[-50:]
                for status in report.status
                if status.name == "/visual_feedback"
                for pair in status.values
                if pair.key == "stiffness_map"
            ]
            return values[-1] if values else ""

        def seen() -> str:
            return str([(e, t, color(i.message, e, t)) for e, i in images.items() for t in range(2)]) + said()

        wait_until(lambda: all(image.message for image in images.values()), "pictures")
        wait_until(lambda: said() == "no map yet" and ground(), lambda: f"no map is said: {said()!r}")
        modeler = Modeler()
        wait_until(shown, lambda: f"a map: {seen()}")
        wait_until(lambda: said() == "drawn", lambda: f"it is told: {said()}")
        modeler.frame = "nowhere"
        wait_until(lambda: ground() and "tf does not know its frame nowhere" in said(), lambda: f"no frame: {seen()}")
        modeler.frame = "world"
        wait_until(shown, lambda: f"it is back: {seen()}")
        modeler.speaks = False
        wait_until(lambda: ground() and "too old" in said(), lambda: f"it grows old: {seen()}")
        modeler.speaks = True
        wait_until(shown, lambda: f"it is back again: {seen()}")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "overlay_stiffness", OverlayStiffness, sys.argv)
