"""What must hold for energy tanks whatever operator, environment and network do (seeded random draws)."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from saras import Status
from saras.teleop import EnergyTank, EnergyTankConfig, LedgerReceiver, LedgerSender

DT = 0.001


def random_config(rng: np.random.Generator) -> EnergyTankConfig:
    levels = np.sort(rng.uniform(0.01, 1.0, 4)) + np.arange(4) * 1e-3
    damping_min = rng.uniform(0, 3, 6) * (rng.random(6) < 0.8)
    return EnergyTankConfig(
        initial_J=rng.uniform(levels[0], levels[3]),
        minimum_J=levels[0],
        request_J=levels[1],
        available_J=levels[2],
        maximum_J=levels[3],
        exchange_W=rng.uniform(0, 5),
        damping_min=damping_min,
        damping_max=damping_min + rng.uniform(0, 10, 6),
        conjugate_rate=rng.uniform(1, 40, 6),
        applied_limit=rng.uniform(0.5, 10, 6),
        hold_s=2 * DT,
    )


def reference_command(
    config: EnergyTankConfig, level_J: float, desired: np.ndarray, conjugate: np.ndarray
) -> np.ndarray:
    """The law of SPEC section 3 in numpy, with scipy's root finder for alpha. desired, conjugate: (n, 6)."""
    k_e = np.clip((config.request_J - level_J) / (config.request_J - config.minimum_J), 0, 1)
    damping = config.damping_min + k_e * (config.damping_max - config.damping_min)

    def applied(alpha: float) -> np.ndarray:
        return np.clip(alpha * (1 - k_e) * desired - damping * conjugate, -config.applied_limit, config.applied_limit)

    def worst(alpha: float) -> float:
        corners = [conjugate + s * config.conjugate_rate * config.hold_s for s in (-1, 1)]
        return float(config.hold_s * np.maximum(*(applied(alpha) * corner for corner in corners)).sum())

    budget_J = level_J - config.minimum_J
    if worst(1.0) <= budget_J:
        return applied(1.0)
    if worst(0.0) > budget_J:
        return applied(0.0)
    return applied(brentq(lambda alpha: worst(alpha) - budget_J, 0, 1, xtol=1e-14))


@given(seed=st.integers(0, 2**32 - 1), channels=st.integers(1, 4))
def test_command_agrees_with_an_independent_reference(seed: int, channels: int) -> None:
    rng = np.random.default_rng(seed)
    config = random_config(rng)
    tank = EnergyTank(config, channels)
    state = tank.state
    state.energy_J = rng.uniform(config.minimum_J, config.maximum_J)
    tank.reset(state)
    desired, conjugate = rng.normal(0, 4, (channels, 6)), rng.normal(0, rng.choice([0.01, 1, 20]), (channels, 6))
    out = tank.step(desired, conjugate, DT)
    expected = reference_command(config, state.energy_J, desired, conjugate)
    # alpha is found by halving on one side and by Brent on the other: compare what it yields.
    np.testing.assert_allclose(out.applied, expected, atol=1e-9)


@given(seed=st.integers(0, 2**32 - 1))
def test_full_tank_is_transparent(seed: int) -> None:
    rng = np.random.default_rng(seed)
    config = random_config(rng)
    tank = EnergyTank(config, 2)
    tank.grant(10.0)
    desired, conjugate = rng.normal(0, 0.1, (2, 6)), rng.normal(0, 0.01, (2, 6))
    expected = np.clip(desired - config.damping_min * conjugate, -config.applied_limit, config.applied_limit)
    out = tank.step(desired, conjugate, DT)
    if out.scale == 1.0 and out.reduction == 0.0:
        assert np.array_equal(out.applied, expected)
    else:  # a tank whose whole capacity is smaller than the worst case of one hold time
        assert config.maximum_J - config.minimum_J < 0.1 or config.maximum_J <= config.request_J


def operator_moves(rng: np.random.Generator, kind: str, config: EnergyTankConfig, n: int) -> Iterator[np.ndarray]:
    """Conjugates that respect the configured rate; send() what is applied."""
    step = config.conjugate_rate * config.hold_s * 0.999
    value = np.zeros((n, 6))
    sign = 1.0
    applied = yield value
    while True:
        if kind == "greedy":
            value = value + step * np.sign(applied)
        elif kind == "vibrating":
            sign = -sign
            value = np.broadcast_to(0.5 * sign * step, (n, 6))
        elif kind == "random":
            value = value + rng.uniform(-1, 1, (n, 6)) * step
        else:
            value = value + rng.uniform(-0.1, 0.1, (n, 6)) * step - 0.01 * value
        applied = yield value


@given(
    seed=st.integers(0, 2**32 - 1),
    kind=st.sampled_from(["greedy", "vibrating", "random", "calm"]),
    negative_damping=st.booleans(),
)
def test_floor_holds_against_every_operator_that_keeps_its_rate(seed: int, kind: str, negative_damping: bool) -> None:
    rng = np.random.default_rng(seed)
    config = random_config(rng)
    tank = EnergyTank(config, 2)
    moves = operator_moves(rng, kind, config, 2)
    conjugate = next(moves)
    for _ in range(300):
        desired = 50 * conjugate if negative_damping else rng.normal(0, 5, (2, 6))
        out = tank.step(desired, conjugate, rng.uniform(0.2, 1.0) * config.hold_s)
        assert out.status in (Status.OK, Status.LIMITED)
        assert out.energy_J >= 0
        assert out.energy_J >= config.minimum_J - tank.damping_reserve_J - 1e-12
        conjugate = moves.send(out.applied)


@dataclasses.dataclass
class Link:
    """A one-way ledger over a network that loses, doubles, delays and reorders."""

    rng: np.random.Generator
    loss: float
    delay_ticks: int
    session: int = 1

    def __post_init__(self) -> None:
        self.sender = LedgerSender(self.session)
        self.receiver = LedgerReceiver()
        self.wire: list[tuple[int, tuple[int, int, float]]] = []
        self.forgotten_J = 0.0

    def tick(self, now: int, sent_J: float) -> float:
        self.sender.send(sent_J)
        message = self.sender.next()
        for _ in range(1 + (self.rng.random() < 0.2)):
            if self.rng.random() >= self.loss:
                self.wire.append((now + int(self.rng.integers(0, 2 * self.delay_ticks + 1)), message))
        due = [m for t, m in self.wire if t <= now]
        self.wire = [(t, m) for t, m in self.wire if t > now]
        self.rng.shuffle(due)  # type: ignore[arg-type]
        return sum(self.receiver.credit(*m) for m in due)

    @property
    def in_flight_J(self) -> float:
        return self.forgotten_J + self.sender.sent_J - self.receiver.state.credited_J

    def restart_sender(self) -> None:
        self.forgotten_J += self.sender.sent_J
        self.session += 1
        self.sender = LedgerSender(self.session)


@given(
    seed=st.integers(0, 2**32 - 1),
    loss=st.floats(0, 0.5),
    delay_ticks=st.integers(0, 250),
    restart_at=st.one_of(st.none(), st.integers(1, 399)),
)
def test_two_tanks_over_a_bad_network_never_create_energy(
    seed: int, loss: float, delay_ticks: int, restart_at: int | None
) -> None:
    rng = np.random.default_rng(seed)
    configs = [random_config(rng) for _ in range(2)]
    tanks = [EnergyTank(config, 1) for config in configs]
    links = [Link(rng, loss, delay_ticks), Link(rng, loss, delay_ticks)]  # links[i]: from tank i to the other
    moves = [operator_moves(rng, rng.choice(["greedy", "random", "calm"]), c, 1) for c in configs]
    conjugates = [next(m) for m in moves]
    outputs = [None, None]
    dead = dict.fromkeys(("energy_J", "work_out_J", "vented_J", "granted_J"), 0.0)
    credits = [0.0, 0.0]
    for now in range(400):
        for i in (0, 1):
            peer = outputs[1 - i]
            if restart_at == now and i == 0:
                state = tanks[0].state
                for name in ("work_out_J", "granted_J"):
                    dead[name] += getattr(state, name)
                dead["vented_J"] += state.vented_J + state.energy_J  # what a dead tank held is gone
                tanks[0] = EnergyTank(configs[0], 1)
                tanks[0].reset()
                links[0].restart_sender()
            out = tanks[i].step(
                rng.normal(0, 5, (1, 6)),
                conjugates[i],
                DT,
                received_J=credits[i],
                peer_requests=bool(peer and peer.requesting),
                peer_has_room=bool(peer is None or peer.has_room),
            )
            credits[1 - i] = links[i].tick(now, out.sent_J)
            conjugates[i] = moves[i].send(out.applied)
            outputs[i] = out
            assert out.energy_J >= configs[i].minimum_J - tanks[i].damping_reserve_J - 1e-12
            assert links[i].in_flight_J >= -1e-12
        total = {k: dead[k] + sum(getattr(t.state, k) for t in tanks) for k in dead}
        flight = sum(link.in_flight_J for link in links)
        # Tank 1 took links[0]'s credit within this tick; the credit for tank 0 waits for the next one.
        flight = sum(link.in_flight_J for link in links) + credits[0]
        residual = total["energy_J"] + flight + total["work_out_J"] + total["vented_J"] - total["granted_J"]
        assert abs(residual) <= 1e-9 * max(1.0, total["granted_J"])
        assert total["work_out_J"] <= total["granted_J"] + 1e-9


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_bad_numbers_give_zero_and_leave_a_usable_tank(bad: float) -> None:
    for place in ("desired", "conjugate", "dt", "received_J", "work_J"):
        tank = EnergyTank(EnergyTankConfig(), 1)
        arguments = {"desired": np.ones((1, 6)), "conjugate": np.zeros((1, 6)), "dt": DT}
        before = tank.step(**arguments).energy_J
        broken = dict(arguments)
        broken[place] = np.full((1, 6), bad) if place in ("desired", "conjugate") else bad
        out = tank.step(**broken)
        assert out.status in (Status.INVALID_INPUT, Status.INVALID_TIME_STEP)
        assert not out.applied.any()
        assert out.energy_J == before
        assert tank.step(**arguments).status == Status.OK


def test_wrong_shapes_are_refused_by_name() -> None:
    tank = EnergyTank(EnergyTankConfig(), 2)
    with pytest.raises(ValueError, match=r"desired: expected shape \(2, 6\), got \(1, 6\)"):
        tank.step(np.zeros((1, 6)), np.zeros((2, 6)), DT)
