"""Random stereo cameras as calibrations give them, and OpenCV's word on where points are in their images."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np

from saras.overlay import CameraConfig

NEAR_M = 0.005


@dataclass
class Eye:
    """One eye of a rectified pair, and the same camera for OpenCV."""

    config: CameraConfig
    rectified: bool

    def raw_frame(self, points: np.ndarray) -> np.ndarray:
        """(n, 3) of the rectified left frame in the frame that this eye's image is taken in."""
        p = np.asarray(self.config.P)
        shifted = points + np.linalg.solve(p[:, :3], p[:, 3])
        return shifted if self.rectified else shifted @ np.asarray(self.config.R)  # rows: R^T x

    def opencv(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) by cv2.projectPoints, of points in front of the eye."""
        in_eye = self.raw_frame(points)
        if self.rectified:
            k, distortion = np.asarray(self.config.P)[:, :3], None
        else:
            k, distortion = np.asarray(self.config.K), np.asarray(self.config.distortion)
        pixels, _ = cv2.projectPoints(in_eye, np.zeros(3), np.zeros(3), np.ascontiguousarray(k), distortion)
        return pixels.reshape(-1, 2)


def random_pair(rng: np.random.Generator, *, rectified: bool, rational: bool) -> tuple[Eye, Eye]:
    """Left and right eye of one endoscope."""
    width, height = ((640, 480), (1280, 720), (1920, 1080))[rng.integers(3)]
    f = width * rng.uniform(0.6, 1.6)
    ks = [
        np.array(
            [
                [f * rng.uniform(0.97, 1.03), 0.0, 0.5 * width + rng.normal(0.0, 0.02 * width)],
                [0.0, f * rng.uniform(0.97, 1.03), 0.5 * height + rng.normal(0.0, 0.02 * height)],
                [0.0, 0.0, 1.0],
            ]
        )
        for _ in range(2)
    ]
    distortions = []
    for _ in range(2):
        d = np.zeros(8)
        d[:5] = rng.uniform(-0.35, 0.1), rng.uniform(-0.05, 0.12), *rng.normal(0.0, 1e-3, 2), rng.normal(0.0, 0.01)
        if rational:
            d[5:] = rng.uniform(-0.05, 0.25), rng.normal(0.0, 0.03), rng.normal(0.0, 0.005)
        distortions.append(d)
    rotation = cv2.Rodrigues(rng.normal(0.0, 0.02, 3))[0]
    translation = np.array([-rng.uniform(0.003, 0.006), *rng.normal(0.0, 2e-4, 2)])
    flags = cv2.CALIB_ZERO_DISPARITY if rng.random() < 0.5 else 0
    r1, r2, p1, p2, *_ = cv2.stereoRectify(
        ks[0], distortions[0], ks[1], distortions[1], (width, height), rotation, translation, flags=flags, alpha=0
    )
    eyes = []
    for k, d, r, p in zip(ks, distortions, (r1, r2), (p1, p2)):
        config = CameraConfig(
            width_px=width, height_px=height, K=k, R=r, P=p, distortion=d, rectified=rectified, near_m=NEAR_M
        )
        eyes.append(Eye(config, rectified))
    return eyes[0], eyes[1]


def in_image(pixels: np.ndarray, config: CameraConfig, margin_px: float = 0.0) -> np.ndarray:
    """(n,) whether pixels are on the image, or at most margin_px beside it."""
    low, high = -0.5 - margin_px, np.array([config.width_px, config.height_px]) - 0.5 + margin_px
    return np.isfinite(pixels).all(axis=1) & (pixels >= low).all(axis=1) & (pixels <= high).all(axis=1)


def before_the_fold(eye: Eye, points: np.ndarray, slack: float = 0.0) -> np.ndarray:
    """(n,) whether the radial part of the lens model still grows there, found on a dense ladder of radii.

    slack: so much of the radius (x/z) before the fold counts as beyond it.
    """
    if eye.rectified:
        return np.ones(len(points), dtype=bool)
    d = np.asarray(eye.config.distortion)
    r = np.arange(0.0, 20.0, 2e-4)
    r2 = r * r
    bent = r * (1 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]))) / (1 + r2 * (d[5] + r2 * (d[6] + r2 * d[7])))
    falls = np.flatnonzero(~(np.diff(bent) > 0.0))
    limit = r[falls[0]] if len(falls) else r[-1]
    in_eye = eye.raw_frame(points)
    return np.hypot(in_eye[:, 0], in_eye[:, 1]) < (limit - slack) * in_eye[:, 2]


def points_in_view(rng: np.random.Generator, eye: Eye, count: int) -> np.ndarray:
    """(m, 3) of the rectified left frame that OpenCV puts into the image, well before the fold of the lens model."""
    k = np.asarray(eye.config.P if eye.rectified else eye.config.K)
    depth = rng.uniform(0.02, 0.3, count)
    size = np.array([eye.config.width_px, eye.config.height_px])
    spread = (rng.uniform(-0.1, 1.1, (count, 2)) * size - k[:2, 2]) / [k[0, 0], k[1, 1]]
    in_eye = np.column_stack([spread * depth[:, None], depth])
    p = np.asarray(eye.config.P)
    rectified = in_eye if eye.rectified else in_eye @ np.asarray(eye.config.R).T
    points = rectified - np.linalg.solve(p[:, :3], p[:, 3])
    seen = in_image(eye.opencv(points), eye.config) & before_the_fold(eye, points, 2e-3)
    return points[seen]
