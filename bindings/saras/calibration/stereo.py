"""Stereo camera calibration without a window: checkerboard or ChArUco, pictures in, camera_info YAML and a report out.

Needs OpenCV (4.6 or newer). The numbers are OpenCV's (calibrateCamera, stereoCalibrate, stereoRectify); this
adds which views are believed, how well the result fits, and files that ROS reads.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import CalibrationError
from saras.calibration.camera import Intrinsics, sharpness
from saras.calibration.camera_info import Eye

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

LEAST_VIEWS = 6
#: Sharpness (variance of the Laplacian) of a view under this share of the median's is blurred.
BLURRED_SHARE = 0.2
#: A view whose error is beyond this many times the median is left out.
BAD_VIEW = 3.0
GRID = 8  # cells of the coverage, each way


@dataclass(frozen=True)
class Checkerboard:
    """columns x rows inner corners."""

    columns: int
    rows: int
    square_m: float

    @property
    def points(self) -> Array:
        """(n, 3) corners, row by row [m]."""
        x, y = np.meshgrid(np.arange(self.columns), np.arange(self.rows))
        return self.square_m * np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])

    def find(self, image: Image) -> dict[int, Array]:
        """Pixel of each corner by its index; empty: not all seen."""
        import cv2

        size = (self.columns, self.rows)
        found, corners = cv2.findChessboardCorners(
            image, size, flags=cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE
        )
        if not found:
            return {}
        grid = corners.reshape(self.rows, self.columns, 2)
        steps = np.concatenate([np.diff(grid, axis=0).reshape(-1, 2), np.diff(grid, axis=1).reshape(-1, 2)])
        window = int(np.clip(0.4 * np.linalg.norm(steps, axis=1).min(), 3, 11))  # never over the next corner
        criteria = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_MAX_ITER, 60, 1e-4)
        refined = cv2.cornerSubPix(image, corners, (window, window), (-1, -1), criteria).reshape(-1, 2)
        return dict(enumerate(np.asarray(refined, dtype=float)))


@dataclass(frozen=True)
class Charuco:
    """ChArUco: columns x rows squares, markers of DICT_4X4_50 in the white ones; part of it may be hidden."""

    columns: int
    rows: int
    square_m: float
    marker_m: float

    def board(self) -> Any:
        """OpenCV's board."""
        import cv2

        dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
        if hasattr(cv2.aruco, "CharucoBoard_create"):
            return cv2.aruco.CharucoBoard_create(self.columns, self.rows, self.square_m, self.marker_m, dictionary)
        return cv2.aruco.CharucoBoard((self.columns, self.rows), self.square_m, self.marker_m, dictionary)

    @property
    def points(self) -> Array:
        """(n, 3) inner corners [m], by OpenCV's index."""
        board = self.board()
        corners = board.chessboardCorners if hasattr(board, "chessboardCorners") else board.getChessboardCorners()
        return np.asarray(corners, dtype=float)

    def find(self, image: Image) -> dict[int, Array]:
        """Pixel of each corner by its index."""
        import cv2

        board = self.board()
        if hasattr(cv2.aruco, "CharucoDetector"):
            corners, ids, _, _ = cv2.aruco.CharucoDetector(board).detectBoard(image)
        else:
            markers, marker_ids, _ = cv2.aruco.detectMarkers(image, board.dictionary)
            if marker_ids is None:
                return {}
            _, corners, ids = cv2.aruco.interpolateCornersCharuco(markers, marker_ids, image, board)
        if ids is None:
            return {}
        return {int(i): c for i, c in zip(np.ravel(ids), np.asarray(corners, dtype=float).reshape(-1, 2))}


@dataclass(frozen=True)
class Stereo:
    """Both eyes. Rectified images have row-aligned epipolar lines."""

    left: Intrinsics
    right: Intrinsics
    right_T_left: Array
    """(4, 4)"""
    left_R: Array
    """(3, 3) rectification of the left eye, and of the right one below"""
    right_R: Array
    left_P: Array
    """(3, 4) projection of rectified images; the right one holds the baseline"""
    right_P: Array
    view_errors_px: Array
    """(views, 2) root mean square reprojection of each view, left and right"""
    epipolar_px: float
    """Root mean square difference of the rows of one corner in both rectified images"""
    view_epipolar_px: Array
    coverage: tuple[float, float]
    """Share of an 8 x 8 grid over each image that corners were seen in"""
    used: tuple[str, ...]
    refused: dict[str, str] = field(default_factory=dict)
    """Views that were not used, and why"""

    @property
    def baseline_m(self) -> float:
        """Distance of the eyes [m]."""
        return float(np.linalg.norm(self.right_T_left[:3, 3]))

    @property
    def worst(self) -> list[str]:
        """Names of the views, worst first."""
        order = np.argsort(-self.view_errors_px.max(axis=1))
        return [self.used[i] for i in order]

    def save(self, folder: str | Path, force: bool = False) -> tuple[Path, Path]:
        """Writes left.yaml and right.yaml as camera_info_manager and camera_calibration_parsers read them."""
        paths = Path(folder) / "left.yaml", Path(folder) / "right.yaml"
        for path in paths:
            if path.exists() and not force:
                raise CalibrationError(f"{path}: exists; ask for it (force) to write over it")
        Path(folder).mkdir(parents=True, exist_ok=True)
        eyes = (self.left, self.left_R, self.left_P), (self.right, self.right_R, self.right_P)
        for path, eye in zip(paths, eyes):
            Eye(*eye, f"endoscope_{path.stem}").save(path)
        return paths


def stereo(
    left: Sequence[Image],
    right: Sequence[Image],
    pattern: Checkerboard | Charuco,
    names: Iterable[str] | None = None,
) -> Stereo:
    """Calibrates a stereo camera from pairs of grey images. Raises CalibrationError: too few good views (each with its
    reason), sizes that differ, too little of the image covered.
    """
    import cv2

    if len(left) != len(right):
        raise CalibrationError(f"images: {len(left)} left, {len(right)} right: must be as many")
    labels = list(names) if names is not None else [f"view {i + 1}" for i in range(len(left))]
    refused: dict[str, str] = {}
    views = _views(left, right, pattern, labels, refused)
    height, width = left[0].shape if left else (0, 0)
    single = cv2.CALIB_FIX_K3  # an endoscope's optics do not show the sixth power before noise does
    while True:
        if len(views) < LEAST_VIEWS:
            why = "; ".join(f"{name}: {text}" for name, text in refused.items())
            raise CalibrationError(f"good views = {len(views)}: must be >= {LEAST_VIEWS}. {why}")
        points = [view[1].astype(np.float32) for view in views]
        pixels = [[v[2].astype(np.float32) for v in views], [v[3].astype(np.float32) for v in views]]
        eyes = [cv2.calibrateCamera(points, p, (width, height), None, None, flags=single) for p in pixels]
        criteria = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-9)
        _, k1, d1, k2, d2, rotation, translation, _, _ = cv2.stereoCalibrate(
            points, *pixels, eyes[0][1], eyes[0][2], eyes[1][1], eyes[1][2], (width, height),
            flags=cv2.CALIB_USE_INTRINSIC_GUESS | single, criteria=criteria,
        )  # fmt: skip
        errors = np.array([_reprojection(view, k1, d1, k2, d2, rotation, translation) for view in views])
        worst = int(np.argmax(errors.max(axis=1)))
        if errors[worst].max() <= max(BAD_VIEW * float(np.median(errors)), 0.3):
            break
        refused[views[worst][0]] = f"corners off by {errors[worst].max():.2f} px rms, median {np.median(errors):.2f}"
        views.pop(worst)
    r1, r2, p1, p2, _, _, _ = cv2.stereoRectify(k1, d1, k2, d2, (width, height), rotation, translation, alpha=0)
    rows = [
        cv2.undistortPoints(view[2][:, None], k1, d1, R=r1, P=p1)[:, 0, 1]
        - cv2.undistortPoints(view[3][:, None], k2, d2, R=r2, P=p2)[:, 0, 1]
        for view in views
    ]
    right_T_left = np.eye(4)
    right_T_left[:3, :3], right_T_left[:3, 3] = rotation, translation.ravel()
    return Stereo(
        left=Intrinsics(k1, d1.ravel()[:5], width, height),
        right=Intrinsics(k2, d2.ravel()[:5], width, height),
        right_T_left=right_T_left,
        left_R=r1,
        right_R=r2,
        left_P=p1,
        right_P=p2,
        view_errors_px=errors,
        epipolar_px=float(np.sqrt(np.mean(np.concatenate(rows) ** 2))),
        view_epipolar_px=np.array([np.sqrt(np.mean(row**2)) for row in rows]),
        coverage=(_coverage(pixels[0], width, height), _coverage(pixels[1], width, height)),
        used=tuple(view[0] for view in views),
        refused=refused,
    )


def _views(
    left: Sequence[Image],
    right: Sequence[Image],
    pattern: Checkerboard | Charuco,
    labels: list[str],
    refused: dict[str, str],
) -> list[tuple[str, Array, Array, Array]]:
    """(name, points on the pattern, left pixels, right pixels) of what both eyes see; the rest goes into refused."""
    sharp = [min(sharpness(a), sharpness(b)) for a, b in zip(left, right)]
    least = BLURRED_SHARE * float(np.median(sharp)) if sharp else 0.0
    points, views = pattern.points, []
    for name, a, b, s in zip(labels, left, right, sharp):
        if a.shape != left[0].shape or b.shape != left[0].shape:
            raise CalibrationError(f"{name}: sizes {a.shape}, {b.shape}: must be {left[0].shape} as in the first view")
        if s < least:
            refused[name] = f"blurred: sharpness = {s:.0f}: must be >= {least:.0f}"
            continue
        seen_left, seen_right = pattern.find(a), pattern.find(b)
        both = sorted(set(seen_left) & set(seen_right))
        if len(both) < 8:
            side = "left" if len(seen_left) < 8 else "right" if len(seen_right) < 8 else "one and the same"
            refused[name] = f"corners seen by both eyes = {len(both)}: must be >= 8 ({side} image)"
            continue
        pixels = [np.array([seen[i] for i in both]) for seen in (seen_left, seen_right)]
        views.append((name, points[both], pixels[0], pixels[1]))
    return views


def _reprojection(
    view: tuple[str, Array, Array, Array], k1: Array, d1: Array, k2: Array, d2: Array, rotation: Array, shift: Array
) -> tuple[float, float]:
    """Root mean square error of a view in both eyes, with its pose fitted to the left one."""
    import cv2

    _, points, left, right = view
    _, turn, place = cv2.solvePnP(points, left, k1, d1)
    in_left, _ = cv2.projectPoints(points, turn, place, k1, d1)
    both = rotation @ cv2.Rodrigues(turn)[0]
    in_right, _ = cv2.projectPoints(points, cv2.Rodrigues(both)[0], rotation @ place + shift, k2, d2)
    return (
        float(np.sqrt(((in_left.reshape(-1, 2) - left) ** 2).sum(axis=1).mean())),
        float(np.sqrt(((in_right.reshape(-1, 2) - right) ** 2).sum(axis=1).mean())),
    )


def _coverage(pixels: Sequence[npt.NDArray[np.float32]], width: int, height: int) -> float:
    cells = np.floor(GRID * np.concatenate(pixels) / [width, height]).astype(int)
    return len({tuple(cell) for cell in np.clip(cells, 0, GRID - 1)}) / GRID**2


__all__ = ["LEAST_VIEWS", "Charuco", "Checkerboard", "Stereo", "stereo"]
