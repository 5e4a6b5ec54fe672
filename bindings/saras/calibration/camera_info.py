"""What a camera_info says of an eye, its YAML as ROS has it, and rectification. Needs OpenCV and PyYAML."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.calibration.camera import Intrinsics

Array = npt.NDArray[np.float64]

MODEL = "plumb_bob"
SHAPES = {
    "camera_matrix": (3, 3),
    "distortion_coefficients": (1, 5),
    "rectification_matrix": (3, 3),
    "projection_matrix": (3, 4),
}
MAX_SIDE_PX = 16384


@dataclass(frozen=True)
class Eye:
    """One eye of a stereo camera. Its optical frame (z forward, x right, y down) is that of the raw image."""

    intrinsics: Intrinsics
    R: Array
    """(3, 3) rectified_R_raw"""
    P: Array
    """(3, 4) of rectified images, for points in the rectified left frame; the right one's holds the baseline"""
    name: str = "endoscope"

    @property
    def size(self) -> tuple[int, int]:
        """Width and height [px]."""
        return self.intrinsics.width, self.intrinsics.height

    @property
    def baseline_m(self) -> float:
        """Distance to the left eye along its rectified x [m]; 0 for the left one."""
        return float(-self.P[0, 3] / self.P[0, 0])

    def document(self) -> dict[str, Any]:
        """What the YAML holds."""
        return {
            "image_width": self.intrinsics.width,
            "image_height": self.intrinsics.height,
            "camera_name": self.name,
            "camera_matrix": _matrix(self.intrinsics.matrix),
            "distortion_model": MODEL,
            "distortion_coefficients": _matrix(self.intrinsics.distortion[None]),
            "rectification_matrix": _matrix(self.R),
            "projection_matrix": _matrix(self.P),
        }

    def save(self, path: str | Path) -> None:
        """Writes the YAML as camera_info_manager and camera_calibration_parsers read it."""
        import yaml

        text = yaml.safe_dump(self.document(), sort_keys=False, default_flow_style=None)
        Path(path).write_text(text, encoding="utf-8")

    @staticmethod
    def load(path: str | Path) -> Eye:
        """Reads the YAML. Raises ConfigError naming file, entry, value and bound; OSError."""
        import yaml

        try:
            document = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: {error}") from None
        if not isinstance(document, dict):
            raise ConfigError(f"{path}: no camera_info in it")
        model = document.get("distortion_model")
        if model != MODEL:
            raise ConfigError(f"{path}: distortion_model = {model!r}: must be {MODEL!r}")
        width, height = (_side(document, key, path) for key in ("image_width", "image_height"))
        k, d, r, p = (_numbers(document, key, shape, path) for key, shape in SHAPES.items())
        if not (k[0, 0] > 0.0 and k[1, 1] > 0.0 and p[0, 0] > 0.0):
            raise ConfigError(f"{path}: camera_matrix, projection_matrix: focal lengths must be > 0: not calibrated")
        off = float(np.abs(r @ r.T - np.eye(3)).max())
        if not off < 1e-6 or np.linalg.det(r) < 0.0:
            raise ConfigError(f"{path}: rectification_matrix: must be a rotation (off by {off:.1e})")
        return Eye(Intrinsics(k, d.ravel(), width, height), r, p, str(document.get("camera_name", "endoscope")))


def rectified(left: Intrinsics, right: Intrinsics, right_T_left: Array, name: str = "endoscope") -> tuple[Eye, Eye]:
    """Both eyes with rotations and projections of cv2.stereoRectify (alpha 0: no pixel without image)."""
    import cv2

    r1, r2, p1, p2, _, _, _ = cv2.stereoRectify(
        left.matrix,
        left.distortion,
        right.matrix,
        right.distortion,
        (left.width, left.height),
        right_T_left[:3, :3],
        right_T_left[:3, 3:4],
        alpha=0,
    )
    return Eye(left, r1, p1, f"{name}_left"), Eye(right, r2, p2, f"{name}_right")


def right_T_left(left: Eye, right: Eye) -> Array:
    """(4, 4) of the raw optical frames, from what both rectifications say."""
    pose = np.eye(4)
    pose[:3, :3] = right.R.T @ left.R
    pose[:3, 3] = right.R.T @ [-right.baseline_m, 0.0, 0.0]
    return pose


def _matrix(matrix: Array) -> dict[str, Any]:
    rows, columns = matrix.shape
    return {"rows": rows, "cols": columns, "data": [float(f"{value:.12g}") for value in matrix.ravel()]}


def _side(document: dict[str, Any], key: str, path: str | Path) -> int:
    value = document.get(key)
    if not isinstance(value, int) or isinstance(value, bool) or not 1 <= value <= MAX_SIDE_PX:
        raise ConfigError(f"{path}: {key} = {value!r}: must be a whole number in [1, {MAX_SIDE_PX}]")
    return value


def _numbers(document: dict[str, Any], key: str, shape: tuple[int, int], path: str | Path) -> Array:
    entry = document.get(key)
    try:
        values = np.array(entry["data"] if isinstance(entry, dict) else None, dtype=float)
    except (KeyError, TypeError, ValueError):
        values = np.array([np.nan])
    if values.size != shape[0] * shape[1] or not np.isfinite(values).all():
        raise ConfigError(f"{path}: {key}: must hold {shape[0]}x{shape[1]} finite numbers under data")
    return values.reshape(shape)


__all__ = ["Eye", "rectified", "right_T_left"]
