"""Every program that a launch file starts is there: roslaunch only prints an error for one that is not."""

from __future__ import annotations

import xml.etree.ElementTree
from pathlib import Path

import pytest

packages = pytest.importorskip("roslib.packages")

ROOT = Path(__file__).resolve().parents[2]
PROGRAMS = sorted(
    {
        (node.get("pkg"), node.get("type"), path.name)
        for path in (ROOT / "launch").glob("*.launch")
        for node in xml.etree.ElementTree.parse(path).getroot().iter("node")
    }
)


def test_launch_files_start_programs() -> None:
    assert len(PROGRAMS) > 40


@pytest.mark.parametrize(("package", "program", "launch"), PROGRAMS)
def test_the_program_is_there(package: str, program: str, launch: str) -> None:
    if "$(" in package + program:
        pytest.skip("its name is an argument")
    assert packages.find_node(package, program), f"{launch}: no program {program} in the package {package}"
