"""Projection and clipping of the overlay against cv2.projectPoints and brute force, both eyes, rectified and raw."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("cv2")
from overlay_cameras import NEAR_M, Eye, before_the_fold, in_image, points_in_view, random_pair

from saras import ConfigError
from saras.overlay import CameraConfig, PinholeEye

KINDS = [(True, False), (False, False), (False, True)]
KIND_NAMES = ["rectified", "raw plumb_bob", "raw rational"]
DENSE = 4000


@pytest.mark.parametrize(("rectified", "rational"), KINDS, ids=KIND_NAMES)
def test_projection_is_opencvs(many: int, rectified: bool, rational: bool) -> None:
    rng = np.random.default_rng(1)
    worst, compared = 0.0, 0
    for _ in range(60 * many):
        for eye in random_pair(rng, rectified=rectified, rational=rational):
            points = points_in_view(rng, eye, 200)
            pixels = PinholeEye(eye.config).project(points)
            assert np.isfinite(pixels).all()
            worst = max(worst, float(np.abs(pixels - eye.opencv(points)).max()))
            compared += len(points)
    assert compared > 5000 * many
    assert worst <= 0.01, worst


@pytest.mark.parametrize(("rectified", "rational"), KINDS, ids=KIND_NAMES)
def test_the_right_eye_sees_from_the_baseline(rectified: bool, rational: bool) -> None:
    """On rectified images of one point: rows equal, columns apart by f b / z. On raw ones undone by OpenCV."""
    import cv2

    rng = np.random.default_rng(2)
    for _ in range(30):
        left, right = random_pair(rng, rectified=rectified, rational=rational)
        points = points_in_view(rng, left, 300)
        points = points[in_image(right.opencv(points), right.config) & before_the_fold(right, points)]
        straight = []
        for eye in (left, right):
            pixels = PinholeEye(eye.config).project(points)
            if not rectified:
                criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 200, 1e-12)
                k, d = np.asarray(eye.config.K), np.asarray(eye.config.distortion)
                r, p = np.asarray(eye.config.R), np.asarray(eye.config.P)
                pixels = cv2.undistortPointsIter(pixels[:, None], k, d, r, p, criteria)[:, 0]
            straight.append(pixels)
        p_left, p_right = np.asarray(left.config.P), np.asarray(right.config.P)
        disparity = (p_left[0, 2] - p_right[0, 2]) - p_right[0, 3] / points[:, 2]
        # Where undistortion converged: near the fold OpenCV's iteration does not.
        homogeneous = np.column_stack([points, np.ones(len(points))])
        good = np.ones(len(points), dtype=bool)
        for p, pixels in zip((p_left, p_right), straight):
            expected = (homogeneous @ p.T)[:, :2] / points[:, 2:]
            good &= np.abs(pixels - expected).max(axis=1) < 0.02
        assert good.mean() > 0.8
        np.testing.assert_allclose(straight[0][good, 1], straight[1][good, 1], atol=0.05)
        np.testing.assert_allclose(straight[0][good, 0] - straight[1][good, 0], disparity[good], atol=0.05)


def test_what_is_behind_or_too_near_is_not_seen() -> None:
    rng = np.random.default_rng(3)
    for rectified, rational in KINDS:
        for eye in random_pair(rng, rectified=rectified, rational=rational):
            points = rng.uniform(-0.1, 0.1, (2000, 3))
            pixels = PinholeEye(eye.config).project(points)
            hidden = eye.raw_frame(points)[:, 2] < NEAR_M
            assert np.isnan(pixels[hidden]).all()
            for value in (np.nan, np.inf, -np.inf):
                assert np.isnan(PinholeEye(eye.config).project([[0.0, value, 0.1], [0.0, 0.0, value]])).all()


def test_a_lens_model_that_folds_back_shows_nothing_twice() -> None:
    """Far outside, k1 = -0.3 alone would bring points back into the image."""
    k = np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]])
    config = CameraConfig(
        width_px=640, height_px=480, K=k, P=np.column_stack([k, np.zeros(3)]), distortion=[-0.3] + 7 * [0.0]
    )
    eye = PinholeEye(config)
    angle = np.linspace(0.0, 2.0 * np.pi, 200)
    for radius in (1.2, 1.5, 1.75, 3.0):
        points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), np.ones_like(angle)])
        pixels = eye.project(points)
        assert not in_image(pixels, config).any()
    assert len(eye.project_line([1.3, -1.0, 1.0], [1.9, 1.0, 1.0])) == 0


def ahead(depth_m: float) -> np.ndarray:
    return np.array([0.0, 0.0, depth_m])


def random_segment(rng: np.random.Generator, eye: Eye) -> tuple[np.ndarray, np.ndarray]:
    """In view, crossing the near plane, wholly behind, passing by the image, along the axis, or of no length."""
    kind = rng.integers(6)
    if kind == 0:
        a, b = rng.uniform(-0.08, 0.08, 3) + ahead(0.12), rng.uniform(-0.08, 0.08, 3) + ahead(0.12)
    elif kind == 1:
        a, b = rng.uniform(-0.05, 0.05, 3) + ahead(0.1), rng.uniform(-0.05, 0.05, 3) - ahead(0.1)
    elif kind == 2:
        a, b = rng.uniform(-0.1, 0.1, 3) - ahead(0.11), rng.uniform(-0.1, 0.1, 3) - ahead(0.11)
    elif kind == 3:
        a, b = rng.uniform(-1.0, 1.0, 3), rng.uniform(-1.0, 1.0, 3)
    elif kind == 4:
        direction = rng.normal(0.0, 0.1, 3) + ahead(1)
        a, b = 0.02 * direction, 0.3 * direction
    else:
        a = b = rng.uniform(-0.05, 0.05, 3) + ahead(0.1)
    return a, b


def distance_to_pieces(points: np.ndarray, pieces: np.ndarray) -> np.ndarray:
    """(n,) from each pixel to the nearest of the (m, 2, 3) pieces."""
    best = np.full(len(points), np.inf)
    for (ax, ay, _), (bx, by, _) in pieces:
        a, d = np.array([ax, ay]), np.array([bx - ax, by - ay])
        share = np.clip((points - a) @ d / max(float(d @ d), 1e-30), 0.0, 1.0)
        best = np.minimum(best, np.linalg.norm(points - a - share[:, None] * d, axis=1))
    return best


@pytest.mark.parametrize(("rectified", "rational"), KINDS, ids=KIND_NAMES)
def test_lines_are_clipped_as_brute_force_does(many: int, rectified: bool, rational: bool) -> None:
    """Samples along the segment that OpenCV puts on the image lie on our pieces; our pieces lie on such samples."""
    rng = np.random.default_rng(4)
    seen = hidden = 0
    share = np.linspace(0.0, 1.0, DENSE)
    for _ in range(25 * many):
        for eye in random_pair(rng, rectified=rectified, rational=rational):
            ours = PinholeEye(eye.config)
            for _ in range(8):
                a, b = random_segment(rng, eye)
                pieces = np.asarray(ours.project_line(a, b))
                # Even steps in the image and not in space: shares where the inverse depth is even, past the near plane.
                za, zb = eye.raw_frame(np.array([a, b]))[:, 2]
                if max(za, zb) < NEAR_M:
                    assert len(pieces) == 0
                    hidden += 1
                    continue
                low = (NEAR_M - za) / (zb - za) if za < NEAR_M else 0.0
                high = (NEAR_M - za) / (zb - za) if zb < NEAR_M else 1.0
                z_low, z_high = za + low * (zb - za), za + high * (zb - za)
                inverse = (1.0 - share) / z_low + share / z_high
                s = low + (high - low) * (share / z_high) / inverse
                samples = a + s[:, None] * (b - a)
                pixels = eye.opencv(samples)
                visible = in_image(pixels, eye.config) & before_the_fold(eye, samples)
                if not len(pieces):
                    # Where sampling says something, it says at most a graze of the border.
                    strictly = in_image(pixels, eye.config, -0.5) & before_the_fold(eye, samples)
                    assert not strictly.any(), (a, b)
                    hidden += 1
                    continue
                seen += 1
                assert in_image(pieces[:, 0, :2], eye.config, 1e-6).all()
                assert in_image(pieces[:, 1, :2], eye.config, 1e-6).all()
                assert (pieces[:, :, 2] >= NEAR_M * (1 - 1e-9)).all()
                assert distance_to_pieces(pixels[visible], pieces).max(initial=0.0) < 0.15, (a, b)
                # And back: our ends are where samples are. Neighbours may be some pixels apart on a long line.
                near = in_image(pixels, eye.config, 20.0)
                gap = np.linalg.norm(np.diff(pixels[near], axis=0), axis=1).max(initial=0.0) if near.sum() > 1 else 0.0
                for point in pieces[:, :, :2].reshape(-1, 2):
                    assert np.linalg.norm(pixels - point, axis=1).min() < 0.2 + gap, (a, b, point)
    assert seen > 100 * many
    assert hidden > 50 * many


@pytest.mark.parametrize(("rectified", "rational"), KINDS, ids=KIND_NAMES)
def test_depths_along_a_line_are_those_of_the_points(rectified: bool, rational: bool) -> None:
    rng = np.random.default_rng(5)
    for _ in range(30):
        for eye in random_pair(rng, rectified=rectified, rational=rational):
            a, b = random_segment(rng, eye)
            za, zb = eye.raw_frame(np.array([a, b]))[:, 2]
            pieces = np.asarray(PinholeEye(eye.config).project_line(a, b))
            for u, v, depth in pieces.reshape(-1, 3):
                s = (depth - za) / (zb - za) if abs(zb - za) > 1e-12 else 0.5
                if abs(zb - za) > 1e-9:
                    pixel = eye.opencv((a + s * (b - a))[None])[0]
                    assert np.hypot(*(pixel - [u, v])) < 0.2 + 1e-9 / abs(zb - za)


def good_config(**changes: object) -> dict:
    k = np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]])
    values = {"width_px": 640, "height_px": 480, "K": k, "P": np.column_stack([k, np.zeros(3)])}
    return {**values, **changes}


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"width_px": 0}, "width_px"),
        ({"height_px": -1}, "height_px"),
        ({"K": np.zeros((3, 3))}, "K"),
        ({"P": np.zeros((3, 4))}, "P"),
        ({"K": np.array([[500.0, 3.0, 320], [0, 500, 240], [0, 0, 1]])}, "K"),
        ({"R": np.diag([1.0, 1.0, -1.0])}, "R"),
        ({"R": 2.0 * np.eye(3)}, "R"),
        ({"distortion": [np.nan] + 7 * [0.0]}, "distortion"),
        ({"near_m": 0.0}, "near_m"),
        ({"P": np.full((3, 4), np.nan)}, "P"),
    ],
)
def test_bad_cameras_are_refused_by_name(changes: dict, named: str) -> None:
    PinholeEye(CameraConfig(**good_config()))
    with pytest.raises(ConfigError, match=named):
        CameraConfig(**good_config(**changes))
