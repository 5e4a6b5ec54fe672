"""The SARAS arm protocol over Socket.IO: message types, their JSON form and their checks.

The vendor's wire format is not public; this one is the platform's own (docs/protocols.md). SI units,
poses in the arm's base frame ``mesa_*/sbs_world``, quaternions x, y, z, w. Commands carry a header
(session, seq, echo_tick, max_age_s) that lets the arm drop what is old, replayed or of another session.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from saras.mesa_link.fields import MessageError, Reader

PROTOCOL_VERSION = 1
JOINTS = 6  # scara_1, scara_2, universal_1, universal_2, insertion, roll
PASSIVE_JOINTS = 7  # the positioning arm
MODES = ("pivot", "parallel")
COMMANDS = ("set_target", "set_max_velocity", "tool", "set_rcm", "set_mode", "brake", "heartbeat")


class Reason:
    """Why a command was refused: the ``reason`` of a nack and the keys of ``state.dropped``."""

    MALFORMED = "malformed"  # not JSON, wrong type, missing field, out of range
    NON_FINITE = "non_finite"  # NaN or infinity
    VERSION = "version"  # another protocol version
    BUSY = "busy"  # another client is in control
    NOT_IN_CONTROL = "not_in_control"  # the sender is a reader
    OLD_SESSION = "old_session"
    REPLAYED = "replayed"  # seq not above the last one of this session
    EXPIRED = "expired"  # older than max_age_s on the arm's clock, or than the arm's own limit
    UNREACHABLE = "unreachable"  # no joint position within the limits reaches it
    MOVING = "moving"  # allowed at rest only
    BRAKES_OPEN = "brakes_open"  # the positioning arm is loose
    UNSUPPORTED = "unsupported"  # this arm cannot do that


@dataclass(frozen=True)
class Hello:
    """First message of a client. ``control`` asks for the only controlling place."""

    protocol: int
    client: str
    control: bool
    state_rate_hz: float = 1000.0  # states wanted; the arm sends the nearest whole fraction of its own rate
    truth_rate_hz: float = 0.0  # ground truth wanted of a simulated arm, 0 none: tests, reports and displays only

    @classmethod
    def parse(cls, data: object) -> Hello:
        """Check and convert; MessageError names the field."""
        read = Reader("hello", data)
        protocol = read.integer("protocol")
        if protocol != PROTOCOL_VERSION:
            raise MessageError(Reason.VERSION, f"hello.protocol: this arm speaks {PROTOCOL_VERSION}, got {protocol}")
        return cls(
            protocol,
            read.text("client", longest=80),
            read.boolean("control"),
            read.number("state_rate_hz", 1.0, 1000.0) if read.has("state_rate_hz") else 1000.0,
            read.number("truth_rate_hz", 0.0, 1000.0) if read.has("truth_rate_hz") else 0.0,
        )


@dataclass(frozen=True)
class Header:
    """What every command begins with. ``echo_tick`` is the newest state the sender had when it decided."""

    session: int
    seq: int
    echo_tick: int
    max_age_s: float

    @classmethod
    def read(cls, read: Reader) -> Header:
        """The header fields of a command."""
        return cls(
            read.integer("session"), read.integer("seq"), read.integer("echo_tick"), read.number("max_age_s", 0.0, 10.0)
        )


@dataclass(frozen=True)
class Target:
    """Where the tip shall be: position [m] and quaternion (x, y, z, w) in the arm's base frame."""

    position: tuple[float, ...]
    quaternion: tuple[float, ...]

    @classmethod
    def read(cls, read: Reader) -> Target:
        """Position and quaternion of ``read``."""
        return cls(read.vector("position", 3), read.quaternion("quaternion"))


@dataclass(frozen=True)
class Tool:
    """Jaw 0 (closed) to 1 (open); roll [rad] absolute, None: the roll follows the target's orientation."""

    jaw: float
    jaw_velocity_1_s: float
    roll_rad: float | None
    roll_velocity_rad_s: float

    @classmethod
    def read(cls, read: Reader) -> Tool:
        """The tool fields of ``read``."""
        return cls(
            read.number("jaw", 0.0, 1.0),
            read.number("jaw_velocity_1_s", 0.0, 100.0),
            read.number("roll_rad", -100.0, 100.0) if read.has("roll_rad") else None,
            read.number("roll_velocity_rad_s", 0.0, 100.0),
        )


@dataclass(frozen=True)
class MaxVelocity:
    """Bounds on the tip's motion, the arm's own limits stay on top."""

    linear_m_s: float
    angular_rad_s: float

    @classmethod
    def read(cls, read: Reader) -> MaxVelocity:
        """The velocity fields of ``read``."""
        return cls(read.number("linear_m_s", 0.0, 1.0), read.number("angular_rad_s", 0.0, 10.0))


@dataclass(frozen=True)
class TargetInEffect:
    """The target the servo used at the very sample it is reported with, and the command it came from."""

    session: int
    seq: int
    position: tuple[float, ...]
    quaternion: tuple[float, ...]

    @classmethod
    def parse(cls, read: Reader) -> TargetInEffect:
        """Check and convert."""
        return cls(
            read.integer("session"), read.integer("seq"), read.vector("position", 3), read.quaternion("quaternion")
        )


@dataclass(frozen=True)
class State:
    """One sample of the arm. ``time_s`` is its time on the arm's own monotonic clock: compare it with nothing else."""

    tick: int
    time_s: float
    period_s: float  # of a tick: machine time between two states
    joints: tuple[float, ...]  # JOINTS values, rad, insertion in m
    joint_velocities: tuple[float, ...]
    jaw: float
    passive: tuple[float, ...]  # PASSIVE_JOINTS values, rad
    position: tuple[float, ...]  # tip in the base frame, m
    quaternion: tuple[float, ...]
    rcm: tuple[float, ...]  # trocar in the base frame, m
    mode: str
    brakes: bool  # the positioning arm is locked
    following: bool  # True: a target is followed; False: the arm holds
    target: TargetInEffect
    controller: str  # name of the client in control, "" for none
    session: int  # the controlling session, 0 for none
    last_seq: int  # newest command that the arm took in this session: it stands still only when the sender does
    dropped: dict[str, int] = field(default_factory=dict)  # by Reason, since the arm started
    fault: str = ""
    wrench: tuple[float, ...] | None = None  # exerted on the tissue, base axes, at the tip; None without a sensor

    def to_json(self) -> dict[str, Any]:
        """The JSON object of a ``state`` event."""
        data = dict(self.__dict__)
        data["target"] = self.target.__dict__
        if self.wrench is None:
            del data["wrench"]
        return data

    @classmethod
    def parse(cls, data: object) -> State:
        """Check and convert; MessageError names the field."""
        read = Reader("state", data)
        return cls(
            tick=read.integer("tick"),
            time_s=read.number("time_s"),
            period_s=read.number("period_s", 1e-4, 0.1),
            joints=read.vector("joints", JOINTS),
            joint_velocities=read.vector("joint_velocities", JOINTS),
            jaw=read.number("jaw", 0.0, 1.0),
            passive=read.vector("passive", PASSIVE_JOINTS),
            position=read.vector("position", 3),
            quaternion=read.quaternion("quaternion"),
            rcm=read.vector("rcm", 3),
            mode=read.text("mode", MODES),
            brakes=read.boolean("brakes"),
            following=read.boolean("following"),
            target=TargetInEffect.parse(read.part("target")),
            controller=read.text("controller"),
            session=read.integer("session"),
            last_seq=read.integer("last_seq"),
            dropped=read.counters("dropped"),
            fault=read.text("fault"),
            wrench=read.vector("wrench", 6) if read.has("wrench") else None,
        )


@dataclass(frozen=True)
class Truth:
    """What only a simulation knows, for tests, reports and displays. Never an input of control."""

    tick: int
    depth_m: float  # of the tip below the undisturbed tissue surface
    tip_force: tuple[float, ...]  # exerted on the tissue, base axes, N
    rcm_deviation_m: float  # distance of the shaft line from the trocar

    @classmethod
    def parse(cls, data: object) -> Truth:
        """Check and convert; MessageError names the field."""
        read = Reader("truth", data)
        return cls(
            read.integer("tick"), read.number("depth_m"), read.vector("tip_force", 3), read.number("rcm_deviation_m")
        )


def command(header: Header, *parts: Target | Tool | MaxVelocity, **fields: object) -> dict[str, Any]:
    """The JSON object of a command: header, the fields of each part, further fields."""
    data = asdict(header)
    for part in parts:
        data.update(asdict(part))
    data.update(fields)
    return data
