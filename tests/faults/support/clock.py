"""The wall clock of all processes of a platform, to be stepped while they run (clock_shim.c)."""

from __future__ import annotations

import struct
import subprocess
from pathlib import Path


class Clock:
    """Give ``env`` to what is started; step() then shifts its wall clock. Compiles the shim."""

    def __init__(self, directory: Path) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        source = Path(__file__).resolve().parents[1] / "clock_shim.c"
        library = directory / "clock_shim.so"
        subprocess.run(["cc", "-O2", "-Wall", "-Werror", "-shared", "-fPIC", "-o", library, source, "-ldl"], check=True)
        self._file = directory / "clock_shift"
        self._file.write_bytes(struct.pack("<q", 0))
        self.env = {"LD_PRELOAD": str(library), "CLOCK_SHIM_FILE": str(self._file)}

    def step(self, shift_s: int) -> None:
        """The clock is from now on so many seconds off the true one, for all processes at once."""
        with self._file.open("r+b") as file:
            file.write(struct.pack("<q", shift_s))
