"""The layers of docs/architecture.md: an arrow never points down."""

from __future__ import annotations

import ast
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
ROS_OR_PYTHON = re.compile(
    r"^(visp3?/|ros/|tf2|nodelet|pluginlib|image_transport|cv_bridge|\w+_msgs/|Python\.h|pybind11/|numpy/|patchlevel\.h)"
)


def core_files() -> list[Path]:
    return [path for path in (ROOT / "cpp").rglob("*") if path.suffix in (".hpp", ".cpp", ".h")]


def test_the_core_exists() -> None:
    assert len(core_files()) > 10


@pytest.mark.parametrize("path", core_files(), ids=lambda path: str(path.relative_to(ROOT)))
def test_core_includes_neither_ros_nor_python(path: Path) -> None:
    forbidden = [name for name in INCLUDE.findall(path.read_text()) if ROS_OR_PYTHON.match(name)]
    assert not forbidden


@pytest.mark.parametrize("path", core_files(), ids=lambda path: str(path.relative_to(ROOT)))
def test_core_reads_no_clock_and_keeps_no_thread_outside_runtime(path: Path) -> None:
    if "runtime" in path.parts:
        return
    assert not [name for name in INCLUDE.findall(path.read_text()) if name in ("chrono", "thread", "ctime", "iostream")]


def imported_modules(path: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            yield node.module


def test_the_python_package_does_not_know_ros() -> None:
    ros = re.compile(r"^(rospy|tf2_|roslib|rosbag(\.|$)|saras_ros1|\w+_msgs)")
    for path in (ROOT / "bindings" / "saras").rglob("*.py"):
        assert not [name for name in imported_modules(path) if ros.match(name)], path


def test_no_path_of_a_machine_stands_in_a_tracked_text() -> None:
    suspicious = re.compile(r"/(work|home/\w+|root)/\w+")
    listed = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=False).stdout
    for path in (ROOT / name for name in listed.splitlines()):
        if path.suffix in (".png", ".stl") or path == Path(__file__).resolve() or not path.is_file():
            continue
        found = suspicious.search(path.read_text(errors="replace"))
        assert not found, f"{path.relative_to(ROOT)}: {found.group(0) if found else ''}"
