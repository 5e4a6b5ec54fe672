"""docs/fault_matrix.md has every row of the catalogue that it is for, and names tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROWS = [*range(1, 19), *range(32, 41), *range(42, 49), 57, 58]
LINES = [
    [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
    for line in (ROOT / "docs" / "fault_matrix.md").read_text(encoding="utf-8").splitlines()
    if re.match(r"\| \d+ \|", line)
]


@pytest.mark.parametrize("row", ROWS)
def test_the_row_is_there_and_its_test_exists(row: int) -> None:
    lines = [line for line in LINES if line[0] == str(row)]
    assert lines, f"row {row} is missing"
    for _, what, injected, seen, result, test in lines:
        assert what and seen
        assert result in ("passed", "**FAILED**", "NOT RUN")
        if result == "NOT RUN":  # honestly marked, with the reason
            assert not test
            continue
        assert injected
        path, _, name = test.strip("`").partition("::")
        assert re.search(rf"def {name.split('[')[0]}\(", (ROOT / path).read_text(encoding="utf-8")), (
            f"{test} does not exist"
        )


def test_no_other_rows() -> None:
    assert {int(line[0]) for line in LINES} == set(ROWS)
