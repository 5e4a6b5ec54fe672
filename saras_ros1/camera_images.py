"""Images and camera_info as numpy: what the calibration needs of cv_bridge, without it."""

from __future__ import annotations

import numpy as np
from sensor_msgs.msg import CameraInfo, Image

from saras import CalibrationError
from saras.calibration.camera import Intrinsics

CHANNELS = {"mono8": 1, "bgr8": 3, "rgb8": 3, "bgra8": 4, "rgba8": 4}
# Rec. 601, as OpenCV turns colours to grey.
WEIGHTS = {"rgb": (0.299, 0.587, 0.114), "bgr": (0.114, 0.587, 0.299)}


def grey(message: Image) -> np.ndarray:
    """(height, width) of an 8-bit image. Raises CalibrationError for other encodings and sizes that do not fit."""
    channels = CHANNELS.get(message.encoding)
    if channels is None:
        raise CalibrationError(f"image encoding = {message.encoding!r}: must be one of {', '.join(CHANNELS)}")
    if message.step < message.width * channels or len(message.data) < message.step * message.height:
        raise CalibrationError(f"image of {len(message.data)} bytes: must hold {message.height} rows of {message.step}")
    rows = np.frombuffer(message.data, np.uint8)[: message.step * message.height].reshape(message.height, message.step)
    pixels = rows[:, : message.width * channels].reshape(message.height, message.width, channels)
    if channels == 1:
        return np.ascontiguousarray(pixels[:, :, 0])
    return np.round(pixels[:, :, :3] @ np.array(WEIGHTS[message.encoding[:3]])).astype(np.uint8)


def intrinsics_of(message: CameraInfo) -> Intrinsics | None:
    """K and D of the raw image; None for a camera that is not calibrated (K[0] = 0, as ROS says it)."""
    if not message.K[0] > 0.0 or message.distortion_model not in ("plumb_bob", ""):
        return None
    distortion = np.zeros(5)
    distortion[: min(5, len(message.D))] = message.D[:5]
    return Intrinsics(np.array(message.K).reshape(3, 3), distortion, message.width, message.height)
