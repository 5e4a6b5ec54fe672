"""Make the calibration board: PDF and SVG at true scale, and the YAML that names its dots and markers.

saras board                        saras_board.pdf, .svg and .yaml in the current directory
saras board --out lab/board --page a3
"""

from __future__ import annotations

import argparse
from pathlib import Path

from saras import ConfigError
from saras._core.calibration import BoardConfig
from saras.calibration.board import Board
from saras.calibration.printing import PAGES, SCALE_BAR_MM, board_page


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds what the board and its page can be."""
    defaults = BoardConfig()
    parser.add_argument(
        "--out", type=Path, default=Path("saras_board"), help="path without suffix (default %(default)s)"
    )
    parser.add_argument("--page", choices=sorted(PAGES), default="a4", help="paper, lying (default %(default)s)")
    parser.add_argument("--force", action="store_true", help="write over existing files")
    for name in ("dot_circle_radius_m", "dot_diameter_m", "marker_circle_radius_m", "marker_side_m"):
        option = "--" + name.replace("_", "-")
        parser.add_argument(option, type=float, default=getattr(defaults, name), help="default %(default)s")
    parser.add_argument("--marker-ids", type=int, nargs="+", default=[0, 1, 2, 3], metavar="ID", help="of DICT_4X4_50")


def run(arguments: argparse.Namespace) -> int:
    """Exit code; refused input is a saras.Error."""
    config = BoardConfig(
        dot_circle_radius_m=arguments.dot_circle_radius_m,
        dot_diameter_m=arguments.dot_diameter_m,
        marker_circle_radius_m=arguments.marker_circle_radius_m,
        marker_side_m=arguments.marker_side_m,
    )
    board = Board(config, tuple(arguments.marker_ids))
    page = board_page(board, arguments.page)
    paths = {suffix: Path(f"{arguments.out}.{suffix}") for suffix in ("pdf", "svg", "yaml")}
    there = [path for path in paths.values() if path.exists()]
    if there and not arguments.force:
        raise ConfigError(f"{there[0]}: exists; --force writes over it")
    paths["pdf"].parent.mkdir(parents=True, exist_ok=True)
    paths["pdf"].write_bytes(page.pdf())
    paths["svg"].write_text(page.svg(), encoding="utf-8")
    board.save(paths["yaml"])
    print(f"{', '.join(str(path) for path in paths.values())}: board {board.hash}")
    print(f"Print the PDF on {arguments.page.upper()} at 100 % (no fitting to the page), glue it onto something flat,")
    print(f"and measure both bars: {SCALE_BAR_MM:.1f} mm within 0.2 mm, or every length of the calibration is wrong.")
    return 0
