"""The SPIN model says what the code does, its properties hold, and each of them can fail."""

from __future__ import annotations

import re
import shutil
import subprocess
from pathlib import Path

import pytest

from saras.safety import promela

ROOT = Path(__file__).resolve().parents[2]
MODEL = ROOT / "safety"

needs_spin = pytest.mark.skipif(
    shutil.which("spin") is None or shutil.which("gcc") is None,
    reason="spin or gcc is not installed (script/bootstrap installs both)",
)


def verify(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [str(ROOT / "script" / "verify-model"), *(str(argument) for argument in arguments)]
    return subprocess.run(command, text=True, capture_output=True, check=False, timeout=300)


def test_the_models_tables_are_those_of_the_core() -> None:
    written = (MODEL / "supervisor_tables.pml").read_text()
    assert written == promela(), "run script/verify-model --write"


@needs_spin
def test_all_properties_hold() -> None:
    done = verify()
    assert done.returncode == 0, done.stdout + done.stderr
    properties = re.findall(r"^ltl (\w+) ", (MODEL / "supervisor.pml").read_text(), re.MULTILINE)
    for name in ["deadlock_and_assertions", *properties]:
        assert re.search(rf"^{name} +ok ", done.stdout, re.MULTILINE), f"{name} was not checked"


WRONG = {
    "hold_latched": ("tables", "(s) == HOLD && (e) == EV_DISENGAGE", "(s) == HOLD && (e) == EV_READY"),
    "estop_latched": ("tables", "(s) == ESTOP && (e) == EV_ESTOP_RESET", "(s) == ESTOP && (e) == EV_ENGAGE"),
    "estop_wins": ("tables", "((estop) -> EV_ESTOP :", "((estop && !hold_asked) -> EV_ESTOP :"),
    "no_motion_without_engage": ("tables", "(s) == READY && (e) == EV_ENGAGE)", "(s) == READY && (e) == EV_READY)"),
    "hand_over_explicit": (
        "tables",
        "(h) == 1 && (o) == 2 && (a) == ACT_ACCEPT",
        "(h) == 1 && (o) == 2 && (a) == ACT_CLAIM",
    ),
    "no_lease_no_engagement": ("model", "holder == NOBODY || holder != engaged_by)", "holder == NOBODY)"),
    "one_holder": ("model", "engaged_by == who && holder == who ->", "true ->"),
    "recovers": ("tables", "(s) == ESTOP && (e) == EV_ESTOP_RESET", "(s) == ESTOP && (e) == EV_NONE"),
}


@needs_spin
def test_each_property_notices_what_it_is_there_for(tmp_path: Path) -> None:
    for name, (where, right, wrong) in WRONG.items():
        for file, kind in (("supervisor_tables.pml", "tables"), ("supervisor.pml", "model")):
            text = (MODEL / file).read_text()
            if kind == where:
                assert right in text, f"{name}: {right} is not in {file}"
                text = text.replace(right, wrong)
            (tmp_path / file).write_text(text)
        done = verify("--dir", tmp_path, "--only", name)
        assert done.returncode == 1, f"{name} did not notice {wrong!r}\n{done.stdout}{done.stderr}"
        assert re.search(rf"^{name} +FAILED ", done.stdout, re.MULTILINE), done.stdout
