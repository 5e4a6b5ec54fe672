"""
Datagram codecs
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core
import typing
import typing_extensions

__all__: list[str] = [
    "CSA_MAX_JOINTS",
    "ChannelState",
    "CsaDown",
    "CsaHandshake",
    "CsaHold",
    "CsaMode",
    "CsaSlaveState",
    "CsaUp",
    "GuardState",
    "LinkAge",
    "PortLedger",
    "ReplayVerdict",
    "ReplayWindow",
    "SequenceCounts",
    "SequenceFilter",
    "SimballJoints",
    "TAG_SIZE",
    "TRAILER_SIZE",
    "TouchballDown",
    "TouchballDownSide",
    "TouchballHandshake",
    "TouchballUp",
    "TouchballUpSide",
    "crc32",
    "seal",
]

class ChannelState:
    """
    Whether one side teleoperates. Same numbers as saras_ros1/ChannelState.

    Members:

      WAITING

      READY

      ENGAGED

      HOLD
    """

    ENGAGED: typing.ClassVar[ChannelState]
    HOLD: typing.ClassVar[ChannelState]
    READY: typing.ClassVar[ChannelState]
    WAITING: typing.ClassVar[ChannelState]
    __members__: typing.ClassVar[dict[str, ChannelState]]
    @typing.overload
    def __eq__(self, other: ChannelState) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ChannelState) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SimballJoints:
    """
    Joints of the Simball handle.
    """

    _fields: typing.ClassVar[list] = ["yaw_rad", "pitch_rad", "roll_rad", "insertion_m"]
    def __copy__(self) -> SimballJoints: ...
    def __deepcopy__(self, arg0: dict) -> SimballJoints: ...
    def __init__(self, **kwargs) -> None:
        """
        Joints of the Simball handle.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def insertion_m(self) -> float:
        """
        [m]
        """
    @insertion_m.setter
    def insertion_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def pitch_rad(self) -> float:
        """
        [rad]
        """
    @pitch_rad.setter
    def pitch_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def roll_rad(self) -> float:
        """
        [rad]; turns the instrument
        """
    @roll_rad.setter
    def roll_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def yaw_rad(self) -> float:
        """
        [rad]
        """
    @yaw_rad.setter
    def yaw_rad(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class PortLedger:
    """
    Energy sent to the peer's tank, cumulative over a session.
    """

    _fields: typing.ClassVar[list] = ["session", "seq", "sent_J", "requesting", "has_room"]
    def __copy__(self) -> PortLedger: ...
    def __deepcopy__(self, arg0: dict) -> PortLedger: ...
    def __init__(self, **kwargs) -> None:
        """
        Energy sent to the peer's tank, cumulative over a session.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def has_room(self) -> bool:
        """
        the sender's tank can take more
        """
    @has_room.setter
    def has_room(self, arg1: bool) -> None: ...
    @property
    def requesting(self) -> bool:
        """
        the sender's tank asks for energy
        """
    @requesting.setter
    def requesting(self, arg1: bool) -> None: ...
    @property
    def sent_J(self) -> float:
        """
        cumulative energy sent in this session [J], >= 0
        """
    @sent_J.setter
    def sent_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def seq(self) -> int:
        """
        counts messages of this session
        """
    @seq.setter
    def seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        larger for every restart of the sending tank
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class GuardState:
    """
    The port guard's tank, for display and recording only.
    """

    _fields: typing.ClassVar[list] = [
        "energy_J",
        "minimum_J",
        "request_J",
        "available_J",
        "maximum_J",
        "reduction",
        "scale",
        "damping",
        "work_out_J",
        "received_J",
        "vented_J",
        "granted_J",
        "status",
    ]
    def __copy__(self) -> GuardState: ...
    def __deepcopy__(self, arg0: dict) -> GuardState: ...
    def __init__(self, **kwargs) -> None:
        """
        The port guard's tank, for display and recording only.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def available_J(self) -> float:
        """
        threshold [J]
        """
    @available_J.setter
    def available_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[6, 1]"]:
        """
        (6,) B now [N s/m, N m s/rad]
        """
    @damping.setter
    def damping(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[6, 1]"]) -> None: ...
    @property
    def energy_J(self) -> float:
        """
        stored energy [J]
        """
    @energy_J.setter
    def energy_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def granted_J(self) -> float:
        """
        cumulative energy granted [J]
        """
    @granted_J.setter
    def granted_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def maximum_J(self) -> float:
        """
        threshold [J]
        """
    @maximum_J.setter
    def maximum_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def minimum_J(self) -> float:
        """
        threshold [J]
        """
    @minimum_J.setter
    def minimum_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def received_J(self) -> float:
        """
        cumulative energy credited from tank_master [J]
        """
    @received_J.setter
    def received_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def reduction(self) -> float:
        """
        K_E in [0, 1]
        """
    @reduction.setter
    def reduction(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def request_J(self) -> float:
        """
        threshold [J]
        """
    @request_J.setter
    def request_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def scale(self) -> float:
        """
        alpha in [0, 1]
        """
    @scale.setter
    def scale(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        saras.Status
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def vented_J(self) -> float:
        """
        cumulative energy discarded [J]
        """
    @vented_J.setter
    def vented_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def work_out_J(self) -> float:
        """
        cumulative work done on the operator [J]
        """
    @work_out_J.setter
    def work_out_J(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class TouchballUpSide:
    """
    One handle, console to platform.
    """

    _fields: typing.ClassVar[list] = [
        "present",
        "calibrated",
        "clutch",
        "clip",
        "simball_T_handle",
        "handle_position_m",
        "handle_quaternion_xyzw",
        "joints",
        "grip",
        "ledger",
        "guard",
    ]
    def __copy__(self) -> TouchballUpSide: ...
    def __deepcopy__(self, arg0: dict) -> TouchballUpSide: ...
    def __init__(self, **kwargs) -> None:
        """
        One handle, console to platform.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def calibrated(self) -> bool:
        """
        its joints and clip were calibrated
        """
    @calibrated.setter
    def calibrated(self, arg1: bool) -> None: ...
    @property
    def clip(self) -> bool:
        """
        the clip is closed; a level
        """
    @clip.setter
    def clip(self, arg1: bool) -> None: ...
    @property
    def clutch(self) -> bool:
        """
        pressed; a level, repeated in every datagram
        """
    @clutch.setter
    def clutch(self, arg1: bool) -> None: ...
    @property
    def grip(self) -> float:
        """
        opening of the clip: 0 closed to 1 open
        """
    @grip.setter
    def grip(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def guard(self) -> GuardState:
        """
        the port guard's tank, for display
        """
    @guard.setter
    def guard(self, arg1: GuardState) -> None: ...
    @property
    def handle_position_m(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) as on the wire [m]
        """
    @handle_position_m.setter
    def handle_position_m(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def handle_quaternion_xyzw(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) unit quaternion as on the wire, scalar last
        """
    @handle_quaternion_xyzw.setter
    def handle_quaternion_xyzw(
        self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]
    ) -> None: ...
    @property
    def joints(self) -> SimballJoints:
        """
        SimballJoints
        """
    @joints.setter
    def joints(self, arg1: SimballJoints) -> None: ...
    @property
    def ledger(self) -> PortLedger:
        """
        the port guard's, to tank_master
        """
    @ledger.setter
    def ledger(self, arg1: PortLedger) -> None: ...
    @property
    def present(self) -> bool:
        """
        a handle is attached and gives valid readings
        """
    @present.setter
    def present(self, arg1: bool) -> None: ...
    @property
    def simball_T_handle(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) handle in simball_base
        """
    @simball_T_handle.setter
    def simball_T_handle(self, arg1: numpy.typing.ArrayLike) -> None: ...

class TouchballUp:
    """
    Datagram from a console to the platform.
    """

    SIZE: typing.ClassVar[int] = 580
    _fields: typing.ClassVar[list] = ["session", "seq", "sender_time_ns", "left", "right"]
    @staticmethod
    def check_frame(data: typing_extensions.Buffer, authenticated: bool) -> None:
        """
        Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.
        """
    @staticmethod
    def decode(data: typing_extensions.Buffer, authenticated: bool = False) -> TouchballUp:
        """
        Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.
        """
    def __copy__(self) -> TouchballUp: ...
    def __deepcopy__(self, arg0: dict) -> TouchballUp: ...
    def __init__(self, **kwargs) -> None:
        """
        Datagram from a console to the platform.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def encode(self, authenticated: bool = False) -> bytes:
        """
        Bytes; raises ProtocolError. An authenticated datagram is whole only after seal().
        """
    @property
    def left(self) -> TouchballUpSide:
        """
        TouchballUpSide
        """
    @left.setter
    def left(self, arg1: TouchballUpSide) -> None: ...
    @property
    def right(self) -> TouchballUpSide:
        """
        TouchballUpSide
        """
    @right.setter
    def right(self, arg1: TouchballUpSide) -> None: ...
    @property
    def sender_time_ns(self) -> int:
        """
        sender's monotonic clock [ns]
        """
    @sender_time_ns.setter
    def sender_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def seq(self) -> int:
        """
        counts datagrams of this session
        """
    @seq.setter
    def seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        larger for every restart of the console
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class TouchballDownSide:
    """
    One handle, platform to console.
    """

    _fields: typing.ClassVar[list] = ["touch_wrench", "state", "engagement", "ledger"]
    def __copy__(self) -> TouchballDownSide: ...
    def __deepcopy__(self, arg0: dict) -> TouchballDownSide: ...
    def __init__(self, **kwargs) -> None:
        """
        One handle, platform to console.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def engagement(self) -> int:
        """
        counts engagements
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def ledger(self) -> PortLedger:
        """
        tank_master's, to this port guard
        """
    @ledger.setter
    def ledger(self, arg1: PortLedger) -> None: ...
    @property
    def state(self) -> ChannelState:
        """
        ChannelState
        """
    @state.setter
    def state(self, arg1: ChannelState) -> None: ...
    @property
    def touch_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) to exert on the hand, touch frame [N, N m]
        """
    @touch_wrench.setter
    def touch_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...

class TouchballDown:
    """
    Datagram from the platform to a console.
    """

    SIZE: typing.ClassVar[int] = 260
    _fields: typing.ClassVar[list] = [
        "session",
        "seq",
        "sender_time_ns",
        "echo_session",
        "echo_seq",
        "echo_time_ns",
        "echo_hold_ns",
        "left",
        "right",
    ]
    @staticmethod
    def check_frame(data: typing_extensions.Buffer, authenticated: bool) -> None:
        """
        Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.
        """
    @staticmethod
    def decode(data: typing_extensions.Buffer, authenticated: bool = False) -> TouchballDown:
        """
        Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.
        """
    def __copy__(self) -> TouchballDown: ...
    def __deepcopy__(self, arg0: dict) -> TouchballDown: ...
    def __init__(self, **kwargs) -> None:
        """
        Datagram from the platform to a console.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def encode(self, authenticated: bool = False) -> bytes:
        """
        Bytes; raises ProtocolError. An authenticated datagram is whole only after seal().
        """
    @property
    def echo_hold_ns(self) -> int:
        """
        from its arrival to the sending of this datagram [ns]
        """
    @echo_hold_ns.setter
    def echo_hold_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_seq(self) -> int:
        """
        its seq
        """
    @echo_seq.setter
    def echo_seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_session(self) -> int:
        """
        newest up datagram seen; 0: none yet
        """
    @echo_session.setter
    def echo_session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_time_ns(self) -> int:
        """
        its sender_time_ns
        """
    @echo_time_ns.setter
    def echo_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def left(self) -> TouchballDownSide:
        """
        TouchballDownSide
        """
    @left.setter
    def left(self, arg1: TouchballDownSide) -> None: ...
    @property
    def right(self) -> TouchballDownSide:
        """
        TouchballDownSide
        """
    @right.setter
    def right(self, arg1: TouchballDownSide) -> None: ...
    @property
    def sender_time_ns(self) -> int:
        """
        sender's monotonic clock [ns]
        """
    @sender_time_ns.setter
    def sender_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def seq(self) -> int:
        """
        counts datagrams of this session
        """
    @seq.setter
    def seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        larger for every restart of the platform's sender
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class TouchballHandshake:
    """
    Message that begins an authenticated session.
    """

    SIZE: typing.ClassVar[int] = 60
    _fields: typing.ClassVar[list] = ["nonce", "echo"]
    @staticmethod
    def check_frame(data: typing_extensions.Buffer, authenticated: bool = True) -> None:
        """
        Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.
        """
    @staticmethod
    def decode(data: typing_extensions.Buffer) -> TouchballHandshake:
        """
        Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.
        """
    def __copy__(self) -> TouchballHandshake: ...
    def __deepcopy__(self, arg0: dict) -> TouchballHandshake: ...
    def __init__(self, **kwargs) -> None:
        """
        Message that begins an authenticated session.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def encode(self) -> bytes:
        """
        Bytes, whole only after seal().
        """
    @property
    def echo(self) -> bytes:
        """
        (16 bytes) the receiver's own nonce, as the sender heard it; 0: none
        """
    @echo.setter
    def echo(self, arg1: bytes) -> None: ...
    @property
    def nonce(self) -> bytes:
        """
        (16 bytes) drawn by the sender
        """
    @nonce.setter
    def nonce(self, arg1: bytes) -> None: ...

class SequenceCounts:
    """
    What a SequenceFilter saw [datagrams].
    """

    _fields: typing.ClassVar[list] = ["accepted", "duplicate", "out_of_order", "old_session", "gaps", "sessions"]
    def __copy__(self) -> SequenceCounts: ...
    def __deepcopy__(self, arg0: dict) -> SequenceCounts: ...
    def __init__(self, **kwargs) -> None:
        """
        What a SequenceFilter saw [datagrams].
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def accepted(self) -> int:
        """
        newer than all before
        """
    @accepted.setter
    def accepted(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def duplicate(self) -> int:
        """
        already received
        """
    @duplicate.setter
    def duplicate(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def gaps(self) -> int:
        """
        numbers skipped by an accepted one
        """
    @gaps.setter
    def gaps(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def old_session(self) -> int:
        """
        from an earlier run of the sender
        """
    @old_session.setter
    def old_session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def out_of_order(self) -> int:
        """
        older than the newest
        """
    @out_of_order.setter
    def out_of_order(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def sessions(self) -> int:
        """
        sessions seen
        """
    @sessions.setter
    def sessions(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class SequenceFilter:
    """
    Newest-wins filter: nothing is delivered backwards or twice.
    """
    def __init__(self) -> None: ...
    def accept(
        self, session: typing.SupportsInt | typing.SupportsIndex, seq: typing.SupportsInt | typing.SupportsIndex
    ) -> bool:
        """
        True when strictly newer.
        """
    def restart(self) -> None:
        """
        A handshake began a new session: the next datagram is newest.
        """
    @property
    def counts(self) -> SequenceCounts: ...
    @property
    def seq(self) -> int: ...
    @property
    def session(self) -> int: ...

class ReplayVerdict:
    """
    What a ReplayWindow says to a sequence number.

    Members:

      NEW

      REPLAYED

      TOO_OLD

      FAR_AHEAD
    """

    FAR_AHEAD: typing.ClassVar[ReplayVerdict]
    NEW: typing.ClassVar[ReplayVerdict]
    REPLAYED: typing.ClassVar[ReplayVerdict]
    TOO_OLD: typing.ClassVar[ReplayVerdict]
    __members__: typing.ClassVar[dict[str, ReplayVerdict]]
    @typing.overload
    def __eq__(self, other: ReplayVerdict) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: ReplayVerdict) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class ReplayWindow:
    """
    Newest 64 sequence numbers of an authenticated session (RFC 6479).
    """

    MOST_AHEAD: typing.ClassVar[int] = 1048576
    SIZE: typing.ClassVar[int] = 64
    def __init__(self) -> None: ...
    def accept(self, seq: typing.SupportsInt | typing.SupportsIndex) -> ReplayVerdict:
        """
        ReplayVerdict; notes seq when NEW, else changes nothing. For authenticated datagrams only.
        """
    def reset(self) -> None:
        """
        For a new session.
        """
    @property
    def newest(self) -> int: ...

class LinkAge:
    """
    Age of received information above the link's least delay.
    """
    def __init__(self, rise_rate: typing.SupportsFloat | typing.SupportsIndex = 0.005) -> None: ...
    def age_s(self, now_ns: typing.SupportsInt | typing.SupportsIndex) -> float:
        """
        Age of the newest information [s]; inf before the first packet.
        """
    def received(
        self, send_ns: typing.SupportsInt | typing.SupportsIndex, receive_ns: typing.SupportsInt | typing.SupportsIndex
    ) -> float:
        """
        Age of this packet on arrival [s].
        """
    def reset(self) -> None:
        """
        Forget the minimum (new session, new clock).
        """

class CsaSlaveState:
    """
    Operating state of a slave arm, as in CRTK.

    Members:

      DISABLED

      ENABLED

      PAUSED

      FAULT
    """

    DISABLED: typing.ClassVar[CsaSlaveState]
    ENABLED: typing.ClassVar[CsaSlaveState]
    FAULT: typing.ClassVar[CsaSlaveState]
    PAUSED: typing.ClassVar[CsaSlaveState]
    __members__: typing.ClassVar[dict[str, CsaSlaveState]]
    @typing.overload
    def __eq__(self, other: CsaSlaveState) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: CsaSlaveState) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class CsaHold:
    """
    Whether a slave follows, and why not.

    Members:

      NONE

      NOT_ENGAGED

      NO_SET_POINT

      REFUSED

      DEVICE_FAULT
    """

    DEVICE_FAULT: typing.ClassVar[CsaHold]
    NONE: typing.ClassVar[CsaHold]
    NOT_ENGAGED: typing.ClassVar[CsaHold]
    NO_SET_POINT: typing.ClassVar[CsaHold]
    REFUSED: typing.ClassVar[CsaHold]
    __members__: typing.ClassVar[dict[str, CsaHold]]
    @typing.overload
    def __eq__(self, other: CsaHold) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: CsaHold) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class CsaMode:
    """
    What a slave is to follow.

    Members:

      HOLD

      JOINTS

      CARTESIAN
    """

    CARTESIAN: typing.ClassVar[CsaMode]
    HOLD: typing.ClassVar[CsaMode]
    JOINTS: typing.ClassVar[CsaMode]
    __members__: typing.ClassVar[dict[str, CsaMode]]
    @typing.overload
    def __eq__(self, other: CsaMode) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: CsaMode) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class CsaUp:
    """
    Datagram of a slave arm: what it measures, and whether it follows.
    """

    SIZE: typing.ClassVar[int] = 548
    _fields: typing.ClassVar[list] = [
        "session",
        "seq",
        "sender_time_ns",
        "echo_session",
        "echo_seq",
        "echo_time_ns",
        "echo_hold_ns",
        "homed",
        "has_force",
        "state",
        "hold",
        "engagement",
        "position",
        "velocity",
        "effort",
        "base_T_tip",
        "tip_position_m",
        "tip_quaternion_xyzw",
        "tip_twist",
        "tip_wrench",
    ]
    @staticmethod
    def check_frame(data: typing_extensions.Buffer, authenticated: bool) -> None:
        """
        Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.
        """
    @staticmethod
    def decode(data: typing_extensions.Buffer, authenticated: bool = False) -> CsaUp:
        """
        Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.
        """
    def __copy__(self) -> CsaUp: ...
    def __deepcopy__(self, arg0: dict) -> CsaUp: ...
    def __init__(self, **kwargs) -> None:
        """
        Datagram of a slave arm: what it measures, and whether it follows.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def encode(self, authenticated: bool = False) -> bytes:
        """
        Bytes; raises ProtocolError. An authenticated datagram is whole only after seal().
        """
    @property
    def base_T_tip(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) tip in the slave's base frame
        """
    @base_T_tip.setter
    def base_T_tip(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def echo_hold_ns(self) -> int:
        """
        from its arrival to the sending of this one [ns]
        """
    @echo_hold_ns.setter
    def echo_hold_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_seq(self) -> int:
        """
        its seq
        """
    @echo_seq.setter
    def echo_seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_session(self) -> int:
        """
        newest of the other direction; 0: none yet
        """
    @echo_session.setter
    def echo_session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_time_ns(self) -> int:
        """
        its sender_time_ns
        """
    @echo_time_ns.setter
    def echo_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def effort(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) [N m, N]; 0 where it is not measured
        """
    @effort.setter
    def effort(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None: ...
    @property
    def engagement(self) -> int:
        """
        the one that it follows, or that it ended
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def has_force(self) -> bool:
        """
        tip_wrench is measured; else it means nothing
        """
    @has_force.setter
    def has_force(self, arg1: bool) -> None: ...
    @property
    def hold(self) -> CsaHold:
        """
        CsaHold
        """
    @hold.setter
    def hold(self, arg1: CsaHold) -> None: ...
    @property
    def homed(self) -> bool:
        """
        ready to be enabled
        """
    @homed.setter
    def homed(self, arg1: bool) -> None: ...
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) n = 1 … 12 joints [rad] or [m]
        """
    @position.setter
    def position(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None: ...
    @property
    def sender_time_ns(self) -> int:
        """
        sender's monotonic clock [ns]
        """
    @sender_time_ns.setter
    def sender_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def seq(self) -> int:
        """
        counts datagrams of this session
        """
    @seq.setter
    def seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        larger for every restart of the sender
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def state(self) -> CsaSlaveState:
        """
        CsaSlaveState
        """
    @state.setter
    def state(self, arg1: CsaSlaveState) -> None: ...
    @property
    def tip_position_m(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) as on the wire [m]
        """
    @tip_position_m.setter
    def tip_position_m(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def tip_quaternion_xyzw(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) unit quaternion as on the wire, scalar last
        """
    @tip_quaternion_xyzw.setter
    def tip_quaternion_xyzw(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...
    @property
    def tip_twist(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) of the tip, base axes
        """
    @tip_twist.setter
    def tip_twist(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def tip_wrench(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (6,) exerted on the tissue, at the tip, base axes
        """
    @tip_wrench.setter
    def tip_wrench(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def velocity(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) [rad/s, m/s]
        """
    @velocity.setter
    def velocity(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None: ...

class CsaDown:
    """
    Datagram to a slave arm: its set-point.
    """

    SIZE: typing.ClassVar[int] = 252
    _fields: typing.ClassVar[list] = [
        "session",
        "seq",
        "sender_time_ns",
        "echo_session",
        "echo_seq",
        "echo_time_ns",
        "echo_hold_ns",
        "mode",
        "engagement",
        "position",
        "base_T_tip",
        "tip_position_m",
        "tip_quaternion_xyzw",
    ]
    @staticmethod
    def check_frame(data: typing_extensions.Buffer, authenticated: bool) -> None:
        """
        Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.
        """
    @staticmethod
    def decode(data: typing_extensions.Buffer, authenticated: bool = False) -> CsaDown:
        """
        Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.
        """
    def __copy__(self) -> CsaDown: ...
    def __deepcopy__(self, arg0: dict) -> CsaDown: ...
    def __init__(self, **kwargs) -> None:
        """
        Datagram to a slave arm: its set-point.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def encode(self, authenticated: bool = False) -> bytes:
        """
        Bytes; raises ProtocolError. An authenticated datagram is whole only after seal().
        """
    @property
    def base_T_tip(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4) tip in the slave's base frame
        """
    @base_T_tip.setter
    def base_T_tip(self, arg1: numpy.typing.ArrayLike) -> None: ...
    @property
    def echo_hold_ns(self) -> int:
        """
        from its arrival to the sending of this one [ns]
        """
    @echo_hold_ns.setter
    def echo_hold_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_seq(self) -> int:
        """
        its seq
        """
    @echo_seq.setter
    def echo_seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_session(self) -> int:
        """
        newest of the other direction; 0: none yet
        """
    @echo_session.setter
    def echo_session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def echo_time_ns(self) -> int:
        """
        its sender_time_ns
        """
    @echo_time_ns.setter
    def echo_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def engagement(self) -> int:
        """
        larger for every engagement; 0: none
        """
    @engagement.setter
    def engagement(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def mode(self) -> CsaMode:
        """
        CsaMode
        """
    @mode.setter
    def mode(self, arg1: CsaMode) -> None: ...
    @property
    def position(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n,) set-point with JOINTS, else empty [rad] or [m]
        """
    @position.setter
    def position(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> None: ...
    @property
    def sender_time_ns(self) -> int:
        """
        sender's monotonic clock [ns]
        """
    @sender_time_ns.setter
    def sender_time_ns(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def seq(self) -> int:
        """
        counts datagrams of this session
        """
    @seq.setter
    def seq(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def session(self) -> int:
        """
        larger for every restart of the sender
        """
    @session.setter
    def session(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def tip_position_m(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) as on the wire [m]
        """
    @tip_position_m.setter
    def tip_position_m(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def tip_quaternion_xyzw(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 1]"]:
        """
        (4,) unit quaternion as on the wire, scalar last
        """
    @tip_quaternion_xyzw.setter
    def tip_quaternion_xyzw(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 1]"]) -> None: ...

class CsaHandshake:
    """
    Message that begins an authenticated session.
    """

    SIZE: typing.ClassVar[int] = 60
    _fields: typing.ClassVar[list] = ["nonce", "echo"]
    @staticmethod
    def check_frame(data: typing_extensions.Buffer, authenticated: bool = True) -> None:
        """
        Length, magic, version, and a tag or none as wanted: what is checked before the tag. Raises ProtocolError.
        """
    @staticmethod
    def decode(data: typing_extensions.Buffer) -> CsaHandshake:
        """
        Strict; raises ProtocolError naming field and value. The tag is the caller's to check, before.
        """
    def __copy__(self) -> CsaHandshake: ...
    def __deepcopy__(self, arg0: dict) -> CsaHandshake: ...
    def __init__(self, **kwargs) -> None:
        """
        Message that begins an authenticated session.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    def encode(self) -> bytes:
        """
        Bytes, whole only after seal().
        """
    @property
    def echo(self) -> bytes:
        """
        (16 bytes) the receiver's own nonce, as the sender heard it; 0: none
        """
    @echo.setter
    def echo(self, arg1: bytes) -> None: ...
    @property
    def nonce(self) -> bytes:
        """
        (16 bytes) drawn by the sender
        """
    @nonce.setter
    def nonce(self, arg1: bytes) -> None: ...

def crc32(data: typing_extensions.Buffer) -> int:
    """
    CRC-32 of IEEE 802.3, as zlib.crc32.
    """

def seal(data: bytes, tag: bytes) -> bytes:
    """
    An encoded datagram with its tag (16 bytes) and checksum at the end. The tag is that of data[:-TRAILER_SIZE].
    """

CSA_MAX_JOINTS: int = 12
TAG_SIZE: int = 16
TRAILER_SIZE: int = 20
