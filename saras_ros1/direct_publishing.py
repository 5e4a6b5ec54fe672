"""Publishing without a thread a subscriber.

rospy hands each message to a thread of its own for each subscriber, and yields the interpreter to it
(`time.sleep(0)`) from within publish(). At 100 Hz and a dozen topics that is most of a node's time. Here publish()
writes to the socket itself and never waits: what a slow subscriber's socket does not take goes into a bounded queue.
"""

from __future__ import annotations

import socket
from collections import deque
from typing import Any

import rospy
from rospy.exceptions import TransportTerminated


class DirectConnection:
    """Stands in for rospy.impl.tcpros_pubsub.QueuedConnection: same constructor, same methods.

    rospy serialises calls of write_data for each topic. The oldest message is dropped when the queue is full.
    """

    def __init__(self, connection: Any, queue_size: int) -> None:
        self._connection = connection
        self._waiting: deque[bytes] = deque(maxlen=queue_size if queue_size > 0 else None)
        self._rest = b""  # of a message that is half in the socket: it must go on before any other

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self._connection, name)

    def write_data(self, data: bytes) -> bool:
        """Sends, or keeps for the next call. Raises TransportTerminated when the subscriber is gone."""
        link = self._connection
        sock = link.socket
        if sock is None or link.done:
            raise TransportTerminated("connection closed")
        self._waiting.append(data)
        try:
            while self._rest or self._waiting:
                if not self._rest:
                    self._rest = self._waiting.popleft()
                    link.stat_num_msg += 1
                sent = sock.send(self._rest, socket.MSG_DONTWAIT)
                link.stat_bytes += sent
                self._rest = self._rest[sent:]
        except BlockingIOError:
            pass
        except OSError as error:
            link.close()
            raise TransportTerminated(str(error)) from None
        return True


def install() -> None:
    """Makes every rospy publisher of this process use DirectConnection. Before the first Publisher."""
    rospy.topics.QueuedConnection = DirectConnection
