"""saras regions: boxes from a mesh cover its whole surface; what is written is what is read."""

from __future__ import annotations

import numpy as np
import pytest

trimesh = pytest.importorskip("trimesh")

import saras
from saras import cli
from saras.collision import ForbiddenRegions
from saras.collision import forbidden_regions as files
from saras.collision.fit import covered, fit_boxes


def bone():
    """Something like a sacrum: a bent, tapering, closed tube."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=1.0)
    p = np.array(mesh.vertices)
    p = p * [0.05, 0.03, 0.015] * (1.0 - 0.3 * p[:, :1])
    p[:, 2] += 8.0 * p[:, 0] ** 2
    return p, np.array(mesh.faces)


def samples(points, faces, count=20_000):
    rng = np.random.default_rng(1)
    weights = rng.dirichlet([0.5] * 3, count)  # many near edges and corners
    return np.einsum("ni,nij->nj", weights, points[faces[rng.integers(len(faces), size=count)]])


@pytest.mark.parametrize("wanted", [{"count": 1}, {"count": 2}, {"count": 17}, {"tolerance_m": 0.006}])
def test_the_union_covers_the_whole_surface(wanted):
    points, faces = bone()
    fit = fit_boxes(points, faces, **wanted)
    assert covered(points, fit.boxes).all()
    assert covered(samples(points, faces), fit.boxes).all()
    # Whole triangles, not samples: all three corners of each in one and the same box.
    home = np.zeros(len(faces), dtype=bool)
    for box in fit.boxes:
        home |= covered(points[faces].reshape(-1, 3), [box]).reshape(-1, 3).all(axis=1)
    assert home.all()
    if "count" in wanted:
        assert len(fit.boxes) == wanted["count"]
    else:
        assert fit.overhang_m <= wanted["tolerance_m"]


def test_more_boxes_fit_better_and_volumes_are_right():
    points, faces = bone()
    fits = [fit_boxes(points, faces, count=n) for n in (1, 8, 32)]
    assert fits[0].excess > fits[1].excess > fits[2].excess > -0.3
    box = trimesh.creation.box((0.1, 0.06, 0.03))
    rotated = box.vertices @ np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0].T
    fit = fit_boxes(rotated, box.faces, count=1)
    assert fit.mesh_volume_m3 == pytest.approx(0.1 * 0.06 * 0.03)
    assert fit.excess == pytest.approx((0.1002 * 0.0602 * 0.0302) / (0.1 * 0.06 * 0.03) - 1.0, abs=0.02)
    assert fit.overhang_m < 2e-3
    assert np.isnan(fit_boxes(rotated, box.faces[1:], count=1).excess)  # not closed


@pytest.mark.parametrize("form", ["stl", "stl_ascii", "obj"])
@pytest.mark.parametrize("out", ["regions.yaml", "vertices.txt"])
def test_from_mesh_and_check(tmp_path, capsys, form, out):
    points, faces = bone()
    path = tmp_path / f"sacrum.{form[:3]}"
    path.write_bytes(
        data
        if isinstance(data := trimesh.Trimesh(1000 * points, faces).export(file_type=form), bytes)
        else data.encode()
    )
    arguments = ["regions", "from-mesh", str(path), "--scale", "0.001", "--count", "9", "--out", str(tmp_path / out)]
    assert cli.main(arguments) == 0
    printed = capsys.readouterr().out
    assert "9 boxes cover" in printed and "% of the bone's" in printed
    regions = ForbiddenRegions.load(tmp_path / out)
    inside = np.zeros(len(points), dtype=bool)
    for vertices in regions.vertices:
        axes = np.column_stack([vertices[i] - vertices[0] for i in (1, 4, 3)])
        inside |= (np.abs(np.linalg.solve(axes, (points - vertices.mean(axis=0)).T)) <= 0.5).all(axis=0)
    assert inside.all()
    assert cli.main(["regions", "check", str(tmp_path / out)]) == 0
    assert "9 regions" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--count", "0"], "count = 0"),
        (["--count", "3000"], "count = 3000"),
        (["--tolerance-m", "1e-9"], "tolerance_m"),
        (["--margin-m", "0"], "margin_m"),
        (["--scale", "1000"], "largest extent"),
        (["--scale", "nan"], "scale"),
    ],
)
def test_refusals_name_value_and_bound(tmp_path, capsys, arguments, words):
    trimesh.Trimesh(*bone()).export(tmp_path / "bone.stl")
    out = tmp_path / "out.yaml"
    assert cli.main(["regions", "from-mesh", str(tmp_path / "bone.stl"), "--out", str(out), *arguments]) == 2
    assert words in capsys.readouterr().err
    assert not out.exists()


@pytest.mark.parametrize("content", [b"", b"solid x\nendsolid x\n", b"\0" * 10, b"not a mesh"])
@pytest.mark.parametrize("name", ["bone.stl", "bone.obj", "bone.ply"])
def test_no_mesh_is_refused(tmp_path, capsys, content, name):
    (tmp_path / name).write_bytes(content)
    assert cli.main(["regions", "from-mesh", str(tmp_path / name), "--out", str(tmp_path / "o.yaml")]) == 2
    assert name in capsys.readouterr().err


def test_check_refuses_what_the_platform_refuses(tmp_path, capsys):
    (tmp_path / "bad.txt").write_text("1\n0 0 0\n")
    assert cli.main(["regions", "check", str(tmp_path / "bad.txt")]) == 2
    assert "line 3" in capsys.readouterr().err


def test_meshes_that_are_none_raise():
    points, faces = bone()
    for bad_points, bad_faces in [(points[:, :2], faces), (points * np.nan, faces), (points, faces + 10**6)]:
        with pytest.raises(saras.ConfigError, match="mesh"):
            fit_boxes(bad_points, bad_faces, count=1)
    assert files.MAX_REGIONS >= 2000
