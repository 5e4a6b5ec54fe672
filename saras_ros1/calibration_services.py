"""Answers of the calibration nodes' services: an error of ours is a refusal with its text, never an exception."""

from __future__ import annotations

from typing import Callable

from std_srvs.srv import TriggerResponse

from saras import CalibrationError, ConfigError, Error
from saras.calibration.calibration_file import Calibration


def answer(act: Callable[[], str]) -> TriggerResponse:
    """What act() says, or why it was refused."""
    try:
        return TriggerResponse(True, act())
    except Error as error:
        return TriggerResponse(False, str(error))


def save(computed: Calibration | None, path: str, force: bool) -> None:
    """Raises CalibrationError, ConfigError or OSError with the reason."""
    if computed is None:
        raise CalibrationError("nothing computed since the last measurement: call compute first")
    if not path.startswith("/"):
        raise ConfigError(f"path = {path!r}: must be absolute")
    computed.save(path, force)
