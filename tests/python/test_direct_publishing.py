"""Publishing writes to the socket itself: whole messages in their order, and a slow subscriber blocks nobody."""

import socket
import struct
import threading
import time
from types import SimpleNamespace

import pytest

rospy = pytest.importorskip("rospy")
from geometry_msgs.msg import PointStamped
from hypothesis import given, settings
from hypothesis import strategies as st
from rospy.exceptions import TransportTerminated

from saras_ros1 import direct_publishing
from saras_ros1.direct_publishing import DirectConnection

PATIENCE_S = 30.0
IMAGE = bytes(range(256)) * 8000  # 2 MB: no socket takes it at once


class Link(SimpleNamespace):
    def close(self):
        self.done = True
        self.socket.close()


def connected(queue_size=100):
    ours, theirs = socket.socketpair()
    ours.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
    theirs.settimeout(PATIENCE_S)
    link = Link(socket=ours, done=False, stat_num_msg=0, stat_bytes=0, endpoint_id="/peer")
    return DirectConnection(link, queue_size), link, theirs


def framed(body):
    return struct.pack("<I", len(body)) + body


def receive(sock):
    def exactly(count):
        parts = []
        while count:
            parts.append(sock.recv(min(count, 1 << 16)))
            assert parts[-1], "closed"
            count -= len(parts[-1])
        return b"".join(parts)

    return exactly(struct.unpack("<I", exactly(4))[0])


def test_an_image_arrives_whole_without_a_second_one():
    connection, link, theirs = connected()
    connection.write_data(framed(IMAGE))  # returns although nobody has read
    assert receive(theirs) == IMAGE
    connection.write_data(framed(b"small"))
    assert receive(theirs) == b"small"
    assert link.stat_num_msg == 2
    assert link.stat_bytes == len(IMAGE) + len(b"small") + 8


@settings(max_examples=30, deadline=None)
@given(sizes=st.lists(st.integers(0, 200_000), min_size=1, max_size=15))
def test_whole_and_in_order_whatever_the_sizes(sizes):
    connection, _, theirs = connected()
    bodies = [bytes([i]) * size for i, size in enumerate(sizes)]
    got = []
    reader = threading.Thread(target=lambda: got.extend(receive(theirs) for _ in bodies))
    reader.start()
    for body in bodies:
        connection.write_data(framed(body))
    reader.join(PATIENCE_S)
    assert got == bodies


def test_a_frozen_subscriber_keeps_the_newest_and_blocks_nobody():
    connection, link, theirs = connected(queue_size=3)
    for i in range(50):
        connection.write_data(framed(bytes([i]) * 100_000))  # the test would hang here
    whole = [receive(theirs)[0] for _ in range(4)]  # the half sent one, and the queue
    assert whole == [0, 47, 48, 49]
    assert link.stat_num_msg == 4


def test_a_subscriber_that_left_ends_the_connection():
    connection, link, theirs = connected()
    connection.write_data(framed(IMAGE))
    theirs.close()
    end = time.monotonic() + PATIENCE_S
    with pytest.raises(TransportTerminated):
        while time.monotonic() < end:
            connection.write_data(framed(b"more"))
            time.sleep(0.01)
    assert link.done


def test_a_connection_that_rospy_closed_ends_its_thread():
    before = set(threading.enumerate())
    connection, link, theirs = connected()
    connection.write_data(framed(IMAGE))
    goes_on = set(threading.enumerate()) - before
    assert len(goes_on) == 1
    link.close()
    for thread in goes_on:
        thread.join(PATIENCE_S)
        assert not thread.is_alive()
    with pytest.raises(TransportTerminated):
        connection.write_data(framed(b"more"))
    theirs.close()


class Heard:
    """A subscriber that notes the number of each message it gets."""

    def __init__(self):
        self.seq, self.endpoint_id, self.cleanup_cb = [], f"/peer{id(self)}", None
        self._ends = socket.socketpair()  # rospy polls each connection

    def fileno(self):
        return self._ends[0].fileno()

    def set_cleanup_callback(self, callback):
        self.cleanup_cb = callback

    def write_data(self, data):
        self.seq.append(PointStamped().deserialize(data[4:]).header.seq)


@given(moves=st.lists(st.sampled_from(["publish", "subscribe"]), max_size=30))
def test_late_subscribers_of_a_latched_topic_leave_no_gap_to_the_others(moves, monkeypatch_of_publish):
    publisher = rospy.topics._PublisherImpl("/latched", PointStamped)
    publisher.enable_latch()
    heard = []
    for move in moves:
        if move == "publish":
            publisher.acquire()
            publisher.publish(PointStamped())
            publisher.release()
        else:
            heard.append(Heard())
            publisher.add_connection(heard[-1])
    for peer in heard:
        assert all(after == before + 1 for before, after in zip(peer.seq, peer.seq[1:]))
    last = {peer.seq[-1] for peer in heard if peer.seq}
    assert len(last) <= 1  # the last message has one number, whoever got it when


@pytest.fixture(scope="module")
def monkeypatch_of_publish():
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(rospy.topics._PublisherImpl, "publish", direct_publishing._publish)
        yield
