"""Files of forbidden regions: what is right is read, what is not is refused with its line (faults 27 and 28)."""

from __future__ import annotations

import time

import numpy as np
import pytest

import saras
from saras.collision import ForbiddenRegions, Scene
from saras.collision import forbidden_regions as files

SACRUM = files.box_vertices([0.0, 0.0, 0.01], [0.1, 0.06, 0.03])
SKEWED = SACRUM + 0.3 * (SACRUM[:, [1]] * [[1.0, 0.0, 0.0]])


@pytest.fixture
def regions():
    return ForbiddenRegions(("sacrum", "skewed"), np.array([SACRUM, SKEWED]))


@pytest.mark.parametrize("name", ["vertices.txt", "regions.yaml", "regions.yml"])
def test_written_files_are_read_back_to_the_last_bit(regions, tmp_path, name):
    regions.save(tmp_path / name)
    read = ForbiddenRegions.load(tmp_path / name)
    np.testing.assert_array_equal(read.vertices, regions.vertices)
    assert read.names == (regions.names if name.startswith("regions") else ("region_1", "region_2"))


@pytest.mark.parametrize("name", ["vertices.txt", "regions.yaml"])
def test_scale_rotation_offset_as_in_the_source(regions, tmp_path, name):
    ForbiddenRegions(regions.names, 1000.0 * regions.vertices).save(tmp_path / name)
    permuted = [[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]  # init_trans of the source's listing
    read = ForbiddenRegions.load(tmp_path / name, scale=0.001, rotation=permuted, offset_m=[0.02, 0.0, 0.0])
    expected = np.stack([-regions.vertices[..., 1], regions.vertices[..., 2], -regions.vertices[..., 0]], axis=-1)
    np.testing.assert_allclose(read.vertices, expected + np.array([0.02, 0.0, 0.0]), atol=1e-15)


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("scale", 0.0),
        ("scale", np.nan),
        ("rotation", -np.eye(3)),
        ("rotation", 2 * np.eye(3)),
        ("offset_m", [np.inf] * 3),
    ],
)
def test_a_transform_that_is_none_is_refused(regions, tmp_path, argument, value):
    regions.save(tmp_path / "vertices.txt")
    with pytest.raises(saras.ConfigError, match=argument):
        ForbiddenRegions.load(tmp_path / "vertices.txt", **{argument: value})


@pytest.mark.parametrize("name", ["vertices.txt", "regions.yaml"])
def test_a_sparse_file_of_2_gb_is_refused_at_once(tmp_path, name):
    path = tmp_path / name
    with path.open("wb") as file:
        file.truncate(2 << 30)
    start = time.process_time()
    with pytest.raises(saras.ProtocolError, match=r"size = 2147483648 bytes: must be at most \d+ bytes"):
        ForbiddenRegions.load(path)
    assert time.process_time() - start < 0.5  # of processor time: it was not read


def test_a_count_beyond_the_cap_is_refused(tmp_path):
    path = tmp_path / "vertices.txt"
    path.write_text("100001\n")
    with pytest.raises(saras.ProtocolError, match=r"line 1: number of regions = '100001'.*\[1, 100000\]"):
        ForbiddenRegions.load(path)


@pytest.mark.parametrize("path", ["missing.txt", "missing.yaml"])
def test_a_missing_file_is_an_os_error(tmp_path, path):
    with pytest.raises(FileNotFoundError):
        ForbiddenRegions.load(tmp_path / path)


@pytest.mark.parametrize("name", ["a_folder.txt", "a_folder.yaml"])
def test_a_folder_is_refused(tmp_path, name):
    (tmp_path / name).mkdir()
    with pytest.raises(saras.ProtocolError, match="must be a regular file"):
        ForbiddenRegions.load(tmp_path / name)


def test_mutations_are_refused_or_mean_the_same(regions, tmp_path, many):
    """Each mutation of a good file either still is a good file, or is refused by line. Nothing else happens."""
    regions.save(tmp_path / "good.txt")
    good = (tmp_path / "good.txt").read_text()
    rng = np.random.default_rng(1)
    words = ["nan", "inf", "-", "1e999", "0x10", "", "1 2", "\n", "1e6", "#", "-0.05", "\0", "٣"]
    refused = 0
    for _ in range(500 * many):
        lines = good.splitlines()
        for _ in range(rng.integers(1, 3)):
            k = int(rng.integers(len(lines)))
            kind = rng.integers(4)
            if kind == 0:
                del lines[k]
            elif kind == 1:
                lines.insert(k, lines[k])
            elif kind == 2:
                parts = lines[k].split(" ")
                parts[int(rng.integers(len(parts)))] = str(rng.choice(words))
                lines[k] = " ".join(parts)
            else:
                other = int(rng.integers(len(lines)))
                lines[k], lines[other] = lines[other], lines[k]
        path = tmp_path / "mutant.txt"
        path.write_text("\n".join(lines))
        try:
            read = ForbiddenRegions.load(path)
        except saras.ProtocolError as error:
            assert "line " in str(error), error
            refused += 1
        else:
            assert np.isfinite(read.vertices).all() and len(read) == 2
            closing = read.vertices[:, 2] - read.vertices[:, 1] - read.vertices[:, 3] + read.vertices[:, 0]
            assert np.abs(closing).max() <= 2e-6
    assert refused > 300 * many


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "line 1: entries"),
        ("regions: []", "line 1: number of regions = 0"),
        ("regions: {}", "no list"),
        ("other: 1", "must be 'regions'"),
        ("regions:\n  - 5", "line 2: region 1: 5: must be a mapping"),
        ("regions:\n  - {name: a}", "must be vertices_m"),
        ("regions:\n  - {center_m: [0, 0, 0], size_m: [1, 1, 1], vertices_m: []}", "must be vertices_m"),
        ("regions:\n  - {center_m: [0, 0, 0], size_m: [1, 1, 1], colour: red}", "colour"),
        (
            "regions:\n  - {center_m: [0, 0], size_m: [1, 1, 1]}",
            r"center_m = \[0, 0\]: must be numbers of shape \(3,\)",
        ),
        ("regions:\n  - {center_m: [0, 0, .nan], size_m: [1, 1, 1]}", "center_m .*: must be finite"),
        ("regions:\n  - {center_m: [0, 0, 0], size_m: [1, 0, 1]}", "size_m = .*: must be > 0"),
        ("regions:\n\n  - {name: [], center_m: [0, 0, 0], size_m: [1, 1, 1]}", r"line 3: region 1: name = \[\]"),
        ("regions:\n  - vertices_m: [[0,0,0],[1,0,0]]", "vertices_m"),
        ("regions:\n  - &a {name: x, center_m: [0, 0, 0], size_m: [1, 1, 1]}\n  - *a", "must not stand there twice"),
        ("regions: [", "regions.yaml"),
        ("regions:\n  - !!python/object/apply:os.system [ls]", "regions.yaml"),
    ],
)
def test_yaml_refusals(tmp_path, text, words):
    path = tmp_path / "regions.yaml"
    path.write_text(text)
    with pytest.raises(saras.ProtocolError, match=words):
        ForbiddenRegions.load(path)


def test_yaml_boxes_are_turned_as_in_urdf(tmp_path):
    path = tmp_path / "regions.yaml"
    path.write_text("regions:\n  - {center_m: [1, 0, 0], size_m: [2, 1, 1], rpy_rad: [0, 0, 1.5707963267948966]}\n")
    read = ForbiddenRegions.load(path)
    assert read.names == ("region_1",)
    np.testing.assert_allclose(read.vertices[0].min(axis=0), [0.5, -1.0, -0.5], atol=1e-15)


def test_regions_go_into_a_scene(regions):
    found = Scene([([0, 0, 0.1], [0, 0, 0.2], 0.0025)], regions).distances()
    assert found[0].distance == pytest.approx(0.1 - 0.025 - 0.0025)
    with pytest.raises(saras.ConfigError, match=r"regions\[1\]"):
        Scene([], [SACRUM, SACRUM * [1, 1, 0]])
    with pytest.raises(saras.ConfigError, match="skewed"):
        ForbiddenRegions(("a", "skewed"), np.array([SACRUM, np.full((8, 3), np.nan)]))
