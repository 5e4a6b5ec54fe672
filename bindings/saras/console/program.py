"""The console at work: devices, calibrations, guards and link, stepped once a tick. No thread, no sleep, no clock."""

from __future__ import annotations

import logging
import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from saras import ConfigError
from saras.console.arrays import Array
from saras.console.calibration import CLIP_CLOSED_BELOW, CLIP_OPEN_ABOVE, HandleCalibration
from saras.console.device import HandleDevice, HandleReading
from saras.console.guard import GuardConfig, GuardedPort
from saras.console.link import TouchballLink
from saras.console.simball import HANDLE
from saras.net import ChannelState, SimballJoints, TouchballUp, TouchballUpSide

log = logging.getLogger("saras.console")

SIDES = ("left", "right")


@dataclass
class ProgramConfig:
    """Rates and guards of a console."""

    device_rate_hz: float = 1000.0
    send_rate_hz: float = 100.0
    guard: GuardConfig = field(default_factory=GuardConfig)

    def __post_init__(self) -> None:
        for name, lowest, highest in (("device_rate_hz", 50.0, 4000.0), ("send_rate_hz", 1.0, 1000.0)):
            if not lowest <= getattr(self, name) <= highest:
                raise ConfigError(f"{name} = {getattr(self, name)}: must be in [{lowest:g}, {highest:g}]")
        if self.send_rate_hz > self.device_rate_hz:
            raise ConfigError(f"send_rate_hz = {self.send_rate_hz}: must be <= device_rate_hz = {self.device_rate_hz}")


class Hand:
    """One handle: device, calibration, guard, and what was last read."""

    def __init__(
        self, device: HandleDevice, calibration: HandleCalibration | None, config: GuardConfig, session: int
    ) -> None:
        self.device = device
        self.calibrated = calibration is not None or not device.needs_calibration
        self.calibration = calibration or HandleCalibration()
        self._joint_zero = np.array(self.calibration.joint_zero)
        self.guard = GuardedPort(config, session)
        self.joints = np.zeros(4)
        self.pose: Array | None = None
        self.grip = 1.0
        self.clip_closed = False
        self.clutch = False
        self.work_J = 0.0

    def tick(self, dt: float, now_ns: int, link_fresh: bool) -> None:
        """Read, guard, apply."""
        self._take(self.device.read(now_ns))
        wrench = self.guard.tick(self.pose, self.work_J, dt, link_fresh)
        self.device.apply(wrench, now_ns)

    def _take(self, reading: HandleReading | None) -> None:
        if reading is None or not math.isfinite(reading.joints.sum() + reading.work_J + reading.clip):
            self.pose, self.clutch = None, False
            return
        self.work_J = reading.work_J
        self.joints = reading.joints - self._joint_zero
        self.pose = HANDLE.forward(self.joints)
        self.grip = self.calibration.grip(reading.clip)
        self.clip_closed = self.grip < (CLIP_OPEN_ABOVE if self.clip_closed else CLIP_CLOSED_BELOW)
        self.clutch = reading.clutch

    def up(self) -> TouchballUpSide:
        """Its part of the next datagram."""
        ledger, guard = self.guard.ledger(), self.guard.snapshot()
        if self.pose is None:
            return TouchballUpSide(ledger=ledger, guard=guard, calibrated=self.calibrated)
        yaw, pitch, roll, insertion = self.joints.tolist()
        return TouchballUpSide(
            present=True,
            calibrated=self.calibrated,
            clutch=self.clutch,
            clip=self.clip_closed,
            simball_T_handle=self.pose,
            joints=SimballJoints(yaw_rad=yaw, pitch_rad=pitch, roll_rad=roll, insertion_m=insertion),
            grip=self.grip,
            ledger=ledger,
            guard=guard,
        )


class Program:
    """All handles and the link. Call ``tick`` at the device rate."""

    def __init__(
        self,
        config: ProgramConfig,
        link: TouchballLink,
        devices: Mapping[str, HandleDevice],
        calibrations: Mapping[str, HandleCalibration],
        session: int,
    ) -> None:
        self.config = config
        self.link = link
        self.hands = {
            side: Hand(device, calibrations.get(side), config.guard, session) for side, device in devices.items()
        }
        self.ticks = 0
        self._dt_max_s = config.guard.law.tank.dt_max_s
        self.overruns = 0
        self._send_period_ns = round(1e9 / config.send_rate_hz)
        self._next_send_ns = 0
        self._last_ns: int | None = None
        self._next_overrun_log_ns = 0
        self._was_fresh = False
        self._shown: dict[str, ChannelState | None] = dict.fromkeys(self.hands)

    def tick(self, now_ns: int) -> None:
        """One device tick at the monotonic time now_ns."""
        dt = self._time_step(now_ns)
        down = self.link.poll(now_ns)
        if down is not None:
            for side, hand in self.hands.items():
                hand.guard.receive(getattr(down, side), down.session)
        fresh = self.link.is_fresh(now_ns)
        for hand in self.hands.values():
            hand.tick(dt, now_ns, fresh)
        if now_ns >= self._next_send_ns:
            late = now_ns - self._next_send_ns > self._send_period_ns
            self._next_send_ns = (now_ns if late else self._next_send_ns) + self._send_period_ns
            self.link.send(TouchballUp(**{side: hand.up() for side, hand in self.hands.items()}), now_ns)
        self._note_changes(fresh)
        self.ticks += 1

    def _time_step(self, now_ns: int) -> float:
        if self._last_ns is None:
            self._last_ns = now_ns - round(1e9 / self.config.device_rate_hz)
        dt = (now_ns - self._last_ns) * 1e-9
        self._last_ns = now_ns
        if dt > self._dt_max_s:
            # The guard bills what happened meanwhile and answers with no force; nothing is caught up.
            self.overruns += 1
            if now_ns >= self._next_overrun_log_ns:
                self._next_overrun_log_ns = now_ns + 1_000_000_000
                log.warning("the control loop stood still for %.0f ms (%d times so far)", dt * 1e3, self.overruns)
        return dt

    def _note_changes(self, fresh: bool) -> None:
        if fresh != self._was_fresh:
            self._was_fresh = fresh
            log.log(logging.INFO if fresh else logging.WARNING, "platform %s", "heard" if fresh else "lost: no force")
        for side, hand in self.hands.items():
            if self._shown[side] != hand.guard.state:
                self._shown[side] = hand.guard.state
                log.info("%s: %s (engagement %s)", side, hand.guard.state.name, hand.guard.engagement)

    def close(self) -> None:
        """Forces to zero, port released."""
        for hand in self.hands.values():
            hand.device.close()
        self.link.close()
