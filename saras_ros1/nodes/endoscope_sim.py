"""endoscope_sim: both eyes of a simulated endoscope on the ECM, with the room that the other simulations are in."""

from __future__ import annotations

import time

import numpy as np
import rospy
from sensor_msgs.msg import Image

from saras import ConfigError, Error
from saras.kinematics.scene import pose_from_xyz_rpy
from saras.sim import clap
from saras.sim.endoscope import Room, StereoRenderer, stereo_camera
from saras.sim.endoscope.window import check_drawing
from saras_ros1.camera_images import image_msg
from saras_ros1.channel import SIDES
from saras_ros1.collision_tools import WORLD
from saras_ros1.endoscope_frames import EndoscopeFrames
from saras_ros1.endoscope_output import EyeOutput
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.node import Node, run
from saras_ros1.seen_tools import SeenTools

# Below this share of the wanted rate the node says that it falls short.
ENOUGH = 0.9


class EndoscopeSim(Node):
    """Draws on its own timer, and only while someone looks. A picture's stamp is the time of the poses in it."""

    def __init__(self) -> None:
        super().__init__("endoscope_sim")
        self.rate_hz = self.params.number("rate_hz", 0.5, 60.0)
        self.camera = stereo_camera(self.params.integer("width", 64, 4096), self.params.integer("height", 64, 4096))
        quality = self.params.integer("jpeg_quality", 10, 100)
        self.room = self._load_room(self.params.text("scene_file"))
        self._options = {
            "seed": self.params.integer("seed", 0, 2**31),
            "noise": self.params.number("noise", 0.0, 32.0),
            "render_scale": self.params.number("render_scale", 0.5, 4.0),
        }
        self.unseen = self.params.flag("render_unseen")
        self.claps = self.params.flag("claps")
        self.live = LiveFrames(self.params.number("transform_timeout_s", 0.005, 2.0))
        self.frames = EndoscopeFrames(self, self.params.section("mount"))
        self.params.finish()
        check_drawing()
        self.frames.place_right(self.camera.right_T_left)
        self.tools = SeenTools(self, self.live)
        self.eyes = [EyeOutput(side, quality) for side in SIDES]
        self.truth = [
            [rospy.Publisher(f"/endoscope/{side}/truth/{kind}", Image, queue_size=2) for kind in ("depth", "labels")]
            for side in SIDES
        ]
        self.renderer: StereoRenderer | None = None
        self.why = "starting"
        self.shown = self.counted = self.ticks = self.counted_ticks = 0
        self.worst_s = self.busy_s = 0.0
        self.since_s = time.monotonic()
        self.every(1.0 / self.rate_hz, self.tick)

    def _load_room(self, path: str) -> Room:
        board = None
        place = self.params.section("world_T_board")
        xyz, rpy = place.vector("xyz_m", 3, -10.0, 10.0), place.vector("rpy_rad", 3, -2.0 * np.pi, 2.0 * np.pi)
        if self.params.flag("show_board"):
            board = pose_from_xyz_rpy(xyz, rpy)
        try:
            return Room.load(path, board)
        except OSError as error:
            raise ConfigError(f"{self.name}/scene_file: {error}") from None

    def tick(self) -> None:
        """One pair of pictures. VTK is made and used in this timer's thread alone."""
        self.ticks += 1
        try:
            if self.renderer is None:
                self.renderer = StereoRenderer(self.room, self.camera, **self._options)
        except Error as error:
            rospy.logfatal(f"{self.name}: {error}")
            rospy.signal_shutdown(str(error))
            return
        stamp = rospy.Time.now()
        world_T_left = self._where()
        if world_T_left is None:
            return
        self.frames.publish(stamp)
        for eye, output in zip((self.camera.left, self.camera.right), self.eyes):
            output.info(eye, eye.size, stamp)
        truth = any(out.get_num_connections() for side in self.truth for out in side)
        if not (self.unseen or truth or any(eye.read for eye in self.eyes)):
            self.why = "nobody looks"
            return
        begin = time.perf_counter()
        tools, flash = self.tools.states(), self.claps and clap.is_on(time.time_ns())
        pair = self.renderer.render(world_T_left, tools)
        for output, pixels in zip(self.eyes, (pair.left, pair.right)):
            output.picture(pixels // 2 + 128 if flash else pixels, stamp)
        if truth:
            self._publish_truth(stamp)
        took = time.perf_counter() - begin
        self.shown += 1
        self.busy_s += took
        self.worst_s = max(self.worst_s, took)
        self.why = ""

    def _where(self) -> np.ndarray | None:
        """(4, 4) world_T_left: a camera shows what it shows, whether or not its arm still says where it is."""
        found = self.frames.last()
        if found is None:
            self.why = self.frames.arm.unknown_reason
            return None
        try:
            return self.live.fresh(WORLD, found[0]) @ found[1]
        except UnknownFrameError as error:
            self.why = str(error)
            return None

    def _publish_truth(self, stamp: rospy.Time) -> None:
        truth = self.renderer.truth()
        depths, labels = (truth.left_depth, truth.right_depth), (truth.left_labels, truth.right_labels)
        for output, publishers, depth, label in zip(self.eyes, self.truth, depths, labels):
            publishers[0].publish(image_msg(depth, "32FC1", output.frame, stamp))
            publishers[1].publish(image_msg(label, "mono8", output.frame, stamp))

    def report(self) -> dict:
        """Rate, shortfall and cost."""
        now = time.monotonic()
        span_s, self.since_s = max(now - self.since_s, 1e-3), now
        rate, self.counted = (self.shown - self.counted) / span_s, self.shown
        self.state = "RUNNING"
        if self.why:
            self.state += f": no pictures: {self.why}"
        elif rate < ENOUGH * self.rate_hz:
            self.state += f": {rate:.1f} of {self.rate_hz:g} Hz"
        return {
            "wanted_hz": self.rate_hz,
            "rate_hz": round(rate, 1),
            "shortfall_hz": round(max(0.0, self.rate_hz - rate), 1) if not self.why else 0.0,
            "step_mean_ms": round(1e3 * self.busy_s / max(1, self.shown), 1),
            "step_worst_ms": round(1e3 * self.worst_s, 1),
            "why": self.why or "none",
            "size": "x".join(map(str, self.camera.size)),
            **self.frames.arm.report(),
        }


def main() -> int:
    """Runs the node."""
    return run(EndoscopeSim)
