"""The board's print, measured in the file's own units, and its YAML."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from saras import ConfigError, cli
from saras.calibration import Board, board
from saras.calibration.printing import SCALE_BAR_MM, board_page

POINTS_PER_MM = 72.0 / 25.4  # a point of PDF is 1/72 inch
SVG = "{http://www.w3.org/2000/svg}"
ANGLES = (0, 40, 100, 170, 250, 320)


def pdf_shapes(data: bytes) -> tuple[list[tuple[np.ndarray, float]], list[np.ndarray]]:
    """Circles (centre, radius) and black rectangles (x, y, width, height) in points, as the page shows them."""
    stream = data.split(b"stream\n")[1].split(b"\nendstream")[0].decode()
    scale = float(re.match(r"([\d.]+) 0 0 ([\d.]+) 0 0 cm", stream).group(1))
    circles = []
    for path in re.findall(r"0 g ([-\d. ]+) m\n((?:[-\d. ]+ c\n){4})f", stream):
        ends = [np.array(line.split()[4:6], dtype=float) for line in path[1].strip().split("\n")]
        center = np.mean(ends, axis=0)
        circles.append((scale * center, scale * float(np.linalg.norm(ends[0] - center))))
    rectangles = [scale * np.array(m.split(), dtype=float) for m in re.findall(r"0 g ([-\d. ]+) re f", stream)]
    return circles, rectangles


def test_pdf_is_at_true_scale() -> None:
    page = board_page(board())
    data = page.pdf()
    box = [float(v) for v in re.search(rb"/MediaBox \[([\d. ]+)\]", data).group(1).split()]
    np.testing.assert_allclose(np.array(box[2:]) / POINTS_PER_MM, [297.0, 210.0], atol=1e-3)
    circles, rectangles = pdf_shapes(data)
    dots = [(c, r) for c, r in circles if abs(2 * r / POINTS_PER_MM - 5.0) < 1e-3]
    assert len(dots) == 6
    points = np.array([c for c, _ in dots]) / POINTS_PER_MM
    expected = 100.0 * np.column_stack([np.cos(np.deg2rad(ANGLES)), np.sin(np.deg2rad(ANGLES))])
    origin = points[0] - expected[0]
    np.testing.assert_allclose(points - origin, expected, atol=1e-3)
    squares = [r / POINTS_PER_MM for r in rectangles if abs(r[2] - r[3]) < 1e-6]
    assert len(squares) == 4
    for square in squares:
        np.testing.assert_allclose(square[2:], 25.0, atol=1e-3)
        assert np.linalg.norm(square[:2] + 12.5 - origin) == pytest.approx(60.0, abs=1e-3)
    bars = [max(r[2:]) / POINTS_PER_MM for r in rectangles if min(r[2:]) / POINTS_PER_MM == pytest.approx(0.4)]
    assert bars == pytest.approx([SCALE_BAR_MM, SCALE_BAR_MM], abs=1e-3)


def test_every_mark_lies_on_the_page_with_a_margin() -> None:
    circles, rectangles = pdf_shapes(board_page(board()).pdf())
    low = np.min([c - r for c, r in circles] + [r[:2] for r in rectangles], axis=0) / POINTS_PER_MM
    high = np.max([c + r for c, r in circles] + [r[:2] + r[2:] for r in rectangles], axis=0) / POINTS_PER_MM
    assert (low > 5.0).all() and (high < np.array([297.0, 210.0]) - 5.0).all()


def test_pdf_offsets_are_right() -> None:
    data = board_page(board()).pdf()
    start = int(re.search(rb"startxref\n(\d+)", data).group(1))
    assert data[start:].startswith(b"xref")
    for number, offset in enumerate(re.findall(rb"(\d{10}) 00000 n", data), start=1):
        assert data[int(offset) :].startswith(b"%d 0 obj" % number)


def test_svg_shows_the_same_as_the_pdf() -> None:
    page = board_page(board())
    root = ET.fromstring(page.svg())
    assert root.get("width") == "297.0mm" and root.get("viewBox") == "0 0 297.0 210.0"
    circles = [c for c in root.iter(SVG + "circle") if c.get("fill") is None]
    from_svg = np.array([[float(c.get("cx")), 210.0 - float(c.get("cy")), float(c.get("r"))] for c in circles])
    from_pdf = np.array([[*c, r] for c, r in pdf_shapes(page.pdf())[0]]) / POINTS_PER_MM
    np.testing.assert_allclose(from_svg, from_pdf, atol=1e-3)


def test_markers_are_those_of_opencv() -> None:
    cv2 = pytest.importorskip("cv2")
    from saras.calibration.board import MARKER_CELLS, marker_cells

    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50)
    draw = getattr(cv2.aruco, "drawMarker", None) or cv2.aruco.generateImageMarker
    for marker_id in MARKER_CELLS:
        np.testing.assert_array_equal(draw(dictionary, marker_id, 6) == 0, marker_cells(marker_id))


def test_yaml_comes_back_and_edits_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "board.yaml"
    board(marker_ids=(4, 5, 6, 7)).save(path)
    again = Board.load(path)
    assert again.hash == board(marker_ids=(4, 5, 6, 7)).hash != board().hash
    np.testing.assert_array_equal(again.dots, board().dots)
    text = path.read_text()
    for old, new, why in (
        ("dot_circle_radius_m: 0.1", "dot_circle_radius_m: 0.101", "hash"),
        ("version: 1", "version: 2", "version"),
        ("format: saras-board", "format: other", "format"),
        ("DICT_4X4_50", "DICT_5X5_50", "dictionary"),
        ("marker_side_m: 0.025", "marker_side: 0.025", "geometry/marker_side"),
        ("dot_diameter_m: 0.005", "dot_diameter_m: .nan", "dot_diameter_m"),
    ):
        assert old in text
        path.write_text(text.replace(old, new))
        with pytest.raises(ConfigError, match=why):
            Board.load(path)


def test_geometry_that_cannot_be_is_refused() -> None:
    for wrong, why in (
        ({"marker_ids": (0, 1, 2, 2)}, "marker_ids"),
        ({"marker_ids": (0, 1, 2, 50)}, "marker_ids = 50"),
        ({"dot_angles_deg": [0, 90, 180, 270]}, "another order"),
        ({"marker_circle_radius_m": 0.095}, "distance of the circles"),
    ):
        with pytest.raises(ConfigError, match=why):
            board(**wrong)
    with pytest.raises(ConfigError, match="must be <= 287"):
        board_page(board(dot_circle_radius_m=0.2))


def test_command_writes_three_files_and_overwrites_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "some" / "board"
    assert cli.main(["board", "--out", str(out)]) == 0
    assert {path.suffix for path in out.parent.iterdir()} == {".pdf", ".svg", ".yaml"}
    assert "100 %" in capsys.readouterr().out
    assert cli.main(["board", "--out", str(out)]) == 2
    assert "exists" in capsys.readouterr().err
    assert cli.main(["board", "--out", str(out), "--force", "--page", "a3"]) == 0
    assert Board.load(f"{out}.yaml").hash == board().hash
