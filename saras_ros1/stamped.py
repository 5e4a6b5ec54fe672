"""geometry_msgs' stamped poses, twists and wrenches on the wire, plain numbers in the program.

rospy's own classes build five objects for each of these messages and copy each number by name, on both ends of every
connection. At 100 Hz and a dozen topics that is a third of a node's time. These classes carry the same type name,
checksum and bytes, so that every other ROS program sees the standard message; ``Node.input`` and ``convert`` use them.
"""

from __future__ import annotations

import struct
from typing import Any

import genpy
import rospy
from geometry_msgs.msg import PoseStamped, TwistStamped, WrenchStamped

NANOSECONDS = 1_000_000_000


def time_of(stamp_ns: int) -> rospy.Time:
    """Nanoseconds as a ROS time."""
    return rospy.Time(*divmod(stamp_ns, NANOSECONDS))


_HEADER = struct.Struct("<4I")  # seq, secs, nsecs, length of frame_id
_FRAME_AT = _HEADER.size
_MAX_FRAMES = 1000  # remembered names; a peer that makes up new ones must not fill the memory

_encoded: dict[str, bytes] = {}
_decoded: dict[bytes, str] = {}


class Stamped(genpy.Message):
    """A header and `numbers`, in the order of the standard message's fields.

    stamp_ns: nanoseconds since the epoch. `header` is the message itself: rospy writes `header.seq`.
    """

    __slots__ = ("_connection_header", "frame_id", "numbers", "seq", "stamp_ns")
    _has_header = True
    _standard: type
    _layout: struct.Struct

    def __init__(self, numbers: tuple[float, ...] = (), frame_id: str = "", stamp_ns: int = 0) -> None:
        self.numbers, self.frame_id, self.stamp_ns, self.seq = numbers, frame_id, stamp_ns, 0

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        standard = cls._standard
        cls._type, cls._md5sum, cls._full_text = standard._type, standard._md5sum, standard._full_text

    @property
    def header(self) -> Stamped:
        """Where rospy looks for seq and frame_id."""
        return self

    @property
    def stamp(self) -> rospy.Time:
        """stamp_ns for those who compute with ROS times."""
        return time_of(self.stamp_ns)

    def serialize(self, buff: Any) -> None:
        """Writes the standard message's bytes. Raises struct.error for a wrong count or kind of numbers."""
        frame = _encoded.get(self.frame_id) or _remember(_encoded, self.frame_id, self.frame_id.encode())
        secs, nsecs = divmod(self.stamp_ns, NANOSECONDS)
        buff.write(_HEADER.pack(self.seq, secs, nsecs, len(frame)) + frame + self._layout.pack(*self.numbers))

    def deserialize(self, data: bytes) -> Stamped:
        """Reads the standard message's bytes. Raises genpy.DeserializationError when they are too few or too many."""
        try:
            self.seq, secs, nsecs, size = _HEADER.unpack_from(data)
            end = _FRAME_AT + size
            self.numbers = self._layout.unpack(data[end:])
            frame = data[_FRAME_AT:end]
            self.frame_id = _decoded.get(frame) or _remember(_decoded, frame, frame.decode())
        except (struct.error, UnicodeDecodeError) as error:
            raise genpy.DeserializationError(f"{self._type}: {error}") from None
        self.stamp_ns = secs * NANOSECONDS + nsecs
        return self


class StampedPose(Stamped):
    """numbers: position x y z [m], orientation x y z w."""

    _standard, _layout = PoseStamped, struct.Struct("<7d")


class StampedTwist(Stamped):
    """numbers: linear x y z [m/s], angular x y z [rad/s]."""

    _standard, _layout = TwistStamped, struct.Struct("<6d")


class StampedWrench(Stamped):
    """numbers: force x y z [N], torque x y z [N m]."""

    _standard, _layout = WrenchStamped, struct.Struct("<6d")


_LEAN = {lean._standard: lean for lean in (StampedPose, StampedTwist, StampedWrench)}


def lean_class(message_class: type) -> type:
    """The class here that carries message_class's bytes, or message_class itself."""
    return _LEAN.get(message_class, message_class)


def _remember(names: dict, key: Any, value: Any) -> Any:
    if len(names) < _MAX_FRAMES:
        names[key] = value
    return value
