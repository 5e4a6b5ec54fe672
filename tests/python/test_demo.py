"""script/demo without ROS: its arguments, its ports, and that no process outlives it."""

from __future__ import annotations

import os
import signal
import sys
import time

import pytest

demo = pytest.importorskip("saras_ros1.demo")
from saras_ros1.processes import Child, descendants, free_ports


def alive(pid: int) -> bool:
    try:
        with open(f"/proc/{pid}/stat") as stat:  # noqa: PTH123
            return stat.read().rsplit(")", 1)[1].split()[0] != "Z"
    except FileNotFoundError:
        return False


def wait_until(condition, timeout_s=10.0):
    end = time.monotonic() + timeout_s
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


# A parent that ignores SIGINT, with a child in a session of its own, as roslaunch starts nodes.
STUBBORN = """
import signal, subprocess, sys, time
signal.signal(signal.SIGINT, signal.SIG_IGN)
deaf = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); time.sleep(60)"
child = subprocess.Popen([sys.executable, "-c", deaf], start_new_session=True)
print(child.pid, flush=True)
time.sleep(60)
"""


def test_stop_leaves_no_grandchild_behind(tmp_path):
    child = Child("stubborn", [sys.executable, "-c", STUBBORN], tmp_path / "log.txt")
    wait_until(lambda: child.tail().strip().isdigit())
    grandchild = int(child.tail())
    time.sleep(0.3)
    assert grandchild in descendants(os.getpid())
    child.stop(patience_s=0.2)
    assert not alive(grandchild)
    assert child.exit_code is not None


def test_stop_is_gentle_first(tmp_path):
    child = Child(
        "polite", [sys.executable, "-c", "print('up', flush=True); import time; time.sleep(60)"], tmp_path / "log.txt"
    )
    wait_until(lambda: "up" in child.tail())
    assert child.stop() in (-signal.SIGINT, 1, 130)
    assert "KeyboardInterrupt" in child.tail(50)


def test_free_ports_differ():
    tcp, udp = free_ports(tcp=5, udp=5)
    assert len(set(tcp)) == len(set(udp)) == 5


def test_arguments(tmp_path, capsys):
    given = demo.parse(["--headless", "--duration", "5", "--out", str(tmp_path), "--operator", "weak"])
    assert (given.headless, given.duration, given.out, given.operator) == (True, 5.0, tmp_path, "weak")
    assert demo.parse([]).out.parent.name == "out"
    for wrong in (["--duration", "0"], ["--duration", "-1"], ["--operator", "strong"], ["nothing_such"]):
        with pytest.raises(SystemExit) as refusal:
            demo.parse(wrong)
        assert refusal.value.code == 2
    assert "--operator" in capsys.readouterr().err


def test_motion_files_become_absolute(tmp_path, monkeypatch):
    (tmp_path / "motion.csv").write_text("")
    monkeypatch.chdir(tmp_path)
    assert demo.parse(["--motion", "motion.csv"]).motion == str(tmp_path / "motion.csv")
    assert demo.parse(["--motion", "circle"]).motion == "circle"


def test_launch_arguments_are_those_that_the_file_declares(tmp_path, monkeypatch):
    launch = tmp_path / "some.launch"
    launch.write_text('<launch><arg name="record"/><arg name="operator"/><arg name="bag"/><arg name="rviz"/></launch>')
    monkeypatch.setattr(demo, "LAUNCH_FILE", launch)
    given = demo.launch_arguments(demo.parse(["--headless"]), tmp_path)
    assert given == {"record": "true", "operator": "normal", "rviz": "false", "bag": str(tmp_path / "session.bag")}
    with pytest.raises(demo.DemoError, match="motion"):
        demo.launch_arguments(demo.parse(["--motion", "circle"]), tmp_path)


def test_an_out_directory_with_a_recording_is_refused(tmp_path, monkeypatch):
    (tmp_path / "old.bag").write_bytes(b"")
    monkeypatch.setattr(demo.shutil, "which", lambda name: name)
    assert demo.main(["--out", str(tmp_path)]) == 2


def test_other_demos_have_command_lines_of_their_own(tmp_path, capsys):
    csa_demo = pytest.importorskip("saras_ros1.csa_demo")
    given = csa_demo.parse(["--headless", "--duration", "50", "--out", str(tmp_path)])
    assert (given.headless, given.duration, given.out) == (True, 50.0, tmp_path)
    for wrong in (["--duration", "5"], ["--operator", "weak"]):
        with pytest.raises(SystemExit) as refusal:
            demo.main(["csa", *wrong])
        assert refusal.value.code == 2
    assert "must be in [40, 3600]" in capsys.readouterr().err
