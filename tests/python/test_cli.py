"""The command saras and the console as a process: help, bad input, clean stops."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1]))
from fakes.touchball_platform import FakePlatform

from saras import cli

CONSOLE = [sys.executable, "-m", "saras", "console", "--plain", "--listen", "127.0.0.1:0"]


def test_help_lists_every_command_and_each_has_its_own(capsys):
    for argv in (["--help"], *([name, "--help"] for name in cli.COMMANDS)):
        with pytest.raises(SystemExit) as done:
            cli.main(argv)
        assert done.value.code == 0
        assert "usage: saras" in capsys.readouterr().out


def test_a_missing_library_is_named_by_the_command_that_needs_it(monkeypatch, capsys):
    monkeypatch.setitem(cli.COMMANDS, "lame", ("lame", "needs something"))

    def absent(name):
        raise ModuleNotFoundError("No module named 'matplotlib'", name="matplotlib")

    monkeypatch.setattr(cli.importlib, "import_module", absent)
    assert cli.main(["lame"]) == 2
    assert "saras lame: needs matplotlib; install it with: pip install 'saras[plot]'" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["--platform", "10.1.2.3:48010"], "platform = 10.1.2.3:48010: must be a loopback address"),
        (["--platform", "nonsense"], "platform = 'nonsense': must be HOST:PORT"),
        (["--duration", "-1"], "duration = -1.0: must be finite and > 0"),
        (["--sides", "left,left"], "sides = 'left,left'"),
        (["--motion", "dance"], "motion = 'dance'"),
        (["--device", "recorded"], "needs a motion file"),
        (["--option", "amplitude_m"], "must be KEY=VALUE"),
        (["--send-rate-hz", "nan"], "send_rate_hz = nan"),
        (["--calibration", "/nowhere.json"], "saras console calibrate"),
    ],
)
def test_bad_arguments_are_named(argv, message, capsys):
    assert cli.main(["console", "--plain", "--listen", "127.0.0.1:0", *argv]) == 2
    assert message in capsys.readouterr().err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_signals_stop_it_cleanly(number, tmp_path):
    with FakePlatform() as platform:
        log = tmp_path / "events.log"
        process = subprocess.Popen([*CONSOLE, "--platform", platform.address, "--log", str(log)], env=os.environ)
        try:
            platform.wait_for(lambda: len(platform.ups) > 20, "datagrams")
            process.send_signal(number)
            assert process.wait(timeout=20) == 0
        finally:
            process.kill()
    text = log.read_text()
    assert f"stopping on {number.name}" in text and "forces at zero" in text


def test_a_run_of_a_given_duration_with_a_recorded_motion(tmp_path):
    rows = [f"{k * 0.03},{0.1 * ((k % 40) - 20) / 20},{0.01 * (k % 7)},0,0,0,0,1" for k in range(600)]
    (tmp_path / "motion.csv").write_text("\n".join(rows))
    with FakePlatform() as platform:
        command = [
            *CONSOLE,
            "--platform",
            platform.address,
            "--device",
            "recorded",
            "--file",
            str(tmp_path / "motion.csv"),
        ]
        done = subprocess.run([*command, "--duration", "2"], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stderr
        assert "left" in done.stdout and "round trip" in done.stdout
        begin, end = platform.ups[0], platform.newest
        assert end.seq - begin.seq == len(platform.ups) - 1  # nothing lost on loopback
        assert platform.refused == 0


def test_a_restarted_console_has_a_larger_session():
    with FakePlatform() as platform:
        for _ in range(2):
            command = [*CONSOLE, "--platform", platform.address, "--duration", "0.2", "--motion", "rest"]
            subprocess.run(command, check=True, capture_output=True, timeout=60)
            time.sleep(0.01)
        sessions = [up.session for up in platform.ups]
        assert sessions == sorted(sessions) and len(set(sessions)) == 2
