"""saras bag: what is in a bag, whether it is complete, and what a cut one still gives. Oracle: Debian's rosbag."""

from __future__ import annotations

import json
import struct

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

import saras
from saras import cli
from saras.recording import Session
from saras.recording.completeness import Bounds, check, expected_topics, lost_by_sequence
from saras.recording.repair import default_out, repair
from saras.recording.survey import survey


def write(path, compression="none", chunk_bytes=4000, n=300):
    """A bag by Debian's writer, as its recorder leaves it; every message is listed: (topic, time, bytes)."""
    rosbag = pytest.importorskip("rosbag")
    import genpy
    from geometry_msgs.msg import PoseStamped
    from std_msgs.msg import String

    listed = []
    with rosbag.Bag(str(path), "w", compression=compression, chunk_threshold=chunk_bytes) as bag:
        for k in range(n):
            time = genpy.Time(1_700_000_000 + k // 100, (k % 100) * 10_000_000)
            pose = PoseStamped()
            pose.header.seq, pose.header.stamp, pose.header.frame_id = k, time, "base"
            pose.pose.position.x = 0.001 * k
            pose.pose.orientation.w = 1.0
            bag.write("/pose", pose, time)
            listed.append(("/pose", time.to_nsec()))
            if k % 10 == 0:
                bag.write("/text", String("x" * (k % 37)), time)
                listed.append(("/text", time.to_nsec()))
    return listed


def by_rosbag(path, reindex=False):
    """(topic, time) of every message, read by Debian's rosbag."""
    rosbag = pytest.importorskip("rosbag")
    with rosbag.Bag(str(path), "a" if reindex else "r", allow_unindexed=reindex) as bag:
        if reindex:
            for _ in bag.reindex():
                pass
    with rosbag.Bag(str(path)) as bag:
        return [(topic, time.to_nsec()) for topic, _, time in bag.read_messages(raw=True)]


def test_info_counts_and_ages_of_a_known_session(tmp_path, capsys):
    path = synthetic.write_session(tmp_path / "s.bag")
    assert cli.main(["bag", "info", str(path), "--json"]) == 0
    facts = json.loads(capsys.readouterr().out)
    assert facts["state"] == "whole"
    assert facts["duration_s"] == pytest.approx(11.99)
    rows = {row["topic"]: row for row in facts["topics"]}
    pose = rows["/mesa_left/ee_pose"]
    assert (pose["messages"], pose["lost"], pose["type"]) == (1200, 0, "geometry_msgs/PoseStamped")
    assert pose["rate_hz"] == pytest.approx(100.0)
    assert [pose["age_ms"][name] for name in ("p50", "p99", "max")] == pytest.approx([0.5] * 3)
    assert rows["/saras/session"]["lost"] is None and rows["/saras/session"]["age_ms"] is None
    assert cli.main(["bag", "info", str(path)]) == 0
    assert "/mesa_left/ee_pose" in capsys.readouterr().out


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_a_bag_by_debians_writer_reads_the_same(tmp_path, compression):
    listed = write(tmp_path / "a.bag", compression)
    found = survey(tmp_path / "a.bag")
    assert found.whole and found.messages == len(listed)
    assert sorted(by_rosbag(tmp_path / "a.bag")) == sorted(listed)


def test_publishers_of_one_topic_are_kept_apart(tmp_path):
    bag = synthetic.BagWriter(tmp_path / "a.bag")
    for k in range(200):
        for node in ("/one", "/two"):
            # Each counts for itself; the second loses every tenth message.
            bag.connections["/d"] = bag.connections.get(node) or bag.writer.add_connection(
                "/d", "geometry_msgs/msg/PoseStamped", typestore=bag.store, callerid=node
            )
            bag.connections[node] = bag.connections["/d"]
            bag.seqs["/d"] = k - 1
            bag.pose("/d", k / 100, (0, 0, 0), "base")
            if node == "/two" and k % 10 == 5:
                bag.pending.pop()
    bag.close()
    found = survey(tmp_path / "a.bag")
    assert {publisher.node: len(publisher) for publisher in found.topics()["/d"]} == {"/one": 200, "/two": 180}
    (lost,) = [row for row in check(found, ["/d"]) if row.what == "lost"]
    assert lost.value == 20 and "/two" in lost.text
    done = repair(tmp_path / "a.bag", tmp_path / "out.bag")
    assert done.lost_by_sequence == 20
    again = survey(tmp_path / "out.bag")
    assert {publisher.node: len(publisher) for publisher in again.publishers} == {"/one": 200, "/two": 180}


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_a_bag_cut_anywhere_gives_all_that_was_whole_before_the_cut(tmp_path, compression, many):
    listed = write(tmp_path / "whole.bag", compression)
    data = (tmp_path / "whole.bag").read_bytes()
    cut, again, out = tmp_path / "cut.bag", tmp_path / "again.bag", tmp_path / "out.bag"
    rng = np.random.default_rng(5)
    for size in rng.integers(4200, len(data), 25 * many):
        cut.write_bytes(data[:size])
        try:
            done = repair(cut, out, force=True)
        except saras.Error as error:
            assert "no readable message" in str(error)
            recovered = []
        else:
            recovered = by_rosbag(out)
            assert len(recovered) == done.messages
            assert survey(out).whole
        # What we recover is a beginning of what was written, and no less than rosbag reindex finds.
        assert sorted(recovered) == sorted(listed[: len(recovered)])
        again.write_bytes(data[:size])
        try:
            reindexed = by_rosbag(again, reindex=True)
        except Exception:  # it refuses some cuts
            reindexed = []
        assert len(recovered) >= len(reindexed)
        if compression == "none":
            # Every message that is in the file with its last byte.
            offset = 0
            for k in range(len(listed)):
                offset = data.find(b"op=\x02", offset + 1)
                length_at = record_end(data, offset)
                whole = length_at is not None and length_at <= size
                assert whole == (k < len(recovered)), (size, k)
                if not whole:
                    break
        assert cut.read_bytes() == data[:size]


def record_end(data, op_at):
    """Where the message record ends whose header has its op at ``op_at``; rosbag writes op first, after the length."""
    for start in range(op_at - 8, op_at - 80, -1):
        length = struct.unpack_from("<I", data, start)[0]
        if start + 4 + length > op_at + 4 and length < 80:
            end = start + 4 + length
            size = struct.unpack_from("<I", data, end)[0]
            if data[end + 4 + size - 1 : end + 4 + size] and size < 10_000:
                return end + 4 + size
    return None


@pytest.mark.parametrize("compression", ["none", "bz2", "lz4"])
def test_a_bag_that_nobody_closed_is_recovered_to_its_last_byte(tmp_path, compression):
    """As rosbag record leaves it on kill -9: no index position, the last chunk open with size 0."""
    listed = write(tmp_path / "whole.bag", compression)
    data = bytearray((tmp_path / "whole.bag").read_bytes())
    at = data.index(b"index_pos=") + len(b"index_pos=")
    data[at : at + 8] = bytes(8)
    last = max(k for k in range(len(data)) if data.startswith(b"compression=", k))
    op = data.index(b"size=", last)
    header_end = next(
        k + 4 + struct.unpack_from("<I", data, k)[0]
        for k in range(last - 4, last - 64, -1)
        if last < k + 4 + struct.unpack_from("<I", data, k)[0] < last + 64 and k + 4 < last
    )
    assert op < header_end
    stop = header_end + 4 + struct.unpack_from("<I", data, header_end)[0]
    data[op + 5 : op + 9] = bytes(4)
    data[header_end : header_end + 4] = bytes(4)
    active = tmp_path / "a.bag.active"
    active.write_bytes(data[:stop])
    found = survey(active)
    assert not found.closed and not found.whole and found.messages == len(listed)
    done = repair(active)
    assert done.out == tmp_path / "a.repaired.bag"
    assert sorted(by_rosbag(done.out)) == sorted(listed)
    assert "killed" in "\n".join(done.lines())
    with pytest.raises(saras.Error, match="exists already"):
        repair(active)


def test_a_block_of_zeros_in_the_middle_costs_only_what_it_covers(tmp_path, many):
    listed = write(tmp_path / "whole.bag")
    data = (tmp_path / "whole.bag").read_bytes()
    rng = np.random.default_rng(8)
    for _ in range(10 * many):
        start = int(rng.integers(4200, len(data) // 2))
        damaged = data[:start] + bytes(3000) + data[start + 3000 :]
        (tmp_path / "holed.bag").write_bytes(damaged)
        done = repair(tmp_path / "holed.bag", tmp_path / "out.bag", force=True)
        recovered = by_rosbag(tmp_path / "out.bag")
        assert set(recovered) <= set(listed)
        # 3000 bytes, and what stood behind them in the same 4 kB chunk and the next
        assert len(recovered) >= len(listed) - 120
        assert done.before.gaps


def test_repair_of_a_whole_bag_keeps_everything(tmp_path, capsys):
    path = synthetic.write_session(tmp_path / "s.bag", duration_s=2.0)
    before = path.read_bytes()
    assert cli.main(["bag", "repair", str(path)]) == 0
    assert "was whole" in capsys.readouterr().out
    assert path.read_bytes() == before
    with Session.open(path) as a, Session.open(tmp_path / "s.repaired.bag") as b:
        assert a.topics == b.topics
        np.testing.assert_array_equal(a.arm("mesa_left").ee_pose.pose, b.arm("mesa_left").ee_pose.pose)
    assert default_out(path.with_name("x.bag.active")).name == "x.repaired.bag"


@pytest.mark.parametrize(
    ("head", "name"),
    [
        (b"", "an empty file"),
        (bytes(100), "a file of zeros"),
        (b"SQLite format 3\x00" + bytes(99), "ROS 2 bag"),
        (b"\x89MCAP0\r\n" + bytes(99), "MCAP"),
        (b"#ROSBAG V1.2\n", "version 1"),
        (b"PK\x03\x04" + bytes(99), "zip"),
        (b"\x1f\x8b" + bytes(99), "gzip"),
        (b"hello", "no ROS 1 bag"),
        (b"#ROSBAG V2.0\n", "before its first message"),
    ],
)
def test_foreign_files_are_named(tmp_path, head, name, capsys):
    (tmp_path / "foreign").write_bytes(head)
    for action in ("info", "check", "repair"):
        assert cli.main(["bag", action, str(tmp_path / "foreign")]) == 2
        assert name in capsys.readouterr().err
    assert [file.name for file in tmp_path.iterdir()] == ["foreign"]


def test_flipped_bytes_are_no_foreign_exception(tmp_path, many):
    data = synthetic.write_session(tmp_path / "whole.bag", duration_s=0.2).read_bytes()
    rng = np.random.default_rng(3)
    for _ in range(30 * many):
        flipped = bytearray(data)
        for at in rng.integers(13, len(data), 20):
            flipped[at] = rng.integers(0, 256)
        (tmp_path / "flipped.bag").write_bytes(flipped)
        try:
            check(survey(tmp_path / "flipped.bag"))
            repair(tmp_path / "flipped.bag", tmp_path / "out.bag", force=True)
        except saras.Error:
            continue
        assert survey(tmp_path / "out.bag").indexed


def session_with(path, drop=(), jump_at=None, jump_s=0.0, silent=None, future_s=0.0, rate_hz=100):
    """Six seconds of one pose topic with the named faults."""
    bag = synthetic.BagWriter(path)
    for tick in range(6 * rate_hz):
        t = tick / rate_hz
        if silent is not None and silent[0] <= t < silent[1]:
            continue
        stamp = t + (jump_s if jump_at is not None and t >= jump_at else 0.0) + future_s
        before = len(bag.pending)
        bag.pose("/mesa_left/ee_pose", stamp, (0, 0, 0), "mesa_left/sbs_world")
        if tick in drop:
            del bag.pending[before:]
        else:
            _, connection, data = bag.pending.pop()
            bag.pending.append((synthetic.START_NS + round((t + 0.0005) * 1e9), connection, data))
    bag.close()
    return path


def findings(path, expected=("/mesa_left/ee_pose",), **bounds):
    return {(row.grade, row.what): row for row in check(survey(path), expected, Bounds(**bounds))}


def test_a_good_session_has_no_finding(tmp_path):
    assert findings(session_with(tmp_path / "s.bag")) == {}


def test_lost_messages_are_counted_exactly(tmp_path, many):
    rng = np.random.default_rng(2)
    for _ in range(5 * many):
        drop = set(map(int, rng.integers(1, 599, rng.integers(1, 30))))
        row = findings(session_with(tmp_path / "s.bag", drop))["bad", "lost"]
        assert row.value == len(drop)
        assert f"at {(min(drop) - 1) / 100:.3f} s" in row.text
        (tmp_path / "s.bag").unlink()


def test_sequence_numbers_wrap_and_restart():
    assert lost_by_sequence(np.array([2**32 - 2, 2**32 - 1, 0, 1])) == (0, 0)
    assert lost_by_sequence(np.array([2**32 - 2, 1])) == (2, 0)
    assert lost_by_sequence(np.array([7, 8, 0, 1, 3])) == (1, 1)


def test_silence_is_a_gap_and_no_loss(tmp_path):
    found = findings(session_with(tmp_path / "s.bag", silent=(2.0, 2.5)))
    assert set(found) == {("warning", "gap"), ("warning", "rate")}
    assert found["warning", "gap"].value == pytest.approx(0.51)


@pytest.mark.parametrize("jump_s", [3600.0, -3600.0, 0.5, -0.5])
def test_a_stepping_clock_is_found_with_size_and_sign(tmp_path, jump_s):
    found = findings(session_with(tmp_path / "s.bag", jump_at=3.0, jump_s=jump_s))
    assert found["bad", "step"].value == pytest.approx(jump_s, abs=1e-3)
    assert "at 3.000 s" in found["bad", "step"].text
    assert (("bad", "order") in found) == (jump_s < 0)


def test_stamps_of_the_future_and_old_ones_are_told(tmp_path):
    assert ("bad", "future") in findings(session_with(tmp_path / "a.bag", future_s=0.05))
    assert ("warning", "age") in findings(session_with(tmp_path / "b.bag", future_s=-0.4))
    assert ("warning", "age") not in findings(session_with(tmp_path / "c.bag", future_s=-0.4), age_s=0.5)


def test_missing_topics_and_the_exit_code(tmp_path, capsys):
    path = session_with(tmp_path / "s.bag")
    (tmp_path / "list.yaml").write_text("topics: ['/mesa_{s}/ee_pose', /rare]\noccasional: [/rare]\n")
    assert expected_topics(tmp_path / "list.yaml") == ["/mesa_left/ee_pose", "/mesa_right/ee_pose"]
    assert cli.main(["bag", "check", str(path), "--topics", str(tmp_path / "list.yaml"), "--json"]) == 1
    answer = json.loads(capsys.readouterr().out)
    assert [(row["grade"], row["topic"]) for row in answer["findings"]] == [("bad", "/mesa_right/ee_pose")]
    # Without a list the question stays open, and is shown so.
    assert cli.main(["bag", "check", str(path)]) == 0
    assert "unknown" in capsys.readouterr().out
    (tmp_path / "list.yaml").write_text("nothing")
    assert cli.main(["bag", "check", str(path), "--topics", str(tmp_path / "list.yaml")]) == 2
    with pytest.raises(saras.ConfigError, match="gap_periods"):
        Bounds(gap_periods=float("nan"))


def test_the_platforms_own_list_is_read():
    names = expected_topics(synthetic.ROOT / "config" / "record_topics.yaml")
    assert "/mesa_right/ee_pose" in names and "/system/faults" not in names
