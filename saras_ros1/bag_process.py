"""rosbag's own recorder as a child process, and what it has written. No ROS: tests put another program in its place."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import struct
import subprocess
from collections.abc import Sequence
from pathlib import Path

RECORD = "/usr/lib/rosbag/record"
STOP_S = 10.0
TAIL_BYTES = 1 << 16
#: Head of each message's record: the field's length, its name; seconds and nanoseconds follow (rosbag format 2.0).
TIME_FIELD = b"\x0d\0\0\0time="
#: Runs a program until it ends or the input does: who started it may be killed, the bag is closed all the same.
LEASH = """
exec 3<&0
"$@" </dev/null 3<&- & child=$!
{ cat <&3 >/dev/null; kill -INT $child 2>/dev/null; } & reader=$!
wait $child; code=$?
kill $reader 2>/dev/null
exit $code
"""


def _quietly() -> list[str]:
    """Control first: the recorder has its queue. Each message passes through three of its dozen threads: on one
    processor, and without interrupting each other, that costs a third less.
    """
    words = ["nice", "-n", "5"]
    if shutil.which("chrt"):
        words += ["chrt", "--batch", "0"]
    if shutil.which("taskset"):
        words += ["taskset", "-c", str(max(os.sched_getaffinity(0)))]
    return words


def newest_time_ns(data: bytes) -> int | None:
    """The last time of a message in a piece of an uncompressed bag; None: no message begins in it."""
    at = data.rfind(TIME_FIELD)
    while at >= 0 and at + len(TIME_FIELD) + 8 > len(data):  # cut off
        at = data.rfind(TIME_FIELD, 0, at)
    if at < 0:
        return None
    sec, nanosec = struct.unpack_from("<II", data, at + len(TIME_FIELD))
    return sec * 1_000_000_000 + nanosec


class BagProcess:
    """One recording: PATH.bag, or PATH_0.bag, PATH_1.bag … when it is split; `.active` while it is written.

    rosbag's own limit of free space is set aside: RecordingWatch ends a recording while it can still be closed.
    """

    def __init__(
        self, path: Path, topics: Sequence[str], *, chunk_kB: int, split_MB: int = 0, program: str = RECORD
    ) -> None:
        """chunk_kB: a killed recorder loses the chunk it was filling. split_MB: size of each file, 0: one file."""
        self.path = path
        self._stem = path.name.removesuffix(".bag")
        split = ["--split", f"--size={split_MB}"] if split_MB else []
        command = [
            program,
            f"--chunksize={chunk_kB}",
            "--min-space=1M",
            "--tcpnodelay",
            *split,
            "-O",
            str(path),
            *topics,
        ]
        command = ["sh", "-c", LEASH, "sh", *_quietly(), *command]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, start_new_session=True)

    @property
    def pid(self) -> int:
        """Of the shell that holds the recorder; the recorder is its child."""
        return self._process.pid

    @property
    def exit_code(self) -> int | None:
        """None while it runs; negative: the signal that ended it."""
        code = self._process.poll()
        return code if code is None or code <= 128 else 128 - code

    def files(self) -> list[Path]:
        """All files of this recording, finished or not."""
        names = [f"{self._stem}.bag*", f"{self._stem}_[0-9]*.bag*"]
        return sorted(file for pattern in names for file in self.path.parent.glob(pattern))

    def bytes(self) -> int:
        """Written so far; what cannot be read counts nothing."""
        total = 0
        for file in self.files():
            try:
                total += file.stat().st_size
            except OSError:
                continue
        return total

    def newest_ns(self) -> int | None:
        """Reception of the newest message that has reached the file, nanoseconds since the epoch; None: not known."""
        files = [file for file in self.files() if file.name.endswith(".active")]
        try:
            with files[-1].open("rb") as file:
                file.seek(0, os.SEEK_END)
                file.seek(max(0, file.tell() - TAIL_BYTES))
                return newest_time_ns(file.read())
        except (IndexError, OSError):
            return None

    def unfinished(self) -> list[Path]:
        """Files that were not closed: `saras bag repair` mends them."""
        return [file for file in self.files() if file.name.endswith(".active")]

    def stop(self) -> None:
        """Lets it close its file; a child that does not end is killed."""
        assert self._process.stdin is not None
        with contextlib.suppress(OSError):
            self._process.stdin.close()
        try:
            self._process.wait(STOP_S)
        except subprocess.TimeoutExpired:
            os.killpg(self._process.pid, signal.SIGKILL)
            self._process.wait()
