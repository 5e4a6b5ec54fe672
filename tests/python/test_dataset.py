"""saras dataset: a session with known numbers comes out aligned, and what is not known is not there."""

from __future__ import annotations

import json

import numpy as np
import pytest

pytest.importorskip("rosbags")
pytest.importorskip("pyarrow")
pandas = pytest.importorskip("pandas")

import synthetic_session as synthetic
from scipy.spatial.transform import Rotation

import saras
from saras import cli
from saras.dataset import Execution, Options, export, make_table, nominal, validate
from saras.dataset.export import session_names
from saras.recording import Session


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return synthetic.write_session(tmp_path_factory.mktemp("bag") / "one.bag")


def table_of(path, **options):
    with Session.open(path) as session:
        table = make_table(session, Options(**options))
    return table, pandas.DataFrame(table.columns)


def test_positions_are_those_of_the_known_path(bag):
    _, table = table_of(bag, rate_hz=37.0)
    # The session begins with the first reception, half a millisecond after stamp 0.
    t = table["t_s"] + 0.0005
    known = table["mesa_left_tip_valid"]
    assert known.mean() > 0.99
    expected = [0.3, 0, -0.1] + 0.5 * synthetic.handle_position(t - synthetic.LAG_S)
    columns = [f"mesa_left_tip_{axis}_m" for axis in "xyz"]
    # Between samples 10 ms apart the path bends by (2 pi 1.0 Hz)^2 x 5 mm x (5 ms)^2 / 2.
    np.testing.assert_allclose(table[columns][known], expected[known], atol=3e-6)
    assert (table["time_unix_ns"].diff()[1:] > 0).all()
    assert table["time_unix_ns"][0] == synthetic.START_NS + 500_000


def test_states_hold_and_tell_their_age(bag):
    _, table = table_of(bag, rate_hz=50.0)
    t = table["t_s"] + 0.0005
    state = table["mesa_left_state"].where(table["mesa_left_state_valid"])
    assert set(state[(t > 9.02) & (t < 9.98)]) == {"HOLD"}
    assert set(state[(t > 2) & (t < 8.98)]) == {"ENGAGED"}
    assert table["mesa_left_state_age_s"].max() <= 0.0101
    assert set(table["mesa_left_state_clutch"][(t > 6.02) & (t < 6.98)]) == {1.0}


def test_nothing_reaches_across_a_gap_or_from_a_wrong_clock(tmp_path):
    bag = synthetic.BagWriter(tmp_path / "s.bag")
    for k in range(500):
        t = k / 100
        if not 1.0 <= t < 2.0:
            bag.pose("/mesa_left/ee_pose", t, (t, 0, 0), "mesa_left/sbs_world")
        bag.text("/saras/session", t, "{}")
        if 4.0 <= t < 4.5:
            bag.pose("/mesa_left/ee_pose", t + 3600.0, (9, 9, 9), "mesa_left/sbs_world")
            _, connection, data = bag.pending.pop()
            bag.pending.append((synthetic.START_NS + round((t + 0.0005) * 1e9), connection, data))
    bag.close()
    made, table = table_of(tmp_path / "s.bag", rate_hz=200.0)
    t = table["t_s"] + 0.0005
    x = table["mesa_left_tip_x_m"]
    assert x[(t > 0.9905) & (t < 2.0)].isna().all()
    assert not table["mesa_left_tip_valid"][(t > 0.9905) & (t < 2.0)].any()
    np.testing.assert_allclose(x.dropna(), t[x.notna()], atol=1e-6)
    (source,) = made.sources
    assert (source.gaps, source.dropped) == (1, 50)
    assert any("50 of" in note for note in made.notes)
    assert "mesa_right_tip" in made.absent


def test_rows_are_frames_when_there_are_frames(tmp_path):
    bag = synthetic.BagWriter(tmp_path / "s.bag")
    rng = np.random.default_rng(0)
    stamps = np.sort(rng.uniform(0.1, 1.9, 45)).round(6)
    for k in range(200):
        bag.pose("/mesa_left/ee_pose", k / 100, (k / 100, 0, 0), "mesa_left/sbs_world")
    for stamp in stamps:
        header = bag.header("/endoscope/left/image_raw/compressed", stamp)
        fields = {"header": header, "format": "jpeg", "data": np.zeros(10, dtype=np.uint8)}
        bag.put("/endoscope/left/image_raw/compressed", "sensor_msgs/msg/CompressedImage", stamp, **fields)
    bag.close()
    made, table = table_of(tmp_path / "s.bag")
    assert made.rows == "a message of /endoscope/left/image_raw/compressed"
    np.testing.assert_allclose(table["mesa_left_tip_x_m"], stamps, atol=1e-6)
    np.testing.assert_array_equal(table["frame"], np.arange(45))
    # The same by the index of a video beside the bag, in whole nanoseconds or in seconds.
    for head, cells in (
        ("frame,stamp_ns", [f"{k},{synthetic.START_NS + round(s * 1e9)}" for k, s in enumerate(stamps)]),
        ("stamp_s", [f"{synthetic.START_NS // 10**9}.{round(s * 1e9):09d}" for s in stamps if s < 1.0]),
    ):
        (tmp_path / "index.csv").write_text("\n".join([head, *cells]))
        _, again = table_of(tmp_path / "s.bag", frame_index=str(tmp_path / "index.csv"))
        np.testing.assert_allclose(again["mesa_left_tip_x_m"], stamps[: len(cells)], atol=1e-6)
    (tmp_path / "index.csv").write_text("a,b\n1,2\n")
    with pytest.raises(saras.Error, match="no index of frames"):
        table_of(tmp_path / "s.bag", frame_index=str(tmp_path / "index.csv"))
    with pytest.raises(saras.Error, match="/none was not recorded"):
        table_of(tmp_path / "s.bag", frames="/none")


def test_rows_are_frames_of_the_video_beside_the_bag(tmp_path):
    bag = synthetic.BagWriter(tmp_path / "s.bag")
    for k in range(200):
        bag.pose("/mesa_left/ee_pose", k / 100, (k / 100, 0, 0), "mesa_left/sbs_world")
    for k in range(20):
        for side, offset in (("left", 0), ("right", 3)):
            if (side, k) != ("right", 7):  # a picture of one eye was lost
                topic, t = f"/recorder/video/{side}", 0.1 + k / 15
                file = f"s_{side}.mkv"
                header = bag.header(topic, t)
                bag.put(topic, "saras_ros1/msg/VideoFrame", t, header=header, frame=k + offset, file=file)
    bag.close()
    (tmp_path / "s_left.mkv").write_bytes(b"video")
    made, table = table_of(tmp_path / "s.bag")
    assert made.rows == "a frame of the left video"
    np.testing.assert_array_equal(table["frame"], np.arange(20))
    right = np.arange(20) + 3.0
    right[7] = np.nan
    np.testing.assert_array_equal(table["frame_right"], right)
    np.testing.assert_allclose(table["mesa_left_tip_x_m"], 0.1 + np.arange(20) / 15, atol=1e-6)
    card = export([tmp_path / "s.bag"], tmp_path / "set", videos=True)
    assert card["sessions"][0]["videos"] == ["s_left.mkv"]
    assert (tmp_path / "set" / "videos" / "s" / "s_left.mkv").read_bytes() == b"video"


def test_annotations_become_columns(tmp_path):
    bag = synthetic.BagWriter(tmp_path / "s.bag")
    for k in range(100):
        bag.pose("/mesa_left/ee_pose", k / 10, (0, 0, 0), "mesa_left/sbs_world")
    for t, text in (
        (1.0, {"kind": "action", "label": "grasp"}),
        (3.0, {"kind": "action", "label": "pull"}),
        (5.0, {"kind": "action", "label": "end"}),
        (2.03, {"kind": "misunderstanding", "label": "which clip?"}),
        # As the recorder writes them: the time that counts is that of the mark.
        (7.0, {"kind": "note", "label": "smoke", "text": "much", "stamp_ns": synthetic.START_NS + 2_040_000_000}),
    ):
        bag.text("/recorder/annotations", t, json.dumps(text))
    bag.text("/recorder/annotations", 6.0, "not json")
    bag.close()
    made, table = table_of(tmp_path / "s.bag", rate_hz=10.0)
    t = table["t_s"] + 0.0005
    action = table["annotation_action"]
    assert set(action[(t > 1.01) & (t < 2.99)]) == {"grasp"} and set(action[(t > 3.01) & (t < 4.99)]) == {"pull"}
    assert action[(t < 0.99) | (t > 5.01)].isna().all()
    assert table["annotation_note"].dropna().to_dict() == {21: "which clip?; smoke: much"}
    assert list(np.flatnonzero(table["annotation_misunderstanding"])) == [21]
    assert any("no JSON" in note for note in made.notes)


def test_speech_becomes_a_column_on_the_sounds_own_time(tmp_path):
    """The sound begins 1 s after the session, its card is 1 % slow; the transcript counts from the sound's begin."""
    bag = synthetic.BagWriter(tmp_path / "s.bag")
    for k in range(400):
        bag.pose("/mesa_left/ee_pose", k / 20, (0, 0, 0), "mesa_left/sbs_world")
    for t, label in ((0.5, "grasp"), (8.0, "clip"), (16.0, "end")):
        bag.text("/recorder/annotations", t, json.dumps({"kind": "action", "label": label}))
    bag.close()
    start_ns = synthetic.START_NS + 500_000  # of the first message
    (tmp_path / "s_audio.flac").write_bytes(b"fLaC\0\0\0\x22" + bytes(10) + (16000 << 4).to_bytes(3, "big") + bytes(21))
    index = [f"{1600 * k},{start_ns + 10**9 + k * 101_000_000}\n" for k in range(160)]
    (tmp_path / "s_audio.samples.csv").write_text("sample,stamp_ns\n" + "".join(index))
    said = [
        (2.0, 3.0, "grasp it"),
        (5.0, 6.0, "It's there"),
        (9.0, 10.0, "clip"),
        (9.5, 10.5, "clip now"),
        (17.0, 18.0, "x"),
    ]
    rows = "".join(f"{a},{b},{text}\n" for a, b, text in said)
    (tmp_path / "s_audio.csv").write_text("start_s,end_s,text\n" + rows)
    made, table = table_of(tmp_path / "s.bag", rate_hz=50.0)
    t = table["t_s"].to_numpy()
    np.testing.assert_array_equal(table["speech_valid"], (t >= 1.0) & (t <= 1.0 + 0.101 * 159))
    both = (t >= 1.0 + 9.5 * 1.01 + 1e-6) & (t < 1.0 + 10.0 * 1.01 - 1e-6)
    assert set(table["speech_text"][both]) == {"clip; clip now"}
    one = table["speech_text"] == "grasp it"
    assert t[one].min() == pytest.approx(1.0 + 2.0 * 1.01, abs=0.02)
    assert t[one].max() == pytest.approx(1.0 + 3.0 * 1.01, abs=0.02)
    assert any("before or after the sound" in note for note in made.notes)
    card = export([tmp_path / "s.bag"], tmp_path / "set", Options(rate_hz=50.0), videos=True)
    assert card["sessions"][0]["speech"] == {"transcript": "s_audio.csv", "utterances": 5}
    assert (tmp_path / "set" / "videos" / "s" / "s_audio.csv").exists()
    words = pandas.read_parquet(tmp_path / "set" / "speech_by_action.parquet").set_index(["action", "word"])
    assert words["count"].to_dict() == {
        ("clip", "clip"): 2, ("clip", "now"): 1, ("grasp", "grasp"): 1, ("grasp", "it"): 1, ("grasp", "it's"): 1,
        ("grasp", "there"): 1,
    }  # fmt: skip
    # Sound from 1.0 to 17.06 s: grasp until 8 s, clip until 16 s.
    assert words.loc[("grasp", "it"), "seconds"] == pytest.approx(7.0, abs=0.05)
    assert words.loc[("clip", "clip"), "per_minute"] == pytest.approx(60.0 * 2 / 8.0, rel=0.01)
    assert words.loc[("clip", "clip"), "lift"] == pytest.approx(16.06 / 8.0, rel=0.01)
    (tmp_path / "s_audio.flac").write_bytes(b"RIFF" + bytes(40))
    with pytest.raises(saras.Error, match="no FLAC"):
        table_of(tmp_path / "s.bag", rate_hz=50.0)


def test_the_set_loads_in_pandas_with_card_units_and_frames(bag, tmp_path, capsys):
    assert cli.main(["dataset", str(bag), "--out", str(tmp_path / "set"), "--rate-hz", "25"]) == 0
    assert "sessions/one.parquet: 300 rows" in capsys.readouterr().out
    table = pandas.read_parquet(tmp_path / "set" / "sessions" / "one.parquet")
    assert len(table) == 300 and table["mesa_left_tip_x_m"].notna().mean() > 0.99
    card = json.loads((tmp_path / "set" / "card.json").read_text())
    columns = {column["name"]: column for column in card["sessions"][0]["columns"]}
    assert set(columns) == set(table.columns)
    tip = columns["mesa_left_tip_x_m"]
    assert (tip["unit"], tip["frame"], tip["method"]) == ("m", "mesa_left/sbs_world", "linear")
    readme = (tmp_path / "set" / "README.md").read_text()
    assert "Licence" in readme and "mesa_left_tip_x_m" in readme and "PSM1_tip" in readme
    import pyarrow.parquet as pq

    field = pq.read_schema(tmp_path / "set" / "sessions" / "one.parquet").field("mesa_left_tip_x_m")
    assert field.metadata[b"frame"] == b"mesa_left/sbs_world"
    # A second one does not mix with the first.
    assert cli.main(["dataset", str(bag), "--out", str(tmp_path / "set")]) == 2
    assert "not empty" in capsys.readouterr().err


def test_processes_give_the_same_as_one(bag, tmp_path):
    pytest.importorskip("dask")
    other = synthetic.write_session(tmp_path / "two.bag", duration_s=3.0)
    for workers in (1, 2):
        export([bag, other], tmp_path / f"set{workers}", workers=workers)
    for name in ("sessions/one.parquet", "sessions/two.parquet", "nominal.parquet"):
        a, b = (pandas.read_parquet(tmp_path / f"set{workers}" / name) for workers in (1, 2))
        pandas.testing.assert_frame_equal(a, b)


def test_a_dask_cluster_gives_the_same(bag, tmp_path):
    distributed = pytest.importorskip("distributed")
    other = synthetic.write_session(tmp_path / "two.bag", duration_s=3.0)
    export([bag, other], tmp_path / "here")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None, host="127.0.0.1", protocol="tcp"
    ) as cluster:
        export([bag, other], tmp_path / "there", scheduler=cluster.scheduler_address)
    for name in ("sessions/one.parquet", "sessions/two.parquet", "nominal.parquet"):
        a, b = (pandas.read_parquet(tmp_path / where / name) for where in ("here", "there"))
        pandas.testing.assert_frame_equal(a, b)


def test_refused_bags_leave_nothing(bag, tmp_path):
    (tmp_path / "cut.bag").write_bytes(bag.read_bytes()[:50_000])
    with pytest.raises(saras.Error, match=r"cut\.bag"):
        export([bag, tmp_path / "cut.bag"], tmp_path / "set")
    with pytest.raises(saras.ConfigError, match="rate_hz"):
        Options(rate_hz=0.0)
    with pytest.raises(saras.ConfigError, match="only one"):
        Options(rate_hz=5.0, frames="/a")
    assert not [path for path in tmp_path.iterdir() if path.name.startswith("set")]


def test_sessions_of_one_name_are_numbered(tmp_path):
    bags = ["a/x.bag", "b/x.bag", "d1/session.bag", "d1/y.bag", "d2/session.repaired.bag"]
    assert session_names(bags) == ["x", "x_2", "d1", "y", "d2"]


def test_validation_gives_workspace_accuracy_and_velocity(bag):
    with Session.open(bag) as session:
        arm = validate(session)["mesa_left"]
    np.testing.assert_allclose(arm["workspace_m"]["size"], [0.03, 0.03, 0.01], atol=1e-4)
    # The tip follows its set-point 30 ms later; speeds are those of the curve.
    t = np.linspace(0, 12, 5000)
    curve = 0.5 * synthetic.handle_position(t)
    speed = np.linalg.norm(np.gradient(curve, t, axis=0), axis=1)
    assert arm["speed_m_per_s"]["max"] == pytest.approx(speed.max(), rel=0.01)
    lag = np.linalg.norm(0.5 * (synthetic.handle_position(t) - synthetic.handle_position(t - 0.03)), axis=1)
    assert arm["accuracy_m"]["rms"] == pytest.approx(np.sqrt(np.mean(lag**2)), rel=0.02)
    assert arm["accuracy_rad"]["max"] < 1e-6


def execution(rng, duration_s, noise_m, warp=1.0, turn=0.0):
    phase = np.linspace(0, 1, 200) ** warp
    position = np.stack([np.cos(3 * phase), np.sin(3 * phase), phase], axis=1) + rng.normal(0, noise_m, 3)
    rotation = Rotation.from_rotvec(np.stack([0 * phase, 0 * phase, phase + turn], axis=1)).as_quat()
    return Execution("PSM1", "suture", np.linspace(0, duration_s, 200), position, rotation)


def test_the_nominal_trajectory_is_the_mean_with_its_spread(many):
    rng = np.random.default_rng(6)
    found = [execution(rng, d, 0.01, turn=rng.normal(0, 0.05)) for d in rng.uniform(5, 20, 200 * many)]
    (one,) = nominal(found)
    truth = np.stack([np.cos(3 * one.phase), np.sin(3 * one.phase), one.phase], axis=1)
    np.testing.assert_allclose(one.position, truth, atol=0.004)
    np.testing.assert_allclose(one.position_std, 0.01, rtol=0.25)
    np.testing.assert_allclose(one.rotation_std, 0.05, rtol=0.25)
    angle = Rotation.from_quat(one.quaternion).as_rotvec()[:, 2]
    np.testing.assert_allclose(angle, one.phase, atol=0.02)
    assert one.executions == len(found)


def test_a_gap_of_one_execution_is_filled_by_nobody():
    rng = np.random.default_rng(8)
    whole, holed = execution(rng, 10.0, 0.0), execution(rng, 10.0, 0.0)
    rows = np.r_[0:80, 120:200]
    holed = Execution("PSM1", "suture", holed.t[rows], holed.position[rows], holed.quaternion[rows])
    (both,) = nominal([whole, holed])
    inside = (both.phase > 0.41) & (both.phase < 0.59)
    assert set(both.known[inside]) == {1} and set(both.known[~inside & (abs(both.phase - 0.5) > 0.11)]) == {2}
    assert np.isnan(both.position_std[inside]).all() and np.isfinite(both.position[inside]).all()
    (alone,) = nominal([holed])
    assert np.isnan(alone.position[inside]).all() and np.isnan(alone.quaternion[inside]).all()


def test_phase_by_path_does_not_care_about_speed():
    rng = np.random.default_rng(7)
    found = [execution(rng, 10.0, 0.0, warp) for warp in (1.0, 2.0, 3.0)]
    (by_path,), (by_time,) = nominal(found, "path"), nominal(found, "time")
    assert by_path.position_std.max() < 1e-3 < 0.1 < by_time.position_std.max()
    (alone,) = nominal(found[:1])
    assert np.isnan(alone.position_std).all() and np.isnan(alone.rotation_std).all()
    with pytest.raises(saras.ConfigError, match="phase"):
        nominal(found, "dtw")


def calibrated(path, offset_m=0.0):
    """A session that says on /tf_static where mesa_left stands."""
    from rosbags.typesys import get_types_from_msg

    bag = synthetic.BagWriter(path)
    bag.store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
    make = bag.make
    zero = {"x": 0.0, "y": 0.0, "z": 0.0}
    transform = make(
        "geometry_msgs/msg/Transform",
        translation=make("geometry_msgs/msg/Vector3", **{**zero, "x": 0.5 + offset_m}),
        rotation=make("geometry_msgs/msg/Quaternion", **zero, w=1.0),
    )
    stamped = make(
        "geometry_msgs/msg/TransformStamped",
        header=bag.header("/tf_static", 0.0, "world"),
        child_frame_id="mesa_left/sbs_world",
        transform=transform,
    )
    bag.put("/tf_static", "tf2_msgs/msg/TFMessage", 0.0, transforms=[stamped])
    for k in range(100):
        bag.pose("/mesa_left/ee_pose", k / 100, (0, 0, 0), "mesa_left/sbs_world")
    bag.close()
    return path


def test_a_calibration_goes_along_and_a_wrong_one_is_refused(tmp_path):
    from datetime import datetime, timedelta, timezone

    from saras.calibration.calibration_file import BaseFrame, Calibration

    base = np.eye(4)
    base[0, 3] = 0.5
    frame = BaseFrame("world", base, 1e-4, 1e-4, 1e-4, 9, "dots")
    when = datetime.fromtimestamp(synthetic.START_NS * 1e-9, tz=timezone.utc)
    file = tmp_path / "calibration.yaml"
    Calibration("abc", when - timedelta(hours=1), {"mesa_left/sbs_world": frame}).save(file)
    good = calibrated(tmp_path / "good.bag")
    card = export([good], tmp_path / "set", calibration=[file])
    assert (tmp_path / "set" / "calibration" / "calibration.yaml").read_bytes() == file.read_bytes()
    assert card["sessions"][0]["notes"] == []
    with pytest.raises(saras.Error, match=r"differs .* by 50\.0 mm"):
        export([calibrated(tmp_path / "moved.bag", 0.05)], tmp_path / "other", calibration=[file])
    Calibration("abc", when + timedelta(hours=1), {"mesa_left/sbs_world": frame}).save(file, force=True)
    with pytest.raises(saras.Error, match="future"):
        export([good], tmp_path / "other", calibration=[file])
    file.write_text(file.read_text().replace("rms_m", "rms_mm"))
    with pytest.raises(saras.Error, match="calibration"):
        export([good], tmp_path / "other", calibration=[file])
