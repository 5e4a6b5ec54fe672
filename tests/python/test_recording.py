"""saras.recording: a bag with known numbers, and bags that cannot be read."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

import saras
from saras.recording import Session


@pytest.fixture(scope="module")
def session(tmp_path_factory):
    path = synthetic.write_session(tmp_path_factory.mktemp("bag") / "session.bag")
    with Session.open(path) as opened:
        yield opened


def test_session_facts(session):
    assert session.duration_s == pytest.approx(11.99, abs=1e-6)
    assert session.start.year == 2023
    assert session.info["seed"] == 7
    assert session.topics["/mesa_left/ee_pose"] == 1200


def test_pose_series_has_stamp_reception_frame_and_matrices(session):
    pose = session.arm("mesa_left").ee_pose
    assert pose.pose.shape == (1200, 4, 4)
    assert pose.frame == "mesa_left/sbs_world"
    # The session starts with the first reception, half a millisecond after the first stamp.
    np.testing.assert_allclose(pose.t, np.arange(1200) / 100 - 0.0005, atol=1e-8)
    np.testing.assert_allclose(pose.t_received - pose.t, 0.0005, atol=1e-8)
    expected = [0.3, 0, -0.1] + 0.5 * synthetic.handle_position(np.arange(1200) / 100 - synthetic.LAG_S)
    np.testing.assert_allclose(pose.position, expected, atol=1e-12)
    np.testing.assert_array_equal(pose.pose[:, :3, :3], np.broadcast_to(np.eye(3), (1200, 3, 3)))


def test_wrenches_and_twists_are_linear_first(session):
    wrench = session.arm("mesa_right").measured_cf
    assert wrench.value.shape == (1200, 6)
    assert np.all(wrench.value[:, [0, 1, 3, 4, 5]] == 0)
    assert wrench.value[:, 2].max() == pytest.approx(2.0, abs=1e-3)
    assert session.console("left").desired_twist.value.shape == (1200, 6)


def test_tank_columns(session):
    tank = session.tank("tank_master")
    assert tank["damping"].shape == (1200, 6)
    assert tank["status"][0] == "OK"
    np.testing.assert_array_equal(tank.seq, np.arange(1200))
    with pytest.raises(saras.Error, match="energy_J"):
        tank["no_such_field"]


def test_not_recorded_is_none_not_zero(session):
    assert session.topic("/nothing") is None
    assert session.arm("mesa_left").truth is None
    assert session.console("left").wrench is None
    assert session.tank("tank_other") is None


def test_events_tell_state_changes_and_clutch(session):
    texts = [(round(event.t, 1), event.source, event.text) for event in session.events]
    assert (9.0, "left side", "HOLD: console: no datagram for 61 ms") in texts
    assert (10.0, "left side", "ENGAGED") in texts
    assert (6.0, "right side", "clutch pressed") in texts
    assert not any("HOLD" in text for _, source, text in texts if source == "right side")


def test_quaternion_off_the_unit_sphere_is_nan():
    from saras.recording.series import rotation_matrices

    one = np.ones(1)
    assert np.isnan(rotation_matrices(0 * one, 0 * one, 0 * one, 1.1 * one)).all()
    np.testing.assert_allclose(rotation_matrices(one, 0 * one, 0 * one, 0 * one)[0], np.diag([1, -1, -1]))


def test_missing_foreign_empty_and_truncated_bags_are_refused(tmp_path):
    with pytest.raises(saras.Error, match="no such file"):
        Session.open(tmp_path / "none.bag")
    foreign = tmp_path / "foreign.bag"
    foreign.write_bytes(b"PK\x03\x04" + bytes(1000))
    with pytest.raises(saras.Error, match="not a ROS 1 bag"):
        Session.open(foreign)
    (tmp_path / "empty.bag").write_bytes(b"")
    with pytest.raises(saras.Error, match="empty"):
        Session.open(tmp_path / "empty.bag")
    whole = synthetic.write_session(tmp_path / "whole.bag", duration_s=0.5).read_bytes()
    for size in range(20, len(whole), len(whole) // 23):
        (tmp_path / "cut.bag").write_bytes(whole[:size])
        with pytest.raises(saras.Error, match=r"cut\.bag"):
            Session.open(tmp_path / "cut.bag")


def test_unindexed_bag_names_the_cure(tmp_path):
    data = bytearray(synthetic.write_session(tmp_path / "a.bag", duration_s=0.2).read_bytes())
    at = data.index(b"index_pos=") + len(b"index_pos=")
    data[at : at + 8] = bytes(8)
    (tmp_path / "b.bag").write_bytes(data)
    with pytest.raises(saras.Error, match="saras bag repair"):
        Session.open(tmp_path / "b.bag")


def test_flipped_bytes_never_end_in_a_foreign_exception(tmp_path, many):
    whole = synthetic.write_session(tmp_path / "whole.bag", duration_s=0.2).read_bytes()
    rng = np.random.default_rng(3)
    for _ in range(30 * many):
        data = bytearray(whole)
        for at in rng.integers(0, len(data), 20):
            data[at] = rng.integers(0, 256)
        (tmp_path / "flipped.bag").write_bytes(data)
        try:
            with Session.open(tmp_path / "flipped.bag") as session:
                for name in session.topics:
                    session.topic(name)
        except saras.Error:
            pass
