"""Closed-loop experiments: tracking, remote centre, energy, repeatability, speed."""

import dataclasses

import numpy as np
import pytest

from saras import sim


def weak_hand(tanks):
    """The weak hand of defaults.md on 500 N/m with a 200 ms round trip."""
    tissue = sim.TissueConfig(stiffness_N_m=500.0, inclusion_stiffness_N_m=500.0)
    side = sim.Side(
        operator=sim.OperatorConfig.weak(), motion=sim.PressAndHold(reach_m=(0.0, 0.0, -0.06)), tissue=tissue
    )
    link = sim.ChannelConfig(delay_s=0.1)
    return sim.Experiment(sides=(side,), duration_s=12.0, tanks=tanks, up=link, down=link)


@pytest.fixture(scope="module")
def free_motion():
    return sim.run(sim.Experiment(duration_s=15.0))


def test_free_motion_tracks(free_motion):
    m = free_motion.metrics()
    assert m.tracking_rms_m < 1e-3
    assert 0.02 < m.lag_s < 0.1
    assert m.set_point_error_m < 0.2e-3
    assert m.rcm_deviation_m < 1e-4


def test_free_motion_with_delay_tracks_after_its_lag():
    link = sim.ChannelConfig(delay_s=0.1)
    m = sim.run(sim.Experiment(duration_s=15.0, up=link, down=link)).metrics()
    assert m.tracking_rms_m < 1e-3
    assert m.set_point_error_m < 0.2e-3
    assert m.lag_s == pytest.approx(0.137, abs=0.015)


def test_guard_is_transparent_while_charged(free_motion):
    force, desired = free_motion.hand_force[:, 0], free_motion.desired_force[:, 0]
    velocity = np.diff(free_motion.hand[:, 0], axis=0, prepend=free_motion.hand[:1, 0]) * 1e3
    assert free_motion.energy.min() > 0.15
    np.testing.assert_allclose(force[1:], np.clip(desired - velocity, -3.3, 3.3)[1:], atol=1e-9)


def test_same_seed_same_run_other_seed_other_run():
    lossy = sim.ChannelConfig(delay_s=0.05, jitter_s=0.02, loss=0.2)
    experiment = sim.Experiment(duration_s=2.0, up=lossy, down=lossy, guard_jitter=0.2)
    one, two = sim.run(experiment), sim.run(experiment)
    np.testing.assert_array_equal(one.tip, two.tip)
    np.testing.assert_array_equal(one.hand_force, two.hand_force)
    assert not np.array_equal(one.tip, sim.run(dataclasses.replace(experiment, seed=2)).tip)


def test_configurations_are_left_alone():
    side = sim.Side(tissue=sim.TissueConfig())
    sim.run(sim.Experiment(sides=(side,), duration_s=0.1))
    np.testing.assert_array_equal(side.tissue.base_T_surface, np.eye(4))
    np.testing.assert_array_equal(side.operator.workspace_centre_m, np.zeros(3))


def test_weak_hand_oscillates_without_tanks_and_rests_with_them():
    without, with_tanks = sim.run(weak_hand(False)), sim.run(weak_hand(True))
    late = without.t > 9.0
    assert np.ptp(without.hand[late, 0, 2]) > 0.1
    assert np.ptp(with_tanks.hand[late, 0, 2]) < 1e-3
    assert with_tanks.delivered_hand_J[0] <= with_tanks.metrics().granted_J < without.delivered_hand_J[0]


def test_drift_dies_out_after_a_reduction():
    # tank_slave is empty and its peer far: the first motion is cut short, then energy arrives.
    tank = sim.slave_tank()
    tank.initial_J = tank.minimum_J
    far = sim.ChannelConfig(delay_s=0.5)
    motion = sim.PressAndHold(reach_m=(0.02, 0.0, -0.03), begin_s=0.1, reach_s=0.5)
    experiment = sim.Experiment(sides=(sim.Side(motion=motion),), duration_s=8.0, slave_tank=tank, exchange=far)
    m = sim.run(experiment).metrics()
    assert m.set_point_error_m > 1e-3
    assert m.drift_m < 1e-4


def test_clutch_holds_the_arm_and_releases_without_a_step():
    side = sim.Side(clutch=((3.0, 5.0),))
    r = sim.run(sim.Experiment(sides=(side,), duration_s=8.0))
    held = (r.t > 3.3) & (r.t < 5.0)
    assert np.ptp(r.tip[held, 0], axis=0).max() < 1e-4
    assert np.ptp(r.hand[held, 0], axis=0).max() > 5e-3
    assert np.abs(np.diff(r.set_point[:, 0], axis=0)).max() <= 0.1 * 0.0101


def test_two_sides_share_the_store_and_impaired_links_keep_the_books():
    bad = sim.ChannelConfig(delay_s=0.1, jitter_s=0.05, loss=0.3, duplicate=0.2, reorder=0.2)
    sides = (
        sim.Side(motion=sim.Palpate(), tissue=sim.TissueConfig()),
        sim.Side(operator=sim.OperatorConfig.weak(), tissue=sim.TissueConfig(), motion=sim.PressAndHold()),
    )
    r = sim.run(sim.Experiment(sides=sides, duration_s=6.0, up=bad, down=bad, exchange=bad))
    m = r.metrics(1)
    assert m.ledger_residual_J < 1e-9
    assert m.in_flight_min_J >= -1e-12
    np.testing.assert_allclose(r.delivered_hand_J, [b.work_out_J for b in r.final_books[:2]], atol=1e-12)


def test_observer_in_place_of_a_sensor():
    side = sim.Side(motion=sim.Palpate(presses=2), tissue=sim.TissueConfig(), slave_wrench="observer")
    r = sim.run(sim.Experiment(sides=(side,), duration_s=8.0))
    assert r.depth.max() > 1e-3
    assert r.metrics().ledger_residual_J < 1e-9


def test_unequal_joint_dynamics_bend_the_remote_centre():
    arm = sim.ServoArmConfig(natural_frequency_rad_s=np.array([60, 40, 60, 60, 60, 60.0]))
    m = sim.run(sim.Experiment(sides=(sim.Side(arm=arm),), duration_s=8.0)).metrics()
    assert m.rcm_deviation_m > 1e-4


def test_recorded_motion_and_its_refusals():
    t = np.linspace(0.0, 3.0, 100)
    motion = sim.Recorded(t, np.stack([0.01 * np.sin(t), 0.0 * t, 0.01 * t], axis=1))
    r = sim.run(sim.Experiment(sides=(sim.Side(motion=motion),), duration_s=3.0))
    np.testing.assert_allclose(r.intended[-1, 0] - r.intended[0, 0], [0.01 * np.sin(3.0), 0, 0.03], atol=1e-4)
    with pytest.raises(ValueError, match="time_s must increase"):
        sim.Recorded(t[::-1], np.zeros((100, 3)))


@pytest.mark.parametrize(
    ("field", "value"), [("duration_s", -1.0), ("graph_rate_hz", float("nan")), ("sides", ()), ("guard_jitter", 1.5)]
)
def test_refusals_name_the_field(field, value):
    with pytest.raises(ValueError, match=field):
        sim.Experiment(**{field: value})
