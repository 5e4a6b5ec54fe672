import threading
import time

import pytest

rospy = pytest.importorskip("rospy")
from geometry_msgs.msg import PointStamped

from saras_ros1.inputs import Input, Loop

PERIOD_S = 0.01
rospy.rostime.set_rostime_initialized(True)  # throttled log lines read the clock; no node runs here


def message(stamp_s, seq=0):
    point = PointStamped()
    point.header.seq = seq
    point.header.stamp = rospy.Time.from_sec(stamp_s)
    return point


def finite(point):
    if point.point.x != point.point.x:
        raise ValueError("not finite")
    return point.point.x


class Recorder:
    """Two inputs and a loop over the first `primaries` of them."""

    def __init__(self, primaries=1, timeout_s=10.0):
        lock = threading.RLock()
        self.inputs = [Input(f"/in{i}", timeout_s, finite, lock) for i in range(2)]
        self.ticks = []
        self.loop = Loop(self.ticks.append, self.inputs[:primaries], PERIOD_S, lock)


def test_the_interval_comes_from_the_stamps():
    r = Recorder()
    for stamp_s in (100.0, 100.01, 100.03):
        r.inputs[0].on_message(message(stamp_s))
    assert [round(t.dt, 6) for t in r.ticks] == [PERIOD_S, 0.01, 0.02]
    assert not any(t.stale for t in r.ticks)


def test_a_duplicate_or_older_stamp_gives_no_step():
    r = Recorder()
    for stamp_s in (100.0, 100.01, 100.01, 100.005, 100.02):
        r.inputs[0].on_message(message(stamp_s))
    assert [round(t.dt, 6) for t in r.ticks] == [PERIOD_S, 0.01, 0.01]
    assert r.loop.dropped == 2


@pytest.mark.parametrize("hour_s", [-3600.0, 3600.0])
def test_a_stepped_clock_costs_one_tick(hour_s):
    r = Recorder()
    for stamp_s in (1e5, 1e5 + 0.01, 1e5 + hour_s, 1e5 + hour_s + 0.01):
        r.inputs[0].on_message(message(stamp_s))
    assert len(r.ticks) == 4
    assert r.ticks[-1].dt == pytest.approx(0.01)
    assert all(t.dt > 0.0 for t in r.ticks)


def test_two_primaries_make_one_step():
    r = Recorder(primaries=2)
    for stamp_s in (100.0, 100.01, 100.02):
        for source in r.inputs:
            source.on_message(message(stamp_s))
    # the very first message finds the other primary never seen, so not alive
    assert len(r.ticks) == 3 or len(r.ticks) == 4
    assert sum(t.dt for t in r.ticks[1:]) == pytest.approx(0.02, abs=PERIOD_S)


def test_a_dead_primary_does_not_hold_up_the_other():
    r = Recorder(primaries=2, timeout_s=0.05)
    r.inputs[1].on_message(message(100.0))
    time.sleep(0.06)
    for k in range(5):
        r.inputs[0].on_message(message(100.0 + 0.01 * (k + 1)))
    assert len(r.ticks) == 6


def test_a_refused_message_changes_nothing_but_the_count():
    r = Recorder()
    r.inputs[0].on_message(message(100.0))
    bad = message(100.01)
    bad.point.x = float("nan")
    received_s = r.inputs[0].received_s
    r.inputs[0].on_message(bad)
    assert (r.inputs[0].rejected, r.inputs[0].received, len(r.ticks)) == (1, 1, 1)
    assert r.inputs[0].received_s == received_s


def test_gaps_of_the_link_are_counted():
    r = Recorder()
    for k, seq in enumerate((5, 6, 9, 10, 12)):
        r.inputs[0].on_message(message(100.0 + k, seq))
    assert r.inputs[0].lost == 3


def test_an_exception_in_a_step_does_not_end_the_loop():
    lock = threading.RLock()
    source = Input("/in", 1.0, finite, lock)
    seen = []

    def step(tick):
        seen.append(tick)
        raise RuntimeError("bad tick")

    Loop(step, [source], PERIOD_S, lock)
    source.on_message(message(1.0))
    source.on_message(message(1.01))
    assert len(seen) == 2


def test_silence_gives_stale_steps():
    r = Recorder(timeout_s=0.02)
    threading.Thread(target=r.loop.watch, daemon=True).start()
    deadline = time.monotonic() + 5.0
    while r.loop.stale_steps < 3 and time.monotonic() < deadline:
        time.sleep(0.01)
    r.inputs[0].timeout_s = 1e9
    assert r.loop.stale_steps >= 3
    assert r.ticks[0].stale and r.ticks[0].dt == PERIOD_S
