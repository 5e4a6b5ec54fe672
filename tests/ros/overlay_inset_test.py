#!/usr/bin/env python3
"""The inset over the wire: there when somebody teleoperates, grey when he falls silent."""

from __future__ import annotations

import math
import sys
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point32, PointStamped, PolygonStamped, PoseStamped, WrenchStamped
from overlay_peers import EYES, HEIGHT, TOOLS, WIDTH, Peers
from saras_ros1.msg import Contact, CsaAdmittance, CsaTeleopState, ToolCollision
from sensor_msgs.msg import Image, PointCloud2, PointField
from support import Newest, wait_until

from saras.overlay import AwarenessInset, AwarenessView
from saras_ros1 import convert

GREEN, RED, WHITE, YELLOW = (40, 217, 80), (255, 38, 26), (255, 255, 255), (255, 214, 0)
CLOSEST, PROXY, TIP = np.array([0.1, 0.0, -0.1]), np.array([0.1, 0.0, -0.108]), np.array([0.112, 0.01, -0.1])
CORNERS = [(0.09, -0.01), (0.112, -0.01), (0.112, 0.012), (0.09, 0.012)]


class Controllers:
    """What the csa nodes say, at 50 Hz while `speaks`."""

    def __init__(self) -> None:
        self.speaks = True
        topics = {
            "teleop/state": CsaTeleopState, "slave/admittance": CsaAdmittance, "slave/measured_cp": PoseStamped,
            "proxy/measured_cp": PoseStamped, "proxy/closest": PointStamped, "proxy/contact": Contact,
            "master/servo_cf": WrenchStamped, "teleop/picked": PolygonStamped, "modeler/roi": PolygonStamped,
        }  # fmt: skip
        self._out = {
            name: rospy.Publisher(f"/csa/{name}", kind, queue_size=2, latch=kind is PolygonStamped)
            for name, kind in topics.items()
        }
        polygon = PolygonStamped()
        polygon.polygon.points = [Point32(x, y, -0.1) for x, y in CORNERS]
        self._out["teleop/picked"].publish(polygon)
        self._out["modeler/roi"].publish(polygon)
        threading.Thread(target=self._run, daemon=True).start()

    def _run(self) -> None:
        while not rospy.is_shutdown():
            time.sleep(0.02)
            if self.speaks:
                self._say(rospy.Time.now())

    def _say(self, now: rospy.Time) -> None:
        self._out["teleop/state"].publish(CsaTeleopState(state=CsaTeleopState.FULL_CONTACT, enabled=True))
        self._out["slave/admittance"].publish(CsaAdmittance(normal_force_N=2.0, desired_force_N=2.0))
        for name, at in (("slave/measured_cp", TIP), ("proxy/measured_cp", PROXY)):
            pose = np.eye(4)
            pose[:3, 3] = at
            self._out[name].publish(convert.pose_msg(pose, "PSM1", now))
        closest = PointStamped()
        closest.point.x, closest.point.y, closest.point.z = CLOSEST.tolist()
        self._out["proxy/closest"].publish(closest)
        contact = Contact(depth=0.008)
        contact.direction.z = 1.0
        self._out["proxy/contact"].publish(contact)
        self._out["master/servo_cf"].publish(convert.wrench_msg(np.array([0, 0, 2.0, 0, 0, 0]), "PSM1", now))


def cloud(rows: list) -> PointCloud2:
    """Vertices with stiffness and deviation, as the modeler publishes them."""
    names = ("x", "y", "z", "stiffness", "std")
    message = PointCloud2(height=1, width=len(rows), point_step=20, row_step=20 * len(rows))
    message.fields = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate(names)]
    message.data = np.array(rows, dtype=np.float32).tobytes()
    return message


def color(message: Image, point: np.ndarray) -> tuple[int, ...]:
    inset, view = AwarenessInset(WIDTH, HEIGHT), AwarenessView()
    view.center = CLOSEST
    column, row = inset.place(view, point)
    left, top, _, _ = inset.box
    image = np.frombuffer(message.data, np.uint8).reshape(HEIGHT, WIDTH, 3)
    return tuple(image[round(top + row), round(left + column), ::-1].tolist())


def yellowish(rgb: tuple[int, ...]) -> bool:
    """As the stiffest vertex: a dot of half a pixel is mixed with its ground."""
    return min(rgb[:2]) > 60 and rgb[2] < 0.5 * min(rgb[:2])


def in_box(message: Image, wanted: tuple[int, ...]) -> bool:
    left, top, width, height = AwarenessInset(WIDTH, HEIGHT).box
    image = np.frombuffer(message.data, np.uint8).reshape(HEIGHT, WIDTH, 3)[top : top + height, left : left + width]
    return bool((image[..., ::-1] == wanted).all(axis=2).any())


class OverlayInset(unittest.TestCase):
    def test_it_shows_what_is_said_and_nothing_when_it_is_old(self) -> None:
        rospy.init_node("overlay_inset_test")
        peers = Peers()
        for name in TOOLS:  # their shafts would be as green as the proxy
            peers.states[name], peers.metres[name] = ToolCollision.UNKNOWN, math.nan
        images = [Newest(f"/endoscope/{eye}/image_overlay", Image) for eye in EYES]
        wait_until(lambda: all(image.message for image in images), "pictures")
        for image in images:
            self.assertFalse(in_box(image.next(), GREEN), "nobody teleoperates")
        controllers = Controllers()
        corner = np.array([*CORNERS[0], -0.1])
        for point, wanted in ((PROXY, GREEN), (CLOSEST, RED), (TIP, WHITE), (corner, YELLOW)):
            wait_until(
                lambda point=point, wanted=wanted: all(color(i.message, point) == wanted for i in images),
                lambda point=point: f"{point}: {[color(i.message, point) for i in images]}",
            )
        map_out = rospy.Publisher("/csa/modeler/stiffness", PointCloud2, queue_size=1)
        at = CLOSEST + np.array([-0.008, 0.014, 0.0])

        def mapped() -> bool:
            map_out.publish(cloud([[*at, 900.0, 1.0], [0.0, 0.0, 0.0, 100.0, 1.0], [0.0, 0.0, 0.0, np.nan, np.inf]]))
            return all(yellowish(color(i.message, at)) for i in images)

        wait_until(mapped, lambda: f"{[color(i.message, at) for i in images]}")
        broken = cloud([[*at, 900.0, 1.0]])
        broken.width = 1000
        map_out.publish(broken)  # less data than it says: no map
        wait_until(lambda: not any(yellowish(color(i.message, at)) for i in images), "no map")
        controllers.speaks = False
        wait_until(lambda: not any(in_box(i.message, c) for i in images for c in (GREEN, RED, WHITE)), "grey")
        controllers.speaks = True
        wait_until(lambda: all(color(i.message, PROXY) == GREEN for i in images), "it is back")
        peers.frozen["left"] = True
        wait_until(lambda: not any(in_box(i.message, GREEN) for i in images), "nothing over a frozen picture")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "overlay_inset", OverlayInset, sys.argv)
