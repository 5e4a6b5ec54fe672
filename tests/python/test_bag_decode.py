"""Columns read all at once equal those that rosbags gives message by message."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

from saras.recording import Session, decode


def irregular(*_):
    raise decode.Irregular


def assert_same(path, monkeypatch, fast_topics=()):
    taken = []
    columns = decode.columns

    def counted(rows, store, msgtype):
        result = columns(rows, store, msgtype)
        taken.append(msgtype)
        return result

    with Session.open(path) as fast, Session.open(path) as slow:
        for name in fast.topics:
            monkeypatch.setattr(decode, "columns", counted)
            before = len(taken)
            ours = fast.topic(name)
            assert len(taken) > before or name not in fast_topics, f"{name} was read message by message"
            monkeypatch.setattr(decode, "columns", irregular)
            theirs = slow.topic(name)
            np.testing.assert_array_equal(ours.t, theirs.t)
            np.testing.assert_array_equal(ours.t_received, theirs.t_received)
            assert list(ours.columns) == list(theirs.columns)
            for field, column in theirs.columns.items():
                mine = ours[field]
                assert mine.shape == column.shape and mine.dtype == column.dtype, field
                if column.dtype == object:  # arrays, lists of texts, lists of messages
                    assert list(map(repr, mine)) == list(map(repr, column))
                else:
                    np.testing.assert_array_equal(mine, column)


def test_a_session_reads_the_same_both_ways(tmp_path, monkeypatch):
    path = synthetic.write_session(tmp_path / "s.bag")
    steady = ["/mesa_left/ee_pose", "/tank_master/state", "/system/left/state", "/mesa_left/measured_cf"]
    assert_same(path, monkeypatch, steady)


def test_lengths_that_vary_and_compensate_read_the_same(tmp_path, monkeypatch, many):
    """Texts and arrays of random lengths, also such that two of them change while their sum stays."""
    rng = np.random.default_rng(4)
    for _ in range(3 * many):
        bag = synthetic.BagWriter(tmp_path / "s.bag")
        for k in range(120):
            a, b, c = (int(n) for n in rng.integers(0, 3, 3))
            header = bag.header("/j", k / 100, "frame" + "x" * a)
            name = [f"joint{'y' * (2 - a)}", "z" * b][: 1 + c % 2]
            position = rng.normal(size=len(name) + c)
            bag.put(
                "/j",
                "sensor_msgs/msg/JointState",
                k / 100,
                header=header,
                name=name,
                position=position,
                velocity=np.zeros(0),
                effort=rng.normal(size=b),
            )
            bag.text("/text", k / 100, "ä" * a)
        bag.close()
        assert_same(tmp_path / "s.bag", monkeypatch)
        (tmp_path / "s.bag").unlink()


def test_several_publishers_are_merged_in_order(tmp_path, monkeypatch):
    bag = synthetic.BagWriter(tmp_path / "s.bag")
    for k in range(100):
        for node in ("/one", "/two"):
            connection = bag.connections.get(node) or bag.writer.add_connection(
                "/d", "geometry_msgs/msg/PoseStamped", typestore=bag.store, callerid=node
            )
            bag.connections[node] = bag.connections["/d"] = connection
            bag.pose("/d", k / 100, (k, node == "/one", 0), "base" + node)
    bag.close()
    assert_same(tmp_path / "s.bag", monkeypatch)
