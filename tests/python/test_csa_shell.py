"""The arrays of `saras csa shell` by themselves; over the wire: tests/ros/csa_shell.test."""

from __future__ import annotations

import builtins
import importlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from saras import ConfigError, cli
from saras.csa import shell
from saras.csa.live_arrays import ARRAYS, PARTS, LiveArrays


def without(monkeypatch, module, missing):
    """Importing the module by its name fails, as missing is not installed."""
    real = importlib.import_module

    def absent(name, *more):
        if name == module:
            raise ModuleNotFoundError(f"No module named '{missing}'", name=missing)
        return real(name, *more)

    monkeypatch.setattr(shell.importlib, "import_module", absent)


@given(
    capacity=st.integers(1, 7),
    arriving=st.lists(st.tuples(st.integers(0, 30), st.sampled_from(PARTS)), max_size=90),
)
def test_samples_are_the_newest_whole_triples_and_what_was_seen_stays(capacity, arriving):
    live, parts, expected, seen = LiveArrays(capacity), {}, [], []
    for i, (stamp, part) in enumerate(arriving):
        value = np.array([stamp, i, PARTS.index(part)], dtype=float)
        live.sample(stamp * 10**9, part, value)
        parts.setdefault(stamp, {})[part] = value
        if len(parts[stamp]) == len(PARTS):
            expected.append(np.concatenate([[stamp], *(parts[stamp][name] for name in PARTS)]))
            del parts[stamp]
        rows = np.array(expected[-capacity:]).reshape(-1, 10)
        np.testing.assert_allclose(live.names["samples"], rows)
        np.testing.assert_array_equal(live.names[part], value)
        seen.append((live.names["samples"], rows))
    for kept, rows in seen:
        np.testing.assert_allclose(kept, rows)


def test_before_anything_came_nothing_looks_known():
    live = LiveArrays()
    assert not live.any_came and all(np.isinf(age) for age in live.ages().values())
    for name in ARRAYS:
        value = live.names[name]
        assert value == "" if name == "state" else np.isnan(value).all() or value.size == 0
    assert live.table().count("never came") == len(ARRAYS)


def test_arrays_cannot_be_written_and_the_table_says_what_is_known():
    live = LiveArrays()
    live.came("stiffness", np.array([200.0, np.nan, 900.0]))
    live.came("state", "FULL_CONTACT")
    with pytest.raises(ValueError, match="read-only"):
        live.names["stiffness"][0] = 1.0
    lines = {line.split()[0]: line for line in live.table().splitlines()}
    assert "200 to 900, 2 known" in lines["stiffness"] and "never" not in lines["stiffness"]
    assert "FULL_CONTACT" in lines["state"]
    assert 0.0 <= live.ages()["stiffness"] < np.inf


def test_fellows_that_never_come_are_forgotten():
    live = LiveArrays()
    for stamp in range(1000):
        live.sample(stamp, "tip", np.zeros(3))
    assert len(live._pending) <= 100 and len(live.names["samples"]) == 0


def test_bad_numbers_and_no_ros_are_named(monkeypatch, capsys):
    with pytest.raises(ConfigError, match="samples = 0"):
        LiveArrays(0)
    assert cli.main(["csa", "shell", "--once", "--wait", "0"]) == 2
    assert "--wait = 0.0" in capsys.readouterr().err

    without(monkeypatch, "saras_ros1.csa_topics", "rospy")
    assert cli.main(["csa", "shell", "--once"]) == 2
    assert "shell needs ROS 1 and this package's messages (rospy is missing)" in capsys.readouterr().err


def test_no_master_is_named(monkeypatch, capsys):
    pytest.importorskip("rospy")
    pytest.importorskip("saras_ros1.msg")
    monkeypatch.setenv("ROS_MASTER_URI", "http://127.0.0.1:9")
    assert cli.main(["csa", "shell", "--once"]) == 2
    assert "no ROS master at http://127.0.0.1:9" in capsys.readouterr().err


def test_the_prompt_reads_newest_values(monkeypatch, capsys):
    live = LiveArrays()
    lines = iter(["print(tip[0])", "from_here = 2 * tip", "print(from_here[0])"])

    def typed(prompt=""):
        try:
            line = next(lines)
        except StopIteration:
            raise EOFError from None
        live.came("tip", live.names["tip"] + 1.0 if live.any_came else np.array([7.0, 0.0, 0.0]))
        return line

    monkeypatch.setattr(builtins, "input", typed)
    without(monkeypatch, "IPython", "IPython")
    shell.prompt(live)
    assert capsys.readouterr().out.split() == ["7.0", "16.0"]
