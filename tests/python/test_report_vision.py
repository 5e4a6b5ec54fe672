"""The report's section about endoscope and seen contact: known numbers come out, unknown ones are said."""

from __future__ import annotations

import re
from html import unescape

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

from saras.recording import Session
from saras.report import examine
from saras.report.vision import vision

ERROR_M, RATE_HZ, AGE_S = 0.0004, 10.0, 0.05


def depth(t: float) -> float:
    """Of the left tip [m]: in contact in the second half of each second."""
    return 0.004 * np.sin(2.0 * np.pi * t)


def write(path, *, seconds: float = 8.0) -> None:
    bag = synthetic.BagWriter(path, transport_s=AGE_S)
    zero = {"x": 0.0, "y": 0.0, "z": 0.0}
    for tick in range(int(20 * seconds)):
        t = tick / 20
        topic = "/mesa_left/truth"
        fields = {"depth": depth(t), "tip_force": bag.make("geometry_msgs/msg/Vector3", **zero), "rcm_deviation": 0.0}
        bag.put(topic, "saras_ros1/msg/ArmTruth", t, header=bag.header(topic, t), **fields)
    for tick in range(int(RATE_HZ * seconds)):
        t = tick / RATE_HZ
        topic, known = "/contact/left", t < 0.75 * seconds
        direction = bag.make("geometry_msgs/msg/Vector3", **zero)
        seen = depth(t) + ERROR_M if known else float("nan")
        bag.put(topic, "saras_ros1/msg/Contact", t, header=bag.header(topic, t), depth=seen, direction=direction)
        topic = "/recorder/video/left"
        bag.put(topic, "saras_ros1/msg/VideoFrame", t, header=bag.header(topic, t), frame=tick, file="x.mkv")
    for second in range(int(seconds)):
        drawn = 0 if second < 2 else 15 * (second - 1)
        ages = {"left age_p50_ms": "40.0", "left age_p99_ms": "70.0", "left age_worst_ms": "80.0"}
        values = {"/visual_feedback": {"left drawn": drawn, **ages}}
        values["/endoscope_sim"] = {"rate_hz": 0.0 if second < 2 else 14.0, "wanted_hz": 15.0}
        status = [
            bag.make(
                "diagnostic_msgs/msg/DiagnosticStatus",
                level=0,
                name=name,
                message="RUNNING",
                hardware_id="",
                values=[bag.make("diagnostic_msgs/msg/KeyValue", key=k, value=str(v)) for k, v in pairs.items()],
            )
            for name, pairs in values.items()
        ]
        topic = "/diagnostics"
        bag.put(topic, "diagnostic_msgs/msg/DiagnosticArray", second, header=bag.header(topic, second), status=status)
    bag.close()


def rows(html: str) -> dict[str, list[str]]:
    """First cell of each row: the others."""
    found = {}
    for row in re.findall(r"<tr>(.*?)</tr>", html):
        cells = [unescape(re.sub("<[^>]*>", "", cell)) for cell in re.findall(r"<td[^>]*>(.*?)</td>", row)]
        if cells:
            found.setdefault(cells[0], cells[1:])
    return found


def section(path) -> str:
    with Session.open(path) as session:
        return vision(session, examine(session))


def test_rates_ages_and_the_error_of_the_depth(tmp_path):
    write(tmp_path / "seen.bag")
    html = section(tmp_path / "seen.bag")
    found = rows(html)
    assert found["pictures drawn"][:2] == ["14.0", "15.0"]
    video = [float(cell) for cell in found["left eye's video"] if cell]
    np.testing.assert_allclose(video, [RATE_HZ, 100.0, 50.0, 50.0, 50.0], rtol=1e-3)
    assert found["left eye's overlay"] == ["15.0", "", "", "40.0", "70.0", "80.0"]
    assert found["known"] == ["75.0 % of 80"]
    rms, mean = re.match(r"([\d.]+) mm RMS, \+([\d.]+) mm", found["error of the depth there"][0]).groups()
    assert float(rms) == pytest.approx(1e3 * ERROR_M, abs=0.01)
    assert float(mean) == pytest.approx(1e3 * ERROR_M, abs=0.01)
    assert "right eye's video" not in found


def test_what_was_never_in_contact_has_no_error(tmp_path):
    bag = synthetic.BagWriter(tmp_path / "silent.bag")
    zero = bag.make("geometry_msgs/msg/Vector3", x=0.0, y=0.0, z=0.0)
    for tick in range(20):
        topic, t = "/contact/left", 0.1 * tick
        nothing = {"depth": float("nan"), "direction": zero}
        bag.put(topic, "saras_ros1/msg/Contact", t, header=bag.header(topic, t), **nothing)
    bag.close()
    html = section(tmp_path / "silent.bag")
    assert rows(html)["known"] == ["0.0 % of 20"]
    assert "error of the depth" not in html  # no truth: nothing to compare with


def test_a_session_without_an_endoscope_says_so(tmp_path):
    path = synthetic.write_session(tmp_path / "plain.bag", duration_s=3.0)
    assert section(path) == "<p class='note'>No endoscope was recorded.</p>"
