"""Every example runs from the installed package, and those that draw give a picture."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("[0-9][0-9]_*.py"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs(example, tmp_path):
    arguments = []
    if "--duration" in example.read_text():
        arguments += ["--duration", "5"]
    picture = tmp_path / "picture.png"
    if "--plot" in example.read_text():
        pytest.importorskip("matplotlib")
        arguments += ["--plot", str(picture)]
    done = subprocess.run(
        [sys.executable, str(example), *arguments],
        cwd=tmp_path,
        env={**os.environ, "MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout
    if "--plot" in arguments:
        assert picture.read_bytes().startswith(b"\x89PNG")


def test_examples_are_numbered_without_gaps():
    assert [int(path.name[:2]) for path in EXAMPLES] == list(range(1, len(EXAMPLES) + 1))
