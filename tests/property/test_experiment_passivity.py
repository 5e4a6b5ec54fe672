"""SPEC section 3: what must hold whatever operator, environment, commands and network do.

Whole experiments (saras.sim.run) with random hands, adversarial commands, impaired links between guard and
tank_master and between the tanks, jittered ticks and killed tanks. The books are checked at every graph tick, the
levels at every device tick, and what left through the handle against the hand's own motion.
"""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from saras import csa, sim
from saras.sim.arm_side import ArmSide

DURATION_S = 2.0
ROUNDING_J = 1e-9
TIP = ArmSide(sim.Side()).measured_base_T_tip[:3, 3]


def floats(low, high):
    return st.floats(low, high, allow_nan=False)


links = st.builds(
    sim.ChannelConfig,
    delay_s=floats(0.0, 0.5),
    jitter_s=floats(0.0, 0.05),
    loss=floats(0.0, 0.5),
    duplicate=floats(0.0, 0.5),
    reorder=floats(0.0, 0.5),
    burst_rate_hz=floats(0.0, 1.0),
)
hands = st.one_of(
    st.sampled_from([sim.OperatorConfig.firm, sim.OperatorConfig.normal, sim.OperatorConfig.weak]).map(lambda f: f()),
    st.builds(
        sim.OperatorConfig,
        stiffness_N_m=floats(0.0, 800.0),
        damping_N_s_m=floats(-3.0, 20.0),
        hand_mass_kg=floats(0.05, 1.0),
    ),
)
tissues = st.one_of(
    st.none(),
    st.builds(
        sim.TissueConfig,
        stiffness_N_m=floats(100.0, 2000.0),
        inclusion_stiffness_N_m=floats(100.0, 2000.0),
        exponent=floats(1.0, 1.5),
        force_noise_N=floats(0.0, 0.3),
    ),
)
motions = st.one_of(
    st.just(sim.SumOfSines(fade_s=0.3)),
    st.builds(
        sim.PressAndHold,
        reach_m=st.tuples(floats(-0.03, 0.03), floats(-0.03, 0.03), floats(-0.08, 0.0)),
        begin_s=st.just(0.1),
        reach_s=floats(0.1, 1.0),
    ),
)
adversaries = st.one_of(
    st.none(),
    st.builds(
        sim.Adversary,
        handle_gain_N_s_m=floats(0.0, 30.0),
        tip_gain_m_N_s=floats(0.0, 0.05),
        noise_N=floats(0.0, 3.0),
        noise_m_s=floats(0.0, 0.05),
    ),
)
restarts = st.lists(
    st.builds(
        sim.Restart, time_s=floats(0.1, DURATION_S), tank=st.sampled_from(["guard", "tank_master", "tank_slave"])
    ),
    max_size=3,
).map(tuple)


def charged(factory, charge_J):
    tank = factory()
    tank.initial_J = charge_J
    return tank


def wall(index, direction, away_m, soft, stiffness_N_m):
    """A plane that allows the tip's start; without a direction, a path through it."""
    length = np.linalg.norm(direction)
    if length > 0.1:
        normal = np.array(direction) / length
        made = csa.Fixture.plane(f"wall {index}", TIP - away_m * normal, normal, soft=soft)
    else:
        made = csa.Fixture.path(f"path {index}", TIP + np.diag([-0.03, 0.0, 0.03]), 0.001, soft=soft)
    return csa.TeleopFixture(fixture=made, stiffness_N_m=stiffness_N_m)


walls = st.lists(
    st.tuples(st.tuples(*[floats(-1.0, 1.0)] * 3), floats(0.0, 0.01), st.booleans(), floats(0.0, 1000.0)), max_size=4
).map(lambda drawn: tuple(wall(i, *each) for i, each in enumerate(drawn)))

# Runs are short: tanks that begin nearly empty get to their floor.
guard_tanks = floats(0.02, 0.5).map(lambda charge_J: charged(sim.guard_tank, charge_J))
slave_tanks = floats(0.02, 0.5).map(lambda charge_J: charged(sim.slave_tank, charge_J))
sides = st.builds(
    sim.Side,
    operator=hands,
    motion=motions,
    tissue=tissues,
    surface_below_m=floats(-0.005, 0.02),
    slave_wrench=st.sampled_from(["truth", "observer"]),
    fixtures=walls,
)
experiments = st.builds(
    sim.Experiment,
    sides=st.lists(sides, min_size=1, max_size=2).map(tuple),
    duration_s=st.just(DURATION_S),
    seed=st.integers(0, 2**16),
    guard_jitter=floats(0.0, 0.6),
    graph_jitter=floats(0.0, 0.5),
    up=links,
    down=links,
    exchange=links,
    adversary=adversaries,
    restarts=restarts,
    guard_tank=guard_tanks,
    slave_tank=slave_tanks,
)


# The real-time host's pipeline as a whole: its tanks share a process, so that their link has no impairments, and its
# inside has no place for an adversary at the tip.
pipelines = st.builds(
    sim.Experiment,
    controller=st.just("pipeline"),
    sides=st.lists(sides, min_size=1, max_size=2).map(tuple),
    duration_s=st.just(DURATION_S),
    seed=st.integers(0, 2**16),
    graph_rate_hz=st.sampled_from([100.0, 500.0, 1000.0]),
    guard_jitter=floats(0.0, 0.6),
    graph_jitter=floats(0.0, 0.5),
    up=links,
    down=links,
    adversary=st.one_of(
        st.none(), st.builds(sim.Adversary, handle_gain_N_s_m=floats(0.0, 30.0), noise_N=floats(0.0, 3.0))
    ),
    restarts=restarts,
    guard_tank=guard_tanks,
    slave_tank=slave_tanks,
)


@given(experiments)
def test_energy_is_never_created(experiment):
    check_energy(experiment)


@given(pipelines)
def test_the_pipeline_creates_no_energy_either(experiment):
    check_energy(experiment)


def check_energy(experiment):
    r = sim.run(experiment)
    total = {name: book.sum(axis=1) for name, book in r.books.items()}
    flight = total["sent_J"] - total["received_J"]
    gone = total["vented_J"] + total["lost_J"]
    scale = max(1.0, float(total["granted_J"][-1]), float(np.abs(total["work_out_J"]).max()))

    assert flight.min() >= -ROUNDING_J, "the network created energy"
    assert np.all(total["work_out_J"] <= total["granted_J"] + ROUNDING_J), "more was delivered than granted"
    residual = total["energy_J"] + flight + total["work_out_J"] + gone - total["granted_J"]
    assert np.abs(residual).max() <= ROUNDING_J * scale

    # The oracle outside the law: the hand's own motion under the force on it.
    for delivered, book in zip(r.delivered_hand_J, r.final_books):
        assert abs(delivered - book.work_out_J) <= ROUNDING_J * scale

    # tank_slave's reserve does not cover an arm that lags behind a command that stopped; zero it never reaches.
    assert r.energy[:, -1].min() >= 0.0
    assert np.all(np.isfinite(r.hand))
    assert np.all(np.isfinite(r.tip))
    assert np.all(np.abs(r.hand_force) <= 3.3 + 1e-12)
    assert np.abs(np.diff(r.set_point, axis=0)).max() <= 0.1 * 0.05 + 1e-9
    if experiment.controller == "pipeline" and experiment.restarts:
        return  # the set-point began anew where the arm was, which may overshoot a wall by micrometres
    for i, side in enumerate(experiment.sides):
        for fixture in (each.fixture for each in side.fixtures):
            if fixture.kind == 0 and not fixture.soft:
                point, normal = np.split(np.array(fixture.numbers[:6]), 2)
                assert ((r.set_point[:, i] - point) @ normal).min() >= -1.1e-6, fixture.name


@given(
    st.builds(
        sim.Experiment,
        sides=st.lists(st.builds(sim.Side, operator=hands, motion=motions, tissue=tissues), min_size=1, max_size=2).map(
            tuple
        ),
        duration_s=st.just(DURATION_S),
        seed=st.integers(0, 2**16),
        up=links,
        down=links,
        exchange=links,
        adversary=adversaries,
        restarts=restarts,
        guard_tank=guard_tanks,
        slave_tank=slave_tanks,
    )
)
def test_guards_stay_above_their_floor(experiment):
    """T >= 0 and T >= T_min - reserve at every device tick while the hand respects the conjugate's rate."""
    r = sim.run(experiment)
    config = experiment.guard_tank
    allowed = config.conjugate_rate[0] * config.hold_s
    velocity = np.diff(r.hand, axis=0, prepend=r.hand[:1]) * experiment.guard_rate_hz
    respects = np.abs(np.diff(velocity, axis=0)).max(axis=(0, 2)) <= allowed
    reserve = float(np.sum(config.damping_max * (config.conjugate_rate * config.hold_s) ** 2) * config.hold_s / 4.0)
    for side in np.flatnonzero(respects):
        assert r.energy[:, side].min() >= min(0.0, config.minimum_J - reserve)
        assert r.energy[:, side].min() >= config.minimum_J - reserve - ROUNDING_J
    assert r.energy[:, -2].min() >= experiment.master_tank.minimum_J - ROUNDING_J
