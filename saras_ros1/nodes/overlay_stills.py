"""overlay_stills: a picture of the overlay in each state it takes, small enough for bag and report."""

from __future__ import annotations

import time
from functools import partial

import cv2
import rospy
from sensor_msgs.msg import CompressedImage, Image

from saras_ros1.camera_images import colours
from saras_ros1.channel import SIDES
from saras_ros1.msg import CollisionState
from saras_ros1.node import Node, run
from saras_ros1.overlay_moments import Moments

STATE_TIMEOUT_S = 0.5
LOOK_S = 0.1
QUALITY = 80
SUBSCRIBED_S = 2.0  #: a picture that does not come for so long is waited for anew


class OverlayStills(Node):
    """Subscribes to a picture only when a still is due: the overlay is drawn for nobody else."""

    def __init__(self) -> None:
        super().__init__("overlay_stills")
        self.width = self.params.integer("width", 80, 4000)
        self.params.finish()
        self.moments = Moments()
        self.collision = self.input("/collision/state", CollisionState, timeout_s=STATE_TIMEOUT_S)
        self._outputs = {
            s: rospy.Publisher(f"/endoscope/{s}/overlay_still", CompressedImage, queue_size=4) for s in SIDES
        }
        self._waiting: dict[str, rospy.Subscriber] = {}
        self._since_s, self.taken = 0.0, 0
        self.every(LOOK_S, self._look)

    def _look(self) -> None:
        now = time.monotonic()
        with self.lock:
            states = [tool.state for tool in self.collision.message.tools] if self.collision.fresh else []
            self.moments.update(states, now)
            if self._waiting and now - self._since_s > SUBSCRIBED_S:
                self._forget()
            if self._waiting or not self.moments.due(now):
                return
            self._since_s = now
            for side in SIDES:
                topic = f"/endoscope/{side}/image_overlay"
                on_image = partial(self._on_image, side)
                self._waiting[side] = rospy.Subscriber(topic, Image, on_image, queue_size=1, buff_size=1 << 25)

    def _on_image(self, side: str, message: Image) -> None:
        with self.lock:
            subscriber = self._waiting.pop(side, None)
            if subscriber is None:
                return
            name = self.moments.taken(time.monotonic()) if not self._waiting else self.moments.state_name
        subscriber.unregister()
        pixels = colours(message)
        height = round(pixels.shape[0] * self.width / pixels.shape[1])
        small = cv2.resize(pixels, (self.width, height), interpolation=cv2.INTER_AREA)
        _, data = cv2.imencode(".jpg", small, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
        still = CompressedImage(format=f"jpeg; {name}", data=data.tobytes())
        still.header = message.header
        self._outputs[side].publish(still)
        self.taken += 1

    def _forget(self) -> None:
        for subscriber in self._waiting.values():
            subscriber.unregister()
        self._waiting.clear()

    def report(self) -> dict:
        """Stills so far."""
        return {"stills": self.taken}


def main() -> int:
    """Runs the node."""
    return run(OverlayStills)
