"""The URDF against the code, through a forward kinematics of its own that reads the XML."""

from __future__ import annotations

import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

from saras.kinematics import dvrk, mesa, scene, simball

ROOT = Path(__file__).resolve().parents[2]
xacro = pytest.importorskip("xacro")


def rotation(axis, angle):
    """Rodrigues' formula."""
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * (k @ k)


class UrdfTree:
    """Poses of links in the root link, from the XML alone."""

    def __init__(self, text):
        self.robot = ET.fromstring(text)
        self.links = [link.get("name") for link in self.robot.iter("link")]
        self.joints = {joint.get("name"): joint for joint in self.robot.findall("joint")}
        self.by_child = {joint.find("child").get("link"): joint for joint in self.joints.values()}

    @staticmethod
    def numbers(element, key, default):
        return np.array([float(v) for v in (element.get(key) if element is not None else default).split()])

    def forward(self, link, q):
        """Pose (4, 4) of a link; q: joint name → value, 0 when absent."""
        joint = self.by_child.get(link)
        if joint is None:
            return np.eye(4)
        parent = self.forward(joint.find("parent").get("link"), q)
        origin = joint.find("origin")
        r, p, y = self.numbers(origin, "rpy", "0 0 0")
        local = np.eye(4)
        local[:3, :3] = rotation([0, 0, 1], y) @ rotation([0, 1, 0], p) @ rotation([1, 0, 0], r)
        local[:3, 3] = self.numbers(origin, "xyz", "0 0 0")
        value, moved = q.get(joint.get("name"), 0.0), np.eye(4)
        axis = self.numbers(joint.find("axis"), "xyz", "1 0 0")
        if joint.get("type") == "revolute":
            moved[:3, :3] = rotation(axis, value)
        elif joint.get("type") == "prismatic":
            moved[:3, 3] = axis * value
        return parent @ local @ moved

    def limits(self, joint):
        limit = self.joints[joint].find("limit")
        return float(limit.get("lower")), float(limit.get("upper")), float(limit.get("velocity"))


def read(model, **arguments):
    words = [f"{key}:={value}" for key, value in arguments.items()]
    command = [sys.executable, "-c", "import xacro; xacro.main()", str(ROOT / "urdf" / f"{model}.urdf.xacro"), *words]
    return UrdfTree(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


@pytest.fixture(scope="module")
def room():
    return scene.load(ROOT / "config" / "scene.yaml")


def draws(limits, count, seed):
    random = np.random.default_rng(seed)
    lower, upper = np.asarray(limits).T
    return lower + random.random((count, len(lower))) * (upper - lower)


@pytest.mark.parametrize("name", ["mesa_left", "mesa_right"])
def test_arm_and_its_chain_agree_with_the_urdf(name, many):
    urdf, arm = read("mesa_arm", name=name), mesa.arm()
    chain = arm.chain()
    for q in draws(arm.limits, 200 * many, 1):
        named = {f"{name}/{joint}": value for joint, value in zip(mesa.JOINT_NAMES, q)}
        np.testing.assert_allclose(arm.forward(q), urdf.forward(f"{name}/tool_tip", named), atol=1e-9)
        for link in ("scara_link_2", "linear_axis", "carriage", "instrument", "tool_tip"):
            np.testing.assert_allclose(chain.forward(q, link), urdf.forward(f"{name}/{link}", named), atol=1e-9)
    for i, joint in enumerate(mesa.JOINT_NAMES):
        assert urdf.limits(f"{name}/{joint}") == (*arm.limits[i], arm.config.speed[i])


def test_hand_piece_agrees_with_the_urdf_and_the_touch_holds_the_handle(many):
    urdf, handle = read("console", name="touchball_right"), simball.handle()
    for q in draws(handle.limits, 200 * many, 2):
        pose = handle.forward(q)
        joints = [*simball.JOINT_NAMES, *simball.TOUCH_JOINT_NAMES]
        values = [*q, *simball.touch_joints_from_handle(pose)]
        named = {f"touchball_right/{joint}": value for joint, value in zip(joints, values)}
        np.testing.assert_allclose(pose, urdf.forward("touchball_right/handle", named), atol=1e-9)
        np.testing.assert_allclose(pose, urdf.forward("touchball_right/touch_stylus", named), atol=1e-9)
    for i, joint in enumerate(simball.JOINT_NAMES):
        assert urdf.limits(f"touchball_right/{joint}")[:2] == tuple(handle.limits[i])


def test_positioning_arm_agrees_with_the_urdf(many):
    urdf, chain = read("passive_arm", name="mesa_left"), mesa.passive_chain()
    for q in draws(chain.limits, 200 * many, 3):
        named = {f"mesa_left/{joint}": value for joint, value in zip(mesa.PASSIVE_JOINT_NAMES, q)}
        np.testing.assert_allclose(chain.forward(q, "flange"), urdf.forward("mesa_left/flange", named), atol=1e-9)


@pytest.mark.parametrize(
    ("model", "name", "arguments", "arm"),
    [
        ("dvrk_psm", "PSM2", {}, dvrk.psm()),
        ("dvrk_psm", "PSM1", {"offset": 0.4826, "length": 0.4670, "wrist": 0.0112}, dvrk.psm("420194", "si")),
        ("dvrk_ecm", "ECM", {}, dvrk.ecm()),
        ("dvrk_ecm", "ECM", {"view": -np.pi / 6}, dvrk.ecm("up")),
    ],
)
def test_da_vinci_agrees_with_the_urdf(model, name, arguments, arm, many):
    urdf = read(model, name=name, **arguments)
    for q in draws(arm.limits, 200 * many, 4):
        tip = urdf.forward(f"{name}_tool_tip", dict(zip(arm.joint_names, q)))
        np.testing.assert_allclose(arm.forward(q), tip, atol=1e-9)


def test_positioning_arms_carry_the_bases_where_the_scene_has_them(room):
    chain, urdf = mesa.passive_chain(), read("saras")
    for name in ("mesa_left", "mesa_right"):
        q = room.arms[name].passive_joints
        chain.check_limits(q)
        named = {f"{name}/{joint}": value for joint, value in zip(mesa.PASSIVE_JOINT_NAMES, q)}
        world_T_base = room.world_T(f"{name}/sbs_world")
        np.testing.assert_allclose(room.world_T(f"{name}/passive_base") @ chain.forward(q), world_T_base, atol=1e-9)
        np.testing.assert_allclose(urdf.forward(f"{name}/sbs_world", named), world_T_base, atol=1e-9)


def test_whole_tree_has_every_frame_of_the_scene_once_under_world(room):
    urdf = read("saras")
    assert len(urdf.links) == len(set(urdf.links))
    assert [link for link in urdf.links if link not in urdf.by_child] == ["world"]
    for frame in ("touchball_left/simball_base", "touchball_right/touch_base", "mesa_left/passive_base", "PSM1", "ECM"):
        np.testing.assert_allclose(urdf.forward(frame, {}), room.world_T(frame), atol=1e-12)


@pytest.mark.parametrize(
    ("model", "name", "root"),
    [
        ("mesa_arm", "mesa_right", "mesa_right/sbs_world"),
        ("passive_arm", "mesa_right", "mesa_right/passive_base"),
        ("console", "touchball_left", "touchball_left/simball_base"),
        ("dvrk_psm", "PSM1", "PSM1"),
        ("dvrk_ecm", "ECM", "ECM"),
        ("scene", "", "world"),
    ],
)
def test_each_device_is_rooted_at_its_base_and_publishes_no_calibrated_frame(model, name, root, room):
    urdf = read(model, name=name)
    assert [link for link in urdf.links if link not in urdf.by_child] == [root]
    assert not set(urdf.by_child) & (set(room.frames) | {"mesa_left/rcm", "mesa_right/rcm"})


def test_every_mesh_is_there_and_each_is_used():
    used = {Path(mesh.get("filename")).name for mesh in read("saras").robot.iter("mesh")}
    assert used == {path.name for path in (ROOT / "urdf" / "meshes").glob("*.stl")}
