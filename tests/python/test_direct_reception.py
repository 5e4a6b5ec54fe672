"""Framing of one connection: whatever the cuts, the newest messages come out, whole and in order."""

import socket
import struct
from types import SimpleNamespace

import pytest

rospy = pytest.importorskip("rospy")
from hypothesis import given
from hypothesis import strategies as st
from rospy.impl.tcpros_base import BytesIO
from std_msgs.msg import String

from saras_ros1.direct_reception import Reception, Stream


def framed(text):
    body = text.encode()
    body = struct.pack("<I", len(body)) + body
    return struct.pack("<I", len(body)) + body


def stream(queue_size=None, leftover=b"", sock=None):
    buffer = BytesIO()
    buffer.write(leftover)
    transport = SimpleNamespace(
        socket=sock,
        protocol=SimpleNamespace(queue_size=queue_size, recv_data_class=String, resolved_name="/t"),
        read_buff=buffer,
        header={"callerid": "/peer"},
        is_latched=False,
        latch=None,
        done=False,
        stat_bytes=0,
        stat_num_msg=0,
    )
    got = []
    return Stream(transport, lambda messages, _: got.append([m.data for m in messages])), got, transport


@given(texts=st.lists(st.text(max_size=20), max_size=12), data=st.data())
def test_any_cuts_give_every_message_once(texts, data):
    whole = b"".join(map(framed, texts))
    cuts = sorted(data.draw(st.lists(st.integers(0, len(whole)), max_size=10)))
    first = data.draw(st.integers(0, len(whole)))
    reader, got, transport = stream(leftover=whole[:first])
    reader.take(b"")
    rest = whole[first:]
    for begin, end in zip([0, *cuts], [*cuts, len(rest)]):
        reader.take(rest[begin:end])
    assert [text for batch in got for text in batch] == texts
    assert transport.stat_num_msg == len(texts)


@given(texts=st.lists(st.text(max_size=5), min_size=1, max_size=12), queue_size=st.integers(1, 3))
def test_of_those_that_came_together_the_newest_are_kept(texts, queue_size):
    reader, got, _ = stream(queue_size)
    reader.take(b"".join(map(framed, texts)))
    assert got == [texts[-queue_size:]]


def test_a_message_that_cannot_be_read_does_not_end_the_stream(monkeypatch):
    monkeypatch.setattr(rospy, "logerr_throttle", lambda *_: None)  # asks the time of a node, and there is none
    reader, got, _ = stream()
    reader.take(struct.pack("<I", 2) + b"xx" + framed("after"))
    assert got == [["after"]]


def test_the_last_message_of_a_latched_topic_is_remembered():
    reader, _, transport = stream()
    transport.is_latched = True
    reader.take(framed("old") + framed("new"))
    assert transport.latch.data == "new"
    assert transport.latch._connection_header == {"callerid": "/peer"}


def test_a_closed_peer_ends_the_stream():
    ours, theirs = socket.socketpair()
    reader, got, transport = stream(sock=ours)
    theirs.sendall(framed("last"))
    assert reader.read()
    assert reader.read()  # nothing there: does not wait
    assert got == [["last"]]
    theirs.close()
    assert not reader.read()
    assert transport.stat_bytes == len(framed("last"))
    ours.close()


def test_a_socket_that_is_closed_already_ends_at_once():
    ours, theirs = socket.socketpair()
    reader, got, _ = stream(leftover=framed("early"), sock=ours)
    ours.close()
    theirs.close()
    Reception().serve(reader)
    assert got == [["early"]]
