"""From two pictures to points on what they show: rectified, matched at half size, refined, masked. Needs OpenCV."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.calibration.camera_info import Eye
from saras.stereo_contact.settings import StereoContactConfig

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

GLARE = 245  # grey levels from which a pixel shows a lamp, not tissue
NEAREST_DRAWN_M = 0.006
SAMPLES = 24  # along a shaft
BEYOND_M = 0.10  # so much of a shaft behind its trocar is masked, too: who knows where the wall is
#: Of the matches at half size every third is refined at full size.
STRIDE_PX = 3
WINDOW_PX = 17
LEAST_TEXTURE = 1e-4  # as calcOpticalFlowPyrLK measures it
WRONG_ROW_PX = 0.8  # a match in another row is none: these pictures are rectified
MOST_CHANGE_PX = 3.0


class StereoPoints:
    """Both eyes at half size. Points are in the rectified left frame."""

    def __init__(self, config: StereoContactConfig, left: Eye, right: Eye) -> None:
        import cv2

        if left.size != right.size:
            raise ConfigError(f"right eye = {right.size}: must be of the left one's size, {left.size}")
        if not right.baseline_m > 0.0:
            raise ConfigError(f"baseline of the right eye = {right.baseline_m} m: must be > 0: eyes exchanged?")
        self.config, self.left = config, left
        self.size = left.size[0] // 2, left.size[1] // 2
        self._maps = [
            cv2.initUndistortRectifyMap(
                eye.intrinsics.matrix, eye.intrinsics.distortion, eye.R, eye.P[:, :3], eye.size, cv2.CV_16SC2
            )
            for eye in (left, right)
        ]
        self.P = _halved(left.P[:, :3])
        self.focal_px, self.baseline_m = float(self.P[0, 0]), right.baseline_m  # at half size, as is P
        self.shift_px = float(_halved(right.P[:, :3])[0, 2] - self.P[0, 2])  # of infinity, where the centres differ
        per_m = self.focal_px * self.baseline_m
        first = int(np.floor(per_m / config.furthest_m - self.shift_px))
        count = int(np.ceil((per_m / config.nearest_m - self.shift_px - first) / 16.0)) * 16
        area = config.block_px**2
        self._matcher = cv2.StereoSGBM_create(
            minDisparity=first,
            numDisparities=count,
            blockSize=config.block_px,
            P1=8 * area,
            P2=32 * area,
            disp12MaxDiff=1,
            uniquenessRatio=8,
            speckleWindowSize=60,
            speckleRange=1,
            preFilterCap=31,
            mode=cv2.STEREO_SGBM_MODE_SGBM_3WAY,
        )
        self._first, self._border = first, max(0, first + count)
        self._chosen = np.zeros((self.size[1], self.size[0]), dtype=bool)
        self._chosen[::STRIDE_PX, ::STRIDE_PX] = True
        self._reach_px = config.block_px // 2 + 1

    def points(self, left: Image, right: Image, capsules: Iterable[tuple[Array, Array, float]]) -> Array:
        """(n, 3) points of what is not a tool [m].

        left, right: raw pictures, (height, width) or (height, width, 3) BGR. capsules: tip and trocar, (3,) each in the
        rectified left frame, and radius [m].
        """
        import cv2

        full = [
            cv2.remap(
                picture if picture.ndim == 2 else cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), *maps, cv2.INTER_LINEAR
            )
            for picture, maps in zip((left, right), self._maps)
        ]
        grey = [cv2.resize(picture, self.size, interpolation=cv2.INTER_AREA) for picture in full]
        # SGBM leaves out what may have its match beyond the border: it gets a border of that width.
        wide = [cv2.copyMakeBorder(picture, 0, 0, self._border, 0, cv2.BORDER_REPLICATE) for picture in grey]
        disparity = self._matcher.compute(wide[0], wide[1])[:, self._border :].astype(np.float32) / 16.0
        good = (disparity >= self._first) & self._chosen
        glare = cv2.dilate((grey[0] > GLARE).astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
        shafts = list(capsules)
        hidden_left, hidden_right = self._hidden(shafts, 0.0), self._hidden(shafts, self.baseline_m)
        good &= ~glare & ~hidden_left
        rows, columns = np.nonzero(good)
        found = disparity[rows, columns]
        there = np.round(columns - found).astype(int)
        inside = (there >= 0) & (there < self.size[0])
        # A match on a tool, or just beside one, is none.
        seen = inside & ~hidden_right[rows, np.clip(there, 0, self.size[0] - 1)]
        at = np.column_stack([columns[seen], rows[seen]]).astype(np.float32)
        places, found = self._refined(full, 2.0 * at + 0.5, 2.0 * found[seen])
        p = self.left.P
        depth = p[0, 0] * self.baseline_m / (found + 2.0 * self.shift_px)
        near = (depth > self.config.nearest_m) & (depth < self.config.furthest_m)
        places, depth = places[near], depth[near]
        return np.column_stack([(places - p[:2, 2]) / [p[0, 0], p[1, 1]] * depth[:, None], depth])

    def _refined(self, full: list[Image], at: npt.NDArray[np.float32], rough: Array) -> tuple[Array, Array]:
        """Places (n, 2) in the left picture at full size and disparities to hundredths of a pixel.

        SGBM's own fractions lean towards whole pixels, over whole patches at once: millimetres at a hand's breadth.
        """
        import cv2

        if not len(at):
            return np.zeros((0, 2)), np.zeros(0)
        guess = at.copy()
        guess[:, 0] -= rough
        criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 12, 0.01)
        window = (WINDOW_PX, WINDOW_PX)
        flags = cv2.OPTFLOW_USE_INITIAL_FLOW
        there, status, _ = cv2.calcOpticalFlowPyrLK(
            full[0], full[1], at, guess.copy(), None, None, window, 0, criteria, flags, LEAST_TEXTURE
        )
        moved = np.abs(there - guess)
        good = (status.ravel() > 0) & (moved[:, 1] < WRONG_ROW_PX) & (moved[:, 0] < MOST_CHANGE_PX)
        return at[good].astype(float), (at[good, 0] - there[good, 0]).astype(float)

    def pixel(self, point: Array) -> Array | None:
        """(2,) where a point (3,) of the rectified left frame is at half size; None: not before the camera."""
        if not point[2] > NEAREST_DRAWN_M:
            return None
        return np.asarray((self.P @ point)[:2] / point[2])

    def _hidden(self, capsules: list[tuple[Array, Array, float]], offset_m: float) -> npt.NDArray[np.bool_]:
        """Pixels of an eye, offset_m to the right of the left one, where a tool or its neighbourhood is."""
        import cv2

        mask = np.zeros((self.size[1], self.size[0]), np.uint8)
        p = self.P.copy()
        if offset_m:
            p[0, 2] += self.shift_px
        for tip, trocar, radius in capsules:
            shaft = trocar - tip
            shaft *= 1.0 + BEYOND_M / max(float(np.linalg.norm(shaft)), 1e-3)
            along = np.linspace(0.0, 1.0, SAMPLES)[:, None] ** 2  # denser at the tip
            axis = tip + along * shaft - [offset_m, 0.0, 0.0]
            axis = axis[axis[:, 2] > NEAREST_DRAWN_M]
            if len(axis) < 2:
                continue
            pixels = axis @ p.T
            pixels = np.clip(pixels[:, :2] / pixels[:, 2:], -4000, 4000)
            width = (radius + self.config.mask_margin_m) * self.focal_px / axis[:, 2] + self._reach_px
            for a, b, w in zip(pixels[:-1], pixels[1:], np.maximum(width[:-1], width[1:])):
                ends = [tuple(round(float(value)) for value in end) for end in (a, b)]
                cv2.line(mask, ends[0], ends[1], 1, max(1, int(np.ceil(2.0 * w))))
        return mask > 0


def _halved(matrix: Array) -> Array:
    """Intrinsics of the picture at half size: a pixel's centre is a whole number."""
    half = matrix.copy()
    half[:2] *= 0.5
    half[:2, 2] -= 0.25
    return half


__all__ = ["StereoPoints"]
