"""A small SVG chart writer: time series with thresholds and shaded bands, and plane curves.

Strokes name CSS variables (``var(--master)``), so that the page's light and dark themes reach into the charts.
The page's script reads ``data-*`` of each chart to show values under the pointer.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

POINTS_PER_LINE = 1600
GAP_S = 0.3  #: a line is not drawn across a longer silence
_LEFT, _RIGHT, _TOP, _BOTTOM = 54, 12, 8, 22


@dataclass
class Line:
    """One curve. ``color`` is a CSS variable's name."""

    x: Floats
    y: Floats
    label: str
    color: str
    dash: bool = False
    width: float = 1.4


@dataclass
class Chart:
    """Axes with curves. Ranges are taken from the data unless given."""

    y_label: str
    x_label: str = "time [s]"
    width: int = 560
    height: int = 170
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    y_include: tuple[float, ...] = ()
    equal_axes: bool = False
    lines: list[Line] = field(default_factory=list)
    bands: list[tuple[float, float, str]] = field(default_factory=list)
    levels: list[tuple[float, str]] = field(default_factory=list)

    def line(self, x: Any, y: Any, label: str, color: str, dash: bool = False, width: float = 1.4) -> Chart:
        """Adds a curve; non-finite values leave a gap. Returns the chart."""
        x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        self.lines.append(Line(x, y, label, color, dash, width))
        return self

    def level(self, y: float, label: str) -> Chart:
        """Adds a horizontal threshold."""
        if math.isfinite(y):
            self.levels.append((y, label))
        return self

    def render(self) -> str:
        """The chart as an <svg> element with its legend, or a note when there is nothing to draw."""
        if not any(np.isfinite(line.y).any() for line in self.lines):
            text = f"<b>unknown</b> {escape(self.y_label)}: not recorded"
            return f'<div class="nodata" style="height:{self.height}px">{text}</div>'
        x0, x1, y0, y1 = self._ranges()
        to_px = _Scale(x0, x1, _LEFT, self.width - _RIGHT)
        to_py = _Scale(y0, y1, self.height - _BOTTOM, _TOP)
        parts = [
            f'<svg class="chart" viewBox="0 0 {self.width} {self.height}" data-x="{x0:.6g} {x1:.6g}" '
            f'data-y="{y0:.6g} {y1:.6g}" data-box="{_LEFT} {self.width - _RIGHT} {_TOP} {self.height - _BOTTOM}" '
            f'data-time="{int(self.x_label.startswith("time"))}" role="img" aria-label="{escape(self.y_label)}">'
        ]
        for start, end, css in self.bands:
            left, right = to_px.clip(start), to_px.clip(end)
            parts.append(box(css, left, _TOP, max(right - left, 1.0), self.height - _TOP - _BOTTOM))
        parts += self._axes(to_px, to_py)
        for y, label in self.levels:
            if y0 <= y <= y1:
                py, right = to_py(y), self.width - _RIGHT
                parts.append(_segment("level", _LEFT, py, right, py))
                parts.append(text_at("level", right - 2, py - 3, label, "end"))
        for line in self.lines:
            dash = ' stroke-dasharray="5 3"' if line.dash else ""
            style = f"stroke:var(--{line.color});stroke-width:{line.width}"
            parts.append(f'<g class="line" data-label="{escape(line.label)}" style="{style}"{dash}>')
            for xs, ys in _runs(line, self.x_label.startswith("time")):
                points = " ".join(f"{to_px(x):.1f},{to_py(y):.1f}" for x, y in zip(xs, ys))
                parts.append(f'<polyline points="{points}"/>')
            parts.append("</g>")
        parts.append("</svg>")
        return f"<figure>{self._legend()}{''.join(parts)}</figure>"

    def _ranges(self) -> tuple[float, float, float, float]:
        xs = np.concatenate([line.x[np.isfinite(line.y) & np.isfinite(line.x)] for line in self.lines])
        ys = np.concatenate(
            [np.asarray(self.y_include, dtype=float), *(line.y[np.isfinite(line.y)] for line in self.lines)]
        )
        x0, x1 = self.x_range or (float(xs.min()), float(xs.max()))
        y0, y1 = self.y_range or _padded(float(ys.min()), float(ys.max()))
        x1 = x1 if x1 > x0 else x0 + 1.0
        if self.equal_axes:
            x0, x1 = _padded(x0, x1)
            per_px = max((x1 - x0) / (self.width - _LEFT - _RIGHT), (y1 - y0) / (self.height - _TOP - _BOTTOM))
            half_x = per_px * (self.width - _LEFT - _RIGHT) / 2
            half_y = per_px * (self.height - _TOP - _BOTTOM) / 2
            cx, cy = (x0 + x1) / 2, (y0 + y1) / 2
            return cx - half_x, cx + half_x, cy - half_y, cy + half_y
        return x0, x1, y0, y1

    def _axes(self, to_px: _Scale, to_py: _Scale) -> list[str]:
        right, bottom = self.width - _RIGHT, self.height - _BOTTOM
        parts = []
        for y in ticks(to_py.low, to_py.high, max(3, (self.height - 30) // 26)):
            parts.append(_segment("grid", _LEFT, to_py(y), right, to_py(y)))
            parts.append(text_at("tick", _LEFT - 5, to_py(y) + 3.5, number(y), "end"))
        for x in ticks(to_px.low, to_px.high, max(3, self.width // 70)):
            parts.append(_segment("grid", to_px(x), _TOP, to_px(x), bottom))
            parts.append(text_at("tick", to_px(x), bottom + 13, number(x), "middle"))
        return parts

    def _legend(self) -> str:
        items = ""
        for line in self.lines:
            border = f"2px {'dashed' if line.dash else 'solid'} var(--{line.color})"
            items += f'<span><i style="border-top:{border}"></i>{escape(line.label)}</span>'
        return f"<figcaption><b>{escape(self.y_label)}</b>{items}<em>{escape(self.x_label)}</em></figcaption>"


@dataclass(frozen=True)
class _Scale:
    low: float
    high: float
    pixel_low: float
    pixel_high: float

    def __call__(self, value: float) -> float:
        return self.pixel_low + (value - self.low) / (self.high - self.low) * (self.pixel_high - self.pixel_low)

    def clip(self, value: float) -> float:
        return self(min(max(value, self.low), self.high))


def box(css: str, x: float, y: float, width: float, height: float, title: str = "") -> str:
    """A filled rectangle; ``title`` shows under the pointer."""
    tip = f"<title>{escape(title)}</title>" if title else ""
    return f'<rect class="{css}" x="{x:.1f}" y="{y:g}" width="{width:.1f}" height="{height:g}">{tip}</rect>'


def text_at(css: str, x: float, y: float, text: str, anchor: str = "start") -> str:
    """Text whose start, middle or end is at (x, y)."""
    return f'<text class="{css}" x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _segment(css: str, x1: float, y1: float, x2: float, y2: float) -> str:
    return f'<line class="{css}" x1="{x1:.1f}" y1="{y1:.1f}" x2="{x2:.1f}" y2="{y2:.1f}"/>'


def ticks(low: float, high: float, count: int) -> list[float]:
    """About ``count`` round numbers in [low, high]."""
    raw = (high - low) / max(count, 1)
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(factor * power for factor in (1, 2, 5, 10) if factor * power >= raw * 0.85)
    first = math.ceil(low / step - 1e-9)
    last = math.floor(high / step + 1e-9)
    return [index * step for index in range(first, last + 1)]


def number(value: float) -> str:
    """A tick label: short, no trailing zeros, no minus zero."""
    text = f"{value:.6g}"
    return "0" if float(text) == 0 else text


def decimate(x: Floats, y: Floats, points: int = POINTS_PER_LINE) -> tuple[Floats, Floats]:
    """At most about ``points`` samples that keep the least and the greatest value of every bucket."""
    if len(x) <= points:
        return x, y
    edges = np.linspace(0, len(x), points // 2 + 1).astype(int)
    keep: set[int] = {0, len(x) - 1}
    for start, stop in zip(edges[:-1], edges[1:]):
        keep.add(start + int(np.argmin(y[start:stop])))
        keep.add(start + int(np.argmax(y[start:stop])))
    index = np.array(sorted(keep))
    return x[index], y[index]


def _runs(line: Line, is_time: bool) -> list[tuple[Floats, Floats]]:
    """Unbroken pieces of a curve, decimated: split at non-finite values and (in time) at silences."""
    known = np.isfinite(line.x) & np.isfinite(line.y)
    breaks = np.flatnonzero(np.diff(known.astype(int)) != 0) + 1
    if is_time:
        breaks = np.union1d(breaks, np.flatnonzero(np.diff(line.x) > GAP_S) + 1)
    pieces = np.split(np.arange(len(line.x)), breaks)
    share = max(1, len(line.x))
    runs = []
    for piece in pieces:
        if len(piece) and known[piece[0]]:
            points = max(20, POINTS_PER_LINE * len(piece) // share)
            if is_time:
                runs.append(decimate(line.x[piece], line.y[piece], points))
            else:
                stride = max(1, len(piece) // points)
                runs.append((line.x[piece][::stride], line.y[piece][::stride]))
    return runs


def _padded(low: float, high: float) -> tuple[float, float]:
    span = high - low
    pad = 0.06 * span if span > 1e-12 else max(0.1 * abs(high), 1e-3)
    return low - pad, high + pad
