"""Device ``openhaptics``: a Touch by 3D Systems through the PyPI package pyOpenHaptics (ctypes over libHD).

Needs the OpenHaptics drivers and ``pip install 'saras[haptics]'``. The Touch's gimbal holds the Simball's shaft, so the
shaft's direction and insertion follow from where the gimbal is; the third gimbal angle is the roll. Button 1 is the
clip, button 2 the clutch.

The HD library knows one current device at a time, and pyOpenHaptics has one scheduler: both handles are served by one
servo callback at 1 kHz, which selects each device in turn. Force falls to zero by itself in that callback when the
console does not refresh it.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from saras import ConfigError
from saras.console import options as option
from saras.console.arrays import Array
from saras.console.device import HandleDevice, HandleReading
from saras.console.simball import HANDLE, SIMBALL_T_HOME, TOUCH_R_SIMBALL

WATCHDOG_NS = 2_000_000
STALE_NS = 20_000_000  #: no servo callback for so long: the device is gone
DEFAULT_NAMES = {"left": "Left Device", "right": "Right Device"}  #: as given in the vendor's set-up tool

#: HD's own frame (x right, y up, z towards the user, mm) in touch_base (x towards the operator, z up, m).
TOUCH_R_HD = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])


@dataclass
class _Servo:
    """What the servo callback and the control thread share about one device."""

    handle: int
    force_hd: tuple[float, float, float] = (0.0, 0.0, 0.0)
    refreshed_ns: int = 0
    read_ns: int = 0
    position_hd: tuple[float, float, float] = (0.0, 0.0, 0.0)  #: [m]
    roll: float = 0.0
    buttons: int = 0
    work_J: float = 0.0
    applied: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lock: threading.Lock = field(default_factory=threading.Lock)


class Scheduler:
    """The one servo loop of all opened devices."""

    _instance: Scheduler | None = None

    def __init__(self) -> None:
        try:
            from pyOpenHaptics import hd, hd_callback
        except OSError as error:  # the package loads libHD when it is imported
            raise ConfigError(f"device openhaptics: the OpenHaptics drivers are not installed ({error})") from None
        self.hd: Any = hd
        self._callback_module: Any = hd_callback
        self._servos: dict[str, _Servo] = {}
        self._callback: Any = None
        self.clock_ns: Callable[[], int] = time.monotonic_ns

    @classmethod
    def shared(cls) -> Scheduler:
        """Loads the library on first use."""
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance

    def open(self, side: str, name: str) -> _Servo:
        """Opens one device by its name in the vendor's set-up tool. Raises ConfigError when it does not answer."""
        if self._callback is not None:
            self.hd.stop_scheduler()  # a device may be added only while the scheduler stands
        handle = self.hd.init_device(name)
        if handle is None:  # pyOpenHaptics prints and swallows its DeviceInitException
            raise ConfigError(f"device openhaptics: {side}: no device named {name!r}; is it plugged in and set up?")
        self.hd.enable_force()
        servo = self._servos[side] = _Servo(int(handle))
        self.hd.start_scheduler()
        if self._callback is None:
            self._callback = self._callback_module.hd_callback(self._serve)
            self._callback_module.hdAsyncSheduler(self._callback)
        return servo

    def close(self, side: str) -> None:
        """Force to zero, then the device is released; the scheduler stops with the last one."""
        servo = self._servos.pop(side, None)
        if servo is None:
            return
        self.hd.stop_scheduler()
        self.hd.close_device(servo.handle)
        if self._servos:
            self.hd.start_scheduler()
        else:
            Scheduler._instance = None

    def _serve(self) -> None:
        """One servo tick, inside the frame that the wrapper opened on the current device: others get their own."""
        hd = self.hd
        now_ns = self.clock_ns()
        current = hd.get_current_device()
        for servo in tuple(self._servos.values()):
            other = servo.handle != current
            if other:
                hd.end_frame(hd.get_current_device())
                hd._lib_hd.hdMakeCurrentDevice(servo.handle)
                hd.begin_frame(servo.handle)
            self._serve_one(servo, now_ns)
            current = servo.handle

    def _serve_one(self, servo: _Servo, now_ns: int) -> None:
        hd = self.hd
        matrix = hd.get_transform()  # 4x4, column by column: the translation is the last row
        position = (matrix[3][0] * 1e-3, matrix[3][1] * 1e-3, matrix[3][2] * 1e-3)
        with servo.lock:
            if servo.read_ns:
                servo.work_J += sum(f * (b - a) for f, a, b in zip(servo.applied, servo.position_hd, position))
            servo.position_hd = position
            servo.roll = float(hd.get_gimbals()[2])
            servo.buttons = hd.get_buttons()
            servo.read_ns = now_ns
            servo.applied = servo.force_hd if now_ns - servo.refreshed_ns <= WATCHDOG_NS else (0.0, 0.0, 0.0)
        hd.set_force(list(servo.applied))


class OpenHapticsHandle(HandleDevice):
    """One Touch that carries a Simball."""

    def __init__(self, side: str, options: Mapping[str, str]) -> None:
        option.refuse_unknown(options, ("name", "seed"), "openhaptics")
        self._side = side
        self._scheduler = Scheduler.shared()
        self._servo = self._scheduler.open(side, options.get("name", DEFAULT_NAMES[side]))
        self._simball_R_hd = TOUCH_R_SIMBALL.T @ TOUCH_R_HD

    def read(self, now_ns: int) -> HandleReading | None:
        """Joints from the gimbal's place. None when the servo loop stands still or the gimbal is below the pivot."""
        with self._servo.lock:
            read_ns, position, roll = self._servo.read_ns, self._servo.position_hd, self._servo.roll
            buttons, work = self._servo.buttons, self._servo.work_J
        if now_ns - read_ns > STALE_NS or not math.isfinite(sum(position)):
            return None
        # HD's origin is the middle of the Touch's workspace: it stands at home.
        joints = HANDLE.inverse_position(SIMBALL_T_HOME[:3, 3] + self._simball_R_hd @ position, roll)
        if joints is None:
            return None
        return HandleReading(joints, 0.0 if buttons & 1 else 1.0, bool(buttons & 2), work)

    def apply(self, wrench: Array, now_ns: int) -> None:
        """Hands the force to the servo loop."""
        x, y, z = (TOUCH_R_HD.T @ wrench[:3]).tolist()
        with self._servo.lock:
            self._servo.force_hd, self._servo.refreshed_ns = (x, y, z), now_ns

    def close(self) -> None:
        """Force to zero and the device released."""
        self._scheduler.close(self._side)


def make(side: str, options: Mapping[str, str]) -> OpenHapticsHandle:
    """Options: name, as given in the vendor's set-up tool (default 'Left Device', 'Right Device')."""
    return OpenHapticsHandle(side, options)
