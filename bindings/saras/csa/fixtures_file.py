"""Files of virtual fixtures for ordinary teleoperation.

YAML::

    force_limit_N: 1.5        # on a hand, of all fixtures of its side together
    ramp_s: 0.1               # the force moves by at most its limit in this time
    fixtures:
      - {name: table, type: plane, point_m: [0, 0, 0.02], normal: [0, 0, 1], margin_m: 0.002}
      - {name: lane, type: path, side: left, frame: sbs_world, points_m: [[…], […]], radius_m: 0.002, soft: true}

Strict: what is not understood is refused with its place in the file, its value and the bound. See docs/csa.md.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError
from saras.csa import Fixture, FixtureForceConfig, TeleopFixture, TriangleMesh, convex_hull, region_of_interest
from saras.csa.surface import load_mesh

Array = NDArray[np.float64]

SIDES = ("left", "right")
#: Short for mesa_left/sbs_world and mesa_right/sbs_world, each on its own side.
OWN_BASE = "sbs_world"
#: A record of the laws holds each mesh whole.
MAX_TRIANGLES = 20_000
MAX_BYTES = 1 << 20

_COMMON = {"name", "type", "side", "frame", "soft", "stiffness_N_m", "start_m"}
#: Of each type: what must be there, and what may.
_KEYS: dict[str, tuple[set[str], set[str]]] = {
    "plane": ({"point_m", "normal"}, {"margin_m"}),
    "line": ({"point_m", "direction"}, {"radius_m"}),
    "path": ({"points_m"}, {"radius_m"}),
    "hull": ({"points_m"}, {"keep_in", "margin_m"}),
    "region": ({"points_m"}, {"normal"}),
    "mesh": ({"file"}, {"keep_in", "margin_m", "reach_m"}),
}


@dataclass(frozen=True)
class FixtureEntry:
    """One fixture of a file, in its own frame."""

    name: str
    kind: str
    sides: tuple[str, ...]
    frame: str
    soft: bool
    geometry: dict[str, Any]
    """its numbers by their names in the file; a mesh: vertices (v, 3) [m] and triangles (t, 3) too"""
    stiffness_N_m: float
    start_m: float

    def frame_of(self, side: str) -> str:
        """Name of its frame in tf."""
        return f"mesa_{side}/{OWN_BASE}" if self.frame == OWN_BASE else self.frame

    def build(self, base_T_frame: Array) -> TeleopFixture:
        """In the arm's base. base_T_frame: (4, 4). Raises ConfigError."""
        return TeleopFixture(
            fixture=self._fixture(base_T_frame[:3, :3], base_T_frame[:3, 3]),
            stiffness_N_m=self.stiffness_N_m,
            start_m=self.start_m,
        )

    def _fixture(self, turn: Array, shift: Array) -> Fixture:
        given, soft = self.geometry, self.soft
        at = {key: given[key] @ turn.T + shift for key in ("point_m", "points_m", "vertices") if key in given}
        along = {key: turn @ given[key] for key in ("normal", "direction") if key in given}
        margin_m = given.get("margin_m", 0.0)
        if self.kind == "plane":
            return Fixture.plane(self.name, at["point_m"], along["normal"], margin_m, soft)
        if self.kind == "line":
            return Fixture.line(self.name, at["point_m"], along["direction"], given.get("radius_m", 0.0), soft)
        if self.kind == "path":
            return Fixture.path(self.name, list(at["points_m"]), given.get("radius_m", 0.001), soft)
        if self.kind == "hull":
            return Fixture.hull(self.name, convex_hull(at["points_m"]), given.get("keep_in", True), margin_m, soft)
        if self.kind == "region":
            return Fixture.hull(self.name, region_of_interest(at["points_m"], along.get("normal")), soft=soft)
        mesh = TriangleMesh(at["vertices"], given["triangles"])
        reach_m = given.get("reach_m", 0.005)
        return Fixture.mesh(self.name, mesh, given.get("keep_in", False), margin_m, reach_m, soft)


@dataclass(frozen=True)
class FixturesFile:
    """All fixtures of a file."""

    path: Path
    force: FixtureForceConfig
    entries: tuple[FixtureEntry, ...]

    def of(self, side: str) -> tuple[FixtureEntry, ...]:
        """Those of a side, in the order of the file."""
        return tuple(entry for entry in self.entries if side in entry.sides)

    def frames(self, side: str) -> set[str]:
        """Names of the frames that build() asks for."""
        return {entry.frame_of(side) for entry in self.of(side)}

    def build(self, side: str, base_T: Callable[[str], Array]) -> list[TeleopFixture]:
        """In the base of a side's arm. base_T: (4, 4) base_T_frame of a frame's name."""
        return [entry.build(base_T(entry.frame_of(side))) for entry in self.of(side)]


def load(path: str | Path) -> FixturesFile:
    """Reads a file. Raises ConfigError naming file, place, value and bound; OSError when it is not there."""
    try:
        import yaml
    except ImportError:
        raise ImportError("fixtures in YAML need PyYAML: pip install pyyaml") from None
    path = Path(path)
    if path.stat().st_size > MAX_BYTES:
        raise ConfigError(f"{path}: size = {path.stat().st_size} bytes: must be at most {MAX_BYTES} bytes")
    try:
        content = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (yaml.YAMLError, UnicodeDecodeError, RecursionError) as error:
        raise ConfigError(f"{path}: {error}") from None
    try:
        return _read(path, content)
    except ConfigError as error:
        raise ConfigError(f"{path}: {error}") from None


def _read(path: Path, content: Any) -> FixturesFile:
    if not isinstance(content, dict):
        raise ConfigError("must be a mapping with the key fixtures")
    _check_keys(content, {"fixtures"}, {"force_limit_N", "ramp_s"}, "")
    limits = {key: _number(content[key], key) for key in ("force_limit_N", "ramp_s") if key in content}
    given = content["fixtures"]
    if not isinstance(given, list):
        raise ConfigError(f"fixtures = {given!r}: must be a list")
    entries = tuple(_entry(entry, f"fixtures[{i}]", path.parent) for i, entry in enumerate(given))
    read = FixturesFile(path, FixtureForceConfig(**limits), entries)
    for side in SIDES:
        names = [entry.name for entry in read.of(side)]
        for i, name in enumerate(names):
            if name in names[:i]:
                raise ConfigError(f"fixtures: name = {name!r}: must not stand there twice for the {side} side")
        if len(names) > 16:
            raise ConfigError(f"fixtures: count = {len(names)} for the {side} side: must be at most 16")
    return read


def _entry(given: Any, where: str, folder: Path) -> FixtureEntry:
    if not isinstance(given, dict):
        raise ConfigError(f"{where} = {given!r}: must be a mapping")
    kind = _choice(given.get("type"), tuple(_KEYS), f"{where}.type")
    needed, further = _KEYS[kind]
    _check_keys(given, {"name", "type"} | needed, _COMMON | further, f"{where}.")
    geometry = {key: _value(key, given[key], f"{where}.{key}") for key in (needed | further) & set(given)}
    for key in {"normal", "direction"} & set(geometry):
        length = float(np.linalg.norm(geometry[key]))
        if not length > 0.0:
            raise ConfigError(f"{where}.{key} = {given[key]}: must not be zero")
        geometry[key] = geometry[key] / length
    if kind == "mesh":
        geometry["vertices"], geometry["triangles"] = load_mesh(folder / geometry["file"])
        if len(geometry["triangles"]) > MAX_TRIANGLES:
            count = len(geometry["triangles"])
            raise ConfigError(f"{where}.file: triangles = {count}: must be at most {MAX_TRIANGLES}")
    side = _choice(given.get("side", "both"), (*SIDES, "both"), f"{where}.side")
    entry = FixtureEntry(
        name=_text(given["name"], f"{where}.name"),
        kind=kind,
        sides=SIDES if side == "both" else (side,),
        frame=_text(given.get("frame", "world"), f"{where}.frame"),
        soft=_flag(given.get("soft", False), f"{where}.soft"),
        geometry=geometry,
        stiffness_N_m=_number(given.get("stiffness_N_m", 150.0), f"{where}.stiffness_N_m"),
        start_m=_number(given.get("start_m", 0.003), f"{where}.start_m"),
    )
    try:
        entry.build(np.eye(4))
    except ConfigError as error:
        raise ConfigError(f"{where}: {error}") from None
    return entry


def _check_keys(given: dict[Any, Any], needed: set[str], further: set[str], where: str) -> None:
    for key in sorted(map(str, set(given) - needed - further)):
        raise ConfigError(f"{where}{key}: unknown entry: must be one of {', '.join(sorted(needed | further))}")
    for key in sorted(needed - set(given)):
        raise ConfigError(f"{where}{key}: is missing")


def _value(key: str, given: Any, where: str) -> Any:
    if key == "points_m":
        if not isinstance(given, list) or not given:
            raise ConfigError(f"{where} = {given!r}: must be a list of points")
        return np.array([_vector(point, f"{where}[{i}]") for i, point in enumerate(given)])
    if key in ("point_m", "normal", "direction"):
        return _vector(given, where)
    if key == "file":
        return _text(given, where)
    return _flag(given, where) if key == "keep_in" else _number(given, where)


def _vector(given: Any, where: str) -> Array:
    if not isinstance(given, list) or len(given) != 3:
        raise ConfigError(f"{where} = {given!r}: must be a list of 3 numbers")
    return np.array([_number(number, f"{where}[{i}]") for i, number in enumerate(given)])


def _number(given: Any, where: str) -> float:
    if isinstance(given, bool) or not isinstance(given, (int, float)) or not math.isfinite(given):
        raise ConfigError(f"{where} = {given!r}: must be a finite number")
    return float(given)


def _flag(given: Any, where: str) -> bool:
    if not isinstance(given, bool):
        raise ConfigError(f"{where} = {given!r}: must be true or false")
    return given


def _text(given: Any, where: str) -> str:
    if not isinstance(given, str) or not given:
        raise ConfigError(f"{where} = {given!r}: must be a text")
    return given


def _choice(given: Any, choices: tuple[str, ...], where: str) -> str:
    if given not in choices:
        raise ConfigError(f"{where} = {given!r}: must be one of {', '.join(choices)}")
    return str(given)
