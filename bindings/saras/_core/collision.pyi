"""
Distances between tools and forbidden regions
"""

from __future__ import annotations
import collections.abc
import numpy
import numpy.typing
import saras._core
import typing

__all__: list[str] = [
    "Capsule",
    "DistanceStatus",
    "Parallelepiped",
    "Partner",
    "ProximityMonitor",
    "ProximityMonitorConfig",
    "ProximityMonitorOutput",
    "ProximityMonitorState",
    "ProximityState",
    "RepulsiveForce",
    "RepulsiveForceConfig",
    "RepulsiveForceOutput",
    "RepulsiveForceState",
    "Scene",
    "SignedDistance",
    "ToolDistance",
    "ToolProximity",
    "capsule_capsule",
    "capsule_parallelepiped",
    "format_vertices",
    "read_vertices",
]

class Parallelepiped:
    """
    A box, or a skewed box. Corners (8, 3) in the source's order: v1, v4, v3 are the
    neighbours of v0 along x, y, z; edges 0-1 1-2 2-3 3-0 0-4 4-7 7-3 4-5 5-6 6-7 1-5 2-6.
    """
    def __init__(self, vertices: typing.Any) -> None:
        """
        vertices: (8, 3) [m]. Raises ConfigError: not finite, zero volume, does not close (1e-6 m).
        """
    def __repr__(self) -> str: ...
    @property
    def center(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]: ...
    @property
    def rectangular(self) -> bool: ...
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]: ...
    @property
    def volume(self) -> float: ...

class Capsule:
    """
    All points within radius_m of the segment a - b.
    """

    _fields: typing.ClassVar[list] = ["a", "b", "radius_m"]
    def __copy__(self) -> Capsule: ...
    def __deepcopy__(self, arg0: dict) -> Capsule: ...
    def __init__(self, **kwargs) -> None:
        """
        All points within radius_m of the segment a - b.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def a(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) one end of the axis, e.g. the tip [m]
        """
    @a.setter
    def a(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def b(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) the other end, e.g. the trocar [m]
        """
    @b.setter
    def b(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def radius_m(self) -> float:
        """
        >= 0 [m]
        """
    @radius_m.setter
    def radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class DistanceStatus:
    """
    What a SignedDistance says.

    Members:

      SEPARATED

      TOUCHING

      PENETRATING

      UNKNOWN
    """

    PENETRATING: typing.ClassVar[DistanceStatus]
    SEPARATED: typing.ClassVar[DistanceStatus]
    TOUCHING: typing.ClassVar[DistanceStatus]
    UNKNOWN: typing.ClassVar[DistanceStatus]
    __members__: typing.ClassVar[dict[str, DistanceStatus]]
    @typing.overload
    def __eq__(self, other: DistanceStatus) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: DistanceStatus) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SignedDistance:
    """
    Distance of b from a; negative: minus the least translation that separates. NaN everywhere: UNKNOWN.
    point_b = point_a + distance * normal.
    """

    _fields: typing.ClassVar[list] = ["distance", "point_a", "point_b", "normal", "status"]
    def __copy__(self) -> SignedDistance: ...
    def __deepcopy__(self, arg0: dict) -> SignedDistance: ...
    def __init__(self, **kwargs) -> None:
        """
        Distance of b from a; negative: minus the least translation that separates. NaN everywhere: UNKNOWN.
        point_b = point_a + distance * normal.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def distance(self) -> float:
        """
        [m]
        """
    @distance.setter
    def distance(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit, from a towards b
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def point_a(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the surface of a [m]
        """
    @point_a.setter
    def point_a(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def point_b(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the surface of b [m]
        """
    @point_b.setter
    def point_b(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def status(self) -> DistanceStatus:
        """
        DistanceStatus
        """
    @status.setter
    def status(self, arg1: DistanceStatus) -> None: ...

class Partner:
    """
    What a distance is to.

    Members:

      NONE

      TOOL

      REGION
    """

    NONE: typing.ClassVar[Partner]
    REGION: typing.ClassVar[Partner]
    TOOL: typing.ClassVar[Partner]
    __members__: typing.ClassVar[dict[str, Partner]]
    @typing.overload
    def __eq__(self, other: Partner) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Partner) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ToolDistance:
    """
    The nearest known thing to one tool, and what is not known.
    """
    @property
    def distance(self) -> float:
        """
        [m]; NaN when nothing is known. To what is known only: see the flags.
        """
    @property
    def index(self) -> typing.Any:
        """
        of that tool or region
        """
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) unit, from the tool towards the other
        """
    @property
    def other_tool_unknown(self) -> bool:
        """
        another tool is not known
        """
    @property
    def partner(self) -> Partner:
        """
        TOOL, REGION, or NONE
        """
    @property
    def point_a(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the tool [m]
        """
    @property
    def point_b(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) on the other [m]
        """
    @property
    def regions_unknown(self) -> bool:
        """
        where the regions are is not known
        """
    @property
    def status(self) -> DistanceStatus: ...
    @property
    def tool_unknown(self) -> bool:
        """
        this tool is not known
        """

class Scene:
    """
    Tools among regions that one rigid transform moves.
    """
    def __init__(self, tools: typing.SupportsInt | typing.SupportsIndex, regions: typing.Any = ()) -> None:
        """
        tools: how many. regions: (n, 8, 3) [m] in their own frame. Raises ConfigError naming the region.
        """
    def distances(
        self, tools: collections.abc.Sequence, base_T_regions: numpy.typing.ArrayLike = ..., regions_known: bool = True
    ) -> list[ToolDistance]:
        """
        One ToolDistance a tool. tools: (a (3,), b (3,), radius) [m], Capsule, or None (not known).
        """
    @property
    def regions(self) -> int: ...
    @property
    def tools(self) -> int: ...

class ProximityMonitorConfig:
    """
    Thresholds and speeds of ProximityMonitor.
    """

    _fields: typing.ClassVar[list] = [
        "collision_m",
        "warning_m",
        "hysteresis_m",
        "slowdown_start_m",
        "slowdown_stop_m",
        "speed_limit_m_s",
        "unknown_speed_limit_m_s",
    ]
    def __copy__(self) -> ProximityMonitorConfig: ...
    def __deepcopy__(self, arg0: dict) -> ProximityMonitorConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Thresholds and speeds of ProximityMonitor.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def collision_m(self) -> float:
        """
        at most this far is a collision [m]
        """
    @collision_m.setter
    def collision_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def hysteresis_m(self) -> float:
        """
        a state is left this much further out [m]
        """
    @hysteresis_m.setter
    def hysteresis_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def slowdown_start_m(self) -> float:
        """
        up to here a tool may approach at full speed [m]
        """
    @slowdown_start_m.setter
    def slowdown_start_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def slowdown_stop_m(self) -> float:
        """
        from here on it may not approach [m]
        """
    @slowdown_stop_m.setter
    def slowdown_stop_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed_limit_m_s(self) -> float:
        """
        full speed [m/s]
        """
    @speed_limit_m_s.setter
    def speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def unknown_speed_limit_m_s(self) -> float:
        """
        while something is unknown [m/s]
        """
    @unknown_speed_limit_m_s.setter
    def unknown_speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def warning_m(self) -> float:
        """
        below it is a warning [m]
        """
    @warning_m.setter
    def warning_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ProximityState:
    """
    What the monitor says of a tool.

    Members:

      UNKNOWN

      CLEAR

      WARNING

      COLLISION
    """

    CLEAR: typing.ClassVar[ProximityState]
    COLLISION: typing.ClassVar[ProximityState]
    UNKNOWN: typing.ClassVar[ProximityState]
    WARNING: typing.ClassVar[ProximityState]
    __members__: typing.ClassVar[dict[str, ProximityState]]
    @typing.overload
    def __eq__(self, other: ProximityState) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ProximityState) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ToolProximity:
    """
    Of one tool: state, distance, with whom, what is unknown, how fast it may move.
    """

    _fields: typing.ClassVar[list] = [
        "state",
        "distance_m",
        "known",
        "partner",
        "partner_index",
        "tool_unknown",
        "other_tool_unknown",
        "regions_unknown",
        "max_speed_scale",
        "approach_direction",
        "approach_speed_limit_m_s",
    ]
    def __copy__(self) -> ToolProximity: ...
    def __deepcopy__(self, arg0: dict) -> ToolProximity: ...
    def __init__(self, **kwargs) -> None:
        """
        Of one tool: state, distance, with whom, what is unknown, how fast it may move.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def approach_direction(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) towards what is near; zero: nothing known
        """
    @approach_direction.setter
    def approach_direction(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def approach_speed_limit_m_s(self) -> float:
        """
        along it [m/s]; infinite: no bound
        """
    @approach_speed_limit_m_s.setter
    def approach_speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def distance_m(self) -> float:
        """
        [m]; NaN when UNKNOWN, infinite when there is nothing to meet
        """
    @distance_m.setter
    def distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def known(self) -> SignedDistance:
        """
        SignedDistance from the tool to the nearest known thing; NaN when nothing is known
        """
    @known.setter
    def known(self, arg1: SignedDistance) -> None: ...
    @property
    def max_speed_scale(self) -> float:
        """
        0..1, for the velocity integrator
        """
    @max_speed_scale.setter
    def max_speed_scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def other_tool_unknown(self) -> bool:
        """
        why UNKNOWN: another tool
        """
    @other_tool_unknown.setter
    def other_tool_unknown(self, arg1: bool) -> None: ...
    @property
    def partner(self) -> Partner:
        """
        TOOL, REGION or NONE
        """
    @partner.setter
    def partner(self, arg1: Partner) -> None: ...
    @property
    def partner_index(self) -> int:
        """
        of that tool or region; -1 for none
        """
    @partner_index.setter
    def partner_index(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def regions_unknown(self) -> bool:
        """
        why UNKNOWN: the regions
        """
    @regions_unknown.setter
    def regions_unknown(self, arg1: bool) -> None: ...
    @property
    def state(self) -> ProximityState:
        """
        ProximityState
        """
    @state.setter
    def state(self, arg1: ProximityState) -> None: ...
    @property
    def tool_unknown(self) -> bool:
        """
        why UNKNOWN: this tool
        """
    @tool_unknown.setter
    def tool_unknown(self, arg1: bool) -> None: ...

class ProximityMonitorOutput:
    """
    Result of ProximityMonitor.step.
    """

    _fields: typing.ClassVar[list] = ["tools", "status"]
    def __copy__(self) -> ProximityMonitorOutput: ...
    def __deepcopy__(self, arg0: dict) -> ProximityMonitorOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of ProximityMonitor.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def status(self) -> saras._core.Status:
        """
        STALE: something is unknown; LIMITED: some tool is slowed down
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def tools(self) -> list[ToolProximity]:
        """
        a ToolProximity each
        """
    @tools.setter
    def tools(self, arg1: collections.abc.Sequence[ToolProximity]) -> None: ...

class ProximityMonitorState:
    """
    What hysteresis remembers.
    """

    _fields: typing.ClassVar[list] = ["levels"]
    def __copy__(self) -> ProximityMonitorState: ...
    def __deepcopy__(self, arg0: dict) -> ProximityMonitorState: ...
    def __init__(self, **kwargs) -> None:
        """
        What hysteresis remembers.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def levels(self) -> typing.Annotated[list[ProximityState], "FixedSize(16)"]:
        """
        ProximityState of each tool when it was last known
        """
    @levels.setter
    def levels(self, arg1: typing.Annotated[collections.abc.Sequence[ProximityState], "FixedSize(16)"]) -> None: ...

class ProximityMonitor:
    """
    State and speed of each tool from its distances. Unknown is never clear.
    """
    def __init__(
        self, config: ProximityMonitorConfig, tools: typing.SupportsInt | typing.SupportsIndex, regions: typing.Any = ()
    ) -> None:
        """
        tools: how many, 1..16. regions: (n, 8, 3) [m]. Raises ConfigError.
        """
    def reset(self, state: ProximityMonitorState = ...) -> None: ...
    def step(
        self,
        tools: collections.abc.Sequence,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        base_T_regions: numpy.typing.ArrayLike = ...,
        regions_known: bool = True,
    ) -> ProximityMonitorOutput:
        """
        One tick. tools: (a (3,), b (3,), radius) [m], Capsule, or None for one that is lost or too old;
        or (n, 7) numbers a, b, radius, with a row that is not finite for such a one.
        base_T_regions: (4, 4) from the regions' frame to that of the tools; regions_known: it is fresh.
        """
    @property
    def config(self) -> ProximityMonitorConfig: ...
    @property
    def regions(self) -> int: ...
    @property
    def state(self) -> ProximityMonitorState: ...
    @property
    def tools(self) -> int: ...

class RepulsiveForceConfig:
    """
    A spring before what is near.
    """

    _fields: typing.ClassVar[list] = ["start_distance_m", "stiffness_N_m", "force_limit_N", "dt_max_s"]
    def __copy__(self) -> RepulsiveForceConfig: ...
    def __deepcopy__(self, arg0: dict) -> RepulsiveForceConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        A spring before what is near.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        largest force [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def start_distance_m(self) -> float:
        """
        nearer than this the force begins [m]
        """
    @start_distance_m.setter
    def start_distance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        force per metre nearer [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class RepulsiveForceOutput:
    """
    Result of RepulsiveForce.step.
    """

    _fields: typing.ClassVar[list] = ["wrench", "status"]
    def __copy__(self) -> RepulsiveForceOutput: ...
    def __deepcopy__(self, arg0: dict) -> RepulsiveForceOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of RepulsiveForce.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def status(self) -> saras._core.Status:
        """
        STALE: distance unknown, zero force
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) on the operator's hand, in the frame of the normal
        """
    @wrench.setter
    def wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class RepulsiveForceState:
    """
    Nothing is remembered.
    """

    _fields: typing.ClassVar[list] = list()
    def __copy__(self) -> RepulsiveForceState: ...
    def __deepcopy__(self, arg0: dict) -> RepulsiveForceState: ...
    def __init__(self, **kwargs) -> None:
        """
        Nothing is remembered.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """

class RepulsiveForce:
    """
    A force on the hand away from what the tool comes near to.
    """
    def __init__(self, config: RepulsiveForceConfig = ...) -> None: ...
    def reset(self, state: RepulsiveForceState = ...) -> None: ...
    def step(
        self,
        distance_m: typing.SupportsFloat | typing.SupportsIndex,
        normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
    ) -> RepulsiveForceOutput:
        """
        One tick. distance_m: signed [m], NaN when unknown (zero force); normal: (3,) unit, tool -> what is near.
        """
    @property
    def config(self) -> RepulsiveForceConfig: ...
    @property
    def state(self) -> RepulsiveForceState: ...

def capsule_capsule(
    a0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    a1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ra: typing.SupportsFloat | typing.SupportsIndex,
    b0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    b1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    rb: typing.SupportsFloat | typing.SupportsIndex,
) -> SignedDistance:
    """
    Signed distance of two capsules: ends of the axes (3,) [m], radii [m]. Input that is not finite gives UNKNOWN.
    """

@typing.overload
def capsule_parallelepiped(
    a0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    a1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    r: typing.SupportsFloat | typing.SupportsIndex,
    region: Parallelepiped,
) -> SignedDistance:
    """
    Signed distance of a capsule (a) from a region (b) that was checked before: for loops.
    """

@typing.overload
def capsule_parallelepiped(
    a0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    a1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    r: typing.SupportsFloat | typing.SupportsIndex,
    vertices: typing.Any,
) -> SignedDistance:
    """
    Signed distance of a capsule (a), ends of the axis (3,) and radius [m], from a parallelepiped (b) of eight
    vertices (8, 3) [m]. A capsule that is not finite gives UNKNOWN; vertices that are none raise ConfigError.
    """

def format_vertices(regions: typing.Any) -> str:
    """
    Text of a vertices.txt with all digits, from (n, 8, 3) [m].
    """

def read_vertices(
    path: str,
    scale: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    marker_T_file: numpy.typing.ArrayLike = ...,
    max_bytes: typing.SupportsInt | typing.SupportsIndex = 67108864,
    max_count: typing.SupportsInt | typing.SupportsIndex = 100000,
) -> numpy.typing.NDArray[numpy.float64]:
    """
    Regions (n, 8, 3) [m] of a vertices.txt: count, then eight lines 'x y z' a region.
    scale: metres per unit of the file; marker_T_file: (4, 4), applied after it. Raises ProtocolError naming line,
    value and bound; a file above max_bytes is refused unread.
    """
