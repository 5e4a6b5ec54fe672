#!/usr/bin/env python3
"""Where the overlay says that an instrument is, the simulated endoscope has drawn one: both eyes, all in motion."""

from __future__ import annotations

import threading
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import Image
from support import wait_until

from saras.collision import ProximityState
from saras.overlay import color_of
from saras.sim.endoscope import Label

EYES = ("left", "right")
LIST = (slice(0, 160), slice(0, 280))  # where the list of tools is
ENOUGH_PX = 400  # of a shaft: the letters beside the tip have the same colour
SHARE = 0.75
PATIENCE_S = 150.0


def pixels(message: Image) -> np.ndarray:
    return np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, -1)


class OverlayOnEndoscope(unittest.TestCase):
    def setUp(self) -> None:
        rospy.init_node("overlay_endoscope_test")
        self.lock = threading.Lock()
        self.seen: dict[tuple[str, str, int], Image] = {}
        for eye in EYES:
            for kind, topic in (("overlay", "image_overlay"), ("labels", "truth/labels")):
                rospy.Subscriber(
                    f"/endoscope/{eye}/{topic}", Image, self.keep, (eye, kind), queue_size=2, tcp_nodelay=True
                )

    def keep(self, message: Image, key: tuple[str, str]) -> None:
        with self.lock:
            self.seen[(*key, message.header.stamp.to_nsec())] = message

    def shares(self, eye: str) -> list[float]:
        """Of each picture with a shaft on it: how much of what is drawn lies on an instrument."""
        with self.lock:
            stamps = [stamp for side, kind, stamp in self.seen if side == eye and kind == "labels"]
            pairs = [(self.seen.get((eye, "overlay", s)), self.seen[eye, "labels", s]) for s in stamps]
        found = []
        for overlay, labels in pairs:
            if overlay is None:
                continue
            drawn = (pixels(overlay) == color_of(ProximityState.UNKNOWN)[:3]).all(axis=-1)
            drawn[LIST] = False
            if drawn.sum() > ENOUGH_PX:
                found.append(float((pixels(labels)[..., 0] == Label.TOOL)[drawn].mean()))
        return found

    def test_lines_lie_on_the_instruments(self) -> None:
        wait_until(
            lambda: all(len(self.shares(eye)) >= 8 for eye in EYES),
            lambda: f"pictures with a shaft on them: { {eye: len(self.shares(eye)) for eye in EYES} }",
            PATIENCE_S,
        )
        for eye in EYES:
            shares = self.shares(eye)
            rospy.loginfo(f"{eye}: {len(shares)} pictures, on an instrument: median {np.median(shares):.2f}")
            self.assertGreater(float(np.median(shares)), SHARE, (eye, shares))


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "overlay_endoscope", OverlayOnEndoscope)
