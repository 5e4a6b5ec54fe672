"""CRTK without ROS: every transition of the table, and what the simulated arm does with commands."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from saras.crtk import COMMANDS, MODES, STATES, MotionLimits, PointToPoint, SimulatedCrtkArm, StateMachine, Surgeon
from saras.crtk.surgeon import joints_for_tip
from saras.kinematics import dvrk

# Written out again, as CRTK prints it: "-" stays, None is invalid.
TABLE = {
    "DISABLED": {"enable": "ENABLED", "disable": "-", "pause": None, "resume": None},
    "ENABLED": {"enable": "-", "disable": "DISABLED", "pause": "PAUSED", "resume": None},
    "PAUSED": {"enable": None, "disable": "DISABLED", "pause": "-", "resume": "ENABLED"},
    "FAULT": {"enable": "ENABLED", "disable": "DISABLED", "pause": None, "resume": None},
}
START = np.array([0.0, 0.0, 0.1, 0.0, 0.0, 0.0])
LIMITS = MotionLimits(np.array([1, 1, 0.2, 3, 3, 3.0]), np.array([4, 4, 0.8, 12, 12, 12.0]))
DT = 0.01


def psm(state="ENABLED", homed=True):
    return SimulatedCrtkArm(
        "PSM1", dvrk.psm(), START, LIMITS, jaw=(-0.698, 1.396), machine=StateMachine(state, is_homed=homed)
    )


def run(arm, seconds):
    for _ in range(round(seconds / DT)):
        arm.step(DT)


@pytest.mark.parametrize(("state", "command"), itertools.product(STATES, ("enable", "disable", "pause", "resume")))
def test_every_transition(state, command):
    machine = StateMachine(state, is_homed=True)
    expected = TABLE[state][command]
    if expected is None:
        with pytest.raises(ValueError, match=f"'{command}' is invalid in state {state}"):
            machine.command(command)
        assert machine.state == state
    else:
        machine.command(command)
        assert machine.state == (state if expected == "-" else expected)
    assert machine.is_homed


@pytest.mark.parametrize(("state", "command"), itertools.product(STATES, ("home", "unhome")))
def test_homing(state, command):
    machine = StateMachine(state, is_homed=command == "unhome")
    if state in ("PAUSED", "FAULT"):
        with pytest.raises(ValueError, match=state):
            machine.command(command)
    else:
        machine.command(command)
        assert machine.is_homed == (command == "home")
        assert machine.state == ("ENABLED" if command == "home" else state)
    with pytest.raises(ValueError, match=f"must be one of {', '.join(COMMANDS)}"):
        machine.command("dance")


@pytest.mark.parametrize("state", STATES)
def test_motion_only_when_enabled_and_homed(state):
    for homed in (True, False):
        arm = psm(state, homed)
        obeyed = arm.command("move_jp", START + np.array([0.1, 0, 0, 0, 0, 0]))
        assert obeyed == (state == "ENABLED" and homed)
        run(arm, 2.0)
        assert (arm.joints.q[0] == 0.1) == obeyed
        if not obeyed:
            ((level, text),) = arm.take_events()
            assert level == "error" and state in text and "move_jp refused" in text


def test_disabling_stops_a_move_where_it_is():
    arm = psm()
    arm.command("move_jp", START + np.array([0.5, 0, 0, 0, 0, 0]))
    run(arm, 0.2)
    moved = arm.joints.q.copy()
    assert 0.0 < moved[0] < 0.5 and arm.machine.is_busy
    arm.state_command("disable")
    run(arm, 1.0)
    np.testing.assert_array_equal(arm.joints.q, moved)
    assert arm.take_states() == [("ENABLED", True, False), ("ENABLED", True, True), ("DISABLED", True, False)]


def test_each_move_says_busy_anew_and_its_end_whether_it_got_there():
    arm = psm()
    arm.take_states()
    up, down = ("ENABLED", True, True), ("ENABLED", True, False)
    assert arm.command("move_jp", START + 0.01)
    assert arm.command("move_jp", START)  # a client waits for a busy state that is younger than its command
    assert arm.jaw_command("move_jp", [0.5])
    assert arm.take_states() == [up, up, up]
    run(arm, 2.0)
    assert (arm.take_states(), arm.take_ends()) == ([down], [True])
    for end in (lambda: arm.command("servo_jp", START), lambda: arm.state_command("disable")):
        assert arm.command("move_jp", START + 0.01)
        assert end()
        assert arm.take_ends() == [False]


def test_ratios_slow_moves_but_not_the_surgeon():
    def duration_s(arm, goal):
        assert arm.command("move_jp", goal)
        begin = arm.time_s
        while arm.machine.is_busy:
            arm.step(DT)
        return arm.time_s - begin

    arm, away = psm(), START + np.array([0.5, 0, 0, 0, 0, 0])
    full = duration_s(arm, away)
    assert arm.set_ratio(0.25)
    assert duration_s(arm, START) > 2.0 * full  # at least by the root of the ratio
    arm.follow(away)
    run(arm, full + 0.1)
    np.testing.assert_allclose(arm.joints.q, away, atol=1e-9)
    assert arm.set_ratio(1.0, acceleration=False)
    assert arm.ratios == (1.0, 0.25)
    for wrong in (0.0, -1.0, 1.01, np.nan):
        assert not arm.set_ratio(wrong)
        assert "must be in (0, 1]" in arm.take_events()[-1][1]
    assert arm.ratios == (1.0, 0.25)


def test_busy_goes_up_and_down_even_for_a_move_to_where_it_is():
    arm = psm()
    arm.take_states()
    arm.command("move_jp", START)
    run(arm, 0.02)
    assert arm.take_states() == [("ENABLED", True, True), ("ENABLED", True, False)]


def test_move_keeps_speed_and_acceleration_and_arrives_in_a_straight_line(many):
    random = np.random.default_rng(1)
    for _ in range(20 * many):
        arm = psm()
        lower, upper = arm.kinematics.limits.T
        goal = random.uniform(lower, upper)
        arm.command("move_jp", goal)
        path, rates = [arm.joints.q], [arm.joints.v]
        while arm.machine.is_busy:
            arm.step(DT)
            path.append(arm.joints.q)
            rates.append(arm.joints.v)
            assert len(path) < 2000
        path, rates = np.array(path), np.array(rates)
        np.testing.assert_array_equal(path[-1], goal)
        steps = np.abs(np.diff(path, axis=0)) / DT
        assert (steps <= LIMITS.speed * (1 + 1e-9)).all()
        assert (np.abs(np.diff(rates, axis=0)) <= LIMITS.acceleration * DT * (1 + 1e-9)).all()
        share = (path - START) / (goal - START)
        assert np.ptp(share, axis=1).max() < 1e-2  # all joints on their way alike


def test_new_goal_in_motion_does_not_jump():
    motion = PointToPoint([0.0], [1.0], [4.0])
    motion.go([1.0])
    speeds = []
    for k in range(400):
        if k == 30:
            motion.go([-0.5])
        motion.step(DT)
        speeds.append(motion.v[0])
    assert motion.arrived and motion.q[0] == -0.5
    assert np.abs(np.diff(speeds)).max() <= 4.0 * DT * (1 + 1e-9)


def test_servo_acts_at_once_and_interpolate_within_its_period():
    arm = psm()
    goal = START + np.array([0.1, -0.05, 0.02, 0.3, 0.2, -0.1])
    assert arm.command("servo_jp", goal)
    np.testing.assert_array_equal(arm.joints.q, goal)
    assert arm.command("servo_jr", [0.01, 0, 0, 0, 0, 0])
    assert arm.joints.q[0] == pytest.approx(0.11)
    assert arm.command("interpolate_jp", START)
    arm.step(DT)
    assert 0.0 < arm.joints.q[0] < 0.11
    run(arm, 0.1)
    np.testing.assert_allclose(arm.joints.q, START, atol=1e-12)
    assert arm.command("servo_jv", [0.5, 0, 0, 0, 0, 0])
    run(arm, 1.0)  # not repeated: it ends by itself
    assert 0.04 < arm.joints.q[0] < 0.07


def test_cartesian_commands_are_in_the_reference_frame():
    arm = psm()
    arm.reference_T_base = np.array([[0, -1, 0, 0.3], [1, 0, 0, -0.1], [0, 0, 1, 0.2], [0, 0, 0, 1.0]])
    goal = arm.forward(START)
    goal[:3, 3] += [0.01, 0.02, -0.005]
    assert arm.command("servo_cp", goal)
    np.testing.assert_allclose(arm.forward(arm.joints.q), goal, atol=1e-9)
    step = np.eye(4)
    step[:3, 3] = [0.0, 0.0, -0.01]
    assert arm.command("move_cr", step)
    run(arm, 1.0)
    np.testing.assert_allclose(arm.forward(arm.joints.q)[:3, 3], goal[:3, 3] + [0, 0, -0.01], atol=1e-9)
    before = arm.forward(arm.joints.q)
    assert arm.command("servo_cv", [0.02, 0, 0, 0, 0, 0])
    run(arm, 0.05)
    moved = arm.forward(arm.joints.q)[:3, 3] - before[:3, 3]
    np.testing.assert_allclose(moved, [0.001, 0, 0], atol=1e-4)


@pytest.mark.parametrize(
    ("command", "value", "words"),
    [
        ("move_jp", [0, 0, 0.3, 0, 0, 0], "insertion [m] = 0.3: must be in [0, 0.24]"),
        ("move_jp", [0, 0, 0.1], "3 values: must be 6"),
        ("servo_jp", [0, np.nan, 0.1, 0, 0, 0], "must be finite"),
        ("move_cp", np.diag([1, 1, 1, 1.0]) + np.array([[0, 0, 0, 0.9]] + [[0.0] * 4] * 3), "must be in ["),
        ("servo_cp", np.full((4, 4), np.inf), "finite (4, 4)"),
        ("servo_cp", np.zeros((4, 4)), "unit quaternion"),
        ("servo_cv", [0, 0], "2 values: must be 6"),
        ("leap_jp", START, "no such command"),
    ],
)
def test_bad_commands_are_refused_and_reported(command, value, words):
    arm = psm()
    assert not arm.command(command, value)
    ((level, text),) = arm.take_events()
    assert level == "error" and words in text and text.startswith(f"PSM1: {command} refused")
    run(arm, 0.5)
    np.testing.assert_array_equal(arm.joints.q, START)
    assert not arm.machine.is_busy


def test_a_stream_beyond_a_limit_is_clipped_and_says_so_once():
    arm = psm()
    for k in range(5):
        assert arm.command("servo_jp", [0, 0, 0.23 + 0.01 * k, 0, 0, 0])
    assert arm.joints.q[2] == 0.24
    ((level, text),) = arm.take_events()
    assert level == "warning" and "insertion [m] = 0.25" in text


def test_jaw():
    arm = psm()
    arm.take_states()
    assert arm.jaw_command("move_jp", [1.0])
    assert arm.command("servo_jp", START)  # the arm's own command does not end the jaw's
    assert arm.machine.is_busy
    run(arm, 1.0)
    assert arm.jaw.q[0] == 1.0
    assert arm.take_states() == [("ENABLED", True, True), ("ENABLED", True, False)]
    assert arm.jaw_command("servo_jp", [9.0])
    assert arm.jaw.q[0] == 1.396
    assert not arm.jaw_command("move_jp", [9.0]) and not arm.jaw_command("move_jp", [0.1, 0.2])
    assert [level for level, _ in arm.take_events()] == ["warning", "error", "error"]
    ecm = SimulatedCrtkArm("ECM", dvrk.ecm(), [0, 0, 0.1, 0], MotionLimits(np.ones(4), np.ones(4)))
    assert not ecm.jaw_command("servo_jp", [0.1])


@pytest.mark.parametrize("mode", [mode for mode in MODES if mode != "clap"])
def test_surgeon_repeats_itself_moves_without_jumps_and_keeps_away(mode):
    home = {"PSM1": (-0.02, 0.04, 0.145), "PSM2": (-0.02, -0.04, 0.145), "ECM": (0.03, 0.0, 0.165)}
    tool, bone = np.array([-0.05, 0.1, 0.14]), np.array([0.05, 0.02, 0.035])
    first, second = (Surgeon(mode, 7, home, closest_m=0.008) for _ in range(2))
    for name in home:
        path = np.array([first.tip(name, 0.01 * k, tool, bone) for k in range(4000)])
        np.testing.assert_array_equal(path[::50], [second.tip(name, 0.5 * k, tool, bone) for k in range(80)])
        assert np.linalg.norm(np.diff(path, axis=0), axis=1).max() < 0.0006  # 60 mm/s
        if mode == "meet" and name != "ECM":
            for target in (tool, bone):
                assert np.linalg.norm(path - target, axis=1).min() == pytest.approx(0.008, abs=1e-4)


def test_at_a_clap_psm1_jumps_at_each_full_second_and_nobody_else():
    home = {"PSM1": (-0.02, 0.04, 0.145), "PSM2": (-0.02, -0.04, 0.145), "ECM": (0.03, 0.0, 0.165)}
    surgeon, begin = Surgeon("clap", 1, home), 1_700_000_000.0
    times = begin + np.arange(0.0, 3.0, 0.05)
    lifted = np.array([surgeon.tip("PSM1", t)[2] - home["PSM1"][2] > 0.001 for t in times])
    assert np.array_equal(lifted, (times - begin + 1e-6) % 1.0 < 0.3)
    for name in ("PSM2", "ECM"):
        assert all(np.array_equal(surgeon.tip(name, t), home[name]) for t in times)


def test_joints_for_a_tip_have_a_straight_wrist():
    base_T_world = np.eye(4)
    for arm in (dvrk.psm(), dvrk.ecm()):
        q = joints_for_tip(arm, base_T_world, np.array([0.02, 0.03, -0.12]), 0.4)
        np.testing.assert_allclose(arm.forward(q)[:3, 3], [0.02, 0.03, -0.12], atol=1e-12)
        assert arm.limit_violation(q) == ""
    with pytest.raises(ValueError, match="remote centre"):
        joints_for_tip(dvrk.psm(), base_T_world, np.zeros(3))
    with pytest.raises(ValueError, match="mode = 'sleep'"):
        Surgeon("sleep", 1, {})
