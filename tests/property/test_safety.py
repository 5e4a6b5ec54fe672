"""Whatever operators and buttons do: who moves an arm holds it and has engaged it, and what stopped stays so."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, rule

from saras.safety import (
    MAX_OPERATORS,
    ChannelInput,
    CrtkState,
    Lease,
    OperatorSigns,
    SafetyEvent,
    SafetyState,
    Supervisor,
    SupervisorConfig,
    crtk_state,
)

DT = 0.01
ARMS = 2
often = st.sampled_from([True, True, True, False])
seldom = st.sampled_from([False] * 7 + [True])
operator_numbers = st.integers(0, MAX_OPERATORS)

OPERATORS = st.lists(
    st.builds(
        OperatorSigns,
        alive=often,
        claim=seldom,
        release=seldom,
        withdraw=seldom,
        accept=st.booleans(),
        offer_to=st.one_of(st.just(0), operator_numbers),
    ),
    min_size=MAX_OPERATORS,
    max_size=MAX_OPERATORS,
)
CHANNEL = {
    "all_there": often,
    "aligned": often,
    "fault": seldom,
    "hold": seldom,
    "disengage": seldom,
    "clutch": seldom,
    "engage_by": operator_numbers,
}
CHANNELS = st.lists(st.fixed_dictionaries(CHANNEL), min_size=ARMS, max_size=ARMS)
TIMES = st.sampled_from([DT] * 9 + [0.0, -DT, math.nan, math.inf])


class Safety(RuleBasedStateMachine):
    """Leases and supervisor of two arms, stepped as a node would: leases first."""

    def __init__(self) -> None:
        super().__init__()
        self.leases = [Lease() for _ in range(ARMS)]
        self.supervisor = Supervisor(SupervisorConfig(channels=ARMS))
        self.states = [SafetyState.WAITING] * ARMS
        self.engaged_by = [0] * ARMS

    @rule(
        operators=st.lists(OPERATORS, min_size=ARMS, max_size=ARMS),
        channels=CHANNELS,
        estop=seldom,
        estop_reset=st.booleans(),
        dt=TIMES,
    )
    def tick(self, operators, channels, estop, estop_reset, dt) -> None:
        holders = [self.lease_tick(arm, operators[arm], dt) for arm in range(ARMS)]
        inputs = [ChannelInput(holder=holder, **channel) for holder, channel in zip(holders, channels, strict=True)]
        out = self.supervisor.step(inputs, estop=estop, estop_reset=estop_reset, dt=dt)
        valid = math.isfinite(dt) and dt > 0
        for arm in range(ARMS):
            self.check(arm, out.channels[arm], inputs[arm], estop=estop, estop_reset=estop_reset, valid=valid)
        assert out.estop_latched == (SafetyState.ESTOP in self.states)
        assert (out.whole == CrtkState.FAULT) == out.estop_latched

    def lease_tick(self, arm: int, operators: list[OperatorSigns], dt: float) -> int:
        lease = self.leases[arm]
        before = lease.state
        out = lease.step(operators, dt)
        if out.holder not in (before.holder, 0):
            signs = operators[out.holder - 1]
            assert signs.alive
            if before.holder:
                assert signs.accept and before.offered_to == out.holder, "taken from its holder without his offer"
                assert operators[before.holder - 1].alive, "a silent one's arm went to another"
            else:
                assert signs.claim
        if before.holder and not operators[before.holder - 1].alive:
            assert out.holder == 0, "the holder's silence must show as a gap"
        for number, signs in enumerate(operators, start=1):
            if signs.claim and number not in (before.holder, out.holder):
                assert out.refused[number - 1], "the second was not told"
        return out.holder

    def check(self, arm, out, given_input, *, estop, estop_reset, valid) -> None:
        before = self.states[arm]
        assert out.crtk == crtk_state(out.state)
        if estop:
            assert out.state == SafetyState.ESTOP
        elif not valid:
            assert out.state == before
        elif before == SafetyState.ESTOP:
            assert out.state == (SafetyState.HOLD if estop_reset else SafetyState.ESTOP)
        elif before == SafetyState.HOLD and out.state != before:
            assert out.event in (SafetyEvent.ENGAGE, SafetyEvent.DISENGAGE)
        if out.state == SafetyState.ENGAGED and before != out.state:
            self.engaged_by[arm] = given_input.engage_by
            assert given_input.engage_by == given_input.holder != 0
            assert given_input.aligned and given_input.all_there and before in (SafetyState.READY, SafetyState.HOLD)
        if out.may_move:
            assert out.state == SafetyState.ENGAGED and valid and not estop and not given_input.clutch
            assert given_input.holder == self.engaged_by[arm] != 0
            assert not (given_input.fault or given_input.hold or given_input.disengage)
        self.states[arm] = out.state

    def teardown(self) -> None:
        """From wherever this ended: the documented steps lead to READY, and only the last one to motion."""
        holders = []
        for lease in self.leases:
            lease.step([OperatorSigns(alive=True, release=True)] * MAX_OPERATORS, DT)
            holders.append(lease.step([OperatorSigns(alive=True, claim=True)], DT).holder)
        assert holders == [1] * ARMS
        calm = {"all_there": True, "aligned": True, "holder": 1}

        def step(reset: bool = False, **more):
            out = self.supervisor.step([ChannelInput(**calm, **more)] * ARMS, estop=False, estop_reset=reset, dt=DT)
            return out.channels[:ARMS]

        assert not any(channel.may_move for channel in step(reset=True, hold=True))
        assert not any(channel.may_move for channel in step(disengage=True))
        assert [channel.state for channel in step()] == [SafetyState.READY] * ARMS
        assert all(channel.may_move for channel in step(engage_by=1))


TestSafety = Safety.TestCase


@given(st.lists(st.tuples(CHANNELS, seldom, st.booleans(), st.lists(operator_numbers, min_size=2, max_size=2))))
def test_channels_know_nothing_of_each_other(ticks) -> None:
    both = Supervisor(SupervisorConfig(channels=2))
    alone = [Supervisor(SupervisorConfig(channels=1)) for _ in range(2)]
    for channels, estop, reset, holders in ticks:
        inputs = [ChannelInput(holder=h, **c) for h, c in zip(holders, channels, strict=True)]
        together = both.step(inputs, estop=estop, estop_reset=reset, dt=DT)
        for arm in range(2):
            single = alone[arm].step([inputs[arm]], estop=estop, estop_reset=reset, dt=DT).channels[0]
            assert repr(single) == repr(together.channels[arm])


def test_wrong_sizes_are_refused() -> None:
    with pytest.raises(ValueError, match="channels: expected 2, got 1"):
        Supervisor().step([ChannelInput()], estop=False, dt=DT)
    with pytest.raises(ValueError, match="operators: at most 4, got 5"):
        Lease().step([OperatorSigns()] * 5, DT)
