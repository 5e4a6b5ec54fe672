#!/usr/bin/env python3
"""What hands and their datagrams may do, by a console with the key that says anything, through the proxy."""

import math
import struct
import sys
import tempfile
import threading
import time
from pathlib import Path

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import PointStamped, PoseStamped, WrenchStamped
from support.case import FaultCase
from support.keyed_console import HANDLES, HOME_M, KeyedConsole, bad_floats
from support.options import HOSTING, LIMIT_S, process_of
from support.platform import SIDES
from support.proxy import Proxy
from support.waiting import wait_until

from saras.net import keys
from saras_ros1 import convert
from saras_ros1.stamped import StampedPose, StampedTwist

QUATERNION_AT = 32  # in a handle's part of a datagram, docs/protocols.md
FORCE_LIMIT_N = 3.3


def moved(x_m, y_m):
    """Home, and so much to the side."""
    return np.add(HOME_M, (x_m, y_m, 0.0))


def circle(t, console, radius_m=0.01, period_s=3.0):
    """Both hands go round: 21 mm/s by default."""
    angle = 2.0 * math.pi * t / period_s
    for side in SIDES:
        console.position[side] = moved(radius_m * math.cos(angle), radius_m * math.sin(angle))


class HandFaults(FaultCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        path = Path(cls.scratch.name, "saras.key")
        cls.keys = keys.draw()
        keys.save(path, cls.keys)
        cls.arguments = {**cls.arguments, "key_file": str(path)}
        super().setUpClass()

    @classmethod
    def start_console(cls):
        cls.proxy = Proxy(cls.platform, seed=8)
        cls.hands = KeyedConsole(cls.platform, cls.keys)
        cls.hands.motion = circle

    @classmethod
    def tearDownClass(cls):
        cls.hands.stop()
        super().tearDownClass()
        cls.scratch.cleanup()

    def shown(self, side):
        """What the console is told."""
        return getattr(self.hands.down, side).state.name

    def tearDown(self):
        self.hands.motion, self.hands.edit, self.hands.sending = circle, lambda packet: None, True
        self.hands.clutch = dict.fromkeys(SIDES, False)

    def test_06_sequence_far_ahead(self):
        self.engage_and_move()
        with self.row(6, "a datagram with a good tag, its sequence 2^40 ahead, 20 times", "far ahead") as row:
            before = self.watch.counts()
            for _ in range(20):
                packet = self.hands.packet()
                packet.seq += 2**40
                self.hands.send_sealed(packet.encode(True))
            after = self.watch.await_count("far_ahead", before["far_ahead"] + 20)
            self.goes_on("left", "after them")
            self.assertEqual(after["sessions"], before["sessions"])
            row.saw(f"{after['far_ahead'] - before['far_ahead']} refused as far_ahead, those that follow are taken")

    def test_08_not_finite(self):
        self.engage_and_move()
        with self.row(
            8, "each of the 60 floats of a datagram as NaN or ±Inf, under a good tag, among good ones"
        ) as row:
            before = self.watch.counts()
            bad = list(bad_floats(self.hands))
            for _, _, data in bad:
                self.hands.send_sealed(data)
                time.sleep(0.005)
            after = self.watch.await_count("malformed", before["malformed"] + len(bad))
            for side in SIDES:
                self.goes_on(side, "among bad ones")
            row.saw(
                f"{after['malformed'] - before['malformed']} of {len(bad)} refused, motion goes on with the good ones"
            )
        with self.row(8, "the same alone, 100 a second", "alone") as row:
            poses = []
            subscriber = rospy.Subscriber("/touchball_left/pose", StampedPose, poses.append)
            wait_until(lambda: poses, "poses")
            self.hands.sending = False
            time.sleep(0.2)
            poses.clear()
            end = time.monotonic() + 3.0 * LIMIT_S["console_limit_s"] + 1.0
            sent = 0
            while time.monotonic() < end:
                for _, _, data in bad_floats(self.hands):
                    self.hands.send_sealed(data)
                    sent += 1
                    time.sleep(0.01)
            subscriber.unregister()
            self.assertEqual(poses, [], "a refused datagram became a pose")
            for side in SIDES:
                self.await_hold(row, side, "console data")
                self.assertEqual(self.shown(side), "HOLD")
            row.saw(f"{sent} refused, none became a pose: the watchdog ran out")
            self.hands.sending = True
            self.engage_and_move()

    def with_quaternion(self, quaternion):
        data = bytearray(self.hands.good())
        for begin in HANDLES:
            struct.pack_into("<4d", data, begin + QUATERNION_AT, *quaternion)
        return bytes(data)

    def test_39_quaternions(self):
        self.engage_and_move()
        with self.row(
            39, "quaternion of norm 1.1, 0.5 and 0 under a good tag; sign turned in every other datagram"
        ) as row:
            before = self.watch.counts()
            for quaternion in ((0.0, 0.0, 0.0, 1.1), (0.0, 0.0, 0.5, 0.0), (0.0, 0.0, 0.0, 0.0)):
                for _ in range(10):
                    self.hands.send_sealed(self.with_quaternion(quaternion))
                    time.sleep(0.005)
            after = self.watch.await_count("malformed", before["malformed"] + 30)
            turns = []
            subscriber = rospy.Subscriber("/tf_transformer_left/tracked_twist", StampedTwist, turns.append)

            def flip(packet):
                sign = 1.0 if packet.seq % 2 else -1.0
                half = 0.15
                for side in SIDES:
                    part = getattr(packet, side)
                    part.handle_quaternion_xyzw = [0.0, 0.0, sign * math.sin(half), sign * math.cos(half)]

            self.hands.edit = flip
            time.sleep(0.5)  # the hand has turned by 0.3 rad once
            turns.clear()
            wait_until(lambda: len(turns) > 100, "twists")
            subscriber.unregister()
            worst = max(np.linalg.norm(message.numbers[3:]) for message in turns)
            self.assertLess(worst, 1e-6, "a change of sign is no rotation")
            for side in SIDES:
                self.goes_on(side, "with changing signs")
            row.saw(
                f"{after['malformed'] - before['malformed']} of 30 refused; {len(turns)} twists under changing signs "
                f"turn by at most {worst:.1e} rad/s"
            )

    def test_40_workspace_limit(self):
        self.engage_and_move()
        with self.row(40, "the left hand goes 0.4 m to one side, its tip could follow 0.1 m; and back") as row:
            points = []
            subscriber = rospy.Subscriber("/mesa_left/set_point", PoseStamped, lambda m: points.append(convert.pose(m)))
            rcm = rospy.wait_for_message("/mesa_left/rcm", PointStamped, 30.0)
            trocar = np.array([rcm.point.x, rcm.point.y, rcm.point.z])
            goal = {"y": 0.4}

            def push(_, console):
                y = console.position["left"][1]
                console.position["left"] = moved(0.0, y + np.clip(goal["y"] - y, -6e-4, 6e-4))  # 60 mm/s

            self.hands.motion = push
            acting = wait_until(self.at_the_limit, "the limit")
            wait_until(lambda: self.hands.position["left"][1] > 0.39, "the hand's end")
            forces = [np.linalg.norm(self.watch.newest["/touchball_left/wrench"][:3])]
            wait_until(lambda: self.resisting(forces), lambda: f"a resisting force; {forces[-1]:.2f} N")
            angles, depths = self.workspace(np.array(points), trocar)
            self.assertLess(max(angles), math.radians(50.0) + 1e-3)  # a tenth of a millimetre: where the arm has been
            self.assertGreater(min(depths), 0.03 - 1e-6)
            self.assertLess(max(depths), 0.2 + 1e-6)
            self.assertLessEqual(max(forces), FORCE_LIMIT_N + 1e-6)
            self.assertEqual(self.watch.state("left"), "ENGAGED", self.watch.reason("left"))
            subscriber.unregister()
            goal["y"] = 0.0
            wait_until(lambda: abs(self.hands.position["left"][1]) < 1e-3, "the hand back")
            self.ask("left", "hold")
            self.hands.motion = circle
            self.engage_and_move("left")
            row.saw(
                f"stops ({acting}) at {math.degrees(max(angles)):.2f}° of 50°, {1e3 * min(depths):.0f} … "
                f"{1e3 * max(depths):.0f} mm of 30 … 200; force on the hand {max(forces):.2f} of {FORCE_LIMIT_N} N, "
                "against the motion"
            )

    def at_the_limit(self):
        report = self.watch.report(process_of("/velocity_integrator_left"))
        acting = report.get("left_limited_by" if HOSTING == "realtime" else "limited_by", "")
        return acting if {"cone", "insertion", "workspace"} & set(acting.split()) else None

    def resisting(self, forces):
        """The force in simball_base (touch_base turned by half a turn about z) points against the displacement."""
        force = self.watch.newest["/touchball_left/wrench"][:3]
        forces.append(float(np.linalg.norm(force)))
        return -force[1] < -0.3

    def workspace(self, poses, trocar):
        ways = poses[:, :3, 3] - trocar
        depths = np.linalg.norm(ways, axis=1)
        return np.arccos(np.clip(-ways[:, 2] / depths, -1.0, 1.0)), depths

    def test_42_clutch_at_speed(self):
        self.engage_and_move()  # a hand that moves faster than 0.1 m/s is not engaged
        self.hands.motion = lambda t, console: circle(t, console, 0.015, 1.0)  # 94 mm/s, the tip 47
        with self.row(42, "clutch pressed at 94 mm/s of the hand and released at speed, 5 times") as row:
            number, stops = self.watch.engagement("left"), []
            for _ in range(5):
                self.logs["left"].await_motion(8e-3, "before the clutch")
                mark = self.logs["left"].mark()
                self.hands.clutch["left"] = True
                wait_until(lambda: self.watch.states["left"][-1].clutch, "clutch in the state")
                self.logs["left"].await_still(within_m=1e-4)  # engaged: the tank's damping answers to noise
                stops.append(self.logs["left"].moved_since(mark))
                self.hands.clutch["left"] = False
                wait_until(lambda: not self.watch.states["left"][-1].clutch, "clutch released")
                self.logs["left"].await_motion(2e-3, "after the clutch")
            self.assertLess(max(stops), 0.02)
            self.assertEqual(self.watch.engagement("left"), number)
            self.assertEqual(self.watch.state("left"), "ENGAGED")
            row.saw(f"stands still after at most {1e3 * max(stops):.1f} mm, released it follows without a step")

    def test_43_clutch_packet_lost(self):
        self.engage_and_move()
        with self.row(
            43, "the two datagrams that would tell of clutch pressed, or released, are lost, 5 times each"
        ) as row:
            for _ in range(5):
                for pressed in (True, False):
                    self.proxy("drop 2 up")
                    self.hands.clutch["left"] = pressed
                    wait_until(
                        lambda pressed=pressed: self.watch.states["left"][-1].clutch == pressed, f"clutch {pressed}"
                    )
                    if pressed:
                        self.logs["left"].await_still(within_m=1e-4)
            self.goes_on("left", "after the last release")
            row.saw("every press and release arrived with the next datagram")

    def test_90_tank_empties(self):
        self.engage_and_move()
        self.hands.motion = lambda t, console: circle(t, console, 0.015, 1.0)
        with self.row(32, "an environment that takes energy without end: 10 N along the tip's motion") as row:
            stop, twists = threading.Event(), []
            thread = threading.Thread(target=self.take_energy, args=(stop, twists), daemon=True)
            thread.start()
            try:
                tank = wait_until(self.emptied, lambda: f"an empty tank; {self.watch.tanks['tank_slave']}", 90.0)
                self.await_told(row, "tank_slave: empty")
                reduced = wait_until(lambda: self.watch.newest["/tank_slave/left/twist"], "twist")
                told = self.watch.report("/tank_slave") if HOSTING == "separate" else {}
            finally:
                stop.set()
                thread.join()
            steps = np.linalg.norm(np.diff([t[:3] for t in twists], axis=0), axis=1)
            self.assertGreaterEqual(tank.energy_J, -1e-9)
            self.assertLess(np.percentile(steps, 50), 0.005, "the twist jumps")
            self.assertEqual(self.watch.state("left"), "ENGAGED")
            row.saw(
                f"down to {1e3 * tank.energy_J:.1f} mJ (minimum {1e3 * tank.minimum_J:.0f}), reduction "
                f"{tank.reduction:.2f}, damping {max(tank.damping):.4f} m/(N s), twist "
                f"{1e3 * np.linalg.norm(reduced[:3]):.1f} mm/s, its changes in 10 ms "
                f"{1e3 * np.percentile(steps, 50):.1f} mm/s in the median, {1e3 * steps.max():.0f} at most; "
                f"shown as {told.get('status', tank.status)}, {told.get('energy_J', f'{tank.energy_J:.3f}')} J"
            )
            wait_until(lambda: self.watch.tanks["tank_slave"].energy_J >= 0.0, "tank")

    def emptied(self):
        tank = self.watch.tanks["tank_slave"]
        return tank if tank.reduction > 0.95 else None

    def take_energy(self, stop, twists):
        """The wrench that the tip exerts, told as a contact estimator would: it always points along the motion."""
        publisher = rospy.Publisher("/contact_force/left/wrench", WrenchStamped, queue_size=1)
        direction = np.zeros(3)
        while not stop.is_set():
            twist = np.array(self.watch.newest["/tank_slave/left/twist"])
            twists.append(twist)
            speed = np.linalg.norm(twist[:3])
            direction += 0.2 * ((twist[:3] / speed if speed > 1e-4 else np.zeros(3)) - direction)
            wrench = np.concatenate((10.0 * direction, np.zeros(3)))
            publisher.publish(convert.wrench_msg(wrench, "mesa_left/sbs_world", rospy.Time.now().to_nsec()))
            time.sleep(0.01)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "faults_hands", HandFaults, sys.argv)
