"""What a haptic handle must offer, and how devices are found by name."""

from __future__ import annotations

import abc
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import metadata

from saras import ConfigError
from saras.console.arrays import Array

ENTRY_POINT_GROUP = "saras.console_devices"

#: Devices of this package: name: "module:factory". Plug-ins come from the entry point group.
BUILT_IN = {
    "script": "saras.console.devices.script:make",
    "recorded": "saras.console.devices.recorded:make",
    "manual": "saras.console.devices.manual:make",
    "openhaptics": "saras.console.devices.openhaptics:make",
}


@dataclass
class HandleReading:
    """What a device measured, before calibration."""

    joints: Array  #: (4,) Simball yaw, pitch, roll [rad], insertion [m]; raw encoder values
    clip: float  #: raw value of the clip's sensor, any unit; larger is more open
    clutch: bool  #: the clutch is pressed now
    work_J: float  #: cumulative force · encoder displacement since the device was opened [J], at the device's own rate


class HandleDevice(abc.ABC):
    """One handle. ``read`` and ``apply`` are called from the control thread at 1 kHz and must not block."""

    #: A simulated hand does by itself what :meth:`cue` asks for.
    simulated = False
    #: Raw readings are not joints yet.
    needs_calibration = True

    @abc.abstractmethod
    def read(self, now_ns: int) -> HandleReading | None:
        """Newest reading at the monotonic time now; None when there is no valid one (unplugged, no power)."""

    @abc.abstractmethod
    def apply(self, wrench: Array, now_ns: int) -> None:
        """Exerts a (6,) wrench on the hand, in the touch frame at the handle [N, N m].

        The device must fall back to zero by itself when it is not refreshed within the guard's ``hold_s``: that time is
        what the guard's budget covers.
        """

    def cue(self, instruction: str) -> None:  # noqa: B027 - optional
        """Calibration asks the operator for 'home', 'roll', 'open', 'closed', or 'run' when done."""

    def pump(self, status: Mapping[str, object]) -> bool:
        """Called from the main thread at about 20 Hz, for devices with a window. False: the user closed it."""
        return True

    @abc.abstractmethod
    def close(self) -> None:
        """Force to zero, resources released. May be called twice."""


Factory = Callable[[str, Mapping[str, str]], HandleDevice]


def device_names() -> list[str]:
    """Names that :func:`open_device` knows now, plug-ins included."""
    return sorted({*BUILT_IN, *(point.name for point in metadata.entry_points().select(group=ENTRY_POINT_GROUP))})


def open_device(name: str, side: str, options: Mapping[str, str]) -> HandleDevice:
    """Opens a device by name for side 'left' or 'right'. Raises ConfigError for an unknown name or bad options, and
    ModuleNotFoundError when the device's library is not installed.
    """
    return find_factory(name)(side, options)


def find_factory(name: str) -> Factory:
    """The factory of a device by name; ConfigError listing all names when there is none."""
    for point in metadata.entry_points().select(group=ENTRY_POINT_GROUP):
        if point.name == name:
            factory: Factory = point.load()
            return factory
    if name not in BUILT_IN:
        raise ConfigError(f"device = {name!r}: must be one of {', '.join(device_names())}")
    module, _, attribute = BUILT_IN[name].partition(":")
    built_in: Factory = getattr(importlib.import_module(module), attribute)
    return built_in
