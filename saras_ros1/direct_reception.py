"""Receiving in one thread, instead of in one for each publisher.

rospy reads each connection in a thread of its own. Messages of one tick come within microseconds: their threads wake
together, and pass the interpreter's lock from one to the next by way of the scheduler. Here one thread waits for all
connections and calls their callbacks in the order of arrival. A callback that blocks holds up all others.
"""

from __future__ import annotations

import contextlib
import select
import socket
import struct
import threading
import time
from io import BytesIO
from typing import Any, Callable
from xml.parsers.expat import ExpatError
from xmlrpc.client import Fault, ProtocolError, ServerProxy

import rospy
from rospy.exceptions import TransportInitError
from rospy.impl import tcpros_base

CONNECT_TIMEOUT_S = 5.0
FIRST_WAIT_S, LONGEST_WAIT_S = 0.25, 8.0  #: between attempts to connect again

_LENGTH = struct.Struct("<I")
_CHUNK_BYTES = 1 << 18


class Stream:
    """One connection: bytes become messages; of those that came together only the newest queue_size are decoded."""

    def __init__(self, transport: Any, callback: Callable[[list, Any], None]) -> None:
        self.socket: socket.socket = transport.socket
        self.ended = threading.Event()  #: by the publisher, or because rospy closed it
        self._transport, self._callback = transport, callback
        self._protocol = transport.protocol
        # What came together with the handshake.
        self._buffer = bytearray(transport.read_buff.getvalue()[: transport.read_buff.tell()])

    def read(self) -> bool:
        """Takes what is there and calls the callback; never waits. False when the connection has ended."""
        try:
            data = self.socket.recv(_CHUNK_BYTES, socket.MSG_DONTWAIT)
        except BlockingIOError:
            return True
        except OSError:
            return False
        if not data:
            return False
        self._transport.stat_bytes += len(data)
        self.take(data)
        return True

    def take(self, data: bytes) -> None:
        """Bytes as they came, cut anywhere."""
        if self._buffer:
            self._buffer += data
            data = bytes(self._buffer) if self._holds_message() else b""
        packets, at = [], 0
        while len(data) - at >= _LENGTH.size:
            end = at + _LENGTH.size + _LENGTH.unpack_from(data, at)[0]
            if end > len(data):
                break
            packets.append(data[at + _LENGTH.size : end])
            at = end
        if data:
            self._buffer = bytearray(data[at:])
        if packets:
            self._deliver(packets)

    def _holds_message(self) -> bool:
        size = len(self._buffer)
        return size >= _LENGTH.size and size >= _LENGTH.size + _LENGTH.unpack_from(self._buffer)[0]

    def _deliver(self, packets: list[bytes]) -> None:
        transport, protocol = self._transport, self._protocol
        if protocol.queue_size is not None:
            packets = packets[-protocol.queue_size :]
        messages = []
        for packet in packets:
            try:
                message = protocol.recv_data_class().deserialize(packet)
            except Exception as error:  # a peer's bytes must not end the only thread that receives
                rospy.logerr_throttle(1.0, f"{protocol.resolved_name}: message cannot be read: {error}")
                continue
            message._connection_header = transport.header
            messages.append(message)
        transport.stat_num_msg += len(messages)
        if messages and transport.is_latched:
            transport.latch = messages[-1]  # for a second subscriber of this process
        if messages and not transport.done:
            self._callback(messages, transport)


class Reception:
    """The thread and its streams."""

    def __init__(self) -> None:
        self._poll = select.epoll()
        self._streams: dict[int, Stream] = {}
        self._lock = threading.Lock()  # a closed socket's number may be that of the next one at once
        threading.Thread(target=self._run, name="reception", daemon=True).start()

    def serve(self, stream: Stream) -> None:
        """Returns when the stream has ended."""
        stream.take(b"")
        number = stream.socket.fileno()
        try:
            with self._lock:
                self._poll.register(number, select.EPOLLIN)
                self._streams[number] = stream
            stream.ended.wait()
        except (OSError, ValueError):  # closed before it was registered
            pass
        finally:
            self._forget(number, stream)

    def _forget(self, number: int, stream: Stream) -> None:
        with self._lock:
            if self._streams.get(number) is stream:
                del self._streams[number]
                with contextlib.suppress(OSError, ValueError):  # a closed socket has left the poll by itself
                    self._poll.unregister(number)

    def _run(self) -> None:
        while True:
            for number, _ in self._poll.poll():
                with self._lock:
                    stream = self._streams.get(number)
                if stream is None or stream.ended.is_set():
                    continue
                try:
                    there = stream.read()
                except Exception as error:
                    rospy.logerr_throttle(1.0, f"reception: {type(error).__name__}: {error}")
                    continue
                if not there:
                    self._forget(number, stream)  # while the number is still this stream's
                    stream.ended.set()


def publishes(publisher_uri: str, topic: str) -> bool:
    """Whether the node there still says so. One that cannot be reached may come back: True."""
    try:
        code, _, topics = ServerProxy(publisher_uri).getPublications(rospy.get_name())
    except ConnectionRefusedError:
        return False
    except (OSError, Fault, ProtocolError, ExpatError):
        return True
    return code == 1 and any(name == topic for name, _ in topics)


def _connect_again(transport: Any, topic: str) -> None:
    """A lost connection to a publisher that is still there is made anew, as roscpp does; else the transport is closed.

    rospy gives it up for good: the topic would be silent until one of the two processes starts again.
    """
    wait_s = FIRST_WAIT_S
    link, transport.socket = transport.socket, None
    with contextlib.suppress(OSError):
        link.close()
    while transport.socket is None and not transport.done and not rospy.is_shutdown():
        if not publishes(transport.endpoint_id, topic):
            transport.close()
            return
        transport.read_buff = BytesIO()  # bytes of the lost connection would be taken for the new one's header
        try:
            transport.connect(*transport.dest_address, transport.endpoint_id, timeout=CONNECT_TIMEOUT_S)
            rospy.logwarn(f"{topic}: connection to {transport.endpoint_id} was lost and is made anew")
        except TransportInitError:
            transport.socket = None
            time.sleep(wait_s)
            wait_s = min(2.0 * wait_s, LONGEST_WAIT_S)


def install() -> None:
    """Makes every rospy subscriber of this process receive here. Before the first Subscriber."""
    reception = Reception()
    transport_class = tcpros_base.TCPROSTransport
    rospy_close = transport_class.close

    def receive_loop(self: Any, callback: Callable[[list, Any], None]) -> None:
        if self.socket is None:  # closed meanwhile
            return
        topic = self.protocol.resolved_name
        try:
            while self.socket is not None and not self.done:
                self._saras_stream = Stream(self, callback)
                reception.serve(self._saras_stream)
                if not self.done and not rospy.is_shutdown():
                    _connect_again(self, topic)
        finally:
            self.close()

    def close(self: Any) -> None:
        rospy_close(self)
        stream = getattr(self, "_saras_stream", None)
        if stream is not None:
            stream.ended.set()

    transport_class.receive_loop, transport_class.close = receive_loop, close
