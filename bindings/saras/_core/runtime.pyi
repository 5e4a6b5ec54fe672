"""
The real-time host: loop, mailboxes, flight recorder
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core.collision
import saras._core.csa
import saras._core.model
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
    "ModelHost",
    "ModelHostConfig",
    "ModelHostStatistics",
    "Pacing",
    "RealtimeReport",
    "RealtimeRequest",
    "TeleopHost",
    "VertexMapConfig",
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
    def set_fixtures(self, side: str, word: saras._core.csa.FixtureWord) -> None:
        """
        saras.csa.FixtureWord; holds until the next one.
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

class VertexMapConfig:
    """
    Which vertices share a local model, and when they are asked again.
    """

    _fields: typing.ClassVar[list] = ["patch_m", "normal_cosine", "move_tolerance_m"]
    def __copy__(self) -> VertexMapConfig: ...
    def __deepcopy__(self, arg0: dict) -> VertexMapConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Which vertices share a local model, and when they are asked again.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def move_tolerance_m(self) -> float:
        """
        a vertex that has moved no further is not asked again [m]
        """
    @move_tolerance_m.setter
    def move_tolerance_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def normal_cosine(self) -> float:
        """
        vertices whose normals differ by more share none
        """
    @normal_cosine.setter
    def normal_cosine(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def patch_m(self) -> float:
        """
        edge of the cells whose vertices share one [m]
        """
    @patch_m.setter
    def patch_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class ModelHostConfig:
    """
    The live map's law, rates and room.
    """

    _fields: typing.ClassVar[list] = ["law", "vertices", "free_m", "near_m", "touched_hz", "map_hz", "room"]
    def __copy__(self) -> ModelHostConfig: ...
    def __deepcopy__(self, arg0: dict) -> ModelHostConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        The live map's law, rates and room.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def free_m(self) -> float:
        """
        so far outside the mesh nothing is touched: the sensor's offset is taken then [m]
        """
    @free_m.setter
    def free_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def law(self) -> saras._core.model.StiffnessGpConfig:
        """
        saras.model.StiffnessGpConfig
        """
    @law.setter
    def law(self, arg1: saras._core.model.StiffnessGpConfig) -> None: ...
    @property
    def map_hz(self) -> float:
        """
        a vertex that is out of date waits for no more than its inverse [1/s]
        """
    @map_hz.setter
    def map_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def near_m(self) -> float:
        """
        vertices this near to the tip are asked at touched_hz [m]
        """
    @near_m.setter
    def near_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def room(self) -> int:
        """
        samples that may wait to be learned; older ones are dropped and counted
        """
    @room.setter
    def room(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def touched_hz(self) -> float:
        """
        [1/s]
        """
    @touched_hz.setter
    def touched_hz(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def vertices(self) -> VertexMapConfig:
        """
        VertexMapConfig
        """
    @vertices.setter
    def vertices(self, arg1: VertexMapConfig) -> None: ...

class ModelHostStatistics:
    """
    Counters, and how long things took.
    """
    @property
    def asked(self) -> int:
        """
        vertices
        """
    @property
    def bias_N(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) the force sensor's offset [N]
        """
    @property
    def disagreement(self) -> float:
        """
        mean deviation of the samples from the map [sigma]
        """
    @property
    def dropped(self) -> int:
        """
        samples that found no room
        """
    @property
    def learning(self) -> Histogram:
        """
        Histogram of one sample
        """
    @property
    def places(self) -> int:
        """
        of samples that are remembered
        """
    @property
    def refreshes(self) -> int:
        """
        of the vertices near the tip
        """
    @property
    def refreshing(self) -> Histogram:
        """
        Histogram of a refresh
        """
    @property
    def stale(self) -> int:
        """
        patches out of date
        """
    @property
    def verdicts(self) -> dict:
        """
        samples since the last reset, by name of their SampleVerdict
        """
    @property
    def waiting(self) -> int:
        """
        samples
        """
    @property
    def waits(self) -> Histogram:
        """
        Histogram over refreshes of the longest time that a vertex was out of date
        """

class ModelHost:
    """
    The live map in C++ threads: nobody who brings samples or looks waits for learning.
    """
    def __init__(self, prior: saras._core.model.Mesh, config: ModelHostConfig = ...) -> None:
        """
        prior: saras.model.Mesh. Raises ConfigError.
        """
    def adopt(
        self,
        hyperparameters: saras._core.model.GpHyperparameters,
        generation: typing.SupportsInt | typing.SupportsIndex,
    ) -> bool:
        """
        Takes over hyper-parameters; False as `lay`. Raises ConfigError.
        """
    def lay(self, mesh: saras._core.model.Mesh, generation: typing.SupportsInt | typing.SupportsIndex) -> bool:
        """
        The mesh lies so from now on. False: all was forgotten since that generation. Raises ModelError.
        """
    def learn_waiting(self) -> None:
        """
        The learning thread's work, in the caller's thread.
        """
    def push(self, stamps: typing.Any, positions: typing.Any, forces: typing.Any, velocities: typing.Any) -> int:
        """
        Samples for the learning thread: stamps (n,) [s], (n, 3) tips [m], (n, 3) forces that the tool exerts [N],
        (n, 3) velocities [m/s]. How many waiting ones were dropped for want of room.
        """
    def refresh(self, all: bool = True) -> None:
        """
        The refreshing thread's work: all that is out of date, or one turn's share.
        """
    def reset(self, prior: saras._core.model.Mesh) -> None:
        """
        Forgets what was learned, and begins with this mesh.
        """
    def snapshot(self) -> tuple[saras._core.model.HashGrid, saras._core.model.LocalModelConfig, int]:
        """
        (a copy of the HashGrid, its LocalModelConfig, generation)
        """
    def start(self) -> None:
        """
        Starts both threads. Raises Error when they run.
        """
    def statistics(self) -> ModelHostStatistics: ...
    def stop(self) -> None:
        """
        After what the threads are at; safe to repeat.
        """
    def take_touched(self) -> tuple[saras._core.model.Mesh, numpy.typing.NDArray[numpy.int32], tuple]:
        """
        (Mesh, numbers (k,) of the vertices near the tip that were asked since the last call, (stiffness (k,),
        its deviation (k,))).
        """
    def view(self) -> tuple[saras._core.model.Mesh, tuple, int]:
        """
        (Mesh, (stiffness (n,) [N/m], its deviation (n,)), generation); NaN and infinite: not known.
        """
    def wait_touched(self, timeout_s: typing.SupportsFloat | typing.SupportsIndex) -> bool:
        """
        Until there is something for take_touched; False: there was nothing in timeout_s.
        """
    @property
    def config(self) -> ModelHostConfig: ...
    @property
    def failure(self) -> str:
        """
        why a thread ended by itself; empty when none did
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
