"""How an arm did in a session: workspace, accuracy, velocity."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras.dataset import resample
from saras.dataset.table import Options
from saras.recording import Session
from saras.recording.series import PoseSeries, pose_series

Floats = NDArray[np.float64]
ENGAGED = 2


def validate(session: Session, options: Options | None = None) -> dict[str, dict[str, Any]]:
    """Figures of each arm whose pose was recorded; None stands for what cannot be known. SI units, names carry them."""
    options = options or Options()
    arms: dict[str, dict[str, Any]] = {}
    for name in ("mesa_left", "mesa_right"):
        measured = session.arm(name).ee_pose
        if measured is not None:
            side = name.removeprefix("mesa_")
            figures = _figures(measured, options)
            arms[name] = {**figures, **_accuracy(session, side, measured, options)}
    for name in ("PSM1", "PSM2", "ECM"):
        topic = session.topic(f"/{name}/measured_cp") or session.topic(f"/dvrk/{name}/position_cartesian_current")
        measured = pose_series(topic)
        if measured is not None:
            arms[name] = _figures(measured, options)
    return arms


def _figures(measured: PoseSeries, options: Options) -> dict[str, Any]:
    order, dropped = resample.usable(measured.t, measured.t_received, options.age_max_s)
    t, position = measured.t[order], measured.position[order]
    known = np.isfinite(position).all(axis=1)
    t, position = t[known], position[known]
    figures: dict[str, Any] = {"samples": len(t), "dropped": dropped, "frame": measured.frame}
    if not len(t):
        return {**figures, "workspace_m": None, "speed_m_per_s": None, "path_m": None}
    step = np.linalg.norm(np.diff(position, axis=0), axis=1)
    near = np.diff(t) <= resample.default_gap_s(t, options.gap_periods, options.gap_least_s)
    low, high = position.min(axis=0), position.max(axis=0)
    return {
        **figures,
        "workspace_m": {"low": low.tolist(), "high": high.tolist(), "size": (high - low).tolist()},
        "path_m": float(step[near].sum()),
        "speed_m_per_s": _speeds(t, position, near),
    }


def _speeds(t: Floats, position: Floats, near: NDArray[np.bool_]) -> dict[str, float] | None:
    """Over five samples: differences of neighbours are mostly jitter of the stamps."""
    span = 4
    if len(t) <= span:
        return None
    whole = np.array([near[k : k + span].all() for k in range(len(t) - span)])
    if not whole.any():
        return None
    speed = np.linalg.norm(position[span:] - position[:-span], axis=1)[whole] / (t[span:] - t[:-span])[whole]
    return {"p50": float(np.median(speed)), "p99": float(np.percentile(speed, 99)), "max": float(speed.max())}


def _accuracy(session: Session, side: str, measured: PoseSeries, options: Options) -> dict[str, Any]:
    """Measured tip against the set-point at the same time, while the side is engaged."""
    asked, state = session.arm(f"mesa_{side}").set_point, session.console(side).state
    nothing = {"accuracy_m": None, "accuracy_rad": None, "engaged_samples": 0}
    if asked is None or state is None or asked.frame != measured.frame:
        return nothing
    order, _ = resample.usable(measured.t, measured.t_received, options.age_max_s)
    t = measured.t[order]
    place, _, known = resample.previous(state.t, t, 0.5)
    engaged = known & (state["state"][place] == ENGAGED)
    source, _ = resample.usable(asked.t, asked.t_received, options.age_max_s)
    gap_s = resample.default_gap_s(asked.t[source], options.gap_periods, options.gap_least_s)
    there, valid = resample.linear(asked.t[source], asked.position[source], t, gap_s)
    error = np.linalg.norm(there - measured.position[order], axis=1)
    use = engaged & valid & np.isfinite(error)
    if not use.any():
        return nothing
    low, _, _ = resample.brackets(asked.t[source], t, gap_s)
    nearest = asked.pose[source][low][:, :3, :3]
    turned = np.swapaxes(nearest, 1, 2) @ measured.pose[order][:, :3, :3]
    axis = np.stack([turned[:, i, j] - turned[:, j, i] for i, j in ((2, 1), (0, 2), (1, 0))], axis=1)
    angle = np.arctan2(np.linalg.norm(axis, axis=1), np.trace(turned, axis1=1, axis2=2) - 1.0)[use]
    return {
        "accuracy_m": _spread(error[use]),
        "accuracy_rad": _spread(angle[np.isfinite(angle)]),
        "engaged_samples": int(use.sum()),
    }


def _spread(values: Floats) -> dict[str, float] | None:
    if not len(values):
        return None
    rms = float(np.sqrt(np.mean(values**2)))
    return {"rms": rms, "p99": float(np.percentile(values, 99)), "max": float(values.max())}
