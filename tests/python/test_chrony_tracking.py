"""What chrony says of this computer's clock: its line, a chronyc that fails, and a real chronyd where there is one."""

from __future__ import annotations

import math
import os
import shutil
import socket
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from saras_ros1 import chrony_tracking

ROOT = Path(__file__).resolve().parents[2]
CHRONYD = shutil.which("chronyd", path=os.environ["PATH"] + ":/usr/sbin")
LINE = (
    "C0A80501,192.168.5.1,11,1795419166.872555454,{system:.9f},0.000006746,{rms:.9f},"
    "-0.063,5.284,4.990,{delay:.9f},{dispersion:.9f},16.3,{leap}\n"
)


def chronyc(tmp_path: Path, script: str) -> str:
    path = tmp_path / "chronyc"
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return str(path)


def test_its_line_is_read(many: int) -> None:
    rng = np.random.default_rng(1)
    for _ in range(200 * many):
        system, rms = rng.normal(0.0, 3e-3), abs(rng.normal(0.0, 2e-3))
        delay, dispersion = rng.uniform(0.0, 0.02, 2)
        said = chrony_tracking.parse(
            LINE.format(system=system, rms=rms, delay=delay, dispersion=dispersion, leap="Normal")
        )
        assert said.offset_s == pytest.approx(-system, abs=1e-9)  # chronyc: positive is slow
        assert said.error_s == pytest.approx(dispersion + delay / 2, abs=1e-9)
        assert (said.source, said.stratum) == ("192.168.5.1", 11)
        assert chrony_tracking.beyond(said, 0.002) == (abs(said.offset_s) > 0.002 or said.rms_s > 0.002)


@pytest.mark.parametrize(
    "text",
    [
        "",
        "506 Cannot talk to daemon\n",
        LINE.format(system=0.0, rms=0.0, delay=1.0, dispersion=1.0, leap="Not synchronised"),
        LINE.format(system=math.nan, rms=0.0, delay=1.0, dispersion=1.0, leap="Normal"),
        LINE.format(system=0.0, rms=0.0, delay=1.0, dispersion=1.0, leap="Normal").replace(",11,", ",eleven,"),
    ],
)
def test_anything_else_is_unknown_and_not_a_warning(text: str) -> None:
    said = chrony_tracking.parse(text)
    assert math.isnan(said.offset_s) and said.why
    assert chrony_tracking.words(said).startswith("unknown: ")
    assert not chrony_tracking.beyond(said, 1e-6)


def test_a_chronyc_that_fails_hangs_or_is_absent(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert chrony_tracking.ask([str(tmp_path / "chronyc")]) is None
    line = LINE.format(system=0.0031, rms=1e-5, delay=1e-3, dispersion=1e-3, leap="Normal").strip()
    good = chrony_tracking.ask([chronyc(tmp_path, f'[ "$*" = "-c tracking" ] && echo "{line}"')])
    assert good is not None and good.offset_s == pytest.approx(-0.0031)
    assert "-3.100 ms" in chrony_tracking.words(good)
    refused = chrony_tracking.ask([chronyc(tmp_path, "echo 506 Cannot talk to daemon; exit 1")])
    assert refused is not None and "506" in refused.why
    monkeypatch.setattr(chrony_tracking, "ANSWER_S", 0.2)
    hung = chrony_tracking.ask([chronyc(tmp_path, "exec sleep 30")])
    assert hung is not None and "does not answer" in hung.why


@pytest.mark.skipif(
    not (
        shutil.which("chronyd", path=os.environ["PATH"] + ":/usr/sbin")
        and shutil.which("chronyc")
        and os.geteuid() == 0
    ),
    reason="needs chrony, and root",
)
def test_a_real_chronyd_whose_source_is_ahead(tmp_path: Path) -> None:
    """-x: it measures, and leaves this computer's clock alone."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    run = tmp_path / "run"
    run.mkdir(mode=0o770)
    config = tmp_path / "chrony.conf"
    config.write_text(
        f"server 127.0.0.1 port {port} iburst minpoll -2 maxpoll -2\n"
        f"cmdport 0\nport 0\nbindcmdaddress {run}/chronyd.sock\npidfile {run}/chronyd.pid\n"
    )
    ahead = {**os.environ, "SARAS_CLOCK_AHEAD_S": "0.005"}
    ahead["PYTHONPATH"] = f"{ROOT / 'tests' / 'fakes' / 'clock_shim'}:{ahead.get('PYTHONPATH', '')}"
    server = subprocess.Popen(
        [sys.executable, str(ROOT / "tests/fakes/ntp_server.py"), "127.0.0.1", str(port)], env=ahead
    )
    keeper = subprocess.Popen(
        [str(CHRONYD), "-d", "-x", "-u", "root", "-f", str(config)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        end, said = time.monotonic() + 60.0, None
        while time.monotonic() < end and (said is None or math.isnan(said.offset_s)):
            time.sleep(0.2)
            said = chrony_tracking.ask(["chronyc", "-h", str(run / "chronyd.sock")])
        assert said is not None and not math.isnan(said.offset_s), said
        assert said.offset_s == pytest.approx(-0.005, abs=0.002)  # the source is ahead: this clock is behind
        assert chrony_tracking.beyond(said, 0.002) and not chrony_tracking.beyond(said, 0.02)
    finally:
        for process in (keeper, server):
            process.terminate()
            process.wait(30.0)
    gone = chrony_tracking.ask(["chronyc", "-h", str(run / "chronyd.sock")])
    assert gone is not None and math.isnan(gone.offset_s)
