"""What a fault test injected and saw, one JSON file a row and part, for script/fault-matrix.

Nothing is written unless SARAS_FAULTS_RESULTS names a directory. Standard library only: tests of any level use it.
"""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Row:
    """One injection. ``seen`` is a sentence with numbers; parts of a row are told apart by ``part``."""

    number: int
    injected: str
    test: str
    part: str = ""
    hosting: str = ""
    limits: str = ""
    seen: list[str] = field(default_factory=list)

    def saw(self, sentence: str) -> None:
        """Adds to what was seen."""
        self.seen.append(sentence)

    def write(self, result: str) -> None:
        """The file of this row and part; a later test of the same one overwrites it."""
        directory = os.environ.get("SARAS_FAULTS_RESULTS")
        if not directory:
            return
        name = f"row_{self.number:02d}_{re.sub(r'[^a-z0-9]+', '_', self.part.lower())}".rstrip("_")
        path = Path(directory, f"{name}.json")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(
            json.dumps({**self.__dict__, "seen": "; ".join(self.seen), "result": result}, indent=1), encoding="utf-8"
        )


@contextmanager
def recorded(row: Row) -> Iterator[Row]:
    """Writes the row: passed, or failed with the first line of what went wrong."""
    try:
        yield row
    except BaseException as error:
        row.saw(f"{type(error).__name__}: {(str(error).splitlines() or [''])[0]}")
        row.write("failed")
        raise
    row.write("passed")
