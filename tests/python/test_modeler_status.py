"""What the modeler says of its samples: totals as the map counts them, in words for the last second."""

from __future__ import annotations

import pytest

pytest.importorskip("rospy")

from saras.model import StiffnessGpConfig
from saras_ros1.modeler_status import SampleStatus


def status() -> SampleStatus:
    return SampleStatus(StiffnessGpConfig())


def test_totals_are_taken_as_they_are_and_the_last_second_is_what_came_since() -> None:
    said = status()
    said.count({"LEARNED": 100, "OUTLIER": 0})
    said.count({"LEARNED": 100, "OUTLIER": 30})
    assert (said.learned, said.refused) == (100, 30)
    assert said.text("", 0.0, 0.0) == (True, "OK")  # 30 of 130
    said.count({"LEARNED": 100, "OUTLIER": 60})
    well, text = said.text("", 0.0, 0.0)
    assert not well and text.startswith("OUTLIER")


def test_totals_that_were_read_before_all_was_forgotten_make_no_negative_counts() -> None:
    said = status()
    said.count({"LEARNED": 500})
    said.reset()
    said.count({"LEARNED": 500})  # read before the reset, told after it
    said.count({"LEARNED": 3, "SENSOR_DRIFT": 2})
    assert (said.learned, said.refused) == (3, 2)
    assert said.text("", 0.6, 0.0)[1] == "OK"


def test_silence_and_disagreement_have_names() -> None:
    said = status()
    assert said.text("nothing from /csa/slave/measured_cf", 0.0, 0.0) == (
        False,
        "STALE: nothing from /csa/slave/measured_cf",
    )
    assert said.text("", 0.0, 0.0) == (True, "NO_CONTACT")
    assert said.text("", 0.0, 9.0)[1].startswith("DISAGREES")
