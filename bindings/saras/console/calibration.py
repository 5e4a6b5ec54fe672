"""Calibration of a handle: where its Simball joints are zero and the range of its clip. Values, checks, file.

The measurement itself is guided by ``saras.console.calibrate``.
"""

from __future__ import annotations

import json
import math
import os
import sys
import tempfile
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from saras import ConfigError
from saras.console.arrays import Array
from saras.console.simball import HANDLE, HOME_JOINTS

VERSION = 1
LARGEST_ZERO = np.array([0.5, 0.5, math.pi, 0.05])  #: a zero further off means a wrong pose or a broken encoder
JOINT_NAMES = tuple(f"{name}_{unit}" for name, unit in zip(HANDLE.joint_names, ("rad", "rad", "rad", "m")))
LEAST_CLIP_RANGE = 0.05  #: in the sensor's own unit: below it noise would move the jaw
CLIP_CLOSED_BELOW, CLIP_OPEN_ABOVE = 0.15, 0.25  #: opening at which the clip counts as closed, and as open again


@dataclass(frozen=True)
class HandleCalibration:
    """What turns raw readings into joints and grip."""

    joint_zero: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)  #: raw joints at q = 0 [rad], [m]
    clip_closed: float = 0.0  #: raw clip value when squeezed
    clip_open: float = 1.0  #: raw clip value when let go

    def validate(self, name: str) -> None:
        """Raises ConfigError naming handle, field, value and bound."""
        if len(self.joint_zero) != 4:
            raise ConfigError(f"{name}.joint_zero: must be 4 numbers, has {len(self.joint_zero)}")
        for joint, value, bound in zip(JOINT_NAMES, self.joint_zero, LARGEST_ZERO):
            if not math.isfinite(value) or abs(value) > bound:
                raise ConfigError(f"{name}.joint_zero {joint} = {value}: must be finite and within ± {bound:.4g}")
        for field in ("clip_closed", "clip_open"):
            if not math.isfinite(getattr(self, field)):
                raise ConfigError(f"{name}.{field} = {getattr(self, field)}: must be finite")
        if self.clip_open < self.clip_closed:
            raise ConfigError(
                f"{name}: clip_open = {self.clip_open:.4g} is below clip_closed = {self.clip_closed:.4g}: swapped; "
                "squeeze the clip when asked to close it, let go when asked to open it"
            )
        if self.clip_open - self.clip_closed < LEAST_CLIP_RANGE:
            raise ConfigError(
                f"{name}: the clip's range {self.clip_open - self.clip_closed:.4g} is too small, must be at least "
                f"{LEAST_CLIP_RANGE}: squeeze and open it fully"
            )

    def grip(self, raw: float) -> float:
        """Opening of the clip, 0 closed to 1 open."""
        return min(1.0, max(0.0, (raw - self.clip_closed) / (self.clip_open - self.clip_closed)))


def zero_from_home(raw_at_home: Array) -> tuple[float, float, float, float]:
    """Joint zeros from the mean raw joints (4,) of a handle that stands at home."""
    yaw, pitch, roll, insertion = (float(value) for value in raw_at_home - HOME_JOINTS)
    return yaw, pitch, roll, insertion


def default_path() -> Path:
    """Where the calibration of this computer's handles is kept."""
    if sys.platform == "win32":
        base = Path(os.environ.get("APPDATA", Path.home() / "AppData" / "Roaming"))
    else:
        base = Path(os.environ.get("XDG_CONFIG_HOME", Path.home() / ".config"))
    return base / "saras" / "console_calibration.json"


def save(path: Path, handles: dict[str, HandleCalibration], taken: str) -> None:
    """Writes the file whole or not at all. Handles that are not given keep what the file says about them."""
    for name, calibration in handles.items():
        calibration.validate(name)
    kept = load(path) if path.exists() else {}
    content = {name: asdict(calibration) for name, calibration in {**kept, **handles}.items()}
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, encoding="utf-8") as file:
        json.dump({"version": VERSION, "taken": taken, "handles": content}, file, indent=2)
    Path(file.name).replace(path)


def load(path: Path) -> dict[str, HandleCalibration]:
    """Reads and checks. Raises ConfigError naming the file and what is wrong in it."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigError(f"calibration = {path}: {error.strerror}; make it with: saras console calibrate") from None
    except ValueError as error:
        raise ConfigError(f"calibration = {path}: not JSON ({error})") from None
    if not isinstance(content, dict) or content.get("version") != VERSION or "handles" not in content:
        raise ConfigError(f"calibration = {path}: not a calibration of version {VERSION}")
    handles = {}
    for name, fields in content["handles"].items():
        try:
            calibration = HandleCalibration(
                tuple(float(value) for value in fields["joint_zero"]),  # type: ignore[arg-type]
                float(fields["clip_closed"]),
                float(fields["clip_open"]),
            )
        except (KeyError, TypeError, ValueError) as error:
            raise ConfigError(f"calibration = {path}: handle {name}: {error!r}") from None
        calibration.validate(f"{path}: {name}")
        handles[name] = calibration
    return handles
