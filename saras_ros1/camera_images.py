"""Images and camera_info as numpy: what calibration and endoscope need of cv_bridge, without it."""

from __future__ import annotations

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image

from saras.calibration.camera import Intrinsics
from saras.calibration.camera_info import MODEL, Eye
from saras.calibration.raw_images import colours, grey

__all__ = ["camera_info_msg", "colours", "eye_of", "grey", "image_msg", "intrinsics_of"]


def intrinsics_of(message: CameraInfo) -> Intrinsics | None:
    """K and D of the raw image; None for a camera that is not calibrated (K[0] = 0, as ROS says it)."""
    if not message.K[0] > 0.0 or message.distortion_model not in ("plumb_bob", ""):
        return None
    distortion = np.zeros(5)
    distortion[: min(5, len(message.D))] = message.D[:5]
    return Intrinsics(np.array(message.K).reshape(3, 3), distortion, message.width, message.height)


def eye_of(message: CameraInfo) -> Eye | None:
    """All that a camera_info says; None for a camera that is not calibrated."""
    intrinsics = intrinsics_of(message)
    if intrinsics is None or not message.P[0] > 0.0:
        return None
    return Eye(intrinsics, np.array(message.R).reshape(3, 3), np.array(message.P).reshape(3, 4))


def camera_info_msg(eye: Eye | None, size: tuple[int, int], frame_id: str, stamp: rospy.Time) -> CameraInfo:
    """Of a calibrated eye; None: of images of this size (width, height) whose camera is not calibrated (K = 0)."""
    message = CameraInfo(width=size[0], height=size[1])
    message.header.frame_id, message.header.stamp = frame_id, stamp
    if eye is not None:
        message.distortion_model = MODEL
        message.D = eye.intrinsics.distortion.tolist()
        message.K = eye.intrinsics.matrix.ravel().tolist()
        message.R, message.P = eye.R.ravel().tolist(), eye.P.ravel().tolist()
    return message


def image_msg(pixels: np.ndarray, encoding: str, frame_id: str, stamp: rospy.Time) -> Image:
    """Of (height, width) or (height, width, channels), C-contiguous."""
    message = Image(height=pixels.shape[0], width=pixels.shape[1], encoding=encoding)
    message.header.frame_id, message.header.stamp = frame_id, stamp
    message.step = pixels.shape[1] * pixels.itemsize * (pixels.shape[2] if pixels.ndim == 3 else 1)
    message.data = pixels.tobytes()
    return message
