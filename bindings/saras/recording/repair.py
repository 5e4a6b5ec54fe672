"""Mends a bag that its recorder could not close, or that was cut: ``saras bag repair``.

Whole chunks are copied as they are; of an open, cut or damaged chunk what can be read is kept (``rosbag reindex`` drops
it). Index, chunk infos and connections are made anew.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from saras import Error
from saras.recording.completeness import lost_by_sequence
from saras.recording.records import BAG_HEADER, CHUNK, CHUNK_INFO, INDEX, MAGIC
from saras.recording.survey import ChunkEntry, Survey, survey

_PADDED = 4096  # of the bag header's record, as every writer makes it
_MTIME_BELIEVED_S = 60.0


@dataclass(frozen=True)
class Repaired:
    """What came of it. Times [s]; None: cannot be known."""

    source: Path
    out: Path
    before: Survey
    messages: int
    duration_s: float
    lost_in_gaps_s: float  #: time between the messages around unreadable places
    lost_by_sequence: int  #: messages missing from what was recovered, by their publishers' numbers
    lost_at_end_s: float | None  #: estimated from the bytes that are missing, or the time of the last write
    lost_at_end_messages: int | None  #: estimated at the mean rate
    dropped: int  #: messages whose topic is not known because that record is lost

    def lines(self) -> list[str]:
        """For a person."""
        text = [f"{self.out}: {self.messages} messages, {self.duration_s:.3f} s"]
        if not self.before.closed:
            text.append("the recorder was killed before it could close the file")
        if self.before.missing_bytes:
            text.append(f"the file is at least {self.before.missing_bytes} bytes shorter than when it was closed")
        for gap in self.before.gaps:
            if gap.after_ns is not None and gap.before_ns is not None:
                where = f"after {(gap.after_ns - self.before.start_ns) * 1e-9:.3f} s"
                text.append(f"{gap.bytes} bytes unreadable {where}: {(gap.before_ns - gap.after_ns) * 1e-9:.3f} s")
            elif gap.bytes:
                text.append(f"{gap.bytes} bytes unreadable at the {'end' if gap.after_ns is not None else 'begin'}")
        if self.lost_by_sequence:
            text.append(f"{self.lost_by_sequence} messages missing in between, by their publishers' numbers")
        if self.dropped:
            text.append(f"{self.dropped} messages dropped: the record that names their topic is lost")
        if self.lost_at_end_s is not None:
            text.append(f"lost at the end: about {self.lost_at_end_s:.3f} s, {self.lost_at_end_messages} messages")
        else:
            text.append("lost at the end: not known")
        return text


def default_out(path: Path) -> Path:
    """``a.bag.active`` and ``a.bag`` become ``a.repaired.bag``."""
    name = path.name.removesuffix(".active").removesuffix(".orig").removesuffix(".bag")
    return path.with_name(name + ".repaired.bag")


def repair(
    path: str | Path,
    out: str | Path | None = None,
    force: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Repaired:
    """Writes a whole bag from a damaged one, which stays as it is.

    Raises saras.Error when the file is no bag, has nothing to recover, or ``out`` exists and not ``force``.
    """
    source = Path(path)
    target = default_out(source) if out is None else Path(out)
    if target.exists() and (not force or target.samefile(source)):
        raise Error(f"{target}: exists already" + ("" if force else " (--force overwrites)"))
    found = survey(source, progress)
    part = target.with_name(target.name + ".part")
    try:
        _write(part, found)
        part.replace(target)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    end_s, end_messages = _lost_at_end(found)
    between = [gap for gap in found.gaps if gap.after_ns is not None and gap.before_ns is not None]
    return Repaired(
        source,
        target,
        found,
        found.messages,
        found.duration_s,
        float(sum((gap.before_ns or 0) - (gap.after_ns or 0) for gap in between)) * 1e-9,
        sum(lost_by_sequence(publisher.seq)[0] for publisher in found.publishers if publisher.seq is not None),
        end_s,
        end_messages,
        found.orphans,
    )


def _lost_at_end(found: Survey) -> tuple[float | None, int | None]:
    if found.whole:
        return 0.0, 0
    duration_s = found.duration_s
    if found.missing_bytes and duration_s > 0:
        # Index records are in the bytes on both sides of the division.
        seconds = found.missing_bytes * duration_s / found.size_bytes
    elif not found.closed:
        seconds = found.path.stat().st_mtime - found.stop_ns * 1e-9
        if not -1.0 <= seconds <= _MTIME_BELIEVED_S:  # a copy, or another clock
            return None, None
        seconds = max(seconds, 0.0)
    elif any(gap.before_ns is None for gap in found.gaps):
        return None, None
    else:
        return 0.0, 0
    return seconds, round(seconds * found.messages / duration_s) if duration_s > 0 else None


def _write(path: Path, found: Survey) -> None:
    known = np.array(sorted(found.connections), dtype=np.int64)
    infos: list[bytes] = []
    with found.path.open("rb") as source, path.open("wb") as out:
        out.write(MAGIC + _bag_header(0, 0, 0))
        for chunk in found.chunks:
            keep = np.isin(chunk.connection, known)
            if not keep.any():
                continue
            position = out.tell()
            if chunk.data is None:
                source.seek(chunk.start)
                out.write(source.read(chunk.stop - chunk.start))
            else:
                fields = {"compression": b"none", "op": bytes([CHUNK]), "size": struct.pack("<I", len(chunk.data))}
                out.write(_record(fields, chunk.data))
            infos.append(_index(out.write, chunk, keep, position))
        index_position = out.tell()
        connections = [found.connections[number] for number in known]
        for connection in connections:
            out.write(connection.record)
        for info in infos:
            out.write(info)
        out.seek(len(MAGIC))
        out.write(_bag_header(index_position, len(connections), len(infos)))
        out.flush()
        os.fsync(out.fileno())


def _index(write: Callable[[bytes], object], chunk: ChunkEntry, keep: NDArray[np.bool_], position: int) -> bytes:
    """Writes the index records of a chunk; returns its chunk info."""
    counts = []
    for number in np.unique(chunk.connection[keep]):
        own = chunk.connection == number
        seconds, nanoseconds = np.divmod(chunk.time_ns[own], 1_000_000_000)
        data = np.stack([seconds, nanoseconds, chunk.offset[own]], axis=1).astype("<u4").tobytes()
        count = int(own.sum())
        fields = {"conn": struct.pack("<I", number), "count": struct.pack("<I", count), "op": bytes([INDEX])}
        write(_record({**fields, "ver": struct.pack("<I", 1)}, data))
        counts.append(struct.pack("<II", number, count))
    fields = {
        "chunk_pos": struct.pack("<Q", position),
        "count": struct.pack("<I", len(counts)),
        "end_time": _time(int(chunk.time_ns[keep].max())),
        "op": bytes([CHUNK_INFO]),
        "start_time": _time(int(chunk.time_ns[keep].min())),
        "ver": struct.pack("<I", 1),
    }
    return _record(fields, b"".join(counts))


def _bag_header(index_position: int, connections: int, chunks: int) -> bytes:
    fields = {
        "chunk_count": struct.pack("<I", chunks),
        "conn_count": struct.pack("<I", connections),
        "index_pos": struct.pack("<Q", index_position),
        "op": bytes([BAG_HEADER]),
    }
    bare = _record(fields, b"")
    return bare[:-4] + struct.pack("<I", _PADDED - len(bare)) + b" " * (_PADDED - len(bare))


def _time(nanoseconds: int) -> bytes:
    return struct.pack("<II", *divmod(nanoseconds, 1_000_000_000))


def _record(fields: dict[str, bytes], data: bytes) -> bytes:
    parts = [name.encode() + b"=" + value for name, value in fields.items()]
    header = b"".join(struct.pack("<I", len(part)) + part for part in parts)
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data
