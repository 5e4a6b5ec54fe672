"""What a simulated arm was told and what it did, a line of JSON each: for tests and for whoever debugs a client.

Lines, each with ``t_s`` (the arm's monotonic clock):
  {"command": "set_target", "session": 7, "seq": 3, "position": [3] m, …}  taken
  {"refused": "expired", "command": "set_target", "seq": 4}          not taken, and why
  {"tick": 12, "following": true, "target": [3] m, "tip": [3] m}  each tick: what the servo follows, where the tip is
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from saras.mesa_link import wire_json
from saras.mesa_link.plant import ArmSample


class ArmLog:
    """Appends to a file that it creates anew. Each line is complete as soon as it is there."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("w", encoding="utf-8", buffering=1)

    def taken(self, t_s: float, event: str, data: object) -> None:
        """A command that passed every check."""
        fields = data if isinstance(data, dict) else {}
        self._write({"t_s": t_s, "command": event, **fields})

    def refused(self, t_s: float, event: str, seq: int, reason: str) -> None:
        """A command that changed nothing."""
        self._write({"t_s": t_s, "refused": reason, "command": event, "seq": seq})

    def tick(self, t_s: float, tick: int, following: bool, sample: ArmSample) -> None:
        """One step of the machine."""
        self._write(
            {"t_s": t_s, "tick": tick, "following": following, "target": sample.target.position, "tip": sample.position}
        )

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def _write(self, line: dict[str, Any]) -> None:
        self._file.write(wire_json.dumps(line) + "\n")
