"""Recording of a law's steps as flat numbers, so that a run can be replayed exactly (see ``saras.replay``).

No ROS in here: a node wraps its law in a :class:`TracedLaw`, steps it, and gathers ``law.tick`` for a
``saras_ros1/LawTicks``::

    law, batch = TracedLaw(EnergyTank, config, 2, name="tank_master"), TickBatch()
    output = law.step(desired=…, conjugate=…, dt=dt)       # keywords only
    batch.add(law.tick, time_s)
    publisher.publish(LawTicks(header=…, **batch.take()))

Values are flattened in field order: numbers and flags as one float64, arrays row by row, structs recursively.
"""

from __future__ import annotations

import json
from typing import Any, NamedTuple

import numpy as np

from saras import Error

STATE_UNCHANGED, STATE_PERIODIC, STATE_SET = 0, 1, 2
STATE_PERIOD_TICKS = 100
_FLOAT = np.dtype(float)

Layout = list[list[Any]]  #: one [name, kind, shape] an argument; kind: number, flag, integer, array, none

LayoutKey = tuple[tuple[str, str, tuple[int, ...]], ...]  #: the same, hashable


class Tick(NamedTuple):
    """One step of a law in flat numbers."""

    seq: int
    dt: float
    layout: int
    state_flag: int
    input: list[float]
    output: list[float]
    state: list[float]


class TickBatch:
    """Consecutive ticks, gathered into the fields of one ``saras_ros1/LawTicks``."""

    def __init__(self) -> None:
        self._ticks: list[Tick] = []
        self._times_s: list[float] = []

    def __len__(self) -> int:
        return len(self._ticks)

    def add(self, tick: Tick | None, time_s: float) -> None:
        """A step and its time of day [s]."""
        if tick is not None:
            self._ticks.append(tick)
            self._times_s.append(time_s)

    def take(self) -> dict[str, Any] | None:
        """The fields of the message; the batch is empty afterwards. None when it was."""
        ticks, times_s = self._ticks, self._times_s
        self._ticks, self._times_s = [], []
        if not ticks:
            return None
        return {
            "first_seq": ticks[0].seq,
            "time_s": times_s,
            "dt": [tick.dt for tick in ticks],
            "layout": [tick.layout for tick in ticks],
            "state_flag": bytes(tick.state_flag for tick in ticks),
            "input_size": [len(tick.input) for tick in ticks],
            "output_size": [len(tick.output) for tick in ticks],
            "state_size": [len(tick.state) for tick in ticks],
            "input": [number for tick in ticks for number in tick.input],
            "output": [number for tick in ticks for number in tick.output],
            "state": [number for tick in ticks for number in tick.state],
        }


def unpack(message: dict[str, Any]) -> list[tuple[float, Tick]]:
    """(time of day [s], step) of one recorded ``saras_ros1/LawTicks``. Inverse of TickBatch.

    Raises saras.Error when the numbers are fewer than the steps need.
    """
    flags = np.frombuffer(bytes(message["state_flag"]), dtype=np.uint8).tolist()
    columns = {name: np.asarray(message[name], dtype=float).tolist() for name in ("input", "output", "state")}
    at = dict.fromkeys(columns, 0)
    ticks = []
    for i, dt in enumerate(message["dt"]):
        parts = []
        for name, numbers in columns.items():
            end = at[name] + int(message[f"{name}_size"][i])
            if end > len(numbers):
                raise Error(f"step {i} of {len(message['dt'])} needs {end} numbers of {name}, got {len(numbers)}")
            parts.append(numbers[at[name] : end])
            at[name] = end
        seq = int(message["first_seq"]) + i
        ticks.append((float(message["time_s"][i]), Tick(seq, float(dt), int(message["layout"][i]), flags[i], *parts)))
    return ticks


class TracedLaw:
    """A law that remembers its last step as a :class:`Tick`. Everything else is passed on to the law.

    Parameters: the law's class, then its constructor's arguments, which become part of ``info``.
    """

    def __init__(self, law_class: type, *args: Any, name: str = "", **kwargs: Any) -> None:
        self._law = law_class(*args, **kwargs)
        self._description = {
            "name": name,
            "law": f"{_public_module(law_class)}.{law_class.__name__}",
            "args": [to_plain(value) for value in args],
            "kwargs": {key: to_plain(value) for key, value in kwargs.items()},
        }
        self._layouts: list[Layout] = []
        self._layout_indices: dict[LayoutKey, int] = {}
        self._seq = 0
        self._state_set = True
        self.tick: Tick | None = None

    def step(self, *, dt: float, **inputs: Any) -> Any:
        """Steps the law; the arguments, the output and (now and then) the state before are in ``tick``."""
        flag = STATE_SET if self._state_set else STATE_UNCHANGED
        if flag == STATE_UNCHANGED and self._seq % STATE_PERIOD_TICKS == 0:
            flag = STATE_PERIODIC
        state = flatten(self._law.state) if flag != STATE_UNCHANGED else []
        output = self._law.step(dt=dt, **inputs)
        layout, flat_input = describe(inputs)
        self.tick = Tick(self._seq, dt, self._layout_index(layout), flag, flat_input, flatten(output), state)
        self._seq += 1
        self._state_set = False
        return output

    @property
    def info(self) -> str:
        """JSON for ``/laws/<name>/info``. It grows when an argument changes its shape: publish it (latched) again
        whenever it differs from what was published last.
        """
        return json.dumps({**self._description, "layouts": self._layouts})

    def _layout_index(self, layout: LayoutKey) -> int:
        index = self._layout_indices.get(layout)
        if index is None:
            index = self._layout_indices[layout] = len(self._layouts)
            self._layouts.append([[name, kind, list(shape)] for name, kind, shape in layout])
        return index

    def __getattr__(self, name: str) -> Any:
        value = getattr(self._law, name)
        if callable(value):
            # Any method beside step may change the state: the next tick carries it.
            self._state_set = True
        return value


def flatten(value: Any) -> list[float]:
    """The numbers of a value in field order. None gives nothing."""
    numbers: list[float] = []
    _append(value, numbers)
    return numbers


def _append(value: Any, numbers: list[float]) -> None:
    """Exact types first: this runs for every field of every step."""
    kind = type(value)
    if kind is np.ndarray:
        numbers.extend((value if value.dtype == _FLOAT else value.astype(float)).ravel().tolist())
    elif kind is float:
        numbers.append(value)
    elif kind is bool or kind is int:
        numbers.append(float(value))
    elif value is None:
        return
    elif hasattr(kind, "_numbers"):  # a struct of the core
        numbers.extend(value._numbers())
    elif hasattr(kind, "_fields"):
        for field in value._fields:
            _append(getattr(value, field), numbers)
    elif isinstance(value, np.generic):
        numbers.append(float(value.item()))
    elif isinstance(value, (list, tuple)):
        for item in value:
            _append(item, numbers)
    elif hasattr(value, "value"):  # an enumeration such as saras.Status
        numbers.append(float(int(value.value)))
    else:
        raise TypeError(f"cannot flatten {kind.__name__}")


def describe(inputs: dict[str, Any]) -> tuple[LayoutKey, list[float]]:
    """Layout and numbers of keyword arguments."""
    layout: list[tuple[str, str, tuple[int, ...]]] = []
    numbers: list[float] = []
    for name, value in inputs.items():
        kind = _KINDS.get(type(value))
        if kind is None:
            value = np.asarray(value, dtype=float)
            kind = "array"
        layout.append((name, kind, value.shape if kind == "array" else ()))
        _append(value, numbers)
    return tuple(layout), numbers


_KINDS = {
    type(None): "none",
    bool: "flag",
    np.bool_: "flag",
    int: "integer",
    np.int64: "integer",
    float: "number",
    np.float64: "number",
    np.ndarray: "array",
}


def to_plain(value: Any) -> Any:
    """JSON-ready form of a constructor argument; structs become {"type": …, "fields": {…}}."""
    if hasattr(value, "_fields"):
        return {
            "type": f"{_public_module(type(value))}.{type(value).__name__}",
            "fields": {field: to_plain(getattr(value, field)) for field in value._fields},
        }
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [to_plain(item) for item in value]
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if hasattr(value, "name") and hasattr(type(value), "__members__"):
        return {"type": f"{_public_module(type(value))}.{type(value).__name__}", "member": value.name}
    raise TypeError(f"cannot record an argument of type {type(value).__name__}")


def _public_module(cls: type) -> str:
    """saras.teleop for classes that pybind11 calls saras._core.teleop."""
    return cls.__module__.replace("saras._core", "saras")
