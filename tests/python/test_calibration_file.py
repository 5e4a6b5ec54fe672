"""The calibration file comes back as written; what is old, edited, of another board or version is refused."""

from __future__ import annotations

from datetime import datetime, timedelta, timezone
from pathlib import Path

import numpy as np
import pytest

import saras
from saras import CalibrationError, ConfigError
from saras.calibration.board import Board
from saras.calibration.calibration_file import BaseFrame, Calibration

NOW = datetime(2026, 3, 1, 12, 0, tzinfo=timezone.utc)


def calibration() -> Calibration:
    pose = saras.add_delta(np.eye(4), np.array([0.1, -0.2, 0.3, 0.4, 0.5, -0.6]), 1.0)
    frame = BaseFrame("world", pose, 4e-4, 2e-3, 5e-4, 12, "dots", {"mesa_left/passive_1": 0.25})
    return Calibration(Board().hash, NOW, {"mesa_left/sbs_world": frame}, {"ECM": pose})


def test_it_comes_back(tmp_path: Path) -> None:
    path = tmp_path / "new" / "calibration.yaml"
    calibration().save(path)
    again = Calibration.load(path, board_hash=Board().hash, frames=["mesa_left/sbs_world"], max_age_s=60.0, now=NOW)
    np.testing.assert_allclose(
        again.frames["mesa_left/sbs_world"].parent_T_frame,
        calibration().frames["mesa_left/sbs_world"].parent_T_frame,
        atol=1e-9,
    )
    assert again.frames["mesa_left/sbs_world"].joints_rad == {"mesa_left/passive_1": 0.25}
    assert again.stamp == NOW and again.document() == calibration().document()


def test_nothing_is_written_over_without_being_asked(tmp_path: Path) -> None:
    path = tmp_path / "calibration.yaml"
    calibration().save(path)
    with pytest.raises(CalibrationError, match="exists"):
        calibration().save(path)
    calibration().save(path, force=True)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("version: 1", "version: 0", "version = 0"),
        ("format: saras-calibration", "format: other", "format"),
        ("std_m: 0.0004", "std_m: 0.0001", "checksum"),
        ("parent: world", "parent: wrold", "checksum"),
    ],
)
def test_what_was_edited_is_refused(tmp_path: Path, old: str, new: str, why: str) -> None:
    path = tmp_path / "calibration.yaml"
    calibration().save(path)
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(ConfigError, match=why):
        Calibration.load(path)


def test_old_cut_and_foreign_files_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "calibration.yaml"
    calibration().save(path)
    with pytest.raises(ConfigError, match=r"age = 25.0 h: must be <= 24.0 h"):
        Calibration.load(path, max_age_s=24 * 3600.0, now=NOW + timedelta(hours=25))
    with pytest.raises(ConfigError, match="future"):
        Calibration.load(path, now=NOW - timedelta(hours=1))
    with pytest.raises(ConfigError, match="board"):
        Calibration.load(path, board_hash="0123456789abcdef", now=NOW)
    with pytest.raises(ConfigError, match="frames/PSM1: missing"):
        Calibration.load(path, frames=["PSM1"], now=NOW)
    whole = path.read_text()
    for part in (0.1, 0.5, 0.9):
        path.write_text(whole[: int(part * len(whole))])
        with pytest.raises(ConfigError):
            Calibration.load(path, now=NOW)
    path.write_text("frames: {world: {}}\n")
    with pytest.raises(ConfigError, match="format"):
        Calibration.load(path)
