"""endoscope_capture: a real stereo endoscope, or recordings of one, through GStreamer."""

from __future__ import annotations

import threading
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import rospy
from std_msgs.msg import String

from saras import ConfigError
from saras.calibration.camera_info import Eye, right_T_left
from saras.capture import SOURCES, Frame, Grabber, Pairing, halves, source_text
from saras.capture.frames import LAYOUTS
from saras.overlay import FrozenWatch, FrozenWatchConfig, fingerprint
from saras_ros1.channel import SIDES
from saras_ros1.endoscope_frames import EndoscopeFrames
from saras_ros1.endoscope_output import EyeOutput
from saras_ros1.node import Node, run
from saras_ros1.params import Params
from saras_ros1.stamped import time_of


class CapturedEye:
    """One side: its calibration, its outputs, and whether it is worth looking at."""

    def __init__(self, side: str, topics: str, quality: int, eye: Eye | None, frozen_s: float) -> None:
        self.side, self.eye = side, eye
        self.output = EyeOutput(side, quality, topics)
        # frozen_s 0: still pictures are meant to stay
        self.watch = FrozenWatch(FrozenWatchConfig(frozen_after_s=frozen_s)) if frozen_s else None
        self.looked_s = time.monotonic()
        self.status = "STARTING"
        self.shown = 0
        self.wrong_size = ""
        self._status = rospy.Publisher(f"{topics}/{side}/status", String, queue_size=5, latch=True)
        self._status.publish(String(self.status))

    def say(self, status: str) -> None:
        """On /endoscope/{s}/status, when it changes."""
        if status != self.status:
            self.status = status
            (rospy.loginfo if status == "OK" else rospy.logerr)(f"{self.side} eye: {status}")
            self._status.publish(String(status))

    def show(self, frame: Frame, stamp: rospy.Time) -> bool:
        """Publishes, unless the picture is the one that was there all the time: old data gets no new stamp."""
        size = frame.pixels.shape[1], frame.pixels.shape[0]
        if self._frozen(frame):
            self.say("FROZEN")
            return False
        self.say("OK")
        eye = self.eye
        self.wrong_size = ""
        if eye is not None and eye.size != size:  # numbers of another size would put the overlay elsewhere
            self.wrong_size = f"pictures are {size[0]}x{size[1]}, calibrated {eye.size[0]}x{eye.size[1]}"
            eye = None
        self.output.info(eye, size, stamp)
        self.output.picture(frame.pixels, stamp)
        self.shown += 1
        return True

    def _frozen(self, frame: Frame) -> bool:
        now_s, before_s = time.monotonic(), self.looked_s
        self.looked_s = now_s
        return self.watch is not None and self.watch.step(fingerprint(frame.pixels, "bgr8"), now_s - before_s).frozen


class EndoscopeCapture(Node):
    """Publishes from the grabbers' threads, as pictures come."""

    def __init__(self) -> None:
        super().__init__("endoscope_capture")
        topics = self.params.text("topics")
        self.layout, self.swap = self.params.text("layout", LAYOUTS), self.params.flag("swap")
        sources = self._sources()
        options = {
            "loop": self.params.flag("loop"),
            "latency_s": self.params.number("latency_s", 0.0, 1.0),
            "silence_s": self.params.number("silence_s", 0.1, 60.0),
            "retry_s": self.params.number("retry_s", 0.1, 600.0),
        }
        self.pairing: Pairing[Frame] = Pairing(self.params.number("skew_s", 0.0, 0.5))
        frozen_s = self.params.number("frozen_s", 0.0, 10.0)
        quality = self.params.integer("jpeg_quality", 10, 100)
        files = self.params.section("camera_info")
        eyes = [self._calibration(files, side) for side in SIDES]
        self.frames = EndoscopeFrames(self, self.params.section("mount"))
        self.params.finish()
        if eyes[0] is not None and eyes[1] is not None:
            self.frames.place_right(right_T_left(eyes[0], eyes[1]))
        self.eyes = [CapturedEye(side, topics, quality, eye, frozen_s) for side, eye in zip(SIDES, eyes)]
        self.turn = threading.Lock()
        self.unpaired = self.counted = 0
        self.since_s = time.monotonic()
        self.grabbers = []
        for i, source in enumerate(sources):
            two = len(sources) == 2
            name = f"{SIDES[i]} eye" if two else "endoscope"
            mine = self.eyes[i : i + 1] if two else self.eyes
            on_frame = partial(self._on_half, i) if two else self._on_both
            grabber = Grabber(name, source, on_frame, on_state=partial(self._on_state, mine), **options)
            self.grabbers.append(grabber)
        rospy.on_shutdown(self._stop)
        for grabber in self.grabbers:
            grabber.start()

    def _sources(self) -> list[str]:
        width, height = self.params.integer("width", 0, 8192), self.params.integer("height", 0, 8192)
        rate_hz = self.params.number("rate_hz", 0.0, 240.0)
        texts = []
        for side in SIDES:
            section = self.params.section(side)
            kind, device = section.text("source", SOURCES), section.text("device", empty=True)
            options = section.text("options", empty=True)
            if side == "right" and self.layout != "two_devices":
                continue
            try:
                texts.append(source_text(kind, device, options, width=width, height=height, rate_hz=rate_hz))
            except ConfigError as error:
                raise ConfigError(f"{self.name}/{side}: {error}") from None
        return texts

    def _calibration(self, files: Params, side: str) -> Eye | None:
        path = files.text(side, empty=True)
        if not path:
            rospy.logwarn(f"{self.name}: {side} eye is not calibrated: nothing can be drawn on its pictures")
            return None
        if not Path(path).is_absolute():  # roslaunch starts nodes in a directory of its own
            raise ConfigError(f"{self.name}/camera_info/{side} = {path!r}: must be an absolute path")
        try:
            return Eye.load(path)
        except OSError as error:
            raise ConfigError(f"{self.name}/camera_info/{side}: {error}") from None

    def _on_state(self, eyes: list[CapturedEye], state: str) -> None:
        if state != "OK":
            for eye in eyes:
                eye.say(state)

    def _on_both(self, frame: Frame) -> None:
        """Both eyes in one picture."""
        try:
            first, second = halves(frame.pixels, self.layout)
        except ConfigError as error:
            for eye in self.eyes:
                eye.say(f"LOST: {error}")
            return
        both = (second, first) if self.swap else (first, second)
        self._publish([replace(frame, pixels=pixels) for pixels in both], frame.taken_ns)

    def _on_half(self, index: int, frame: Frame) -> None:
        """One eye of two devices, from its own thread."""
        side = 1 - index if self.swap else index
        with self.turn:
            for left, right in self.pairing.add(side, 1e-9 * frame.taken_ns, frame):
                if left is not None and right is not None:
                    self._publish([left, right], (left.taken_ns + right.taken_ns) // 2)
                else:  # its own time: readers see for themselves that the eyes are out of step
                    self.unpaired += 1
                    alone = left or right
                    self._publish([left, right], alone.taken_ns)

    def _publish(self, frames: list[Frame | None], taken_ns: int) -> None:
        if rospy.is_shutdown():
            return
        stamp = time_of(taken_ns)
        try:
            self.frames.publish(stamp)
            for eye, frame in zip(self.eyes, frames):
                if frame is not None:
                    eye.show(frame, stamp)
        except rospy.ROSException:
            pass  # topics are closed: the node shuts down

    def _stop(self) -> None:
        for grabber in self.grabbers:
            grabber.stop()

    def report(self) -> dict:
        """State and rate of each eye."""
        now = time.monotonic()
        span_s, self.since_s = max(now - self.since_s, 1e-3), now
        shown = sum(eye.shown for eye in self.eyes)
        rate, self.counted = 0.5 * (shown - self.counted) / span_s, shown
        bad = [f"{eye.side} eye {text}" for eye in self.eyes if (text := eye.wrong_size or eye.status) != "OK"]
        self.state = "; ".join(bad) or "RUNNING"
        values = {"rate_hz": round(rate, 1), "unpaired": self.unpaired, "skew_ms": round(1e3 * self.pairing.apart_s, 1)}
        for eye in self.eyes:
            values[eye.side] = eye.wrong_size or eye.status
        for grabber in self.grabbers:
            values[grabber.name] = f"{grabber.state} frames={grabber.frames} failures={grabber.failures}"
        return {**values, **self.frames.arm.report()}


def main() -> int:
    """Runs the node."""
    return run(EndoscopeCapture)
