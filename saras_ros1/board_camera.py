"""The calibration board before a camera, live: the newest image with its intrinsics, and the markers drawn into it."""

from __future__ import annotations

import time

import numpy as np
import rospy
from sensor_msgs.msg import CameraInfo, Image

from saras import CalibrationError
from saras.calibration.board import Board
from saras.calibration.camera import BoardView, Intrinsics, find_markers, locate_board
from saras_ros1.camera_images import grey, intrinsics_of

STALE_S = 0.5
SEEN_BGR, REFUSED_BGR = (80, 200, 80), (60, 60, 230)


class BoardCamera:
    """Subscribes to an image and its camera_info. marked_topic: where the markers are shown, "": nowhere."""

    def __init__(self, image_topic: str, info_topic: str, board: Board, marked_topic: str = "") -> None:
        self.image_topic, self.board = image_topic, board
        self.image: Image | None = None
        self.intrinsics: Intrinsics | None = None
        self._image_at_s = float("-inf")
        self._marked = rospy.Publisher(marked_topic, Image, queue_size=1) if marked_topic else None
        rospy.Subscriber(image_topic, Image, self._on_image, queue_size=1, buff_size=1 << 24)
        rospy.Subscriber(info_topic, CameraInfo, self._on_info, queue_size=1)

    def _on_image(self, message: Image) -> None:
        self.image, self._image_at_s = message, time.monotonic()

    def _on_info(self, message: CameraInfo) -> None:
        self.intrinsics = intrinsics_of(message)

    def look(self) -> BoardView:
        """The board in the newest image. Raises CalibrationError with the reason why not."""
        if self.image is None or time.monotonic() - self._image_at_s > STALE_S:
            raise CalibrationError(f"no image on {self.image_topic} now")
        if self.intrinsics is None:
            raise CalibrationError("no camera_info: calibrate the camera first")
        return locate_board(grey(self.image), self.board, self.intrinsics)

    def show(self, text: str) -> None:
        """Publishes the newest image with the markers that are seen, and a line of text; only when somebody looks."""
        if self._marked is None or not self._marked.get_num_connections() or self.image is None:
            return
        self._marked.publish(self._draw(self.image, text))

    def _draw(self, message: Image, text: str) -> Image:
        import cv2

        picture = grey(message)
        canvas = cv2.cvtColor(picture, cv2.COLOR_GRAY2BGR)
        try:
            why = f"rms {self.look().rms_px:.2f} px"
            colour = SEEN_BGR
        except CalibrationError as error:
            why, colour = str(error), REFUSED_BGR
        for number, corners in find_markers(picture).items():
            cv2.polylines(canvas, [np.round(corners).astype(np.int32)], True, colour, 2, cv2.LINE_AA)
            x, y = map(int, corners.mean(axis=0))
            cv2.putText(canvas, str(number), (x - 8, y + 6), cv2.FONT_HERSHEY_SIMPLEX, 0.6, colour, 2, cv2.LINE_AA)
        for row, line in enumerate((why, text)):
            place = (8, 20 + 20 * row)
            for shade, width in (((0, 0, 0), 3), (colour, 1)):
                cv2.putText(canvas, line[:110], place, cv2.FONT_HERSHEY_SIMPLEX, 0.5, shade, width, cv2.LINE_AA)
        height, width = picture.shape
        marked = Image(height=height, width=width, encoding="bgr8", step=3 * width, data=canvas.tobytes())
        marked.header = message.header
        return marked
