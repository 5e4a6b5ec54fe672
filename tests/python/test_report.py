"""saras.report: findings against known numbers, and the page itself."""

from __future__ import annotations

import re
from html.parser import HTMLParser

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

from saras.recording import Session, Topic
from saras.report import examine, tracking, write_report
from saras.report.energy import account
from saras.report.svg import Chart, decimate, ticks
from saras.report.timing import latency, rate


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return synthetic.write_session(tmp_path_factory.mktemp("bag") / "session.bag", duration_s=30.0)


@pytest.fixture(scope="module")
def found(bag):
    with Session.open(bag) as session:
        yield examine(session)


def verdict(found, title):
    return next(v for v in found.verdicts if v.title == title)


def test_tracking_finds_scale_lag_and_no_residual(found):
    for side in ("left", "right"):
        fit = found.tracking[side]
        assert fit.lag_s == pytest.approx(synthetic.LAG_S, abs=5e-4)
        assert fit.scale == pytest.approx(synthetic.SCALE, abs=1e-4)
        assert fit.rms_mm < 0.01  # linear interpolation between 10 ms samples
        assert found.set_point_tracking[side].lag_s == pytest.approx(0.01, abs=5e-4)


def test_hold_is_counted_and_bad(found):
    assert verdict(found, "HOLDs").value == "1"
    assert verdict(found, "HOLDs").grade == "bad"
    assert [round(end - start, 2) for start, end, state in found.states["left"] if state == 3] == [1.0]


def test_books_balance(found):
    assert verdict(found, "Energy ledger").grade == "good"
    assert found.ledger.flight_J == pytest.approx(0.0, abs=1e-12)
    assert [a.granted_J for a in found.ledger.accounts] == [0.4] * 4


def test_least_distance_names_who_and_when(bag, found):
    tile = verdict(found, "Least distance")
    assert tile.value == "5.0 mm"
    assert tile.detail.startswith("mesa_left - PSM1 at 14.0 s")
    assert tile.grade == "warning"
    with Session.open(bag) as session:
        (tool,) = session.distances
    # 10 mm, 11 mm and so on are reached linearly: 45 mm in 4.5 s.
    assert tool.seconds_in(2) == pytest.approx(1.0, abs=0.03)
    assert tool.seconds_in(0) == pytest.approx(0.5, abs=0.03)
    assert tool.t[tool.slowed].min() == pytest.approx(13.0, abs=0.03)


def test_slowed_motion_is_not_free(bag):
    with Session.open(bag) as session:
        grid = tracking.time_grid(session)
        free = tracking.free_motion(session, "left", grid)
    assert not free[(grid > 13.1) & (grid < 15.9)].any()
    assert free[(grid > 17.0) & (grid < 17.2)].any() or free[(grid > 3.0) & (grid < 6.0)].any()


def test_what_was_not_recorded_is_unknown(found):
    assert verdict(found, "Remote centre").grade == "unknown"
    assert dict(found.latencies["left"])["tank_master → touch frame"] is None


def test_lost_messages_and_restarts_are_counted():
    seq = np.array([0, 1, 2, 5, 6, 0, 1])
    t = np.arange(7) * 0.01
    result = rate(Topic("/x", "y", t, t, {"seq": seq}))
    assert (result.lost, result.restarts) == (2, 1)
    assert result.median_hz == pytest.approx(100)


def test_latency_pairs_equal_stamps_else_latest_input():
    class Recorded:
        def __init__(self, **topics):
            self.topics = topics

        def topic(self, name):
            return self.topics.get(name)

    t = np.arange(100) * 0.01
    source = Topic("a", "", t, t + 0.001, {})
    same = latency(Recorded(a=source, b=Topic("b", "", t, t + 0.004, {})), "a → b", "a", "b")
    assert (same.method, round(same.p50_ms, 6)) == ("same stamp", 3.0)
    restamped = latency(Recorded(a=source, b=Topic("b", "", t + 0.003, t + 0.004, {})), "a → b", "a", "b")
    assert (restamped.method, round(restamped.p50_ms, 6)) == ("latest input", 3.0)


def test_account_sums_over_restarts():
    columns = {
        "session": np.array([1, 1, 2, 2]),
        "energy_J": np.array([0.4, 0.3, 0.02, 0.42]),
        "work_out_J": np.array([0.0, 0.1, 0.0, 0.0]),
        "granted_J": np.array([0.4, 0.4, 0.02, 0.42]),
        "minimum_J": np.full(4, 0.02),
    }
    columns.update({name: np.zeros(4) for name in ("sent_J", "received_J", "vented_J")})
    t = np.arange(4.0)
    result = account("tank", Topic("/tank/state", "", t, t, columns))
    assert result.granted_J == pytest.approx(0.82)
    assert result.work_out_J == pytest.approx(0.1)
    assert result.sessions == 2
    assert result.residual_J < 1e-12


def test_decimation_keeps_extremes():
    x = np.linspace(0, 1, 100_000)
    y = np.zeros_like(x)
    y[31_337], y[77_777] = 5.0, -3.0
    xs, ys = decimate(x, y, 500)
    assert len(xs) <= 502
    assert (ys.max(), ys.min()) == (5.0, -3.0)
    assert np.all(np.diff(xs) > 0)


def test_chart_leaves_gaps_open_and_says_when_there_is_nothing():
    x = np.arange(100) * 0.01
    y = np.ones(100)
    y[50] = np.nan
    assert Chart("v").line(x, y, "a", "master").render().count("<polyline") == 2
    x[70:] += 1.0
    assert Chart("v").line(x, y, "a", "master").render().count("<polyline") == 3
    assert "unknown" in Chart("v").line(x, np.full(100, np.nan), "a", "master").render()
    assert "unknown" in Chart("v").render()


def test_ticks_are_round():
    assert ticks(0.0, 1.0, 5) == pytest.approx([0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert all(-16 <= tick <= 16 for tick in ticks(-16, 16, 3))
    assert len(ticks(-16, 16, 3)) >= 3


class _Balance(HTMLParser):
    """Every tag is closed, in order."""

    void = ("meta", "br", "hr", "img", "link", "input")

    def __init__(self):
        super().__init__()
        self.open = []

    def handle_starttag(self, tag, attrs):
        if tag not in self.void:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, f"</{tag}> closes {self.open[-3:]}"
        self.open.pop()


def test_page_is_one_balanced_file_without_outside_links(bag, tmp_path):
    write_report(bag, tmp_path / "deep" / "report.html")
    html = (tmp_path / "deep" / "report.html").read_text(encoding="utf-8")
    parser = _Balance()
    parser.feed(html)
    parser.close()
    assert parser.open == []
    assert len(html) < 6_000_000
    outside = [url for url in re.findall(r"https?://[^\"' <]+", html) if "www.w3.org/2000/svg" not in url]
    assert outside == []
    assert not re.search(r"<(?:link|script|img)[^>]+(?:src|href)=", html)
    assert "HOLD: console: no datagram for 61 ms" in html


def test_page_of_a_nearly_empty_bag_is_all_unknown(tmp_path):
    writer = synthetic.BagWriter(tmp_path / "thin.bag")
    for index in range(5):
        writer.text("/chatter", 0.1 * index, "<script>alert(1)</script>")
    writer.close()
    found = write_report(tmp_path / "thin.bag", tmp_path / "thin.html")
    assert {v.grade for v in found.verdicts} == {"unknown"}
    assert "alert(1)" not in (tmp_path / "thin.html").read_text(encoding="utf-8")
