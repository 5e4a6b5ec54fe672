"""safety/hazards.yaml names tests that exist, and docs/safety.md is made of it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
ROWS = yaml.safe_load((ROOT / "safety" / "hazards.yaml").read_text(encoding="utf-8"))
NAMED = sorted({name for row in ROWS for name in row["shown_by"]})


def test_the_table_names_tests() -> None:
    assert len(NAMED) > 60
    assert all(row["hazard"] and row["required"] and row["shown_by"] for row in ROWS)


@pytest.mark.parametrize("named", NAMED)
def test_each_named_test_exists(named: str) -> None:
    path, _, name = named.partition("::")
    text = (ROOT / path.split()[0]).read_text(encoding="utf-8")
    if name:
        assert re.search(rf"def {name}\(|TEST(?:_F|_P)?\(\w+, {name}\)", text), f"{path} has no test {name}"


def test_the_page_is_made_of_the_table() -> None:
    command = [sys.executable, str(ROOT / "safety" / "report.py"), "--check"]
    said = subprocess.run(command, capture_output=True, text=True, check=False)
    assert said.returncode == 0, said.stdout + said.stderr
