"""The page of script/demo palpation: the map beside the truth, errors over time, where the inclusion was found."""

from __future__ import annotations

from html import escape
from importlib import resources
from typing import Any

import numpy as np

from saras.model.storage import MIDDLE, SOFT, STIFF, UNKNOWN
from saras.report.parts import table
from saras.report.svg import Chart
from saras_ros1.palpation_truth import LOOKED_AT_M, Errors, Truth

CELLS, PIXELS = 40, 300
LEFT, TOP = 34, 22
FOUND_M = 0.002
AXIS = "palpated for [s]"  # named time, a line would break at silences of 0.3 s
NOTE = (
    '<p class="note">x and y in mm; grey: not known. '
    "Circle: the inclusion; cross: where the map is surely stiffest.</p>"
)


def report(truth: Truth, rows: Any, begun_with: Any, series: list[Errors], facts: dict[str, Any]) -> str:
    """The whole document. rows, begun_with: of read_cloud, the last map and the first one."""
    data = resources.files("saras") / "data"
    style = (data / "report.css").read_text(encoding="utf-8")
    script = (data / "report.js").read_text(encoding="utf-8")
    last = series[-1]
    found = last.inclusion_m <= FOUND_M
    grade = "good" if found else "bad"
    said = f"inclusion found {1e3 * last.inclusion_m:.1f} mm off, after {last.samples} samples"
    verdict = f"<p class='summary {grade}'>{said}</p>"
    body = "".join(
        f"<section><h2>{escape(title)}</h2>{html}</section>"
        for title, html in (
            ("Map beside truth", maps(truth, rows)),
            ("Where the surface was believed", surfaces(truth, rows, begun_with)),
            ("Error over time", charts(series)),
            ("Numbers", numbers(series, facts)),
        )
    )
    return (
        '<!doctype html><html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
        f"<title>Palpation</title><style>{style}</style></head><body><header><p class='brand'>SARAS palpation</p>"
        f"<h1>A stiff inclusion, found by touch</h1>{verdict}</header>"
        f"<main>{body}</main><script>{script}</script></body></html>"
    )


def found_when(series: list[Errors]) -> Errors | None:
    """The first moment from which on the inclusion stays found; None: it is not."""
    off = np.array([row.inclusion_m <= FOUND_M for row in series])
    if not off[-1]:
        return None
    wrong = np.flatnonzero(~off)
    return series[int(wrong[-1]) + 1 if len(wrong) else 0]


def maps(truth: Truth, rows: Any) -> str:
    """Truth, what was learned, and its standard deviation; grey: unknown."""
    points = np.column_stack([rows["x"], rows["y"], rows["z"]]).astype(float)
    stiffness, std = rows["stiffness"].astype(float), rows["std"].astype(float)
    at, near = _cells(truth, points)
    true = truth.phantom.stiffness(truth.phantom.surface(at))
    high = float(true.max())
    stiffest = int(np.where(np.isfinite(stiffness), stiffness - std, -np.inf).argmax())
    marks = [
        (1e3 * (truth.phantom.inclusion - truth.middle)[:2], "true"),
        (1e3 * (points[stiffest] - truth.middle)[:2], "found"),
    ]
    panels = (
        panel("truth [N/m]", true, 0.0, high, marks[:1]),
        panel("learned [N/m]", stiffness[near], 0.0, high, marks),
        panel("standard deviation [N/m]", np.where(np.isfinite(std), std, np.nan)[near], 0.0, 200.0, []),
    )
    return f'<div style="display:flex;flex-wrap:wrap;gap:12px">{"".join(panels)}</div>{NOTE}'


def surfaces(truth: Truth, rows: Any, begun_with: Any) -> str:
    """Height over the true surface of the prior mesh and of the mesh at the end."""
    panels = ""
    for title, given in (("prior model, height over the tissue [mm]", begun_with), ("after bending [mm]", rows)):
        points = np.column_stack([given["x"], given["y"], given["z"]]).astype(float)
        _, near = _cells(truth, points)
        panels += panel(title, -1e3 * truth.phantom.depth(points)[near], -3.0, 3.0, [])
    return f'<div style="display:flex;flex-wrap:wrap;gap:12px">{panels}</div>'


def charts(series: list[Errors]) -> str:
    """Errors, coverage and how much is known."""
    t = [row.t_s for row in series]
    off = Chart("inclusion, distance to the stiffest place [mm]", AXIS, width=1150, height=150, y_include=(0.0,))
    off.line(t, [1e3 * row.inclusion_m for row in series], "distance", "measured").level(1e3 * FOUND_M, "found")
    stiffness = Chart("stiffness, RMS error where known [N/m]", AXIS, width=1150, height=130, y_include=(0.0,))
    stiffness.line(t, [row.stiffness_N_m for row in series], "error", "extra")
    surface = Chart("surface, RMS error [mm]", AXIS, width=1150, height=130, y_include=(0.0,))
    surface.line(t, [1e3 * row.surface_m for row in series], "error", "master")
    share = Chart("share [%]", AXIS, width=1150, height=150, y_range=(0.0, 100.0))
    share.line(t, [100.0 * row.known for row in series], "of the square that is known", "truth")
    share.line(t, [100.0 * row.within_1 for row in series], "of stiffnesses within 1 σ", "command", True)
    share.line(t, [100.0 * row.within_2 for row in series], "within 2 σ", "measured", True)
    return off.render() + stiffness.render() + surface.render() + share.render()


def numbers(series: list[Errors], facts: dict[str, Any]) -> str:
    """At the end, and when the inclusion was found for good."""
    first, last, when = series[0], series[-1], found_when(series)
    lines: list[list[Any]] = [
        ["inclusion found [mm] off", f"{1e3 * last.inclusion_m:.2f}"],
        ["within 2 mm for good after [s]", "never" if when is None else f"{when.t_s:.0f}"],
        ["… after samples", "never" if when is None else when.samples],
        ["samples in all", last.samples],
        ["stiffness, RMS error where known [N/m]", f"{last.stiffness_N_m:.0f}"],
        ["stiffnesses within 1 σ, 2 σ [%]", f"{100 * last.within_1:.0f}, {100 * last.within_2:.0f}"],
        ["known of the square [%]", f"{100 * last.known:.0f}"],
        ["surface, RMS error [mm]", f"{1e3 * last.surface_m:.2f}"],
        ["surface of the prior, RMS error [mm]", f"{1e3 * first.surface_m:.2f}"],
        *([key, str(value)] for key, value in facts.items()),
    ]
    return table(["", ""], lines)


def panel(title: str, values: np.ndarray, low: float, high: float, marks: list[tuple[np.ndarray, str]]) -> str:
    """CELLS x CELLS values over the square, x to the right, y up, with a colour bar."""
    cell, ramp = PIXELS / CELLS, np.array([SOFT, MIDDLE, STIFF], dtype=float)

    def colour(value: float) -> str:
        share = (value - low) / (high - low)
        rgb = [np.interp(share, [0.0, 0.5, 1.0], ramp[:, k]) for k in range(3)] if np.isfinite(value) else UNKNOWN
        return "#" + "".join(f"{round(float(c)):02x}" for c in rgb)

    def pixel(mm: float, up: bool = False) -> float:
        share = 0.5 + 0.5 * mm / (1e3 * LOOKED_AT_M)
        return TOP + PIXELS * (1.0 - share) if up else LEFT + PIXELS * share

    parts = [
        f'<svg viewBox="0 0 {LEFT + PIXELS + 62} {TOP + PIXELS + 22}" style="width:365px" '
        'shape-rendering="crispEdges" font-size="11" fill="currentColor">'
    ]
    parts.append(f'<text x="{LEFT}" y="13" font-weight="bold">{escape(title)}</text>')
    for index, value in enumerate(values):
        i, j = divmod(index, CELLS)
        parts.append(
            f'<rect x="{LEFT + i * cell:.1f}" y="{TOP + PIXELS - (j + 1) * cell:.1f}" width="{cell + 0.3:.1f}" '
            f'height="{cell + 0.3:.1f}" fill="{colour(float(value))}"/>'
        )
    for mm in (-20, -10, 0, 10, 20):
        parts.append(f'<text x="{pixel(mm):.0f}" y="{TOP + PIXELS + 14}" text-anchor="middle">{mm}</text>')
        parts.append(f'<text x="{LEFT - 4}" y="{pixel(mm, True) + 4:.0f}" text-anchor="end">{mm}</text>')
    for (x, y), kind in marks:
        px, py, line = pixel(x), pixel(y, True), 'fill="none" stroke="#ff3b30" stroke-width="2"'
        shape = f'<circle cx="{px:.1f}" cy="{py:.1f}" r="7" {line}/>'
        if kind == "found":
            shape = f'<path d="M{px - 5:.1f} {py - 5:.1f}l10 10m0 -10l-10 10" {line}/>'
        parts.append(shape)
    bar = LEFT + PIXELS + 10
    for k in range(50):
        y, fill = TOP + PIXELS * (1.0 - (k + 1) / 50), colour(low + (high - low) * (k + 0.5) / 50)
        parts.append(f'<rect x="{bar}" y="{y:.1f}" width="12" height="{PIXELS / 50 + 0.3:.1f}" fill="{fill}"/>')
    for share in (0.0, 0.5, 1.0):
        parts.append(
            f'<text x="{bar + 16}" y="{TOP + PIXELS * (1.0 - share) + 4:.0f}">{low + (high - low) * share:.0f}</text>'
        )
    return "".join(parts) + "</svg>"


def _cells(truth: Truth, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2) middles of the cells across the surface [m], and the vertex nearest to each, as seen from above."""
    side = LOOKED_AT_M * (2.0 * (np.arange(CELLS) + 0.5) / CELLS - 1.0)
    at = np.array([(x, y) for x in side for y in side])
    flat = points[:, :2] - truth.middle[:2]
    return at, np.array([int(((flat - a) ** 2).sum(1).argmin()) for a in at])
