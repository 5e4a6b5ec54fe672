"""Sections about motion and force: trajectories, forces, remote centre."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras.recording import PoseSeries, Session
from saras.report import tracking
from saras.report.parts import both_sides, chart, table
from saras.report.svg import Chart
from saras.report.verdicts import SIDES, Findings

CLOSE_UP_S = 5.0
_COS_30, _SIN_30 = np.cos(np.pi / 6), 0.5


def trajectories(session: Session, found: Findings) -> str:
    """Mapped master, set-point and measured tip: each axis over time, a close-up, the path in space."""

    def one(side: str) -> list[str]:
        curves = _curves(session, found, side)
        panels = []
        for axis, name in enumerate("xyz"):
            panel = chart(session, found, side, f"{name} − mean [mm]", height=130)
            for t, position, label, color, dash in curves:
                panel.line(t, position[:, axis], label, color, dash)
            panels.append(panel.render())
        return [*panels, _close_up(session, found, side, curves), _error(session, found, side), _path(curves)]

    return _fit_table(found) + both_sides(one)


_Curve = tuple[NDArray[np.float64], NDArray[np.float64], str, str, bool]


def _curves(session: Session, found: Findings, side: str) -> list[_Curve]:
    """(t, (n, 3) position from the mean measured one [mm], label, colour, dashed)."""
    arm = session.arm(f"mesa_{side}")
    tip, set_point, master = arm.ee_pose, arm.set_point, session.console(side).tracked_pose
    origin = next((np.nanmean(pose.position, axis=0) for pose in (tip, set_point, master) if pose is not None), 0.0)
    curves: list[_Curve] = []
    if master is not None:
        scale = _scale(session, found, side)
        position = master.position if scale is None else _aligned(session, side, master, scale, tip or set_point)
        label = "master" if scale is None else f"master × {scale:.2f}"
        curves.append((master.t, 1e3 * (position - origin), label, "master", False))
    for pose, label, color, dash in ((set_point, "set-point", "command", True), (tip, "measured", "measured", False)):
        if pose is not None:
            curves.append((pose.t, 1e3 * (pose.position - origin), label, color, dash))
    return curves


def _scale(session: Session, found: Findings, side: str) -> float | None:
    """Slave metres per master metre: as configured where the laws were recorded, else as fitted."""
    info = session.topic(f"/laws/transparency_{side}/info")
    if info is not None:
        try:
            return float(json.loads(str(info["data"][-1]))["args"][0]["fields"]["scale"])
        except (ValueError, LookupError, TypeError):
            pass
    fit = found.tracking[side]
    return fit.scale if fit is not None else None


def _aligned(
    session: Session, side: str, master: PoseSeries, scale: float, follower: PoseSeries | None
) -> NDArray[np.float64]:
    """(n, 3) where the master wants the slave: scaled, with the offset of each engaged stretch; NaN between."""
    wanted = np.full_like(master.position, np.nan)
    if follower is None:
        return wanted
    active = tracking.engaged(session, side, master.t)
    edges = np.flatnonzero(np.diff(active.astype(int), prepend=0, append=0))
    for start, stop in zip(edges[::2], edges[1::2]):
        moved = scale * master.position[start:stop]
        there = np.stack(
            [np.interp(master.t[start:stop], follower.t, column) for column in follower.position.T], axis=1
        )
        wanted[start:stop] = moved + (there - moved).mean(axis=0)
    return wanted


def _close_up(session: Session, found: Findings, side: str, curves: list[_Curve]) -> str:
    """The liveliest seconds of the liveliest axis: here the lag can be seen."""
    if not curves:
        return ""
    t, position = curves[-1][0], curves[-1][1]
    starts = np.arange(t[0], max(t[0], t[-1] - CLOSE_UP_S) + 1e-9, CLOSE_UP_S / 2)
    spans = []
    for start in starts:
        part = position[(t >= start) & (t <= start + CLOSE_UP_S)]
        spans.append(np.ptp(part, axis=0) if len(part) else np.zeros(3))
    window, axis = np.unravel_index(np.argmax(spans), (len(spans), 3))
    panel = chart(session, found, side, f"close-up of {'xyz'[axis]} [mm]", height=170)
    panel.x_range = (float(starts[window]), float(starts[window]) + CLOSE_UP_S)
    for times, values, label, color, dash in curves:
        inside = (times >= panel.x_range[0]) & (times <= panel.x_range[1])
        panel.line(times[inside], values[inside, axis], label, color, dash)
    return panel.render()


def _error(session: Session, found: Findings, side: str) -> str:
    panel = chart(session, found, side, "tracking error, lag removed [mm]", height=110, y_include=(0.0,))
    fit = found.tracking[side]
    if fit is not None:
        panel.line(fit.t, fit.error_mm, "measured against scale × delayed master", "measured")
        panel.level(1.0, "1 mm")
    return panel.render()


def _path(curves: list[_Curve]) -> str:
    panel = Chart("path [mm]", "isometric: x right-down, y right-up, z up", height=330, equal_axes=True)
    for _, position, label, color, _dash in curves:
        x, y, z = position.T
        panel.line((x + y) * _COS_30, z + (y - x) * _SIN_30, label, color, width=1.0)
    return panel.render()


def _fit_table(found: Findings) -> str:
    rows: list[list[Any]] = []
    for side in SIDES:
        for name, fit in (("set-point", found.set_point_tracking[side]), ("measured tip", found.tracking[side])):
            if fit is None:
                rows.append([f"{side} {name}", *([None] * 5)])
                continue
            numbers = (fit.scale, 1e3 * fit.lag_s, fit.rms_mm, fit.worst_mm, fit.seconds)
            rows.append([f"{side} {name}", *(f"{value:.{d}f}" for value, d in zip(numbers, (4, 0, 3, 3, 1)))])
    note = (
        "<p class='note'>Scale, constant lag and one offset a stretch, fitted over free motion: engaged, "
        f"clutch released, force below {tracking.FREE_FORCE_N} N, tanks not reducing, "
        f"{tracking.SETTLE_S:.0f} s after any of these. The master is drawn while it is engaged.</p>"
    )
    head = ["against the mapped master", "scale", "lag [ms]", "RMS [mm]", "worst [mm]", "measured on [s]"]
    return table(head, rows) + note


def forces(session: Session, found: Findings) -> str:
    """Magnitudes of the force on the hand (asked, let through) and on the tissue (estimated, true)."""

    def one(side: str) -> list[str]:
        console, arm = session.console(side), session.arm(f"mesa_{side}")
        hand = chart(session, found, side, "force on the hand [N]", y_include=(0.0,))
        for series, label, color in (
            (console.desired_wrench, "asked by transparency", "command"),
            (console.applied_wrench, "let through by tank_master", "measured"),
        ):
            if series is not None:
                hand.line(series.t, np.linalg.norm(series.value[:, :3], axis=1), label, color)
        tissue = chart(session, found, side, "force on the tissue [N]", y_include=(0.0,))
        if arm.measured_cf is not None:
            force = np.linalg.norm(arm.measured_cf.value[:, :3], axis=1)
            tissue.line(arm.measured_cf.t, force, "estimated", "master")
        truth = arm.truth
        columns = [f"tip_force.{axis}" for axis in "xyz"]
        if truth is not None and all(name in truth.columns for name in columns):
            force = np.linalg.norm(np.stack([truth[name] for name in columns], axis=1), axis=1)
            tissue.line(truth.t, force, "simulator's truth", "truth", dash=True)
        return [hand.render(), tissue.render()]

    return both_sides(one)


def remote_centre(session: Session, found: Findings) -> str:
    """Distance of each shaft from its trocar."""

    def one(side: str) -> list[str]:
        panel = chart(session, found, side, "shaft from trocar [mm]", y_include=(0.0,), height=130)
        result = tracking.remote_centre_deviation(session, f"mesa_{side}")
        if result is not None:
            panel.line(result[0], 1e3 * result[1], result[2], "measured").level(0.1, "0.1 mm")
        return [panel.render()]

    return both_sides(one)
