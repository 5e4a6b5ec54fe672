"""A recording that does not go on is never taken for one that does."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from saras_ros1.bag_process import newest_time_ns
from saras_ros1.recording_watch import Look, RecordingLimits, RecordingWatch, free_bytes, writable

LIMITS = RecordingLimits(stall_s=2.0, min_free_B=1e8, warn_free_B=1e9, behind_s=10.0)


def look(watch, now_s, size, exit_code=None, free_B=1e12):
    return watch.look(Look(now_s, size, exit_code, free_B))


def test_a_growing_bag_is_recording():
    watch = RecordingWatch(LIMITS, 0.0)
    look(watch, 0.1, 500)
    for k in range(1, 50):
        assert look(watch, 0.2 * k, 1000 * k)[:3] == (True, False, "")


def test_a_bag_that_stands_still_is_not_and_is_again_when_it_grows():
    watch = RecordingWatch(LIMITS, 0.0)
    look(watch, 0.1, 1000)
    look(watch, 0.2, 2000)
    assert look(watch, 2.1, 2000).recording
    stalled = look(watch, 2.5, 2000)
    assert not stalled.recording and not stalled.stop and "nothing was written for 2.3 s" in stalled.reason
    assert look(watch, 2.6, 2001).recording


def test_a_bag_that_grows_behind_the_messages_is_said():
    watch = RecordingWatch(LIMITS, 0.0)
    look(watch, 0.1, 500)
    seen = [watch.look(Look(0.2 * k, 1000 * k, None, 1e12, 0.1 * k)) for k in range(1, 150)]
    for k, verdict in enumerate(seen, start=1):
        assert verdict.recording == (0.1 * k <= 10.0)
        assert ("slow" in verdict.reason) == (0.1 * k > 2.0)
        assert not verdict.stop
    assert watch.look(Look(31.0, 10**6, None, 1e12, math.nan)).recording


def test_the_newest_message_is_found_in_the_tail_of_a_bag(tmp_path):
    rosbag, genpy = pytest.importorskip("rosbag"), pytest.importorskip("genpy")
    from std_msgs.msg import String

    path, sizes = tmp_path / "a.bag", []
    with rosbag.Bag(str(path), "w", chunk_threshold=4000) as bag:
        for k in range(400):
            bag.write("/text", String("time=" * (k % 50)), genpy.Time(1_700_000_000 + k, 5 * k))
            bag._file.flush()
            sizes.append(path.stat().st_size)
    data = path.read_bytes()
    for k in range(2, 400):
        found = newest_time_ns(data[: sizes[k]][-(1 << 16) :])
        assert found is not None and found % 10**9 == 5 * (found // 10**9 - 1_700_000_000)
        assert 0 <= k - (found // 10**9 - 1_700_000_000) <= 1
    assert newest_time_ns(b"") is None and newest_time_ns(data[:20]) is None


def test_the_head_of_a_file_is_no_recording():
    watch = RecordingWatch(LIMITS, 0.0)
    assert look(watch, 0.2, 0)[:3] == look(watch, 0.4, 4117)[:3] == (False, False, "starting")
    assert look(watch, 0.6, 20000).recording


@pytest.mark.parametrize(
    ("code", "words"), [(-9, "killed by signal 9"), (1, "ended with code 1"), (0, "ended with code 0")]
)
def test_a_dead_recorder_stops_with_its_reason(code, words):
    verdict = look(RecordingWatch(LIMITS, 0.0), 0.2, 1000, exit_code=code)
    assert not verdict.recording and verdict.stop and words in verdict.reason


def test_it_ends_before_the_disk_is_full_and_warns_before_that():
    watch = RecordingWatch(LIMITS, 0.0)
    look(watch, 0.0, 1, free_B=6e8)
    warned = look(watch, 1.0, 10_000_001, free_B=5.9e8)
    assert warned.recording and "590 MB free" in warned.reason and warned.left_s == pytest.approx(49.0)
    full = look(watch, 2.0, 20_000_001, free_B=0.9e8)
    assert not full.recording and full.stop and "disk is full" in full.reason


@given(st.lists(st.tuples(st.floats(0.01, 3.0), st.integers(0, 10**7), st.floats(0.0, 1e10)), min_size=1, max_size=60))
def test_recording_means_alive_grown_lately_and_room(steps):
    watch, now_s, size, grown_s = RecordingWatch(LIMITS, 0.0), 0.0, 4117, 0.0
    look(watch, 0.0, size)
    for dt, growth, free_B in steps:
        now_s, size = now_s + dt, size + growth
        grown_s = now_s if growth else grown_s
        verdict = look(watch, now_s, size, free_B=free_B)
        lately = size > 4117 and now_s - grown_s <= LIMITS.stall_s
        assert verdict.recording == (free_B >= LIMITS.min_free_B and lately)
        assert verdict.recording or verdict.reason


def test_what_cannot_be_told_is_no_room():
    assert math.isnan(free_bytes("/nowhere/at/all"))
    watch = RecordingWatch(LIMITS, 0.0)
    look(watch, 0.1, 5)
    verdict = look(watch, 0.2, 10, free_B=math.nan)
    assert verdict.recording is False and verdict.stop


def test_where_nothing_can_be_written_is_named(tmp_path: Path):
    assert writable(str(tmp_path / "new" / "one")) == ""
    (tmp_path / "file").write_text("")
    assert "file" in writable(str(tmp_path / "file"))
