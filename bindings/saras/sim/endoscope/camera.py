"""The simulated endoscope's two eyes, and how their distorted pixels lie in what a pinhole renders. Needs OpenCV."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

import saras
from saras import ConfigError
from saras.calibration.camera import Intrinsics
from saras.calibration.camera_info import Eye, rectified

Array = npt.NDArray[np.float64]

#: The eyes at 480 rows; other sizes are scaled.
_ROWS = 480
_LEFT = Intrinsics(
    np.array([[440.0, 0.0, 322.0], [0.0, 438.0, 243.0], [0.0, 0.0, 1.0]]),
    np.array([-0.22, 0.08, 5e-4, -4e-4, 0.0]),
    640,
    480,
)
_RIGHT = Intrinsics(
    np.array([[442.0, 0.0, 316.0], [0.0, 441.0, 239.0], [0.0, 0.0, 1.0]]),
    np.array([-0.21, 0.07, -3e-4, 2e-4, 0.0]),
    640,
    480,
)
# 5.2 mm apart, toed in by 0.7 degrees, and a little crooked, as real ones are.
_RIGHT_T_LEFT = np.array([-0.0052, 0.0001, -0.0002, 0.004, -0.012, 0.003])


@dataclass(frozen=True)
class StereoCamera:
    """Both eyes of an endoscope."""

    left: Eye
    right: Eye
    right_T_left: Array
    """(4, 4) of the raw optical frames"""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of either image [px]."""
        return self.left.size


def stereo_camera(width: int = 640, height: int = 480) -> StereoCamera:
    """The simulated endoscope, about 75 degrees wide at 4:3. Raises ConfigError for sizes outside 64 … 4096."""
    for name, value in (("width", width), ("height", height)):
        if not 64 <= value <= 4096:
            raise ConfigError(f"{name} = {value}: must be in [64, 4096]")
    pose: Array = saras.add_delta(np.eye(4), _RIGHT_T_LEFT, 1.0)
    left, right = (_scaled(eye, width, height) for eye in (_LEFT, _RIGHT))
    return StereoCamera(*rectified(left, right, pose), pose)


def _scaled(eye: Intrinsics, width: int, height: int) -> Intrinsics:
    scale = height / _ROWS
    matrix = eye.matrix.copy()
    matrix[:2, :2] *= scale
    # A pixel's centre is a whole number: the image's corner is at -0.5.
    matrix[:2, 2] = (matrix[:2, 2] + 0.5) * scale - 0.5
    matrix[0, 2] += 0.5 * (width - eye.width * scale)
    return replace(eye, matrix=matrix, width=width, height=height)


@dataclass(frozen=True)
class WideView:
    """The pinhole image, wide enough that every pixel of the distorted one is in it."""

    focal_px: float
    center_px: tuple[float, float]
    width: int
    height: int

    def frustum(self) -> tuple[float, float, float, float]:
        """left, right, bottom, top at distance 1, y up."""
        f, (cx, cy) = self.focal_px, self.center_px
        return (-0.5 - cx) / f, (self.width - 0.5 - cx) / f, -(self.height - 0.5 - cy) / f, (0.5 + cy) / f


def wide_views(eyes: list[Intrinsics], scale: float = 1.0) -> tuple[list[WideView], list[Array]]:
    """A pinhole for each eye, all of one size, and for each the (height, width, 2) places of the eye's pixels in it.

    scale: pixels of the pinhole for one of the eye, in the middle.
    """
    rays = [normalised(eye) for eye in eyes]
    focal = [scale * eye.matrix[0, 0] for eye in eyes]
    low = [f * ray.reshape(-1, 2).min(axis=0) for f, ray in zip(focal, rays)]
    spans = [f * ray.reshape(-1, 2).max(axis=0) - corner for f, ray, corner in zip(focal, rays, low)]
    width, height = (int(np.ceil(max(span[k] for span in spans))) + 4 for k in (0, 1))
    views, maps = [], []
    for f, ray, corner in zip(focal, rays, low):
        center = 1.5 - corner
        views.append(WideView(f, (float(center[0]), float(center[1])), width, height))
        maps.append(f * ray + center)
    return views, maps


def normalised(eye: Intrinsics) -> Array:
    """(height, width, 2) x/z and y/z of the ray through each pixel of the distorted image."""
    import cv2

    u, v = np.meshgrid(np.arange(eye.width, dtype=float), np.arange(eye.height, dtype=float))
    # The default stops after 5 steps, which leaves some hundredths of a pixel.
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-10)
    pixels = np.column_stack([u.ravel(), v.ravel()])[:, None]
    rays = cv2.undistortPointsIter(pixels, eye.matrix, eye.distortion, None, None, criteria)
    return np.asarray(rays, dtype=float).reshape(eye.height, eye.width, 2)


__all__ = ["StereoCamera", "WideView", "normalised", "stereo_camera", "wide_views"]
