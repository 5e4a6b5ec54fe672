#!/usr/bin/env python3
"""A flash, a beep and a jump of an arm at one true time are recorded within one picture of it, each by itself."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import rospy
import rostest
from saras_ros1.msg import AudioChunk, RecorderState
from saras_ros1.srv import StartRecording
from std_srvs.srv import Trigger
from support import Newest, frames_in, wait_until

PATIENT_S = 90.0  # pictures are drawn without a graphics card
CLAPS = 10


class Aligned(unittest.TestCase):
    def stop(self):
        """A busy machine's master may need a second question."""

        def stopped():
            with contextlib.suppress(rospy.ServiceException):
                return rospy.ServiceProxy("/recorder/stop", Trigger)()

        self.assertTrue(wait_until(stopped, "the recorder's answer", PATIENT_S).success)

    def test_claps_are_within_a_picture(self):
        rospy.init_node("alignment_test")
        audio, state = Newest("/audio", AudioChunk), Newest("/recorder/state", RecorderState)
        rospy.wait_for_service("/recorder/start", PATIENT_S)
        wait_until(lambda: audio.all, "sound", PATIENT_S)
        path = Path(tempfile.mkdtemp()) / "session.bag"
        answer = rospy.ServiceProxy("/recorder/start", StartRecording)(str(path))
        self.assertTrue(answer.success, answer.message)
        videos = [path.with_name(f"session_{side}.mkv") for side in ("left", "right")]
        wait_until(lambda: all(frames_in(video) > 5 for video in videos), "videos", PATIENT_S)
        rospy.sleep(CLAPS + 2.0)
        self.stop()
        wait_until(lambda: state.message is not None and not state.message.recording, "the recorder stopped")
        rospy.sleep(2.0)  # videos and sound are closed
        command = [sys.executable, "-m", "saras", "bag", "align", str(path)]
        said = subprocess.run([*command, "--json"], text=True, capture_output=True, check=False, timeout=120.0)
        self.assertIn(said.returncode, (0, 1), said.stderr)
        found = json.loads(said.stdout)
        rospy.loginfo(said.stdout)
        self.assertGreaterEqual(found["claps"], CLAPS - 1)
        self.assertEqual(set(found["sources"]), {"left eye", "right eye", "PSM1", "sound"})
        self.assertTrue(found["within_a_frame"], said.stdout)
        for name, one in found["sources"].items():
            self.assertGreaterEqual(one["seen"], 0.5 * found["claps"], name)
            self.assertLessEqual(one["error_worst_ms"], found["frame_ms"], name)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "alignment", Aligned)
