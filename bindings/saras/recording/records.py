"""The records of a bag file (ROS 1, version 2.0) in the order of the file, index or not, whole or cut.

Reading by index is rosbags' business. Here a file is read that nobody closed: a recorder that was killed leaves its
last chunk open (stored size 0, its records follow), a copy may end anywhere, a disk may have lost a
block in the middle. Format: http://wiki.ros.org/Bags/Format/2.0.
"""

from __future__ import annotations

import bz2
import mmap
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple, Union

from saras import Error

MAGIC = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, INDEX, CHUNK, CHUNK_INFO, CONNECTION = range(2, 8)
Buffer = Union[bytes, mmap.mmap]

_u32 = struct.Struct("<I").unpack_from
_time = struct.Struct("<II").unpack
_FOREIGN = (
    (b"#ROSBAG V1", "a ROS bag of version 1: rosbag fix makes it a version 2.0"),
    (b"SQLite format 3\x00", "an SQLite file: perhaps a ROS 2 bag (.db3)"),
    (b"\x89MCAP0\r\n", "an MCAP file"),
    (b"PAR1", "a Parquet file"),
    (b"PK\x03\x04", "a zip archive"),
    (b"\x1f\x8b", "a gzip archive: unpack it first"),
    (b"BZh", "a bzip2 archive: unpack it first"),
    (b"\x28\xb5\x2f\xfd", "a zstd archive: unpack it first"),
    (b"\x7fELF", "a program"),
    (b"\x89HDF\r\n", "an HDF5 file"),
)


class DamagedError(Exception):
    """A record that cannot be read; for this package only."""


class Message(NamedTuple):
    """One message: data[start:stop] of its chunk."""

    connection: int
    time_ns: int  #: reception
    offset: int  #: of its record in the chunk
    start: int
    stop: int


@dataclass(frozen=True)
class Connection:
    """One publisher of one topic, its record's bytes as they are in the file."""

    id: int
    topic: str
    fields: dict[str, str]  #: type, md5sum, message_definition, callerid, latching
    record: bytes

    @property
    def publisher(self) -> str:
        """Name of the node, empty when the file does not say."""
        return self.fields.get("callerid", "")


@dataclass(frozen=True)
class Chunk:
    """Records of one chunk, unpacked."""

    position: int  #: of its record in the file
    stop: int  #: where the file goes on
    data: bytes
    stored: bytes | None  #: the whole record as it is in the file; None when it ends early


@dataclass(frozen=True)
class Unreadable:
    """Bytes of the file that are no record, start and stop."""

    start: int
    stop: int


def what_is(head: bytes) -> str:
    """What kind of file begins with ``head``, for a refusal."""
    if not head:
        return "an empty file"
    if not any(head):
        return "a file of zeros"
    for magic, name in _FOREIGN:
        if head.startswith(magic):
            return name
    return "no ROS 1 bag (version 2.0)"


class Records:
    """One bag file. Raises saras.Error when it is missing or none."""

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        if not self.path.is_file():
            raise Error(f"{self.path}: no such file")
        with self.path.open("rb") as file:
            head = file.read(4096)
            if not head.startswith(MAGIC):
                raise Error(f"{self.path}: not a bag: {what_is(head)}")
            self._file = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        self.size = len(self._file)
        try:
            fields, _, stop = _record(self._file, len(MAGIC), self.size)
            if fields.get("op") != bytes([BAG_HEADER]):
                raise DamagedError
        except DamagedError:
            self._file.close()
            raise Error(f"{self.path}: the bag ends or is damaged before its first message") from None
        if fields.get("encryptor"):
            self._file.close()
            raise Error(f"{self.path}: the bag is encrypted with {fields['encryptor'].decode(errors='replace')!r}")
        self.index_position: int = struct.unpack("<Q", fields["index_pos"])[0] if "index_pos" in fields else 0
        self._first = stop
        self.connections: dict[int, Connection] = {}  #: those read so far; all after ``chunks`` has ended

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def chunks(self) -> Iterator[Chunk | Unreadable]:
        """Chunks and unreadable places in the order of the file."""
        at = self._first
        while at < self.size:
            try:
                fields, data, stop = _record(self._file, at, self.size)
                op = _op(fields)
                if op == CHUNK and data == stop:  # never closed by the recorder
                    chunk = self._open_chunk(at, data)
                    yield chunk
                    stop = chunk.stop
                elif op == CHUNK:
                    yield self._chunk(at, fields, data, stop)
                elif op == CONNECTION:
                    self._learn(fields, bytes(self._file[at:stop]))
                elif op not in (INDEX, CHUNK_INFO):
                    raise DamagedError
                at = stop
            except DamagedError:
                cut, at = self._cut_chunk(at)
                if cut is not None:
                    yield cut
                    continue
                start, at = at, self._next_chunk(at + 1)
                yield Unreadable(start, at)

    def messages(self, chunk: Chunk) -> tuple[list[Message], int]:
        """Messages of a chunk, and how many of its bytes could be read; learns its connections."""
        found: list[Message] = []
        read = 0
        for fields, at, data, stop in _nested(chunk.data):
            op = fields.get("op")
            if op == b"\x02" and len(fields.get("time", b"")) == 8 and len(fields.get("conn", b"")) == 4:
                seconds, nanoseconds = _time(fields["time"])
                found.append(Message(_u32(fields["conn"])[0], seconds * 1_000_000_000 + nanoseconds, at, data, stop))
            elif op == b"\x07":
                self._learn(fields, chunk.data[at:stop])
            else:
                break
            read = stop
        if chunk.data[read : read + 4] == bytes(4) and found:
            # A block of zeros, from a lost sector or a crash of the machine: it began inside the last message.
            read = found.pop().offset
        return found, read

    def _chunk(self, at: int, fields: dict[str, bytes], start: int, stop: int) -> Chunk:
        packed = bytes(self._file[start:stop])
        data = _unpack(packed, fields.get("compression", b"none"))
        size = fields.get("size", b"")
        if len(size) != 4 or _u32(size, 0)[0] != len(data):
            raise DamagedError
        return Chunk(at, stop, data, bytes(self._file[at:stop]))

    def _open_chunk(self, at: int, start: int) -> Chunk:
        """A chunk that says that it is empty: its records follow, packed or not, to where they stop making sense."""
        fields, _, _ = _record(self._file, at, self.size)
        compression = fields.get("compression", b"none")
        if compression == b"none":
            stop = max((end for _, _, _, end in _nested(self._file, start, (MESSAGE, CONNECTION))), default=start)
            return Chunk(at, stop, bytes(self._file[start:stop]), None)
        return Chunk(at, self.size, _unpack(bytes(self._file[start:]), compression, partly=True), None)

    def _cut_chunk(self, at: int) -> tuple[Chunk | None, int]:
        """The last chunk of a file that ends inside it, as far as it goes."""
        try:
            fields, start = _header(self._file, at, self.size)
            if _op(fields) != CHUNK or start + 4 > self.size or start + 4 + _u32(self._file, start)[0] <= self.size:
                return None, at
            data = _unpack(bytes(self._file[start + 4 :]), fields.get("compression", b"none"), partly=True)
        except DamagedError:
            return None, at
        # A damaged length looks the same: then another chunk follows inside.
        following = self._next_chunk(start + 4)
        if following < self.size and fields.get("compression") == b"none":
            data = data[: following - start - 4]
            return Chunk(at, following, data, None), following
        if following < self.size:
            return None, at
        return Chunk(at, self.size, data, None), self.size

    def _next_chunk(self, at: int) -> int:
        """Where the next chunk's record begins, searched byte by byte; the size of the file when there is none."""
        while True:
            mark = self._file.find(b"compression=", at)
            if mark < 0:
                return self.size
            for start in range(mark - 4, max(at, mark - 64) - 1, -1):
                try:
                    fields, _ = _header(self._file, start, self.size)
                except DamagedError:
                    continue
                if fields.get("op") == bytes([CHUNK]) and len(fields.get("size", b"")) == 4 and start + 4 < mark:
                    return start
            at = mark + 1

    def _learn(self, fields: dict[str, bytes], record: bytes) -> None:
        """Keeps a connection whose text is text: one that is damaged here may stand again in the index."""
        try:
            number = _u32(fields["conn"])[0]
            described = _fields(record, _header(record, 0, len(record))[1] + 4, len(record))
            texts = {name: value.decode() for name, value in described.items()}
            topic = fields["topic"].decode()
        except (KeyError, struct.error, UnicodeDecodeError, DamagedError):
            return
        names = {*fields, *texts}
        if topic and {"type", "md5sum", "message_definition"} <= names and "\ufffd" not in "".join(names):
            self.connections.setdefault(number, Connection(number, topic, texts, record))


def _op(fields: dict[str, bytes]) -> int:
    op = fields.get("op", b"")
    if len(op) != 1:
        raise DamagedError
    return op[0]


def _fields(buffer: Buffer, at: int, stop: int) -> dict[str, bytes]:
    fields: dict[str, bytes] = {}
    while at < stop:
        if at + 4 > stop:
            raise DamagedError
        length = _u32(buffer, at)[0]
        at += 4
        if length == 0 or at + length > stop:
            raise DamagedError
        name, equals, value = bytes(buffer[at : at + length]).partition(b"=")
        if not equals:
            raise DamagedError
        fields[name.decode(errors="replace")] = value
        at += length
    return fields


def _header(buffer: Buffer, at: int, size: int) -> tuple[dict[str, bytes], int]:
    """Fields of the record's header and where the length of its data stands."""
    if at + 4 > size:
        raise DamagedError
    start = at + 4
    stop = start + _u32(buffer, at)[0]
    if stop == start or stop > size:
        raise DamagedError
    return _fields(buffer, start, stop), stop


def _record(buffer: Buffer, at: int, size: int) -> tuple[dict[str, bytes], int, int]:
    """Header fields, start and stop of the data of the record at ``at``."""
    fields, start = _header(buffer, at, size)
    if start + 4 > size:
        raise DamagedError
    stop = start + 4 + _u32(buffer, start)[0]
    if stop > size:
        raise DamagedError
    return fields, start + 4, stop


def _nested(
    buffer: Buffer, at: int = 0, only: tuple[int, ...] | None = None
) -> Iterator[tuple[dict[str, bytes], int, int, int]]:
    """Records one after the other until one cannot be read: fields, position, start and stop of the data."""
    size = len(buffer)
    while at < size:
        try:
            fields, start, stop = _record(buffer, at, size)
            if only is not None and _op(fields) not in only:
                return
        except DamagedError:
            return
        yield fields, at, start, stop
        at = stop


def _unpack(packed: bytes, compression: bytes, partly: bool = False) -> bytes:
    if compression == b"none":
        return packed
    try:
        if compression == b"bz2":
            return bz2.BZ2Decompressor().decompress(packed) if partly else bz2.decompress(packed)
        if compression == b"lz4":
            import lz4.frame

            if partly:
                return bytes(lz4.frame.LZ4FrameDecompressor().decompress(packed))
            return bytes(lz4.frame.decompress(packed))
    except ImportError:
        raise Error("chunks packed with lz4 need the package lz4: pip install 'saras[recording]'") from None
    except (OSError, EOFError, ValueError, RuntimeError):
        raise DamagedError from None
    raise DamagedError
