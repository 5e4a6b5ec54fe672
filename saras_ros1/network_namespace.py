"""A network of one's own for a process and its children: only loopback, so that no port of theirs has an outside.

Works without privilege where the kernel allows user namespaces. A socket belongs to the namespace in which it was made,
whoever uses it: handed out of the namespace, it is the only way in.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import socket
import struct
from pathlib import Path

CLONE_NEWUSER, CLONE_NEWNET = 0x1000_0000, 0x4000_0000
_SIOCGIFFLAGS, _SIOCSIFFLAGS = 0x8913, 0x8914
IFF_UP, IFF_LOOPBACK = 0x1, 0x8
_PR_SET_PDEATHSIG = 1
_libc = ctypes.CDLL(None, use_errno=True)


def enter_new() -> None:
    """Moves this process, of one thread, into a new network namespace with loopback up. OSError when not permitted."""
    uid, gid = os.geteuid(), os.getegid()
    # Root needs no user namespace, and keeps its other rights without one.
    if _libc.unshare(CLONE_NEWNET | (CLONE_NEWUSER if uid != 0 else 0)) != 0:
        code = ctypes.get_errno()
        raise OSError(code, os.strerror(code))
    if uid != 0:
        Path("/proc/self/setgroups").write_text("deny")
        Path("/proc/self/uid_map").write_text(f"{uid} {uid} 1")
        Path("/proc/self/gid_map").write_text(f"{gid} {gid} 1")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        fcntl.ioctl(
            any_socket, _SIOCSIFFLAGS, struct.pack("16sH14x", b"lo", interface_flags(any_socket, "lo") | IFF_UP)
        )


def interface_flags(any_socket: socket.socket, name: str) -> int:
    """IFF_… of an interface of the namespace in which the socket was made; OSError when there is none."""
    answer = fcntl.ioctl(any_socket, _SIOCGIFFLAGS, struct.pack("16sH14x", name.encode(), 0))
    return int(struct.unpack("16sH14x", answer)[1])


def outside_interfaces() -> list[str]:
    """Interfaces of this namespace, other than loopback, that are up."""
    found = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        for _, name in socket.if_nameindex():
            try:
                flags = interface_flags(any_socket, name)
            except OSError:  # gone meanwhile
                continue
            if flags & IFF_UP and not flags & IFF_LOOPBACK:
                found.append(name)
    return found


def end_with_parent(signal_number: int) -> None:
    """The calling process gets the signal when its parent ends, however that happens."""
    _libc.prctl(_PR_SET_PDEATHSIG, signal_number)


def join_command(pid: int) -> list[str]:
    """What runs a program in the namespaces of process pid, as their owner; the program follows."""
    user = [] if Path(f"/proc/{pid}/ns/user").samefile("/proc/self/ns/user") else ["--user", "--preserve-credentials"]
    return ["nsenter", "--target", str(pid), "--net", *user, "--"]
