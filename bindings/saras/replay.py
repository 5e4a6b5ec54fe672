"""Runs the laws again on their recorded inputs and compares with what they put out then.

Needs the steps that nodes record on ``/laws/*`` (launch argument ``trace_laws``): arguments, time step and output of
every step, and now and then the state. From the first recorded state on, a law runs on its own; at a gap it waits for
the next recorded state. The same library gives the same numbers: within BOUND, because poses in configurations and
states pass through matrices, and exactly 0 otherwise.
"""

from __future__ import annotations

import argparse
import importlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from saras import Error
from saras.law_trace import STATE_SET, STATE_UNCHANGED, Layout, flatten, unpack
from saras.recording import Session, Topic

BOUND = 1e-12  #: largest difference that counts as equal [SI units of the output]
LAW_PREFIX = "/laws/"
SIZES = ("input_size", "output_size", "state_size")


@dataclass(frozen=True)
class Comparison:
    """One law's replay."""

    name: str
    law: str
    ticks: int  #: recorded
    compared: int
    skipped: int  #: after a gap, until a state was recorded
    exact: int  #: of the compared ones, bit for bit
    worst: float  #: largest |recorded - replayed|
    worst_field: str
    worst_t: float

    @property
    def agrees(self) -> bool:
        """Whether something was compared and nothing differs by more than BOUND."""
        return self.compared > 0 and self.worst <= BOUND


def replay(session: Session) -> list[Comparison]:
    """Replays every recorded law. Empty when none was recorded."""
    results = []
    for name in sorted(session.topics):
        if name.startswith(LAW_PREFIX) and not name.endswith("/info"):
            ticks, info = session.topic(name), session.topic(f"{name}/info")
            if ticks is None:
                continue
            if info is None:
                raise Error(f"{name}: {name}/info was not recorded, so the numbers have no meaning")
            results.append(replay_law(ticks, json.loads(str(info["data"][-1]))))
    return results


def replay_law(ticks: Topic, info: dict[str, Any]) -> Comparison:
    """Replays one law from its ticks (saras_ros1/LawTicks) and its description."""
    names = ("first_seq", "time_s", "dt", "layout", "state_flag", *SIZES, "input", "output", "state")
    columns = {name: ticks[name] for name in names}
    steps = [
        (float(ticks.t[i]) + time_s - float(columns["time_s"][i][-1]), tick)  # since the session's start
        for i in range(len(ticks))
        for time_s, tick in unpack({name: column[i] for name, column in columns.items()})
    ]
    law = build_law(info)
    layouts: list[Layout] = info["layouts"]
    running = False
    next_seq = -1
    compared = exact = 0
    worst, worst_field, worst_t = 0.0, "", float("nan")
    for time_s, tick in steps:
        seq, flag, state = tick.seq, tick.state_flag, tick.state
        running = running and seq == next_seq
        next_seq = seq + 1
        if flag == STATE_SET or (not running and flag != STATE_UNCHANGED):
            law.reset(unflatten(law.state, np.asarray(state, dtype=float)))
            running = True
        if not running:
            continue
        inputs = restore(layouts[tick.layout], np.asarray(tick.input, dtype=float))
        output = law.step(dt=tick.dt, **inputs)
        replayed = np.array(flatten(output))
        recorded = np.asarray(tick.output, dtype=float)
        compared += 1
        if np.array_equal(recorded, replayed, equal_nan=True):
            exact += 1
            continue
        difference, place = _difference(recorded, replayed)
        if difference > worst:
            worst, worst_field, worst_t = difference, _field_at(output, place), time_s
    skipped = len(steps) - compared
    return Comparison(info["name"], info["law"], len(steps), compared, skipped, exact, worst, worst_field, worst_t)


def build_law(info: dict[str, Any]) -> Any:
    """The law that a description names, constructed with its recorded arguments."""
    args = [from_plain(value) for value in info["args"]]
    kwargs = {key: from_plain(value) for key, value in info["kwargs"].items()}
    return _saras_type(info["law"])(*args, **kwargs)


def from_plain(value: Any) -> Any:
    """Inverse of saras.law_trace.to_plain."""
    if isinstance(value, dict) and "member" in value:
        return getattr(_saras_type(value["type"]), value["member"])
    if isinstance(value, dict) and "fields" in value:
        return _saras_type(value["type"])(**{key: from_plain(field) for key, field in value["fields"].items()})
    if isinstance(value, list):
        return [from_plain(item) for item in value]
    return value


def restore(layout: Layout, numbers: np.ndarray[Any, np.dtype[np.float64]]) -> dict[str, Any]:
    """Keyword arguments from their flat numbers. Inverse of saras.law_trace.describe."""
    inputs: dict[str, Any] = {}
    at = 0
    for name, kind, shape in layout:
        size = int(np.prod(shape)) if kind == "array" else 0 if kind == "none" else 1
        part = numbers[at : at + size]
        if len(part) != size:
            raise Error(f"recorded input of {len(numbers)} numbers is shorter than its layout")
        at += size
        if kind == "array":
            inputs[name] = part.reshape(shape)
        elif kind == "none":
            inputs[name] = None
        else:
            inputs[name] = {"number": float, "integer": int, "flag": bool}[kind](part[0])
    return inputs


def unflatten(prototype: Any, numbers: np.ndarray[Any, np.dtype[np.float64]]) -> Any:
    """A value of the prototype's type and shapes, filled from flat numbers. Inverse of saras.law_trace.flatten."""
    stream = iter(numbers.tolist())
    try:
        value = _take(prototype, stream)
    except StopIteration:
        raise Error(f"{len(numbers)} recorded numbers are too few for {type(prototype).__name__}") from None
    if next(stream, None) is not None:
        raise Error(f"{len(numbers)} recorded numbers are too many for {type(prototype).__name__}")
    return value


def _take(prototype: Any, stream: Iterator[float]) -> Any:
    if hasattr(prototype, "_fields"):
        fields = {field: _take(getattr(prototype, field), stream) for field in prototype._fields}
        return type(prototype)(**fields)
    if isinstance(prototype, np.ndarray):
        flat = [next(stream) for _ in range(prototype.size)]
        return np.array(flat).reshape(prototype.shape)
    if isinstance(prototype, (list, tuple)):
        return [_take(item, stream) for item in prototype]
    if isinstance(prototype, (bool, int, float)):
        return type(prototype)(next(stream))
    if hasattr(type(prototype), "__members__"):
        return type(prototype)(int(next(stream)))
    raise Error(f"cannot restore a {type(prototype).__name__}")


def _saras_type(name: str) -> Any:
    """A class of this package. A recording is data: it must not choose what else is imported."""
    module, _, cls = name.rpartition(".")
    if module.split(".")[0] != "saras":
        raise Error(f"the recording names {name!r}, which is no law of saras")
    try:
        return getattr(importlib.import_module(module), cls)
    except (ImportError, AttributeError):
        raise Error(f"this version of saras has no {name}") from None


def _difference(recorded: Any, replayed: Any) -> tuple[float, int]:
    """(largest difference, its place); infinite where one has a number and the other none."""
    if recorded.shape != replayed.shape:
        return float("inf"), 0
    both_nan = np.isnan(recorded) & np.isnan(replayed)
    with np.errstate(invalid="ignore"):
        difference = np.where((recorded == replayed) | both_nan, 0.0, np.abs(recorded - replayed))
    difference = np.where(np.isnan(difference), np.inf, difference)
    return float(difference.max()), int(difference.argmax())


def _field_at(output: Any, place: int) -> str:
    """Name of the output's field that holds the number at ``place``."""
    for field in output._fields:
        size = sum(1 for _ in flatten(getattr(output, field)))
        if place < size:
            return f"{field}[{place}]" if size > 1 else str(field)
        place -= size
    return "?"


def replay_bag(path: str | Path) -> list[Comparison]:
    """Opens a bag and replays its laws; saras.Error when it holds none."""
    with Session.open(path) as session:
        results = replay(session)
    if not results:
        raise Error(f"{path}: no law steps recorded on {LAW_PREFIX}*: record with trace_laws:=true")
    return results


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of ``saras replay``."""
    parser.description = "Runs the laws again on a recording's inputs and compares their outputs."
    parser.add_argument("bag", type=Path, help="a bag recorded with trace_laws:=true")


def run(arguments: argparse.Namespace) -> int:
    """Exit code 0 when every recorded law gives its recorded outputs within BOUND."""
    results = replay_bag(arguments.bag)
    width = max(len(result.name) for result in results)
    print(f"{'law':<{width}}  {'ticks':>7} {'compared':>8} {'exact':>7} {'worst difference':>17}")
    for result in results:
        where = f"  in {result.worst_field} at {result.worst_t:.3f} s" if result.worst > 0 else ""
        mark = "" if result.agrees else "   DIFFERS" if result.compared else "   NOT COMPARED"
        counts = f"{result.ticks:>7} {result.compared:>8} {result.exact:>7}"
        print(f"{result.name:<{width}}  {counts} {result.worst:>17.1e}{where}{mark}")
    bad = [result.name for result in results if not result.agrees]
    print(f"bound {BOUND:.0e}: " + (f"not met by {', '.join(bad)}" if bad else "met by all laws"))
    return 1 if bad else 0
