"""Schema checks and the gate: pure, no sockets, time injected."""

from __future__ import annotations

import json
import math

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given
from mesa_link_peers import HOME, FakePlant

from saras import ConfigError
from saras.mesa_link import MessageError, Reason, State
from saras.mesa_link.commands import CommandTable
from saras.mesa_link.driver import load_driver
from saras.mesa_link.gate import CommandGate, GateConfig
from saras.mesa_link.lag import LagMeter
from saras.mesa_link.poses import angle_between, to_matrix, to_target
from saras.mesa_link.protocol import Header, Hello, TargetInEffect, command

FIELDS = {
    "tick": 7,
    "time_s": 1.5,
    "period_s": 0.005,
    "following": True,
    "controller": "x",
    "session": 3,
    "last_seq": 9,
    "dropped": {"expired": 2},
}


def state(**changes: object) -> State:
    sample = FakePlant().sample().__dict__ | {"target": TargetInEffect(3, 4, *HOME.__dict__.values())}
    return State(**{**sample, **FIELDS, **changes})


def test_state_survives_json() -> None:
    sent = state(wrench=(1.0, 2.0, 3.0, 0.0, 0.0, 0.0))
    assert State.parse(json.loads(json.dumps(sent.to_json()))) == sent
    assert "wrench" not in state().to_json()


@pytest.mark.parametrize(
    ("change", "reason", "words"),
    [
        ({"position": [1.0, 2.0]}, Reason.MALFORMED, "state.position: expected 3 numbers, got [1.0, 2.0]"),
        ({"position": [1.0, math.nan, 0.0]}, Reason.NON_FINITE, "state.position"),
        ({"quaternion": [0, 0, 0, 0]}, Reason.MALFORMED, "state.quaternion: expected a unit quaternion"),
        ({"joints": [1.0] * 5}, Reason.MALFORMED, "state.joints"),
        ({"jaw": 1.5}, Reason.MALFORMED, "state.jaw: expected a number in [0, 1], got 1.5"),
        ({"brakes": 1}, Reason.MALFORMED, "state.brakes: expected true or false, got 1"),
        ({"mode": "free"}, Reason.MALFORMED, "state.mode: expected pivot or parallel"),
        ({"tick": -1}, Reason.MALFORMED, "state.tick"),
        ({"target": 5}, Reason.MALFORMED, "state.target: expected one JSON object"),
    ],
)
def test_bad_fields_are_refused_by_name(change: dict[str, object], reason: str, words: str) -> None:
    with pytest.raises(MessageError, match=words.replace("[", r"\[").replace("]", r"\]")) as refusal:
        State.parse({**state().to_json(), **change})
    assert refusal.value.reason == reason


@given(
    st.recursive(
        st.none() | st.booleans() | st.floats() | st.text(), lambda x: st.lists(x) | st.dictionaries(st.text(), x)
    )
)
def test_any_json_is_parsed_or_refused(data: object) -> None:
    for parse in (State.parse, Hello.parse):
        with pytest.raises(MessageError):
            parse(data)


@given(
    st.sampled_from(sorted(state().to_json())),
    st.none() | st.booleans() | st.floats() | st.text() | st.lists(st.floats()),
)
def test_no_bad_float_gets_through(name: str, value: object) -> None:
    try:
        parsed = State.parse({**state().to_json(), name: value})
    except MessageError:
        return
    numbers = [*parsed.joints, *parsed.position, *parsed.quaternion, *parsed.rcm, parsed.jaw, parsed.time_s]
    assert np.isfinite(numbers).all()


def test_other_protocol_version_is_refused() -> None:
    with pytest.raises(MessageError, match="speaks 1, got 2"):
        Hello.parse({"protocol": 2, "client": "x", "control": True})


# -- the gate ------------------------------------------------------------------------------------------------------


def gate() -> CommandGate:
    made = CommandGate(GateConfig(command_age_limit_s=0.15, target_timeout_s=0.1, heartbeat_timeout_s=0.3), 1000)
    for tick in range(1, 11):
        made.note_state(tick, 0.005 * tick)
    return made


def header(session: int, seq: int = 1, echo_tick: int = 10, max_age_s: float = 0.1) -> Header:
    return Header(session, seq, echo_tick, max_age_s)


def refused(made: CommandGate, sent: Header, now_s: float, client: str = "a") -> str:
    with pytest.raises(MessageError) as refusal:
        made.admit(client, sent, now_s)
    return str(refusal.value.reason)


def test_only_new_commands_of_this_session_pass() -> None:
    made = gate()
    session = made.take_control("a", "A", 0.05)
    made.admit("a", header(session, 5), 0.06)
    assert refused(made, header(session, 5), 0.06) == Reason.REPLAYED
    assert refused(made, header(session, 4), 0.06) == Reason.REPLAYED
    assert refused(made, header(session - 1, 6), 0.06) == Reason.OLD_SESSION
    assert refused(made, header(session, 6, echo_tick=11), 0.06) == Reason.MALFORMED
    assert refused(made, header(session, 6), 0.06, client="b") == Reason.NOT_IN_CONTROL
    made.admit("a", header(session, 6), 0.06)


def test_age_is_that_of_the_echoed_state_on_the_arms_clock() -> None:
    made = gate()
    session = made.take_control("a", "A", 0.05)
    made.admit("a", header(session, 1, echo_tick=10, max_age_s=0.1), 0.149)
    assert refused(made, header(session, 2, echo_tick=10, max_age_s=0.1), 0.151) == Reason.EXPIRED
    # A client may ask for less, never for more than the arm's own limit.
    assert refused(made, header(session, 3, echo_tick=10, max_age_s=9.0), 0.201) == Reason.EXPIRED


def test_a_tick_that_is_no_longer_remembered_is_expired() -> None:
    made = CommandGate(GateConfig(ticks_remembered=5), 1)
    session = made.take_control("a", "A", 0.0)
    for tick in range(1, 11):
        made.note_state(tick, 0.0)
    assert refused(made, header(session, 1, echo_tick=5), 0.0) == Reason.EXPIRED


def test_one_controller_and_never_the_same_session_twice() -> None:
    made = gate()
    first = made.take_control("a", "A", 0.05)
    with pytest.raises(MessageError, match="'A' is in control"):
        made.take_control("b", "B", 0.06)
    made.release("b")  # not the holder: nothing happens
    assert made.controller == "A"
    made.release("a")
    assert made.take_control("b", "B", 0.07) == first + 1
    assert refused(made, header(first), 0.07) == Reason.NOT_IN_CONTROL


def test_watchdogs_hold_then_release() -> None:
    made = gate()
    session = made.take_control("a", "A", 0.05)
    assert not made.step(0.05)
    made.target_accepted(0.06)
    assert made.step(0.16) and not made.step(0.161)
    assert made.session == session
    made.step(0.36)
    assert made.session == 0 and made.controller == ""
    assert refused(made, header(session, 9), 0.36) == Reason.NOT_IN_CONTROL


def test_refused_command_feeds_no_watchdog() -> None:
    made = gate()
    session = made.take_control("a", "A", 0.05)
    for seq in range(1, 20):
        refused(made, header(session, seq, echo_tick=1, max_age_s=0.001), 0.3)
    made.step(0.36)
    assert made.session == 0


@pytest.mark.parametrize("name", ["command_age_limit_s", "target_timeout_s", "heartbeat_timeout_s"])
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_gate_config_names_the_field(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=name):
        GateConfig(**{name: value})


def test_unreachable_target_keeps_the_last_one_and_the_arm_following() -> None:
    plant, made = FakePlant(), gate()
    table = CommandTable(plant, made)
    session = made.take_control("a", "A", 0.05)
    table.obey("set_target", "a", command(header(session, 1), HOME), 0.06)
    far = {**command(header(session, 2), HOME), "position": [9.0, 0.0, 0.0]}
    with pytest.raises(MessageError) as refusal:
        table.obey("set_target", "a", far, 0.12)
    assert refusal.value.reason == Reason.UNREACHABLE
    assert plant.target == HOME and table.in_effect == (session, 1) and made.step(0.2)


def test_rcm_mode_and_brake_only_at_rest() -> None:
    plant, made = FakePlant(), gate()
    table = CommandTable(plant, made)
    session = made.take_control("a", "A", 0.05)
    table.obey("set_rcm", "a", command(header(session, 1), position=[0.1, 0.0, 0.0]), 0.06)
    table.obey("set_target", "a", command(header(session, 2), HOME), 0.06)
    for seq, (event, fields) in enumerate(
        {"set_rcm": {"position": [0, 0, 0]}, "set_mode": {"mode": "parallel"}, "brake": {"on": False}}.items()
    ):
        with pytest.raises(MessageError, match="while the arm holds"):
            table.obey(event, "a", command(header(session, 3 + seq), **fields), 0.07)
    assert (plant.rcm, plant.mode, plant.brakes) == ((0.1, 0.0, 0.0), "pivot", True)


# -- small parts ---------------------------------------------------------------------------------------------------


@given(st.lists(st.floats(-1, 1), min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 1e-3))
def test_quaternion_round_trip(values: list[float]) -> None:
    quaternion = tuple((np.array(values) / np.linalg.norm(values)).tolist())
    target = to_target(to_matrix((1.0, 2.0, 3.0), quaternion))
    assert angle_between(target.quaternion, quaternion) < 1e-7
    assert target.position == (1.0, 2.0, 3.0)


def test_what_is_no_pose_is_refused() -> None:
    for bad in (np.eye(3), np.full((4, 4), np.nan), np.diag([1.0, 1.0, -1.0, 1.0]), 2 * np.eye(4)):
        with pytest.raises(ValueError, match="pose"):
            to_target(bad)


def test_lag_is_backlog_not_delay() -> None:
    meter = LagMeter()
    for k in range(100):
        assert meter.step(1000.0 + 0.005 * k + 0.05, 0.005 * k) < 1e-6  # constant delay, clocks far apart
    assert meter.step(1000.0 + 3.5, 0.5) == pytest.approx(2.95, abs=1e-2)


def test_unknown_driver_lists_known_ones() -> None:
    with pytest.raises(ConfigError, match=r"no arm driver named 'acme'; there are: .*socketio"):
        load_driver("acme")


def test_a_vendors_plug_in_is_found_by_its_entry_point(monkeypatch: pytest.MonkeyPatch) -> None:
    from importlib.metadata import EntryPoint

    from saras.mesa_link import driver

    points = [EntryPoint("acme", "collections:OrderedDict", driver.ENTRY_POINT_GROUP)]
    monkeypatch.setattr(driver, "entry_points", lambda group: points if group == driver.ENTRY_POINT_GROUP else [])
    assert load_driver("acme").__name__ == "OrderedDict"
