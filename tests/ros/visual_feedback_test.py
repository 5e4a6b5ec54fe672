#!/usr/bin/env python3
"""The overlay over the wire: right pixels, no unsafe green, notices in time. Tests run in the order of their names.

Both a process of its own and a nodelet in a manager are looked at: each look waits for both.
"""

from __future__ import annotations

import math
import subprocess
import unittest

import numpy as np
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from overlay_peers import CHANNELS, EYES, FOCAL, HEIGHT, ROWS, TOOLS, WIDTH, Peers
from saras_ros1.msg import ToolCollision
from sensor_msgs.msg import Image
from support import ROOT, Newest, wait_until

from saras.collision import ProximityState
from saras.overlay import color_of

HOSTS = {"standalone": "/endoscope", "managed": "/loaded"}
OUTPUTS = [(host, eye) for host in HOSTS for eye in EYES]
LEVELS = {
    ToolCollision.UNKNOWN: ProximityState.UNKNOWN,
    ToolCollision.CLEAR: ProximityState.CLEAR,
    ToolCollision.WARNING: ProximityState.WARNING,
    ToolCollision.COLLISION: ProximityState.COLLISION,
}
METRES = {ToolCollision.CLEAR: 0.05, ToolCollision.WARNING: 0.006, ToolCollision.COLLISION: 0.001}
COLUMN_M = 0.02  # a place along the shafts, away from ruler, label and list
#: The list is dark and its letters coloured; below and right of it is only the picture.
BELOW_LIST = slice(100, HEIGHT)


def pixels(message: Image) -> np.ndarray:
    n = CHANNELS[message.encoding]
    return np.frombuffer(message.data, np.uint8).reshape(message.height, message.width, n)


def rgb(message: Image) -> np.ndarray:
    image = pixels(message)
    return image[..., :3] if message.encoding.startswith("rgb") else image[..., 2::-1]


def is_green(image: np.ndarray) -> np.ndarray:
    image = image.astype(int)
    return (image[..., 1] > image[..., 0] + 40) & (image[..., 1] > image[..., 2] + 40)


def place(eye: str, tool: int) -> tuple[int, int]:
    """Row and column of a point on a tool's shaft (the lens moves it by less than the shaft is thick)."""
    x, y = COLUMN_M - (0.005 if eye == "right" else 0.0), ROWS[tool]
    r2 = (x * x + y * y) / 0.01
    bend = 1.0 - 0.1 * r2 + 0.02 * r2 * r2
    return round(HEIGHT / 2 + FOCAL * bend * y / 0.1), round(WIDTH / 2 + FOCAL * bend * x / 0.1)


class VisualFeedback(unittest.TestCase):
    @classmethod
    def setUpClass(cls) -> None:
        rospy.init_node("visual_feedback_test")
        cls.peers = Peers()
        cls.outputs = {
            (host, eye): Newest(f"{base}/{eye}/image_overlay", Image) for host, base in HOSTS.items() for eye in EYES
        }
        cls.diagnostics = Newest("/diagnostics", DiagnosticArray)

    def setUp(self) -> None:
        self.peers.reset()

    def set_all(self, state: int, metres: float | None = None) -> None:
        for name in TOOLS:
            self.peers.states[name] = state
            self.peers.metres[name] = METRES.get(state, math.nan) if metres is None else metres

    def shows(self, key: tuple[str, str], tool: int, level: ProximityState) -> bool:
        message = self.outputs[key].message
        if message is None or message.encoding not in CHANNELS:
            return False
        row, column = place(key[1], tool)
        image = pixels(message)
        if message.encoding == "mono8":
            return image[row, column, 0] == color_of(level)[3]
        return tuple(rgb(message)[row, column].tolist()) == color_of(level)[:3]

    def await_level(self, level: ProximityState, tools: tuple[int, ...] = (0, 1, 2, 3)) -> None:
        def there() -> bool:
            return all(self.shows(key, tool, level) for key in OUTPUTS for tool in tools)

        def seen() -> str:
            found = {}
            for key in OUTPUTS:
                message = self.outputs[key].message
                found[key] = None if message is None else [tuple(pixels(message)[place(key[1], t)]) for t in tools]
            return f"{level.name} at all shafts; seen {found}"

        wait_until(there, seen)

    def look(self, frames: int = 6) -> list[tuple[tuple[str, str], Image]]:
        """The next images of all outputs."""
        for newest in self.outputs.values():
            newest.clear()
        wait_until(lambda: all(len(newest.all) >= frames for newest in self.outputs.values()), f"{frames} images each")
        return [(key, message) for key, newest in self.outputs.items() for message in list(newest.all)]

    def assert_no_green(self) -> None:
        for key, message in self.look():
            self.assertFalse(is_green(rgb(message)).any(), key)

    def await_off(self, notice: bool = True) -> None:
        """No overlay: no colour of any level beyond the list's place, and (notice) something is written below."""

        def off() -> bool:
            for key in OUTPUTS:
                message = self.outputs[key].message
                if message is None:
                    return False
                image = rgb(message)
                if is_green(image).any() or any(self.shows(key, tool, ProximityState.CLEAR) for tool in range(4)):
                    return False
                if notice and not (image[HEIGHT - 80 :] == [255, 140, 0]).all(axis=-1).any():
                    return False
            return True

        wait_until(off, "the overlay off, with a notice")

    def test_01_all_four_tools_in_the_colours_of_their_levels(self) -> None:
        for state, level in LEVELS.items():
            self.set_all(state)
            self.await_level(level)
        for tool, state in enumerate(LEVELS):
            self.peers.states[TOOLS[tool]] = state
            self.peers.metres[TOOLS[tool]] = METRES.get(state, math.nan)
        for tool, state in enumerate(LEVELS):
            self.await_level(LEVELS[state], (tool,))

    def test_02_images_keep_their_header_and_size(self) -> None:
        for _, message in self.look(2):
            self.assertEqual((message.width, message.height, message.encoding), (WIDTH, HEIGHT, "bgr8"))
            self.assertEqual(message.header.frame_id, "endoscope_left_optical")

    def test_03_both_eyes_are_of_one_moment(self) -> None:
        self.look(8)
        for host in HOSTS:
            stamps = [{m.header.stamp for m in self.outputs[host, eye].all} for eye in EYES]
            self.assertGreaterEqual(len(stamps[0] & stamps[1]), 6)

    def test_04_each_encoding_has_its_channel_order(self) -> None:
        for encoding in ("rgb8", "bgra8", "rgba8", "mono8", "bgr8"):
            self.peers.encoding = encoding
            wait_until(
                lambda e=encoding: all(
                    o.message is not None and o.message.encoding == e for o in self.outputs.values()
                ),
                f"images in {encoding}",
            )
            for state in (ToolCollision.CLEAR, ToolCollision.UNKNOWN):
                self.set_all(state)
                self.await_level(LEVELS[state])

    def test_05_an_encoding_that_cannot_be_drawn_on_passes_untouched(self) -> None:
        self.peers.encoding = "bayer_rggb8"
        wait_until(lambda: all(o.message.encoding == "bayer_rggb8" for o in self.outputs.values()), "Bayer images")
        for _, message in self.look(2):
            self.assertLess(np.frombuffer(message.data, np.uint8).max(), 30)
        self.peers.encoding = "bgr8"
        self.await_level(ProximityState.CLEAR)

    def unknown_then_known(self, silence, speak) -> None:
        self.await_level(ProximityState.CLEAR)
        silence()
        self.await_level(ProximityState.UNKNOWN)
        self.assert_no_green()
        speak()
        self.await_level(ProximityState.CLEAR)

    def test_06_silent_distances_are_grey(self) -> None:
        self.unknown_then_known(
            lambda: setattr(self.peers, "sends_distances", False), lambda: setattr(self.peers, "sends_distances", True)
        )

    def test_07_nan_is_grey_whatever_the_state_says(self) -> None:
        self.unknown_then_known(
            lambda: self.set_all(ToolCollision.CLEAR, math.nan), lambda: self.set_all(ToolCollision.CLEAR)
        )

    def test_08_an_unknown_state_is_grey_whatever_the_distance_says(self) -> None:
        self.unknown_then_known(
            lambda: self.set_all(ToolCollision.UNKNOWN, 0.05), lambda: self.set_all(ToolCollision.CLEAR)
        )

    def test_09_without_the_tools_state_there_is_no_green(self) -> None:
        self.await_level(ProximityState.CLEAR)
        self.peers.sends_state = False
        wait_until(
            lambda: all(not is_green(rgb(o.message)).any() for o in self.outputs.values()), "no green pixel any more"
        )
        self.assert_no_green()
        self.peers.sends_state = True
        self.await_level(ProximityState.CLEAR)

    def test_10_without_the_cameras_pose_no_shaft_is_drawn(self) -> None:
        self.await_level(ProximityState.CLEAR)
        self.peers.sends_tf = False

        def unplaced() -> bool:
            return not any(self.shows(key, tool, ProximityState.CLEAR) for key in OUTPUTS for tool in range(4))

        wait_until(unplaced, "no shafts")
        for key, message in self.look():
            image = rgb(message)
            self.assertFalse(is_green(image[BELOW_LIST]).any(), key)
            self.assertTrue((image[HEIGHT - 80 :] == [255, 140, 0]).all(axis=-1).any(), "it says why")
        self.peers.sends_tf = True
        self.await_level(ProximityState.CLEAR)

    def test_11_another_size_takes_the_overlay_off_until_the_intrinsics_match(self) -> None:
        """Row 30 of the fault catalogue."""
        self.await_level(ProximityState.CLEAR)
        bigger = (WIDTH + 80, HEIGHT + 60)
        self.peers.size = bigger
        wait_until(lambda: all(o.message.width == bigger[0] for o in self.outputs.values()), "larger images")
        for key, message in self.look():
            self.assertFalse(is_green(rgb(message)).any(), key)
            self.assertTrue((rgb(message)[-110:] == [255, 140, 0]).all(axis=-1).any(), "it says why")
        self.peers.info_size = bigger
        self.await_level(ProximityState.CLEAR)
        self.peers.info_size = (WIDTH, HEIGHT)
        self.await_off()
        self.peers.size = (WIDTH, HEIGHT)
        self.await_level(ProximityState.CLEAR)

    def test_12_a_frozen_eye_takes_the_overlay_from_both(self) -> None:
        """Row 29: the same frame again and again."""
        for eye in EYES:
            self.await_level(ProximityState.CLEAR)
            self.peers.frozen[eye] = True
            self.await_off()
            self.peers.frozen[eye] = False
        self.await_level(ProximityState.CLEAR)

    def test_13_frozen_is_said_within_200_ms_of_the_first_repeated_image(self) -> None:
        """From the stamps of the images, which are those of the camera: best of some trials on a busy machine."""
        delays = []
        for _ in range(4):
            self.await_level(ProximityState.CLEAR)
            newest = self.outputs["standalone", "left"]
            newest.clear()
            self.peers.frozen["left"] = True
            self.await_off()
            self.peers.frozen["left"] = False
            images = list(newest.all)
            noticed = next(
                i for i, m in enumerate(images) if (rgb(m)[HEIGHT - 80 :] == [255, 140, 0]).all(axis=-1).any()
            )
            # The untouched part of a repeated picture equals the one before it.
            corner = [rgb(m)[BELOW_LIST, :20].tobytes() for m in images[: noticed + 1]]
            first = next(i for i in range(1, noticed + 1) if corner[i] == corner[i - 1])
            delays.append((images[noticed].header.stamp - images[first - 1].header.stamp).to_sec())
        self.assertLessEqual(min(delays), 0.2, delays)

    def test_14_a_silent_camera_is_frozen_too(self) -> None:
        self.await_level(ProximityState.CLEAR)
        for eye in EYES:
            self.peers.silent[eye] = True
        self.await_off()
        for eye in EYES:
            self.peers.silent[eye] = False
        self.await_level(ProximityState.CLEAR)

    def test_15_eyes_out_of_step_have_no_overlay(self) -> None:
        """Row 31: pictures of the right eye are 40 ms older; one eye alone."""
        self.await_level(ProximityState.CLEAR)
        self.peers.delay_s["right"] = 0.04
        self.await_off()
        for key, message in self.look():
            self.assertFalse(is_green(rgb(message)).any(), key)
        self.peers.delay_s["right"] = 0.0
        self.await_level(ProximityState.CLEAR)

    def test_16_diagnostics_count_and_say_why(self) -> None:
        def statuses() -> dict[str, dict[str, str]]:
            found = {}
            for array in self.diagnostics.all:
                for status in array.status:
                    if "visual_feedback" in status.name:
                        found[status.name] = {pair.key: pair.value for pair in status.values}
            return found

        keys = ("left drawn", "left out_of_step", "left frozen", "left refused", "left age_p99_ms")

        def counted() -> bool:
            found = statuses()
            return len(found) == 2 and all(float(values[key]) > 0.0 for values in found.values() for key in keys)

        wait_until(counted, lambda: f"{keys} of both: {statuses()}")

    def test_17_bad_parameters_refuse_the_start_by_name(self) -> None:
        program = ROOT / "devel" / "lib" / "saras_ros1" / "visual_feedback"
        good = rospy.get_param("/visual_feedback")
        spoilt = {
            "max_skew_s": "soon",
            "frozen_after_s": 3.0,
            "tools": [],
            "rectified": 1,
            "optical_frame_is": "crooked",
            "distances_timeout_s": -1.0,
        }
        for name, value in [*spoilt.items(), ("near_m", None), ("frozen_aftre_s", 0.1)]:
            values = {**good, name: value}
            if value is None:
                del values[name]
            rospy.set_param("/refused", values)
            done = subprocess.run(
                [str(program), "__name:=refused"], capture_output=True, text=True, timeout=60, check=False
            )
            self.assertEqual(done.returncode, 2, name)
            self.assertIn(name, done.stdout + done.stderr)
            rospy.delete_param("/refused")


if __name__ == "__main__":
    rostest.rosrun("saras_ros1", "visual_feedback", VisualFeedback)
