"""The report of a session of situational awareness: known numbers in, the same numbers out."""

from __future__ import annotations

import math

import numpy as np
import pytest

pytest.importorskip("rosbags")

import synthetic_session as synthetic

from saras.recording import Session
from saras.report import awareness, write_report

FULL, NO = 3, 0
ERROR_N, OUT_M = 0.05, 0.0015


def write(path, *, hold=True):
    """30 s at 100 Hz: full contact from 5 to 25 s, a hold from 15 to 16 s, a region from 18 s on."""
    bag = synthetic.BagWriter(path)

    def xyz(kind, values):
        return bag.make(f"geometry_msgs/msg/{kind}", **dict(zip("xyz", map(float, values))))

    primitive = bag.make("saras_ros1/msg/CsaPrimitive", kind="force", amplitude=0.5, frequency_hz=0.5, exploring=False)
    for i in range(3000):
        t = 0.01 * i
        state, held = FULL if 5.0 <= t < 25.0 else NO, hold and 15.0 <= t < 16.0
        pose = bag.make(
            "geometry_msgs/msg/Pose", position=xyz("Point", (0, 0, 0)),
            orientation=bag.make("geometry_msgs/msg/Quaternion", x=0.0, y=0.0, z=0.0, w=1.0),
        )  # fmt: skip
        bag.put(
            "/csa/teleop/state", "saras_ros1/msg/CsaTeleopState", t, header=bag.header("state", t, "PSM1"),
            state=state, enabled=t >= 1.0, hold=held, reason="FORCE_UNKNOWN: nothing" if held else "", mode=1,
            desired=pose, normal=xyz("Vector3", (0, 0, 1)), desired_force_N=2.0, synchronisations=1, mismatch_m=0.001,
            primitive=primitive,
        )  # fmt: skip
        desired = 2.0 + 0.5 * math.sin(math.pi * t)
        bag.put(
            "/csa/slave/admittance", "saras_ros1/msg/CsaAdmittance", t, header=bag.header("did", t, "PSM1"),
            hold=held, reason="NONE", admittance_m_Ns=0.02, normal_force_N=desired + ERROR_N,
            desired_force_N=desired if state == FULL else math.nan, normal=xyz("Vector3", (0, 0, 1)),
            joint_speed_share=0.5, fixture="", fixture_distance_m=math.nan, fixture_closest=xyz("Point", (0, 0, 0)),
            kkt_residual=0.0,
        )  # fmt: skip
        x = 0.01 + OUT_M if 20.0 <= t < 20.1 else 0.0
        bag.pose("/csa/slave/measured_cp", t, (x, 0.0, 0.0), "PSM1")
        bag.vector(
            "/csa/master/servo_cf", t, np.array([0, 0, 1.5 if state == FULL else 0.0, 0, 0, 0]), "Wrench", "PSM1"
        )
        push = np.array([-0.75 if 20.0 <= t < 20.1 else 0.0, 0, 0, 0, 0, 0])
        bag.vector("/csa/master/border", t, push, "Wrench", "PSM1")
        if i == 1800:
            corners = [
                bag.make("geometry_msgs/msg/Point32", x=0.01 * a, y=0.01 * b, z=0.0)
                for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))
            ]
            polygon = bag.make("geometry_msgs/msg/Polygon", points=corners)
            header = bag.header("roi", t, "PSM1")
            bag.put("/csa/modeler/roi", "geometry_msgs/msg/PolygonStamped", t, header=header, polygon=polygon)
    bag.close()
    return path


@pytest.fixture(scope="module")
def bag(tmp_path_factory):
    return write(tmp_path_factory.mktemp("csa") / "session.bag")


def test_verdicts_are_the_numbers_that_went_in(bag) -> None:
    with Session.open(bag) as session:
        assert awareness.is_awareness(session)
        verdicts = {v.title: v for v in awareness.examine(session).verdicts}
    assert verdicts["Contact"].value == "19.0 s" and verdicts["Contact"].grade == "good"
    assert verdicts["Force error"].value == f"{ERROR_N:.3f} N" and verdicts["Force error"].grade == "good"
    assert verdicts["Out of the region"].value == f"{1e3 * OUT_M:.2f} mm"
    assert verdicts["Out of the region"].grade == "bad"
    assert verdicts["Force on the hand"].value == "1.50 N"
    assert verdicts["Force on the hand"].detail.endswith("fixtures asked for up to 0.75 N")
    assert verdicts["Holds"].value == "1" and verdicts["Holds"].grade == "warning"
    assert verdicts["Joint speeds"].value == "50 %"


def test_the_page_names_the_hold_and_draws(bag, tmp_path) -> None:
    page = tmp_path / "report.html"
    found = write_report(bag, page)
    html = page.read_text(encoding="utf-8")
    assert [v.title for v in found.verdicts][:2] == ["Contact", "Force error"]
    assert "FORCE_UNKNOWN" in html and html.count("<svg") >= 7 and "region of interest" in html
    assert "wanted by the fixtures" in html


def test_what_was_not_recorded_is_unknown(tmp_path) -> None:
    writer = synthetic.BagWriter(tmp_path / "little.bag")
    writer.text("/saras/session", 0.0, "{}")
    writer.text("/saras/session", 1.0, "{}")
    writer.close()
    with Session.open(tmp_path / "little.bag") as session:
        verdicts = {v.title: v.grade for v in awareness.examine(session).verdicts}
        assert verdicts["Contact"] == verdicts["Force error"] == verdicts["Holds"] == "unknown"
        assert "unknown" in awareness.force(session) + awareness.mismatch(session)
