"""What the endoscope's images say: markers of the board, and where the board is. Needs OpenCV (4.6 or newer)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import CalibrationError
from saras.calibration.board import Board

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

#: Variance of the Laplacian under which a view counts as blurred, for images of 8 bits.
LEAST_SHARPNESS = 30.0
#: Root mean square reprojection of the corners above which a view is refused [px].
MAX_RMS_PX = 2.0


@dataclass(frozen=True)
class Intrinsics:
    """Pinhole with OpenCV's plumb_bob distortion."""

    matrix: Array
    """(3, 3) K [px]"""
    distortion: Array
    """(5,) k1 k2 p1 p2 k3"""
    width: int
    height: int


@dataclass(frozen=True)
class BoardView:
    """The board in one image."""

    camera_T_board: Array
    """(4, 4), camera: optical frame, z forward"""
    marker_ids: tuple[int, ...]
    corners_px: Array
    """(n, 4, 2)"""
    rms_px: float


def sharpness(image: Image) -> float:
    """Variance of the Laplacian."""
    import cv2

    return float(cv2.Laplacian(image, cv2.CV_64F).var())


def find_markers(image: Image) -> dict[int, Array]:
    """(4, 2) corners [px] of each marker of the board's dictionary, refined to a fraction of a pixel."""
    import cv2

    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    make = getattr(cv2.aruco, "DetectorParameters_create", None) or cv2.aruco.DetectorParameters
    parameters: Any = make()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    if hasattr(cv2.aruco, "ArucoDetector"):
        corners, ids, _ = cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(image)
    else:
        corners, ids, _ = cv2.aruco.detectMarkers(image, dictionary, parameters=parameters)
    if ids is None:
        return {}
    return {int(i): np.asarray(c, dtype=float).reshape(4, 2) for i, c in zip(np.ravel(ids), corners)}


def locate_board(image: Image, board: Board, intrinsics: Intrinsics, least_markers: int = 3) -> BoardView:
    """Where the board is before the camera. image: (height, width) grey. Raises CalibrationError with the reason:
    size, blur, markers missing, another board, corners that do not fit, board seen from behind.
    """
    import cv2

    if image.shape != (intrinsics.height, intrinsics.width):
        raise CalibrationError(
            f"image = {image.shape[1]}x{image.shape[0]}: must be {intrinsics.width}x{intrinsics.height}, as calibrated"
        )
    blur = sharpness(image)
    if blur < LEAST_SHARPNESS:
        raise CalibrationError(f"blurred view: sharpness = {blur:.0f}: must be >= {LEAST_SHARPNESS:.0f}; hold still")
    found = find_markers(image)
    markers = board.markers
    ids = tuple(i for i in markers if i in found)
    if len(ids) < least_markers:
        others = sorted(set(found) - set(markers))
        if others and not ids:
            raise CalibrationError(f"markers {others}: must be of {sorted(markers)}: another board?")
        missing = sorted(set(markers) - set(ids))
        raise CalibrationError(f"markers seen = {len(ids)}: must be >= {least_markers}; missing: {missing}")
    points = np.concatenate([markers[i] for i in ids])
    pixels = np.concatenate([found[i] for i in ids])
    solved, rotation, translation = cv2.solvePnP(
        points, pixels, intrinsics.matrix, intrinsics.distortion, flags=cv2.SOLVEPNP_IPPE
    )
    if not solved:
        raise CalibrationError("the markers' corners fit no pose of the board")
    rotation, translation = cv2.solvePnPRefineLM(
        points, pixels, intrinsics.matrix, intrinsics.distortion, rotation, translation
    )
    projected, _ = cv2.projectPoints(points, rotation, translation, intrinsics.matrix, intrinsics.distortion)
    rms_px = float(np.sqrt(((projected.reshape(-1, 2) - pixels) ** 2).sum(axis=1).mean()))
    if not rms_px <= MAX_RMS_PX:
        raise CalibrationError(
            f"corners are {rms_px:.1f} px rms from where the board would show them: must be <= {MAX_RMS_PX:g} px; "
            "another board, print scale, or camera calibration?"
        )
    pose = np.eye(4)
    pose[:3, :3], _ = cv2.Rodrigues(rotation)
    pose[:3, 3] = translation.ravel()
    if (pose[:3, :3].T @ pose[:3, 3])[2] >= 0.0:  # the camera, seen from the board, must be on its printed side
        raise CalibrationError("board seen from behind: mirrored image?")
    return BoardView(pose, ids, np.array([found[i] for i in ids]), rms_px)


__all__ = ["LEAST_SHARPNESS", "MAX_RMS_PX", "BoardView", "Intrinsics", "find_markers", "locate_board", "sharpness"]
