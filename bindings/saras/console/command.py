"""The console: reads two haptic handles, guards their ports and talks Touchball UDP to the platform.

  saras console                          two simulated hands, platform on this computer
  saras console --motion palpate --operator weak --duration 60
  saras console --device recorded --file motion.zip --member NAME
  saras console --device manual          mouse, keyboard or gamepad
  saras console calibrate --device openhaptics
  saras console --key saras.key --platform 192.168.5.1:48010 --listen 0.0.0.0:48011    over a network (saras keys make)

Stops on Ctrl-C or SIGTERM with forces at zero. Exit codes: 0 done, 1 the control loop failed, 2 refused input.
"""

from __future__ import annotations

import argparse
import logging
import signal
import time
from datetime import datetime, timezone
from pathlib import Path
from types import FrameType

from saras import ConfigError
from saras.console import calibration as calibrations
from saras.console.calibrate import calibrate
from saras.console.device import HandleDevice, device_names, find_factory
from saras.console.link import Address, TouchballLink, new_session
from saras.console.loop import PeriodicLoop
from saras.console.program import SIDES, Program, ProgramConfig
from saras.console.status import open_status
from saras.net.keys import load as load_keys

log = logging.getLogger("saras.console")

#: Arguments that are shorthands for device options, when the device knows them.
SHORTHANDS = ("motion", "operator", "seed", "file", "member")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """The arguments of ``saras console``."""
    parser.add_argument("action", nargs="?", choices=("run", "calibrate"), default="run", help="default: run")
    parser.add_argument("--platform", default="127.0.0.1:48010", metavar="HOST:PORT", help="where the platform listens")
    parser.add_argument("--listen", default="127.0.0.1:48011", metavar="HOST:PORT", help="where this console listens")
    parser.add_argument(
        "--key",
        type=Path,
        metavar="FILE",
        help="key file (saras keys make FILE) that authenticates the link; none: loopback only",
    )
    parser.add_argument("--sides", default="left,right", help="handles to open: left,right (default), left or right")
    parser.add_argument("--duration", type=float, metavar="S", help="stop after S seconds (default: run until stopped)")
    parser.add_argument("--send-rate-hz", type=float, default=100.0, help="datagrams a second (default 100)")
    parser.add_argument("--device-rate-hz", type=float, default=1000.0, help="port guard and device (default 1000)")
    parser.add_argument("--plain", action="store_true", help="status as lines, even in a terminal")
    parser.add_argument("--log", type=Path, metavar="FILE", help="append events to FILE, too")
    parser.add_argument(
        "--calibration", type=Path, metavar="FILE", help=f"of the handles (default {calibrations.default_path()})"
    )
    device = parser.add_argument_group("device")
    device.add_argument("--device", default="script", help=f"one of {', '.join(device_names())} (default script)")
    device.add_argument("--device-right", help="another device for the right handle")
    device.add_argument("--motion", help="script: rest, circle, reach, palpate, clip or mixed (default)")
    device.add_argument("--operator", help="simulated hands: firm, normal (default), weak or active")
    device.add_argument("--seed", help="simulated hands: another seed, another motion (default 1)")
    device.add_argument("--file", help="recorded: CSV of t,x,y,z,qx,qy,qz,qw, or a zip of such")
    device.add_argument(
        "--member", help="recorded: part of a name in the zip (default: left the first, right the second)"
    )
    device.add_argument(
        "--option", action="append", default=[], metavar="[SIDE.]KEY=VALUE", help="of the device; may be repeated"
    )


def run(arguments: argparse.Namespace) -> int:
    """Runs or calibrates; returns the exit code."""
    sides = _sides(arguments.sides)
    if arguments.duration is not None and not 0.0 < arguments.duration < float("inf"):
        raise ConfigError(f"duration = {arguments.duration}: must be finite and > 0")
    devices = {side: _open(arguments, side) for side in sides}
    try:
        if arguments.action == "calibrate":
            return _calibrate(arguments, devices)
        return _run(arguments, devices)
    finally:
        for device in devices.values():
            device.close()


def _sides(text: str) -> list[str]:
    sides = text.split(",")
    if not sides or any(side not in SIDES for side in sides) or len(set(sides)) != len(sides):
        raise ConfigError(f"sides = {text!r}: must be left,right or left or right")
    return sides


def device_options(arguments: argparse.Namespace, side: str) -> dict[str, str]:
    """Options for one side: shorthands, then --option KEY=VALUE, then --option SIDE.KEY=VALUE."""
    options = {name: getattr(arguments, name) for name in SHORTHANDS if getattr(arguments, name) is not None}
    for prefix in ("", f"{side}."):
        for text in arguments.option:
            key, separator, value = text.partition("=")
            if not separator:
                raise ConfigError(f"option = {text!r}: must be KEY=VALUE")
            owner, dot, name = key.rpartition(".")
            if dot and owner not in SIDES:
                raise ConfigError(f"option = {text!r}: {owner!r} is not a side")
            if f"{owner}{dot}" == prefix:
                options[name] = value
    return options


def _open(arguments: argparse.Namespace, side: str) -> HandleDevice:
    name = arguments.device_right if side == "right" and arguments.device_right else arguments.device
    return find_factory(name)(side, device_options(arguments, side))


def _calibrate(arguments: argparse.Namespace, devices: dict[str, HandleDevice]) -> int:
    path = arguments.calibration or calibrations.default_path()

    def ask(instruction: str) -> None:
        if all(device.simulated for device in devices.values()):
            print(instruction)
        else:
            input(f"{instruction}, then press Enter ")

    results = calibrate(devices, ask)
    calibrations.save(path, results, datetime.now(timezone.utc).isoformat(timespec="seconds"))
    print(f"saved {path}")
    return 0


def _load_calibrations(
    path: Path | None, devices: dict[str, HandleDevice]
) -> dict[str, calibrations.HandleCalibration]:
    """The named file for all handles; else this computer's file for those that need one, if there is one."""
    if path is not None:
        return calibrations.load(path)
    if not calibrations.default_path().exists():
        return {}
    loaded = calibrations.load(calibrations.default_path())
    return {side: loaded[side] for side in loaded if side in devices and devices[side].needs_calibration}


def _run(arguments: argparse.Namespace, devices: dict[str, HandleDevice]) -> int:
    config = ProgramConfig(device_rate_hz=arguments.device_rate_hz, send_rate_hz=arguments.send_rate_hz)
    calibration = _load_calibrations(arguments.calibration, devices)
    session = new_session()
    platform = Address.parse(arguments.platform, "platform")
    keys = load_keys(arguments.key) if arguments.key else None
    listen = Address.parse(arguments.listen, "listen")
    link = TouchballLink(listen, platform, session, config.guard.link_timeout_s, keys)
    program = Program(config, link, devices, calibration, session)
    status, handler, _ = open_status(arguments.plain)
    handlers = [handler]
    if arguments.log:
        handlers.append(logging.FileHandler(arguments.log, encoding="utf-8"))
        handlers[-1].setFormatter(logging.Formatter("%(asctime)s %(levelname)s %(message)s"))
    log.setLevel(logging.INFO)
    for each in handlers:
        log.addHandler(each)
    log.info(
        "session %d: %s, listening on %s, platform %s, %s",
        session,
        ", ".join(devices),
        link.address,
        platform,
        "loopback only: no key file" if keys is None else f"keys {keys.fingerprint()}",
    )
    for side, hand in program.hands.items():
        if not hand.calibrated:
            log.warning("%s: not calibrated, raw joints are used; calibrate with: saras console calibrate", side)
    loop = PeriodicLoop(program.tick, config.device_rate_hz)
    stopped_by = _install_signals()
    try:
        loop.start()
        _watch(loop, program, devices, status, arguments.duration, stopped_by)
    finally:
        loop.stop()
        program.close()
        status.close()
    if loop.error is not None:
        log.error("the control loop failed: %s: %s", type(loop.error).__name__, loop.error)
        code = 1
    else:
        log.info("stopped after %d ticks (%d deadlines skipped), forces at zero", program.ticks, loop.skipped)
        code = 0
    for each in handlers:
        log.removeHandler(each)
        each.close()
    return code


def _install_signals() -> list[str]:
    """A list that gets the name of the signal that asks to stop."""
    stopped_by: list[str] = []

    def stop(number: int, frame: FrameType | None) -> None:
        stopped_by.append(signal.Signals(number).name)

    signal.signal(signal.SIGINT, stop)
    signal.signal(signal.SIGTERM, stop)
    return stopped_by


def _watch(
    loop: PeriodicLoop,
    program: Program,
    devices: dict[str, HandleDevice],
    status: object,
    duration_s: float | None,
    stopped_by: list[str],
) -> None:
    """The main thread: windows and status, until a signal, the duration, a closed window or a failed loop."""
    end = None if duration_s is None else time.monotonic() + duration_s
    while loop.running and not stopped_by and (end is None or time.monotonic() < end):
        now_ns = time.monotonic_ns()
        for side, device in devices.items():
            guard = program.hands[side].guard
            if not device.pump({"state": guard.state.name, "force_N": guard.force_N, "energy_J": guard.energy_J}):
                log.info("%s: window closed", side)
                return
        status.show(program, now_ns)  # type: ignore[attr-defined]
        time.sleep(0.05)
    if stopped_by:
        log.info("stopping on %s", stopped_by[0])
