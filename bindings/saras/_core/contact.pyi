"""
Force of a contact that a camera sees
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core
import typing

__all__: list[str] = ["ContactForce", "ContactForceConfig", "ContactForceOutput", "ContactForceState"]

class ContactForceConfig:
    """
    Of the tissue, and what is believed of a reading.
    """

    _fields: typing.ClassVar[list] = [
        "stiffness_N_m",
        "exponent",
        "damping_N_s_m2",
        "rate_cutoff_hz",
        "depth_limit_m",
        "force_limit_N",
        "age_limit_s",
        "dt_max_s",
    ]
    def __copy__(self) -> ContactForceConfig: ...
    def __deepcopy__(self, arg0: dict) -> ContactForceConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Of the tissue, and what is believed of a reading.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_limit_s(self) -> float:
        """
        an older reading gives no estimate [s]
        """
    @age_limit_s.setter
    def age_limit_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping_N_s_m2(self) -> float:
        """
        lambda of Hunt and Crossley [N s/m^(1+n)]; 0: none
        """
    @damping_N_s_m2.setter
    def damping_N_s_m2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def depth_limit_m(self) -> float:
        """
        a deeper reading is not believed [m]
        """
    @depth_limit_m.setter
    def depth_limit_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def exponent(self) -> float:
        """
        n of depth^n; 1: a spring
        """
    @exponent.setter
    def exponent(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        beyond it there is no estimate (saturated) [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def rate_cutoff_hz(self) -> float:
        """
        low-pass of the depth's rate [Hz]
        """
    @rate_cutoff_hz.setter
    def rate_cutoff_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        K [N/m^exponent]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ContactForceOutput:
    """
    Result of ContactForce.step.
    """

    _fields: typing.ClassVar[list] = ["has_estimate", "exerted", "reaction", "depth_m", "age_s", "status"]
    def __copy__(self) -> ContactForceOutput: ...
    def __deepcopy__(self, arg0: dict) -> ContactForceOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of ContactForce.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        of the reading behind it [s]
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def depth_m(self) -> float:
        """
        [m], >= 0; NaN when unknown
        """
    @depth_m.setter
    def depth_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def exerted(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) by the tool on the tissue, in the frame of the direction; NaN when unknown
        """
    @exerted.setter
    def exerted(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def has_estimate(self) -> bool:
        """
        false: unknown, which is not zero
        """
    @has_estimate.setter
    def has_estimate(self, arg1: bool) -> None: ...
    @property
    def reaction(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the tool: its opposite [N]; NaN when unknown
        """
    @reaction.setter
    def reaction(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        WAITING, STALE, INVALID_INPUT, LIMITED (saturated): no estimate
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...

class ContactForceState:
    """
    The reading that is held.
    """

    _fields: typing.ClassVar[list] = ["known", "depth_m", "rate_m_s", "normal", "age_s"]
    known: bool
    def __copy__(self) -> ContactForceState: ...
    def __deepcopy__(self, arg0: dict) -> ContactForceState: ...
    def __init__(self, **kwargs) -> None:
        """
        The reading that is held.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_s(self) -> float:
        """
        [s]
        """
    @age_s.setter
    def age_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def depth_m(self) -> float:
        """
        [m]
        """
    @depth_m.setter
    def depth_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def rate_m_s(self) -> float:
        """
        [m/s]
        """
    @rate_m_s.setter
    def rate_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ContactForce:
    """
    Force of a contact that a camera sees, held between its readings.
    """
    def __init__(self, config: ContactForceConfig = ...) -> None: ...
    def reset(self, state: ContactForceState = ...) -> None: ...
    def step(
        self,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        depth_m: typing.SupportsFloat | typing.SupportsIndex | None = None,
        direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] | None = None,
        age_s: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> ContactForceOutput:
        """
        One tick. depth_m: a new reading [m], None: none came; direction: (3,) outward normal of the tissue, of any
        length but 0; age_s: of that reading. A depth of NaN says that it is not known.
        """
    @property
    def config(self) -> ContactForceConfig: ...
    @property
    def state(self) -> ContactForceState: ...
