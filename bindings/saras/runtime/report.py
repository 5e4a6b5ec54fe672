"""The picture of a flight record: states, forces, energies and ages of the last minute on one page."""

from __future__ import annotations

from html import escape
from importlib import resources
from pathlib import Path

import numpy as np
import numpy.typing as npt

from saras.report.svg import Chart
from saras.runtime import FlightRecord, FlightReplay

Array = npt.NDArray[np.float64]

SIDES = ("left", "right")
STATES = ("WAITING", "READY", "ENGAGED", "HOLD")
COLORS = ("master", "measured")  #: CSS variables of report.css


def write_report(directory: Path, name: str, record: FlightRecord, replay: FlightReplay) -> Path:
    """Writes flight.html into the directory; returns its path. Nothing is loaded from outside."""
    arrays = record.arrays()
    t = arrays["time_s"] - arrays["time_s"][-1]  # seconds before the end: that is where it happened
    style = (resources.files("saras") / "data" / "report.css").read_text(encoding="utf-8")
    script = (resources.files("saras") / "data" / "report.js").read_text(encoding="utf-8")
    exact = replay.exact == replay.ticks
    verdict = f"{replay.exact} of {replay.ticks} outputs equal to the bit" + ("" if exact else ": DIFFERS")
    sections = [
        f"<h2>{side}</h2>" + "".join(chart.render() for chart in _side(arrays, t, i)) for i, side in enumerate(SIDES)
    ]
    page = (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><title>Flight record</title>'
        f"<style>{style}</style></head><body><header><p class='brand'>SARAS flight record</p>"
        f"<h1>{escape(record.reason or 'reason unknown')}</h1><p>{escape(name)}: {len(t)} steps, "
        f"{t[-1] - t[0]:.1f} s; replay: {verdict}</p></header><main>"
        + "".join(f"<section>{html}</section>" for html in (_common(arrays, t), *sections))
        + f"</main><script>{script}</script></body></html>"
    )
    directory.mkdir(parents=True, exist_ok=True)
    path = directory / "flight.html"
    path.write_text(page, encoding="utf-8")
    return path


def _chart(label: str, t: Array, height: int = 180) -> Chart:
    return Chart(label, x_label="before the end [s]", height=height, width=1150, x_range=(float(t[0]), 0.0))


def _common(arrays: dict[str, Array], t: Array) -> str:
    steps, tanks = _chart("time step [ms]", t), _chart("energy [J]", t)
    steps.line(t, 1e3 * arrays["dt_s"], "between two steps", COLORS[0])
    tanks.line(t, arrays["tank_master_J"], "tank_master", COLORS[0])
    tanks.line(t, arrays["tank_slave_J"], "tank_slave", COLORS[1])
    counts = f"{int(arrays['overrun'].sum())} overruns, {int(arrays['hold'].sum())} of them too long"
    return f"<h2>Loop and tanks</h2><p>{counts}</p>" + steps.render() + tanks.render()


def _side(arrays: dict[str, Array], t: Array, i: int) -> list[Chart]:
    state = _chart("state", t, 120)
    state.line(t, arrays["state"][:, i, 0], " · ".join(f"{n} {name}" for n, name in enumerate(STATES)), COLORS[0])
    way = _chart("moved [mm]", t)
    for name, color in (("tip", COLORS[0]), ("set_point", COLORS[1])):
        values = arrays[name][:, i]
        way.line(t, 1e3 * np.linalg.norm(values - values[0], axis=1), name.replace("_", "-"), color)
    force = _chart("force [N]", t)
    for name, color in (("hand_force", COLORS[0]), ("tissue_force", COLORS[1])):
        force.line(t, np.linalg.norm(arrays[name][:, i], axis=1), name.replace("_", " "), color)
    age = _chart("age [ms]", t, 140)
    for name, color in (("handle_age_s", COLORS[0]), ("arm_age_s", COLORS[1])):
        milliseconds = 1e3 * arrays[name][:, i, 0]
        age.line(t, np.where(milliseconds < 1e3, milliseconds, np.nan), name[:-6] + " (gap: over 1 s)", color)
    return [state, way, force, age]
