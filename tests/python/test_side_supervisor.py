import math

import pytest

pytest.importorskip("rospy")
from saras_ros1.side_supervisor import SideSupervisor, State, Watch, crtk_of_all

LIMIT_S = 0.06


def watches(console_s=0.0, arm_s=0.0):
    return [
        Watch("console data", console_s, LIMIT_S, "check the console"),
        Watch("arm state", arm_s, 0.1, "check the arm"),
    ]


def engaged(**options):
    side = SideSupervisor("left", **options)
    side.update(watches())
    side.engage()
    return side


def test_waiting_names_what_was_never_seen():
    side = SideSupervisor("left")
    side.update(watches(console_s=math.inf))
    assert (side.state, side.reason, side.advice) == (State.WAITING, "no console data yet", "check the console")


def test_ready_comes_and_goes_by_itself():
    side = SideSupervisor("left")
    assert side.update(watches()) and side.state == State.READY
    assert side.update(watches(arm_s=0.2)) and side.state == State.WAITING
    assert side.update(watches()) and side.state == State.READY


def test_engaging_counts():
    side = engaged()
    assert (side.state, side.engagement) == (State.ENGAGED, 1)
    assert side.engage() == (True, "left is engaged already") and side.engagement == 1


def test_engaging_is_refused_while_something_is_missing():
    side = SideSupervisor("left")
    assert not side.engage()[0]
    side.update(watches(arm_s=0.2))
    done, said = side.engage()
    assert not done and "no arm state for 200 ms (limit 100)" in said and side.state == State.WAITING


@pytest.mark.parametrize("ages", [{"console_s": 0.061}, {"arm_s": 0.101}])
def test_silence_holds_and_stays_until_engaged_again(ages):
    side = engaged()
    assert not side.update(watches(**ages)), "one look may be our own hiccup"
    assert side.update(watches(**ages)) and side.state == State.HOLD
    assert "limit" in side.reason and side.advice
    assert not side.update(watches()) and side.state == State.HOLD
    assert side.engage()[0] and side.engagement == 2


def test_a_fault_holds():
    side = engaged()
    side.update(watches(), "the pose jumped 50 mm")
    assert (side.state, side.reason) == (State.HOLD, "the pose jumped 50 mm")


def test_the_operator_can_hold():
    side = engaged()
    side.hold()
    assert side.state == State.HOLD


def test_auto_engage_acts_once_and_never_out_of_hold():
    side = SideSupervisor("left", auto_engage=True)
    side.update(watches(console_s=math.inf))
    side.update(watches())
    assert (side.state, side.engagement) == (State.ENGAGED, 1)
    side.update(watches(console_s=1.0))
    side.update(watches(console_s=1.0))
    for _ in range(3):
        side.update(watches())
    assert (side.state, side.engagement) == (State.HOLD, 1)


def test_a_refusal_from_outside_is_told():
    side = SideSupervisor("left")
    side.update(watches())
    assert side.engage("roscore does not answer") == (False, "left not engaged: roscore does not answer")


def all_words(side):
    return [side.engage, side.hold, side.disengage, lambda: side.update(watches()), lambda: side.update(watches(), "x")]


@pytest.mark.parametrize("state", ["WAITING", "READY", "ENGAGED", "HOLD"])
def test_estop_is_latched_from_every_state_and_reset_alone_never_moves(state):
    side = engaged() if state in ("ENGAGED", "HOLD") else SideSupervisor("left", auto_engage=state == "WAITING")
    if state == "READY":
        side.update(watches())
    elif state == "HOLD":
        side.hold()
    before = side.engagement
    side.estop()
    for word in all_words(side):
        word()
        assert (side.state, side.crtk) == (State.ESTOP, "FAULT")
    assert "E-stop" in side.engage()[1]
    side.estop_reset()
    for _ in range(3):
        side.update(watches())
        assert (side.state, side.engagement) == (State.HOLD, before)
    assert side.engage()[0] and side.state == State.ENGAGED


def test_reset_without_estop_does_nothing():
    side = engaged()
    side.estop_reset()
    assert side.state == State.ENGAGED


def test_who_disengages_is_ready_again():
    side = engaged()
    side.disengage()
    assert side.crtk == "DISABLED"
    side.update(watches())
    assert (side.state, side.engagement) == (State.READY, 1)


def test_crtk_of_the_whole():
    assert crtk_of_all(["DISABLED", "DISABLED"]) == "DISABLED"
    assert crtk_of_all(["PAUSED", "DISABLED"]) == "PAUSED"
    assert crtk_of_all(["PAUSED", "ENABLED"]) == "ENABLED"
    assert crtk_of_all(["ENABLED", "FAULT"]) == "FAULT"
