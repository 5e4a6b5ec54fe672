"""`pip install .` into a fresh environment without ROS: the examples and the console run there."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run(*command: object, cwd: Path, **extra: str) -> subprocess.CompletedProcess[str]:
    """Without the variables that would let the environment at hand leak in."""
    clean = {k: v for k, v in os.environ.items() if not k.startswith(("PYTHON", "ROS", "CATKIN", "CMAKE_PREFIX"))}
    clean.update(extra)
    return subprocess.run(
        [str(part) for part in command], cwd=cwd, env=clean, text=True, capture_output=True, check=False
    )


@pytest.fixture(scope="module")
def fresh_python(tmp_path_factory: pytest.TempPathFactory) -> Path:
    where = tmp_path_factory.mktemp("wheel")
    base = getattr(sys, "_base_executable", sys.executable)
    assert run(base, "-m", "venv", where / "venv", cwd=where).returncode == 0
    python = where / "venv" / "bin" / "python"
    done = run(python, "-m", "pip", "install", "--quiet", f"{ROOT}[plot,calibration,csa]", cwd=where)
    assert done.returncode == 0, done.stderr[-3000:]
    return python


def test_it_imports_without_ros(fresh_python: Path, tmp_path: Path) -> None:
    rooms = "import saras.teleop, saras.kinematics, saras.sim, saras.net, saras.calibration, saras.csa, saras.model"
    done = run(fresh_python, "-c", rooms, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert run(fresh_python, "-c", "import rospy", cwd=tmp_path).returncode != 0


@pytest.mark.parametrize("example", sorted((ROOT / "examples").glob("[0-9]*.py")), ids=lambda path: path.stem)
def test_example_runs(fresh_python: Path, tmp_path: Path, example: Path) -> None:
    done = run(fresh_python, example, cwd=tmp_path, MPLBACKEND="Agg")
    assert done.returncode == 0, done.stderr[-3000:]


def test_console_runs(fresh_python: Path, tmp_path: Path) -> None:
    saras = fresh_python.parent / "saras"
    arguments = [
        "--device",
        "script",
        "--duration",
        "2",
        "--platform",
        "127.0.0.1:28990",
        "--listen",
        "127.0.0.1:28991",
    ]
    done = run(saras, "console", *arguments, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
