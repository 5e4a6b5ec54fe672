"""csa_display: markers for rviz on /csa/markers, and the frame csa_view where the tip starts. Displays only."""

from __future__ import annotations

import os
from collections import deque

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import Point, PointStamped, PolygonStamped, PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import MarkerArray

from saras.csa import arms
from saras.csa.setup import PHANTOM_HEIGHT_M, UP
from saras_ros1 import convert
from saras_ros1 import csa_markers as markers
from saras_ros1.csa_node import CsaNode
from saras_ros1.latest import Latest
from saras_ros1.markers import RED, WHITE, ball
from saras_ros1.msg import CsaAdmittance, CsaTeleopState
from saras_ros1.node import run

DISPLAY_HZ = 15.0
JOINTS_HZ = 10.0
TRAIL_POINTS = 1500
TRAIL_EVERY = 5  # drawings; it is long, and changes slowly
LIFT_M = 0.0003
LABEL_M = 0.022
STEEL = ColorRGBA(0.75, 0.78, 0.82, 0.8)
FOREVER_S = float("inf")  # latched


class CsaDisplay(CsaNode):
    """Timers only."""

    def __init__(self) -> None:
        os.nice(5)  # when the processor is short, control goes before pictures
        super().__init__("csa_display")
        self.told = Latest("/csa/teleop/state", CsaTeleopState)
        self.did = Latest("/csa/slave/admittance", CsaAdmittance)
        self.tip, self.proxy = (
            Latest("/csa/slave/measured_cp", PoseStamped),
            Latest("/csa/proxy/measured_cp", PoseStamped),
        )
        self.closest = Latest("/csa/proxy/closest", PointStamped)
        self.wrench = Latest("/csa/master/servo_cf", WrenchStamped)
        self.picked, self.region = (
            Latest("/csa/teleop/picked", PolygonStamped),
            Latest("/csa/modeler/roi", PolygonStamped),
        )
        self.next_location = Latest("/csa/modeler/next_location", PointStamped)
        self.joints = Latest(arms.topic(self.setup.slave, "measured_js"), JointState)
        self.joints_out = self.output(f"/visualization/{self.slave}/joint_states", JointState)
        self.markers = self.output("/csa/markers", MarkerArray)
        self.trail: deque = deque(maxlen=TRAIL_POINTS)
        self.count = 0
        self.start, self.surface = self.setup.start(), self.setup.surface()
        self.view = tf2_ros.StaticTransformBroadcaster()
        view_T_base = np.eye(4)
        view_T_base[:3, 3] = -self.start
        self.view.sendTransform(convert.transform_msg(view_T_base, "csa_view", self.frame, rospy.Time.now()))
        self.every(1.0 / DISPLAY_HZ, self._publish)
        self.every(1.0 / JOINTS_HZ, self._publish_joints)

    def _publish_joints(self) -> None:
        message = self.joints.value()
        if message is not None:
            self.joints_out.publish(message)

    def _publish(self) -> None:
        self.count += 1
        frame, told, did = self.frame, self.told.value(), self.did.value()
        tip, proxy, closest = (_at(latest.value()) for latest in (self.tip, self.proxy, self.closest))
        touching = told is not None and told.state in (CsaTeleopState.SLAVE_CONTACT, CsaTeleopState.FULL_CONTACT)
        if tip is not None and touching:
            self.trail.append(self._on_model(tip))
        next_location = _at(self.next_location.value())
        picked = [self._on_model(point) for point in _points(self.picked.value(FOREVER_S))]
        shown = [
            *self._phantom(),
            markers.shaft("slave", frame, tip, STEEL, 0.003),
            ball("tip", frame, tip, WHITE, 0.0034),
            ball("proxy", frame, proxy, markers.GREEN, 0.004),
            ball("closest point", frame, closest, RED, 0.003),
            markers.force(frame, closest, self.wrench.value()),
            *markers.region(frame, picked, bool(_points(self.region.value(FOREVER_S)))),
            *([markers.trail(frame, list(self.trail))] if self.count % TRAIL_EVERY == 0 else []),
            ball("next location", frame, next_location, markers.NEXT, 0.0025),
            markers.label(frame, self.start + LABEL_M * UP, told, did),
        ]
        self.markers.publish(MarkerArray(shown))

    def _on_model(self, point) -> Point:
        """Lifted to the model's surface: what is pressed in would be drawn under it."""
        at = np.array([point.x, point.y, point.z])
        touch = self.surface.touch(at)
        return Point(*(touch.closest + LIFT_M * touch.normal if touch.depth_m > 0.0 else at).tolist())

    def _phantom(self) -> list:
        phantom = self.setup.phantom()
        if not phantom:
            return []
        top = self.start - phantom.get("height_m", PHANTOM_HEIGHT_M) * UP
        tissue = self.setup.tissue_config()
        at = top + np.array([tissue.inclusion_x_m, tissue.inclusion_y_m, -0.002])
        shown = [
            markers.block("phantom", self.frame, top, markers.THICKNESS_M, markers.SILICONE),
            markers.lump(self.frame, at, tissue.inclusion_radius_m),
        ]
        if "model" not in self.setup.teleop:
            surface = top + phantom.get("model_error_m", 0.0) * UP
            shown.append(markers.block("model", self.frame, surface, 0.0003, markers.MODEL))
        return shown


def _at(message) -> Point | None:
    if message is None:
        return None
    return message.point if hasattr(message, "point") else message.pose.position


def _points(message) -> list:
    return [] if message is None else message.polygon.points


def main() -> int:
    """Runs the node."""
    return run(CsaDisplay)
