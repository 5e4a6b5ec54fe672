"""The stiffness map in the endoscope's image: each pixel against its ray, OpenCV on raw images, fading, the bar."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import saras
from saras.overlay import CameraConfig, PinholeEye, StiffnessOverlay, StiffnessOverlayStyle, stiffness_color

WIDTH, HEIGHT, FOCAL = 160, 120, 150.0
GROUND = 100
CHANNELS = {"bgr8": 3, "rgb8": 3, "mono8": 1, "bgra8": 4, "rgba8": 4}


def camera(rectified: bool = True, baseline_m: float = 0.0, size: tuple[int, int] = (WIDTH, HEIGHT)) -> CameraConfig:
    matrix = np.array([[FOCAL, 0.0, size[0] / 2], [0.0, FOCAL, size[1] / 2], [0.0, 0.0, 1.0]])
    bent = [0.0] * 8 if rectified else [-0.2, 0.05, 0.001, -0.002, 0.0, 0.0, 0.0, 0.0]
    return CameraConfig(
        width_px=size[0],
        height_px=size[1],
        K=matrix,
        P=np.column_stack([matrix, [-FOCAL * baseline_m, 0.0, 0.0]]),
        distortion=bent,
        rectified=rectified,
    )


def plain(encoding: str = "rgb8") -> np.ndarray:
    shape = (HEIGHT, WIDTH) if encoding == "mono8" else (HEIGHT, WIDTH, CHANNELS[encoding])
    return np.full(shape, GROUND, np.uint8)


def style(**changes) -> StiffnessOverlayStyle:
    return StiffnessOverlayStyle(**{"bar": False, **changes})


def expected(stiffness: float, std: float, wanted: StiffnessOverlayStyle) -> np.ndarray:
    """RGB of a blended pixel; NaN: not known."""
    known = np.isfinite(stiffness) and np.isfinite(std)
    share = (stiffness - wanted.low_N_m) / (wanted.high_N_m - wanted.low_N_m) if known else np.nan
    certainty = max(0.0, 1.0 - std / wanted.uncertain_std_N_m) if known else 0.0
    alpha = wanted.faint_opacity + certainty * (wanted.opacity - wanted.faint_opacity)
    return (1.0 - alpha) * GROUND + alpha * np.array(stiffness_color(share)[:3])


def nearest_hit(vertices: np.ndarray, triangles: np.ndarray, baseline_m: float) -> tuple[np.ndarray, ...]:
    """Of each pixel's ray: distance, triangle, weights of its corners, how far inside; by Moeller and Trumbore."""
    u, v = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    rays = np.stack([(u - WIDTH / 2) / FOCAL, (v - HEIGHT / 2) / FOCAL, np.ones_like(u, float)], axis=-1)
    origin = np.array([baseline_m, 0.0, 0.0])
    best = np.full((HEIGHT, WIDTH), np.inf)
    second = np.full((HEIGHT, WIDTH), np.inf)
    which, weights = np.full((HEIGHT, WIDTH), -1), np.zeros((HEIGHT, WIDTH, 3))
    edge = np.full((HEIGHT, WIDTH), np.inf)
    for i, (a, b, c) in enumerate(vertices[triangles]):
        normal_b, normal_c = np.cross(rays, c - a), np.cross(origin - a, b - a)
        det = normal_b @ (b - a)
        with np.errstate(all="ignore"):  # triangles without area
            wb = (normal_b @ (origin - a)) / det
            wc = (rays @ normal_c) / det
            t = ((c - a) @ normal_c) / det
            inside = np.minimum(np.minimum(wb, wc), 1.0 - wb - wc)
        edge = np.fmin(edge, np.abs(inside))
        hit = (inside >= 0.0) & (t > 0.0)
        nearer = hit & (t < best)
        second = np.where(nearer, best, np.where(hit, np.minimum(second, t), second))
        best = np.where(nearer, t, best)
        which = np.where(nearer, i, which)
        weights[nearer] = np.stack([1.0 - wb - wc, wb, wc], axis=-1)[nearer]
    # At borders and where two surfaces meet either answer is right.
    return which, weights, (edge < 1e-6) | ((which >= 0) & (second < best + 1e-6))


@settings(deadline=None, max_examples=25)
@given(seed=st.integers(0, 2**32 - 1), baseline_m=st.sampled_from([0.0, 0.005]))
def test_every_pixel_is_what_its_ray_hits_first(seed, baseline_m):
    rng = np.random.default_rng(seed)
    wanted = style(opacity=rng.uniform(0.3, 1.0), faint_opacity=0.2, low_N_m=200.0, high_N_m=1200.0)
    n = 12
    vertices = np.column_stack([rng.uniform(-0.08, 0.08, (n, 2)), rng.uniform(0.05, 0.2, n)])
    triangles = rng.integers(0, n, (8, 3))
    stiffness = np.where(rng.random(n) < 0.15, np.nan, rng.uniform(100.0, 1300.0, n))
    std = np.where(rng.random(n) < 0.05, np.inf, rng.uniform(0.0, 500.0, n))
    image = plain()
    # Given in another frame than the camera's.
    turn, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    left_T_map = np.eye(4)
    left_T_map[:3, :3], left_T_map[:3, 3] = turn * np.sign(np.linalg.det(turn)), rng.uniform(-0.1, 0.1, 3)
    in_map = (vertices - left_T_map[:3, 3]) @ left_T_map[:3, :3]
    drawn = StiffnessOverlay(camera(baseline_m=baseline_m), wanted)
    for _ in range(2):  # nothing is left from the picture before
        image = plain()
        assert drawn.draw(in_map, stiffness, std, triangles, left_T_map, image, "rgb8")
    which, weights, unclear = nearest_hit(vertices, triangles, baseline_m)
    assert unclear.mean() < 0.05
    nothing = ~unclear & (which < 0)
    assert (image[nothing] == GROUND).all()
    hit = ~unclear & (which >= 0)
    corners, w = triangles[which[hit]], weights[hit]
    known = (np.isfinite(stiffness) & np.isfinite(std))[corners].all(axis=1)
    wanted_pixels = np.tile(expected(np.nan, np.inf, wanted), (len(known), 1))
    certainty = (w * np.maximum(0.0, 1.0 - std[corners] / wanted.uncertain_std_N_m)).sum(axis=1)
    mean = (w * stiffness[corners]).sum(axis=1)
    for i in np.flatnonzero(known):
        wanted_pixels[i] = expected(mean[i], (1.0 - certainty[i]) * wanted.uncertain_std_N_m, wanted)
    np.testing.assert_allclose(image[hit], wanted_pixels, atol=2.0)


@pytest.mark.parametrize("baseline_m", [0.0, 0.005])
def test_on_raw_images_it_lies_where_opencv_draws_it(baseline_m):
    cv2 = pytest.importorskip("cv2")
    side = np.linspace(-0.02, 0.02, 21)
    vertices = np.array([(x, y, 0.06 + 4.0 * (x * x + y * y)) for y in side for x in side])
    quads = [(r * 21 + c, r * 21 + c + 1, r * 21 + c + 21, r * 21 + c + 22) for r in range(20) for c in range(20)]
    triangles = np.array([t for a, b, c, d in quads for t in ((a, b, c), (b, d, c))])
    config, image = camera(rectified=False, baseline_m=baseline_m), plain()
    overlay = StiffnessOverlay(config, style(opacity=1.0, faint_opacity=1.0))
    n = len(vertices)
    assert overlay.draw(vertices, np.full(n, 1200.0), np.zeros(n), triangles, np.eye(4), image, "rgb8")
    shift = np.array([-baseline_m, 0.0, 0.0])
    pixels, _ = cv2.projectPoints(vertices, np.zeros(3), shift, config.K, np.array(config.distortion[:5]))
    mask = np.zeros((HEIGHT, WIDTH), np.uint8)
    for triangle in triangles:
        cv2.fillConvexPoly(mask, np.round(pixels[triangle, 0] * 16).astype(np.int32), 255, shift=4)
    ours = (image == stiffness_color(1.0)[:3]).all(axis=2)
    border = cv2.morphologyEx(mask, cv2.MORPH_GRADIENT, np.ones((3, 3), np.uint8)) > 0
    assert ours.sum() > 3000
    assert (ours == (mask > 0))[~border].all()


def square(stiffness: float, std: float, depth_m: float = 0.1, half_m: float = 0.01) -> tuple[np.ndarray, ...]:
    vertices = np.array([(x, y, depth_m) for x in (-half_m, half_m) for y in (-half_m, half_m)])
    return vertices, np.full(4, stiffness), np.full(4, std), np.array([[0, 1, 2], [1, 2, 3]])


def at_the_middle(image: np.ndarray) -> np.ndarray:
    return image[HEIGHT // 2 + 3, WIDTH // 2 - 4].astype(int)


def test_the_less_is_known_the_fainter_and_unknown_is_grey_never_soft():
    def distance(stiffness: float, std: float) -> float:
        image = plain()
        StiffnessOverlay(camera(), style()).draw(*square(stiffness, std), np.eye(4), image, "rgb8")
        return float(np.abs(at_the_middle(image) - GROUND).sum())

    shown = [distance(1200.0, std) for std in (0.0, 100.0, 200.0, 400.0, 4000.0)]
    assert all(a > b for a, b in zip(shown[:3], shown[1:4])) and shown[3] == shown[4] > 0
    for stiffness, std in ((np.nan, 10.0), (900.0, np.inf), (900.0, np.nan), (np.inf, 1.0), (900.0, -1.0)):
        image = plain()
        StiffnessOverlay(camera(), style()).draw(*square(stiffness, std), np.eye(4), image, "rgb8")
        red, green, blue = at_the_middle(image)
        assert red == green == blue != GROUND


def test_one_unknown_corner_makes_its_triangle_unknown():
    vertices, stiffness, std, triangles = square(1200.0, 0.0)
    stiffness[0] = np.nan
    image = plain()
    StiffnessOverlay(camera(), style()).draw(vertices, stiffness, std, triangles, np.eye(4), image, "rgb8")
    colours = np.unique(image.reshape(-1, 3), axis=0)
    assert len(colours) == 3  # ground, grey, yellow: nothing between


def test_what_is_nearer_hides_what_is_behind_in_any_order():
    near, far = square(1200.0, 0.0, 0.08), square(200.0, 0.0, 0.12)
    pictures = []
    for order in ((near, far), (far, near)):
        image = plain()
        both = [np.concatenate([a, b]) for a, b in zip(order[0][:3], order[1][:3])]
        StiffnessOverlay(camera(), style()).draw(
            *both, np.concatenate([near[3], near[3] + 4]), np.eye(4), image, "rgb8"
        )
        pictures.append(image)
        np.testing.assert_allclose(at_the_middle(image), expected(1200.0, 0.0, style()), atol=1.0)
    np.testing.assert_array_equal(*pictures)


@pytest.mark.parametrize("encoding", CHANNELS)
def test_each_format(encoding):
    image = plain(encoding)
    assert StiffnessOverlay(camera(), style(opacity=1.0)).draw(*square(1200.0, 0.0), np.eye(4), image, encoding)
    r, g, b, mono = stiffness_color(1.0)
    order = {"bgr8": [b, g, r], "rgb8": [r, g, b], "mono8": mono, "bgra8": [b, g, r, 255], "rgba8": [r, g, b, 255]}
    assert (at_the_middle(image) == order[encoding]).all()


@settings(deadline=None, max_examples=60)
@given(seed=st.integers(0, 2**32 - 1))
def test_nothing_hurts(seed):
    """Not finite, behind, far away, no vertices, indices out of range: those triangles are left out."""
    rng = np.random.default_rng(seed)
    vertices = rng.choice([0.0, 0.01, -1e3, 1e12, 0.1, -0.1, np.nan, np.inf, 1e-300], (6, 3))
    values = rng.choice([0.0, 1e300, -1e300, np.nan, np.inf, 500.0], (2, 6))
    overlay, image = StiffnessOverlay(camera(rectified=False), style()), plain()
    overlay.draw(vertices, *values, rng.integers(-3, 9, (20, 3)), np.eye(4), image, "rgb8")
    image = plain()
    overlay.draw(vertices[:0], *values[:, :0], np.zeros((3, 3), int), np.eye(4), image, "rgb8")
    assert (image == GROUND).all()


def test_the_bar_has_the_colours_and_fades():
    image, wanted = plain(), style(bar=True)
    overlay = StiffnessOverlay(camera(), wanted)
    assert overlay.draw(*square(700.0, 0.0), np.eye(4), image, "rgb8")
    left, top, width, height = overlay.bar
    assert left > 0 and left + width < WIDTH and top > 0 and top + height < HEIGHT
    column = image[top : top + height, left].astype(int)
    assert (np.abs(np.diff(column, axis=0)).max(axis=0) <= 14).all()
    assert column[0, 0] > column[-1, 0] + 50  # yellow above, violet below
    spread = image[top, left : left + width].astype(int).sum(axis=1)
    assert (np.diff(spread) < 0).all()
    without = plain()
    StiffnessOverlay(camera(), style()).draw(*square(700.0, 0.0), np.eye(4), without, "rgb8")
    assert (without[:, : left - width] == image[:, : left - width]).all()


def test_no_map_is_said_and_nothing_else_drawn():
    image, overlay = plain(), StiffnessOverlay(camera(), style(bar=True))
    assert overlay.draw_unknown(image, "rgb8")
    _, top, _, height = overlay.bar
    changed = (image != GROUND).any(axis=2)
    assert changed.any() and not changed[top + height // 2 :].any()


def test_other_sizes_and_bad_styles():
    overlay = StiffnessOverlay(camera(), style())
    small = np.zeros((HEIGHT, WIDTH - 1, 3), np.uint8)
    assert not overlay.draw(*square(700.0, 0.0), np.eye(4), small, "rgb8")
    assert not overlay.draw_unknown(small, "rgb8")
    with pytest.raises(ValueError, match="stiffness, std: 3 and 4 numbers for 4 vertices"):
        vertices, stiffness, std, triangles = square(1.0, 1.0)
        overlay.draw(vertices, stiffness[:3], std, triangles, np.eye(4), plain(), "rgb8")
    for name, value in (
        ("high_N_m", 100.0), ("opacity", 0.0), ("opacity", 1.1), ("faint_opacity", 0.9), ("uncertain_std_N_m", 0.0),
        ("low_N_m", -1.0), ("low_N_m", np.nan),
    ):  # fmt: skip
        with pytest.raises(saras.ConfigError, match=name):
            StiffnessOverlay(camera(), style(**{name: value}))


def test_it_lies_under_the_points_that_tools_are_drawn_at():
    """The same camera model as the rest of the room."""
    config, image = camera(rectified=False), plain()
    corner = np.array([0.012, -0.009, 0.07])
    vertices = corner + 0.0015 * np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.4, 0.0]])
    StiffnessOverlay(config, style(opacity=1.0)).draw(
        vertices, np.full(3, 1200.0), np.zeros(3), np.array([[0, 1, 2]]), np.eye(4), image, "rgb8"
    )
    column, row = PinholeEye(config).project([corner])[0]
    assert (image[round(row), round(column)] == stiffness_color(1.0)[:3]).all()
