"""Virtual fixtures in the whole simulated platform, both forms of it; replay of their steps; their part of a report."""

import dataclasses
import json

import numpy as np
import pytest

from saras import csa, sim
from saras.law_trace import TickBatch, TracedLaw
from saras.recording import Topic
from saras.replay import replay_law
from saras.report import fixtures as section
from saras.sim.arm_side import ArmSide
from saras.teleop import VelocityIntegratorConfig

TIP = ArmSide(sim.Side()).measured_base_T_tip[:3, 3]
CAGE = TIP + 0.004 * np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)])


def caged(controller, soft=False, stiffness_N_m=150.0):
    fixture = csa.Fixture.hull("cage", csa.convex_hull(CAGE), soft=soft)
    made = csa.TeleopFixture(fixture=fixture, stiffness_N_m=stiffness_N_m, start_m=0.001)
    side = sim.Side(motion=sim.SumOfSines(amplitudes_m=((0.03, 0.03, 0.02), (0.0, 0.0, 0.0))), fixtures=(made,))
    return sim.Experiment(sides=(side,), duration_s=8.0, controller=controller)


@pytest.mark.parametrize("controller", ["laws", "pipeline"])
def test_the_tip_stays_in_its_cage_and_the_hand_feels_it(controller):
    experiment = caged(controller)
    r = sim.run(experiment)
    free = sim.run(dataclasses.replace(experiment, sides=(dataclasses.replace(experiment.sides[0], fixtures=()),)))
    assert np.abs(free.set_point[:, 0] - TIP).max() > 0.008
    assert np.abs(r.set_point[:, 0] - TIP).max() <= 0.004 + 1.1e-6
    assert np.abs(r.tip[:, 0] - TIP).max() <= 0.004 + 5e-4, "the arm overshoots a little"
    assert np.linalg.norm(r.hand_force, axis=2).max() > 1.0
    total = {name: book.sum(axis=1) for name, book in r.books.items()}
    flight = total["sent_J"] - total["received_J"]
    gone = total["vented_J"] + total["lost_J"]
    assert np.abs(total["energy_J"] + flight + total["work_out_J"] + gone - total["granted_J"]).max() <= 1e-9


@pytest.mark.parametrize("controller", ["laws", "pipeline"])
def test_a_soft_cage_lets_the_arm_out_and_tells_the_hand(controller):
    soft, none = sim.run(caged(controller, soft=True)), sim.run(caged(controller, soft=True, stiffness_N_m=0.0))
    assert np.abs(soft.set_point[:, 0] - TIP).max() > 0.005
    force, without = (np.linalg.norm(r.hand_force[:, 0], axis=1) for r in (soft, none))
    assert np.mean(force) > np.mean(without) + 0.1


def topic(name, count, columns):
    times = np.arange(float(count))
    return Topic(name, "", times, times, columns)


def replayed(law, name, steps):
    batch = TickBatch()
    for i, given in enumerate(steps):
        law.step(**given)
        batch.add(law.tick, 0.01 * i)
    columns = {key: np.array([value], dtype=object) for key, value in batch.take().items()}
    return replay_law(topic(name, 1, columns), json.loads(law.info))


def steps(random, force):
    tip = np.diag([1.0, -1.0, -1.0, 1.0])
    for _ in range(300):
        tip = tip.copy()
        tip[:3, 3] = TIP + random.uniform(-0.006, 0.006, 3)
        word = {"fixtures_on": bool(random.random() < 0.9), "fixtures_known": bool(random.random() < 0.9), "dt": 0.01}
        if force:
            yield {"base_T_tip": tip, "hand_ahead": random.uniform(-0.01, 0.01, 3), **word}
        else:
            rcm = TIP + np.array([0.0, 0.0, 0.08])
            yield {"twist": random.uniform(-0.1, 0.1, 6), "measured_pose": tip, "rcm": rcm, "stale": False, **word}


@pytest.mark.parametrize("force", [True, False])
def test_recorded_steps_replay_to_the_bit(force):
    path = csa.Fixture.path("guide", list(CAGE[:3]), 0.002)
    made = [csa.TeleopFixture(fixture=f) for f in (csa.Fixture.hull("cage", csa.convex_hull(CAGE)), path)]
    if force:
        law = TracedLaw(csa.FixtureForce, csa.FixtureForceConfig(), made, name="fixture_force_left")
    else:
        config = VelocityIntegratorConfig(shaft_through_rcm=True)
        law = TracedLaw(csa.FixtureIntegrator, config, made, name="velocity_integrator_left")
    result = replayed(law, "/laws/x", steps(np.random.default_rng(1), force))
    assert result.compared == 300
    assert result.worst == 0.0


class Recorded:
    """As much of a session as the section reads."""

    def __init__(self, topics):
        self._topics = topics

    def topic(self, name):
        return self._topics.get(name)


def test_the_report_tells_the_least_distance_of_each():
    assert not section.recorded(Recorded({}))
    nan = float("nan")
    columns = {
        "names": [["floor", "cage"]] * 4,
        "distance": [[0.004, nan], [0.002, nan], [nan, nan], [0.003]],
        "status": ["OK", "LIMITED", "STALE", "OK"],
    }
    arrays = {name: np.array([*values, None], dtype=object)[:-1] for name, values in columns.items()}
    session = Recorded({"/fixtures/right": topic("/fixtures/right", 4, arrays)})
    assert section.recorded(session)
    text = section.fixtures(session, None)
    assert "2.000" in text
    assert "25%" in text
    assert text.count("floor") == text.count("cage") == 1
    assert "unknown</span>" in text, "a distance that was never known is said to be unknown"
