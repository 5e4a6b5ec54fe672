"""Frames out of a video file by their number."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras.capture.video_file import VideoError

Image = npt.NDArray[np.uint8]


class VideoReader:
    """Reads on when later frames are asked for, and begins anew for an earlier one. Raises VideoError for no video."""

    def __init__(self, path: Path) -> None:
        try:
            import cv2
        except ImportError:
            raise VideoError("reading a video needs OpenCV: apt-get install python3-opencv") from None
        self.path, self._open = path, cv2.VideoCapture
        self._next = 0
        self._film = self._begin()

    def _begin(self) -> Any:
        film = self._open(str(self.path))
        if not film.isOpened():
            raise VideoError(f"{self.path}: cannot be read as a video")
        self._next = 0
        return film

    def frame(self, number: int) -> Image:
        """(height, width, 3) BGR. Raises VideoError: there is no such frame."""
        if number < self._next:
            self._film.release()
            self._film = self._begin()
        while self._next <= number:
            # Frames that nobody wants are decoded, but not converted.
            if not self._film.grab():
                raise VideoError(f"{self.path}: frame {number}: the video has {self._next}")
            self._next += 1
        good, pixels = self._film.retrieve()
        if not good:
            raise VideoError(f"{self.path}: frame {number} cannot be decoded")
        return np.asarray(pixels, np.uint8)


__all__ = ["VideoReader"]
