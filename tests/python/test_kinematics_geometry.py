"""config/mesa_geometry.yaml and config/scene.yaml hold the numbers that the code holds."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

import saras
from saras.kinematics import dvrk, mesa, scene, simball

ROOT = Path(__file__).resolve().parents[2]
GEOMETRY = yaml.safe_load((ROOT / "config" / "mesa_geometry.yaml").read_text(encoding="utf-8"))
SCENE = ROOT / "config" / "scene.yaml"


def test_arm():
    numbers, config = GEOMETRY["arm"], mesa.arm().config
    for field in ("scara_link_1_m", "scara_link_2_m", "tip_offset_m", "instrument_m", "minimum_depth_m"):
        assert getattr(config, field) == numbers[field], field
    for field in ("lower", "upper", "speed"):
        np.testing.assert_array_equal(getattr(config, field), numbers[field])
    assert tuple(numbers["joint_names"]) == mesa.JOINT_NAMES == tuple(mesa.arm().joint_names)
    np.testing.assert_array_equal(mesa.NOMINAL_RCM, numbers["nominal_rcm_m"])
    assert numbers["shaft_radius_m"] == mesa.SHAFT_RADIUS_M


def test_positioning_arm():
    numbers = GEOMETRY["passive"]
    assert tuple(numbers["joint_names"]) == mesa.PASSIVE_JOINT_NAMES
    assert tuple(numbers["height_m"]) == mesa.PASSIVE_HEIGHT_M
    assert "".join(numbers["axis"]) == mesa.PASSIVE_AXIS
    assert tuple(numbers["limit_rad"]) == mesa.PASSIVE_LIMIT_RAD
    assert numbers["flange_height_m"] == mesa.PASSIVE_FLANGE_HEIGHT_M
    assert numbers["flange_to_base_m"] == mesa.PASSIVE_FLANGE_TO_BASE_M


def test_console():
    numbers, config = GEOMETRY["simball"], simball.handle().config
    assert config.handle_distance_m == numbers["handle_distance_m"]
    np.testing.assert_array_equal(config.lower, numbers["lower"])
    np.testing.assert_array_equal(config.upper, numbers["upper"])
    assert tuple(numbers["joint_names"]) == simball.JOINT_NAMES == tuple(simball.handle().joint_names)
    touch = GEOMETRY["touch"]
    assert tuple(touch["joint_names"]) == simball.TOUCH_JOINT_NAMES
    assert touch["shoulder_height_m"] == simball.TOUCH_SHOULDER_HEIGHT_M
    assert touch["upper_arm_m"] == simball.TOUCH_UPPER_ARM_M
    assert touch["forearm_m"] == simball.TOUCH_FOREARM_M


def test_scene_places_trocars_where_the_workspace_is_widest():
    room = scene.load(SCENE)
    for side in ("left", "right"):
        np.testing.assert_array_equal(room.arms[f"mesa_{side}"].rcm, mesa.NOMINAL_RCM)
        touch_base = room.frames[f"touchball_{side}/touch_base"].parent_T_frame
        np.testing.assert_allclose(touch_base, simball.SIMBALL_T_TOUCH_BASE, atol=1e-12)


def test_both_arms_reach_the_phantom():
    room, arm = scene.load(SCENE), mesa.arm()
    top = room.phantom.center + room.phantom.size * [0.0, 0.0, 0.5]
    for name, place in room.arms.items():
        base_T_world = np.linalg.inv(room.world_T(f"{name}/sbs_world"))
        sign = 1.0 if name == "mesa_left" else -1.0
        for x in (-1, 0, 1):
            for y in (0.0, 0.5, 1.0):
                world_tip = top + np.array([x * room.phantom.size[0], sign * y * room.phantom.size[1], 0.0]) / 2
                tip = (base_T_world @ np.append(world_tip, 1.0))[:3]
                assert arm.unreachable(tip, place.rcm) == "", (name, world_tip)


def test_da_vinci_reaches_the_phantom_and_the_assistants_tools_through_the_abdominal_wall():
    room = scene.load(SCENE)
    torso = yaml.safe_load(SCENE.read_text(encoding="utf-8"))["torso"]
    top = room.phantom.center + room.phantom.size * [0.0, 0.0, 0.5]
    trocars = [(room.world_T(f"{name}/sbs_world") @ np.append(place.rcm, 1.0))[:3] for name, place in room.arms.items()]
    for name, side in (("PSM1", 1.0), ("PSM2", -1.0), ("ECM", 0.0)):
        arm = dvrk.ecm() if name == "ECM" else dvrk.psm()
        pose = room.world_T(name)
        centre = pose[:3, 3]
        # In the wall: below the torso's highest line, above the tissue, and away from the other trocars.
        assert top[2] + 0.05 < centre[2] < torso["height_m"] and abs(centre[1]) < torso["half_width_m"]
        assert centre[0] > 0.05 and np.sign(centre[1]) == side
        assert min(np.linalg.norm(centre - trocar) for trocar in trocars) > 0.10
        # At zero the shaft points at the phantom's upper face, nearly at its middle.
        towards = (top - centre) / np.linalg.norm(top - centre)
        assert -pose[:3, 2] @ towards > np.cos(np.deg2rad(10.0))
        q = np.zeros(len(arm.limits))
        for y in (0.0, 0.5, 1.0):  # where the assistant's tools are, with a straight wrist
            for height in (0.0, 0.03):
                tip = np.linalg.inv(pose) @ np.append(top + np.array([0.0, side * y * 0.07, height]), 1.0)
                q[:3] = np.arctan2(tip[0], -tip[2]), np.arcsin(-tip[1] / np.linalg.norm(tip[:3])), 0.0
                q[2] = np.linalg.norm(tip[:3]) - arm.forward(q)[:3, 3] @ arm.shaft(q)
                np.testing.assert_allclose(arm.forward(q)[:3, 3], tip[:3], atol=1e-9)
                assert arm.limit_violation(q) == "", (name, y, height)
    # The endoscope's up is the table's.
    ecm = room.world_T("ECM") @ dvrk.ecm().forward([0, 0, 0.1, 0])
    assert ecm[2, 1] > 0.5 and abs(ecm[2, 0]) < 1e-6


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ("xyz_m: [-0.22, 0.162, 0.32]", "xyz_m: [-0.22, .nan, 0.32]", "frames.mesa_left/sbs_world.xyz_m"),
        ("rcm_m: [0.18, 0.0, -0.10]   #", "rcm_m: [0.18, 0.0]   #", "arms.mesa_left.rcm_m"),
        ("elbow: -1", "side: -1", "arms.mesa_left.elbow is missing"),
        ("parent: touchball_left/simball_base", "parent: nowhere", "does not lead to world"),
        ("size_m: [0.14, 0.22, 0.08]", "size_m: [0.14, -0.22, 0.08]", "phantom.size_m"),
    ],
)
def test_scene_names_what_is_wrong(tmp_path, old, new, word):
    text = SCENE.read_text(encoding="utf-8")
    assert old in text
    broken = tmp_path / "scene.yaml"
    broken.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(saras.ConfigError, match=word):
        scene.load(broken)


def test_meshes_are_what_their_script_makes(tmp_path):
    subprocess.run(
        [sys.executable, str(ROOT / "script" / "make_meshes"), str(tmp_path)], check=True, stdout=subprocess.DEVNULL
    )
    made, kept = (
        {p.name: p.read_bytes() for p in folder.glob("*.stl")} for folder in (tmp_path, ROOT / "urdf" / "meshes")
    )
    assert made.keys() == kept.keys()
    assert [name for name in made if len(made[name]) != len(kept[name])] == []
    assert sum(len(mesh) for mesh in kept.values()) < 1.5e6
