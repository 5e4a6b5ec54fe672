"""visualization: joint states for the drawn devices, and markers. Displays only; nothing depends on it."""

from __future__ import annotations

import os
from collections import deque

import numpy as np
import rospy
from geometry_msgs.msg import Point, PointStamped, PoseStamped, WrenchStamped
from sensor_msgs.msg import JointState
from visualization_msgs.msg import MarkerArray

from saras.kinematics import mesa, simball
from saras_ros1 import convert, fixture_markers, markers
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.fixtures import read_file
from saras_ros1.latest import Latest
from saras_ros1.msg import ChannelState, RecorderState, SideFixtures, TankState
from saras_ros1.node import Node, run

LABEL_HEIGHT_M = 0.33
ARM, HANDLE = mesa.arm(), simball.handle()
TOUCH_T_SIMBALL = np.linalg.inv(simball.SIMBALL_T_TOUCH_BASE)


class Side:
    """One arm and one hand piece."""

    def __init__(self, node: Visualization, side: str) -> None:
        self.side, self.frame, self.console = side, base_frame(side), f"touchball_{side}"
        self.arm_joints = Latest(f"/mesa_{side}/joint_states", JointState)
        self.tool = Latest(f"/mesa_{side}/tool", JointState)
        self.set_point = Latest(f"/mesa_{side}/set_point", PoseStamped)
        self.tissue = Latest(f"/mesa_{side}/measured_cf", WrenchStamped)
        self.rcm = Latest(f"/mesa_{side}/rcm", PointStamped)  # latched: never too old
        self.hand_joints = Latest(f"/{self.console}/joint_states", JointState)
        self.hand = Latest(f"/touchball_{side}/wrench", WrenchStamped)
        self.state = Latest(f"/system/{side}/state", ChannelState)
        self.guard = Latest(f"/port_guard_{side}/state", TankState)
        entries = node.fixtures.of(side) if node.fixtures is not None else ()
        self.fixtures = Latest(f"/fixtures/{side}", SideFixtures) if entries else None
        self.borders = {known: [fixture_markers.shape(e, side, not known) for e in entries] for known in (False, True)}
        self.trail: deque = deque(maxlen=markers.TRAIL_POINTS)
        self.arm_out = node.output(f"/visualization/mesa_{side}/joint_states", JointState)
        self.passive_out = node.output(f"/visualization/mesa_{side}/passive/joint_states", JointState)
        self.console_out = node.output(f"/visualization/{self.console}/joint_states", JointState)

    def publish_joints(self) -> None:
        """Arm with its jaw; hand piece with the Touch that carries it. Unknown ones stay where they were drawn."""
        now = rospy.Time.now()
        arm, tool = self.arm_joints.value(), self.tool.value()
        if arm is not None:
            # Each description gets its own joints: robot_state_publisher warns of others.
            by_name = dict(zip(arm.name, arm.position))
            passive = [name for name in arm.name if "/passive_" in name]
            stand = JointState(name=passive, position=[by_name.pop(name) for name in passive])
            stand.header.stamp = now
            self.passive_out.publish(stand)
            message = JointState(name=list(by_name), position=list(by_name.values()))
            if tool is not None and len(tool.position) > 1:
                message.name.append(f"mesa_{self.side}/jaw")
                message.position.append(tool.position[1])
            message.header.stamp = now
            self.arm_out.publish(message)
        hand = self.hand_joints.value()
        if hand is not None:
            touch = simball.touch_joints_from_handle(HANDLE.forward(convert.positions(hand)))
            names = [f"{self.console}/{name}" for name in simball.TOUCH_JOINT_NAMES]
            message = JointState(name=[*hand.name, *names], position=[*hand.position, *touch.tolist()])
            message.header.stamp = now
            self.console_out.publish(message)

    def markers(self, tanks: dict[str, TankState | None]) -> list:
        """All markers of this side."""
        s, frame = self.side, self.frame
        set_point, rcm, at = self.set_point.value(), self.rcm.value(float("inf")), self._tip()
        if at is not None:
            self.trail.append(at)
        energies = {"guard": self.guard.value(), **tanks}
        return [
            markers.force(f"{s} force on tissue", frame, at, self.tissue.value()),
            markers.ball(f"{s} set-point", frame, set_point and set_point.pose.position, markers.BLUE, 0.008),
            markers.trail(f"{s} trail", frame, list(self.trail), markers.BLUE),
            markers.ball(f"{s} trocar", frame, rcm and rcm.point, markers.WHITE, 0.006),
            markers.force(f"{s} force on hand", f"{self.console}/touch_base", self._hand_in_touch(), self.hand.value()),
            markers.label(f"{s} state", frame, LABEL_HEIGHT_M, self.state.value(), energies),
            *self._fixture_markers(),
        ]

    def _fixture_markers(self) -> list:
        """Borders and the nearest point; grey while nobody says where they are."""
        if self.fixtures is None:
            return []
        message = self.fixtures.value()
        known = message is not None and message.nearest >= 0
        return [*self.borders[known], *fixture_markers.state(self.side, message)]

    def _tip(self) -> Point | None:
        """The tool tip in the arm's base, from the joints."""
        joints = self.arm_joints.value()
        if joints is None:
            return None
        angles = dict(zip(joints.name, joints.position))
        q = [angles.get(f"mesa_{self.side}/{name}", np.nan) for name in mesa.JOINT_NAMES]
        return Point(*ARM.forward(q)[:3, 3].tolist()) if np.isfinite(q).all() else None

    def _hand_in_touch(self) -> Point | None:
        """Where the hand is, in the frame of its force."""
        hand = self.hand_joints.value()
        if hand is None:
            return None
        return Point(*(TOUCH_T_SIMBALL @ HANDLE.forward(convert.positions(hand)))[:3, 3].tolist())


class Visualization(Node):
    """Timers only: no law steps here."""

    def __init__(self) -> None:
        os.nice(5)  # when the processor is short, control goes before pictures
        super().__init__("visualization")
        joints_hz = self.params.number("joints_hz", 1.0, 60.0)
        markers_hz = self.params.number("markers_hz", 1.0, 60.0)
        self.params.finish()
        self.tanks = {name: Latest(f"/tank_{name}/state", TankState) for name in ("master", "slave")}
        self.fixtures = read_file()
        self.recorder = Latest("/recorder/state", RecorderState)
        self.sides = [Side(self, side) for side in SIDES]
        self.markers = self.output("/saras/markers", MarkerArray)
        self.every(1.0 / joints_hz, self._publish_joints)
        self.every(1.0 / markers_hz, self._publish_markers)

    def _publish_joints(self) -> None:
        for side in self.sides:
            side.publish_joints()

    def _publish_markers(self) -> None:
        tanks = {name: latest.value() for name, latest in self.tanks.items()}
        shown = [marker for side in self.sides for marker in side.markers(tanks)]
        self.markers.publish(MarkerArray([*shown, markers.recording(self.recorder.value())]))


def main() -> int:
    """Runs the node."""
    return run(Visualization)
