"""Plane patterns as a distorting camera sees them: images for the simulated endoscope and for tests. Needs OpenCV."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras.calibration.board import Board, marker_cells
from saras.calibration.camera import Intrinsics

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

#: Each pixel is the mean of so many by so many rays.
RAYS = 3


class Pattern:
    """Black and white on a plane: `shade(xy)` says how white the points (n, 2) [m] are, 0 to 1."""

    def shade(self, xy: Array) -> Array:
        """(n,) of the points (n, 2) [m]."""
        raise NotImplementedError


class BoardPattern(Pattern):
    """The calibration board on white paper."""

    def __init__(self, board: Board) -> None:
        self.board = board

    def shade(self, xy: Array) -> Array:
        """White paper, black dots and marker cells."""
        white = np.ones(len(xy))
        for dot in self.board.dots:
            white[((xy - dot[:2]) ** 2).sum(axis=1) < (0.5 * self.board.config.dot_diameter_m) ** 2] = 0.0
        for marker_id, corners in self.board.markers.items():
            side = corners[1, 0] - corners[0, 0]
            column = np.floor(6.0 * (xy[:, 0] - corners[0, 0]) / side).astype(int)
            row = np.floor(6.0 * (corners[0, 1] - xy[:, 1]) / side).astype(int)
            inside = (column >= 0) & (column < 6) & (row >= 0) & (row < 6)
            white[inside] = np.where(marker_cells(marker_id)[row[inside], column[inside]], 0.0, 1.0)
        return white


class Checkerboard(Pattern):
    """columns x rows inner corners; the first at the origin, x along the columns, y along the rows."""

    def __init__(self, columns: int, rows: int, square_m: float) -> None:
        self.columns, self.rows, self.square_m = columns, rows, square_m

    def shade(self, xy: Array) -> Array:
        """Squares with a white border of one square."""
        cell = np.floor(xy / self.square_m).astype(int)
        inside = (cell >= -1).all(axis=1) & (cell[:, 0] < self.columns) & (cell[:, 1] < self.rows)
        return np.where(inside & ((cell.sum(axis=1) % 2) == 0), 0.0, 1.0)


def render(
    pattern: Pattern,
    camera_T_pattern: Array,
    intrinsics: Intrinsics,
    rng: np.random.Generator | None = None,
    noise: float = 2.0,
) -> Image:
    """(height, width) grey image, by casting RAYS² rays a pixel through the inverse distortion.

    camera_T_pattern: (4, 4), pattern in its z = 0. rng: adds normal noise of `noise` grey levels. What is not the plane
    from its front is dark grey.
    """
    width, height = intrinsics.width, intrinsics.height
    total = np.zeros(width * height)
    normal, origin = camera_T_pattern[:3, 2], camera_T_pattern[:3, 3]
    front = normal @ origin < 0.0
    for rays in _rays(intrinsics):
        along = rays @ normal
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = (origin @ normal) / along
        hit = np.isfinite(depth) & (depth > 0.0) & front
        shade = np.full(len(rays), 0.25)
        local = (rays[hit] * depth[hit, None] - origin) @ camera_T_pattern[:3, :2]
        shade[hit] = 0.08 + 0.84 * pattern.shade(local)
        total += shade
    image = 255.0 * total.reshape(height, width) / RAYS**2
    if rng is not None:
        image += rng.normal(0.0, noise, image.shape)
    pixels: Image = np.clip(np.round(image), 0, 255).astype(np.uint8)
    return pixels


_cache: dict[bytes, list[Array]] = {}


def _rays(intrinsics: Intrinsics) -> list[Array]:
    """Directions (n, 3) with z = 1 of all pixels, for each of the RAYS² places in a pixel; kept for a few cameras."""
    import cv2

    key = np.concatenate([intrinsics.matrix.ravel(), intrinsics.distortion, [intrinsics.width, intrinsics.height]])
    name = key.tobytes()
    if name not in _cache:
        while len(_cache) > 2:
            _cache.pop(next(iter(_cache)))
        u, v = np.meshgrid(np.arange(intrinsics.width, dtype=float), np.arange(intrinsics.height, dtype=float))
        at = (np.arange(RAYS) + 0.5) / RAYS - 0.5
        # Default stops after 5 steps, which leaves some hundredths of a pixel with strong distortion.
        criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 40, 1e-10)
        all_rays = []
        for du in at:
            for dv in at:
                pixels = np.column_stack([(u + du).ravel(), (v + dv).ravel()])[:, None]
                straight = cv2.undistortPointsIter(
                    pixels, intrinsics.matrix, intrinsics.distortion, None, None, criteria
                )[:, 0]
                all_rays.append(np.column_stack([straight, np.ones(len(straight))]))
        _cache[name] = all_rays
    return _cache[name]


__all__ = ["BoardPattern", "Checkerboard", "Pattern", "render"]
