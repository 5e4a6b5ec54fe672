"""The lean classes carry exactly the standard messages' bytes."""

import io
import math

import numpy as np
import pytest

rospy = pytest.importorskip("rospy")
import genpy
from geometry_msgs.msg import PointStamped, PoseStamped, TwistStamped, WrenchStamped
from hypothesis import given
from hypothesis import strategies as st
from rospy.msg import serialize_message

from saras_ros1.stamped import StampedPose, StampedTwist, StampedWrench, lean_class

PAIRS = [(PoseStamped, StampedPose, 7), (TwistStamped, StampedTwist, 6), (WrenchStamped, StampedWrench, 6)]
names = st.text(max_size=30).filter(lambda s: "\0" not in s)
seconds, nanoseconds = st.integers(0, 2**32 - 1), st.integers(0, 999_999_999)


def to_bytes(message):
    buffer = io.BytesIO()
    message.serialize(buffer)
    return buffer.getvalue()


def fields(message):
    """The numbers of a standard message, in field order."""
    body = getattr(message, message.__slots__[1])
    parts = [getattr(body, name) for name in body.__slots__]
    return tuple(getattr(part, name) for part in parts for name in part.__slots__)


@pytest.mark.parametrize(("standard", "lean", "size"), PAIRS)
def test_type_and_checksum_are_the_standard_ones(standard, lean, size):
    assert lean_class(standard) is lean
    assert (lean._type, lean._md5sum, lean._full_text) == (standard._type, standard._md5sum, standard._full_text)


def test_other_messages_stay_as_they_are():
    assert lean_class(PointStamped) is PointStamped


@pytest.mark.parametrize(("standard", "lean", "size"), PAIRS)
@given(data=st.data())
def test_both_classes_read_what_the_other_wrote(standard, lean, size, data):
    numbers = tuple(data.draw(st.lists(st.floats(allow_nan=False), min_size=size, max_size=size)))
    frame, secs, nsecs = data.draw(names), data.draw(seconds), data.draw(nanoseconds)
    message = lean(numbers, frame, secs * 1_000_000_000 + nsecs)
    message.seq = data.draw(seconds)
    read = standard().deserialize(to_bytes(message))
    assert fields(read) == numbers
    header = (read.header.seq, read.header.frame_id, read.header.stamp.secs, read.header.stamp.nsecs)
    assert header == (message.seq, frame, secs, nsecs)
    again = lean().deserialize(to_bytes(read))
    assert (again.numbers, again.frame_id, again.stamp_ns, again.seq) == (
        numbers,
        frame,
        message.stamp_ns,
        message.seq,
    )
    assert again.stamp.to_nsec() == message.stamp_ns


@pytest.mark.parametrize(("standard", "lean", "size"), PAIRS)
def test_cut_and_lengthened_bytes_are_refused(standard, lean, size):
    whole = to_bytes(lean(tuple(np.arange(float(size))), "base", 5))
    for data in [whole[:n] for n in range(len(whole))] + [whole + b"\0", whole + bytes(8)]:
        with pytest.raises(genpy.DeserializationError):
            lean().deserialize(data)


def test_rospy_counts_in_the_header():
    message, buffer = StampedTwist((0.0,) * 5 + (math.nan,), "base", 7), io.BytesIO()
    serialize_message(buffer, 41, message)
    read = TwistStamped().deserialize(buffer.getvalue()[4:])
    assert (read.header.seq, read.header.frame_id) == (41, "base")
    assert math.isnan(read.twist.angular.z)
