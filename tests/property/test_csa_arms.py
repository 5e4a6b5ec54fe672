"""What the nodes of situational awareness are made of: arms of system files, the proxy's model, picked regions."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import saras
from saras import csa
from saras.kinematics import mtm

pytest.importorskip("jsonschema")
from saras.csa import system
from saras.csa.region import RegionPicker
from saras.csa.simulated_arms import SimulatedMaster, SimulatedSlave
from saras.csa.surface import MeshSurface, PlaneSurface, rotation

CONFIG = Path(__file__).parents[2] / "config" / "csa"


def test_the_masters_jacobian_is_the_derivative_of_its_pose() -> None:
    rng, chain = np.random.default_rng(1), mtm.chain()
    lower, upper = np.asarray(chain.limits).T
    for _ in range(50):
        q = rng.uniform(lower, upper)
        jacobian = chain.jacobian(q)
        for i in range(7):
            step = np.zeros(7)
            step[i] = 1e-6
            a, b = chain.forward(q - step), chain.forward(q + step)
            turned = Rotation.from_matrix(b[:3, :3] @ a[:3, :3].T).as_rotvec()
            np.testing.assert_allclose(jacobian[:, i], np.r_[b[:3, 3] - a[:3, 3], turned] / 2e-6, atol=1e-6)


def test_the_masters_links_are_as_long_as_the_arm() -> None:
    chain = mtm.chain()
    assert chain.joint_names == list(mtm.JOINT_NAMES)
    straight = chain.forward(np.zeros(7))[:3, 3]
    # Upper arm down, forearm away, the wrist's platform up again.
    assert np.linalg.norm(straight) == pytest.approx(np.hypot(0.3645, 0.2794 - 0.1506), abs=1e-9)


def test_torques_come_to_the_hand_as_the_wrench_that_was_asked_for() -> None:
    setup, rng = system.load(CONFIG / "demo.json").setup(), np.random.default_rng(2)
    model = setup.master_model
    law = csa.MasterMlc(csa.MasterMlcConfig(torque_limit=model.torque_limit), model.gravity)
    master = SimulatedMaster(setup)
    for i in range(200):
        master.intended = 0.03 * np.sin(0.02 * i) * rng.normal(size=3)
        wrench = np.r_[rng.uniform(-1.5, 1.5, 3), np.zeros(3)]
        master.obey_torques(law.step(master.q, model.jacobian(master.q), wrench, 0.01).torque)
        np.testing.assert_allclose(master.force, wrench[:3], atol=1e-6)
        master.step(0.01)
        np.testing.assert_allclose(model.forward(master.q), master.pose, atol=2e-4)
    for _ in range(20):  # nobody commands any more
        master.step(0.01)
    assert not master.force.any()


@pytest.mark.parametrize("name", ["demo", "saras"])
def test_a_simulated_slave_follows_and_refuses(name: str) -> None:
    slave = SimulatedSlave(system.load(CONFIG / f"{name}.json").setup())
    goal = slave.model.home + 0.01
    assert slave.obey(goal) == ""
    for _ in range(100):
        slave.step(0.01)
    np.testing.assert_allclose(slave.joints.measured, goal, atol=1e-9)
    for wrong in (goal[:3], goal * np.nan, goal + 100.0):
        assert "must be" in slave.obey(wrong)
    np.testing.assert_allclose(slave.set_point, goal)


def test_the_trocar_of_a_saras_arm_is_in_its_fixtures_and_its_reach() -> None:
    setup = system.load(CONFIG / "saras.json").setup()
    arm = setup.slave_model
    assert csa.FixtureSet(setup.fixtures()).names == ["trocar"]
    away = arm.forward(arm.home).copy()
    away[:3, 3] += [0.01, -0.02, 0.005]
    turned = arm.within_reach(away)
    np.testing.assert_allclose(turned[:3, 3], away[:3, 3], atol=1e-12)
    from saras.kinematics import mesa

    across = np.cross(turned[:3, 2], turned[:3, 3] - mesa.NOMINAL_RCM)
    assert np.linalg.norm(across) < 1e-9


def test_mesh_and_plane_say_the_same() -> None:
    rng = np.random.default_rng(3)
    turn = Rotation.random(random_state=4).as_matrix()
    corners = np.array([[-1.0, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]) * 0.1 @ turn.T
    mesh, plane = MeshSurface(corners, [[0, 1, 2], [0, 2, 3]]), PlaneSurface(corners[0], turn[:, 2])
    for _ in range(200):
        point = turn @ (rng.uniform(-0.05, 0.05, 3) * [1, 1, 0.5])
        a, b = mesh.touch(point), plane.touch(point)
        assert a.depth_m == pytest.approx(b.depth_m, abs=1e-9)
        np.testing.assert_allclose(a.closest, b.closest, atol=1e-9)
        np.testing.assert_allclose(a.normal, b.normal, atol=1e-9)
    far = mesh.touch(turn @ [0.0, 0.0, 0.5])
    assert far.depth_m < 0.0 and not far.normal.any()
    with pytest.raises(saras.ConfigError, match="normal"):
        PlaneSurface([0, 0, 0], [0, 0, 0])


def test_a_region_is_picked_closed_and_cleared() -> None:
    picker = RegionPicker()
    for i, (x, y) in enumerate(((0, 0), (0.02, 0), (0.02, 0.02), (0, 0.02))):
        assert picker.pick([x, y, 0.001]) == f"point {i + 1}"
        assert "nearer" in picker.pick([x + 0.001, y, 0.0]) if i != 0 else True
    assert picker.pick([0.001, 0.001, 0.0]) == "region of 4 points" and picker.closed
    assert picker.pick([0.05, 0.0, 0.0]) == "point 1" and not picker.closed
    with pytest.raises(saras.ConfigError, match="points"):
        picker.close()
    with pytest.raises(saras.ConfigError, match="finite"):
        picker.pick([np.nan, 0, 0])
    picker.pick([0.06, 0.0, 0.0])
    picker.pick([0.07, 0.0, 0.0])
    with pytest.raises(saras.ConfigError, match="one line"):
        picker.close()
    assert not picker.closed
    assert picker.clear() == "no region" and not picker.points


def test_axes_of_the_master_are_turned_as_urdf_turns_them() -> None:
    rng = np.random.default_rng(5)
    for rpy in rng.uniform(-3.0, 3.0, (50, 3)):
        np.testing.assert_allclose(rotation(rpy), Rotation.from_euler("xyz", rpy).as_matrix(), atol=1e-12)


def test_the_bound_of_the_gain_is_that_of_the_real_period() -> None:
    document = json.loads((CONFIG / "demo.json").read_text())
    teleop = document["teleops"][0]
    teleop.update(scheduled=False, stiffness_max_N_m=1500.0, damping_max_N_s_m=0.0)
    lag = 0.01 + 2.0 / 150.0 + 0.02
    teleop["admittance_m_Ns"] = 0.99 * 0.5 / (1500.0 * lag)
    setup = system.System(CONFIG / "demo.json", document).setup()
    assert setup.slave_config().admittance_m_Ns == teleop["admittance_m_Ns"]
    with pytest.raises(saras.ConfigError, match="admittance_m_Ns"):
        setup.slave_config(period_s=0.012)
    teleop["damping_max_N_s_m"] = 0.86 / teleop["admittance_m_Ns"]
    with pytest.raises(saras.ConfigError, match="damping_max_N_s_m"):
        setup.slave_config()
