"""Contact states: the table, chattering contacts, synchronisation, and passivity with the tank over delay."""

from __future__ import annotations

from collections import deque
from itertools import product

import numpy as np
import pytest
from csa_rig import DT, Arm, motion_config, slave_config
from hypothesis import given, settings
from hypothesis import strategies as st
from teleop_strategies import FAULTY_DT, spoilt

import saras
from saras import csa
from saras.csa import ContactState, SlaveMode, Synchronisation
from saras.kinematics import dvrk
from saras.sim import Operator, OperatorConfig
from saras.teleop import EnergyTank, EnergyTankConfig

NO, PROXY, SLAVE, FULL = (
    ContactState.NO_CONTACT, ContactState.PROXY_CONTACT, ContactState.SLAVE_CONTACT, ContactState.FULL_CONTACT,
)  # fmt: skip
#: state -> slave touches, proxy touches, the master feels, how the slave moves
MEANING = {
    NO: (False, False, False, SlaveMode.POSITION),
    PROXY: (False, True, True, SlaveMode.HYBRID),
    SLAVE: (True, False, False, SlaveMode.ADMITTANCE),
    FULL: (True, True, True, SlaveMode.HYBRID),
}
UP = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize(("before", "after"), list(product(MEANING, MEANING)))
def test_the_sixteen_transitions(before: ContactState, after: ContactState) -> None:
    slave, proxy, feels, mode = MEANING[after]
    row = csa.contact_transition(before, slave, proxy)
    assert (row.state, row.master_feels, row.mode) == (after, feels, mode)
    expected = Synchronisation.NEVER
    if after == NO and before in (PROXY, SLAVE):
        expected = Synchronisation.ALWAYS
    elif after == NO and before == FULL:
        expected = Synchronisation.WHEN_MISMATCHED
    assert row.synchronise == expected


def signals(state: ContactState) -> tuple[float, float]:
    slave, proxy, *_ = MEANING[state]
    return (2.0 if slave else 0.0), (0.003 if proxy else -0.003)


class Loop:
    """Master hand, CsaTeleop, slave and proxy (PSMs), contacts as told."""

    def __init__(self) -> None:
        self.psm, self.law = dvrk.psm(), csa.CsaTeleop(csa.CsaTeleopConfig())
        self.slave = csa.SlaveMlc(slave_config())
        self.proxy = csa.ProxySlave(motion_config())
        self.arm = Arm(300.0)
        self.q_proxy = self.arm.q.copy()
        self.master = np.eye(4)

    def step(self, force: float, depth: float, wrench: np.ndarray, **inputs) -> csa.CsaTeleopOutput:
        proxy_pose = self.psm.forward(self.q_proxy)
        output = self.law.step(
            self.master, self.arm.pose(), proxy_pose, DT, force, depth, UP, np.r_[wrench, 0, 0, 0], **inputs
        )
        if output.synchronise:
            self.q_proxy = self.arm.q.copy()
        if not output.hold:
            at = self.psm.forward(self.q_proxy)
            moved = self.proxy.step(self.q_proxy, self.psm.jacobian(self.q_proxy), at, output.desired, DT)
            self.q_proxy = moved.q
            self.arm.q = self.slave.step(
                self.arm.q, self.arm.jacobian(), self.arm.pose(), output.desired, DT,
                tissue_wrench=np.r_[-force * UP, 0, 0, 0], mode=output.mode, normal=output.normal,
                desired_force_N=output.desired_force_N,
            ).motion.q  # fmt: skip
        return output

    def mismatch(self) -> float:
        return float(np.linalg.norm((self.psm.forward(self.q_proxy) - self.arm.pose())[:3, 3]))


@given(st.data())
@settings(max_examples=25)
def test_no_step_of_force_or_set_point_under_chattering_contact(data: st.DataObject) -> None:
    """Contacts that come and go at random, the wrench wanted jumping with them."""
    loop, config, limits = Loop(), csa.CsaTeleopConfig(), motion_config()
    rng = np.random.default_rng(data.draw(st.integers(0, 10**6)))
    previous, q, seen = np.zeros(6), loop.arm.q.copy(), set()
    state, force, depth = NO, 0.0, -0.003
    chatter = data.draw(st.sampled_from([0.02, 0.5]))
    for _ in range(600):
        if rng.random() < chatter:
            force, depth = signals(list(MEANING)[rng.integers(4)])
        loop.master[:3, 3] += rng.normal(size=3) * 2e-4
        output = loop.step(force, depth, rng.normal(size=3) * 20.0)
        seen.add((state, output.state))
        state = output.state
        assert np.linalg.norm(output.wrench[:3] - previous[:3]) <= config.force_limit_N * DT / config.ramp_s + 1e-9
        assert (np.abs(loop.arm.q - q) <= limits.speed * DT + 1e-12).all()
        previous, q = output.wrench, loop.arm.q.copy()
    assert len(seen) > 1 or chatter == 0.5  # the debounce lets nothing through


def test_all_sixteen_transitions_are_walked_without_a_step() -> None:
    loop, config, limits = Loop(), csa.CsaTeleopConfig(), motion_config()
    walked, previous, q, state = set(), np.zeros(6), loop.arm.q.copy(), NO
    order = [b for a in MEANING for b in MEANING for b in (a, b)]
    for target in order:
        force, depth = signals(target)
        for _ in range(60):
            loop.master[:3, 3] += [1e-5, 0, -1e-5]
            output = loop.step(force, depth, 3.0 * UP)
            walked.add((state, output.state))
            state = output.state
            assert np.linalg.norm((output.wrench - previous)[:3]) <= config.force_limit_N * DT / config.ramp_s + 1e-9
            assert (np.abs(loop.arm.q - q) <= limits.speed * DT + 1e-12).all()
            previous, q = output.wrench, loop.arm.q.copy()
        assert state == target
    assert {(a, b) for a in MEANING for b in MEANING} <= walked


@pytest.mark.parametrize("before", [PROXY, SLAVE, FULL])
def test_mismatch_is_zero_after_synchronisation(before: ContactState) -> None:
    loop = Loop()
    force, depth = signals(before)
    for _ in range(300):
        loop.master[:3, 3] += [0, 0, -1e-4]
        loop.step(force, depth, np.zeros(3))
    assert loop.mismatch() > 0.002 or before == SLAVE  # which follows
    synchronised = False
    for _ in range(30):
        output = loop.step(*signals(NO), np.zeros(3))
        if output.synchronise:
            synchronised = True
            assert output.mismatch_m == 0.0
            assert np.abs(output.desired - loop.arm.pose()).max() < 1e-4
        if synchronised:
            assert loop.mismatch() < 1e-6
    assert synchronised and output.state == NO


def test_shorter_contacts_than_the_debounce_do_not_count() -> None:
    law = csa.CsaTeleop(csa.CsaTeleopConfig())
    for i in range(500):
        force = 2.0 if i % 20 < 15 else 0.0  # 15 ms on, 5 ms off
        output = law.step(np.eye(4), np.eye(4), np.eye(4), DT, force, -1.0, UP, np.zeros(6))
        assert output.state == NO
    for i in range(500):  # between the thresholds nothing changes
        output = law.step(np.eye(4), np.eye(4), np.eye(4), DT, 0.31 if i < 30 else 0.2, -1.0, UP, np.zeros(6))
    assert output.state == SLAVE


@given(st.data(), st.sampled_from(["master", "slave", "proxy", "force", "depth", "stale", "disabled"]), FAULTY_DT)
def test_what_is_not_known_holds_and_fades(data: st.DataObject, what: str, dt: float) -> None:
    loop = Loop()
    for _ in range(200):
        loop.step(2.0, 0.003, 3.0 * UP)
    good = {"master_pose": loop.master, "slave_pose": loop.arm.pose(), "proxy_pose": loop.arm.pose(), "dt": dt,
            "slave_force_N": 2.0, "proxy_depth_m": 0.003, "proxy_normal": UP,
            "compliance_wrench": np.r_[3.0 * UP, 0, 0, 0]}  # fmt: skip
    bad = {
        "master": lambda: {"master_pose": data.draw(spoilt(np.eye(4)))},
        "slave": lambda: {"slave_pose": data.draw(spoilt(np.eye(4)))},
        "proxy": lambda: {"proxy_pose": data.draw(spoilt(np.eye(4)))},
        "force": lambda: {"slave_force_N": data.draw(st.sampled_from([None, np.nan, np.inf]))},
        "depth": lambda: {"proxy_depth_m": data.draw(st.sampled_from([None, np.nan]))},
        "stale": lambda: {"stale": True},
        "disabled": lambda: {"enabled": False},
    }[what]()
    before = loop.law.state.wrench
    output = loop.law.step(**{**good, **bad})
    assert output.hold and output.status != saras.Status.OK
    assert np.linalg.norm(output.wrench) < np.linalg.norm(before)
    for _ in range(150):
        output = loop.law.step(**{**good, **bad, "dt": DT})
    assert not output.wrench.any()


def test_clutch_moves_the_master_alone() -> None:
    loop = Loop()
    for _ in range(100):
        loop.step(0.0, -0.01, np.zeros(3))
    q = loop.arm.q.copy()
    for _ in range(200):
        loop.master[:3, 3] += [2e-4, 0, 0]
        loop.step(0.0, -0.01, np.zeros(3), clutch=True)
    assert np.abs(loop.arm.q - q).max() < 1e-9
    output = loop.step(0.0, -0.01, np.zeros(3))
    np.testing.assert_allclose(output.desired, loop.arm.pose(), atol=1e-9)


@given(st.integers(0, 120), st.sampled_from(["firm", "normal", "weak"]), st.floats(100.0, 3000.0))
@settings(max_examples=12)
def test_the_hand_gets_no_more_than_the_tank_was_granted(delay_ms: int, hand: str, stiffness: float) -> None:
    """The model's wall felt over a delay both ways, through the tank at the handle."""
    wall = csa.ComplianceGains(stiffness_N_m=[0, 0, stiffness], damping_N_s_m=[0, 0, 2.0])
    compliance = csa.ComplianceWrench(csa.ComplianceConfig(negative=wall))
    law = csa.CsaTeleop(csa.CsaTeleopConfig(scale=1.0))
    config = OperatorConfig.firm() if hand == "firm" else OperatorConfig.weak() if hand == "weak" else OperatorConfig()
    operator, tank = Operator(config), EnergyTank(EnergyTankConfig(), 1)
    ticks = max(1, delay_ms)
    up, down = deque([np.zeros(3)] * ticks), deque([np.zeros(6)] * ticks)
    position, applied, delivered = np.zeros(3), np.zeros(6), 0.0
    slave = np.eye(4)
    for i in range(3000):
        intended = np.array([0, 0, 0.01 - 0.02 * min(1.0, i / 1000)])
        moved = operator.step(applied[:3], intended, DT)
        step_m, position = moved.position - position, np.array(moved.position)
        work = float(applied[:3] @ step_m)
        delivered += work
        up.append(position)
        handle = np.eye(4)
        handle[:3, 3] = up.popleft()
        felt = compliance.step(handle, np.zeros(6), np.eye(4), DT)
        slave[:3, 3] = handle[:3, 3]
        depth = -handle[2, 3]
        output = law.step(handle, slave, slave, DT, 2.0 if depth > 0 else 0.0, depth, UP, felt.wrench)
        down.append(output.wrench)
        twist = np.r_[step_m / DT, 0, 0, 0]
        applied = tank.step([down.popleft()], [twist], DT, work_J=work).applied[0]
        assert tank.state.energy_J >= 0.0
        assert delivered <= tank.state.granted_J + 1e-9
