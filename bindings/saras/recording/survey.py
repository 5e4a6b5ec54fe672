"""What a bag holds, publisher by publisher, read once from front to end: the base of info, check and repair."""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from saras import Error
from saras.recording.records import Chunk, Connection, Message, Records

Integers = NDArray[np.int64]
_HEADER_FIRST = re.compile(r"(std_msgs/)?Header\s+\w+")
_stamp = struct.Struct("<III").unpack_from


@dataclass(frozen=True)
class Publisher:
    """What one node published on one topic, in the order of the file; arrays are (n,)."""

    topic: str
    type: str
    node: str  #: empty when the bag does not say
    latched: bool
    received_ns: Integers
    seq: Integers | None  #: of the header; None for types without one, and when the node does not count
    stamp_ns: Integers | None  #: of the header; None for types without one, and when all are zero
    bytes: int

    def __len__(self) -> int:
        return len(self.received_ns)

    @property
    def age_s(self) -> NDArray[np.float64] | None:
        """Received − stamp of the messages that carry a stamp [s]."""
        if self.stamp_ns is None:
            return None
        stamped = self.stamp_ns != 0
        return np.asarray((self.received_ns - self.stamp_ns)[stamped] * 1e-9)


@dataclass(frozen=True)
class Gap:
    """A place of the file that could not be read, between the last message before and the first one after it."""

    bytes: int
    after_ns: int | None
    before_ns: int | None  #: None: the file ends there


@dataclass(frozen=True)
class ChunkEntry:
    """Where a chunk's messages are; arrays are (n,) in the order of the chunk."""

    start: int  #: of the record in the file
    stop: int
    data: bytes | None  #: its readable part, unpacked, when the record in the file is not to be kept as it is
    connection: Integers
    time_ns: Integers
    offset: Integers


@dataclass
class Survey:
    """One bag file."""

    path: Path
    size_bytes: int
    missing_bytes: int  #: by which the file is shorter than when it was closed, without its index
    closed: bool  #: the recorder closed it; else it was killed or still writes
    chunks: list[ChunkEntry] = field(default_factory=list)
    gaps: list[Gap] = field(default_factory=list)
    connections: dict[int, Connection] = field(default_factory=dict)
    publishers: list[Publisher] = field(default_factory=list)
    orphans: int = 0  #: messages of publishers whose own record is lost: their topic is not known

    @property
    def messages(self) -> int:
        """Readable messages of known topics."""
        return sum(map(len, self.publishers))

    @property
    def start_ns(self) -> int:
        """Reception of the first message."""
        return min(int(publisher.received_ns.min()) for publisher in self.publishers)

    @property
    def stop_ns(self) -> int:
        """Reception of the last message."""
        return max(int(publisher.received_ns.max()) for publisher in self.publishers)

    @property
    def duration_s(self) -> float:
        """From the first to the last reception."""
        return (self.stop_ns - self.start_ns) * 1e-9

    @property
    def whole(self) -> bool:
        """Closed, all of it readable, and its index there."""
        return self.closed and not self.gaps and self.missing_bytes == 0 and self.indexed

    indexed: bool = False

    def topics(self) -> dict[str, list[Publisher]]:
        """Publishers of each topic, by name."""
        result: dict[str, list[Publisher]] = {}
        for publisher in sorted(self.publishers, key=lambda publisher: (publisher.topic, publisher.node)):
            result.setdefault(publisher.topic, []).append(publisher)
        return result


class _Collector:
    """Rows of one publisher while the file is read."""

    def __init__(self) -> None:
        self.received_ns: list[int] = []
        self.heads: list[bytes] = []
        self.bytes = 0


def survey(path: str | Path, progress: Callable[[int, int], None] | None = None) -> Survey:
    """Reads all records of a bag, also of one without an index or cut short.

    ``progress`` is called with bytes read and bytes in all. Raises saras.Error for a file that is no bag, and for one
    without any readable message.
    """
    records = Records(path)
    try:
        result = Survey(
            records.path,
            records.size,
            max(0, records.index_position - records.size),
            records.index_position > 0,
        )
        rows: dict[int, _Collector] = {}
        last_ns: int | None = None
        for part in records.chunks():
            if not isinstance(part, Chunk):
                if 0 < records.index_position <= part.start:
                    continue  # no message is lost with a part of the index
                result.gaps.append(Gap(part.stop - part.start, last_ns, None))
                continue
            messages, read = records.messages(part)
            whole = part.stored is not None and read == len(part.data)
            kept = None if whole else part.data[:read]
            if messages:
                result.gaps = [_ended(gap, messages[0].time_ns) for gap in result.gaps]
                last_ns = messages[-1].time_ns
                result.chunks.append(_entry(part, kept, messages))
            if read < len(part.data):
                result.gaps.append(Gap(len(part.data) - read, last_ns, None))
            elif part.stored is None and result.closed:
                result.gaps.append(Gap(0, last_ns, None))
            for message in messages:
                row = rows.get(message.connection) or rows.setdefault(message.connection, _Collector())
                row.received_ns.append(message.time_ns)
                row.heads.append(part.data[message.start : min(message.start + 12, message.stop)])
                row.bytes += message.stop - message.start
            if progress is not None:
                progress(part.stop, records.size)
        result.connections = dict(records.connections)
    finally:
        records.close()
    for number, row in rows.items():
        if number in result.connections:
            result.publishers.append(_publisher(result.connections[number], row))
        else:
            result.orphans += len(row.received_ns)
    if not result.publishers:
        raise Error(f"{path}: the bag holds no readable message")
    result.indexed = result.closed and _opens(result)
    return result


def _ended(gap: Gap, time_ns: int) -> Gap:
    return gap if gap.before_ns is not None else Gap(gap.bytes, gap.after_ns, time_ns)


def _entry(chunk: Chunk, kept: bytes | None, messages: list[Message]) -> ChunkEntry:
    rows = np.array([(message.connection, message.time_ns, message.offset) for message in messages], dtype=np.int64)
    return ChunkEntry(chunk.position, chunk.stop, kept, rows[:, 0], rows[:, 1], rows[:, 2])


def _publisher(connection: Connection, row: _Collector) -> Publisher:
    seq = stamp_ns = None
    if starts_with_header(connection.fields["message_definition"]) and all(len(head) == 12 for head in row.heads):
        numbers = np.array([_stamp(head) for head in row.heads], dtype=np.int64)
        # A sequence that never moves is a publisher that does not count.
        if len(numbers) > 1 and (np.diff(numbers[:, 0]) != 0).any():
            seq = numbers[:, 0]
        if numbers[:, 1:].any():
            stamp_ns = numbers[:, 1] * 1_000_000_000 + numbers[:, 2]
    return Publisher(
        connection.topic,
        connection.fields["type"],
        connection.publisher,
        connection.fields.get("latching") == "1",
        np.array(row.received_ns, dtype=np.int64),
        seq,
        stamp_ns,
        row.bytes,
    )


def starts_with_header(definition: str) -> bool:
    """Whether a message definition's first field is std_msgs/Header: its sequence and stamp are the first 12 bytes."""
    for line in definition.splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("===="):
            return False
        if line and "=" not in line:
            return _HEADER_FIRST.fullmatch(line) is not None
    return False


def _opens(result: Survey) -> bool:
    """Whether rosbags reads the file by its index, and finds all of its messages."""
    from saras.recording.bag import Bag

    try:
        bag = Bag(result.path)
    except Error:
        return False
    try:
        return sum(bag.counts.values()) >= result.messages
    finally:
        bag.close()
