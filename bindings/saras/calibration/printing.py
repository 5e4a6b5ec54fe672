"""The board as a page to print."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.calibration.board import Board, marker_cells
from saras.calibration.drawing import Circle, Page, Rectangle, Text

Array = npt.NDArray[np.float64]

#: Width and height, lying [mm].
PAGES = {"a4": (297.0, 210.0), "a3": (420.0, 297.0), "letter": (279.4, 215.9)}
MARGIN_MM = 5.0
SCALE_BAR_MM = 100.0
#: White in the middle of a dot, to aim at.
AIM_RADIUS_MM = 0.25


def board_page(board: Board, paper: str = "a4") -> Page:
    """The board in the middle of a lying page, with a scale bar in each direction. Raises ConfigError: does not fit."""
    if paper not in PAGES:
        raise ConfigError(f"page = {paper!r}: must be one of {', '.join(PAGES)}")
    width, height = PAGES[paper]
    dots = 1e3 * board.dots[:, :2]
    dot_radius = 0.5e3 * board.config.dot_diameter_m
    corners = np.concatenate([1e3 * c[:, :2] for c in board.markers.values()])
    low = np.minimum(dots.min(axis=0) - dot_radius, corners.min(axis=0))
    high = np.maximum(dots.max(axis=0) + dot_radius, corners.max(axis=0))
    room = np.array([width, height]) - 2.0 * MARGIN_MM
    if (high - low > room).any():
        size, fits = " x ".join(f"{v:.1f}" for v in high - low), " x ".join(f"{v:.1f}" for v in room)
        raise ConfigError(f"board = {size} mm: must be <= {fits} mm to fit on {paper}")
    origin = 0.5 * np.array([width, height]) - 0.5 * (low + high)
    page = Page(width, height, f"SARAS calibration board {board.hash}")
    for number, dot in enumerate(dots, start=1):
        x, y = (float(v) for v in origin + dot)
        page.shapes.append(Circle(x, y, dot_radius))
        page.shapes.append(Circle(x, y, AIM_RADIUS_MM, white=True))
        inwards = origin + dot * (1.0 - (dot_radius + 5.0) / np.linalg.norm(dot))
        page.shapes.append(Text(inwards[0] - 1.4, inwards[1] - 1.8, 5.0, str(number)))
    for marker_id, marker in board.markers.items():
        page.shapes += _marker(origin + 1e3 * marker[:, :2], marker_id)
    page.shapes += _axes(origin)
    page.shapes += _scale_bars(page, board)
    return page


def _marker(corners: Array, marker_id: int) -> list[Rectangle | Text]:
    """A black square with white cells on it, joined along rows and along columns: seams would show as hairlines."""
    cell = (corners[1, 0] - corners[0, 0]) / 6.0
    left, top = corners[0]
    shapes: list[Rectangle | Text] = [Rectangle(left, top - 6.0 * cell, 6.0 * cell, 6.0 * cell)]
    white = ~marker_cells(marker_id)
    for i in range(6):
        for start, end in _runs(white[i]):
            shapes.append(Rectangle(left + start * cell, top - (i + 1) * cell, (end - start) * cell, cell, white=True))
        for start, end in _runs(white[:, i]):
            shapes.append(Rectangle(left + i * cell, top - end * cell, cell, (end - start) * cell, white=True))
    shapes.append(Text(left, top - 6.0 * cell - 8.0, 3.0, f"marker {marker_id}"))
    return shapes


def _runs(flags: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    edges = np.flatnonzero(np.diff(np.concatenate([[0], flags.astype(int), [0]])))
    return [(int(start), int(end)) for start, end in zip(edges[::2], edges[1::2])]


def _axes(origin: Array) -> list[Rectangle | Text]:
    x, y = origin
    return [
        Rectangle(x, y - 0.15, 15.0, 0.3),
        Rectangle(x - 0.15, y, 0.3, 15.0),
        Text(x + 16.0, y - 1.2, 4.0, "x"),
        Text(x - 1.0, y + 16.5, 4.0, "y"),
    ]


def _scale_bars(page: Page, board: Board) -> list[Rectangle | Text]:
    right, bottom = page.width_mm - 15.0, 12.0
    middle = 0.5 * page.height_mm
    bar = SCALE_BAR_MM
    shapes: list[Rectangle | Text] = [
        Rectangle(right - bar, bottom, bar, 0.4),
        Rectangle(right - bar, bottom - 2.0, 0.2, 4.4),
        Rectangle(right - 0.2, bottom - 2.0, 0.2, 4.4),
        Text(right - 0.62 * bar, bottom + 1.5, 3.2, f"{bar:.0f} mm between the outer edges"),
        Rectangle(right, middle - 0.5 * bar, 0.4, bar),
        Rectangle(right - 2.0, middle - 0.5 * bar, 4.4, 0.2),
        Rectangle(right - 2.0, middle + 0.5 * bar - 0.2, 4.4, 0.2),
        Text(right - 16.0, middle - 0.5 * bar - 4.5, 3.2, f"{bar:.0f} mm"),
    ]
    lines = (f"SARAS calibration board {board.hash}", "print at 100 %, no fitting; then measure both bars")
    shapes += [Text(8.0, 12.0 - 4.5 * i, 3.2, line) for i, line in enumerate(lines)]
    return shapes


__all__ = ["AIM_RADIUS_MM", "MARGIN_MM", "PAGES", "SCALE_BAR_MM", "board_page"]
