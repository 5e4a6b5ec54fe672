"""
The saras core. Import the rooms: saras.teleop, saras.kinematics, saras.collision, saras.sim,
saras.net.
"""

from __future__ import annotations
import numpy
import numpy.typing
import typing
from . import teleop
from . import kinematics
from . import collision
from . import calibration
from . import sim
from . import net
from . import safety
from . import console
from . import csa
from . import pipeline
from . import overlay
from . import contact
from . import model
from . import runtime

__all__: list[str] = [
    "CalibrationError",
    "ConfigError",
    "Error",
    "KinematicsError",
    "ModelError",
    "ProtocolError",
    "Status",
    "add_delta",
    "calibration",
    "collision",
    "console",
    "contact",
    "csa",
    "displacement",
    "kinematics",
    "model",
    "net",
    "overlay",
    "pipeline",
    "runtime",
    "safety",
    "sim",
    "teleop",
]

class Error(RuntimeError):
    pass

class ConfigError(Error, ValueError):
    pass

class ProtocolError(Error, ValueError):
    pass

class KinematicsError(Error, ValueError):
    pass

class CalibrationError(Error, ValueError):
    pass

class ModelError(Error, ValueError):
    pass

class Status:
    """
    What a law's step says about its output.

    Members:

      OK

      LIMITED

      WAITING

      STALE

      INVALID_INPUT

      INVALID_TIME_STEP

      RATE_EXCEEDED
    """

    INVALID_INPUT: typing.ClassVar[Status]
    INVALID_TIME_STEP: typing.ClassVar[Status]
    LIMITED: typing.ClassVar[Status]
    OK: typing.ClassVar[Status]
    RATE_EXCEEDED: typing.ClassVar[Status]
    STALE: typing.ClassVar[Status]
    WAITING: typing.ClassVar[Status]
    __members__: typing.ClassVar[dict[str, Status]]
    @typing.overload
    def __eq__(self, other: Status) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Status) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

def add_delta(
    base_T_body: numpy.typing.ArrayLike,
    base_twist: numpy.typing.ArrayLike,
    dt: typing.SupportsFloat | typing.SupportsIndex,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Moves a (4, 4) pose by a base-frame twist (6,) [m/s, rad/s] for dt [s]. Same convention as KDL::addDelta.
    """

def displacement(
    base_T_1: numpy.typing.ArrayLike, base_T_2: numpy.typing.ArrayLike
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Displacement from one (4, 4) pose to another in the base frame: (6,) translation [m], rotation vector [rad].
    Same convention as KDL::diff; divide by the interval for the mean twist.
    """
