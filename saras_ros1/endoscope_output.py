"""What the simulated endoscope publishes for each eye: image_raw, image_raw/compressed, camera_info."""

from __future__ import annotations

import cv2
import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from saras.calibration.camera_info import Eye
from saras_ros1.camera_images import camera_info_msg, image_msg
from saras_ros1.endoscope_frames import OPTICAL

# A viewer that is slow gets the newest picture, not the last twenty.
QUEUE = 2


class EyeOutput:
    """Publishers of one side, "left" or "right"; images are built only for readers."""

    def __init__(self, side: str, jpeg_quality: int) -> None:
        self.side, self.frame, self._quality = side, OPTICAL[side], jpeg_quality
        base = f"/endoscope/{side}"
        self._image = rospy.Publisher(f"{base}/image_raw", Image, queue_size=QUEUE)
        self._jpeg = rospy.Publisher(f"{base}/image_raw/compressed", CompressedImage, queue_size=QUEUE)
        self._info = rospy.Publisher(f"{base}/camera_info", CameraInfo, queue_size=QUEUE)

    @property
    def read(self) -> bool:
        """Whether anyone reads the pictures."""
        return bool(self._image.get_num_connections() or self._jpeg.get_num_connections())

    def info(self, eye: Eye | None, size: tuple[int, int], stamp: rospy.Time) -> None:
        """camera_info; None: not calibrated."""
        self._info.publish(camera_info_msg(eye, size, self.frame, stamp))

    def picture(self, pixels: np.ndarray, stamp: rospy.Time) -> None:
        """pixels: (height, width, 3) BGR."""
        if self._image.get_num_connections():
            self._image.publish(image_msg(pixels, "bgr8", self.frame, stamp))
        if self._jpeg.get_num_connections():
            _, data = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, self._quality])
            message = CompressedImage(format="bgr8; jpeg compressed bgr8", data=data.tobytes())
            message.header.frame_id, message.header.stamp = self.frame, stamp
            self._jpeg.publish(message)
