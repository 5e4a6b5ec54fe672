#!/usr/bin/env python3
"""touchball_receiver and the console program with keys: what has no key moves nothing, and both ends may restart."""

import signal
import socket
import sys
import tempfile
import time
import unittest
from pathlib import Path

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped
from support import ROOT, Newest, spawn, wait_until

from saras.net import TouchballUp, TouchballUpSide
from saras.net import keys as key_files


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


class TrustedTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node("trusted_test")
        cls.directory = tempfile.TemporaryDirectory()
        cls.key_file = str(Path(cls.directory.name, "saras.key"))
        key_files.save(Path(cls.key_file), key_files.draw())
        cls.up, cls.down = free_port(), free_port()
        cls.node = "touchball_receiver" if rospy.get_param("~hosting", "separate") == "separate" else "realtime_host"
        values = yaml.safe_load((ROOT / "config" / "console.yaml").read_text(encoding="utf-8"))["touchball_receiver"]
        values.update(bind_port=cls.up, console_port=cls.down, key_file=cls.key_file)
        rospy.set_param("/touchball_receiver", values)
        if cls.node == "realtime_host":
            cls.set_realtime_params()
        rospy.set_param("/saras/simulated", True)
        rospy.set_param("/saras/trace_laws", False)
        cls.pose = Newest("/touchball_left/pose", PoseStamped)
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)
        cls.children = {}
        cls.start_receiver()

    @classmethod
    def set_realtime_params(cls):
        """The host reads the parameters of all nodes that it is; the launch file for frames runs already."""
        for file in ("teleop", "tanks", "realtime", "collision"):
            for name, section in yaml.safe_load((ROOT / "config" / f"{file}.yaml").read_text(encoding="utf-8")).items():
                rospy.set_param(f"/{name}", section)
        rospy.set_param("/colliding_regions/regions_file", "none")
        rospy.set_param("/realtime_host/hosting", "realtime")
        rospy.set_param("/realtime_host/hold_after_s", 2.0)
        rospy.set_param("/realtime_host/record_s", 5.0)

    @classmethod
    def tearDownClass(cls):
        for child in cls.children.values():
            child.kill()
        cls.directory.cleanup()

    @classmethod
    def start_receiver(cls):
        cls.children["receiver"] = spawn(cls.node, f"__name:={cls.node}")

    @classmethod
    def start_console(cls, *arguments):
        addresses = ("--platform", f"127.0.0.1:{cls.up}", "--listen", f"127.0.0.1:{cls.down}")
        command = ("-m", "saras", "console", "--plain", "--motion", "circle", *addresses, *arguments)
        cls.children["console"] = spawn(sys.executable, *command)

    def end(self, name, how=signal.SIGKILL):
        self.children[name].send_signal(how)
        self.children[name].communicate(timeout=30)

    def counts(self):
        self.diagnostics.clear()

        def told():
            for message in self.diagnostics.all:
                for status in message.status:
                    if self.node in status.name:
                        return {value.key: value.value for value in status.values}
            return None

        return {key: int(value) for key, value in wait_until(told, "diagnostics").items() if value.isdigit()}

    def await_poses(self, what):
        self.pose.clear()
        wait_until(lambda: len(self.pose.all) > 20, what)

    def await_silence(self):
        wait_until(self.silent, "an end of the poses")

    def silent(self):
        self.pose.clear()
        rospy.sleep(0.5)
        return not self.pose.all

    def test_1_a_console_without_a_key_is_not_heard(self):
        self.start_console()
        wait_until(lambda: self.counts()["unauthenticated"] > 10, "refusals")
        self.assertFalse(self.pose.all)
        self.end("console")

    def test_2_with_the_key_it_is(self):
        self.start_console("--key", self.key_file)
        self.await_poses("poses")
        self.assertEqual(self.counts()["handshakes"], 1)

    def test_3_forged_datagrams_move_nothing(self):
        self.await_poses("poses")
        before = self.counts()
        forged = TouchballUp(session=2**63, sender_time_ns=0, left=TouchballUpSide(present=True))
        forged.left.handle_position_m = [9.0, 9.0, 9.0]
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as forger:
            for seq in range(500):
                forged.seq = 2**40 + seq
                data = bytearray(forged.encode())
                data[6] = seq % 2
                forger.sendto(bytes(data), ("127.0.0.1", self.up))
                time.sleep(0.001)
        wait_until(lambda: self.counts()["unauthenticated"] >= before["unauthenticated"] + 400, "refusals")
        self.await_poses("poses, still")
        self.assertLess(max(message.pose.position.x for message in self.pose.all), 1.0)
        self.assertEqual(self.counts()["sessions"], before["sessions"])

    def test_4_a_killed_console_comes_back(self):
        self.end("console")
        self.await_silence()
        self.start_console("--key", self.key_file)
        self.await_poses("poses of the restarted console")
        self.assertEqual(self.counts()["handshakes"], 2)

    def test_5_a_killed_receiver_comes_back(self):
        self.end("receiver")
        self.await_silence()
        self.start_receiver()
        self.await_poses("poses of the restarted receiver")
        self.end("console", signal.SIGTERM)
        self.assertEqual(self.children["console"].returncode, 0)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "trusted_test", TrustedTest)
