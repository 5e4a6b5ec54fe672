"""The calibration board: its geometry, the YAML that names dots and markers, its print at true scale."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras._core.calibration import BoardConfig, dot_centers, marker_corners

Array = npt.NDArray[np.float64]

FORMAT = "saras-board"
VERSION = 1
DICTIONARY = "DICT_4X4_50"

#: Inner cells of the markers of DICT_4X4_50 that a board may carry, row by row; 1 is white. The border is black.
MARKER_CELLS = {
    0: "1011010100110010",
    1: "0000111110011010",
    2: "0011001100101101",
    3: "1001100101000110",
    4: "0101010010011110",
    5: "0111100111001101",
    6: "1001111000101110",
    7: "1100010011110010",
}


@dataclass(frozen=True)
class Board:
    """Dots (touched by the arms) and ArUco markers (seen by the endoscope) in one frame.

    The board's frame: origin in the circle's centre, x to dot 1, y to 90 degrees, z out of the print.
    """

    config: BoardConfig = field(default_factory=BoardConfig)
    marker_ids: tuple[int, ...] = (0, 1, 2, 3)
    """Of DICT_4X4_50, in the order of config.marker_angles_deg."""

    def __post_init__(self) -> None:
        dot_centers(self.config)  # validates
        if len(set(self.marker_ids)) != len(self.config.marker_angles_deg):
            count = len(self.config.marker_angles_deg)
            raise ConfigError(f"marker_ids = {list(self.marker_ids)}: must be {count} different ones")
        unknown = [i for i in self.marker_ids if i not in MARKER_CELLS]
        if unknown:
            raise ConfigError(f"marker_ids = {unknown[0]}: must be in [0, {len(MARKER_CELLS) - 1}]")

    @property
    def dots(self) -> Array:
        """(n, 3) centres of the dots [m], dot 1 first."""
        centers: Array = dot_centers(self.config)
        return centers

    @property
    def markers(self) -> dict[int, Array]:
        """(4, 3) corners [m] of each marker by its id: upper left, upper right, lower right, lower left."""
        return dict(zip(self.marker_ids, marker_corners(self.config)))

    @property
    def hash(self) -> str:
        """16 characters that any change of the geometry changes: a calibration names its board by it."""
        text = json.dumps([self.dots.round(7).tolist(), {i: c.round(7).tolist() for i, c in self.markers.items()}])
        return hashlib.sha256(text.encode()).hexdigest()[:16]

    def document(self) -> dict[str, Any]:
        """What the YAML holds."""
        config = self.config
        return {
            "format": FORMAT,
            "version": VERSION,
            "hash": self.hash,
            "dictionary": DICTIONARY,
            "geometry": {
                "dot_circle_radius_m": config.dot_circle_radius_m,
                "dot_diameter_m": config.dot_diameter_m,
                "dot_angles_deg": list(config.dot_angles_deg),
                "marker_circle_radius_m": config.marker_circle_radius_m,
                "marker_side_m": config.marker_side_m,
                "marker_angles_deg": list(config.marker_angles_deg),
                "marker_ids": list(self.marker_ids),
            },
            # For the reader, and for other programs: what follows from the geometry.
            "dots_m": {f"dot_{i}": _numbers(dot) for i, dot in enumerate(self.dots, start=1)},
            "marker_corners_m": {f"marker_{i}": [_numbers(c) for c in cs] for i, cs in self.markers.items()},
        }

    def save(self, path: str | Path) -> None:
        """Writes the YAML."""
        import yaml

        text = "# The calibration board. Frame: origin in the circle's centre, x to dot 1, z out of the print.\n"
        document = yaml.safe_dump(self.document(), sort_keys=False, default_flow_style=None, width=110)
        Path(path).write_text(text + document, encoding="utf-8")

    @staticmethod
    def load(path: str | Path) -> Board:
        """Reads the YAML. Raises ConfigError naming what is missing or does not fit; OSError."""
        import yaml

        try:
            document = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        except (yaml.YAMLError, UnicodeDecodeError) as error:
            raise ConfigError(f"{path}: {error}") from None
        return Board.of(document, str(path))

    @staticmethod
    def of(document: Any, where: str = "board") -> Board:
        """The board of a loaded YAML. Raises ConfigError."""
        if not isinstance(document, dict) or document.get("format") != FORMAT:
            raise ConfigError(f"{where}: format: must be {FORMAT!r}")
        if document.get("version") != VERSION:
            raise ConfigError(f"{where}: version = {document.get('version')!r}: must be {VERSION}")
        if document.get("dictionary") != DICTIONARY:
            raise ConfigError(f"{where}: dictionary = {document.get('dictionary')!r}: must be {DICTIONARY!r}")
        geometry = document.get("geometry")
        if not isinstance(geometry, dict):
            raise ConfigError(f"{where}: geometry: missing")
        names = set(BoardConfig._fields) | {"marker_ids"}
        if set(geometry) != names:
            wrong = sorted(set(geometry) ^ names)[0]
            raise ConfigError(f"{where}: geometry/{wrong}: {'unknown' if wrong in geometry else 'missing'}")
        values = dict(geometry)
        ids = values.pop("marker_ids")
        try:
            board = Board(BoardConfig(**values), tuple(int(i) for i in ids))
        except (TypeError, ConfigError) as error:
            raise ConfigError(f"{where}: geometry: {error}") from None
        if document.get("hash") != board.hash:
            raise ConfigError(f"{where}: hash = {document.get('hash')!r}: its geometry gives {board.hash!r}: edited?")
        return board


def marker_cells(marker_id: int) -> npt.NDArray[np.bool_]:
    """(6, 6) cells of a marker with its border, True where it is black; row 0 is the upper one."""
    cells = np.ones((6, 6), dtype=bool)
    cells[1:5, 1:5] = np.array([cell == "0" for cell in MARKER_CELLS[marker_id]]).reshape(4, 4)
    return cells


def board(**geometry: Any) -> Board:
    """The board of the source document, with changes of BoardConfig's fields, or marker_ids. Raises ConfigError."""
    ids = tuple(geometry.pop("marker_ids", (0, 1, 2, 3)))
    return Board(BoardConfig(**geometry), ids)


def _numbers(vector: Array) -> list[float]:
    return [round(float(value), 7) + 0.0 for value in vector]


__all__ = ["DICTIONARY", "FORMAT", "MARKER_CELLS", "VERSION", "Board", "board", "marker_cells"]
