"""Key file of an authenticated Touchball link: one secret key for each direction, the same file at both ends.

The file is JSON: {"format": "saras touchball keys", "version": 1, "up": "…", "down": "…"}, each key 32 bytes in
hexadecimal. It is made by ``saras keys make FILE`` with mode 0600, and refused when others than its owner may read it.
"""

from __future__ import annotations

import hashlib
import json
import os
import secrets
import stat
from dataclasses import dataclass
from pathlib import Path

from saras import ConfigError

FORMAT, VERSION = "saras touchball keys", 1
KEY_BYTES = 32
MOST_BYTES = 4096  #: of a key file
LEAST_DISTINCT_BYTES = 8  #: in a key: fewer were typed or are padding (a drawn key has 30 of 32)


@dataclass(frozen=True, repr=False)
class Keys:
    """Secret keys (32 bytes each): ``up`` for console → platform, ``down`` for platform → console."""

    up: bytes
    down: bytes

    def __post_init__(self) -> None:
        for name in ("up", "down"):
            key = getattr(self, name)
            if len(key) != KEY_BYTES:
                raise ConfigError(f"{name}: a key of {len(key)} bytes: must be {KEY_BYTES}")
            if len(set(key)) < LEAST_DISTINCT_BYTES:
                raise ConfigError(f"{name}: not a random key; make one with: saras keys make FILE")
        if self.up == self.down:
            raise ConfigError("up, down: the same key for both directions: an answer could be sent back as a question")

    def fingerprint(self) -> str:
        """16 hexadecimal digits to compare two files by, from which the keys cannot be found."""
        digest = hashlib.sha256(b"saras touchball fingerprint 1" + self.up + self.down).hexdigest()
        return " ".join(digest[i : i + 4] for i in range(0, 16, 4))

    def __repr__(self) -> str:
        return f"Keys({self.fingerprint()})"  # never the keys: this goes to logs


def draw() -> Keys:
    """New keys from the operating system's random source."""
    return Keys(secrets.token_bytes(KEY_BYTES), secrets.token_bytes(KEY_BYTES))


def save(path: Path, keys: Keys) -> None:
    """Writes a new file that its owner alone may read. Raises ConfigError when the path exists."""
    content = {"format": FORMAT, "version": VERSION, "up": keys.up.hex(), "down": keys.down.hex()}
    try:
        descriptor = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    except FileExistsError:
        raise ConfigError(f"key file = {path}: exists already; keys in use are not overwritten") from None
    except OSError as error:
        raise ConfigError(f"key file = {path}: {error.strerror}") from None
    with os.fdopen(descriptor, "w", encoding="ascii") as file:
        json.dump(content, file, indent=2)
        file.write("\n")


def load(path: Path) -> Keys:
    """Reads and checks. Raises ConfigError naming the file and what is wrong with it, never what stands in it."""
    try:
        with path.open("rb") as file:
            _check_access(path, os.fstat(file.fileno()))
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise ConfigError(f"key file = {path}: {error.strerror}; make one with: saras keys make FILE") from None
    if len(data) > MOST_BYTES:
        raise ConfigError(f"key file = {path}: more than {MOST_BYTES} bytes: not a key file")
    try:
        content = json.loads(data)
    except ValueError:
        raise ConfigError(f"key file = {path}: not JSON") from None
    if not isinstance(content, dict) or content.get("format") != FORMAT:
        raise ConfigError(f"key file = {path}: its format is not {FORMAT!r}")
    if content.get("version") != VERSION:
        raise ConfigError(f"key file = {path}: version = {content.get('version')!r}: must be {VERSION}")
    unknown = sorted(set(content) - {"format", "version", "up", "down"})
    if unknown:
        raise ConfigError(f"key file = {path}: {unknown[0]}: unknown field")
    try:
        return Keys(_key(content, "up"), _key(content, "down"))
    except ConfigError as error:
        raise ConfigError(f"key file = {path}: {error}") from None


def _key(content: dict[str, object], name: str) -> bytes:
    text = content.get(name)
    try:
        return bytes.fromhex(text) if isinstance(text, str) else _not_hexadecimal(name)
    except ValueError:
        return _not_hexadecimal(name)


def _not_hexadecimal(name: str) -> bytes:
    raise ConfigError(f"{name}: must be {2 * KEY_BYTES} hexadecimal digits")


def _check_access(path: Path, status: os.stat_result) -> None:
    if not stat.S_ISREG(status.st_mode):
        raise ConfigError(f"key file = {path}: not a regular file")
    if os.name == "nt":
        return  # access lists, not mode bits: keep the file in the user's own directory
    mode = stat.S_IMODE(status.st_mode)
    if mode & 0o077:
        raise ConfigError(f"key file = {path}: mode = {mode:04o}: must be 0600, others can read it; chmod 600 it")
    if status.st_uid not in (os.geteuid(), 0):
        raise ConfigError(f"key file = {path}: belongs to user {status.st_uid}: must be the user's own or root's")
