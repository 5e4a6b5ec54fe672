#!/usr/bin/env python3
"""Sound on its topic and beside the bag: no sample is lost, and both say the same time."""

from __future__ import annotations

import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosbag
import rospy
import rostest
from saras_ros1.msg import AudioChunk, RecorderState
from saras_ros1.srv import StartRecording
from std_srvs.srv import Trigger
from support import Newest, wait_until

from saras.capture.sound import index_path, times_ns


class Audio(unittest.TestCase):
    def test_it_is_recorded_without_gaps(self):
        rospy.init_node("audio_test")
        audio, state = Newest("/audio", AudioChunk), Newest("/recorder/state", RecorderState)
        rospy.wait_for_service("/recorder/start", 60.0)
        wait_until(lambda: len(audio.all) > 5, "sound")
        path = Path(tempfile.mkdtemp()) / "session.bag"
        answer = rospy.ServiceProxy("/recorder/start", StartRecording)(str(path))
        self.assertTrue(answer.success, answer.message)
        wait_until(lambda: state.message is not None and state.message.recording, "the bag grows")
        rospy.sleep(4.0)
        self.assertTrue(rospy.ServiceProxy("/recorder/stop", Trigger)().success)
        sound = path.with_name("session_audio.flac")
        wait_until(lambda: sound.exists() and index_path(sound).exists(), "the sound beside the bag")
        rospy.sleep(1.0)
        with rosbag.Bag(str(path)) as bag:
            chunks = [m for _, m, _ in bag.read_messages(["/audio"])]
        self.assertGreater(len(chunks), 25)
        firsts = [chunk.first for chunk in chunks]
        self.assertEqual(firsts, list(range(firsts[0], firsts[0] + 1600 * len(firsts), 1600)))
        samples = np.concatenate([chunk.samples for chunk in chunks]).astype(float)
        self.assertGreater(np.abs(samples).max(), 3000, "it can be heard")
        stamps = [chunk.header.stamp.to_nsec() for chunk in chunks]
        in_file = times_ns(sound, np.arange(0, 16000, 1600))
        self.assertTrue(set(in_file[:5]) & {int(m.header.stamp.to_nsec()) for m in audio.all}, "the chunks' own stamps")
        self.assertLess(abs((stamps[-1] - stamps[0]) / 1e9 - 0.1 * (len(stamps) - 1)), 0.05)


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "audio", Audio)
