"""The wrench that a tip exerts on tissue, from the best source at hand."""

from __future__ import annotations

import numpy as np
from geometry_msgs.msg import WrenchStamped

from saras.mesa_link import State
from saras.teleop import DisturbanceObserver, DisturbanceObserverConfig
from saras_ros1 import convert
from saras_ros1.channel import base_frame
from saras_ros1.node import Node

SOURCES = ("auto", "sensor", "contact", "observer")


class ExertedWrench:
    """auto: the arm's sensor, else a fresh /contact_force/{side}/wrench, else the observer on the servo model."""

    def __init__(
        self, node: Node, side: str, source: str, timeout_s: float, observer: DisturbanceObserverConfig
    ) -> None:
        self.source = source
        self.used = "none"
        self._observer = node.law(f"disturbance_observer_{side}", DisturbanceObserver, observer)
        self._tick: int | None = None
        read = convert.in_frame(base_frame(side), convert.wrench)
        # Its watchdog is this class's business: the topic may well not exist.
        self._contact = node.input(f"/contact_force/{side}/wrench", WrenchStamped, read)
        self._timeout_s = timeout_s

    def step(self, state: State) -> np.ndarray | None:
        """(6,) in the base frame; None: unknown, which is not zero. To be called with every state."""
        observed = self._observe(state)
        candidates = {
            "sensor": None if state.wrench is None else np.array(state.wrench),
            "contact": self._contact.value if self._contact.age_s <= self._timeout_s else None,
            "observer": observed,
        }
        for name in SOURCES[1:] if self.source == "auto" else (self.source,):
            if candidates[name] is not None:
                self.used = name
                return candidates[name]
        self.used = "none"
        return None

    def _observe(self, state: State) -> np.ndarray | None:
        """The target in effect and the measured tip belong to one sample: the observer needs nothing else."""
        ticks = 1 if self._tick is None or state.tick <= self._tick else state.tick - self._tick
        self._tick = state.tick
        out = self._observer.step(
            set_point=np.array(state.target.position),
            measured=np.array(state.position),
            stale=False,
            dt=ticks * state.period_s,
        )
        return out.wrench if out.has_wrench else None
