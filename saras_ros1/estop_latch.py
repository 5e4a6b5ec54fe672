"""The latched E-stop as a file, so that neither a restart of the supervisor nor one of the computer resets it."""

from __future__ import annotations

import os
from pathlib import Path

import rospkg


class EstopLatch:
    """A file that is there while an E-stop is latched; its text is the reason. Relative paths are under ROS's home."""

    def __init__(self, path: str) -> None:
        self.path = Path(rospkg.get_ros_home()) / Path(path).expanduser()

    def read(self) -> str:
        """The reason of the E-stop that was latched; "" when none was. One that cannot be read is latched too."""
        try:
            return self.path.read_text(encoding="utf-8").strip() or "E-stop"
        except FileNotFoundError:
            return ""
        except (OSError, UnicodeDecodeError) as error:
            return f"E-stop, and its file cannot be read: {error}"

    def write(self, reason: str) -> None:
        """Latches; raises OSError when it cannot be kept."""
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with self.path.open("w", encoding="utf-8") as file:
            file.write(reason + "\n")
            file.flush()
            os.fsync(file.fileno())

    def clear(self) -> None:
        """After a reset."""
        self.path.unlink(missing_ok=True)
