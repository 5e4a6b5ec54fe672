"""What rviz is given: cylinders along the shafts, grey for unknown, nothing where nothing is known."""

import math

import numpy as np
import pytest

pytest.importorskip("rospy")
from geometry_msgs.msg import Point, Vector3
from saras_ros1.msg import CollisionState, ToolCollision
from scipy.spatial.transform import Rotation
from visualization_msgs.msg import Marker

from saras_ros1 import collision_markers

NAN = float("nan")
CUBE = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1], [0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1]], dtype=float)


def tool(tip, trocar, state=ToolCollision.CLEAR, witness=(0.0, 0.0, 0.0)):
    message = ToolCollision(name="t", state=state, known_distance=0.0123, radius=0.004)
    message.tip, message.trocar = Point(*tip), Point(*trocar)
    message.on_tool, message.on_partner = Point(*witness), Point(*witness)
    message.normal = Vector3(0.0, 0.0, 1.0)
    return message


def drawn(*tools, regions=()):
    state = CollisionState(tools=list(tools))
    state.header.frame_id = "world"
    return {
        marker.ns: marker
        for marker in collision_markers.of(state, np.array(regions).reshape(-1, 8, 3), "bones_marker_frame").markers
    }


@pytest.mark.parametrize("axis", [*np.eye(3), *-np.eye(3), [0.3, -0.5, 0.8], [1e-9, 0.0, -1.0]])
def test_the_cylinder_lies_along_the_shaft(axis):
    tip = np.array([0.1, -0.2, 0.3])
    trocar = tip + 0.25 * np.array(axis) / np.linalg.norm(axis)
    shaft = drawn(tool(tip, trocar))["t shaft"]
    q, p = shaft.pose.orientation, shaft.pose.position
    assert math.isclose(q.x**2 + q.y**2 + q.z**2 + q.w**2, 1.0, abs_tol=1e-9)
    along = Rotation.from_quat([q.x, q.y, q.z, q.w]).as_matrix()[:, 2] * shaft.scale.z / 2
    middle = np.array([p.x, p.y, p.z])
    np.testing.assert_allclose([middle - along, middle + along], [tip, trocar], atol=1e-8)
    assert shaft.scale.x == shaft.scale.y == 0.008
    assert shaft.header.frame_id == "world"


def test_a_tool_without_length_is_a_ball():
    markers = drawn(tool((0.1, 0.2, 0.3), (0.1, 0.2, 0.3)))
    assert math.isfinite(markers["t shaft"].pose.orientation.w)
    assert len(markers["t ends"].points) == 2


def test_an_unknown_tool_is_taken_away():
    markers = drawn(tool((NAN,) * 3, (NAN,) * 3, ToolCollision.UNKNOWN))
    assert {marker.action for marker in markers.values()} == {Marker.DELETE}


def test_unknown_is_grey_and_says_so_where_the_tool_itself_is_known():
    markers = drawn(tool((0, 0, 0), (0, 0, 1), ToolCollision.UNKNOWN))
    colour = markers["t shaft"].color
    assert colour.r == colour.g == colour.b
    assert markers["t distance"].text == "12.3 mm ?"
    assert drawn(tool((0, 0, 0), (0, 0, 1)))["t distance"].text == "12.3 mm"


def test_no_witness_no_line():
    markers = drawn(tool((0, 0, 0), (0, 0, 1), witness=(NAN, 0.0, 0.0)))
    assert markers["t witness"].action == markers["t distance"].action == Marker.DELETE


def test_regions_are_one_closed_surface_in_their_own_frame():
    marker = drawn(regions=(CUBE, CUBE + 3.0))["forbidden regions"]
    assert marker.header.frame_id == "bones_marker_frame"
    points = np.array([[p.x, p.y, p.z] for p in marker.points]).reshape(2, -1, 3, 3)
    for triangles, centre in zip(points, (0.5, 3.5)):
        normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        assert 0.5 * np.linalg.norm(normal, axis=1).sum() == pytest.approx(6.0)
        # The divergence theorem, whichever way the triangles wind.
        outward = np.sign((normal * (triangles.mean(axis=1) - centre)).sum(axis=1, keepdims=True))
        volume = ((triangles.mean(axis=1) - centre) * 0.5 * normal * outward).sum() / 3.0
        assert volume == pytest.approx(1.0)
