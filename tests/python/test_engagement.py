"""The demo's operator: engages again after a HOLD, but never after an E-stop."""

import pytest

pytest.importorskip("rospy")
from saras_ros1.msg import ChannelState

from saras_ros1 import engagement


@pytest.fixture
def asked(monkeypatch):
    sides = []
    monkeypatch.setattr(engagement, "engage", sides.append)
    return sides


def hold(reason):
    return {"left": ChannelState(state=ChannelState.HOLD, reason=reason)}


@pytest.mark.parametrize(("reason", "times"), [("console data is late", 3), ("E-stop", 0), ("the E-stop was reset", 0)])
def test_who_engages_again(asked, reason, times):
    operator = engagement.Engagement()
    operator.since = 0.0  # both sides were engaged
    for tick in range(40):
        operator.update(hold(reason), 0.1 * tick)
    assert len(asked) == times
    assert set(asked) <= {"left"}
