"""The newest two pictures of one moment, and whether they still move."""

from __future__ import annotations

import threading
import time
from collections import OrderedDict
from typing import NamedTuple

import rospy
from sensor_msgs.msg import CameraInfo, Image

from saras.calibration.camera_info import Eye
from saras_ros1.camera_images import eye_of
from saras_ros1.channel import SIDES

KEPT = 4
BUFFER_BYTES = 1 << 24


class Pair(NamedTuple):
    """Both messages and both eyes."""

    left: Image
    right: Image
    eyes: tuple[Eye, Eye]

    @property
    def stamp(self) -> rospy.Time:
        """Of the left picture."""
        return self.left.header.stamp


class UnknownPairError(Exception):
    """There is no pair to be used now; the text says why."""


class PicturePairs:
    """Subscribes to /endoscope/{left,right}/{image_raw,camera_info}.

    timeout_s: a pair received longer ago is no longer used; skew_s: how far apart the stamps may be; frozen_s: a camera
    that repeats one picture for so long is frozen.
    """

    def __init__(self, timeout_s: float, skew_s: float, frozen_s: float) -> None:
        self.timeout_s, self.skew_s, self.frozen_s = timeout_s, skew_s, frozen_s
        self._lock = threading.Lock()
        self._images: dict[str, OrderedDict[int, Image]] = {side: OrderedDict() for side in SIDES}
        self._infos: dict[str, CameraInfo] = {}
        self._eyes: tuple[bytes, tuple[Eye, Eye]] | None = None
        self._pair: tuple[Image, Image] | None = None
        self._pair_s = self._moved_s = float("-inf")
        for side in SIDES:
            base = f"/endoscope/{side}"
            rospy.Subscriber(f"{base}/image_raw", Image, self._on_image, side, queue_size=1, buff_size=BUFFER_BYTES)
            rospy.Subscriber(f"{base}/camera_info", CameraInfo, self._on_info, side, queue_size=1)

    def _on_info(self, message: CameraInfo, side: str) -> None:
        self._infos[side] = message

    def _on_image(self, message: Image, side: str) -> None:
        with self._lock:
            own = self._images[side]
            own[message.header.stamp.to_nsec()] = message
            while len(own) > KEPT:
                own.popitem(last=False)
            other = self._images["right" if side == "left" else "left"]
            stamp = message.header.stamp.to_nsec()
            near = min(other, key=lambda at: abs(at - stamp), default=None)
            if near is None or abs(near - stamp) > 1e9 * self.skew_s:
                return
            pair = (message, other[near]) if side == "left" else (other[near], message)
            now = time.monotonic()
            if self._pair is None or pair[0].data != self._pair[0].data or pair[1].data != self._pair[1].data:
                self._moved_s = now
            self._pair, self._pair_s = pair, now

    def newest(self) -> Pair:
        """Raises UnknownPairError."""
        with self._lock:
            pair, age_s = self._pair, time.monotonic() - self._pair_s
            still_s = self._pair_s - self._moved_s
            heard = [side for side in SIDES if self._images[side]]
        if pair is None:
            missing = [side for side in SIDES if side not in heard]
            raise UnknownPairError(
                f"no picture of the {' and the '.join(missing)} eye"
                if missing
                else f"left and right pictures are never within {1e3 * self.skew_s:g} ms of each other"
            )
        if age_s > self.timeout_s:
            raise UnknownPairError(f"pictures are {age_s:.1f} s old: must be at most {self.timeout_s:g}")
        if still_s >= self.frozen_s:
            raise UnknownPairError(f"camera is frozen: the same pictures for {still_s:.1f} s")
        return Pair(*pair, self._calibrated(pair))

    def _calibrated(self, pair: tuple[Image, Image]) -> tuple[Eye, Eye]:
        eyes = []
        key = b""
        for side, image in zip(SIDES, pair):
            info = self._infos.get(side)
            if info is None:
                raise UnknownPairError(f"no camera_info of the {side} eye")
            if (info.width, info.height) != (image.width, image.height):
                raise UnknownPairError(
                    f"{side} picture is {image.width}x{image.height}: camera_info is for {info.width}x{info.height}"
                )
            key += repr((info.K, info.D, info.R, info.P, info.width)).encode()
            eyes.append(info)
        if self._eyes is None or self._eyes[0] != key:
            made = [eye_of(info) for info in eyes]
            if made[0] is None or made[1] is None:
                raise UnknownPairError("camera_info: the camera is not calibrated")
            self._eyes = key, (made[0], made[1])
        return self._eyes[1]
