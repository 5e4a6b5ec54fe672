"""The driver plug-in interface: what a node asks of an arm, whoever's library is behind it.

Plug-ins register in the entry point group ``saras.arm_drivers``; ``socketio`` is ours. A factory takes the
keyword arguments of the arm's section in config/arms.yaml.
"""

from __future__ import annotations

import abc
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from importlib.metadata import entry_points
from typing import cast

import numpy as np
from numpy.typing import NDArray

from saras import ConfigError, Error
from saras.mesa_link.protocol import MaxVelocity, State, Tool, Truth

ENTRY_POINT_GROUP = "saras.arm_drivers"


class ArmLinkError(Error):
    """The arm cannot take this now; the message says why (link, control, freshness, refusal)."""


@dataclass(frozen=True)
class Received:
    """A state and when it came. ``lag_s``: how much later than the fastest packets of this link (backlog)."""

    state: State
    received_s: float  # local monotonic clock
    lag_s: float


@dataclass
class LinkStats:
    """Counters since the driver was made, and how the link stands."""

    connected: bool = False
    in_control: bool = False
    session: int = 0
    sessions: int = 0  # how many were begun
    states: int = 0
    bad_states: int = 0
    sent: int = 0
    superseded: int = 0  # commands replaced by a newer one before they left
    discarded: int = 0  # commands given up: link down, state stale, session over
    nacks: Counter[str] = field(default_factory=Counter)
    last_error: str = ""


StateCallback = Callable[[Received], None]
TruthCallback = Callable[[Truth], None]


class ArmDriver(abc.ABC):
    """One arm. Methods may be called from any thread; none but ``connect`` and the requests blocks.

    Poses are (4, 4) in the arm's base frame, SI. Refusals raise ArmLinkError.
    """

    @abc.abstractmethod
    def connect(self, timeout_s: float) -> None:
        """Connect and wait for the first state; ArmLinkError says what is missing. The driver goes on trying."""

    @abc.abstractmethod
    def close(self) -> None:
        """Give up control and disconnect."""

    @abc.abstractmethod
    def latest_state(self) -> Received | None:
        """The newest state, None before the first one. Check its age: it stays when the link is gone."""

    @abc.abstractmethod
    def command_pose(self, base_T_tip: NDArray[np.float64]) -> None:
        """Send a tip target. Only the newest one is kept; none is kept while the link is down."""

    @abc.abstractmethod
    def command_tool(self, tool: Tool) -> None:
        """Open, close, rotate the instrument."""

    @abc.abstractmethod
    def set_max_velocity(self, bounds: MaxVelocity, timeout_s: float = 1.0) -> None:
        """Bound the tip's speed."""

    @abc.abstractmethod
    def set_rcm(self, position: tuple[float, ...], timeout_s: float = 1.0) -> None:
        """Set the trocar [m]; at rest only."""

    @abc.abstractmethod
    def set_mode(self, mode: str, timeout_s: float = 1.0) -> None:
        """Choose ``pivot`` or ``parallel``; at rest only."""

    @abc.abstractmethod
    def brake(self, on: bool, timeout_s: float = 1.0) -> None:
        """Lock (True) or release the positioning arm; at rest only. Released, its weight is in the user's hands."""

    @abc.abstractmethod
    def stats(self) -> LinkStats:
        """A copy of the counters."""


def load_driver(name: str) -> Callable[..., ArmDriver]:
    """The driver class registered as ``name``; ConfigError lists those that are."""
    if name == "socketio":  # ours needs no installed metadata
        from saras.mesa_link.client import SocketIoArmDriver

        return SocketIoArmDriver
    found = {point.name: point for point in entry_points(group=ENTRY_POINT_GROUP)}
    if name not in found:
        known = ", ".join(sorted({"socketio", *found}))
        raise ConfigError(f"driver: no arm driver named '{name}'; there are: {known}")
    return cast(Callable[..., ArmDriver], found[name].load())
