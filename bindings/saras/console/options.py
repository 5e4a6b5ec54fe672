"""Device options are strings (``--option key=value``); these turn them into checked values, naming what is wrong."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

from saras import ConfigError


def number(options: Mapping[str, str], name: str, default: float, lowest: float, highest: float) -> float:
    """A finite number in [lowest, highest]."""
    text = options.get(name)
    if text is None:
        return default
    try:
        value = float(text)
    except ValueError:
        raise ConfigError(f"{name} = {text!r}: must be a number") from None
    if not math.isfinite(value) or not lowest <= value <= highest:
        raise ConfigError(f"{name} = {text}: must be in [{lowest:g}, {highest:g}]")
    return value


def integer(options: Mapping[str, str], name: str, default: int, lowest: int, highest: int) -> int:
    """A whole number in [lowest, highest]."""
    text = options.get(name)
    try:
        value = default if text is None else int(text)
    except ValueError:
        raise ConfigError(f"{name} = {text!r}: must be a whole number") from None
    if not lowest <= value <= highest:
        raise ConfigError(f"{name} = {value}: must be in [{lowest}, {highest}]")
    return value


def choice(options: Mapping[str, str], name: str, default: str, values: Iterable[str]) -> str:
    """One of the given words."""
    value = options.get(name, default)
    allowed = list(values)
    if value not in allowed:
        raise ConfigError(f"{name} = {value!r}: must be one of {', '.join(allowed)}")
    return value


def refuse_unknown(options: Mapping[str, str], known: Iterable[str], device: str) -> None:
    """A misspelt option is an error, not ignored."""
    allowed = set(known)
    for name in options:
        if name not in allowed:
            raise ConfigError(f"device {device} has no option {name!r}; it knows {', '.join(sorted(allowed))}")
