"""Raw images as ROS carries them (sensor_msgs/Image, of rospy, of rosbags, or anything with its fields), as numpy."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from saras import CalibrationError

Image = npt.NDArray[np.uint8]

CHANNELS = {"mono8": 1, "8UC1": 1, "bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4}
# Rec. 601, as OpenCV turns colours to grey.
WEIGHTS = {"rgb": (0.299, 0.587, 0.114), "bgr": (0.114, 0.587, 0.299)}


def grey(message: Any) -> Image:
    """(height, width) of an 8-bit image. Raises CalibrationError for other encodings and sizes that do not fit."""
    pixels = _pixels(message)
    if pixels.shape[2] == 1:
        return np.ascontiguousarray(pixels[:, :, 0])
    return np.asarray(np.round(pixels[:, :, :3] @ np.array(WEIGHTS[message.encoding[:3]])), np.uint8)


def colours(message: Any) -> Image:
    """(height, width, 3) BGR of an 8-bit image, or (height, width) of a grey one. Raises as grey does."""
    pixels = _pixels(message)
    if pixels.shape[2] == 1:
        return pixels[:, :, 0]
    return pixels[:, :, :3] if message.encoding.startswith("bgr") else pixels[:, :, 2::-1]


def _pixels(message: Any) -> Image:
    channels = CHANNELS.get(message.encoding)
    if channels is None:
        raise CalibrationError(f"image encoding = {message.encoding!r}: must be one of {', '.join(CHANNELS)}")
    if message.step < message.width * channels or len(message.data) < message.step * message.height:
        raise CalibrationError(f"image of {len(message.data)} bytes: must hold {message.height} rows of {message.step}")
    rows = np.frombuffer(message.data, np.uint8)[: message.step * message.height].reshape(message.height, message.step)
    return rows[:, : message.width * channels].reshape(message.height, message.width, channels)


__all__ = ["CHANNELS", "colours", "grey"]
