#!/usr/bin/env python3
"""Distances over the wire: right numbers, unknown in time, the speed bound. Tests run in the order of their names."""

from __future__ import annotations

import math
import unittest

import numpy as np
import rosnode
import rospy
import rostest
from collision_peers import TROCARS, Peers, at
from geometry_msgs.msg import PoseStamped
from saras_ros1.msg import CollisionState, ToolCollision
from std_msgs.msg import Float64MultiArray
from support import Newest, wait_until
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from saras.collision import capsule_capsule, capsule_parallelepiped
from saras_ros1 import convert

UNKNOWN, CLEAR, WARNING, COLLISION = range(4)
RADII = {"mesa_left": 0.0025, "mesa_right": 0.0025, "PSM1": 0.0042, "PSM2": 0.0042, "ECM": 0.006}
BONES = at(-0.15, -0.05, 0.0)
REGION = np.array(
    [[0, 0, -1], [1, 0, -1], [1, 0, 0], [0, 0, 0], [0, 1, -1], [1, 1, -1], [1, 1, 0], [0, 1, 0]], dtype=float
)
LIMIT_S = 0.15


class Collision(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("collision_test")
        cls.peers = Peers()
        cls.state = Newest("/collision/state", CollisionState)
        cls.distances = Newest("/collision/distances", Float64MultiArray)
        cls.set_point = Newest("/mesa_left/set_point", PoseStamped)

    def tool(self, name: str) -> ToolCollision:
        message = self.state.message
        return next((tool for tool in message.tools if tool.name == name), None) if message else None

    def await_state(self, name: str, *states: int, reason: str = "") -> ToolCollision:
        def there() -> ToolCollision | None:
            tool = self.tool(name)
            return tool if tool is not None and tool.state in states and reason in tool.reason else None

        return wait_until(there, lambda: f"{name} in {states} because of {reason!r}; last: {self.tool(name)}")

    def expected(self, name: str) -> float:
        """The least of the core's own distances, without scene and broad phase."""
        ends = {n: (np.array(tip), np.array(TROCARS[n]), RADII[n]) for n, tip in self.peers.tips.items()}
        a = ends.pop(name)
        least = min(capsule_capsule(*a, *b).distance for b in ends.values())
        bones = self.peers.bones
        return min(least, capsule_parallelepiped(*a, 0.1 * REGION + bones[:3, 3]).distance)

    def test_01_without_bones_nothing_is_clear(self) -> None:
        tool = self.await_state("mesa_left", UNKNOWN, reason="regions: no transform")
        self.assertTrue(math.isnan(tool.distance))
        wait_until(lambda: math.isfinite(self.tool("mesa_left").known_distance), "the other tools known")
        for _ in range(20):
            message = self.state.next()
            self.assertTrue(all(tool.state != CLEAR for tool in message.tools), message)
        self.assertTrue(all(math.isnan(value) for value in self.distances.next().data))

    def test_02_distances_are_right_and_in_the_sources_order(self) -> None:
        self.peers.bones = BONES
        for name in RADII:
            self.await_state(name, CLEAR)
        message = self.distances.next()
        self.assertEqual(message.layout.dim[0].label, "mesa_left,mesa_right,PSM1,PSM2,ECM")
        for name, value in zip(RADII, message.data):
            self.assertAlmostEqual(value, self.expected(name), places=9, msg=name)
        tool = self.tool("mesa_left")
        self.assertEqual(tool.partner, "region_1" if tool.known_distance < 0.0949 else "mesa_right")
        normal = np.array([tool.normal.x, tool.normal.y, tool.normal.z])
        ours, theirs = (np.array([p.x, p.y, p.z]) for p in (tool.on_tool, tool.on_partner))
        np.testing.assert_allclose(theirs - ours, tool.known_distance * normal, atol=1e-12)

    def test_03_states_follow_the_distance_with_hysteresis(self) -> None:
        def height(distance: float) -> None:
            self.peers.tips["mesa_left"] = np.array([-0.1, 0.04, distance + RADII["mesa_left"]])

        for distance, state in ((0.008, WARNING), (0.0105, WARNING), (0.012, CLEAR), (0.001, COLLISION)):
            height(distance)
            wait_until(lambda d=distance: abs(self.tool("mesa_left").known_distance - d) < 1e-6, "the tip there")
            self.await_state("mesa_left", state)
        height(-0.004)
        tool = self.await_state("mesa_left", COLLISION)
        wait_until(lambda: abs(self.tool("mesa_left").distance + 0.004) < 1e-6, "the depth")
        self.assertEqual(tool.partner, "region_1")
        height(0.1)
        self.await_state("mesa_left", CLEAR)

    def test_04_markers_show_capsules_boxes_and_witness_lines(self) -> None:
        markers = Newest("/collision/markers", MarkerArray)
        names = {marker.ns for marker in markers.next().markers}
        self.assertIn("forbidden regions", names)
        for tool in RADII:
            self.assertTrue({f"{tool} shaft", f"{tool} witness", f"{tool} distance"} <= names, names)
        markers.subscriber.unregister()

    def becomes_unknown(self, name: str, silence, speak, reason: str) -> None:
        """Best of some trials: a busy machine only adds."""
        delays = []
        for _ in range(5):
            speak()
            self.await_state(name, CLEAR)
            self.state.clear()
            last = rospy.Time.now()
            silence()
            tool = self.await_state(name, UNKNOWN, reason=reason)
            self.assertTrue(math.isnan(tool.distance))
            first = next(m for m in self.state.all if any(t.name == name and t.state == UNKNOWN for t in m.tools))
            delays.append((first.header.stamp - last).to_sec())
        speak()
        self.assertLess(min(delays), LIMIT_S, delays)

    def test_05_a_silent_da_vinci_is_unknown_in_time(self) -> None:
        self.becomes_unknown(
            "PSM1",
            lambda: self.peers.tips.pop("PSM1"),
            lambda: self.peers.tips.setdefault("PSM1", np.array(TROCARS["PSM1"]) - (0, 0, 0.1)),
            "PSM1",
        )
        self.await_state("mesa_right", CLEAR)

    def test_06_a_silent_arm_is_unknown_to_itself_and_to_others(self) -> None:
        self.becomes_unknown(
            "mesa_right",
            lambda: self.peers.tips.pop("mesa_right"),
            lambda: self.peers.tips.setdefault("mesa_right", np.array(TROCARS["mesa_right"]) - (0, 0, 0.1)),
            "mesa_right",
        )
        self.peers.tips.pop("mesa_right")
        self.await_state("mesa_left", UNKNOWN, reason="mesa_right")
        self.peers.tips["mesa_right"] = np.array(TROCARS["mesa_right"]) - (0, 0, 0.1)
        self.await_state("mesa_left", CLEAR)

    def test_07_stale_bones_are_unknown_in_time(self) -> None:
        self.becomes_unknown(
            "mesa_left",
            lambda: setattr(self.peers, "bones", None),
            lambda: setattr(self.peers, "bones", BONES),
            "ms old",
        )

    def test_08_a_da_vinci_that_is_not_enabled_is_unknown(self) -> None:
        self.await_state("PSM2", CLEAR)
        self.peers.states["PSM2"] = "FAULT"
        self.await_state("PSM2", UNKNOWN, reason="FAULT")
        self.peers.states["PSM2"] = "ENABLED"
        self.await_state("PSM2", CLEAR)

    def test_09_bad_transforms_are_refused(self) -> None:
        self.await_state("mesa_left", CLEAR)
        self.peers.bones = None
        self.await_state("mesa_left", UNKNOWN)
        for spoil in ({"x": math.inf}, {"x": math.nan}):
            transform = convert.transform_msg(BONES, "world", "bones_marker_frame", rospy.Time.now())
            for name, value in spoil.items():
                setattr(transform.transform.translation, name, value)
            self.peers.tf.publish(TFMessage([transform]))
            transform.transform.translation.x = 0.0
            transform.transform.rotation.w = 2.0
            self.peers.tf.publish(TFMessage([transform]))
        for _ in range(10):
            message = self.state.next()
            self.assertTrue(all(tool.state != CLEAR for tool in message.tools), message)
        self.peers.bones = BONES
        self.await_state("mesa_left", CLEAR)

    def test_09a_a_lost_connection_is_made_anew(self) -> None:
        """roscpp does so; rospy leaves the topic silent for good."""
        self.await_state("mesa_left", CLEAR)
        for _ in range(3):
            lost = list(self.peers.tf.impl.connections)
            self.assertGreater(len(lost), 0)
            for connection in lost:
                connection.close()
            wait_until(lambda lost=lost: set(self.peers.tf.impl.connections) - set(lost), "a new connection")
            rospy.sleep(2.0 * LIMIT_S)  # what came before is old now
            self.await_state("mesa_left", CLEAR)

    # ---- what it allows the left arm

    def speed(self, twist: tuple[float, float, float], steps: int = 30) -> float:
        """Fastest mean speed over 5 set-points that this command gives along itself [m/s].

        A set-point that repeats the last one is left out: a step without a twist is stamped with the time at which it
        was taken, the next twist with that at which it was sent; between the two nothing was covered.
        """
        self.peers.twist = np.array([*twist, 0.0, 0.0, 0.0])
        wait_until(lambda: len(self.set_point.all) > 0, "a set-point")
        self.set_point.clear()
        wait_until(lambda: len(self.set_point.all) > steps, "set-points")
        self.peers.twist = np.zeros(6)
        path = np.array([convert.pose(m)[:3, 3] for m in self.set_point.all])
        times = np.array([m.header.stamp.to_sec() for m in self.set_point.all])
        moved = np.concatenate([[True], np.any(np.diff(path, axis=0) != 0.0, axis=1)])
        along, times = path[moved] @ (np.array(twist) / np.linalg.norm(twist)), times[moved]
        return float(np.max((along[5:] - along[:-5]) / (times[5:] - times[:-5]), initial=0.0))

    def start_at(self, z: float) -> None:
        self.peers.follows, self.peers.twist = False, None
        rospy.sleep(0.3)
        self.peers.tips["mesa_left"] = np.array([-0.1, 0.04, z])
        rosnode.kill_nodes(["velocity_integrator_left"])  # it starts again, from where the arm is
        wait_until(lambda: self.tool("mesa_left").tip.z == z, "the tip there")
        self.peers.twist = np.zeros(6)
        self.peers.follows = True
        self.set_point.clear()
        wait_until(lambda: self.set_point.all, "the integrator again")

    def test_10_far_away_it_may_go_fast(self) -> None:
        self.start_at(0.15)
        self.await_state("mesa_left", CLEAR)
        self.assertGreater(self.speed((0.0, 0.0, -0.08), 20), 0.05)

    def test_11_near_the_bone_it_may_not_approach_but_retreat(self) -> None:
        self.start_at(0.02)
        self.speed((0.0, 0.0, -0.08), 200)
        tip = self.peers.tips["mesa_left"][2] - RADII["mesa_left"]
        self.assertGreater(tip, 0.0005, "it came to a stop before the bone")
        self.assertLess(tip, 0.006)
        self.assertGreater(self.speed((0.0, 0.0, 0.08), 20), 0.03, "retreat is free")

    def test_12_unknown_is_slow_in_every_direction(self) -> None:
        self.start_at(0.12)
        self.peers.bones = None
        self.addCleanup(setattr, self.peers, "bones", BONES)
        self.await_state("mesa_left", UNKNOWN)
        for direction in ((0.0, 0.0, -0.08), (0.0, 0.05, 0.0), (0.0, 0.0, 0.08)):
            self.assertLess(self.speed(direction), 0.021)

    def test_13_a_dead_node_is_unknown_too(self) -> None:
        self.start_at(0.12)
        self.await_state("mesa_left", CLEAR)
        rosnode.kill_nodes(["colliding_regions"])
        rospy.sleep(0.5)
        for z in (-0.08, 0.08):
            self.assertLess(self.speed((0.0, 0.0, z)), 0.021)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "collision", Collision)
