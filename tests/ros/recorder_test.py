#!/usr/bin/env python3
"""The recorder: what it loses when it is killed, and what it says when it does not record."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import rosbag
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PointStamped
from saras_ros1.msg import RecorderState
from saras_ros1.srv import Annotate, StartRecording
from std_msgs.msg import String
from std_srvs.srv import Trigger
from support import ROOT, Newest, wait_until

RATE_HZ = 200.0


class Recorder(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("recorder_test")
        cls.state = Newest("/recorder/state", RecorderState)
        cls.events = Newest("/system/events", String)
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)
        cls.directory = Path(tempfile.mkdtemp())
        cls.points = rospy.Publisher("/test/points", PointStamped, queue_size=1000)
        cls.bulk = rospy.Publisher("/test/bulk", String, queue_size=100)
        cls.sent = 0
        cls.bulk_size = 200  # with the rest 50 kB/s, less than the platform has
        threading.Thread(target=cls.speak, daemon=True).start()
        rospy.wait_for_service("/recorder/start", 60.0)

    @classmethod
    def speak(cls):
        due = time.monotonic()
        while not rospy.core.is_shutdown_requested():
            message = PointStamped()
            message.header.stamp = rospy.Time.now()
            message.point.x = cls.sent
            cls.points.publish(message)
            cls.sent += 1
            cls.bulk.publish(String("x" * cls.bulk_size))
            due += 1.0 / RATE_HZ
            time.sleep(max(0.0, due - time.monotonic()))

    def start(self, path=""):
        answer = rospy.ServiceProxy("/recorder/start", StartRecording)(str(path))
        return answer.success, answer.message

    def stop(self):
        return rospy.ServiceProxy("/recorder/stop", Trigger)()

    def await_recording(self, recording, *words):
        wait_until(
            lambda: (
                self.state.message is not None
                and self.state.message.recording == recording
                and all(word in self.state.message.reason for word in words)
            ),
            lambda: f"recording {recording} {words}: {self.state.message}",
        )

    def await_event(self, *words):
        wait_until(lambda: any(all(w in m.data for w in words) for m in self.events.all), lambda: f"{words} in events")

    def record_process(self):
        family = subprocess.run(["pgrep", "-f", "^/usr/lib/rosbag/record .*" + self.state.message.path], text=True,
                                capture_output=True, check=False).stdout.split()  # fmt: skip
        self.assertTrue(family, "rosbag's recorder runs")
        return int(family[0])

    def numbers(self, path):
        if path.name.endswith(".active"):  # of a killed recorder
            path = Path(shutil.copy(path, path.with_name("mended.bag")))
            with rosbag.Bag(str(path), "a", allow_unindexed=True) as bag:
                for _ in bag.reindex():
                    pass
        with rosbag.Bag(str(path)) as bag:
            return [int(m.point.x) for _, m, _ in bag.read_messages(["/test/points"])]

    def test_1_not_recording_is_said_at_once(self):
        self.await_recording(False, "not started")
        self.assertFalse(self.stop().success)
        wait_until(
            lambda: any(
                s.name == "/recorder" and "NOT RECORDING" in s.message for m in self.diagnostics.all for s in m.status
            ),
            "NOT RECORDING in /diagnostics",
        )

    def test_2_start_annotate_stop(self):
        path = self.directory / "first.bag"
        self.assertFalse(self.start("relative.bag")[0])
        done, said = self.start(path)
        self.assertTrue(done, said)
        self.assertIn("/test/nobody", said)
        self.assertFalse(self.start()[0], "one at a time")
        self.await_recording(True)
        annotate = rospy.ServiceProxy("/recorder/annotate", Annotate)
        self.assertIn("must be one of", annotate("dance", "x", "").message)
        self.assertTrue(annotate("action", "grasp", "left hand").success)
        before = self.sent
        rospy.sleep(2.0)
        after = self.sent - 20
        self.assertTrue(self.stop().success)
        self.await_recording(False, "stopped")
        self.assertTrue(path.exists())
        found = self.numbers(path)
        self.assertEqual(found, list(range(found[0], found[-1] + 1)), "nothing is lost in between")
        self.assertLessEqual(found[0], before)
        self.assertGreaterEqual(found[-1], after)
        with rosbag.Bag(str(path)) as bag:
            marks = [json.loads(m.data) for _, m, _ in bag.read_messages(["/recorder/annotations"])]
        self.assertEqual([(m["kind"], m["label"]) for m in marks], [("action", "grasp")])
        self.assertIn("exists", self.start(path)[1])

    def test_3_killed_it_loses_a_second_at_most_and_begins_anew(self):
        path = self.directory / "killed.bag"
        self.assertTrue(self.start(path)[0])
        self.await_recording(True)
        rospy.sleep(4.0)
        number = self.sent
        os.kill(self.record_process(), signal.SIGKILL)
        self.await_event("NOT RECORDING", "killed by signal 9")
        wait_until(lambda: self.state.message.path != str(path) and self.state.message.recording, "another bag")
        self.assertTrue(self.stop().success)
        found = self.numbers(next(self.directory.glob("killed.bag*")))
        self.assertGreater(len(found), 100)
        self.assertGreaterEqual(found[-1], number - RATE_HZ, "more than the last second is lost")
        self.assertEqual(found, list(range(found[0], found[-1] + 1)))

    def test_4_a_frozen_recorder_is_seen(self):
        self.assertTrue(self.start(self.directory / "frozen.bag")[0])
        self.await_recording(True)
        pid = self.record_process()
        os.kill(pid, signal.SIGSTOP)
        try:
            self.await_recording(False, "nothing was written")
        finally:
            os.kill(pid, signal.SIGCONT)
        self.await_recording(True)
        self.assertTrue(self.stop().success)

    def test_5_a_full_disk_ends_it_while_the_bag_can_be_closed(self):
        disk = self.mount("size=12m")
        path = disk / "full.bag"
        type(self).bulk_size = 4000
        try:
            self.assertTrue(self.start(path)[0])
            self.await_event("NOT RECORDING", "the disk is full")
        finally:
            type(self).bulk_size = 200
        self.await_recording(False, "the disk is full")
        self.assertFalse(self.state.message.wanted, "it does not begin by itself on a full disk")
        found = self.numbers(path)
        self.assertGreater(len(found), 100)
        self.assertIn("free", self.start(disk / "again.bag")[1])

    def test_6_a_read_only_disk_is_refused_by_name(self):
        disk = self.mount("size=12m,ro")
        done, said = self.start(disk / "x.bag")
        self.assertFalse(done)
        self.assertIn("Read-only", said)
        self.assertIn("Read-only", self.state.next().reason)

    def test_7_a_slow_disk_is_said_and_holds_up_nobody(self):
        folder = Path(tempfile.mkdtemp())
        shim, rate = folder / "slow_disk.so", folder / "bytes_per_s"
        source = ROOT / "tests" / "faults" / "slow_disk.c"
        subprocess.run(["cc", "-O2", "-Wall", "-Werror", "-shared", "-fPIC", "-o", shim, source, "-ldl"], check=True)
        rate.write_text("0")
        rospy.set_param("/slow", {**rospy.get_param("/recorder"), "behind_s": 6.0})
        names = ["__name:=slow", *(f"/recorder/{what}:=/slow/{what}" for what in ("state", "annotations"))]
        path = [ROOT / "devel" / "lib" / "saras_ros1" / "recorder", *names]
        slow = subprocess.Popen(path, env={**os.environ, "LD_PRELOAD": str(shim), "SLOW_DISK_FILE": str(rate)})
        self.addCleanup(slow.wait, 60.0)
        self.addCleanup(slow.terminate)
        state, points = Newest("/slow/state", RecorderState), Newest("/test/points", PointStamped)
        rospy.wait_for_service("/slow/start", 60.0)
        self.assertTrue(rospy.ServiceProxy("/slow/start", StartRecording)(str(folder / "slow.bag")).success)
        wait_until(lambda: state.message is not None and state.message.recording, "the bag grows")
        points.clear()
        rate.write_text("5000")  # a tenth of what comes
        wait_until(lambda: "s behind" in state.message.reason, lambda: f"slow, {state.message}", 60.0)
        self.assertTrue(state.message.recording)
        wait_until(lambda: "too slow" in state.message.reason, lambda: f"too slow, {state.message}", 60.0)
        self.assertFalse(state.message.recording)
        numbers = [int(message.point.x) for message in list(points.all)]
        self.assertGreater(len(numbers), 100)
        self.assertEqual(numbers, list(range(numbers[0], numbers[0] + len(numbers))), "others hear all of it meanwhile")
        rate.write_text("0")
        wait_until(lambda: state.message.recording and not state.message.reason, lambda: f"{state.message}", 60.0)
        self.assertTrue(rospy.ServiceProxy("/slow/stop", Trigger)().success)
        found = self.numbers(folder / "slow.bag")
        self.assertEqual(found, list(range(found[0], found[-1] + 1)), "what waited for the disk came later")
        self.assertGreaterEqual(found[-1], numbers[-1])

    def mount(self, options):
        disk = Path(tempfile.mkdtemp())
        done = subprocess.run(["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(disk)], check=False)
        if done.returncode:
            self.skipTest("mounting a small disk needs root")
        self.addCleanup(subprocess.run, ["umount", "-l", str(disk)], check=False)
        return disk


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "recorder", Recorder)
