"""The inset of situational awareness: in its box only, each thing in its place, what is unknown is not drawn."""

from __future__ import annotations

import numpy as np
import pytest

import saras
from saras.overlay import AwarenessInset, AwarenessInsetStyle, AwarenessView, stiffness_color

WIDTH, HEIGHT = 640, 480
GREEN, RED, WHITE, YELLOW = (40, 217, 80), (255, 38, 26), (255, 255, 255), (255, 214, 0)


def view(**changes) -> AwarenessView:
    made = AwarenessView()
    fields = {
        "known": True,
        "center": [0.1, 0.0, -0.1],
        "tip": [0.11, 0.01, -0.1],
        "proxy": [0.09, 0.005, -0.105],
        "closest": [0.09, -0.005, -0.1],
        "force_N": [0.0, 0.0, 2.0],
        "region": [[0.095, -0.01, -0.1], [0.11, -0.01, -0.1], [0.11, -0.002, -0.1]],
        "region_closed": True,
        "text": "FULL CONTACT 2.0 N",
    }
    for name, value in {**fields, **changes}.items():
        setattr(made, name, value)
    return made


def drawn(what: AwarenessView, style: AwarenessInsetStyle | None = None) -> tuple[np.ndarray, AwarenessInset]:
    image = np.full((HEIGHT, WIDTH, 3), 120, np.uint8)
    inset = AwarenessInset(WIDTH, HEIGHT, style or AwarenessInsetStyle())
    assert inset.draw(what, image, "rgb8")
    return image, inset


def at(image: np.ndarray, inset: AwarenessInset, what: AwarenessView, point) -> tuple[int, ...]:
    left, top, _, _ = inset.box
    column, row = inset.place(what, point)
    return tuple(int(c) for c in image[round(top + row), round(left + column)])


def has(image: np.ndarray, color) -> bool:
    return bool((np.abs(image.astype(int) - color).max(axis=2) <= 2).any())


def test_each_thing_is_where_it_belongs() -> None:
    shown = view()
    image, inset = drawn(shown)
    assert at(image, inset, shown, shown.proxy) == GREEN
    assert at(image, inset, shown, shown.closest) == RED
    assert at(image, inset, shown, shown.tip) == WHITE
    style = AwarenessInsetStyle()
    assert at(image, inset, shown, np.add(shown.closest, [0.0, 0.0, 1.5 * style.arrow_m_per_N])) == RED
    for corner in shown.region:
        assert at(image, inset, shown, corner) == YELLOW
    closing = 0.5 * (shown.region[0] + shown.region[2])
    red, green, blue = at(image, inset, shown, closing)
    assert min(red, green) > 150 and blue < 60
    open_image, _ = drawn(view(region_closed=False))
    assert max(at(open_image, inset, shown, closing)) < 150


def test_up_is_up_and_lengths_are_those_of_the_span() -> None:
    inset, shown = AwarenessInset(WIDTH, HEIGHT), view()
    middle = np.array(inset.place(shown, shown.center))
    up = np.array(inset.place(shown, np.add(shown.center, [0.0, 0.0, 0.01])))
    assert up[0] == pytest.approx(middle[0]) and up[1] < middle[1]
    style = AwarenessInsetStyle()
    px_per_m = inset.box[2] / style.span_m
    assert middle[1] - up[1] == pytest.approx(0.01 * px_per_m * np.cos(style.elevation_rad))
    rng = np.random.default_rng(1)
    for direction in rng.normal(size=(50, 3)):
        seen = np.array(inset.place(shown, shown.center + 0.01 * direction)) - middle
        assert np.linalg.norm(seen) <= 0.01 * np.linalg.norm(direction) * px_per_m + 1e-9


def test_only_its_box_changes_also_for_things_far_outside() -> None:
    rng = np.random.default_rng(2)
    for _ in range(30):
        shown = view(tip=rng.normal(0.0, 0.1, 3), proxy=rng.normal(0, 1, 3), force_N=rng.normal(0, 30, 3))
        image, inset = drawn(shown)
        left, top, width, height = inset.box
        assert (left, top + height) == (0, HEIGHT) and width <= WIDTH
        outside = np.ones((HEIGHT, WIDTH), bool)
        outside[top : top + height, left : left + width] = False
        assert (image[outside] == 120).all()
        assert (image[~outside] != 120).any()


def test_what_is_not_known_is_not_drawn() -> None:
    nan = [np.nan] * 3
    for missing, color in (("proxy", GREEN), ("tip", WHITE)):
        image, _ = drawn(view(**{missing: nan, "text": ""}))
        assert not has(image, color), missing
    image, _ = drawn(view(closest=nan, text=""))
    assert not has(image, RED)
    image, _ = drawn(view(known=False, text=""))
    for color in (GREEN, RED, WHITE, YELLOW):
        assert not has(image, color)
    image, _ = drawn(view(hold=True, text="HOLD FORCE"))
    assert has(image, (255, 140, 0))


def test_the_stiffness_map_stands_for_the_models_grid() -> None:
    image = np.full((HEIGHT, WIDTH, 3), 120, np.uint8)
    inset, shown = AwarenessInset(WIDTH, HEIGHT), view(text="")
    at_m = np.add(shown.center, [[-0.012, 0.012, 0], [-0.004, 0.012, 0], [0.004, 0.012, 0], [0.012, 0.012, 0]])
    shares = [0.0, 0.5, 1.0, np.nan]
    assert inset.draw(shown, image, "rgb8", dots=np.c_[at_m, shares])
    for point, share in zip(at_m, shares):
        assert at(image, inset, shown, point) == stiffness_color(share)[:3]
    assert stiffness_color(0.5)[:3] == (33, 145, 140) and stiffness_color(7.0)[:3] == (253, 231, 37)
    grid = (70, 110, 150)
    assert not has(image, grid) and has(drawn(view())[0], grid)


@pytest.mark.parametrize(("encoding", "channels"), [("mono8", 1), ("bgr8", 3), ("rgba8", 4)])
def test_all_formats(encoding: str, channels: int) -> None:
    image = np.full((HEIGHT, WIDTH) if channels == 1 else (HEIGHT, WIDTH, channels), 90, np.uint8)
    inset = AwarenessInset(WIDTH, HEIGHT)
    assert inset.draw(view(), image, encoding)
    assert (image != 90).any()
    assert not inset.draw(view(), np.zeros((100, 100), np.uint8), "mono8")


def test_sizes_and_styles_are_checked() -> None:
    with pytest.raises(saras.ConfigError, match="width_px"):
        AwarenessInset(10, 480)
    with pytest.raises(saras.ConfigError, match="width"):
        AwarenessInset(WIDTH, HEIGHT, AwarenessInsetStyle(width=0.9))
    with pytest.raises(ValueError, match="at most 64"):
        view(region=np.zeros((65, 3)))
