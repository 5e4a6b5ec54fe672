"""Publishing without a thread a subscriber.

rospy hands each message to a thread of its own for each subscriber, and yields the interpreter to it
(`time.sleep(0)`) from within publish(). At 100 Hz and a dozen topics that is most of a node's time. Here publish()
writes to the socket itself and never waits: what a slow subscriber's socket does not take goes into a bounded queue.
"""

from __future__ import annotations

import select
import socket
import threading
from collections import deque
from typing import Any

import rospy
from rospy.exceptions import TransportTerminated

CLOSED_S = 0.5  #: how soon a thread sees that the connection it waits for was closed


class DirectConnection:
    """Stands in for rospy.impl.tcpros_pubsub.QueuedConnection: same constructor, same methods.

    rospy serialises calls of write_data for each topic. The oldest message is dropped when the queue is full. What a
    socket does not take at once, as most of an image, goes on from a thread that lives until it is gone.
    """

    def __init__(self, connection: Any, queue_size: int) -> None:
        self._connection = connection
        self._waiting: deque[bytes] = deque(maxlen=queue_size if queue_size > 0 else None)
        self._rest = memoryview(b"")  # of a message that is half in the socket: it must go on before any other
        self._lock = threading.Lock()
        self._goes_on = False

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._connection, name)

    def write_data(self, data: bytes) -> bool:
        """Sends, or keeps for later. Raises TransportTerminated when the subscriber is gone."""
        link = self._connection
        sock = link.socket
        if sock is None or link.done:
            raise TransportTerminated("connection closed")
        try:
            with self._lock:
                self._waiting.append(data)
                if not self._goes_on and not self._send(sock):
                    self._goes_on = True
                    threading.Thread(target=self._go_on, args=(sock,), daemon=True).start()
        except OSError as error:
            link.close()  # without the lock: rospy calls back and takes locks of its own
            raise TransportTerminated(str(error)) from None
        return True

    def _send(self, sock: socket.socket) -> bool:
        """As much as the socket takes; True when nothing is left. With the lock."""
        link = self._connection
        try:
            while self._rest or self._waiting:
                if not self._rest:
                    self._rest = memoryview(self._waiting.popleft())
                    link.stat_num_msg += 1
                sent = sock.send(self._rest, socket.MSG_DONTWAIT)
                link.stat_bytes += sent
                self._rest = self._rest[sent:]
        except BlockingIOError:
            return False
        return True

    def _go_on(self, sock: socket.socket) -> None:
        link, room = self._connection, select.poll()
        try:
            room.register(sock, select.POLLOUT)
            while not link.done:
                ready = room.poll(1e3 * CLOSED_S)
                with self._lock:
                    if ready and self._send(sock):
                        self._goes_on = False
                        return
        except (OSError, ValueError):  # it has ended: the next write_data says so
            link.close()


def _publish(publisher: Any, message: Any, connection_override: Any = None) -> Any:
    """As roscpp: a latched message keeps its number when it goes to a late subscriber.

    rospy counts it anew, which looks like a lost message to every other subscriber, and in the bag.
    """
    if connection_override is None:
        return _rospy_publish(publisher, message)
    before = publisher.seq
    publisher.seq = max(0, before - 1)
    try:
        return _rospy_publish(publisher, message, connection_override)
    finally:
        publisher.seq = max(before, publisher.seq)


_rospy_publish = rospy.topics._PublisherImpl.publish


def install() -> None:
    """Makes every rospy publisher of this process use DirectConnection. Before the first Publisher."""
    rospy.topics.QueuedConnection = DirectConnection
    rospy.topics._PublisherImpl.publish = _publish
