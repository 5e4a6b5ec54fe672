"""Markers of virtual fixtures: points lie on the border; what is unknown is grey or gone."""

import math

import numpy as np
import pytest
import trimesh
import yaml

pytest.importorskip("rospy")
from geometry_msgs.msg import Point, Vector3
from saras_ros1.msg import SideFixtures
from visualization_msgs.msg import Marker

from saras.csa import fixtures_file
from saras_ros1 import fixture_markers
from saras_ros1.markers import GREY, RED, WHITE

CUBE = trimesh.creation.box(extents=(0.02, 0.02, 0.02)).vertices.tolist()
FIXTURES = [
    {"name": "plane", "type": "plane", "point_m": [0, 0, 0.1], "normal": [1, 2, 2], "margin_m": 0.01},
    {"name": "line", "type": "line", "point_m": [0, 0, 0.1], "direction": [1, 0, 0], "soft": True},
    {"name": "path", "type": "path", "points_m": CUBE[:3], "radius_m": 0.002},
    {"name": "hull", "type": "hull", "points_m": CUBE, "frame": "sbs_world"},
    {"name": "region", "type": "region", "points_m": CUBE[:4]},
    {"name": "mesh", "type": "mesh", "file": "cube.stl"},
]


@pytest.fixture
def entries(tmp_path):
    trimesh.creation.box(extents=(0.02, 0.02, 0.02)).export(tmp_path / "cube.stl")
    (tmp_path / "f.yaml").write_text(yaml.safe_dump({"fixtures": FIXTURES}), encoding="utf-8")
    return {entry.name: entry for entry in fixtures_file.load(tmp_path / "f.yaml").of("left")}


def points(marker):
    return np.array([[p.x, p.y, p.z] for p in marker.points])


def test_each_kind_has_a_border_in_its_own_frame(entries):
    for name, entry in entries.items():
        marker = fixture_markers.shape(entry, "left", unknown=False)
        assert marker.ns == f"left fixture {name}"
        assert marker.header.frame_id == ("mesa_left/sbs_world" if name == "hull" else "world")
        assert np.isfinite(points(marker)).all()
        assert marker.type == Marker.LINE_STRIP or len(marker.points) % 2 == 0
        assert fixture_markers.shape(entry, "left", unknown=True).color == GREY
    assert fixture_markers.shape(entries["line"], "left", False).color == fixture_markers.SOFT
    normal = np.array([1, 2, 2]) / 3
    heights = (points(fixture_markers.shape(entries["plane"], "left", False)) - [0, 0, 0.1]) @ normal
    np.testing.assert_allclose(heights[:-1], 0.01, atol=1e-12)
    assert len(fixture_markers.shape(entries["hull"], "left", False).points) == 2 * 12, "a cube's edges, no diagonals"


def test_the_nearest_point_is_red_beyond_the_border_and_gone_when_unknown():
    message = SideFixtures(nearest=0, closest=Point(1, 2, 3), violation=0.0, force=Vector3(0.0, 0.0, 0.5))
    dot, arrow = fixture_markers.state("left", message)
    assert dot.color == WHITE
    np.testing.assert_allclose(points(arrow), [[1, 2, 3], [1, 2, 3.01]])
    message.violation = 1e-4
    assert fixture_markers.state("left", message)[0].color == RED
    message.force.x = math.nan
    assert fixture_markers.state("left", message)[1].action == Marker.DELETE
    for unknown in (None, SideFixtures(nearest=-1)):
        assert all(marker.action == Marker.DELETE for marker in fixture_markers.state("left", unknown))
