"""Gains by name over a service: all of a call are taken, or none."""

from __future__ import annotations

import math
from typing import Callable

import rospy

from saras import ConfigError
from saras_ros1.srv import SetGains, SetGainsResponse


class Gains:
    """Serves `topic`. apply(gains): builds anew with all gains that were ever set; raises ConfigError."""

    def __init__(self, topic: str, known: tuple[str, ...], apply: Callable[[dict[str, float]], None]) -> None:
        self.values: dict[str, float] = {}
        self._known, self._apply = known, apply
        rospy.Service(topic, SetGains, self._on_call)

    def _on_call(self, request: SetGains) -> SetGainsResponse:
        if len(request.names) != len(request.values) or not request.names:
            return SetGainsResponse(False, "names and values must be as many, at least one")
        for name, value in zip(request.names, request.values):
            if name not in self._known:
                return SetGainsResponse(False, f"{name}: must be one of {', '.join(self._known)}")
            if not math.isfinite(value):
                return SetGainsResponse(False, f"{name} = {value}: must be finite")
        wanted = {**self.values, **dict(zip(request.names, request.values))}
        try:
            self._apply(wanted)
        except ConfigError as error:
            return SetGainsResponse(False, str(error))
        self.values = wanted
        return SetGainsResponse(True, ", ".join(f"{name} = {value:g}" for name, value in wanted.items()))
