"""Unknown is never green: the law over random input, and the pixels read back, in every format."""

from __future__ import annotations

import math

import numpy as np
import pytest

from saras.collision import ProximityState
from saras.overlay import (
    CameraConfig,
    OverlayNotice,
    OverlayPainter,
    OverlayStyle,
    OverlayTool,
    ToolOverlay,
    ToolOverlayConfig,
    color_of,
    draw_notice,
)

UNKNOWN, CLEAR = ProximityState.UNKNOWN, ProximityState.CLEAR
WARNING, COLLISION = ProximityState.WARNING, ProximityState.COLLISION
CHANNELS = {"bgr8": 3, "rgb8": 3, "mono8": 1, "bgra8": 4, "rgba8": 4}
K = np.array([[500.0, 0, 320], [0, 500, 240], [0, 0, 1]])
CAMERA = CameraConfig(width_px=640, height_px=480, K=K, P=np.column_stack([K, np.zeros(3)]))
#: Tip and trocar of a shaft that crosses the middle of the image.
TIP, TROCAR = (-0.03, 0.0, 0.1), (0.08, 0.0, 0.1)
NAN = math.nan


def tool(distance_m: float = 0.05, state: ProximityState = CLEAR, **changes: object) -> OverlayTool:
    values = {"name": "T", "tip": TIP, "trocar": TROCAR, "distance_m": distance_m, "state": state}
    return OverlayTool(**{**values, **changes})


def step(tools: list, law: ToolOverlay | None = None, **changes: object):
    values = {
        "camera_T_world": np.eye(4),
        "distances_age_s": 0.01,
        "tools_age_s": 0.01,
        "camera_age_s": 0.01,
        "dt": 0.04,
    }
    return (law or ToolOverlay()).step(tools, **{**values, **changes})


def level(distance_m: float, state: ProximityState, **changes: object) -> ProximityState:
    return step([tool(distance_m, state)], **changes).tools[0].level


def blank(encoding: str, width: int = 640, height: int = 480, value: int = 30) -> np.ndarray:
    n = CHANNELS[encoding]
    return np.full((height, width) if n == 1 else (height, width, n), value, dtype=np.uint8)


def drawn(result, encoding: str = "bgr8", panel: bool = False) -> np.ndarray:
    image = blank(encoding)
    assert OverlayPainter(CAMERA, OverlayStyle(panel=panel)).draw(result, image, encoding)
    return image


def color_at_shaft(image: np.ndarray, encoding: str) -> tuple[int, ...]:
    """Red, green, blue (or the grey level) of the pixel in the middle of the shaft, away from ruler and label."""
    pixel = np.atleast_1d(image[240, 500]).tolist()
    if encoding == "mono8":
        return tuple(pixel)
    return tuple(pixel[:3] if encoding.startswith("rgb") else pixel[2::-1])


def is_green(rgb: np.ndarray) -> np.ndarray:
    rgb = rgb.astype(int)
    return (rgb[..., 1] > rgb[..., 0] + 40) & (rgb[..., 1] > rgb[..., 2] + 40)


def test_levels_follow_the_thresholds() -> None:
    for distance, expected in (
        (0.05, CLEAR),
        (0.0101, CLEAR),
        (0.0099, WARNING),
        (0.0021, WARNING),
        (0.002, COLLISION),
    ):
        assert level(distance, CLEAR) == expected
    for distance, expected in ((-0.004, COLLISION), (0.0, COLLISION), (math.inf, CLEAR)):
        assert level(distance, CLEAR) == expected


def test_a_colour_is_left_further_out_than_it_was_entered() -> None:
    law = ToolOverlay()
    path = (
        (0.012, CLEAR),
        (0.0095, WARNING),
        (0.0105, WARNING),
        (0.0112, CLEAR),
        (0.001, COLLISION),
        (0.0025, COLLISION),
    )
    for distance, expected in (*path, (0.0032, WARNING), (0.0105, WARNING), (0.02, CLEAR)):
        assert step([tool(distance)], law).tools[0].level == expected


def test_the_worse_of_both_words_holds() -> None:
    for ours, distance in ((CLEAR, 0.05), (WARNING, 0.005), (COLLISION, 0.001), (UNKNOWN, NAN)):
        for theirs in (CLEAR, WARNING, COLLISION, UNKNOWN):
            order = (CLEAR, UNKNOWN, WARNING, COLLISION)
            assert level(distance, theirs) == order[max(order.index(ours), order.index(theirs))]


def test_green_needs_everything_fresh(many: int) -> None:
    rng = np.random.default_rng(6)
    config = ToolOverlayConfig()
    distances = (NAN, math.inf, -math.inf, -0.01, 0.0, 0.002, 0.005, 0.01, 0.02, 0.5)
    ages = (0.0, 0.05, 0.1499, 0.1501, 0.3, math.inf, NAN, -1e-9, -1.0)
    law, greens = ToolOverlay(config), 0
    for _ in range(5000 * many):
        states = [(CLEAR, WARNING, COLLISION, UNKNOWN)[rng.choice(4, p=(0.55, 0.15, 0.15, 0.15))] for _ in range(4)]
        tools = [tool(float(rng.choice(distances, p=[0.1, 0.1, *[0.05] * 6, 0.25, 0.25])), state) for state in states]
        age = [float(rng.choice(ages, p=[0.28, 0.28, 0.2, *[0.04] * 6])) for _ in range(2)]
        dt = float(rng.choice((0.04, 0.0, NAN, -1.0, math.inf), p=(0.9, 0.025, 0.025, 0.025, 0.025)))
        out = step(tools, law, distances_age_s=age[0], tools_age_s=age[1], dt=dt)
        fresh = all(0.0 <= a <= 0.15 for a in age) and dt == 0.04
        for given, mark in zip(tools, out.tools):
            if mark.level == CLEAR:
                greens += 1
                assert fresh and given.state == CLEAR and given.distance_m >= config.warning_m, (given, age, dt)
            if dt == 0.04 and age[1] <= 0.15 and age[1] >= 0.0 and given.state in (WARNING, COLLISION):
                assert mark.level in (WARNING, COLLISION), "a known danger is not hidden by what is unknown"
            assert not math.isfinite(mark.distance_m) or mark.distance_m == given.distance_m
    assert greens > 500 * many


@pytest.mark.parametrize("encoding", CHANNELS)
@pytest.mark.parametrize(
    ("distance", "state", "expected"),
    [(0.05, CLEAR, CLEAR), (0.005, WARNING, WARNING), (0.001, COLLISION, COLLISION), (NAN, UNKNOWN, UNKNOWN)],
)
def test_the_pixel_read_back_has_the_levels_colour(encoding: str, distance: float, state, expected) -> None:
    image = drawn(step([tool(distance, state)]), encoding)
    r, g, b, mono = color_of(expected)
    assert color_at_shaft(image, encoding) == ((mono,) if encoding == "mono8" else (r, g, b))
    if CHANNELS[encoding] == 4:
        assert image[240, 500, 3] == 255


def test_colours_are_told_apart_in_colour_and_in_grey() -> None:
    colours = {state: color_of(state) for state in (CLEAR, WARNING, COLLISION, UNKNOWN)}
    rgb = {state: np.array(colour[:3]) for state, colour in colours.items()}
    assert [state for state in rgb if is_green(rgb[state])] == [CLEAR]
    r, g, b = colours[UNKNOWN][:3]
    assert r == g == b
    greys = sorted(colour[3] for colour in colours.values())
    assert np.diff(greys).min() >= 20


SPOILERS = {
    "distance NaN": {"tool": {"distance_m": NAN}},
    "state unknown": {"tool": {"state": UNKNOWN}},
    "distances silent": {"ages": {"distances_age_s": math.inf}},
    "distances stale": {"ages": {"distances_age_s": 0.151}},
    "tools stale": {"ages": {"tools_age_s": 0.151}},
    "tools silent": {"ages": {"tools_age_s": math.inf}},
    "tip NaN": {"tool": {"tip": (NAN, 0.0, 0.1), "state": UNKNOWN}},
    "trocar infinite": {"tool": {"trocar": (0.0, math.inf, 0.1), "state": UNKNOWN}},
    "time stands still": {"ages": {"dt": 0.0}},
}


@pytest.mark.parametrize("spoiler", SPOILERS)
@pytest.mark.parametrize("encoding", ["bgr8", "rgb8", "bgra8", "rgba8"])
def test_no_green_pixel_for_what_is_unknown(spoiler: str, encoding: str) -> None:
    change = SPOILERS[spoiler]
    result = step([tool(**change.get("tool", {}))], **change.get("ages", {}))
    image = drawn(result, encoding, panel=True)
    rgb = image[..., :3] if encoding.startswith("rgb") else image[..., 2::-1]
    assert not is_green(rgb).any()
    r, g, b, _ = color_of(UNKNOWN)
    assert (rgb == [r, g, b]).all(axis=-1).any(), "the list says that it is unknown"


@pytest.mark.parametrize("camera_age_s", [0.21, math.inf, NAN, -1.0])
def test_without_the_cameras_pose_nothing_is_placed(camera_age_s: float) -> None:
    result = step([tool(on_tool=TIP, on_partner=TROCAR, known_distance_m=0.01)], camera_age_s=camera_age_s)
    assert not result.camera_known
    assert not result.tools[0].placed and not result.tools[0].witness
    assert (drawn(result) == blank("bgr8")).all()


def test_a_pose_that_is_not_rigid_is_none() -> None:
    for spoilt in (2.0 * np.eye(4), np.full((4, 4), NAN)):
        assert not step([tool()], camera_T_world=spoilt).camera_known


@pytest.mark.parametrize("size", [(480, 640), (641, 480), (640, 481), (320, 240), (1, 1), (1920, 1080)])
def test_another_image_size_stays_untouched(size: tuple[int, int]) -> None:
    image = blank("bgr8", *size)
    assert not OverlayPainter(CAMERA).draw(step([tool()]), image, "bgr8")
    assert (image == 30).all()


def test_witnesses_are_drawn_when_near() -> None:
    points = {"on_tool": (0.0, 0.02, 0.1), "on_partner": (0.02, 0.03, 0.1)}
    for known_distance, near in ((0.01, True), (-0.01, True), (0.031, False), (NAN, False)):
        result = step([tool(0.005, WARNING, known_distance_m=known_distance, **points)])
        assert result.tools[0].witness == near
        middle = drawn(result)[240 + 125, 320 + 50]
        assert (middle.tolist() == list(color_of(WARNING)[2::-1])) == near


def test_nearer_is_thicker() -> None:
    thick = []
    for depth in (0.05, 0.1, 0.2):
        ends = {"tip": (-depth, 0.0, depth), "trocar": (depth, 0.0, depth)}
        column = drawn(step([tool(**ends)]))[:, 500]
        thick.append(int((column != 30).any(axis=1).sum()))
    assert thick[0] > thick[1] > thick[2] >= 1


def test_notices_are_written_on_images_of_any_size() -> None:
    for encoding, n in CHANNELS.items():
        for width, height in ((640, 480), (1920, 1080), (64, 48), (3, 2), (1, 1)):
            for notice in list(OverlayNotice.__members__.values()):
                image = blank(encoding, width, height, 100)
                draw_notice(notice, image, encoding)
                changed = (image != 100).any()
                assert changed == (notice != OverlayNotice.NONE) or height < 48
                assert n != 4 or (image[..., 3][image[..., 3] != 100] == 255).all()


def test_images_may_have_padded_rows_and_wild_tools_draw_within_them(many: int) -> None:
    rng = np.random.default_rng(7)
    painter = OverlayPainter(CAMERA)
    for _ in range(200 * many):
        wide = np.full((482, 700, 3), 77, dtype=np.uint8)
        image = wide[1:481, 10:650]
        size = 10.0 ** rng.uniform(-3, 6)
        ends = rng.normal(0.0, size, (4, 3)) + np.array([0, 0, 0.1])
        ends[rng.random((4, 3)) < 0.02] = rng.choice([NAN, math.inf, -math.inf])
        given = tool(
            float(rng.normal(0.0, 0.02)),
            tip=ends[0],
            trocar=ends[1],
            on_tool=ends[2],
            on_partner=ends[3],
            known_distance_m=0.0,
        )
        assert painter.draw(step([given]), image, "bgr8")
        assert (wide[0] == 77).all() and (wide[-1] == 77).all()
        assert (wide[:, :10] == 77).all() and (wide[:, 650:] == 77).all()


def test_wrong_arrays_are_refused() -> None:
    painter, result = OverlayPainter(CAMERA), step([tool()])
    with pytest.raises(ValueError, match="encoding"):
        painter.draw(result, blank("bgr8"), "bayer_rggb8")
    with pytest.raises(ValueError, match="shape"):
        painter.draw(result, blank("mono8"), "bgr8")
    with pytest.raises(TypeError):
        painter.draw(result, blank("bgr8").astype(float), "bgr8")
