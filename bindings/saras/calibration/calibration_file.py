"""The file of a calibration: world → base frames, how well they are known, and what they hold for.

A file is refused when its version is another, its board is another, its numbers were edited, it is older than allowed,
or it lacks a frame that is needed. Nothing is written over without being asked to.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import CalibrationError, ConfigError

Array = npt.NDArray[np.float64]

FORMAT = "saras-calibration"
VERSION = 1
#: A clock that is behind the one that calibrated, by less than this, is no reason to refuse.
CLOCK_SLACK_S = 300.0


@dataclass(frozen=True)
class BaseFrame:
    """One base frame and how it was found."""

    parent: str
    parent_T_frame: Array
    """(4, 4)"""
    std_m: float
    """Standard deviation of the origin, along its worst axis [m]."""
    std_rad: float
    """Standard deviation of the rotation, about its worst axis [rad]."""
    rms_m: float
    """Residual of the measurements [m]."""
    measurements: int
    method: str
    """dots or markers"""
    joints_rad: dict[str, float] = field(default_factory=dict)
    """Positions of the positioning arm's or set-up joints [rad] then; when they move, the frame is unknown."""


@dataclass(frozen=True)
class Calibration:
    """World → base frames of one session."""

    board_hash: str
    stamp: datetime
    frames: dict[str, BaseFrame]
    gripper_T_camera: dict[str, Array] = field(default_factory=dict)
    """(4, 4) by arm, from hand-eye calibration."""

    def document(self) -> dict[str, Any]:
        """What the YAML holds."""
        body: dict[str, Any] = {
            "format": FORMAT,
            "version": VERSION,
            "stamp": self.stamp.astimezone(timezone.utc).isoformat(timespec="seconds"),
            "board": self.board_hash,
            "frames": {
                name: {
                    "parent": frame.parent,
                    "matrix": _rows(frame.parent_T_frame),
                    "std_m": _round(frame.std_m),
                    "std_rad": _round(frame.std_rad),
                    "rms_m": _round(frame.rms_m),
                    "measurements": frame.measurements,
                    "method": frame.method,
                    "joints_rad": {joint: float(value) for joint, value in frame.joints_rad.items()},
                }
                for name, frame in self.frames.items()
            },
            "gripper_T_camera": {arm: _rows(matrix) for arm, matrix in self.gripper_T_camera.items()},
        }
        body["checksum"] = _checksum(body)
        return body

    def save(self, path: str | Path, force: bool = False) -> None:
        """Writes the YAML. Raises CalibrationError when the file exists and force is not set."""
        import yaml

        path = Path(path)
        if path.exists() and not force:
            raise CalibrationError(f"{path}: exists; ask for it (force) to write over it")
        text = "# World -> base frames. Made by saras; do not edit: make it anew when anything has moved.\n"
        text += yaml.safe_dump(self.document(), sort_keys=False, default_flow_style=None, width=110)
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(path.name + ".part")
        part.write_text(text, encoding="utf-8")
        part.replace(path)  # a reader sees the old file or the new one

    @staticmethod
    def load(
        path: str | Path,
        *,
        board_hash: str | None = None,
        frames: Iterable[str] = (),
        max_age_s: float = math.inf,
        now: datetime | None = None,
    ) -> Calibration:
        """Reads and checks the YAML. Raises ConfigError naming what is wrong with it; OSError.

        board_hash: of the board that is in use; frames: that must be there; now: for the age, default the clock.
        """
        import yaml

        try:
            document = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: {error}") from None
        calibration = _parse(document, str(path))
        if board_hash is not None and calibration.board_hash != board_hash:
            raise ConfigError(f"{path}: board = {calibration.board_hash}: must be {board_hash}, the one in use")
        missing = [name for name in frames if name not in calibration.frames]
        if missing:
            raise ConfigError(f"{path}: frames/{missing[0]}: missing")
        age_s = ((now or datetime.now(timezone.utc)) - calibration.stamp).total_seconds()
        if age_s > max_age_s:
            raise ConfigError(f"{path}: age = {age_s / 3600.0:.1f} h: must be <= {max_age_s / 3600.0:.1f} h")
        if age_s < -CLOCK_SLACK_S:
            raise ConfigError(f"{path}: stamp = {calibration.stamp.isoformat()}: lies in the future")
        return calibration


def _parse(document: Any, where: str) -> Calibration:
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise ConfigError(f"{where}: format: must be {FORMAT!r}")
    if document.get("version") != VERSION:
        raise ConfigError(f"{where}: version = {document.get('version')!r}: must be {VERSION}; calibrate anew")
    if document.get("checksum") != _checksum({k: v for k, v in document.items() if k != "checksum"}):
        raise ConfigError(f"{where}: checksum: does not fit the numbers; was the file edited or cut?")
    try:
        stamp = datetime.fromisoformat(str(document["stamp"]))
        if stamp.tzinfo is None:
            raise ValueError(f"stamp = {document['stamp']!r}: must name its time zone")
        frames = {str(name): _frame(entry, name) for name, entry in document["frames"].items()}
        cameras = {
            str(arm): _matrix(rows, f"gripper_T_camera/{arm}") for arm, rows in document["gripper_T_camera"].items()
        }
        return Calibration(str(document["board"]), stamp, frames, cameras)
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        text = f"{error.args[0]}: missing" if isinstance(error, KeyError) else str(error)
        raise ConfigError(f"{where}: {text}") from None


def _frame(entry: Any, name: str) -> BaseFrame:
    numbers = {key: float(entry[key]) for key in ("std_m", "std_rad", "rms_m")}
    for key, value in numbers.items():
        if not (math.isfinite(value) and value >= 0.0):
            raise ValueError(f"frames/{name}/{key} = {value}: must be finite and >= 0")
    joints = {str(joint): float(value) for joint, value in entry["joints_rad"].items()}
    if not np.isfinite(list(joints.values())).all():
        raise ValueError(f"frames/{name}/joints_rad: must be finite")
    matrix = _matrix(entry["matrix"], f"frames/{name}/matrix")
    return BaseFrame(
        parent=str(entry["parent"]),
        parent_T_frame=matrix,
        measurements=int(entry["measurements"]),
        method=str(entry["method"]),
        joints_rad=joints,
        **numbers,
    )


def _matrix(rows: Any, where: str) -> Array:
    matrix = np.array(rows, dtype=float)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
        raise ValueError(f"{where}: must be 4 rows of 4 finite numbers")
    rotation = matrix[:3, :3]
    if not (
        np.allclose(rotation @ rotation.T, np.eye(3), atol=1e-6)
        and np.linalg.det(rotation) > 0.0
        and (matrix[3] == [0, 0, 0, 1]).all()
    ):
        raise ValueError(f"{where}: must be a rigid transform")
    return matrix


def _rows(matrix: Array) -> list[list[float]]:
    return [[float(f"{value:.10g}") + 0.0 for value in row] for row in matrix]


def _round(value: float) -> float:
    return float(f"{value:.6g}")


def _checksum(body: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(body, sort_keys=True, default=str).encode()).hexdigest()[:16]


__all__ = ["FORMAT", "VERSION", "BaseFrame", "Calibration"]
