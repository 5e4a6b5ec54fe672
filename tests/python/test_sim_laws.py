"""Operator, Tissue, Channel and Link from Python."""

import numpy as np
import pytest

import saras
from saras import sim


def test_operator_presets_and_balance():
    assert sim.OperatorConfig.weak().stiffness_N_m == 50.0
    hand = sim.Operator(sim.OperatorConfig.firm())
    for _ in range(3000):
        out = hand.step(force=[4, 0, 0], intended_position=[0, 0.01, 0], dt=1e-3)
    np.testing.assert_allclose(out.position, [0.01, 0.01, 0], atol=1e-9)


def test_tissue_wrench_is_exerted_on_the_tissue():
    tissue = sim.Tissue(sim.TissueConfig(inclusion_stiffness_N_m=300.0))
    out = tissue.step([0, 0, -0.01], [0, 0, 0], 1e-3)
    np.testing.assert_allclose(out.wrench, [0, 0, -3, 0, 0, 0], atol=1e-12)
    assert tissue.step([0, 0, np.nan], [0, 0, 0], 1e-3).status == saras.Status.INVALID_INPUT


def test_configuration_errors_name_the_field():
    with pytest.raises(saras.ConfigError, match="loss"):
        sim.ChannelConfig(loss=2.0)


def test_link_carries_objects():
    link = sim.Link(sim.ChannelConfig(delay_s=0.1, duplicate=1.0, reorder_s=0.01))
    link.send(b"one", 0.0)
    link.send(b"two", 0.05)
    assert link.receive(0.09) == []
    assert link.receive(0.2) == [b"one", b"one", b"two", b"two"]


def test_link_forgets_lost_payloads():
    link = sim.Link(sim.ChannelConfig(loss=1.0))
    for i in range(100):
        link.send(i, i * 1.0)
        assert link.receive(i * 1.0) == []
    assert len(link._payloads) < 10


def test_servo_arm_reaches_its_target():
    arm = sim.ServoArm()
    rcm = np.array([0.18, 0.0, -0.10])
    target = rcm + np.array([0.01, 0.02, -0.11])
    for _ in range(1000):
        out = arm.step(target, 0.3, rcm, [0, 0, 0], 1e-3, target_jaw=1.0)
    np.testing.assert_allclose(out.base_T_tip[:3, 3], target, atol=1e-9)
    assert out.rcm_deviation_m < 1e-9
    assert out.jaw == 1.0
    out = arm.step(target - [0, 0, 0.5], 0.3, rcm, [0, 0, 0], 1e-3)
    assert out.status == saras.Status.LIMITED
    assert "insertion" in out.violation
