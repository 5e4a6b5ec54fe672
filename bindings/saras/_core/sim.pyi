"""
Simulated arm, tissue, hand and network
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core
import typing

__all__: list[str] = [
    "ArmMode",
    "Channel",
    "ChannelConfig",
    "ChannelCounters",
    "Operator",
    "OperatorConfig",
    "OperatorOutput",
    "OperatorState",
    "ServoArm",
    "ServoArmConfig",
    "ServoArmOutput",
    "ServoArmState",
    "Tissue",
    "TissueConfig",
    "TissueOutput",
]

class OperatorConfig:
    """
    A hand and the handle it holds. Presets: firm(), normal(), weak(), active().
    """

    _fields: typing.ClassVar[list] = [
        "stiffness_N_m",
        "damping_N_s_m",
        "hand_mass_kg",
        "handle_mass_kg",
        "roll_stiffness_N_m_rad",
        "roll_damping_N_m_s_rad",
        "roll_inertia_kg_m2",
        "workspace_centre_m",
        "workspace_radius_m",
        "speed_max_m_s",
        "dt_max_s",
    ]
    @staticmethod
    def active() -> OperatorConfig:
        """
        weak with negative damping: feeds every motion, for adversarial tests
        """
    @staticmethod
    def firm() -> OperatorConfig:
        """
        400 N/m, 15 N s/m, 0.8 kg
        """
    @staticmethod
    def normal() -> OperatorConfig:
        """
        200 N/m, 6 N s/m, 0.4 kg
        """
    @staticmethod
    def weak() -> OperatorConfig:
        """
        50 N/m, 1 N s/m, 0.15 kg
        """
    def __copy__(self) -> OperatorConfig: ...
    def __deepcopy__(self, arg0: dict) -> OperatorConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        A hand and the handle it holds. Presets: firm(), normal(), weak(), active().
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def damping_N_s_m(self) -> float:
        """
        of the hand [N s/m]; negative: an active hand
        """
    @damping_N_s_m.setter
    def damping_N_s_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest step [s], > 0
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def hand_mass_kg(self) -> float:
        """
        [kg], > 0
        """
    @hand_mass_kg.setter
    def hand_mass_kg(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def handle_mass_kg(self) -> float:
        """
        [kg], >= 0
        """
    @handle_mass_kg.setter
    def handle_mass_kg(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_damping_N_m_s_rad(self) -> float:
        """
        [N m s/rad]
        """
    @roll_damping_N_m_s_rad.setter
    def roll_damping_N_m_s_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_inertia_kg_m2(self) -> float:
        """
        [kg m^2], > 0
        """
    @roll_inertia_kg_m2.setter
    def roll_inertia_kg_m2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_stiffness_N_m_rad(self) -> float:
        """
        of the fingers [N m/rad], >= 0
        """
    @roll_stiffness_N_m_rad.setter
    def roll_stiffness_N_m_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed_max_m_s(self) -> float:
        """
        no hand is faster [m/s], > 0
        """
    @speed_max_m_s.setter
    def speed_max_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        of the hand around the intended position [N/m], >= 0
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def workspace_centre_m(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the mechanical stops [m]
        """
    @workspace_centre_m.setter
    def workspace_centre_m(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def workspace_radius_m(self) -> float:
        """
        inelastic stop [m], > 0
        """
    @workspace_radius_m.setter
    def workspace_radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class OperatorOutput:
    """
    Result of Operator.step.
    """

    _fields: typing.ClassVar[list] = ["position", "velocity", "roll", "roll_rate", "status"]
    def __copy__(self) -> OperatorOutput: ...
    def __deepcopy__(self, arg0: dict) -> OperatorOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of Operator.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) of the handle, console frame [m]
        """
    @position.setter
    def position(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def roll(self) -> float:
        """
        [rad]
        """
    @roll.setter
    def roll(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_rate(self) -> float:
        """
        [rad/s]
        """
    @roll_rate.setter
    def roll_rate(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status; LIMITED at a stop
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m/s]
        """
    @velocity.setter
    def velocity(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class OperatorState:
    """
    All that an Operator remembers.
    """

    _fields: typing.ClassVar[list] = ["position", "velocity", "roll", "roll_rate"]
    def __copy__(self) -> OperatorState: ...
    def __deepcopy__(self, arg0: dict) -> OperatorState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that an Operator remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m]
        """
    @position.setter
    def position(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def roll(self) -> float:
        """
        [rad]
        """
    @roll.setter
    def roll(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_rate(self) -> float:
        """
        [rad/s]
        """
    @roll_rate.setter
    def roll_rate(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [m/s]
        """
    @velocity.setter
    def velocity(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...

class Operator:
    """
    A hand around an intended motion, holding the handle's mass: m x'' = k (x_i - x) + b (x_i' - x') + F,
    exact for inputs held over dt, so that force moves the hand.
    """
    def __init__(self, config: OperatorConfig = ...) -> None: ...
    def reset(self, state: OperatorState = ...) -> None: ...
    def step(
        self,
        force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        intended_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        intended_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
        roll_torque: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        intended_roll: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> OperatorOutput:
        """
        One tick. force (3,) [N] and roll_torque [N m] are what the handle exerts on the hand; intended motion (3,) [m],
        (3,) [m/s] and roll [rad] in the console frame; dt [s].
        """
    @property
    def config(self) -> OperatorConfig: ...
    @property
    def state(self) -> OperatorState: ...

class TissueConfig:
    """
    Soft tissue with a stiff Gaussian inclusion under a plane or spherical surface.
    """

    _fields: typing.ClassVar[list] = [
        "base_T_surface",
        "curvature_1_m",
        "stiffness_N_m",
        "inclusion_stiffness_N_m",
        "inclusion_x_m",
        "inclusion_y_m",
        "inclusion_radius_m",
        "exponent",
        "damping_N_s_m2",
        "friction",
        "friction_speed_m_s",
        "skin_stiffness_N_m",
        "force_noise_N",
        "seed",
    ]
    def __copy__(self) -> TissueConfig: ...
    def __deepcopy__(self, arg0: dict) -> TissueConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Soft tissue with a stiff Gaussian inclusion under a plane or spherical surface.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def base_T_surface(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) origin on the surface, z = outward normal there
        """
    @base_T_surface.setter
    def base_T_surface(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def curvature_1_m(self) -> float:
        """
        1 / radius, > 0 bulges outward, 0 plane [1/m]
        """
    @curvature_1_m.setter
    def curvature_1_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping_N_s_m2(self) -> float:
        """
        lambda [N s/m^(1+n)], >= 0
        """
    @damping_N_s_m2.setter
    def damping_N_s_m2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def exponent(self) -> float:
        """
        n of depth^n, 1 to 3
        """
    @exponent.setter
    def exponent(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_noise_N(self) -> float:
        """
        standard deviation of the sensor's noise per axis [N], >= 0
        """
    @force_noise_N.setter
    def force_noise_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def friction(self) -> float:
        """
        Coulomb coefficient, >= 0
        """
    @friction.setter
    def friction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def friction_speed_m_s(self) -> float:
        """
        below it friction is viscous [m/s], > 0
        """
    @friction_speed_m_s.setter
    def friction_speed_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def inclusion_radius_m(self) -> float:
        """
        its standard deviation [m], > 0
        """
    @inclusion_radius_m.setter
    def inclusion_radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def inclusion_stiffness_N_m(self) -> float:
        """
        K at its centre [N/m^exponent], > 0
        """
    @inclusion_stiffness_N_m.setter
    def inclusion_stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def inclusion_x_m(self) -> float:
        """
        its centre, surface frame [m]
        """
    @inclusion_x_m.setter
    def inclusion_x_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def inclusion_y_m(self) -> float:
        """
        [m]
        """
    @inclusion_y_m.setter
    def inclusion_y_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def seed(self) -> int:
        """
        of the noise
        """
    @seed.setter
    def seed(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def skin_stiffness_N_m(self) -> float:
        """
        of the abdominal wall at the trocar [N/m], >= 0
        """
    @skin_stiffness_N_m.setter
    def skin_stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        K away from the inclusion [N/m^exponent], > 0
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class TissueOutput:
    """
    Result of Tissue.step.
    """

    _fields: typing.ClassVar[list] = [
        "wrench",
        "measured_wrench",
        "skin_force",
        "normal",
        "depth",
        "stiffness",
        "stored_energy_J",
        "contact",
        "status",
    ]
    def __copy__(self) -> TissueOutput: ...
    def __deepcopy__(self, arg0: dict) -> TissueOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of Tissue.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def contact(self) -> bool:
        """
        whether depth > 0
        """
    @contact.setter
    def contact(self, arg1: bool) -> None: ...
    @property
    def depth(self) -> float:
        """
        indentation [m]; negative: distance to the surface
        """
    @depth.setter
    def depth(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def measured_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) the same with the sensor's noise
        """
    @measured_wrench.setter
    def measured_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) outward, base frame; zero when the input was bad
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def skin_force(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) that the shaft exerts on the trocar's skin [N]
        """
    @skin_force.setter
    def skin_force(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def stiffness(self) -> float:
        """
        K under the tip
        """
    @stiffness.setter
    def stiffness(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stored_energy_J(self) -> float:
        """
        elastic energy of the dent [J]
        """
    @stored_energy_J.setter
    def stored_energy_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) that the tool exerts on the tissue, base frame [N, N m]
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class Tissue:
    """
    Hunt-Crossley contact with a stiffness field; never pulls, never makes energy.
    """
    def __init__(self, config: TissueConfig = ...) -> None: ...
    def reset(self) -> None: ...
    def step(
        self,
        tip_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        tip_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        trocar_deviation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
    ) -> TissueOutput:
        """
        One tick: tip (3,) [m] and its velocity (3,) [m/s] in the base frame, dt [s], the shaft's deviation from the
        trocar (3,) [m].
        """
    @property
    def config(self) -> TissueConfig: ...

class ChannelConfig:
    """
    Impairments of a datagram link, one way.
    """

    _fields: typing.ClassVar[list] = [
        "delay_s",
        "jitter_s",
        "loss",
        "duplicate",
        "reorder",
        "reorder_s",
        "burst_rate_hz",
        "burst_s",
        "seed",
        "capacity",
    ]
    def __copy__(self) -> ChannelConfig: ...
    def __deepcopy__(self, arg0: dict) -> ChannelConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Impairments of a datagram link, one way.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def burst_rate_hz(self) -> float:
        """
        how often a loss burst begins [1/s], >= 0
        """
    @burst_rate_hz.setter
    def burst_rate_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def burst_s(self) -> float:
        """
        how long a loss burst lasts [s], >= 0
        """
    @burst_s.setter
    def burst_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def capacity(self) -> int:
        """
        datagrams in flight; more are dropped and counted
        """
    @capacity.setter
    def capacity(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def delay_s(self) -> float:
        """
        of every datagram [s], >= 0
        """
    @delay_s.setter
    def delay_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def duplicate(self) -> float:
        """
        probability that it comes twice, 0 to 1
        """
    @duplicate.setter
    def duplicate(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def jitter_s(self) -> float:
        """
        uniform addition in [0, jitter_s]; keeps the order [s], >= 0
        """
    @jitter_s.setter
    def jitter_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def loss(self) -> float:
        """
        probability that a datagram is lost, 0 to 1
        """
    @loss.setter
    def loss(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def reorder(self) -> float:
        """
        probability that it is overtaken, 0 to 1
        """
    @reorder.setter
    def reorder(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def reorder_s(self) -> float:
        """
        by how much an overtaken one or a copy comes late [s], >= 0
        """
    @reorder_s.setter
    def reorder_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def seed(self) -> int:
        """
        of all draws
        """
    @seed.setter
    def seed(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class ChannelCounters:
    """
    What a Channel did so far.
    """

    _fields: typing.ClassVar[list] = ["sent", "lost", "duplicated", "reordered", "overflowed", "delivered"]
    def __copy__(self) -> ChannelCounters: ...
    def __deepcopy__(self, arg0: dict) -> ChannelCounters: ...
    def __init__(self, **kwargs) -> None:
        """
        What a Channel did so far.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def delivered(self) -> int:
        """
        copies that came out
        """
    @delivered.setter
    def delivered(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def duplicated(self) -> int:
        """
        datagrams that come twice
        """
    @duplicated.setter
    def duplicated(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def lost(self) -> int:
        """
        lost at random, in a burst or in a blackout
        """
    @lost.setter
    def lost(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def overflowed(self) -> int:
        """
        dropped because capacity was reached
        """
    @overflowed.setter
    def overflowed(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def reordered(self) -> int:
        """
        datagrams that are overtaken
        """
    @reordered.setter
    def reordered(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def sent(self) -> int:
        """
        datagrams given to the channel
        """
    @sent.setter
    def sent(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class Channel:
    """
    Impaired datagram link that carries ids; deterministic for a seed. Times are arguments [s].
    saras.sim.Link carries Python objects over it.
    """
    def __init__(self, config: ChannelConfig = ...) -> None: ...
    def blackout_until(self, time: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Loses all that is sent before time [s].
        """
    def hold_until(self, time: typing.SupportsFloat | typing.SupportsIndex) -> None:
        """
        Delivers nothing before time [s], then all at once.
        """
    def receive(self, now: typing.SupportsFloat | typing.SupportsIndex) -> list:
        """
        Ids of all datagrams that are due at the time now [s], in order of arrival.
        """
    def send(
        self, id: typing.SupportsInt | typing.SupportsIndex, now: typing.SupportsFloat | typing.SupportsIndex
    ) -> None:
        """
        Puts one datagram on the link at the time now [s].
        """
    @property
    def config(self) -> ChannelConfig: ...
    @property
    def counters(self) -> ChannelCounters: ...
    @property
    def in_flight(self) -> int:
        """
        datagrams under way
        """
    @property
    def next_arrival(self) -> float:
        """
        when the next datagram comes out [s]; inf: none
        """

class ArmMode:
    """
    How the arm keeps the direction of its shaft.

    Members:

      PIVOT : the shaft passes through the trocar

      PARALLEL : the shaft keeps its direction
    """

    PARALLEL: typing.ClassVar[ArmMode]
    PIVOT: typing.ClassVar[ArmMode]
    __members__: typing.ClassVar[dict[str, ArmMode]]
    @typing.overload
    def __eq__(self, other: ArmMode) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ArmMode) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ServoArmConfig:
    """
    Joint dynamics and measurement of the simulated SARAS arm.
    """

    _fields: typing.ClassVar[list] = [
        "natural_frequency_rad_s",
        "damping_ratio",
        "effective_mass_kg",
        "jaw_speed_max_1_s",
        "joint_resolution",
        "joint_noise",
        "seed",
        "dt_max_s",
    ]
    def __copy__(self) -> ServoArmConfig: ...
    def __deepcopy__(self, arg0: dict) -> ServoArmConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Joint dynamics and measurement of the simulated SARAS arm.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def initial_q(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) joints with the tip 0.1 m straight below the nominal trocar
        """
    @property
    def damping_ratio(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) per joint, > 0
        """
    @damping_ratio.setter
    def damping_ratio(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest step [s], > 0
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def effective_mass_kg(self) -> float:
        """
        of the tip, in every direction [kg], > 0
        """
    @effective_mass_kg.setter
    def effective_mass_kg(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def jaw_speed_max_1_s(self) -> float:
        """
        jaw 0 closed to 1 open [1/s], > 0
        """
    @jaw_speed_max_1_s.setter
    def jaw_speed_max_1_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def joint_noise(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) standard deviation of the measured joints [rad, m]
        """
    @joint_noise.setter
    def joint_noise(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def joint_resolution(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) step of the measured joints, 0 none [rad, m]
        """
    @joint_resolution.setter
    def joint_resolution(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def natural_frequency_rad_s(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) per joint; unequal ones bend the remote centre
        """
    @natural_frequency_rad_s.setter
    def natural_frequency_rad_s(
        self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]
    ) -> None: ...
    @property
    def seed(self) -> int:
        """
        of the noise
        """
    @seed.setter
    def seed(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class ServoArmOutput:
    """
    Result of ServoArm.step.
    """

    _fields: typing.ClassVar[list] = [
        "q",
        "q_rate",
        "base_T_tip",
        "tip_velocity",
        "measured_q",
        "measured_base_T_tip",
        "trocar_deviation",
        "rcm_deviation_m",
        "jaw",
        "status",
    ]
    def __copy__(self) -> ServoArmOutput: ...
    def __deepcopy__(self, arg0: dict) -> ServoArmOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of ServoArm.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def base_T_tip(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) true
        """
    @base_T_tip.setter
    def base_T_tip(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def jaw(self) -> float:
        """
        0 closed to 1 open
        """
    @jaw.setter
    def jaw(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def measured_base_T_tip(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) forward kinematics of measured_q
        """
    @measured_base_T_tip.setter
    def measured_base_T_tip(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def measured_q(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) with resolution and noise
        """
    @measured_q.setter
    def measured_q(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def q(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) true joints [rad], insertion [m]
        """
    @q.setter
    def q(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def q_rate(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) true rates [rad/s], [m/s]
        """
    @q_rate.setter
    def q_rate(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def rcm_deviation_m(self) -> float:
        """
        its length [m]
        """
    @rcm_deviation_m.setter
    def rcm_deviation_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status; LIMITED: target out of reach or speed scaled
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def tip_velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) true, base frame [m/s]
        """
    @tip_velocity.setter
    def tip_velocity(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def trocar_deviation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) from the trocar to the nearest point of the shaft's line [m]
        """
    @trocar_deviation.setter
    def trocar_deviation(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def violation(self) -> str:
        """
        why the target is not followed; empty when it is
        """

class ServoArmState:
    """
    All that a ServoArm remembers.
    """

    _fields: typing.ClassVar[list] = ["q", "q_rate", "q_target", "roll_reference", "jaw"]
    def __copy__(self) -> ServoArmState: ...
    def __deepcopy__(self, arg0: dict) -> ServoArmState: ...
    def __init__(self, **kwargs) -> None:
        """
        All that a ServoArm remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def jaw(self) -> float:
        """
        0 closed to 1 open
        """
    @jaw.setter
    def jaw(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def q(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,)
        """
    @q.setter
    def q(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def q_rate(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,)
        """
    @q_rate.setter
    def q_rate(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def q_target(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) the last target in reach
        """
    @q_target.setter
    def q_target(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def roll_reference(self) -> float:
        """
        [rad]
        """
    @roll_reference.setter
    def roll_reference(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ServoArm:
    """
    Six servoed joints with second-order dynamics that follow a pivoting tip and yield to a force on it.
    """
    def __init__(self, config: ServoArmConfig = ...) -> None: ...
    @typing.overload
    def reset(self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None:
        """
        At rest in the joints q (6,). Raises ConfigError when they leave the limits.
        """
    @typing.overload
    def reset(self, state: ServoArmState) -> None: ...
    @typing.overload
    def reset(self) -> None: ...
    def step(
        self,
        target_tip: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        target_roll: typing.SupportsFloat | typing.SupportsIndex,
        rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        reaction_force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        target_jaw: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        roll_speed_max_rad_s: typing.SupportsFloat | typing.SupportsIndex = 1000000000.0,
        jaw_speed_max_1_s: typing.SupportsFloat | typing.SupportsIndex = 1000000000.0,
        mode: ArmMode = ...,
    ) -> ServoArmOutput:
        """
        One tick: target tip (3,) [m], roll joint [rad] and trocar (3,) [m] in the base frame; reaction_force (3,) is
        what the surroundings exert on the tip [N], minus the wrench exerted; dt [s]; jaw 0 closed to 1 open.
        """
    @property
    def config(self) -> ServoArmConfig: ...
    @property
    def state(self) -> ServoArmState: ...
