"""The simulated stereo endoscope: pixels where OpenCV's camera puts them, truth, dents, the same again from a seed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import saras
from saras import ConfigError

cv2 = pytest.importorskip("cv2")
pytest.importorskip("vtkmodules")
from saras.calibration.board import board
from saras.calibration.camera import locate_board
from saras.calibration.camera_info import Eye
from saras.calibration.rendering import BoardPattern
from saras.calibration.rendering import render as cast_rays
from saras.kinematics.scene import pose_from_xyz_rpy
from saras.sim.endoscope import Label, Room, StereoRenderer, Surface, ToolState, stereo_camera

SCENE = Path(__file__).parents[2] / "config" / "scene.yaml"
DOWN = np.diag([1.0, -1.0, -1.0, 1.0])
WORLD_T_BOARD = pose_from_xyz_rpy([-0.01, -0.01, 0.09], [0.02, -0.03, 0.4])


def above(surface_T_point: np.ndarray, height_m: float, turn: np.ndarray) -> np.ndarray:
    """(4, 4) camera looking down at a frame's origin from a height, turned a little."""
    pose = surface_T_point @ pose_from_xyz_rpy([0.0, 0.0, height_m], [0.0, 0.0, 0.0]) @ DOWN
    return saras.add_delta(pose, np.concatenate([np.zeros(3), turn]), 1.0)


def straight_tool(tip: np.ndarray, trocar: np.ndarray) -> ToolState:
    z = (tip - trocar) / np.linalg.norm(tip - trocar)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = np.column_stack([x, np.cross(z, x), z]), tip
    return ToolState(pose, trocar)


def project(eye: Eye, camera_T_world: np.ndarray, points: np.ndarray) -> np.ndarray:
    local = points @ camera_T_world[:3, :3].T + camera_T_world[:3, 3]
    pixels, _ = cv2.projectPoints(local, np.zeros(3), np.zeros(3), eye.intrinsics.matrix, eye.intrinsics.distortion)
    return pixels.reshape(-1, 2)


@pytest.fixture(scope="module")
def board_renderer() -> StereoRenderer:
    return StereoRenderer(Room.load(SCENE, WORLD_T_BOARD), stereo_camera(), tools={}, noise=0.0, render_scale=2.0)


@pytest.fixture(scope="module")
def renderer() -> StereoRenderer:
    return StereoRenderer(Room.load(SCENE), stereo_camera(), noise=0.0)


def tissue_view(room: Room, x: float = 0.0, y: float = 0.0, height: float = 0.09, tilt: float = 0.5) -> np.ndarray:
    """From the head, over the tissue at (x, y), tilted."""
    place = room.surface.world_T_surface @ pose_from_xyz_rpy([x, y, 0.0], [0.0, 0.0, -np.pi / 2])
    pose = place @ pose_from_xyz_rpy([0.0, 0.0, 0.0], [tilt, 0.0, 0.0])
    return pose @ pose_from_xyz_rpy([0.0, 0.0, height], [0.0, 0.0, 0.0]) @ DOWN


def dot_center(grey: np.ndarray, near: np.ndarray) -> np.ndarray:
    """(2,) centre of gravity of what is dark around a pixel."""
    u, v = np.round(near).astype(int)
    v0, u0 = v - 14, u - 14
    dark = np.clip(200.0 - grey[v0 : v + 15, u0 : u + 15], 0.0, None)
    rows, columns = np.mgrid[v0 : v + 15, u0 : u + 15]
    return np.array([(dark * columns).sum(), (dark * rows).sum()]) / dark.sum()


@pytest.mark.parametrize("scale", [0.8, 1.0, 2.0])
def test_known_points_are_where_opencv_projects_them(scale: float) -> None:
    """Dots of 4 mm, from all over the pictures of both eyes: each to 0.1 px, all together to 0.02 px."""
    room = replace(Room.load(SCENE, WORLD_T_BOARD), board=board(dot_circle_radius_m=0.036, dot_diameter_m=0.004))
    renderer = StereoRenderer(room, stereo_camera(), tools={}, noise=0.0, render_scale=scale)
    camera = renderer.camera
    errors, places = [], []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        world_T_left = above(WORLD_T_BOARD, rng.uniform(0.075, 0.095), rng.uniform(-0.2, 0.2, 3))
        pair = renderer.render(world_T_left, {})
        left_T_board = np.linalg.inv(world_T_left) @ WORLD_T_BOARD
        for image, eye, pose in (
            (pair.left, camera.left, left_T_board),
            (pair.right, camera.right, camera.right_T_left @ left_T_board),
        ):
            grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY).astype(float)
            for pixel in project(eye, pose, room.board.dots):
                if (pixel > 18).all() and (pixel < [621, 461]).all():
                    errors.append(dot_center(grey, pixel) - pixel)
                    places.append(pixel)
    assert len(errors) > 80
    assert np.ptp(places, axis=0).min() > 350  # near the borders, too, where the lens bends most
    assert np.abs(errors).max() < 0.1
    assert np.abs(np.mean(errors, axis=0)).max() < 0.02


def test_pictures_are_those_of_a_ray_caster(board_renderer: StereoRenderer) -> None:
    """Grey levels differ by no more than the edges of black on white do when they are sampled otherwise."""
    camera, pattern = board_renderer.camera, BoardPattern(board_renderer.room.board)
    world_T_left = above(WORLD_T_BOARD, 0.14, np.array([0.1, -0.05, 0.1]))
    pair = board_renderer.render(world_T_left, {})
    left_T_board = np.linalg.inv(world_T_left) @ WORLD_T_BOARD
    for image, eye, pose in (
        (pair.left, camera.left, left_T_board),
        (pair.right, camera.right, camera.right_T_left @ left_T_board),
    ):
        expected = cast_rays(pattern, pose, eye.intrinsics).astype(float)
        off = np.abs(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) - expected)[60:420, 60:580]
        assert off.mean() < 1.5
        assert (off > 60.0).mean() < 0.002


def test_the_calibrations_detector_finds_the_board(board_renderer: StereoRenderer) -> None:
    world_T_left = above(WORLD_T_BOARD, 0.19, np.array([0.1, -0.05, 0.2]))
    pair = board_renderer.render(world_T_left, {})
    grey = cv2.cvtColor(pair.left, cv2.COLOR_BGR2GRAY)
    view = locate_board(grey, board_renderer.room.board, board_renderer.camera.left.intrinsics)
    off = saras.displacement(view.camera_T_board, np.linalg.inv(world_T_left) @ WORLD_T_BOARD)
    assert np.linalg.norm(off[:3]) < 4e-4
    assert np.linalg.norm(off[3:]) < 3e-3


def test_depth_is_that_of_the_plane(renderer: StereoRenderer) -> None:
    room, camera = renderer.room, renderer.camera
    world_T_left = tissue_view(room)
    renderer.render(world_T_left, {})
    truth = renderer.truth()
    for depth, labels, eye, right_T_left in (
        (truth.left_depth, truth.left_labels, camera.left, np.eye(4)),
        (truth.right_depth, truth.right_labels, camera.right, camera.right_T_left),
    ):
        world_T_eye = world_T_left @ np.linalg.inv(right_T_left)
        u, v = np.meshgrid(np.arange(20, 620, 37.0), np.arange(20, 460, 29.0))
        pixels = np.column_stack([u.ravel(), v.ravel()])
        rays = cv2.undistortPointsIter(
            pixels[:, None], eye.intrinsics.matrix, eye.intrinsics.distortion, None, None, (3, 40, 1e-10)
        ).reshape(-1, 2)
        rays = np.column_stack([rays, np.ones(len(rays))]) @ world_T_eye[:3, :3].T
        frame = room.surface.world_T_surface
        expected = frame[:3, 2] @ (frame[:3, 3] - world_T_eye[:3, 3]) / (rays @ frame[:3, 2])
        at = pixels.astype(int)
        hit = world_T_eye[:3, 3] + rays * expected[:, None] - frame[:3, 3]
        flat = (np.abs(hit[:, 0]) < 0.07) & (np.abs(hit[:, 1]) < 0.11)
        assert flat.sum() > 60
        assert (labels[at[:, 1], at[:, 0]][flat] == Label.TISSUE).all()
        assert np.abs(depth[at[:, 1], at[:, 0]][flat] - expected[flat]).max() < 3e-5


@pytest.mark.parametrize("depth_m", [0.001, 0.004, 0.008])
def test_tissue_gives_way_to_the_tip(renderer: StereoRenderer, depth_m: float) -> None:
    room = renderer.room
    surface = room.surface.world_T_surface
    tip = (surface @ [0.004, 0.006, -depth_m, 1.0])[:3]
    assert room.surface.depth(tip) == pytest.approx(depth_m)
    world_T_left = tissue_view(room, tilt=0.0)
    far = np.array([*tip[:2], 0.3])
    renderer.render(world_T_left, {})
    undisturbed = renderer.truth().left_depth
    renderer.render(world_T_left, {"mesa_left": straight_tool(tip, far)})
    renderer.contents.tools["mesa_left"].place(None)  # look at the dent without what made it
    renderer._window.Render()
    dented = renderer.truth().left_depth
    given = dented - undisturbed
    assert np.nanmax(given) == pytest.approx(depth_m, abs=2e-4)
    v, u = np.unravel_index(np.nanargmax(given), given.shape)
    expected = project(renderer.camera.left, np.linalg.inv(world_T_left), tip[None])[0]
    assert np.hypot(u - expected[0], v - expected[1]) < 20.0  # anywhere on the punch's face
    assert abs(given[5, 5]) < 1e-5


def test_tools_are_labelled_where_they_are(renderer: StereoRenderer) -> None:
    room = renderer.room
    tip = (room.surface.world_T_surface @ [0.0, 0.0, 0.02, 1.0])[:3]
    tool = straight_tool(tip, tip + np.array([0.0, 0.08, 0.06]))
    world_T_left = tissue_view(room)
    renderer.render(world_T_left, {"mesa_right": tool})
    truth = renderer.truth()
    axis = tip + np.linspace(0.1, 0.5, 9)[:, None] * (tool.trocar - tip)
    pixels = project(renderer.camera.left, np.linalg.inv(world_T_left), axis)
    inside = pixels[((pixels > 3) & (pixels < [636, 476])).all(axis=1)].round().astype(int)
    assert len(inside) >= 4
    assert (truth.left_labels[inside[:, 1], inside[:, 0]] == Label.TOOL).all()
    share = (truth.left_labels == Label.TOOL).mean()
    assert 0.005 < share < 0.3
    renderer.render(world_T_left, {})
    assert not (renderer.truth().left_labels == Label.TOOL).any()


def test_a_curved_surface_bulges_as_the_tissue_law_says() -> None:
    from saras.sim import Tissue, TissueConfig

    rng = np.random.default_rng(4)
    for curvature in (-4.0, 0.0, 5.0):
        place = saras.add_delta(np.eye(4), rng.normal(0.0, 0.3, 6), 1.0)
        surface = Surface(place, (0.1, 0.1), curvature)
        law = Tissue(TissueConfig(base_T_surface=place, curvature_1_m=curvature))
        for _ in range(20):
            point = (place @ [*rng.uniform(-0.04, 0.04, 2), rng.uniform(-0.01, 0.02), 1.0])[:3]
            out = law.step(point, np.zeros(3), dt=0.01)
            assert surface.depth(point) == pytest.approx(out.depth, abs=1e-12)
            assert np.allclose(surface.normal(point), out.normal)
            on_it = point + surface.depth(point) * surface.normal(point)
            local = (np.linalg.inv(place) @ [*on_it, 1.0])[:3]
            assert surface.height(local[None, :2])[0] == pytest.approx(local[2], abs=1e-12)


def test_a_seed_gives_the_same_pictures_again() -> None:
    room = Room.load(SCENE)
    view = tissue_view(room)
    made = []
    for seed in (7, 7, 8):
        renderer = StereoRenderer(room, stereo_camera(320, 240), seed=seed)
        made.append([renderer.render(view, {}) for _ in range(2)])
    for a, b in zip(made[0], made[1]):
        assert np.array_equal(a.left, b.left) and np.array_equal(a.right, b.right)
    assert not np.array_equal(made[0][0].left, made[0][1].left)  # a sensor's noise is new in each frame
    assert not np.array_equal(made[0][0].left, made[2][0].left)


@pytest.mark.parametrize(("width", "height"), [(640, 480), (1280, 720), (320, 240)])
def test_cameras_of_any_size_see_the_same(width: int, height: int) -> None:
    small, camera = stereo_camera(), stereo_camera(width, height)
    assert camera.size == (width, height)
    assert camera.right.baseline_m == pytest.approx(0.0052, abs=1e-4)
    scale = height / 480
    middle = camera.left.intrinsics.matrix[:2, 2] - [0.5 * width - 0.5, 0.5 * height - 0.5]
    assert np.allclose(middle, scale * (small.left.intrinsics.matrix[:2, 2] - [319.5, 239.5]))
    for value in (0, 63, 5000):
        with pytest.raises(ConfigError, match="width"):
            stereo_camera(value, height)


def test_camera_info_comes_back_from_its_file(tmp_path: Path) -> None:
    eye = stereo_camera().right
    eye.save(tmp_path / "right.yaml")
    again = Eye.load(tmp_path / "right.yaml")
    assert again.size == eye.size and again.name == "endoscope_right"
    for a, b in ((again.R, eye.R), (again.P, eye.P), (again.intrinsics.matrix, eye.intrinsics.matrix)):
        assert np.allclose(a, b, atol=1e-10)


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ("image_width: 640", "image_width: -3", "image_width"),
        ("plumb_bob", "fisheye", "distortion_model"),
        ("rows: 1", "rows: 1", ""),
        ("data: [1.", "data: [.nan, 1.", "finite numbers"),
        ("image_height", "image_tallness", "image_height"),
    ],
)
def test_a_spoilt_camera_info_is_refused_by_name(tmp_path: Path, old: str, new: str, word: str) -> None:
    path = tmp_path / "left.yaml"
    eye = stereo_camera().left
    replace(eye, R=np.eye(3)).save(path)
    path.write_text(path.read_text().replace(old, new, 1))
    if not word:
        Eye.load(path)
        return
    with pytest.raises(ConfigError, match=word):
        Eye.load(path)


def test_bones_show_where_no_tissue_covers_them(renderer: StereoRenderer) -> None:
    room = renderer.room
    bone = room.world_T_bones @ [0.45 * room.bones_size_m[0], 0.0, 0.5 * room.bones_size_m[2], 1.0]
    world_T_left = np.eye(4)
    world_T_left[:3, :3] = np.diag([1.0, -1.0, -1.0])
    world_T_left[:3, 3] = bone[:3] + np.array([0.0, 0.0, 0.12])
    renderer.render(world_T_left, {})
    truth = renderer.truth()
    u, v = project(renderer.camera.left, np.linalg.inv(world_T_left), bone[None, :3])[0].round().astype(int)
    assert truth.left_labels[v, u] == Label.BONE
    assert truth.left_depth[v, u] == pytest.approx(0.12, abs=1e-4)
