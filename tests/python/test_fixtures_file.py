"""Files of virtual fixtures: what is read, where it lands in the arm's base, and what is refused and how."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
import yaml
from scipy.spatial.transform import Rotation

from saras import ConfigError, csa
from saras.csa import fixtures_file

CONFIG = Path(__file__).parents[2] / "config"
PLANE = {"name": "floor", "type": "plane", "point_m": [0.0, 0.0, 0.1], "normal": [0, 0, 2]}
SQUARE = [[0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]]
ONE_OF_EACH = [
    PLANE,
    {"name": "line", "type": "line", "point_m": [0, 0, 0.1], "direction": [1, 1, 0], "radius_m": 0.002},
    {"name": "path", "type": "path", "points_m": SQUARE, "radius_m": 0.002, "soft": True},
    {"name": "hull", "type": "hull", "points_m": [*SQUARE, [0, 0, 0.1]], "keep_in": False, "margin_m": 0.001},
    {"name": "region", "type": "region", "points_m": SQUARE, "normal": [0, 0, 1], "side": "left"},
    {"name": "ball", "type": "mesh", "file": "ball.stl", "keep_in": True, "margin_m": 0.001, "frame": "sbs_world"},
]


def written(folder, content):
    path = folder / "fixtures.yaml"
    path.write_text(content if isinstance(content, str) else yaml.safe_dump(content), encoding="utf-8")
    trimesh.creation.icosphere(subdivisions=2, radius=0.05).export(folder / "ball.stl")
    return path


def test_the_shipped_example_is_read():
    read = fixtures_file.load(CONFIG / "fixtures.yaml")
    assert [entry.name for entry in read.of("left")] == ["floor", "region", "lane"]
    assert [entry.name for entry in read.of("right")] == ["floor", "region"]
    assert read.frames("right") == {"mesa_right/sbs_world"}
    csa.FixtureForce(read.force, read.build("left", lambda _: np.eye(4)))


def test_a_place_in_its_frame_is_the_same_place_in_the_base(tmp_path):
    read = fixtures_file.load(written(tmp_path, {"force_limit_N": 2.0, "fixtures": ONE_OF_EACH}))
    assert read.force.force_limit_N == 2.0
    assert read.frames("left") == {"world", "mesa_left/sbs_world"}
    random = np.random.default_rng(1)
    base_T_world = np.eye(4)
    base_T_world[:3, :3] = Rotation.random(random_state=random).as_matrix()
    base_T_world[:3, 3] = random.normal(size=3)
    at_home = csa.FixtureForce(read.force, read.build("left", lambda _: np.eye(4)))
    away = csa.FixtureForce(read.force, read.build("left", lambda _: base_T_world))
    for _ in range(200):
        tip = np.eye(4)
        tip[:3, 3] = random.uniform(-0.1, 0.2, 3)
        one, other = at_home.step(tip, 0.01), away.step(base_T_world @ tip, 0.01)
        np.testing.assert_allclose(other.distance_m, one.distance_m, atol=1e-6)
        np.testing.assert_allclose(other.wrench[:3], base_T_world[:3, :3] @ one.wrench[:3], atol=1e-3)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"normal": [0, 0]}, r"fixtures\[0\]\.normal = \[0, 0\]: must be a list of 3 numbers"),
        ({"normal": [0, 0, 0]}, r"fixtures\[0\]\.normal = .*must not be zero"),
        ({"normal": [0, 0, ".nan"]}, r"fixtures\[0\]\.normal\[2\]"),
        ({"point_m": [0, 0, float("inf")]}, r"fixtures\[0\]\.point_m\[2\] = inf"),
        ({"type": "wall"}, r"fixtures\[0\]\.type = 'wall': must be one of plane, line"),
        ({"type": "remote_centre"}, r"fixtures\[0\]\.type"),
        ({"side": "middle"}, r"fixtures\[0\]\.side = 'middle'"),
        ({"soft": 1}, r"fixtures\[0\]\.soft = 1: must be true or false"),
        ({"stiffness_N_m": 1e6}, r"fixtures\[0\]: floor\.stiffness_N_m = 1000000: must be in \[0, 2000\]"),
        ({"start_m": True}, r"fixtures\[0\]\.start_m = True"),
        ({"margin": 0.1}, r"fixtures\[0\]\.margin: unknown entry"),
        ({"name": ""}, r"fixtures\[0\]\.name = ''"),
        ({"frame": 3}, r"fixtures\[0\]\.frame = 3"),
    ],
)
def test_a_spoilt_entry_refuses_by_its_place(tmp_path, change, told):
    path = written(tmp_path, {"fixtures": [{**PLANE, **change}]})
    with pytest.raises(ConfigError, match=told) as refusal:
        fixtures_file.load(path)
    assert str(path) in str(refusal.value)


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("", "must be a mapping"),
        ("fixtures: 3", "fixtures = 3: must be a list"),
        ("fixtures: [3]", r"fixtures\[0\] = 3: must be a mapping"),
        ("fixtures: [", "fixtures.yaml: while parsing"),
        ("{fixtures: [], ramp: 1}", "ramp: unknown entry"),
        ("{fixtures: [], ramp_s: 0}", "ramp_s = 0: must be finite and > 0"),
        ("force_limit_N: 1", "fixtures: is missing"),
        ({"fixtures": [PLANE, PLANE]}, "must not stand there twice for the left side"),
        ({"fixtures": [{**PLANE, "name": f"p{i}"} for i in range(17)]}, "count = 17"),
        ({"fixtures": [{key: PLANE[key] for key in ("name", "type", "normal")}]}, r"point_m: is missing"),
        ({"fixtures": [{"name": "h", "type": "hull", "points_m": SQUARE}]}, r"fixtures\[0\]: points: thickness"),
        ({"fixtures": [{"name": "m", "type": "mesh", "file": "none.stl"}]}, "none.stl"),
    ],
)
def test_what_is_no_file_of_fixtures_is_refused(tmp_path, content, told):
    with pytest.raises(ConfigError, match=told):
        fixtures_file.load(written(tmp_path, content))


def test_a_fixture_is_recorded_and_built_again(tmp_path):
    from saras.law_trace import to_plain
    from saras.replay import from_plain

    read = fixtures_file.load(written(tmp_path, {"fixtures": ONE_OF_EACH}))
    for made in read.build("left", lambda _: np.eye(4)):
        again = from_plain(to_plain(made))
        assert again.fixture.name == made.fixture.name
        assert again.fixture.soft == made.fixture.soft
        assert again.fixture.kind == made.fixture.kind
        assert again.fixture.numbers == made.fixture.numbers
        assert (again.stiffness_N_m, again.start_m) == (made.stiffness_N_m, made.start_m)
