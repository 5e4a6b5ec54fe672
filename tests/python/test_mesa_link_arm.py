"""The simulated arm as a plant, and the content check."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from mesa_link_peers import HOME, FakePlant

from saras import ConfigError
from saras.kinematics import mesa, scene
from saras.mesa_link import MaxVelocity, MessageError, Reason, Received, State, Target, Tool
from saras.mesa_link.guard import StateGuard, StateGuardConfig
from saras.mesa_link.protocol import TargetInEffect
from saras.mesa_link.scene import simulated_arm
from saras.mesa_link.simulated_arm import SimulatedArm

SCENE = Path(__file__).resolve().parents[2] / "config" / "scene.yaml"
PERIOD_S = 0.005
RCM = tuple(mesa.NOMINAL_RCM.tolist())


def moved(target: Target, dx: float = 0.0, dy: float = 0.0, dz: float = 0.0) -> Target:
    x, y, z = target.position
    return Target((x + dx, y + dy, z + dz), target.quaternion)


def here(arm: SimulatedArm) -> Target:
    sample = arm.sample()
    return Target(sample.position, sample.quaternion)


def run(arm: SimulatedArm, seconds: float) -> list[np.ndarray]:
    tips = []
    for _ in range(round(seconds / PERIOD_S)):
        arm.step(PERIOD_S)
        tips.append(np.array(arm.sample().position))
    return tips


def test_tip_reaches_its_target_through_the_trocar_within_the_speed_bound() -> None:
    arm = SimulatedArm(RCM, bounds=MaxVelocity(0.05, 1.0))
    start = here(arm)
    goal = moved(start, 0.01, 0.02, -0.01)
    arm.follow(goal)
    tips = run(arm, 2.0)
    assert np.allclose(tips[-1], goal.position, atol=1e-6)
    assert arm.truth(0).rcm_deviation_m < 1e-4
    steps = np.linalg.norm(np.diff(tips, axis=0), axis=1)
    assert steps.max() <= 0.05 * PERIOD_S * 1.01


def test_reported_joints_pose_and_target_agree() -> None:
    arm = SimulatedArm(RCM)
    arm.follow(moved(here(arm), 0.005))
    run(arm, 1.0)
    sample = arm.sample()
    pose = mesa.arm().forward(sample.joints)
    assert np.allclose(pose[:3, 3], sample.position, atol=1e-12)
    assert np.allclose(sample.target.position, sample.position, atol=1e-6)
    assert mesa.arm().rcm_deviation(sample.joints, sample.rcm) < 1e-6


def test_hold_stops_where_the_arm_is() -> None:
    arm = SimulatedArm(RCM)
    arm.follow(moved(here(arm), 0.03))
    run(arm, 0.2)
    stopped = np.array(here(arm).position)
    arm.hold()
    assert np.linalg.norm(run(arm, 1.0)[-1] - stopped) < 1e-3
    assert stopped[0] < RCM[0] + 0.03 - 0.003  # it was on its way


@pytest.mark.parametrize("target", [(0.18, 0.0, -0.105), (0.18, 0.0, 0.2), (0.18, 0.3, -0.15), (9.0, 9.0, 9.0)])
def test_unreachable_targets_are_refused_with_the_reason_and_change_nothing(target: tuple[float, ...]) -> None:
    arm = SimulatedArm(RCM)
    before = arm.sample().target
    with pytest.raises(MessageError, match="set_target: ") as refusal:
        arm.follow(Target(target, here(arm).quaternion))
    assert refusal.value.reason == Reason.UNREACHABLE
    arm.step(PERIOD_S)
    assert arm.sample().target == before


def test_tool_turns_and_opens_and_the_roll_command_wins() -> None:
    arm = SimulatedArm(RCM)
    arm.move_tool(Tool(1.0, 0.5, 0.6, 1.0))
    tips = run(arm, 1.0)
    assert arm.sample().jaw == pytest.approx(0.5, abs=0.02)
    run(arm, 2.0)
    sample = arm.sample()
    assert (sample.jaw, sample.joints[5]) == (pytest.approx(1.0), pytest.approx(0.6, abs=1e-3))
    arm.follow(here(arm))  # its own orientation: the commanded roll stays
    run(arm, 1.0)
    assert arm.sample().joints[5] == pytest.approx(0.6, abs=1e-3)
    assert np.linalg.norm(tips[-1] - tips[0]) < 1e-6


def test_tissue_pushes_back_and_the_sensor_says_so() -> None:
    arm = simulated_arm(SCENE, "mesa_left", sensor=True)
    depth_before = arm.truth(0).depth_m
    assert depth_before < 0.0, "the arm starts above the phantom"
    press = -depth_before + 0.01
    start = here(arm)
    for k in range(1, 21):
        arm.follow(moved(start, dz=-press * k / 20))
        run(arm, 0.1)
    run(arm, 1.0)
    sample, truth = arm.sample(), arm.truth(7)
    assert truth.tick == 7 and 0.005 < truth.depth_m < 0.01
    assert truth.tip_force[2] < -1.0  # exerted on the tissue: downwards
    assert np.allclose(sample.wrench[:3], truth.tip_force, atol=0.15)
    # Static balance of the servo: F = m w^2 (target - measured), here along the shaft.
    servo_force = 2.0 * 60.0**2 * (np.array(sample.target.position) - np.array(sample.position))
    assert np.allclose(servo_force, truth.tip_force, rtol=0.05, atol=0.1)


def test_scene_gives_both_arms_their_trocar_and_positioning_arm() -> None:
    place = scene.load(SCENE)
    for name in ("mesa_left", "mesa_right"):
        sample = simulated_arm(SCENE, name).sample()
        assert np.allclose(sample.rcm, place.arms[name].rcm)
        assert np.allclose(sample.passive, place.arms[name].passive_joints)
        assert math.copysign(1.0, sample.joints[1]) == place.arms[name].elbow
    with pytest.raises(ConfigError, match=r"arms\.mesa_up: no such arm; there are: mesa_left, mesa_right"):
        simulated_arm(SCENE, "mesa_up")


def test_same_seed_same_run() -> None:
    def states() -> list[object]:
        arm = simulated_arm(SCENE, "mesa_right", seed=3)
        arm.follow(moved(here(arm), 0.004))
        return [arm.sample() for _ in range(50) if arm.step(PERIOD_S) is None]

    assert states() == states()


def test_trocar_far_from_the_shaft_is_refused_and_a_near_one_is_approached_slowly() -> None:
    arm = SimulatedArm(RCM)
    with pytest.raises(MessageError, match="the shaft passes 50"):
        arm.set_rcm((RCM[0] + 0.05, RCM[1], RCM[2]))
    arm.set_rcm((RCM[0] + 0.01, RCM[1], RCM[2]))
    tips = run(arm, 0.1)
    assert arm.sample().rcm[0] == pytest.approx(RCM[0] + 0.002)
    tips += run(arm, 1.0)
    assert arm.sample().rcm[0] == pytest.approx(RCM[0] + 0.01)
    assert np.abs(np.array(tips) - tips[0]).max() < 1e-4  # the tip stays while the shaft tilts


# -- the content check ---------------------------------------------------------------------------------------------


def state(tick: int, **changes: object) -> State:
    sample = FakePlant().sample().__dict__ | {"target": TargetInEffect(3, tick, *HOME.__dict__.values())}
    life = {"joints": (1e-6 * tick,) * 6, "time_s": PERIOD_S * tick, "last_seq": tick, "session": 3, "following": True}
    rest = {"tick": tick, "period_s": PERIOD_S, "controller": "x"}
    return State(**{**sample, **rest, **life, **changes})


def feed(guard: StateGuard, states: list[State], lag_s: float = 0.0) -> list[str]:
    refusals = []
    for each in states:
        try:
            guard.check(Received(each, each.time_s, lag_s))
            refusals.append("")
        except ValueError as error:
            refusals.append(str(error))
    return refusals


def guard() -> StateGuard:
    return StateGuard(StateGuardConfig())


def test_a_living_arm_is_believed() -> None:
    assert feed(guard(), [state(k) for k in range(1, 500)]) == [""] * 499
    # At rest, nobody in control: nothing need change.
    assert set(feed(guard(), [state(k, joints=(0.0,) * 6, session=0, following=False) for k in range(1, 500)])) == {""}
    # Coarse encoders at rest under a living link: the count of commands moves.
    assert set(feed(guard(), [state(k, joints=(0.0,) * 6) for k in range(1, 500)])) == {""}


@pytest.mark.parametrize(("following", "limit_s"), [(True, 0.1), (False, 0.5)])
def test_frozen_content_is_noticed_in_time(following: bool, limit_s: float) -> None:
    kept = state(10, following=following)
    frozen = [replace(kept, tick=k, time_s=PERIOD_S * k) for k in range(10, 400)]
    refusals = feed(guard(), frozen)
    first = next(i for i, text in enumerate(refusals) if text)
    assert first == round(limit_s / PERIOD_S) + 1 and "frozen: nothing changed" in refusals[first]
    assert all(refusals[first:])


def test_frozen_tick_and_frozen_encoders_are_noticed() -> None:
    assert feed(guard(), [state(5), state(5)])[1] == "frozen: tick 5 again"
    driven = []
    for k in range(1, 200):
        target = TargetInEffect(3, k, (HOME.position[0] + 1e-4 * k, *HOME.position[1:]), HOME.quaternion)
        driven.append(state(k, joints=(0.0,) * 6, target=target))
    assert "joints unchanged" in feed(guard(), driven)[-1]


def test_jump_is_refused_until_the_new_place_has_settled() -> None:
    away = (HOME.position[0] + 0.051, *HOME.position[1:])
    states = [state(k) for k in range(1, 10)] + [state(k, position=away) for k in range(10, 300)]
    refusals = feed(guard(), states)
    assert refusals[8] == "" and refusals[9] == "the tip jumped 51 mm between two states"
    assert all(refusals[9 : 9 + 199]) and refusals[-1] == ""
    near = (HOME.position[0] + 0.049, *HOME.position[1:])
    assert set(feed(guard(), [state(1), state(2, position=near)])) == {""}


def test_backlog_and_reported_faults_are_refused_and_a_restarted_arm_is_not() -> None:
    assert "120 ms late" in feed(guard(), [state(1)], lag_s=0.12)[0]
    assert "overheated" in feed(guard(), [state(1, fault="overheated")])[0]
    assert feed(guard(), [state(900), state(1), state(2)]) == ["", "", ""]


@pytest.mark.parametrize("name", list(StateGuardConfig().__dict__))
@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf])
def test_guard_config_names_the_field(name: str, value: float) -> None:
    with pytest.raises(ConfigError, match=name):
        StateGuardConfig(**{name: value})
