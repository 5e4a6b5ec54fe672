"""stereo_contact: how deep the SARAS arms' tips are in the tissue that the endoscope sees, on /contact/{s}."""

from __future__ import annotations

import time
from dataclasses import fields

import numpy as np
import rospy
from geometry_msgs.msg import Vector3

from saras import ConfigError
from saras.calibration.camera_info import Eye
from saras.stereo_contact import ContactEstimate, StereoContact, StereoContactConfig, Tool
from saras_ros1.camera_images import colours
from saras_ros1.channel import SIDES, base_frame
from saras_ros1.collision_tools import WORLD, DvrkTool, UnknownToolError
from saras_ros1.endoscope_frames import LEFT
from saras_ros1.live_frames import LiveFrames, UnknownFrameError
from saras_ros1.msg import Contact, ContactQuality
from saras_ros1.node import Node, run
from saras_ros1.params import Params
from saras_ros1.picture_pairs import Pair, PicturePairs, UnknownPairError
from saras_ros1.tip_history import TipHistory


class StereoContactNode(Node):
    """Looks at the newest pair at its own rate; what cannot be known is published as NaN, with the reason beside it."""

    def __init__(self) -> None:
        super().__init__("stereo_contact")
        rate_hz = self.params.number("rate_hz", 0.5, 60.0)
        self.pairs = PicturePairs(
            self.params.number("camera_timeout_s", 0.05, 5.0),
            self.params.number("skew_s", 0.0, 0.1),
            self.params.number("frozen_s", 0.05, 5.0),
        )
        arm_timeout_s = self.params.number("arm_timeout_s", 0.005, 2.0)
        self.live = LiveFrames(self.params.number("transform_timeout_s", 0.005, 2.0))
        self.radius_m = self.params.section("mesa").number("radius_m", 0.0, 0.1)
        dvrk = self.params.section("dvrk")
        radius_m = dvrk.number("radius_m", 0.0, 0.1)
        options = {"timeout_s": arm_timeout_s, "frame_override": dvrk.text("frame_override", empty=True)}
        self.others = [DvrkTool(self, name, radius_m, **options) for name in dvrk.texts("arms")]
        self.config = settings(self.params.section("law"), f"{self.name}/law")
        self.params.finish()
        self.tips = {side: TipHistory(self, side, arm_timeout_s) for side in SIDES}
        self.contact = {side: self.output(f"/contact/{side}", Contact) for side in SIDES}
        self.quality = {side: self.output(f"/contact/{side}/quality", ContactQuality) for side in SIDES}
        self.estimator: tuple[tuple[Eye, Eye], StereoContact] | None = None
        self.seen_stamp: rospy.Time | None = None
        self.said_stamp = rospy.Time()
        self.shown: dict[str, ContactEstimate] = {}
        self.frames_seen = self.counted = 0
        self.busy_s = self.worst_s = 0.0
        self.since_s = time.monotonic()
        self.every(1.0 / rate_hz, self.tick)

    def tick(self) -> None:
        """One look. A pair that was judged already is not judged again: its contact grows old at the readers."""
        try:
            pair = self.pairs.newest()
        except UnknownPairError as error:
            self._publish_unknown(str(error))
            return
        if pair.stamp == self.seen_stamp:
            return
        self.seen_stamp = pair.stamp
        if pair.stamp <= self.said_stamp:
            return  # later than that "unknown" was said already: stamps never go back
        begin = time.perf_counter()
        try:
            found = self._estimate(pair)
        except (UnknownFrameError, UnknownToolError, ConfigError) as error:
            self._publish_unknown(str(error), pair.stamp)
            return
        for side in SIDES:
            self._publish(side, found[side], pair.stamp)
        took = time.perf_counter() - begin
        self.frames_seen += 1
        self.busy_s += took
        self.worst_s = max(self.worst_s, took)

    def _estimate(self, pair: Pair) -> dict[str, ContactEstimate]:
        if self.estimator is None or self.estimator[0] is not pair.eyes:
            self.estimator = pair.eyes, StereoContact(self.config, *pair.eyes)
        world_T_left = self.live.at(WORLD, LEFT, pair.stamp)
        tools: dict[str, Tool] = {}
        missing: dict[str, str] = {}
        for side in SIDES:
            try:
                tools[side] = Tool(*self.tips[side].ends(self.live, pair.stamp.to_nsec()), self.radius_m)
            except (UnknownToolError, UnknownFrameError) as error:
                missing[side] = str(error)
        for other in self.others:
            try:
                tools[other.name] = Tool(*other.ends(self.live), other.radius_m)
            except (UnknownToolError, UnknownFrameError) as error:  # its shaft would be taken for tissue
                raise UnknownToolError(f"{other.name}: {error}: it may be in the picture") from None
        left, right = colours(pair.left), colours(pair.right)
        now_s = time.monotonic()
        found = self.estimator[1].estimate(left, right, world_T_left, tools, now_s, tuple(SIDES))
        found.update({side: ContactEstimate(False, reason=reason) for side, reason in missing.items()})
        return found

    def _publish_unknown(self, reason: str, stamp: rospy.Time | None = None) -> None:
        """Without a picture it is stamped as old as one that would still count, so that one on its way does count."""
        stamp = stamp or max(self.said_stamp, rospy.Time.now() - rospy.Duration(self.pairs.timeout_s))
        for side in SIDES:
            self._publish(side, ContactEstimate(False, reason=reason), stamp)

    def _publish(self, side: str, found: ContactEstimate, stamp: rospy.Time) -> None:
        direction = np.zeros(3)
        if found.known:
            try:
                direction = self.live.fresh(WORLD, base_frame(side))[:3, :3].T @ found.normal
            except UnknownFrameError as error:
                found = ContactEstimate(False, reason=str(error))
        self.said_stamp = stamp
        message = Contact(depth=found.depth_m, direction=Vector3(*direction))
        message.header.stamp, message.header.frame_id = stamp, base_frame(side)
        self.contact[side].publish(message)
        quality = ContactQuality(
            confidence=found.confidence, deviation=found.std_m, points=found.points, reason=found.reason
        )
        quality.header = message.header
        self.quality[side].publish(quality)
        self.shown[side] = found

    def report(self) -> dict:
        """Rate, cost, and what is known of each side."""
        now = time.monotonic()
        span_s, self.since_s = max(now - self.since_s, 1e-3), now
        rate, self.counted = (self.frames_seen - self.counted) / span_s, self.frames_seen
        values = {
            "rate_hz": round(rate, 1),
            "step_mean_ms": round(1e3 * self.busy_s / max(1, self.frames_seen), 1),
            "step_worst_ms": round(1e3 * self.worst_s, 1),
            "remembered": len(self.estimator[1].memory) if self.estimator is not None else 0,
        }
        for side, found in dict(self.shown).items():
            values[side] = (
                f"{1e3 * found.depth_m:.1f} mm +- {1e3 * found.std_m:.2f}" if found.known else f"? {found.reason}"
            )
        return values


def settings(params: Params, where: str) -> StereoContactConfig:
    """The estimator's parameters: each must be there. Raises ConfigError."""
    values = {}
    for field in fields(StereoContactConfig):
        whole = isinstance(field.default, int)
        values[field.name] = params.integer(field.name, 0, 10**6) if whole else params.number(field.name)
    params.finish()
    try:
        return StereoContactConfig(**values)
    except ConfigError as error:
        raise ConfigError(f"{where}: {error}") from None


def main() -> int:
    """Runs the node."""
    return run(StereoContactNode)
