"""docs/safety.md names tests that exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NAMED = sorted(set(re.findall(r"`((?:tests|benchmarks)/[\w/.]+)(?:::(\w+))?`", (ROOT / "docs/safety.md").read_text())))


def test_the_page_names_tests() -> None:
    assert len(NAMED) > 20


@pytest.mark.parametrize(("path", "name"), NAMED, ids=lambda value: value or "whole")
def test_each_named_test_exists(path: str, name: str) -> None:
    text = (ROOT / path).read_text(encoding="utf-8")
    if name:
        assert re.search(rf"def {name}\(|TEST(?:_F|_P)?\(\w+, {name}\)", text), f"{path} has no test {name}"
