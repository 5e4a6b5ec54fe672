"""Typed parameters: what is missing, not finite, of the wrong type, out of range or unknown refuses the start.

    params = Params(rospy.get_param("~"), "/tank_master")
    config = params.build(EnergyTankConfig, "tank")      # every field of the Config must stand in the file
    period_s = params.number("period_s", 0.001, 0.1)
    params.finish()                                      # a key that nobody read is a mistake (a typo, mostly)

Errors are saras.ConfigError and name parameter, value and bound.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from saras import ConfigError


class Params:
    """A parameter namespace, read key by key.

    values: the namespace as a dict; where: its name, for messages.
    """

    def __init__(self, values: Any, where: str) -> None:
        if not isinstance(values, Mapping) or not values:
            raise ConfigError(f"{where}: no parameters there: load the file of config/ that has them")
        self._values = dict(values)
        self._where = where
        self._unread = set(self._values)
        self._sections: list[Params] = []

    def _take(self, name: str) -> Any:
        if name not in self._values:
            raise ConfigError(f"{self._where}/{name}: missing")
        self._unread.discard(name)
        return self._values[name]

    def has(self, name: str) -> bool:
        """Whether the key stands in the file."""
        return name in self._values

    def skip(self, name: str) -> None:
        """A key that is known but not wanted now."""
        self._take(name)

    def number(self, name: str, low: float = -math.inf, high: float = math.inf) -> float:
        """A finite number in [low, high]."""
        return _number(self._take(name), f"{self._where}/{name}", low, high)

    def integer(self, name: str, low: int, high: int) -> int:
        """A whole number in [low, high]."""
        value = self._take(name)
        if isinstance(value, bool) or not isinstance(value, int):
            raise ConfigError(f"{self._where}/{name} = {value!r}: must be a whole number")
        return int(_number(value, f"{self._where}/{name}", low, high))

    def flag(self, name: str) -> bool:
        """True or false."""
        value = self._take(name)
        if not isinstance(value, bool):
            raise ConfigError(f"{self._where}/{name} = {value!r}: must be true or false")
        return value

    def text(self, name: str, choices: tuple[str, ...] = (), empty: bool = False) -> str:
        """A string, one of `choices` when given."""
        value = self._take(name)
        if not isinstance(value, str) or (not value and not empty):
            raise ConfigError(f"{self._where}/{name} = {value!r}: must be text")
        if choices and value not in choices:
            raise ConfigError(f"{self._where}/{name} = {value!r}: must be one of {', '.join(choices)}")
        return value

    def vector(self, name: str, length: int, low: float = -math.inf, high: float = math.inf) -> np.ndarray:
        """(length,) finite numbers in [low, high]."""
        return _vector(self._take(name), f"{self._where}/{name}", length, low, high)

    def texts(self, name: str) -> list[str]:
        """A list of strings."""
        value = self._take(name)
        if not isinstance(value, list) or not all(isinstance(item, str) for item in value):
            raise ConfigError(f"{self._where}/{name} = {value!r}: must be a list of texts")
        return list(value)

    def section(self, name: str) -> Params:
        """A nested namespace; its unread keys are refused by `finish` too."""
        child = Params(self._take(name), f"{self._where}/{name}")
        self._sections.append(child)
        return child

    def build(self, config_class: type, name: str, **given: Any) -> Any:
        """A law's Config from the nested namespace `name`: each of its fields, no other.

        given: fields that the node knows itself and that must not stand in the file (frames, mostly).
        """
        section = self.section(name)
        template = config_class()
        fields = {f: section._field(f, getattr(template, f)) for f in config_class._fields if f not in given}
        section.finish()
        try:
            return config_class(**fields, **given)
        except ConfigError as error:
            raise ConfigError(f"{self._where}/{name}: {error}") from None

    def _field(self, name: str, like: Any) -> Any:
        """The value of a Config field, of the type that its default has."""
        path = f"{self._where}/{name}"
        if isinstance(like, bool):
            return self.flag(name)
        if isinstance(like, int):
            return self.integer(name, -(2**53), 2**53)
        if isinstance(like, float):
            return self.number(name)
        if isinstance(like, str):
            return self.text(name)
        if isinstance(like, np.ndarray) and like.ndim == 1:
            return self.vector(name, like.size)
        if isinstance(like, np.ndarray):
            rows, columns = like.shape
            return np.reshape(_vector(self._take(name), path, rows * columns, -math.inf, math.inf), like.shape)
        members = getattr(type(like), "__members__", None)
        if members is not None:
            by_text = {member.lower(): value for member, value in members.items()}
            return by_text[self.text(name, tuple(by_text))]
        if hasattr(type(like), "_fields"):
            return self.build(type(like), name)
        raise ConfigError(f"{path}: a field of type {type(like).__name__} cannot be read from parameters")

    def finish(self) -> None:
        """Refuses keys that nothing has read."""
        if self._unread:
            raise ConfigError(f"{self._where}/{sorted(self._unread)[0]}: unknown parameter")
        for section in self._sections:
            section.finish()


def _number(value: Any, path: str, low: float, high: float) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise ConfigError(f"{path} = {value!r}: must be a number")
    if not math.isfinite(value):
        raise ConfigError(f"{path} = {value}: must be finite")
    if not low <= value <= high:
        raise ConfigError(f"{path} = {value}: must be in [{low:g}, {high:g}]")
    return float(value)


def _vector(value: Any, path: str, length: int, low: float, high: float) -> np.ndarray:
    if not isinstance(value, (list, tuple)) or len(value) != length:
        raise ConfigError(f"{path} = {value!r}: must be a list of {length} numbers")
    return np.array([_number(item, f"{path}[{i}]", low, high) for i, item in enumerate(value)])
