"""config/*.yaml: the shipped parameters are accepted, and each law's parameter refuses by name when it is spoilt."""

import math
from pathlib import Path

import pytest
import yaml

pytest.importorskip("rospy")
from saras import ConfigError
from saras.collision import ForbiddenRegions, ProximityMonitorConfig, RepulsiveForceConfig
from saras.kinematics import scene
from saras.teleop import EnergyTankConfig, FrameMappingConfig, TransparencyConfig, VelocityIntegratorConfig
from saras_ros1.params import Params

CONFIG = Path(__file__).parents[2] / "config"
SECTIONS = [
    ("teleop.yaml", "tf_transformer_left", "law", FrameMappingConfig),
    ("teleop.yaml", "transparency", "law", TransparencyConfig),
    ("teleop.yaml", "velocity_integrator_right", "law", VelocityIntegratorConfig),
    ("collision.yaml", "colliding_regions", "law", ProximityMonitorConfig),
    ("tanks.yaml", "tank_master", "tank", EnergyTankConfig),
    ("tanks.yaml", "tank_slave", "tank", EnergyTankConfig),
]


def load(file, node):
    return yaml.safe_load((CONFIG / file).read_text(encoding="utf-8"))[node]


def build(values, node, section, config_class):
    given = {}
    if config_class is FrameMappingConfig:
        given = {name: getattr(config_class(), name) for name in ("base_T_console", "touch_T_console")}
    return Params(values, f"/{node}").build(config_class, section, **given)


@pytest.mark.parametrize(("file", "node", "section", "config_class"), SECTIONS)
def test_the_shipped_file_is_accepted(file, node, section, config_class):
    build(load(file, node), node, section, config_class)


@pytest.mark.parametrize(("file", "node", "section", "config_class"), SECTIONS)
@pytest.mark.parametrize("spoilt", [KeyError, math.nan, math.inf, "text", -1e9])
def test_each_number_refuses_by_name(file, node, section, config_class, spoilt):
    for field, value in load(file, node)[section].items():
        if isinstance(value, (bool, str)) or (spoilt == -1e9 and isinstance(value, list)):
            continue
        values = load(file, node)
        if spoilt is KeyError:
            del values[section][field]
        else:
            values[section][field] = [spoilt] * len(value) if isinstance(value, list) else spoilt
        with pytest.raises(ConfigError) as refusal:
            build(values, node, section, config_class)
        assert field in str(refusal.value), (field, str(refusal.value))


def test_distances_fit_the_speed_bounds():
    law = build(load("collision.yaml", "colliding_regions"), "colliding_regions", "law", ProximityMonitorConfig)
    for side in ("left", "right"):
        integrator = load("teleop.yaml", f"velocity_integrator_{side}")
        assert law.speed_limit_m_s == integrator["law"]["speed_limit_m_s"]
        assert law.unknown_speed_limit_m_s == integrator["proximity_slowdown"]["unknown_speed_m_s"]
    force = load("teleop.yaml", "transparency")["proximity_force"]
    Params(force, "/transparency/proximity_force").build(RepulsiveForceConfig, "law")
    assert force["law"]["start_distance_m"] <= law.slowdown_start_m


def test_the_shipped_regions_hold_the_scenes_bones():
    regions = ForbiddenRegions.load(CONFIG / "forbidden_regions.yaml")
    bones = scene.load(CONFIG / "scene.yaml").bones
    spine = regions.vertices[regions.names.index("spine")]
    assert abs(spine.mean(axis=0) - bones.center).max() < 1e-12
    assert abs((spine.max(axis=0) - spine.min(axis=0)) - bones.size).max() < 1e-12


def test_the_slave_tanks_budget_covers_how_long_a_twist_acts():
    hold_s = load("tanks.yaml", "tank_slave")["tank"]["hold_s"]
    for side in ("left", "right"):
        assert load("teleop.yaml", f"velocity_integrator_{side}")["twist_timeout_s"] <= hold_s
