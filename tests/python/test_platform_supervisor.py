"""The supervisor's sides, leases and E-stop, without ROS: what operators ask, and what they are told."""

import math

import pytest

pytest.importorskip("rospy")

from saras_ros1.operator_ask import Ask
from saras_ros1.platform_supervisor import PlatformSupervisor, SideSigns, State
from saras_ros1.system_commands import crtk_of_all
from saras_ros1.watch import Watch

LIMIT_S = 0.06
TWO = ("assistant", "colleague")


def watches(console_s=0.0, arm_s=0.0):
    return [
        Watch("console data", console_s, LIMIT_S, "check the console"),
        Watch("arm state", arm_s, 0.1, "check the arm"),
    ]


class Platform:
    """One side, with words as one says them."""

    def __init__(self, operators=("assistant",), sides=("left",), **options):
        self.law = PlatformSupervisor(sides, operators, **options)
        self.alive = [True] * len(operators)

    def look(self, fault="", misaligned="", estop="", reset=False, **ages):
        signs = {name: SideSigns(watches(**ages), fault=fault, misaligned=misaligned) for name in self.law.sides}
        return bool(self.law.update(signs, self.alive, estop=estop, reset=reset))

    def ask(self, act, operator="", to="", side="left", refusal="", **look):
        number = self.law.operators.index(operator) + 1 if operator else 0
        ask = Ask(side, act, number, self.law.operators.index(to) + 1 if to else 0, refusal=refusal)
        self.law.ask(ask)
        self.look(**look)
        return ask.wait(0.0)

    @property
    def left(self):
        return self.law.sides["left"]

    @property
    def state(self):
        return self.left.state


def ready(*arguments, **options):
    platform = Platform(*arguments, **options)
    platform.look()
    return platform


def engaged(*arguments, **options):
    platform = ready(*arguments, **options)
    assert platform.ask("engage")[0]
    return platform


def test_waiting_names_what_was_never_seen():
    platform = Platform()
    platform.look(console_s=math.inf)
    said = (platform.state, platform.left.reason, platform.left.advice)
    assert said == (State.WAITING, "no console data yet", "check the console")


def test_ready_comes_and_goes_by_itself():
    platform = Platform()
    assert platform.look() and platform.state == State.READY
    assert platform.look(arm_s=0.2) and platform.state == State.WAITING
    assert platform.look() and platform.state == State.READY


def test_engaging_counts():
    platform = engaged()
    assert (platform.state, platform.left.engagement, platform.left.may_move) == (State.ENGAGED, 1, True)
    assert platform.ask("engage") == (True, "left is engaged already") and platform.left.engagement == 1


def test_engaging_is_refused_while_something_is_missing():
    platform = Platform()
    assert not platform.ask("engage", arm_s=0.2)[0]
    done, said = platform.ask("engage", arm_s=0.2)
    assert not done and "no arm state for 200 ms (limit 100)" in said and platform.state == State.WAITING


def test_engaging_is_refused_while_misaligned_and_the_advice_says_why():
    platform = ready()
    done, said = platform.ask("engage", misaligned="hold the hand still")
    assert not done and "hold the hand still" in said and platform.state == State.READY
    assert platform.left.advice == "to engage: hold the hand still"
    assert platform.ask("engage")[0]
    platform.look(misaligned="only of interest before")
    assert platform.state == State.ENGAGED and not platform.left.misaligned


@pytest.mark.parametrize("ages", [{"console_s": 0.061}, {"arm_s": 0.101}])
def test_silence_holds_and_stays_until_engaged_again(ages):
    platform = engaged()
    assert not platform.look(**ages), "one look may be our own hiccup"
    assert platform.look(**ages) and platform.state == State.HOLD
    assert "limit" in platform.left.reason and platform.left.advice
    assert not platform.look() and platform.state == State.HOLD
    assert platform.ask("engage")[0] and platform.left.engagement == 2


def test_a_fault_holds():
    platform = engaged()
    platform.look(fault="the pose jumped 50 mm")
    assert (platform.state, platform.left.reason) == (State.HOLD, "the pose jumped 50 mm")


def test_the_operator_can_hold():
    platform = engaged()
    assert platform.ask("hold") == (True, "left holds") and platform.state == State.HOLD


def test_sides_know_nothing_of_each_other():
    platform = Platform(sides=("left", "right"))
    platform.look()
    assert platform.ask("engage", side="left")[0] and platform.ask("engage", side="right")[0]
    platform.ask("hold", side="right")
    assert (platform.state, platform.law.sides["right"].state) == (State.ENGAGED, State.HOLD)


def test_auto_engage_acts_once_and_never_out_of_hold():
    platform = Platform(auto_engage=True)
    platform.look(console_s=math.inf)
    platform.look()
    platform.look()
    assert (platform.state, platform.left.engagement) == (State.ENGAGED, 1)
    platform.look(console_s=1.0)
    platform.look(console_s=1.0)
    for _ in range(3):
        platform.look()
    assert (platform.state, platform.left.engagement) == (State.HOLD, 1)


def test_a_refusal_from_outside_is_told():
    platform = ready()
    said = platform.ask("engage", refusal="roscore does not answer")
    assert said == (False, "left not engaged: roscore does not answer")


def test_nobody_waits_any_more_and_it_never_happens():
    platform = ready()
    ask = Ask("left", "engage")
    platform.law.ask(ask)
    assert "ask again" in ask.wait(0.0)[1]
    platform.look()
    assert platform.state == State.READY


@pytest.mark.parametrize("state", ["WAITING", "READY", "ENGAGED", "HOLD"])
def test_estop_is_latched_from_every_state_and_reset_alone_never_moves(state):
    platform = engaged() if state in ("ENGAGED", "HOLD") else Platform(auto_engage=state == "WAITING")
    if state == "READY":
        platform.look()
    elif state == "HOLD":
        platform.ask("hold")
    before = platform.left.engagement
    platform.law.estop("E-stop")
    for act in ("engage", "hold", "disengage", "release"):
        platform.ask(act, "assistant" if act == "release" else "")
        platform.look(fault="x")
        assert (platform.state, platform.left.crtk) == (State.ESTOP, "FAULT")
    assert "E-stop" in platform.ask("engage")[1]
    platform.look(reset=True)
    for _ in range(3):
        platform.look()
        assert (platform.state, platform.left.engagement) == (State.HOLD, before)
    assert platform.ask("engage")[0] and platform.state == State.ENGAGED


def test_a_pressed_button_wins_over_its_reset():
    platform = engaged()
    platform.look(estop="E-stop: the button is pressed")
    assert platform.state == State.ESTOP and "button" in platform.left.reason
    platform.look(estop="E-stop: the button is pressed", reset=True)
    assert platform.state == State.ESTOP and platform.law.estop_latched
    platform.look(reset=True)
    assert platform.state == State.HOLD and not platform.law.estop_latched


def test_an_estop_from_before_the_start_is_latched():
    platform = Platform(latched="E-stop", auto_engage=True)
    for _ in range(3):
        platform.look()
    assert platform.state == State.ESTOP and not platform.ask("engage")[0]
    platform.look(reset=True)
    for _ in range(3):
        platform.look()
    assert platform.state == State.HOLD


def test_reset_without_estop_does_nothing():
    platform = engaged()
    platform.look(reset=True)
    assert platform.state == State.ENGAGED


def test_who_disengages_is_ready_again():
    platform = engaged()
    assert platform.ask("disengage")[0]
    assert platform.left.crtk == "DISABLED"
    platform.look()
    assert (platform.state, platform.left.engagement) == (State.READY, 1)


def test_of_several_operators_one_claims_and_the_second_is_refused():
    platform = ready(TWO)
    assert (platform.state, platform.left.reason, platform.left.advice) == (
        State.WAITING,
        "nobody holds the arm",
        "claim it",
    )
    assert "nobody holds" in platform.ask("engage")[1]
    assert platform.ask("claim", "assistant") == (True, "left: claim done: held by assistant")
    assert platform.ask("claim", "colleague") == (False, "left: claim refused: held by assistant")
    assert not platform.ask("engage", "colleague")[0]
    assert platform.state == State.READY
    assert platform.ask("engage", "assistant")[0]
    done, said = platform.ask("engage", "colleague")
    assert not done and "colleague does not hold the arm, assistant does" in said
    assert platform.state == State.ENGAGED
    assert not platform.ask("disengage", "colleague")[0] and platform.state == State.ENGAGED


def test_anybody_may_hold():
    platform = ready(TWO)
    platform.ask("claim", "assistant")
    platform.ask("engage", "assistant")
    assert platform.ask("hold", "colleague")[0] and platform.state == State.HOLD


def test_handing_over_takes_an_offer_an_acceptance_and_a_new_engagement():
    platform = ready(TWO)
    platform.ask("claim", "assistant")
    platform.ask("engage", "assistant")
    assert not platform.ask("accept", "colleague")[0], "nothing was offered"
    assert platform.ask("offer", "assistant", "colleague")[0] and platform.state == State.ENGAGED
    assert platform.ask("accept", "colleague")[0]
    assert platform.law.name_of(platform.left.holder) == "colleague"
    assert (platform.state, platform.left.reason) == (
        State.HOLD,
        "the console of assistant handed the arm over",
    )
    assert not platform.ask("engage", "assistant")[0]
    assert platform.ask("engage", "colleague")[0] and platform.left.engagement == 2


def test_a_new_holder_engages_when_his_console_has_taken_over():
    platform = ready(TWO, hand_over_looks=3)
    platform.ask("claim", "assistant")
    done, said = platform.ask("engage", "assistant")
    assert not done and "the console of assistant takes over" in said
    platform.look()
    assert platform.ask("engage", "assistant")[0]
    platform.ask("offer", "assistant", "colleague")
    assert platform.ask("accept", "colleague")[0]
    assert not platform.ask("engage", "colleague")[0] and platform.state == State.HOLD
    platform.look()
    assert platform.ask("engage", "colleague")[0]


def test_nobody_releases_what_another_one_holds():
    platform = ready(TWO)
    assert not platform.ask("release", "assistant")[0], "nobody holds it"
    platform.ask("claim", "assistant")
    assert platform.ask("release", "colleague") == (False, "left: release refused: held by assistant")
    assert platform.ask("release", "assistant")[0] and platform.left.holder == 0


def test_a_silent_holder_leaves_the_arm_to_nobody():
    platform = ready(TWO)
    platform.ask("claim", "assistant")
    platform.ask("engage", "assistant")
    platform.alive = [False, True]
    platform.look()
    assert (platform.state, platform.left.holder) == (State.HOLD, 0)
    assert "assistant is silent" in platform.left.reason
    platform.alive = [True, True]
    platform.look()
    assert platform.left.holder == 0, "it does not come back by itself"
    assert platform.ask("claim", "colleague")[0] and platform.ask("engage", "colleague")[0]


def test_a_sole_operator_gets_the_arm_back_but_not_the_engagement():
    platform = engaged()
    platform.alive = [False]
    platform.look()
    assert (platform.state, platform.left.holder) == (State.HOLD, 0)
    platform.alive = [True]
    platform.look()
    assert (platform.state, platform.left.holder) == (State.HOLD, 1)


def test_crtk_of_the_whole():
    assert crtk_of_all(["DISABLED", "DISABLED"]) == "DISABLED"
    assert crtk_of_all(["PAUSED", "DISABLED"]) == "PAUSED"
    assert crtk_of_all(["PAUSED", "ENABLED"]) == "ENABLED"
    assert crtk_of_all(["ENABLED", "FAULT"]) == "FAULT"
