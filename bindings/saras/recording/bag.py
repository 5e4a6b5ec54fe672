"""A bag file as columns: one array a message field. Message definitions come from the bag itself."""

from __future__ import annotations

import mmap
import struct
from collections.abc import Callable
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from saras import Error
from saras.recording import decode

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Topic:
    """All messages of one topic, in order of reception.

    ``columns`` maps a field's dotted name (``pose.position.x``) to an array over messages: (n,) for numbers and
    text, (n, k) for arrays of constant length k, objects otherwise.
    """

    name: str
    type: str  #: as ROS 1 writes it, e.g. geometry_msgs/PoseStamped
    t: Floats  #: (n,) header stamp, else reception [s since session start]
    t_received: Floats  #: (n,) when the recorder got it [s since session start]
    columns: dict[str, NDArray[Any]]

    def __len__(self) -> int:
        return len(self.t)

    def __getitem__(self, field: str) -> NDArray[Any]:
        try:
            return self.columns[field]
        except KeyError:
            raise Error(
                f"{self.name} ({self.type}) has no field {field!r}; it has: {', '.join(self.columns)}"
            ) from None

    @property
    def seq(self) -> NDArray[Any] | None:
        """(n,) the message's own sequence number, else its header's; None without either."""
        column = self.columns.get("seq")
        return column if column is not None else self.columns.get("header.seq")


class Bag:
    """Reads topics of one bag when they are asked for, and keeps them."""

    def __init__(self, path: str | Path) -> None:
        try:
            from rosbags.rosbag1 import Reader
            from rosbags.typesys import Stores, get_typestore
        except ImportError:
            raise Error("reading a recording needs the package rosbags: pip install 'saras[recording]'") from None
        self.path = Path(path)
        if not self.path.is_file():
            raise Error(f"{self.path}: no such file")
        try:
            self._reader = Reader(self.path)
            self._reader.open()
        except Exception as error:  # rosbags raises ReaderError, AssertionError, struct.error … on damaged files
            hint = ""
            if "not indexed" in str(error):
                hint = f" The recorder was killed before it could close the file: saras bag repair {self.path}"
            elif "magic" in str(error) or "decode" in str(error):
                hint = " This is not a ROS 1 bag (version 2.0)."
            raise Error(f"{self.path}: cannot be read as a bag: {error or type(error).__name__}.{hint}") from error
        if not self._reader.connections or self._reader.message_count == 0:
            self._reader.close()
            raise Error(f"{self.path}: the bag holds no messages")
        self.start_ns: int = self._reader.start_time
        self.duration_s: float = self._reader.duration * 1e-9
        self.counts: dict[str, int] = {name: info.msgcount for name, info in self._reader.topics.items()}
        with self.path.open("rb") as file:
            self._bytes = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
        self._stores = [get_typestore(Stores.EMPTY)]
        self._cache: dict[str, Topic | None] = {}

    def close(self) -> None:
        """Closes the file; topics that were read stay usable."""
        if self._reader.bio is not None:
            self._reader.close()

    def topic(self, name: str) -> Topic | None:
        """The messages of one topic, or None when none was recorded."""
        if name not in self._cache:
            self._cache[name] = self._read(name)
        return self._cache[name]

    def heads(self, name: str) -> tuple[Floats, Floats] | None:
        """(n,) stamps and receptions [s] of a topic whose messages begin with a header; the rest is not decoded."""
        from saras.recording.survey import starts_with_header

        connections = [connection for connection in self._reader.connections if connection.topic == name]
        if not connections or self.counts.get(name, 0) == 0:
            return None
        if not all(starts_with_header(connection.msgdef.data) for connection in connections):
            raise Error(f"{self.path}: {name} ({connections[0].msgtype}) has no header, so its stamps are not known")
        rows = []
        try:
            for _, time_ns, raw in self._reader.messages(connections):
                _, sec, nanosec = struct.unpack_from("<III", raw)
                rows.append((sec * 1_000_000_000 + nanosec - self.start_ns, time_ns - self.start_ns))
        except Exception as error:
            raise Error(f"{self.path}: {name}: damaged after {len(rows)} messages: {error}") from error
        times = np.array(rows, dtype=np.int64) * 1e-9
        return times[:, 0], times[:, 1]

    def _read(self, name: str) -> Topic | None:
        connections = [connection for connection in self._reader.connections if connection.topic == name]
        if not connections or self.counts.get(name, 0) == 0:
            return None
        types = {connection.msgtype for connection in connections}
        if len(types) > 1:
            raise Error(f"{self.path}: {name} was recorded with several types: {', '.join(sorted(types))}")
        msgtype = connections[0].msgtype
        try:
            store = self._store_for(connections[0])
            received_ns, columns = self._columns(connections, store, msgtype)
        except Exception as error:
            raise Error(f"{self.path}: {name}: damaged: {error}") from error
        t_received = (received_ns - self.start_ns) * 1e-9
        return Topic(name, msgtype.replace("/msg/", "/"), self._stamps(columns, t_received), t_received, columns)

    def _columns(
        self, connections: list[Any], store: Any, msgtype: str
    ) -> tuple[NDArray[np.int64], dict[str, NDArray[Any]]]:
        """Times of reception and a column a field; all at once where the messages repeat one layout."""
        try:
            received_ns, groups = decode.messages_by_length(self._bytes, self._reader, connections)
            return received_ns, decode.columns(groups, store, msgtype)
        except decode.Irregular:
            pass
        received: list[int] = []
        messages: list[Any] = []
        try:
            for _, time_ns, raw in self._reader.messages(connections):
                received.append(time_ns)
                messages.append(store.deserialize_ros1(raw, msgtype))
        except Exception as error:
            raise Error(f"after {len(messages)} messages: {error}") from error
        return np.array(received, dtype=np.int64), _columns(messages, store, msgtype)

    def _stamps(self, columns: dict[str, NDArray[Any]], t_received: Floats) -> Floats:
        if "header.stamp.sec" not in columns:
            return t_received
        sec = columns["header.stamp.sec"].astype(np.int64)
        # Integers until the start is taken off: 1.7e18 ns does not fit a float64.
        t = (sec * 1_000_000_000 + columns["header.stamp.nanosec"].astype(np.int64) - self.start_ns) * 1e-9
        return np.where(sec == 0, t_received, t)

    def _store_for(self, connection: Any) -> Any:
        """A type store that knows this connection's type; a second one when a type was redefined in the bag."""
        from rosbags.typesys import Stores, get_types_from_msg, get_typestore

        types = get_types_from_msg(connection.msgdef.data, connection.msgtype)
        for store in self._stores:
            if all(name not in store.fielddefs or store.fielddefs[name] == fields for name, fields in types.items()):
                store.register({name: fields for name, fields in types.items() if name not in store.fielddefs})
                return store
        self._stores.append(get_typestore(Stores.EMPTY))
        self._stores[-1].register(types)
        return self._stores[-1]


def _columns(messages: list[Any], store: Any, msgtype: str) -> dict[str, NDArray[Any]]:
    return {path: _stack(list(map(get, messages))) for path, get in _leaves(store, msgtype, "")}


def _leaves(store: Any, msgtype: str, prefix: str) -> list[tuple[str, Callable[[Any], Any]]]:
    """Dotted paths of all fields that are no nested message."""
    from rosbags.interfaces import Nodetype

    leaves: list[tuple[str, Callable[[Any], Any]]] = []
    for name, (kind, detail) in store.fielddefs[msgtype][1]:
        path = prefix + name
        if kind == Nodetype.NAME:
            leaves += _leaves(store, str(detail), path + ".")
        else:
            leaves.append((path, attrgetter(path)))
    return leaves


def _stack(values: list[Any]) -> NDArray[Any]:
    first = values[0]
    if isinstance(first, np.ndarray):
        if all(value.shape == first.shape for value in values):
            return np.stack(values)
    elif not isinstance(first, list):
        return np.array(values)
    column = np.empty(len(values), dtype=object)
    column[:] = values
    return column
