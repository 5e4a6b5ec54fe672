#!/usr/bin/env python3
"""Capture and overlay in one nodelet manager: the overlay comes out, and no picture is copied on its way to it."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import tempfile
import time
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import numpy as np
import rosgraph
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from sensor_msgs.msg import CameraInfo, Image
from support import Newest, pair_of_pictures, wait_until

from saras.sim.endoscope import stereo_camera
from saras_ros1.camera_images import colours, eye_of

SIDES = ("left", "right")
MANAGER = "/endoscope_manager"
PATIENCE_S = 90.0
INSIDE = ("o", "INTRAPROCESS")


class Managed(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("managed_endoscope_test")
        cls.folder = Path(tempfile.mkdtemp())
        cls.camera = stereo_camera(320, 240)
        files = {side: cls.folder / f"{side}.yaml" for side in SIDES}
        for side, eye in zip(SIDES, (cls.camera.left, cls.camera.right)):
            eye.save(files[side])
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)
        cls.overlays = {side: Newest(f"/endoscope/{side}/image_overlay", Image) for side in SIDES}
        launch = str(Path(__file__).with_name("endoscope_manager.launch"))
        cls.output = (cls.folder / "output").open("w+")
        cls.process = subprocess.Popen(
            ["roslaunch", launch, *(f"{side}:={files[side]}" for side in SIDES)], stdout=cls.output, stderr=cls.output
        )

    @classmethod
    def tearDownClass(cls) -> None:
        cls.process.send_signal(signal.SIGINT)
        cls.process.wait(timeout=60)
        cls.output.seek(0)
        print(cls.output.read()[-5000:])
        cls.output.close()
        shutil.rmtree(cls.folder, ignore_errors=True)

    def values(self, name: str) -> dict[str, str]:
        """What /diagnostics last said of a nodelet."""
        for array in reversed(list(self.diagnostics.all)):
            for status in array.status:
                if status.name == name:
                    return {pair.key: pair.value for pair in status.values}
        return {}

    def manager(self) -> ServerProxy:
        return ServerProxy(rosgraph.Master(rospy.get_name()).lookupNode(MANAGER))

    def to_itself(self, topic: str) -> set[tuple[str, str]]:
        """(direction, transport) of a topic from the manager to the manager."""
        _, _, links = self.manager().getBusInfo(rospy.get_name())
        return {(way, transport) for _, peer, way, transport, name, *_ in links if name == topic and peer == MANAGER}

    def await_overlays(self) -> None:
        for overlay in self.overlays.values():
            overlay.clear()
        wait_until(
            lambda: all(len(overlay.all) >= 3 for overlay in self.overlays.values()),
            lambda: f"overlays; {self.values('/endoscope_capture')} {self.values('/visual_feedback')}",
            PATIENCE_S,
        )

    def test_1_the_overlay_comes_out_of_one_process(self) -> None:
        self.await_overlays()
        for side, eye in zip(SIDES, (self.camera.left, self.camera.right)):
            info = Newest(f"/endoscope/{side}/camera_info", CameraInfo).next()
            self.assertTrue(np.allclose(eye_of(info).P, eye.P))
            raw = Newest(f"/endoscope/{side}/image_raw", Image)
            before, after = (colours(message).astype(int) for message in pair_of_pictures(raw, self.overlays[side]))
            changed = np.abs(before - after).sum(axis=-1) > 0
            self.assertTrue(changed[:100, :160].any())  # the list of tools
            self.assertLess(changed.mean(), 0.5)  # and the picture behind it
            raw.subscriber.unregister()

    def test_2_pictures_stay_where_they_are_between_the_nodelets(self) -> None:
        self.await_overlays()
        for side in SIDES:
            topic = f"/endoscope/{side}/image_raw"
            wait_until(lambda topic=topic: INSIDE in self.to_itself(topic), lambda topic=topic: f"{INSIDE} of {topic}")
            self.assertEqual(self.to_itself(topic), {INSIDE})  # not over a socket as well
        first = wait_until(lambda: self.values("/endoscope_capture"), "diagnostics of the capture")

        def more() -> bool:
            now = self.values("/endoscope_capture")
            return all(int(now[f"{side} shared"]) >= int(first[f"{side} shared"]) + 10 for side in SIDES)

        wait_until(
            more, lambda: f"pictures that the overlay holds as they were filled: {self.values('/endoscope_capture')}"
        )

    def test_3_a_manager_that_dies_comes_back_with_both(self) -> None:
        self.await_overlays()
        _, _, pid = self.manager().getPid(rospy.get_name())
        os.kill(pid, signal.SIGKILL)
        time.sleep(1.0)
        self.await_overlays()
        self.assertNotEqual(self.manager().getPid(rospy.get_name())[2], pid)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "managed_endoscope", Managed)
