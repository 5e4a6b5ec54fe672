"""Messages of one topic as columns without an object a message.

Nearly all topics of a platform repeat one layout: their text has the same length in each message. Then a field stands
at the same offset in all messages, and a column is a slice of the matrix of their bytes. Messages are grouped by
length, and within a group all length prefixes are compared; what does not repeat is left to rosbags.
"""

from __future__ import annotations

import mmap
import struct
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]

_DTYPES = {
    **{f"{sign}int{bits}": f"<{sign[:1] or 'i'}{bits // 8}" for sign in ("", "u") for bits in (8, 16, 32, 64)},
    **{"float32": "<f4", "float64": "<f8", "bool": "|b1", "byte": "|u1", "char": "|u1", "octet": "|u1"},
}
_LARGEST = 1 << 16  # bytes of a message; pictures are left to the slow way
_FEWEST = 8  # messages of a group for which finding the layout pays
_GROUPS = 64


class Irregular(Exception):  # noqa: N818 - a signal, no error
    """These messages have no common layout."""


@dataclass(frozen=True)
class _Leaf:
    path: str
    kind: str  #: number, array, text, texts
    offset: int
    dtype: str = ""
    length: int = 0
    texts: tuple[tuple[int, int], ...] = ()  #: start and length of each, for texts


def columns(rows: list[tuple[NDArray[np.int64], Bytes]], store: Any, msgtype: str) -> dict[str, NDArray[Any]]:
    """One array a field, as ``saras.recording.Topic`` has them, from groups (places in the result, bytes (n, length)).

    Raises Irregular when the type or the messages have no common layout.
    """
    total = sum(len(places) for places, _ in rows)
    if len(rows) * _FEWEST > total:
        raise Irregular
    parts: dict[str, list[tuple[NDArray[np.int64], Any]]] = {}
    for places, matrix in rows:
        leaves, prefixes = _layout(matrix[0].tobytes(), store, msgtype)
        for at in prefixes:
            if (matrix[:, at : at + 4] != matrix[0, at : at + 4]).any():
                raise Irregular
        for leaf in leaves:
            parts.setdefault(leaf.path, []).append((places, _read(matrix, leaf)))
    return {path: _merged(pieces, total) for path, pieces in parts.items()}


def _layout(data: bytes, store: Any, msgtype: str) -> tuple[list[_Leaf], list[int]]:
    leaves: list[_Leaf] = []
    prefixes: list[int] = []
    end = _walk(data, 0, store, msgtype, "", leaves, prefixes)
    if end != len(data):
        raise Irregular
    return leaves, prefixes


def _walk(data: bytes, at: int, store: Any, msgtype: str, prefix: str, leaves: list[_Leaf], prefixes: list[int]) -> int:
    from rosbags.interfaces import Nodetype

    def count() -> int:
        nonlocal at
        if at + 4 > len(data):
            raise Irregular
        prefixes.append(at)
        (number,) = struct.unpack_from("<I", data, at)
        at += 4
        if number > len(data):
            raise Irregular
        return int(number)

    for name, (kind, detail) in store.fielddefs[msgtype][1]:
        path = prefix + name
        if kind == Nodetype.NAME:
            at = _walk(data, at, store, str(detail), path + ".", leaves, prefixes)
            continue
        if kind == Nodetype.BASE:
            base, many = detail[0], None
        else:
            (inner, base), length = detail
            many = int(length) if kind == Nodetype.ARRAY else count()
            if inner != Nodetype.BASE:
                if many:
                    raise Irregular
                leaves.append(_Leaf(path, "texts", at))
                continue
            base = base[0]
        if base == "string" and many is None:
            length = count()
            leaves.append(_Leaf(path, "text", at, length=length))
            at += length
        elif base == "string":
            texts = []
            for _ in range(many or 0):
                length = count()
                texts.append((at, length))
                at += length
            leaves.append(_Leaf(path, "texts", at, texts=tuple(texts)))
        elif base in _DTYPES:
            dtype = _DTYPES[base]
            leaves.append(_Leaf(path, "number" if many is None else "array", at, dtype, 1 if many is None else many))
            at += np.dtype(dtype).itemsize * (1 if many is None else many)
        else:
            raise Irregular
        if at > len(data):
            raise Irregular
    return at


def _read(matrix: Bytes, leaf: _Leaf) -> Any:
    """Array (n,) or (n, k) of numbers, else a list of n."""
    if leaf.kind in ("number", "array"):
        width = np.dtype(leaf.dtype).itemsize * leaf.length
        block = np.ascontiguousarray(matrix[:, leaf.offset : leaf.offset + width])
        values = block.view(leaf.dtype) if width else np.empty((len(matrix), 0), leaf.dtype)
        return _wide(values[:, 0]) if leaf.kind == "number" else values
    spans = leaf.texts if leaf.kind == "texts" else ((leaf.offset, leaf.length),)
    texts = [_texts(matrix[:, start : start + length]) for start, length in spans]
    if leaf.kind == "text":
        return texts[0]
    return [list(row) for row in zip(*texts)] if texts else [[] for _ in range(len(matrix))]


def _wide(values: NDArray[Any]) -> NDArray[Any]:
    """As Python's numbers become arrays: differences of unsigned ones would wrap."""
    if values.dtype.kind in "iu":
        return values.astype(np.int64) if values.dtype.itemsize < 8 or values.max() < 2**63 else values
    return values.astype(np.float64) if values.dtype.kind == "f" else values


def _texts(block: Bytes) -> list[str]:
    try:
        if block.size == 0 or (block == block[0]).all():
            return [block[0].tobytes().decode()] * len(block)
        return [row.tobytes().decode() for row in block]
    except UnicodeDecodeError:
        raise Irregular from None


def _merged(pieces: list[tuple[NDArray[np.int64], Any]], total: int) -> NDArray[Any]:
    first = pieces[0][1]
    if isinstance(first, np.ndarray) and all(piece.shape[1:] == first.shape[1:] for _, piece in pieces):
        result = np.empty((total, *first.shape[1:]), first.dtype.newbyteorder("="))
        for places, piece in pieces:
            result[places] = piece
        return result
    column = np.empty(total, dtype=object)
    for places, piece in pieces:
        for place, value in zip(places, piece):
            column[place] = value
    if not isinstance(first, np.ndarray) and isinstance(first[0], str):
        return np.array(column.tolist())
    return column


def messages_by_length(
    file: mmap.mmap, reader: Any, connections: list[Any]
) -> tuple[NDArray[np.int64], list[tuple[NDArray[np.int64], Bytes]]]:
    """Times of reception [ns] of all messages in order, and groups of equal length for ``columns``.

    ``reader`` is rosbags' open Reader, ``file`` its bag. Raises Irregular for packed chunks, and when index and records
    differ: rosbags then says what is wrong.
    """
    entries = [entry for connection in connections for entry in reader.indexes[connection.id]]
    if len(entries) < _FEWEST:
        raise Irregular
    index = np.array(entries, dtype=np.int64)
    index = index[np.argsort(index[:, 0], kind="stable")]
    positions, inverse = np.unique(index[:, 1], return_inverse=True)
    chunks = [reader.chunks[position] for position in positions]
    if not all(_plain(chunk) for chunk in chunks):
        raise Irregular
    data: Bytes = np.frombuffer(file, dtype=np.uint8)
    at = np.array([chunk.datapos for chunk in chunks], dtype=np.int64)[inverse] + index[:, 2]
    if at.max() + 46 > len(data):
        raise Irregular
    header = _uint32(data, at)
    # conn, op and time, in any order: no other record's header has this length and such a time.
    first = data[at[0] + 4 : at[0] + 42].tobytes()
    place = first.find(b"time=") + 5
    if (header != 38).any() or place < 5 or b"op=\x02" not in first:
        raise Irregular
    seconds, nanoseconds = _uint32(data, at + 4 + place), _uint32(data, at + 8 + place)
    if (seconds * 1_000_000_000 + nanoseconds != index[:, 0]).any():
        raise Irregular
    length = _uint32(data, at + 42)
    if (at + 46 + length > len(data)).any() or length.max() > _LARGEST or length.min() == 0:
        raise Irregular
    lengths = np.unique(length)
    if len(lengths) > _GROUPS:
        raise Irregular
    groups = []
    for size in lengths:
        places = np.flatnonzero(length == size)
        windows = np.lib.stride_tricks.sliding_window_view(data, int(size))
        groups.append((places, windows[at[places] + 46]))
    return index[:, 0], groups


def _plain(chunk: Any) -> bool:
    try:
        return bool(chunk.decompressor(b"-") == b"-")
    except Exception:  # whatever a decompressor raises on what it never packed
        return False


def _uint32(data: Bytes, at: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(data[at[:, None] + np.arange(4)]).view("<u4")[:, 0].astype(np.int64)
