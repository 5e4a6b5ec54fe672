"""Whether a calibration belongs to a session before it goes into its data set."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError, Error
from saras.recording import Session
from saras.recording.series import rotation_matrices

TOLERANCE_M = 1e-3
TOLERANCE_RAD = 2e-3


def check_calibration(path: str | Path, session: Session) -> list[str]:
    """Notes for the card.

    A file that is no calibration of base frames is copied unread (camera_info, hand-eye) and noted. Raises
    saras.Error for one that is damaged, younger than the session, or says other frames than the session's /tf_static.
    """
    from saras.calibration.calibration_file import Calibration

    text = Path(path).read_text(encoding="utf-8", errors="replace")
    if "gripper_T_camera" not in text or "frames" not in text:
        return [f"{Path(path).name}: no calibration of base frames: copied as it is"]
    try:
        found = Calibration.load(path, now=session.start)
    except ConfigError as error:
        raise Error(f"{error} (session {session.path}, {session.start.isoformat(timespec='seconds')})") from error
    said = _recorded(session)
    notes = []
    for name, frame in found.frames.items():
        recorded = said.get((frame.parent, name))
        if recorded is None:
            notes.append(f"{Path(path).name}: {frame.parent} → {name} is not in the recording: not compared")
            continue
        difference = np.linalg.inv(recorded) @ frame.parent_T_frame
        off_m = float(np.linalg.norm(difference[:3, 3]))
        off_rad = math.acos(float(np.clip((np.trace(difference[:3, :3]) - 1.0) / 2.0, -1.0, 1.0)))
        if off_m > TOLERANCE_M or off_rad > TOLERANCE_RAD:
            raise Error(
                f"{path}: frames/{name}: differs from {session.path} by {off_m * 1e3:.1f} mm, "
                f"{math.degrees(off_rad):.2f}°: must be <= {TOLERANCE_M * 1e3:g} mm, "
                f"{math.degrees(TOLERANCE_RAD):.2f}°: the calibration of another session"
            )
    return notes


def _recorded(session: Session) -> dict[tuple[str, str], NDArray[np.float64]]:
    """(parent, child): 4×4, the last that was said."""
    topic = session.topic("/tf_static")
    result = {}
    for message in topic["transforms"] if topic is not None else ():
        for transform in message:
            q, p = transform.transform.rotation, transform.transform.translation
            matrix = np.eye(4)
            matrix[:3, :3] = rotation_matrices(*(np.array([getattr(q, axis)]) for axis in "xyzw"))[0]
            matrix[:3, 3] = p.x, p.y, p.z
            result[transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/")] = matrix
    return result
