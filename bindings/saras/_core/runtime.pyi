"""
The real-time host: loop, mailboxes, flight recorder
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core.collision
import saras._core.net
import saras._core.pipeline
import typing

__all__: list[str] = [
    "ConsoleSocketConfig",
    "FlightRecord",
    "FlightReplay",
    "FlightTick",
    "Histogram",
    "HostConfig",
    "HostSnapshot",
    "HostStatistics",
    "LoopConfig",
    "LoopStatistics",
    "Pacing",
    "RealtimeReport",
    "RealtimeRequest",
    "TeleopHost",
    "monotonic_ns",
    "read_flight",
    "replay_flight",
]

class Pacing:
    """
    What wakes the loop.

    Members:

      DATAGRAM

      TICK
    """

    DATAGRAM: typing.ClassVar[Pacing]
    TICK: typing.ClassVar[Pacing]
    __members__: typing.ClassVar[dict[str, Pacing]]
    @typing.overload
    def __eq__(self, other: Pacing) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: Pacing) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class RealtimeRequest:
    """
    What is asked of the machine; a refusal is reported, not raised.
    """

    _fields: typing.ClassVar[list] = ["priority", "lock_memory"]
    def __copy__(self) -> RealtimeRequest: ...
    def __deepcopy__(self, arg0: dict) -> RealtimeRequest: ...
    def __init__(self, **kwargs) -> None:
        """
        What is asked of the machine; a refusal is reported, not raised.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def lock_memory(self) -> bool:
        """
        keep all pages in memory
        """
    @lock_memory.setter
    def lock_memory(self, arg1: bool) -> None: ...
    @property
    def priority(self) -> int:
        """
        of SCHED_FIFO, 1..99; 0: an ordinary thread
        """
    @priority.setter
    def priority(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class RealtimeReport:
    """
    What of it the loop's thread got, and why not.
    """
    def text(self) -> str:
        """
        All that in one line.
        """
    @property
    def fifo(self) -> bool:
        """
        SCHED_FIFO obtained
        """
    @property
    def fifo_reason(self) -> str:
        """
        why not; empty when obtained
        """
    @property
    def future_locked(self) -> bool:
        """
        and those of later
        """
    @property
    def memory_locked(self) -> bool:
        """
        pages of now are locked
        """
    @property
    def memory_reason(self) -> str:
        """
        why not, or why only those of now
        """
    @property
    def priority(self) -> int:
        """
        in effect
        """
    @property
    def timer_slack(self) -> bool:
        """
        timers of the thread are not delayed to join wake-ups
        """

class LoopConfig:
    """
    Period and punctuality of the loop.
    """

    _fields: typing.ClassVar[list] = ["period_s", "pacing", "hold_after_s", "realtime"]
    def __copy__(self) -> LoopConfig: ...
    def __deepcopy__(self, arg0: dict) -> LoopConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Period and punctuality of the loop.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def hold_after_s(self) -> float:
        """
        time lost by overruns in a row that asks for HOLD [s]
        """
    @hold_after_s.setter
    def hold_after_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pacing(self) -> Pacing:
        """
        Pacing
        """
    @pacing.setter
    def pacing(self, arg1: Pacing) -> None: ...
    @property
    def period_s(self) -> float:
        """
        [s], 0.0001..0.1
        """
    @period_s.setter
    def period_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def realtime(self) -> RealtimeRequest:
        """
        RealtimeRequest
        """
    @realtime.setter
    def realtime(self, arg1: RealtimeRequest) -> None: ...

class Histogram:
    """
    Distribution of durations, to 3 %.
    """
    def quantile_ns(self, p: typing.SupportsFloat | typing.SupportsIndex) -> int:
        """
        Duration that the share p (0..1) does not exceed [ns].
        """
    @property
    def count(self) -> int: ...
    @property
    def max_ns(self) -> int: ...
    @property
    def mean_ns(self) -> float: ...

class LoopStatistics:
    """
    Counters of the loop since its construction.
    """
    @property
    def by_datagram(self) -> int: ...
    @property
    def execution(self) -> Histogram:
        """
        of the steps
        """
    @property
    def holds(self) -> int: ...
    @property
    def lateness(self) -> Histogram:
        """
        of timer wake-ups behind their deadline
        """
    @property
    def missed_periods(self) -> int:
        """
        whole periods lost in them
        """
    @property
    def overruns(self) -> int:
        """
        wake-ups more than a period late
        """
    @property
    def wakes(self) -> int: ...

class ConsoleSocketConfig:
    """
    The platform's end of the Touchball UDP link.
    """

    _fields: typing.ClassVar[list] = [
        "bind_host",
        "bind_port",
        "console_host",
        "console_port",
        "age_limit_s",
        "keyed",
        "session",
    ]
    def __copy__(self) -> ConsoleSocketConfig: ...
    def __deepcopy__(self, arg0: dict) -> ConsoleSocketConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        The platform's end of the Touchball UDP link.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def age_limit_s(self) -> float:
        """
        a datagram older than this on arrival is dropped [s]
        """
    @age_limit_s.setter
    def age_limit_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def bind_host(self) -> str:
        """
        numeric IPv4
        """
    @bind_host.setter
    def bind_host(self, arg1: str) -> None: ...
    @property
    def bind_port(self) -> int:
        """
        0: any free one
        """
    @bind_port.setter
    def bind_port(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def console_host(self) -> str:
        """
        numeric IPv4; other datagrams are refused
        """
    @console_host.setter
    def console_host(self, arg1: str) -> None: ...
    @property
    def console_port(self) -> int:
        """
        1..65535
        """
    @console_port.setter
    def console_port(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def keyed(self) -> bool:
        """
        only authenticated datagrams are believed; else loopback only
        """
    @keyed.setter
    def keyed(self, arg1: bool) -> None: ...
    @property
    def session(self) -> int:
        """
        of the datagrams down: larger for every restart
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class HostConfig:
    """
    Loop, console link, pipeline and flight recorder of a TeleopHost.
    """

    _fields: typing.ClassVar[list] = ["loop", "console", "pipeline", "silent_period_s", "record_s"]
    def __copy__(self) -> HostConfig: ...
    def __deepcopy__(self, arg0: dict) -> HostConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Loop, console link, pipeline and flight recorder of a TeleopHost.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def console(self) -> ConsoleSocketConfig:
        """
        ConsoleSocketConfig
        """
    @console.setter
    def console(self, arg1: ConsoleSocketConfig) -> None: ...
    @property
    def loop(self) -> LoopConfig:
        """
        LoopConfig
        """
    @loop.setter
    def loop(self, arg1: LoopConfig) -> None: ...
    @property
    def pipeline(self) -> saras._core.pipeline.PipelineConfig:
        """
        saras.pipeline.PipelineConfig
        """
    @pipeline.setter
    def pipeline(self, arg1: saras._core.pipeline.PipelineConfig) -> None: ...
    @property
    def record_s(self) -> float:
        """
        length of the flight recorder [s]; 0: none
        """
    @record_s.setter
    def record_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def silent_period_s(self) -> float:
        """
        while no console is heard: a step this often [s]
        """
    @silent_period_s.setter
    def silent_period_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class FlightTick:
    """
    One step.
    """
    @property
    def dt_s(self) -> float:
        """
        [s]
        """
    @property
    def index(self) -> int:
        """
        counts steps since the start
        """
    @property
    def input(self) -> saras._core.pipeline.PipelineInput:
        """
        saras.pipeline.PipelineInput
        """
    @property
    def now_ns(self) -> int:
        """
        monotonic clock [ns]
        """
    @property
    def output(self) -> saras._core.pipeline.PipelineOutput:
        """
        saras.pipeline.PipelineOutput
        """
    @property
    def stamp_ns(self) -> int:
        """
        wall clock of the newest datagram [ns]
        """

class HostSnapshot:
    """
    What one step did.
    """
    @property
    def capsules(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 7) tip, trocar, radius of each tool in the world; NaN where unknown
        """
    @property
    def distances(self) -> list[saras._core.collision.ToolProximity]:
        """
        a saras.collision.ToolProximity for each tool; empty without the pipeline's own monitor
        """
    @property
    def held(self) -> bool:
        """
        the loop was too late: a side stands until its next engagement
        """
    @property
    def tick(self) -> FlightTick:
        """
        FlightTick
        """
    @property
    def up(self) -> saras._core.net.TouchballUp | None:
        """
        the newest saras.net.TouchballUp, or None
        """

class HostStatistics:
    """
    Counters and distributions of a host.
    """
    @property
    def handed(self) -> Histogram:
        """
        from the same to the set-points in their mailbox
        """
    @property
    def left_out(self) -> int:
        """
        steps that the flight recorder left out
        """
    @property
    def loop(self) -> LoopStatistics:
        """
        LoopStatistics
        """
    @property
    def reply(self) -> Histogram:
        """
        from a datagram's arrival in the kernel to the sending of the force
        """
    @property
    def silent_steps(self) -> int:
        """
        of those, without a datagram
        """
    @property
    def steps(self) -> int:
        """
        of the pipeline
        """

class TeleopHost:
    """
    Socket, pipeline and flight recorder in one real-time loop, in a thread of its own.

    Python starts, configures and observes it; nothing here holds the loop up. side: left, right.
    """
    def __init__(self, config: HostConfig) -> None:
        """
        Binds the socket. Raises ConfigError.
        """
    def counts(self) -> dict:
        """
        Datagrams by name, since the start.
        """
    def heard_ns(self) -> int:
        """
        Monotonic time at which the session was heard last [ns]; 0: not yet.
        """
    def link_age_s(self) -> float:
        """
        Age of the console's information [s].
        """
    def send(self, data: bytes) -> None:
        """
        Sends bytes to the console as they are: the answers of a handshake.
        """
    def set_arm_pose(
        self, side: str, base_T_tip: numpy.typing.ArrayLike, stamp_ns: typing.SupportsInt | typing.SupportsIndex
    ) -> None:
        """
        (4, 4) measured, and when [ns].
        """
    def set_arm_rcm(self, side: str, rcm: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None:
        """
        (3,) trocar, base frame [m].
        """
    def set_arm_wrench(self, side: str, exerted: numpy.typing.ArrayLike) -> None:
        """
        (6,) that the tip exerts on the tissue, base frame.
        """
    def set_nearness(self, side: str, nearness: saras._core.pipeline.NearnessInput) -> None:
        """
        saras.pipeline.NearnessInput; its age runs from now on.
        """
    def set_scene(self, scene: saras._core.pipeline.SceneInput) -> None:
        """
        saras.pipeline.SceneInput; its age runs from now on.
        """
    def set_session(self, up_key: bytes, down_key: bytes) -> None:
        """
        Keys (32 bytes each) of the session that a handshake began.
        """
    def set_supervisor(
        self,
        side: str,
        state: typing.SupportsInt | typing.SupportsIndex,
        engagement: typing.SupportsInt | typing.SupportsIndex,
        clutch: bool,
    ) -> None:
        """
        The supervisor's word; state: number of a saras.net.ChannelState.
        """
    def snapshot(self) -> HostSnapshot:
        """
        HostSnapshot of the step that wait() saw last.
        """
    def start(self) -> None: ...
    def statistics(self) -> HostStatistics:
        """
        HostStatistics
        """
    def stop(self) -> None: ...
    def take_handshake(self) -> bytes | None:
        """
        The next datagram of a handshake, or None.
        """
    def wait(self, timeout_s: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Waits for a step that this call has not seen; False after timeout_s. One thread at a time.
        """
    def write_record(self, path: str, reason: str) -> int:
        """
        Writes the flight record; returns its number of steps. Does not hold the loop up.
        """
    @property
    def config(self) -> HostConfig: ...
    @property
    def failure(self) -> str:
        """
        why the loop ended by itself; or empty
        """
    @property
    def port(self) -> int:
        """
        the bound UDP port
        """
    @property
    def report(self) -> RealtimeReport:
        """
        RealtimeReport; after start()
        """
    @property
    def running(self) -> bool: ...

class FlightRecord:
    """
    A flight record read back.
    """
    def arrays(self) -> dict:
        """
        Arrays over all n steps: index, time_s, stamp_s, dt_s, overrun, hold, tank_master_J, tank_slave_J (n,);
        state, handle_age_s, arm_age_s (n, 2, 1); handle, tip, set_point, hand_force, tissue_force (n, 2, 3).
        """
    def ticks(self, chunk: typing.SupportsInt | typing.SupportsIndex) -> list[FlightTick]:
        """
        The FlightTicks of one chunk.
        """
    @property
    def chunks(self) -> int: ...
    @property
    def config(self) -> saras._core.pipeline.PipelineConfig:
        """
        saras.pipeline.PipelineConfig
        """
    @property
    def reason(self) -> str:
        """
        why it was written
        """

class FlightReplay:
    """
    What a replay found.
    """
    @property
    def exact(self) -> int:
        """
        of those, with outputs equal to the bit
        """
    @property
    def first_difference(self) -> int:
        """
        index of the first step that differs; -1: none
        """
    @property
    def states(self) -> int:
        """
        states in the record that follow without a gap
        """
    @property
    def states_exact(self) -> int:
        """
        of those, equal to what the replay reached
        """
    @property
    def ticks(self) -> int:
        """
        steps
        """

def monotonic_ns() -> int:
    """
    The loop's clock [ns].
    """

def read_flight(path: str) -> FlightRecord:
    """
    Reads a record. Raises ProtocolError, Error.
    """

def replay_flight(record: FlightRecord) -> FlightReplay:
    """
    Steps a pipeline through the record and compares.
    """
